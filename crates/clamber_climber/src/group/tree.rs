//! A tree of boxes around bodies, made anew in each tick.

use glam::DVec3;

/// Number of bodies up to which a box is not divided.
const LEAF: usize = 4;

/// Rounding error of a comparison of distances in f64, as a fraction of the distances.
const SLACK: f64 = 1e-12;

/// Boxes around balls, halved along their longest side: a bounding volume hierarchy (Ericson 2005, *Real-Time Collision
/// Detection*, 6.2).
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    /// Indices of the balls, so that each node has a range of them.
    order: Vec<u32>,
    /// Each node is followed by its first half and all that is in it, then by its second half.
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// Index of the first node after all that is in this one.
    next: u32,
    /// The range of its balls in `order`; empty for a node with halves.
    balls: [u32; 2],
}

impl Tree {
    /// Makes the tree of balls, each with its centre and radius.
    pub(super) fn build(&mut self, balls: &[(DVec3, f64)]) {
        self.nodes.clear();
        let mut order = std::mem::take(&mut self.order);
        order.clear();
        order.extend(0..balls.len() as u32);
        if !order.is_empty() {
            self.divide(balls, &mut order, 0);
        }
        self.order = order;
    }

    /// Adds the node of some balls, the first of which is at `start` in the order of all.
    fn divide(&mut self, balls: &[(DVec3, f64)], order: &mut [u32], start: u32) {
        let around = |(low, high): (DVec3, DVec3), index: &u32| {
            let (center, radius) = balls[*index as usize];
            (low.min(center - radius), high.max(center + radius))
        };
        let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = order.iter().fold(nothing, around);
        let node = self.nodes.len();
        let is_leaf = order.len() <= LEAF;
        let end = if is_leaf {
            start + order.len() as u32
        } else {
            start
        };
        self.nodes.push(Node {
            low,
            high,
            next: 0,
            balls: [start, end],
        });
        if !is_leaf {
            let axis = (high - low).max_position();
            let half = order.len() / 2;
            let along = |index: &u32| balls[*index as usize].0[axis];
            order.select_nth_unstable_by(half, |a, b| along(a).total_cmp(&along(b)).then(a.cmp(b)));
            let (first, second) = order.split_at_mut(half);
            self.divide(balls, first, start);
            self.divide(balls, second, start + half as u32);
        }
        self.nodes[node].next = self.nodes.len() as u32;
    }

    /// Calls `visit` with the indices of the balls that meet another ball, and possibly of others near it.
    pub(super) fn near(&self, center: DVec3, radius: f64, mut visit: impl FnMut(usize)) {
        let mut index = 0;
        while let Some(node) = self.nodes.get(index) {
            let apart = center.clamp(node.low, node.high).distance(center);
            if apart > radius + SLACK * (radius + center.length()) {
                index = node.next as usize;
                continue;
            }
            let [from, to] = node.balls.map(|ball| ball as usize);
            for ball in &self.order[from..to] {
                visit(*ball as usize);
            }
            index += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_finds_what_a_list_finds() {
        let mut random = fastrand::Rng::with_seed(5);
        let mut tree = Tree::default();
        for count in [0, 1, 2, 5, 8, 9, 100, 1000] {
            let mut place =
                |size: f64| DVec3::from_array(std::array::from_fn(|_| (random.f64() - 0.5) * size));
            // Some are at one place.
            let balls: Vec<(DVec3, f64)> = (0..count)
                .map(|index| {
                    let at = if index % 7 == 0 {
                        DVec3::ONE
                    } else {
                        place(50.0)
                    };
                    (at, place(1.0).x.abs())
                })
                .collect();
            tree.build(&balls);
            for radius in [0.0, 0.5, 5.0, 200.0] {
                let center = place(60.0);
                let mut found = Vec::new();
                tree.near(center, radius, |index| found.push(index));
                found.sort_unstable();
                assert!(found.is_sorted_by(|a, b| a < b), "one twice: {found:?}");
                for (index, (at, size)) in balls.iter().enumerate() {
                    if at.distance(center) <= radius + size {
                        assert!(found.contains(&index), "{count}, {radius}: {index}");
                    }
                }
                // Boxes are small: 1,000 balls make boxes of some 8 m.
                let is_far = |index: &&usize| balls[**index].0.distance(center) > radius + 30.0;
                let far = found.iter().filter(is_far).count();
                assert!(far <= 20, "{far} of {count} are far away");
            }
        }
    }
}
