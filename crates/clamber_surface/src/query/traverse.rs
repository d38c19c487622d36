//! The traversal of the hierarchy that all queries share.

use super::broad::LaneMask;
use crate::mesh::hierarchy::{Child, Hierarchy, LANES, STACK};

/// Descends from all roots to the clusters in which a query may find something.
///
/// A key is a distance or a time, and `limit` is the largest key that still matters. `bounds` takes a node and the
/// limit. It returns which children of the node may matter, and for each child a lower bound of the keys of its
/// contents. `leaf` takes a cluster and the limit. It returns the new limit, or `None` to end the search. With
/// `NEAREST_FIRST`, children with smaller keys are visited first, which lowers the limit early, and children beyond the
/// limit are skipped. Without it, the order is arbitrary.
pub(super) fn traverse<const NEAREST_FIRST: bool>(
    hierarchy: &Hierarchy,
    mut limit: f64,
    mut bounds: impl FnMut(u32, f64) -> (LaneMask, [f32; LANES]),
    leaf: &mut dyn FnMut(u32, f64) -> Option<f64>,
) {
    // Nodes and clusters still to be visited, and with `NEAREST_FIRST` their keys. A mesh whose hierarchy needs a
    // larger stack cannot be built. Not a struct, so that the count stays in a register and unused keys cost nothing.
    let (mut children, mut keys) = ([0; STACK], [0.0f32; STACK]);
    for root in std::iter::once(0).chain(hierarchy.further_roots()) {
        children[0] = Child::Node(root).packed();
        if NEAREST_FIRST {
            keys[0] = 0.0;
        }
        let mut count = 1;
        while count > 0 {
            count -= 1;
            // A child at exactly the limit stays: it may hold a triangle with a smaller id.
            if NEAREST_FIRST && f64::from(keys[count]) > limit {
                continue;
            }
            let index = match Child::unpacked(children[count]) {
                Child::Node(index) => index,
                Child::Cluster(cluster) => match leaf(cluster, limit) {
                    Some(nearer) => {
                        limit = nearer;
                        continue;
                    }
                    None => return,
                },
            };
            let node = &hierarchy.nodes[index as usize];
            let (near, child_keys) = bounds(index, limit);
            let first = count;
            for lane in each_lane(near & node.lane_mask()) {
                let mut place = count;
                if NEAREST_FIRST {
                    // Below children with smaller keys, which are then visited first.
                    let key = child_keys[lane];
                    while place > first && keys[place - 1].total_cmp(&key).is_lt() {
                        keys[place] = keys[place - 1];
                        children[place] = children[place - 1];
                        place -= 1;
                    }
                    keys[place] = key;
                }
                children[place] = node.children[lane];
                count += 1;
            }
        }
    }
}

/// The set bits of a mask of lanes, ascending.
fn each_lane(mut mask: LaneMask) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}
