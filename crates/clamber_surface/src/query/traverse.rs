//! The one way down the hierarchy.

use super::broad::LaneMask;
use crate::mesh::hierarchy::{Child, Hierarchy, LANES, STACK};

/// Descends from all roots to the clusters that a query may find something in.
///
/// `bounds` says of a node, given the key that still matters, which of its children may matter, and per child at most
/// the key of what it holds: a distance, a time; what is beyond the limit is passed over. `leaf` looks at a cluster and
/// gives the key that still matters, or none to end the search. With `NEAREST_FIRST` children of smaller keys are
/// visited before others, which brings the limit down soon; without, in any order.
pub(super) fn traverse<const NEAREST_FIRST: bool>(
    hierarchy: &Hierarchy,
    mut limit: f64,
    mut bounds: impl FnMut(u32, f64) -> (LaneMask, [f32; LANES]),
    leaf: &mut dyn FnMut(u32, f64) -> Option<f64>,
) {
    // Nodes and clusters still to be visited, with their keys where those matter; a mesh whose hierarchy asks for more
    // room was not built. No struct: the count stays in a register so, and keys that nobody reads cost nothing.
    let (mut children, mut keys) = ([0; STACK], [0.0f32; STACK]);
    for root in std::iter::once(0).chain(hierarchy.further_roots()) {
        children[0] = Child::Node(root).packed();
        if NEAREST_FIRST {
            keys[0] = 0.0;
        }
        let mut count = 1;
        while count > 0 {
            count -= 1;
            // What is as far as the best one stays: it may have a smaller id.
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
                    // Below those of smaller keys, which are visited before it.
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
