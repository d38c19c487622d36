//! Finds the use of clips by their names.

use clamber_animation::rig::Clip;

/// Words in the names of clips that can serve as the idle clip. Earlier words are preferred.
const IDLE_WORDS: [&str; 13] = [
    "idle",
    "survey",
    "stand",
    "stands",
    "standing",
    "breath",
    "breathe",
    "breathing",
    "rest",
    "swim",
    "swimming",
    "fly",
    "flying",
];
/// Words in the names of clips that can serve as the walk. Earlier words are preferred.
const WALK_WORDS: [&str; 7] = [
    "walk", "walks", "walking", "move", "moves", "run", "running",
];
/// Words in the names of clips that can serve for shaking off riders. Earlier words are preferred.
const SHAKE_WORDS: [&str; 11] = [
    "shake", "shrug", "hit", "react", "recieve", "impact", "hurt", "roar", "dance", "jump",
    "attack",
];
/// Words in the names of clips that can serve as the attack. Earlier words are preferred.
const ATTACK_WORDS: [&str; 9] = [
    "headbutt", "bite", "attack", "stomp", "swipe", "punch", "kick", "slash", "strike",
];
/// Words in the names of clips that can serve as the death. Earlier words are preferred.
const DEATH_WORDS: [&str; 5] = ["death", "die", "dies", "dying", "dead"];

/// A clip with one of these words in its name is neither the idle clip nor the walk.
const ACT_WORDS: [&str; 22] = [
    "death", "die", "dies", "dying", "dead", "attack", "headbutt", "bite", "punch", "kick",
    "slash", "shoot", "hit", "jump", "hold", "holding", "gun", "sword", "sit", "sitting", "fast",
    "impulse",
];

/// Longest clip that is used, seconds.
const LONGEST_CLIP: f64 = 600.0;

/// The clips of a creature by their use, as far as their names tell.
pub(super) struct Clips {
    pub(super) idle: Option<String>,
    pub(super) walk: Option<String>,
    pub(super) shake: Option<String>,
    pub(super) attack: Option<String>,
    pub(super) death: Option<String>,
}

impl Clips {
    pub(super) fn of(clips: &[Clip]) -> Self {
        // A name refers to the first clip that has it.
        let is_first = |index: usize, clip: &Clip| {
            let same = clips.iter().position(|other| other.name == clip.name);
            same == Some(index) && clip.duration() <= LONGEST_CLIP
        };
        let known = clips
            .iter()
            .enumerate()
            .filter(|(index, clip)| is_first(*index, clip));
        let known: Vec<(&Clip, Vec<String>)> =
            known.map(|(_, clip)| (clip, words(&clip.name))).collect();
        let is_act = |words: &[String]| words.iter().any(|word| ACT_WORDS.contains(&word.as_str()));
        // The clip with the shortest name: longer names tell of something else that the clip does.
        let plainest = |wanted: &[&str], is_calm: bool| {
            wanted.iter().find_map(|word| {
                let fits = known.iter().filter(|(clip, words)| {
                    // A standing clip may be a single pose.
                    let lasts = clip.duration() > 0.0 || is_calm && IDLE_WORDS.contains(word);
                    let is_named = words.iter().any(|own| own == word);
                    lasts && is_named && !(is_calm && is_act(words))
                });
                let plainest = fits.min_by_key(|(clip, _)| clip.name.len());
                plainest.map(|(clip, _)| clip.name.clone())
            })
        };
        let calm = known
            .iter()
            .find(|(clip, words)| clip.duration() > 0.0 && !is_act(words));
        Self {
            idle: plainest(&IDLE_WORDS, true).or(calm.map(|(clip, _)| clip.name.clone())),
            walk: plainest(&WALK_WORDS, true),
            shake: plainest(&SHAKE_WORDS, false),
            attack: plainest(&ATTACK_WORDS, false),
            death: plainest(&DEATH_WORDS, false),
        }
    }
}

