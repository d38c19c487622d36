//! Reads the body part, the side and the rank from a joint's name.

use super::Side;

/// A body part that a joint's name can mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    Shoulder,
    UpperArm,
    LowerArm,
    /// `arm` alone: the upper arm if there is a forearm, or a link of a numbered chain.
    Arm,
    Hand,
    Wrist,
    Palm,
    UpperLeg,
    LowerLeg,
    /// `leg` alone: the shin if there is a thigh, or a link of a numbered chain.
    Leg,
    Foot,
    Toes,
    Head,
    Neck,
    Spine,
}

/// The meaning of a joint's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Meaning {
    pub(super) part: Part,
    pub(super) side: Option<Side>,
    /// Order of preference, lower is better: 0 for a deforming joint (`def`), 1 for a plain one, 2 for one that only
    /// steers a joint (`org`).
    pub(super) rank: u8,
}

/// Words that are ignored in names.
const IGNORED_WORDS: [&str; 18] = [
    "armature",
    "b",
    "base",
    "bip",
    "bone",
    "c",
    "cc",
    "character",
    "def",
    "j",
    "jnt",
    "joint",
    "mixamorig",
    "org",
    "rig",
    "root",
    "skeleton",
    "valve",
];

/// Words that exclude a joint from the body: such joints twist, steer or hold something.
const EXCLUDING_WORDS: [&str; 22] = [
    "control", "ctrl", "end", "fk", "helper", "ik", "item", "mch", "nub", "orient", "parent",
    "pole", "roll", "slot", "socket", "target", "tip", "tracker", "tweak", "twist", "vis",
    "weapon",
];

/// Each part with the names that mean it. A name is compared without ignored words, sides, digits and separators.
const PART_NAMES: [(Part, &[&str]); 15] = [
    (
        Part::Shoulder,
        &["shoulder", "clavicle", "collar", "collarbone"],
    ),
    (Part::UpperArm, &["upperarm", "uparm", "armupper"]),
    (
        Part::LowerArm,
        &["lowerarm", "forearm", "lowarm", "armlower", "elbow"],
    ),
    (Part::Arm, &["arm"]),
    (Part::Hand, &["hand"]),
    (Part::Wrist, &["wrist"]),
    (
        Part::Palm,
        &["palm", "palmi", "palmm", "palmp", "palmr", "palmt"],
    ),
    (Part::UpperLeg, &["upperleg", "upleg", "thigh", "legupper"]),
    (
        Part::LowerLeg,
        &["lowerleg", "shin", "calf", "lowleg", "leglower", "knee"],
    ),
    (Part::Leg, &["leg"]),
    (Part::Foot, &["foot", "ankle"]),
    (Part::Toes, &["toe", "toes", "toebase", "ball"]),
    (Part::Head, &["head"]),
    (Part::Neck, &["neck"]),
    (
        Part::Spine,
        &[
            "spine",
            "chest",
            "torso",
            "abdomen",
            "waist",
            "upperchest",
            "body",
        ],
    ),
];

impl Meaning {
    /// The meaning of a name; `None` if the joint is not part of a body.
    pub(super) fn of(name: &str) -> Option<Self> {
        // Drops the name of an armature or a namespace.
        let name = name.rsplit([':', '|']).next().unwrap_or(name);
        let words = words(name);
        if words
            .iter()
            .any(|word| EXCLUDING_WORDS.contains(&word.as_str()))
        {
            return None;
        }
        let rank = match words.first().map(String::as_str) {
            Some("def") => 0,
            Some("org") => 2,
            _ => 1,
        };
        let mut side = None;
        let mut rest = String::new();
        for word in &words {
            match word.as_str() {
                "l" | "left" => side = Some(Side::Left),
                "r" | "right" => side = Some(Side::Right),
                word if IGNORED_WORDS.contains(&word) => {}
                word => rest += word,
            }
        }
        let is = |(_, names): &&(Part, &[&str])| names.contains(&rest.as_str());
        let part = PART_NAMES.iter().find(is)?.0;
        Some(Self { part, side, rank })
    }
}

/// Splits a name into lower-case words: at each character that is no letter, and before a capital that follows a
/// lower-case letter. Digits are left out.
pub(super) fn words(name: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word = String::new();
    let mut before = ' ';
    for letter in name.chars() {
        let starts = letter.is_uppercase() && before.is_lowercase();
        if (starts || !letter.is_alphabetic()) && !word.is_empty() {
            words.push(core::mem::take(&mut word));
        }
        if letter.is_alphabetic() {
            word.extend(letter.to_lowercase());
        }
        before = letter;
    }
    if !word.is_empty() {
        words.push(word);
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_many_tools_are_understood() {
        use Side::{Left, Right};
        for (name, part, side) in [
            ("mixamorig:LeftUpLeg", Part::UpperLeg, Some(Left)),
            ("mixamorig1:RightForeArm", Part::LowerArm, Some(Right)),
            ("mixamorig:LeftArm", Part::Arm, Some(Left)),
            ("mixamorig:LeftToeBase", Part::Toes, Some(Left)),
            ("DEF-upper_arm.L", Part::UpperArm, Some(Left)),
            ("DEF-shin.R.001", Part::LowerLeg, Some(Right)),
            ("UpperLeg.L", Part::UpperLeg, Some(Left)),
            ("upperarm.r", Part::UpperArm, Some(Right)),
            ("J_Bip_L_LowerLeg", Part::LowerLeg, Some(Left)),
            ("J_Bip_C_Neck", Part::Neck, None),
            ("clavicle_l", Part::Shoulder, Some(Left)),
            ("calf_r", Part::LowerLeg, Some(Right)),
            ("ball_l", Part::Toes, Some(Left)),
            ("Bip001 R UpperArm", Part::UpperArm, Some(Right)),
            ("LeftLowerLeg", Part::LowerLeg, Some(Left)),
            ("CC_Base_L_Thigh", Part::UpperLeg, Some(Left)),
            ("l-forearm", Part::LowerArm, Some(Left)),
            ("Skeleton_arm_joint_L__4_", Part::Arm, Some(Left)),
            ("leg_joint_R_1", Part::Leg, Some(Right)),
            ("Armature|Head", Part::Head, None),
            ("DEF-spine.006", Part::Spine, None),
        ] {
            let meaning = Meaning::of(name).map(|meaning| (meaning.part, meaning.side));
            assert_eq!(meaning, Some((part, side)), "{name}");
        }
        for other in [
            "upperarm_twist_01_l",
            "PoleTarget.L",
            "handslot.l",
            "socket_hand_L",
            "thigh_ik.L",
            "Weapon",
            "Bone.003",
            "headtracker",
            "r-LEGCONTROL",
            "",
            "PT.L",
            "HeadTop_End",
            "Pinky1.L",
        ] {
            assert_eq!(Meaning::of(other), None, "{other}");
        }
    }
}
