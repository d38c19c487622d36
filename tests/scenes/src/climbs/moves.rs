//! The clips that a creature plays while it is climbed.

use std::error::Error;

use clamber_animation::SeamProbe;
use clamber_navigation::{ClimbGraph, Forecast};
use clamber_surface::rig::{Playback, Pose, RigError};

use crate::Creature;
use crate::battle::Repeat;

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

/// Clips that are played by turns, each as it repeats; at rest if there are none.
pub(super) struct Moves {
    played: Vec<(usize, Repeat)>,
    /// Seconds of a clip per second.
    pub(super) rate: f64,
    /// How long a clip fades into another, seconds.
    fade: f64,
}

impl Moves {
    pub(super) fn none() -> Self {
        Self {
            played: Vec::new(),
            rate: 1.0,
            fade: 0.0,
        }
    }

    /// The first clip with one of these words in its name, or else the first clip, in a loop.
    pub(super) fn one(creature: &Creature, words: &[&str], rate: f64) -> Self {
        let first = (!creature.rig.clips.is_empty()).then_some(0);
        let played = creature.clip_index(words).or(first);
        Self {
            played: played
                .map(|clip| (clip, Repeat::Loop))
                .into_iter()
                .collect(),
            rate,
            ..Self::none()
        }
    }

    /// A creature's idling and walking by turns, or its first clip that lives if it has neither. They play slower for a
    /// creature that is higher than `own`, its height in its file, by Froude's law.
    pub(super) fn by_turns(
        creature: &Creature,
        own: f64,
        height: f64,
    ) -> Result<Self, Box<dyn Error>> {
        let all = || 0..creature.rig.clips.len();
        let name = |clip: usize| creature.rig.clips[clip].name.to_lowercase();
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
        let probe = SeamProbe::new(&creature.rig.skeleton, &creature.rig.collider, own);
        let mut played = Vec::new();
        for clip in clips {
            played.push((clip, Repeat::of(probe.measure(&creature.rig.clips[clip])?)));
        }
        Ok(Self {
            played,
            rate: (own / height).sqrt().min(1.0),
            fade: FADE * (height / HUMAN).sqrt(),
        })
    }

    /// The pose at a time, seconds.
    pub(super) fn pose(&self, creature: &Creature, seconds: f64) -> Result<Pose, RigError> {
        let mut pose = creature.rig.skeleton.rest_pose();
        let Some((played, since)) = self.at(seconds) else {
            return Ok(pose);
        };
        self.sample(creature, played, since, &mut pose)?;
        let faded = since / self.fade;
        if self.played.len() > 1
            && seconds > since
            && faded < 1.0
            && let Some((before, _)) = self.at(seconds - TURN)
        {
            let mut other = creature.rig.skeleton.rest_pose();
            self.sample(creature, before, TURN + since, &mut other)?;
            let share = faded * faded * (3.0 - 2.0 * faded);
            pose.blend_in(&other, 1.0 - share)?;
        }
        Ok(pose)
    }

    fn sample(
        &self,
        creature: &Creature,
        (clip, repeat): (usize, Repeat),
        since: f64,
        pose: &mut Pose,
    ) -> Result<(), RigError> {
        let clip = &creature.rig.clips[clip];
        let time = repeat.time(since * self.rate, clip.duration());
        clip.sample_into(time, Playback::Clamp, pose)
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

    /// The clips of the next two turns.
    pub(super) fn forecast(
        &self,
        creature: &Creature,
        graph: &ClimbGraph,
        seconds: f64,
    ) -> Forecast {
        let mut forecast = Forecast::still();
        for step in 0..(2.0 * TURN / AHEAD) as u32 {
            if let Some(((clip, repeat), since)) = self.at(seconds + f64::from(step) * AHEAD) {
                let clip = &creature.rig.clips[clip];
                let time = repeat.time(since * self.rate, clip.duration());
                forecast = forecast.then(graph, &clip.name, time, AHEAD);
            }
        }
        forecast
    }
}
