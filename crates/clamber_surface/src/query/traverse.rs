//! The traversal of the hierarchy that all queries share.

use arrayvec::ArrayVec;

use super::broad::LaneMask;
use crate::geometry::round_up_to_f32;
use crate::mesh::hierarchy::{Child, Hierarchy, LANES, STACK};

/// Descends from all roots to the clusters in which a query may find something.
///
/// A key is a distance or a time, not negative, and `limit` is the largest key that still matters. `bounds` takes a
/// node and the limit, rounded up. It returns which children of the node may matter, and for each child a lower bound
/// of the keys of its contents. `leaf` takes a cluster and the limit. It returns the new limit, or `None` to end the
/// search. With `NEAREST_FIRST`, children with smaller keys are visited first, which lowers the limit early, and
/// children beyond the limit are skipped. Without it, the order is arbitrary.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn traverse<const NEAREST_FIRST: bool>(
    hierarchy: &Hierarchy,
    mut limit: f64,
    mut bounds: impl FnMut(u32, f32) -> (LaneMask, [f32; LANES]),
    mut leaf: impl FnMut(u32, f64) -> Option<f64>,
) {
    // Nodes and clusters still to be visited, in the lower half; in the upper half the bits of their keys, which are in
    // the order of the keys. A mesh whose hierarchy needs a larger stack cannot be built.
    let mut stack = ArrayVec::<u64, STACK>::new();
    let mut reach = round_up_to_f32(limit);
    for root in std::iter::once(0).chain(hierarchy.further_roots()) {
        stack.push(u64::from(Child::Node(root).packed()));
        while let Some(next) = stack.pop() {
            // A child at exactly the limit stays: it may hold a triangle with a smaller id.
            if NEAREST_FIRST && f32::from_bits((next >> 32) as u32) > reach {
                continue;
            }
            let index = match Child::unpacked(next as u32) {
                Child::Node(index) => index,
                Child::Cluster(cluster) => match leaf(cluster, limit) {
                    Some(nearer) => {
                        limit = nearer;
                        reach = round_up_to_f32(limit);
                        continue;
                    }
                    None => return,
                },
            };
            let node = &hierarchy.nodes[index as usize];
            let (near, keys) = bounds(index, reach);
            let first = stack.len();
            let mut lanes = near & node.lane_mask();
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                let mut child = u64::from(node.children[lane]);
                if NEAREST_FIRST {
                    child |= u64::from(keys[lane].to_bits()) << 32;
                }
                stack.push(child);
                if NEAREST_FIRST {
                    // Below children with smaller keys, which are then visited first.
                    let mut place = stack.len() - 1;
                    while place > first && stack[place - 1] < child {
                        stack.swap(place - 1, place);
                        place -= 1;
                    }
                }
            }
        }
    }
}
