//! Finds the legs of a creature: chains of joints that end in a joint with skin on the ground. A foot is detached if it
//! is not below its leg in the skeleton, like a control that was baked into the file.

use std::collections::{BTreeMap, BTreeSet};

use clamber_animation::rig::JointId;

use super::look::Look;
use crate::kind::LegFile;

/// Skin touches the ground if it is no higher above the lowest skin than this share of the creature's height.
const GROUND_SKIN_HEIGHT: f64 = 0.04;
/// A joint is no foot if the mean X of its skin is nearer to 0 than this share of the creature's height. [`is_aside`]
/// tests the joint's own X by it.
const MIDDLE_WIDTH: f64 = 0.01;

/// An ankle is no higher above the lowest skin than this share of the creature's height.
const MOST_ANKLE_HEIGHT: f64 = 0.15;

/// Largest gap between the skin of a detached foot and the skin of its leg, as a share of the creature's height.
const MOST_FOOT_GAP: f64 = 0.1;

/// The top joint of a leg is dropped if it moves less than this share of the leg's skin, and the condition of
/// [`INNER_JOINT_SHARE`] holds: it only connects the leg to the body.
const LIGHT_SKIN_SHARE: f64 = 0.15;
/// See [`LIGHT_SKIN_SHARE`]: the top joint is nearer to the plane X = 0 than this share of the next joint's distance.
const INNER_JOINT_SHARE: f64 = 0.75;

/// Largest difference between the distances of a pair's feet from the plane X = 0, as a share of the creature's height.
const MOST_PAIR_DIFFERENCE: f64 = 0.1;
/// Weight of the feet's distance along Z in the cost of a pair, against 1 for other distances: the feet may be in a
/// stride. Pairs of the least cost are taken first.
const STRIDE_WEIGHT: f64 = 0.3;

/// Most joints of a leg, the limit of [`LegFile::joints`].
const MOST_LEG_JOINTS: usize = 5;

/// Most ends of chains on the ground. A creature with more of them gets no legs.
const MOST_LEGS: usize = 64;
/// Most pairs of vertices between which gaps of skin are measured. This limits the time of a proposal.
const MOST_PAIRS: usize = 4_000_000;

/// A leg under construction.
struct Found {
    foot: JointId,
    toe: Option<JointId>,
    /// The lowest joint of the chain that carries the foot: the foot itself, or for a detached foot the joint whose
    /// skin is connected or nearest to the foot's skin.
    base: JointId,
}

/// The legs that a creature seems to have.
pub(super) fn find(look: &Look<'_>) -> Vec<LegFile> {
    let mut found = feet(look);
    // The joint that carries a detached foot may look like a foot itself. Such joints are removed.
    let carried: BTreeSet<JointId> = found
        .iter()
        .filter(|leg| leg.base != leg.foot)
        .flat_map(|leg| look.upward(leg.base))
        .collect();
    found.retain(|leg| leg.base != leg.foot || !carried.contains(&leg.foot));
    let found = paired(look, found);
    let mut below: BTreeMap<JointId, usize> = BTreeMap::new();
    for joint in found.iter().flat_map(|leg| look.upward(leg.base)) {
        *below.entry(joint).or_default() += 1;
    }
    let legs = found.iter().filter_map(|leg| {
        let own = look.upward(leg.base).take_while(|joint| below[joint] == 1);
        let mut chain: Vec<JointId> = own.collect();
        chain.reverse();
        if leg.base != leg.foot {
            chain.push(leg.foot);
        }
        trim(look, &mut chain);
        let name = |joint: &JointId| look.name(*joint).to_owned();
        let mut all = chain.iter().chain(&leg.toe);
        let is_named = all.all(|joint| look.is_named(*joint));
        (chain.len() > 1 && is_named).then(|| LegFile {
            joints: chain.iter().map(name).collect(),
            toe: leg.toe.as_ref().map(name),
            knee: None,
        })
    });
    legs.collect()
}