/// The words of a name in lower case: idle, hit and react for `Rhino|Idle_HitReact.001`. The part before the last `|`
/// names the armature.
pub(super) fn words(name: &str) -> Vec<String> {
    let name = name.rsplit('|').next().unwrap_or(name);
    let mut words: Vec<String> = Vec::new();
    let mut before: Option<char> = None;
    for letter in name.chars() {
        let goes_on = before.is_some_and(|before| {
            before.is_alphabetic() && !(before.is_lowercase() && letter.is_uppercase())
        });
        if letter.is_alphabetic() {
            if !goes_on {
                words.push(String::new());
            }
            if let Some(word) = words.last_mut() {
                word.extend(letter.to_lowercase());
            }
        }
        before = Some(letter);
    }
    words
}

#[cfg(test)]
mod tests {
    use clamber_animation::rig::{Channel, Interpolation, JointId, Keyframes};
    use glam::Vec3;

    use super::*;

    fn clip(name: &str, seconds: f32) -> Clip {
        let times = if seconds > 0.0 {
            vec![0.0, seconds]
        } else {
            vec![0.0]
        };
        let values = Keyframes::Translation(vec![Vec3::ZERO; times.len()]);
        let channel = Channel::new(JointId(0), Interpolation::Linear, times, values).unwrap();
        Clip::new(name, vec![channel])
    }

    fn found(names: &[(&str, f32)]) -> [Option<String>; 5] {
        let clips: Vec<Clip> = names
            .iter()
            .map(|(name, seconds)| clip(name, *seconds))
            .collect();
        let Clips {
            idle,
            walk,
            shake,
            attack,
            death,
        } = Clips::of(&clips);
        [idle, walk, shake, attack, death]
    }

    fn wanted(names: [&str; 5]) -> [Option<String>; 5] {
        names.map(|name| (!name.is_empty()).then(|| name.to_owned()))
    }

    #[test]
    fn names_are_words() {
        assert_eq!(words("Rhino|Idle_HitReact.001"), ["idle", "hit", "react"]);
        assert_eq!(words("fanRunning"), ["fan", "running"]);
        assert_eq!(words("1_idle"), ["idle"]);
        assert_eq!(words("A|b|"), Vec::<String>::new());
        assert_eq!(words("ATTACK"), ["attack"]);
    }

    #[test]
    fn words_within_words_mean_nothing() {
        // `White` contains `hit`, `Soldier` `die`, `Undead` `dead`, `Trunk` `run`, and `ArmatureAction` `react`.
        let all = found(&[("WhiteRhino|Idle", 1.0), ("WhiteRhino|Walk", 1.0)]);
        assert_eq!(
            all,
            wanted(["WhiteRhino|Idle", "WhiteRhino|Walk", "", "", ""])
        );
        let all = found(&[
            ("Soldier|Idle", 1.0),
            ("Soldier_Run", 1.0),
            ("Undead_Roar", 1.0),
        ]);
        assert_eq!(
            all,
            wanted(["Soldier|Idle", "Soldier_Run", "Undead_Roar", "", ""])
        );
        assert_eq!(
            found(&[("Trunk_Swing", 1.0)]),
            wanted(["Trunk_Swing", "", "", "", ""])
        );
        assert_eq!(
            found(&[("ArmatureAction", 1.0)]),
            wanted(["ArmatureAction", "", "", "", ""])
        );
    }

    #[test]
    fn nobody_idles_by_dying_or_attacking() {
        let all = found(&[
            ("Attack", 1.0),
            ("Death", 1.0),
            ("Walk", 1.0),
            ("Idle", 0.0),
        ]);
        assert_eq!(all, wanted(["Idle", "Walk", "Attack", "Attack", "Death"]));
        let all = found(&[("Stand_Die", 1.0), ("Attack", 1.0)]);
        assert_eq!(all, wanted(["", "", "Attack", "Attack", "Stand_Die"]));
        let all = found(&[("Swimming_Fast", 1.0), ("Swimming_Normal", 1.0)]);
        assert_eq!(all[0].as_deref(), Some("Swimming_Normal"));
    }

    #[test]
    fn clips_without_end_and_second_ones_of_a_name_are_none() {
        assert_eq!(
            found(&[("Idle", 1e9), ("Attack", 1e9)]),
            wanted(["", "", "", "", ""])
        );
        assert_eq!(
            found(&[("Jump", 0.0), ("Jump", 1.0)]),
            wanted(["", "", "", "", ""])
        );
    }
}
