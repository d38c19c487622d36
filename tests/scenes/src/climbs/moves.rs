//! What a model does while a bot climbs it: it idles and walks by turns.

use clamber_animation::SeamProbe;
use clamber_navigation::{ClimbGraph, Forecast};
use clamber_surface::rig::{Playback, Pose};

use super::ClimbError;
use crate::Creature;
use crate::battle::Repeat;

/// Seconds of each of its clips.
const TURN: f64 = 30.0;

/// The forecast's steps, seconds: the slices of a graph.
const AHEAD: f64 = 0.5;

/// Seconds in which one clip fades into another for a creature of a human's height, metres; larger ones take longer, by
/// Froude's law. As in the gaits of a colossus.
const FADE: f64 = 0.35;
const HUMAN: f64 = 1.8;

/// Words in the names of clips of somebody who waits, and of somebody who goes.
const WAITS: [&str; 3] = ["idle", "survey", "standing"];
const GOES: [&str; 4] = ["walk", "swimming_normal", "swim", "run"];

/// Words in the names of clips that are no way to live: they are played by no model that has others.
const ACTS: [&str; 34] = [
    "death",
    "die",
    "dying",
    "dead",
    "attack",
    "headbutt",
    "bite",
    "punch",
    "kick",
    "slash",
    "swordslash",
    "sword",
    "shoot",
    "gun",
    "jump",
    "walkjump",
    "hit",
    "hitrecieve",
    "hitreact",
    "react",
    "dance",
    "fall",
    "falling",
    "wave",
    "eat",
    "eating",
    "sit",
    "sitting",
    "emote",
    "flip",
    "cast",
    "dodge",
    "roll",
    "dashing",
];

/// A clip, and how it goes on after its end.
#[derive(Clone, Copy, Debug)]
struct Played {
    clip: usize,
    repeat: Repeat,
}

/// Clips by turns.
#[derive(Clone, Debug)]
pub(super) struct Moves {
    played: Vec<Played>,
    /// How fast they are played: slower for a model that is larger than its file says, by Froude's law.
    pub(super) rate: f64,
    /// How long a clip fades into another, seconds.
    fade: f64,
}

impl Moves {
    /// A model's idling and walking; what else loops if it has neither.
    pub(super) fn new(creature: &Creature, height: f64) -> Result<Self, ClimbError> {
        let (place, _) = creature.standing(height)?;
        let own = height / place.scale;
        let probe = SeamProbe::new(&creature.skeleton, &creature.collider, own);
        let all = || 0..creature.clips.len();
        let name = |clip: usize| creature.clips[clip].name.to_lowercase();
        let lives = |clip: &usize| {
            let name = name(*clip);
            let mut words = name.split(|letter: char| !letter.is_alphabetic());
            !words.any(|word| ACTS.contains(&word))
        };
        // Of several the first of the shortest name: others say what it does meanwhile.
        let plainest = |word: &str| {
            let named = all()
                .filter(lives)
                .filter(|clip| name(*clip).contains(word));
            named.min_by_key(|clip| name(*clip).len())
        };
        let first = |words: &[&str]| words.iter().find_map(|word| plainest(word));
        let mut clips: Vec<usize> = [&WAITS[..], &GOES].into_iter().filter_map(first).collect();
        let mut played = Vec::new();
        if clips.is_empty() {
            clips.extend(all().find(lives).or(all().next()));
        }
        for clip in clips {
            let repeat = Repeat::of(probe.measure(&creature.clips[clip])?);
            played.push(Played { clip, repeat });
        }
        Ok(Self {
            played,
            rate: (own / height).sqrt().min(1.0),
            fade: FADE * (height / HUMAN).sqrt(),
        })
    }

    /// Poses the model at a time.
    pub(super) fn pose(
        &self,
        creature: &Creature,
        seconds: f64,
        pose: &mut Pose,
    ) -> Result<(), ClimbError> {
        let Some((played, since)) = self.at(seconds) else {
            return Ok(());
        };
        self.sample(creature, played, since, pose)?;
        let faded = since / self.fade;
        if self.played.len() > 1 && seconds > since && faded < 1.0 {
            let Some((before, _)) = self.at(seconds - TURN) else {
                return Ok(());
            };
            let mut other = creature.skeleton.rest_pose();
            self.sample(creature, before, TURN + since, &mut other)?;
            let share = faded * faded * (3.0 - 2.0 * faded);
            pose.blend_in(&other, 1.0 - share)?;
        }
        Ok(())
    }

    fn sample(
        &self,
        creature: &Creature,
        played: Played,
        since: f64,
        pose: &mut Pose,
    ) -> Result<(), ClimbError> {
        let clip = &creature.clips[played.clip];
        let time = played.repeat.time(since * self.rate, clip.duration());
        clip.sample_into(time, Playback::Clamp, pose)?;
        Ok(())
    }

    /// The clip of a time, and since when it plays.
    fn at(&self, seconds: f64) -> Option<(Played, f64)> {
        let turns = self.played.len();
        let turn = (seconds / TURN).floor();
        let index = turn.rem_euclid(turns.max(1) as f64) as usize;
        // A single clip goes on without an end.
        let since = if turns > 1 {
            seconds - turn * TURN
        } else {
            seconds
        };
        Some((*self.played.get(index)?, since))
    }

    /// What is to come from a time on.
    pub(super) fn forecast(
        &self,
        creature: &Creature,
        graph: &ClimbGraph,
        seconds: f64,
    ) -> Forecast {
        let steps = (2.0 * TURN / AHEAD) as u32;
        let mut forecast = Forecast::still();
        for step in 0..steps {
            if let Some((played, since)) = self.at(seconds + f64::from(step) * AHEAD) {
                let clip = &creature.clips[played.clip];
                let time = played.repeat.time(since * self.rate, clip.duration());
                forecast = forecast.then(graph, &clip.name, time, AHEAD);
            }
        }
        forecast
    }
}
