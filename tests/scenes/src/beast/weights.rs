//! The beast's skin weights: which bones move a vertex, and how much.

use glam::DVec3;

use super::body::Bone;
use super::field::limb_distance;

/// A limb moves a vertex only if it is less than this farther away than the nearest limb, metres.
const REACH: f64 = 3.0;

/// A bone moves a vertex only if it is at most so many steps along the skeleton from the nearest bone, so
/// that legs do not pull on each other across the gap.
const STEPS: usize = 2;

/// Number of influences of a vertex.
const INFLUENCES: usize = 4;

/// Joints and weights of a vertex: the nearest bones, with weights that fall off smoothly, padded with
/// zeros. The weights are not normalised.
pub(super) fn weights(bones: &[Bone], p: DVec3) -> [(u32, f64); INFLUENCES] {
    let mut by_distance: Vec<(f64, usize)> = bones
        .iter()
        .enumerate()
        .map(|(joint, bone)| (limb_distance(bone, p), joint))
        .filter(|(distance, _)| distance.is_finite())
        .collect();
    by_distance.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let (nearest, first) = by_distance[0];
    let mut chosen = [(0, 0.0); INFLUENCES];
    let related = by_distance
        .iter()
        .filter(|(_, joint)| steps_apart(bones, first, *joint) <= STEPS);
    for (slot, (distance, joint)) in chosen.iter_mut().zip(related) {
        let share = (1.0 - (distance - nearest) / REACH).max(0.0);
        *slot = (*joint as u32, share * share);
    }
    chosen
}

/// Number of steps along the skeleton from one joint to another.
fn steps_apart(bones: &[Bone], a: usize, b: usize) -> usize {
    let ancestors = |joint: usize| std::iter::successors(Some(joint), |j| bones[*j].parent);
    ancestors(a)
        .enumerate()
        .find_map(|(up, joint)| {
            let down = ancestors(b).position(|other| other == joint)?;
            Some(up + down)
        })
        .unwrap_or(usize::MAX)
}
