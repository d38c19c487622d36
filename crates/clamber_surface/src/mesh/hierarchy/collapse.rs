//! Collapses the binary tree into nodes of up to eight children.
//!
//! A node costs the area of its bound. Dynamic programming from the leaves up finds the cheapest choice of children
//! (Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
//! section 3.1).
//!
//! Every node replaces at least two levels of the binary tree, so the hierarchy is at most half as deep as that
//! tree: at most `log2(triangles) + 2` nodes on a path. A traversal that pops a node and pushes its children holds
//! at most seven entries per level, and 7 * 34 + 1 < 256.

use super::LANES;
use crate::mesh::clusters::tree::{Branch, Tree};

/// The costs of every fork in each form that it can take in the hierarchy.
pub(super) struct Collapse<'a> {
    tree: &'a Tree,
    forks: Vec<Costs>,
}

/// The costs of one fork, including the nodes below it.
#[derive(Clone, Copy)]
struct Costs {
    /// The cost as a node: one child of another node.
    node: f32,
    /// At index `i`: the cost when opened, so that it becomes at most `i` children.
    opened: [f32; LANES + 1],
}

/// The forms that a branch can take in the hierarchy.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    /// A node, or opened.
    Any,
    /// Not a node: a cluster, or the sides of a fork.
    Opened,
}

impl<'a> Collapse<'a> {
    pub(super) fn of(tree: &'a Tree) -> Self {
        let mut collapse = Self {
            tree,
            forks: Vec::with_capacity(tree.forks.len()),
        };
        // The area of every fork, which the fork above it holds.
        let mut areas = vec![0.0; tree.forks.len()];
        for fork in &tree.forks {
            for (side, area) in core::iter::zip(fork.sides, fork.areas) {
                if let Branch::Fork(index) = side {
                    areas[index as usize] = area;
                }
            }
        }
        // Forks come after the forks below them.
        for (fork, area) in core::iter::zip(&tree.forks, areas) {
            let (_, inside) = collapse.divide(fork.sides, LANES, Form::Opened);
            let mut opened = [f32::INFINITY; LANES + 1];
            for (lanes, cost) in opened.iter_mut().enumerate().skip(2) {
                *cost = collapse.divide(fork.sides, lanes, Form::Any).1;
            }
            collapse.forks.push(Costs {
                node: area + inside,
                opened,
            });
        }
        collapse
    }

    /// The children of the node that a branch becomes, from left to right: up to eight.
    pub(super) fn lanes(&self, branch: Branch) -> Vec<Branch> {
        let mut lanes = Vec::with_capacity(LANES);
        match branch {
            Branch::Leaf(_) => lanes.push(branch),
            Branch::Fork(fork) => {
                let sides = self.tree.forks[fork as usize].sides;
                self.expand_sides(sides, LANES, Form::Opened, &mut lanes);
            }
        }
        lanes
    }

    fn expand_sides(&self, sides: [Branch; 2], lanes: usize, form: Form, out: &mut Vec<Branch>) {
        let (left, _) = self.divide(sides, lanes, form);
        self.expand(sides[0], left, form, out);
        self.expand(sides[1], lanes - left, form, out);
    }

    fn expand(&self, branch: Branch, lanes: usize, form: Form, out: &mut Vec<Branch>) {
        match branch {
            Branch::Fork(fork) if form == Form::Opened || self.opens(fork, lanes) => {
                let sides = self.tree.forks[fork as usize].sides;
                self.expand_sides(sides, lanes, Form::Any, out);
            }
            _ => out.push(branch),
        }
    }

    fn opens(&self, fork: u32, lanes: usize) -> bool {
        let costs = &self.forks[fork as usize];
        costs.opened[lanes] < costs.node
    }

    /// The cheapest split of `lanes` between two sides: the number of lanes for the left side, and the cost of both
    /// sides.
    fn divide(&self, sides: [Branch; 2], lanes: usize, form: Form) -> (usize, f32) {
        let cost =
            |left: usize| self.cost(sides[0], left, form) + self.cost(sides[1], lanes - left, form);
        let ways = (1..lanes).map(|left| (left, cost(left)));
        // On a tie, the first one.
        let cheapest = ways.min_by(|a, b| a.1.total_cmp(&b.1));
        cheapest.unwrap_or((0, f32::INFINITY))
    }

    fn cost(&self, branch: Branch, lanes: usize, form: Form) -> f32 {
        match branch {
            // Free, because every hierarchy contains every cluster.
            Branch::Leaf(_) => 0.0,
            Branch::Fork(fork) => {
                let costs = &self.forks[fork as usize];
                match form {
                    Form::Opened => costs.opened[lanes],
                    Form::Any => costs.opened[lanes].min(costs.node),
                }
            }
        }
    }
}
