//! A creature that idles and walks by turns while it is climbed.

use std::error::Error;

use clamber::animation::SeamProbe;
use clamber::geometry::Similarity;
use clamber::rig::{Palette, Playback, Pose};
use clamber::surface::SkinnedSurface;
use clamber_navigation::{ClimbGraph, Forecast};
use clamber_scenes::Creature;
use clamber_scenes::battle::Repeat;

/// Time for which each clip plays, seconds.
const TURN: f64 = 30.0;

/// Length of the forecast's steps, seconds: the slices of a graph.
const AHEAD: f64 = 0.5;

/// Seconds in which one clip fades into another for a creature of a human's height, metres; larger ones take longer, by
/// Froude's law. As in the gaits of a colossus.
const FADE: f64 = 0.35;
const HUMAN: f64 = 1.8;

/// Words in the names of clips of a creature that waits, and of one that goes.
const WAITS: [&str; 3] = ["idle", "survey", "standing"];
const GOES: [&str; 4] = ["walk", "swimming_normal", "swim", "run"];

/// Words in the names of clips that show a single act. Only a creature without other clips plays them.
const ACTS: &str = "death die dying dead attack headbutt bite punch kick slash swordslash sword shoot gun jump walkjump \
                    hit hitrecieve hitreact react dance fall falling wave eat eating sit sitting emote flip cast dodge \
                    roll dashing";

/// A creature, scaled to a height, at the origin.
pub(crate) struct Stage<'a> {
    creature: &'a Creature,
    pub(crate) surface: SkinnedSurface,
    pub(crate) place: Similarity,
    /// Height of the ground, metres.
    pub(crate) ground: f64,
    /// Clips that are played by turns, each as it repeats; at rest if there are none.
    played: Vec<(usize, Repeat)>,
    /// Seconds of a clip that pass in a second.
    pub(crate) rate: f64,
    /// How long a clip fades into another, seconds.
    fade: f64,
}

impl<'a> Stage<'a> {
    /// A creature whose rest pose is `height` metres high, at its first tick. If it is `moving`, it idles and walks by
    /// turns, or plays its first clip that lives if it has neither; otherwise it stays at rest. Clips play slower for a
    /// creature that is higher than in its file, by Froude's law.
    pub(crate) fn new(
        creature: &'a Creature,
        height: f64,
        moving: bool,
    ) -> Result<Self, Box<dyn Error>> {
        let (place, ground) = creature.standing(height)?;
        let own = height / place.scale;
        let mut stage = Self {
            creature,
            surface: SkinnedSurface::new(creature.rig.collider.clone()),
            place,
            ground,
            played: Vec::new(),
            rate: 1.0,
            fade: 0.0,
        };
        if moving {
            stage.played = by_turns(creature, own)?;
            stage.rate = (own / height).sqrt().min(1.0);
            stage.fade = FADE * (height / HUMAN).sqrt();
        }
        let palette = stage.palette(0.0)?;
        stage.surface.teleport(&palette, place)?;
        Ok(stage)
    }

    /// Moves the creature on to its pose at a time, seconds: the next tick.
    pub(crate) fn advance(&mut self, seconds: f64) -> Result<(), Box<dyn Error>> {
        let palette = self.palette(seconds)?;
        Ok(self.surface.advance(&palette, self.place)?)
    }

    /// The palette at a time, seconds.
    pub(crate) fn palette(&self, seconds: f64) -> Result<Palette, Box<dyn Error>> {
        let skeleton = &self.creature.rig.skeleton;
        let Some((played, since)) = self.at(seconds) else {
            return Ok(skeleton.palette(&skeleton.rest_pose())?);
        };
        let mut pose = self.sample(played, since)?;
        let faded = since / self.fade;
        if self.played.len() > 1
            && seconds > since
            && faded < 1.0
            && let Some((before, _)) = self.at(seconds - TURN)
        {
            let share = faded * faded * (3.0 - 2.0 * faded);
            pose.blend_in(&self.sample(before, TURN + since)?, 1.0 - share)?;
        }
        Ok(skeleton.palette(&pose)?)
    }

    fn sample(&self, (clip, repeat): (usize, Repeat), since: f64) -> Result<Pose, Box<dyn Error>> {
        let (rig, clip) = (&self.creature.rig, &self.creature.rig.clips[clip]);
        let time = repeat.time(since * self.rate, clip.duration());
        Ok(clip.sample(&rig.skeleton.rest_pose(), time, Playback::Clamp)?)
    }

    /// The clip that plays at a time, and for how long it has played, seconds. A single clip goes on without an end.
    fn at(&self, seconds: f64) -> Option<((usize, Repeat), f64)> {
        let turns = self.played.len();
        let turn = if turns > 1 {
            (seconds / TURN).floor()
        } else {
            0.0
        };
        let index = turn.rem_euclid(turns.max(1) as f64) as usize;
        Some((*self.played.get(index)?, seconds - turn * TURN))
    }

    /// The clips of the next two turns, from a time on, seconds.
    pub(crate) fn forecast(&self, graph: &ClimbGraph, seconds: f64) -> Forecast {
        let mut forecast = Forecast::still();
        for step in 0..(2.0 * TURN / AHEAD) as u32 {
            if let Some(((clip, repeat), since)) = self.at(seconds + f64::from(step) * AHEAD) {
                let clip = &self.creature.rig.clips[clip];
                let time = repeat.time(since * self.rate, clip.duration());
                forecast = forecast.then(graph, &clip.name, time, AHEAD);
            }
        }
        forecast
    }
}

/// A creature's clips for idling and walking, or its first clip that lives if it has neither. `own` is its height in
/// its file.
fn by_turns(creature: &Creature, own: f64) -> Result<Vec<(usize, Repeat)>, Box<dyn Error>> {
    let rig = &creature.rig;
    let all = || 0..rig.clips.len();
    let name = |clip: usize| rig.clips[clip].name.to_lowercase();
    let lives = |clip: &usize| {
        let name = name(*clip);
        let mut words = name.split(|letter: char| !letter.is_alphabetic());
        !words.any(|word| ACTS.split(' ').any(|act| act == word))
    };
    // The shortest name of several is the plainest: longer ones say what the creature does meanwhile.
    let plainest = |word: &&str| {
        let named = all()
            .filter(lives)
            .filter(|clip| name(*clip).contains(word));
        named.min_by_key(|clip| name(*clip).len())
    };
    let first = |words: &[&str]| words.iter().find_map(plainest);
    let mut clips: Vec<usize> = [&WAITS[..], &GOES].into_iter().filter_map(first).collect();
    if clips.is_empty() {
        clips.extend(all().find(lives).or(all().next()));
    }
    let probe = SeamProbe::new(&rig.skeleton, &rig.collider, own);
    let mut played = Vec::new();
    for clip in clips {
        played.push((clip, Repeat::of(probe.measure(&rig.clips[clip])?)));
    }
    Ok(played)
}