/// Keeps the feet that have a partner on the other side: a tail that lies on the ground is no leg.
fn paired(look: &Look<'_>, mut found: Vec<Found>) -> Vec<Found> {
    let place = |leg: &Found| look.place(leg.foot);
    let mut pairs = Vec::new();
    for (index, left) in found.iter().enumerate() {
        for (other, right) in found.iter().enumerate().skip(index + 1) {
            let (a, b) = (place(left), place(right));
            let aside = (a.x + b.x).abs();
            if a.x * b.x < 0.0 && aside < MOST_PAIR_DIFFERENCE * look.height {
                // The feet may be in the middle of a stride.
                pairs.push((
                    aside + (a.y - b.y).abs() + STRIDE_WEIGHT * (a.z - b.z).abs(),
                    index,
                    other,
                ));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept = BTreeSet::new();
    for (_, left, right) in pairs {
        if !kept.contains(&left) && !kept.contains(&right) {
            kept.extend([left, right]);
        }
    }
    let mut index = 0..;
    found.retain(|_| index.next().is_some_and(|index| kept.contains(&index)));
    found
}

/// All joints that may be feet.
fn feet(look: &Look<'_>) -> Vec<Found> {
    let is_low = |joint: &JointId| {
        let heights = look.skin(*joint).iter().map(|place| place.y);
        let aside = look.skin(*joint).iter().map(|place| place.x).sum::<f64>();
        let aside = aside / look.skin(*joint).len().max(1) as f64;
        let lowest = heights.fold(f64::INFINITY, f64::min);
        lowest < look.low + GROUND_SKIN_HEIGHT * look.height
            && aside.abs() > MIDDLE_WIDTH * look.height
    };
    let low: Vec<JointId> = look.joints().filter(is_low).collect();
    let above: BTreeSet<JointId> = low
        .iter()
        .flat_map(|joint| look.upward(*joint).skip(1))
        .collect();
    let ends: Vec<JointId> = low.into_iter().filter(|one| !above.contains(one)).collect();
    if ends.len() > MOST_LEGS {
        return Vec::new();
    }
    let mut passed: BTreeMap<JointId, usize> = BTreeMap::new();
    for joint in ends.iter().flat_map(|end| look.upward(*end)) {
        *passed.entry(joint).or_default() += 1;
    }
    // Joints from the end of the chain up to the ankle.
    let mut feet: BTreeMap<JointId, Vec<JointId>> = BTreeMap::new();
    for end in &ends {
        let is_foot = |joint: &JointId| {
            !look.skin(*joint).is_empty()
                && look.place(*joint).y < look.low + MOST_ANKLE_HEIGHT * look.height
                && is_aside(look, *joint)
        };
        let path: Vec<JointId> = look.upward(*end).skip(1).take_while(is_foot).collect();
        let foot = path.last().copied().unwrap_or(*end);
        let toe = look.upward(*end).take_while(|joint| *joint != foot).last();
        feet.entry(foot).or_default().extend(toe);
    }
    let all: BTreeSet<JointId> = feet.keys().copied().collect();
    let found = feet.iter().map(|(foot, toes)| {
        // A foot is part of its leg unless other feet hang from the same parent joint, too. Such a foot is a control
        // below the root, and detached.
        let is_held = look
            .parent(*foot)
            .is_some_and(|parent| passed.get(&parent) == Some(&1));
        Found {
            foot: *foot,
            toe: toes.first().copied().filter(|_| toes.len() == 1),
            base: if is_held {
                *foot
            } else {
                nearest(look, *foot, &all).unwrap_or(*foot)
            },
        }
    });
    found.collect()
}

/// True if a joint is further from the plane X = 0 than [`MIDDLE_WIDTH`].
fn is_aside(look: &Look<'_>, joint: JointId) -> bool {
    look.place(joint).x.abs() > MIDDLE_WIDTH * look.height
}

/// The joint that carries a detached foot, among joints with skin on the same side that are neither detached feet nor
/// below the foot: the joint that shares most triangles with the foot, or else the joint whose skin is nearest to the
/// foot's. `None` if no skin is near.
fn nearest(look: &Look<'_>, foot: JointId, feet: &BTreeSet<JointId>) -> Option<JointId> {
    let gap = |joint: JointId| {
        let of_foot = look.skin(foot).iter();
        let gaps = of_foot.flat_map(|a| look.skin(joint).iter().map(|b| a.distance_squared(*b)));
        gaps.fold(f64::INFINITY, f64::min)
    };
    let is_elsewhere = |joint: &JointId| {
        let is_below = look.upward(*joint).any(|above| above == foot);
        let same_side = look.place(*joint).x * look.place(foot).x > 0.0;
        let hangs = |foot: &JointId| {
            look.parent(*foot)
                .is_none_or(|parent| !is_aside(look, parent))
        };
        let is_foot = feet.contains(joint) && hangs(joint);
        !is_below && same_side && !is_foot && !look.skin(*joint).is_empty()
    };
    let together = look.neighbours(foot).into_iter();
    let together = together.filter(|(joint, _)| is_elsewhere(joint));
    if let Some((joint, _)) = together.max_by_key(|(_, triangles)| *triangles) {
        return Some(joint);
    }
    let vertices: usize = look.joints().map(|joint| look.skin(joint).len()).sum();
    if vertices.saturating_mul(look.skin(foot).len()) > MOST_PAIRS {
        return None;
    }
    let others = look.joints().filter(is_elsewhere);
    let near = (MOST_FOOT_GAP * look.height) * (MOST_FOOT_GAP * look.height);
    let gaps = others
        .map(|joint| (gap(joint), joint))
        .filter(|(gap, _)| *gap < near);
    gaps.min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, joint)| joint)
}

/// Removes joints from the top of a leg that only connect it to the body, and joints over [`MOST_LEG_JOINTS`].
fn trim(look: &Look<'_>, chain: &mut Vec<JointId>) {
    let count = |joint: &JointId| look.skin(*joint).len() as f64;
    let all: f64 = chain.iter().map(count).sum();
    let aside = |joint: JointId| look.place(joint).x.abs();
    while let [top, next, _, ..] = chain[..] {
        let is_light =
            count(&top) < LIGHT_SKIN_SHARE * all && aside(top) < INNER_JOINT_SHARE * aside(next);
        if !(is_light || chain.len() > MOST_LEG_JOINTS) {
            break;
        }
        chain.remove(0);
    }
}
