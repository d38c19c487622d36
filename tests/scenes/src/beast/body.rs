//! The beast's bones: their start and end at rest, metres, Y up, facing +Z.

use glam::DVec3;

/// A joint with the flesh around its bone.
pub(super) struct Bone {
    pub(super) name: String,
    pub(super) parent: Option<usize>,
    /// Position of the joint, where the bone starts.
    pub(super) at: DVec3,
    /// Position of the bone's end.
    pub(super) tip: DVec3,
    /// Radii of the flesh at the joint and at the tip; no flesh if both are zero.
    pub(super) radii: [f64; 2],
}

/// Name, parent's name, joint, tip, radii.
type Row = (&'static str, &'static str, [f64; 3], [f64; 3], [f64; 2]);

#[rustfmt::skip]
const TRUNK: [Row; 18] = [
    ("root",   "",       [0.0, 13.0, 0.0],   [0.0, 13.0, 0.0],   [0.0, 0.0]),
    ("pelvis", "root",   [0.0, 13.4, -6.2],  [0.0, 13.8, -4.0],  [3.2, 3.5]),
    ("spine1", "pelvis", [0.0, 13.8, -4.0],  [0.0, 14.2, -1.6],  [3.5, 3.6]),
    ("spine2", "spine1", [0.0, 14.2, -1.6],  [0.0, 14.4, 0.8],   [3.6, 3.7]),
    ("spine3", "spine2", [0.0, 14.4, 0.8],   [0.0, 14.5, 3.2],   [3.7, 3.9]),
    ("spine4", "spine3", [0.0, 14.5, 3.2],   [0.0, 14.6, 5.8],   [3.9, 3.7]),
    ("spine5", "spine4", [0.0, 14.6, 5.8],   [0.0, 15.4, 7.8],   [3.7, 2.8]),
    ("neck1",  "spine5", [0.0, 15.4, 7.8],   [0.0, 17.0, 9.6],   [2.6, 2.1]),
    ("neck2",  "neck1",  [0.0, 17.0, 9.6],   [0.0, 18.4, 11.2],  [2.1, 1.8]),
    ("neck3",  "neck2",  [0.0, 18.4, 11.2],  [0.0, 19.2, 12.6],  [1.8, 1.7]),
    ("head",   "neck3",  [0.0, 19.2, 12.6],  [0.0, 19.2, 15.2],  [1.7, 1.2]),
    ("jaw",    "head",   [0.0, 18.2, 12.9],  [0.0, 17.7, 15.0],  [0.9, 0.6]),
    ("tail1",  "pelvis", [0.0, 13.4, -6.2],  [0.0, 13.0, -9.0],  [2.8, 2.1]),
    ("tail2",  "tail1",  [0.0, 13.0, -9.0],  [0.0, 12.2, -11.4], [2.1, 1.7]),
    ("tail3",  "tail2",  [0.0, 12.2, -11.4], [0.0, 11.0, -13.6], [1.7, 1.4]),
    ("tail4",  "tail3",  [0.0, 11.0, -13.6], [0.0, 9.6, -15.6],  [1.4, 1.1]),
    ("tail5",  "tail4",  [0.0, 9.6, -15.6],  [0.0, 8.2, -17.6],  [1.1, 0.8]),
    ("tail6",  "tail5",  [0.0, 8.2, -17.6],  [0.0, 7.0, -19.8],  [0.8, 0.5]),
];

/// The legs of one side, at positive x; the other side mirrors them.
#[rustfmt::skip]
const LEGS: [Row; 10] = [
    ("scapula",  "spine4",   [1.8, 14.4, 5.6],  [3.2, 12.0, 5.6],  [2.4, 2.1]),
    ("arm",      "scapula",  [3.2, 12.0, 5.6],  [3.4, 7.2, 5.0],   [2.0, 1.4]),
    ("forearm",  "arm",      [3.4, 7.2, 5.0],   [3.4, 2.9, 5.6],   [1.35, 1.1]),
    ("wrist",    "forearm",  [3.4, 2.9, 5.6],   [3.4, 1.2, 6.1],   [1.15, 1.2]),
    ("forefoot", "wrist",    [3.4, 1.2, 6.1],   [3.4, 1.15, 7.4],  [1.2, 1.0]),
    ("hip",      "pelvis",   [1.8, 13.0, -6.0], [3.2, 11.2, -6.0], [2.6, 2.2]),
    ("thigh",    "hip",      [3.2, 11.2, -6.0], [3.4, 7.0, -4.9],  [2.1, 1.4]),
    ("shin",     "thigh",    [3.4, 7.0, -4.9],  [3.4, 3.0, -6.8],  [1.35, 1.1]),
    ("ankle",    "shin",     [3.4, 3.0, -6.8],  [3.4, 1.2, -6.2],  [1.1, 1.15]),
    ("hindfoot", "ankle",    [3.4, 1.2, -6.2],  [3.4, 1.15, -4.9], [1.15, 1.0]),
];

/// All bones, every parent before its children. Names of the legs' bones end in `.l` (positive x) or `.r`.
pub(super) fn bones() -> Vec<Bone> {
    let mut bones: Vec<Bone> = Vec::new();
    let mut push = |name: String, parent: &str, row: &Row, side: f64| {
        let mirror = DVec3::new(side, 1.0, 1.0);
        let bone = Bone {
            parent: bones.iter().position(|bone| bone.name == parent),
            name,
            at: DVec3::from_array(row.2) * mirror,
            tip: DVec3::from_array(row.3) * mirror,
            radii: row.4,
        };
        bones.push(bone);
    };
    for row in &TRUNK {
        push(row.0.to_owned(), row.1, row, 1.0);
    }
    for (suffix, side) in [(".l", 1.0), (".r", -1.0)] {
        for row in &LEGS {
            let on_trunk = TRUNK.iter().any(|bone| bone.0 == row.1);
            let parent = format!("{}{}", row.1, if on_trunk { "" } else { suffix });
            push(format!("{}{suffix}", row.0), &parent, row, side);
        }
    }
    bones
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parents_come_before_their_children() {
        let bones = bones();
        assert_eq!(bones.len(), 38);
        for (index, bone) in bones.iter().enumerate() {
            assert_eq!(bone.parent.is_none(), index == 0, "{}", bone.name);
            assert!(
                bone.parent.is_none_or(|parent| parent < index),
                "{}",
                bone.name
            );
        }
    }
}
