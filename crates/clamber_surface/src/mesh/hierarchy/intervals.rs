//! Weight intervals: how much each joint moves the vertices of a set.

use super::super::{Influence, WEIGHT_ONE, normalize};
use crate::rig::JointId;

/// How much one joint moves the vertices of a node. All weights are multiples of 2^-24, so the
/// differences below are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeightInterval {
    /// The joint; it moves at least one vertex of the node.
    pub joint: JointId,
    /// Its smallest weight over the node's vertices; 0 if there is a vertex that it does not move.
    pub low: f32,
    /// Its largest weight.
    pub high: f32,
    /// Near the middle; those of a node add up to exactly 1.
    pub middle: f32,
    /// The most by which a weight differs from `middle`.
    pub deviation: f32,
}

/// Joint, smallest and largest weight over a set of vertices.
pub(crate) type Range = (JointId, f32, f32);

/// Intervals from the ranges of a set's joints, ascending; `None` without any.
pub(crate) fn intervals(ranges: &[Range]) -> Option<Vec<WeightInterval>> {
    // Twice the middles. Their rounding does not matter, the sum of the integers they become does.
    let middles: Vec<Influence> = ranges
        .iter()
        .map(|&(joint, low, high)| Influence {
            joint,
            weight: low + high,
        })
        .collect();
    // Without those of the joints whose middle is 0.
    let mut middles = normalize(&middles)?.into_iter().peekable();
    let interval = |&(joint, low, high): &Range| {
        let units = middles.next_if(|(other, _)| *other == joint);
        let middle = units.map_or(0, |(_, units)| units) as f32 / WEIGHT_ONE as f32;
        WeightInterval {
            joint,
            low,
            high,
            middle,
            deviation: (high - middle).max(middle - low),
        }
    };
    Some(ranges.iter().map(interval).collect())
}

/// The ranges of the union of sets: where a set is not moved by a joint, its weight is 0 there.
pub(super) fn union<'a>(sets: impl ExactSizeIterator<Item = &'a [Range]>) -> Vec<Range> {
    let count = sets.len();
    let mut all: Vec<Range> = sets.flatten().copied().collect();
    // Stable, though the order within a joint does not matter.
    all.sort_by_key(|(joint, ..)| *joint);
    let of_joint = |ranges: &[Range]| {
        let lows = ranges.iter().map(|(_, low, _)| *low);
        let highs = ranges.iter().map(|(_, _, high)| *high);
        let low = if ranges.len() < count {
            0.0
        } else {
            lows.fold(1.0, f32::min)
        };
        (ranges[0].0, low, highs.fold(0.0, f32::max))
    };
    all.chunk_by(|a, b| a.0 == b.0).map(of_joint).collect()
}
