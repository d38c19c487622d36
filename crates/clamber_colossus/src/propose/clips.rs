//! Finds out by their names what clips are for.

use clamber_animation::rig::Clip;

/// Words in the names of clips of somebody who waits, walks, shakes somebody off, attacks, and dies. Those that come
/// first are preferred.
const WAITS: [&str; 7] = ["idle", "survey", "stand", "breath", "rest", "swim", "fly"];
const WALKS: [&str; 3] = ["walk", "move", "run"];
const SHAKES: [&str; 10] = [
    "shake", "shrug", "hitre", "react", "impact", "hurt", "roar", "dance", "jump", "attack",
];
const ATTACKS: [&str; 9] = [
    "headbutt", "bite", "attack", "stomp", "swipe", "punch", "kick", "slash", "strike",
];
const DIES: [&str; 3] = ["death", "die", "dead"];

/// Words in the names of clips that are neither waiting nor walking.
const ACTS: [&str; 12] = [
    "death", "attack", "bite", "punch", "kick", "slash", "shoot", "hit", "jump", "hold", "gun",
    "sit",
];

/// What a creature's clips are for, as far as their names tell.
pub(super) struct Clips {
    pub(super) idle: Option<String>,
    pub(super) walk: Option<String>,
    pub(super) shake: Option<String>,
    pub(super) attack: Option<String>,
    pub(super) death: Option<String>,
}

impl Clips {
    pub(super) fn of(clips: &[Clip]) -> Self {
        let lasting = || clips.iter().filter(|clip| clip.duration() > 0.0);
        let named = |clip: &Clip, word: &str| clip.name.to_lowercase().contains(word);
        // The first of the shortest name: others say what it does meanwhile.
        let plainest = |words: &[&str], is_calm: bool| {
            let is_act = |clip: &Clip| is_calm && ACTS.iter().any(|act| named(clip, act));
            words.iter().find_map(|word| {
                let found = lasting().filter(|clip| named(clip, word) && !is_act(clip));
                found
                    .min_by_key(|clip| clip.name.len())
                    .map(|clip| clip.name.clone())
            })
        };
        let first = lasting().map(|clip| clip.name.clone()).next();
        Self {
            idle: plainest(&WAITS, true).or(first),
            walk: plainest(&WALKS, true),
            shake: plainest(&SHAKES, false),
            attack: plainest(&ATTACKS, false),
            death: plainest(&DIES, false),
        }
    }
}
