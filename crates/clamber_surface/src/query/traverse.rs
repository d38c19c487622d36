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
    mut leaf: impl FnMut(u32, f64) -> Option<f64>,
) {
    let mut stack = Stack::<NEAREST_FIRST>::new();
    for root in std::iter::once(0).chain(hierarchy.further_roots()) {
        stack.push((0.0, Child::Node(root).packed()));
        while let Some((key, child)) = stack.pop() {
            // What is as far as the best one stays: it may have a smaller id.
            if NEAREST_FIRST && f64::from(key) > limit {
                continue;
            }
            match Child::unpacked(child) {
                Child::Cluster(cluster) => match leaf(cluster, limit) {
                    Some(nearer) => limit = nearer,
                    None => return,
                },
                Child::Node(index) => {
                    let node = &hierarchy.nodes[index as usize];
                    let (near, keys) = bounds(index, limit);
                    let near = near & node.lane_mask();
                    let first = stack.count;
                    for lane in each_lane(near) {
                        let child = node.children[lane];
                        if NEAREST_FIRST {
                            stack.insert(first, (keys[lane], child));
                        } else {
                            stack.push((0.0, child));
                        }
                    }
                }
            }
        }
    }
}

/// Nodes and clusters still to be visited, with their keys where those matter. A mesh whose hierarchy asks for more
/// room was not built.
struct Stack<const WITH_KEYS: bool> {
    /// Two arrays: the compiler drops the keys where they are not read.
    keys: [f32; STACK],
    children: [u32; STACK],
    count: usize,
}

impl<const WITH_KEYS: bool> Stack<WITH_KEYS> {
    fn new() -> Self {
        Self {
            keys: [0.0; STACK],
            children: [0; STACK],
            count: 0,
        }
    }

    fn push(&mut self, (key, child): (f32, u32)) {
        self.keys[self.count] = key;
        self.children[self.count] = child;
        self.count += 1;
    }

    /// Pushes below the entries from `first` on that have smaller keys, which are so popped before it.
    fn insert(&mut self, first: usize, (key, child): (f32, u32)) {
        let mut place = self.count;
        while place > first && self.keys[place - 1].total_cmp(&key).is_lt() {
            self.keys[place] = self.keys[place - 1];
            self.children[place] = self.children[place - 1];
            place -= 1;
        }
        self.keys[place] = key;
        self.children[place] = child;
        self.count += 1;
    }

    fn pop(&mut self) -> Option<(f32, u32)> {
        self.count = self.count.checked_sub(1)?;
        let key = if WITH_KEYS {
            self.keys[self.count]
        } else {
            0.0
        };
        Some((key, self.children[self.count]))
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
