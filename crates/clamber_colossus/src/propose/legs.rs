//! Finds the legs of a creature: chains of joints whose last one moves skin on the ground.

use std::collections::{BTreeMap, BTreeSet};

use clamber_animation::rig::JointId;

use super::look::Look;
use crate::kind::LegFile;

/// Skin that is no higher above the lowest than this share of the height stands on the ground. A joint whose skin is
/// nearer to the middle of the creature than `MIDDLE` heights is no foot.
const LOW: f64 = 0.04;
const MIDDLE: f64 = 0.01;

/// An ankle is no higher above the lowest skin than this share of the height.
const ANKLE: f64 = 0.15;

/// Skin of a foot that hangs elsewhere is no further from its leg's than this share of the height.
const NEAR: f64 = 0.1;

/// A joint at the top of a leg that moves less than `LIGHT` of the leg's skin, and is nearer to the middle than `INNER`
/// of how far the next one is, holds the leg at the body and is no part of it.
const LIGHT: f64 = 0.15;
const INNER: f64 = 0.75;

/// Feet of a pair differ by no more heights than this in how far aside they are. Of several that may be a pair the most
/// alike are; how far one is before the other counts only this share of other distances, as they may be in a stride.
const ASIDE: f64 = 0.1;
const STRIDE: f64 = 0.3;

/// The most joints of a leg.
const MOST: usize = 5;

/// What has more ends on the ground than this stands on none of them. Gaps between pieces of skin are measured up to so
/// many pairs of vertices.
const MOST_LEGS: usize = 64;
const MOST_PAIRS: usize = 4_000_000;

/// A leg under construction.
struct Found {
    foot: JointId,
    toe: Option<JointId>,
    /// The lowest joint of the chain that carries the foot: the foot itself, or, if that hangs elsewhere, the joint whose
    /// skin is nearest to its skin.
    base: JointId,
}

/// The legs that a creature seems to have.
pub(super) fn find(look: &Look<'_>) -> Vec<LegFile> {
    let mut found = feet(look);
    // Feet that hang elsewhere are carried by what would be feet without them.
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

/// The legs of which there is one on either side: a tail that lies on the ground is no leg.
fn paired(look: &Look<'_>, mut found: Vec<Found>) -> Vec<Found> {
    let place = |leg: &Found| look.place(leg.foot);
    let mut pairs = Vec::new();
    for (index, left) in found.iter().enumerate() {
        for (other, right) in found.iter().enumerate().skip(index + 1) {
            let (a, b) = (place(left), place(right));
            let aside = (a.x + b.x).abs();
            if a.x * b.x < 0.0 && aside < ASIDE * look.height {
                // They may be in the middle of a stride.
                pairs.push((
                    aside + (a.y - b.y).abs() + STRIDE * (a.z - b.z).abs(),
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

/// All that may be feet.
fn feet(look: &Look<'_>) -> Vec<Found> {
    let is_low = |joint: &JointId| {
        let heights = look.skin(*joint).iter().map(|place| place.y);
        let aside = look.skin(*joint).iter().map(|place| place.x).sum::<f64>();
        let aside = aside / look.skin(*joint).len().max(1) as f64;
        let lowest = heights.fold(f64::INFINITY, f64::min);
        lowest < look.low + LOW * look.height && aside.abs() > MIDDLE * look.height
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
    // From the end up to the ankle.
    let mut feet: BTreeMap<JointId, Vec<JointId>> = BTreeMap::new();
    for end in &ends {
        let is_foot = |joint: &JointId| {
            !look.skin(*joint).is_empty()
                && look.place(*joint).y < look.low + ANKLE * look.height
                && is_aside(look, *joint)
        };
        let path: Vec<JointId> = look.upward(*end).skip(1).take_while(is_foot).collect();
        let foot = path.last().copied().unwrap_or(*end);
        let toe = look.upward(*end).take_while(|joint| *joint != foot).last();
        feet.entry(foot).or_default().extend(toe);
    }
    let all: BTreeSet<JointId> = feet.keys().copied().collect();
    let found = feet.iter().map(|(foot, toes)| {
        // A foot hangs in its leg, unless other feet hang from the same joint: then it is a control below the root.
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

/// True if a joint is not in the middle of the creature.
fn is_aside(look: &Look<'_>, joint: JointId) -> bool {
    look.place(joint).x.abs() > MIDDLE * look.height
}

/// Of the joints on the same side that are neither feet nor below this one, the one whose skin hangs together with its
/// skin most; where the foot is a piece of its own, the one whose skin comes nearest. `None` if that is not near.
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
    let near = (NEAR * look.height) * (NEAR * look.height);
    let gaps = others
        .map(|joint| (gap(joint), joint))
        .filter(|(gap, _)| *gap < near);
    gaps.min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, joint)| joint)
}

/// Takes joints from the top of a leg that only hold it at the body.
fn trim(look: &Look<'_>, chain: &mut Vec<JointId>) {
    let count = |joint: &JointId| look.skin(*joint).len() as f64;
    let all: f64 = chain.iter().map(count).sum();
    let aside = |joint: JointId| look.place(joint).x.abs();
    while let [top, next, _, ..] = chain[..] {
        let is_light = count(&top) < LIGHT * all && aside(top) < INNER * aside(next);
        if !(is_light || chain.len() > MOST) {
            break;
        }
        chain.remove(0);
    }
}
