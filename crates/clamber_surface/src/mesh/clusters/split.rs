//! Cuts the triangles of a part in two, again and again, until every set fits a cluster.
//!
//! A set is cut across one of a few directions, or by the weight of a joint, at a place where both sides fill a
//! whole number of clusters nearly completely. The candidate with the cheapest sides wins. Large sets are judged by
//! a sample. Cutting n triangles costs O(n log n).

use core::ops::Range;

use glam::{DMat3, DVec3, Vec3};

use super::super::{PartId, TriangleId, VertexId};
use super::tree::{Branch, Fork, Leaf, Tree};
use super::{MAX_SLOTS, MAX_TRIANGLES};
use crate::geometry::widen;
use crate::mesh::summary::{Summarizer, Summary};

/// Target number of triangles of a cluster after the cuts. It is below [`MAX_TRIANGLES`], to leave room for
/// triangles that move when borders are straightened.
const WANTED_TRIANGLES: usize = 92;

/// Target for the most vertices of a cluster. It matters for meshes whose triangles share few vertices.
const WANTED_SLOTS: usize = 63;

/// The most triangles of a set that are examined to choose a cut. More gain little.
const SAMPLE: usize = 512;

/// Number of joints by whose weights a cut is tried: those with the widest spread of weights in the set.
const JOINT_CANDIDATES: usize = 2;

/// The value by which triangles are sorted.
#[derive(Clone, Copy, Debug)]
enum Order {
    Along(Vec3),
    Joint(u32),
}

/// Cuts parts; see the module docs.
pub(super) struct Splitter<'a> {
    pub(super) summarizer: Summarizer<'a>,
    pub(super) tree: Tree,
    /// Per triangle, the sum of its three corners.
    centers: Vec<Vec3>,
    /// The triangles that are being cut, permuted by the cuts.
    triangles: Vec<u32>,
    /// Sort key in the upper half, triangle in the lower: ties go to the smaller triangle.
    keys: Vec<u64>,
    summary: Summary,
    /// Number of vertices of the sample on which a cut is judged.
    whole: usize,
    /// Maximum number of vertices of a leaf.
    pub(super) max_slots: usize,
}

/// A possible cut, judged on a sample.
struct Candidate {
    order: Order,
    cost: f32,
    areas: [f32; 2],
}

impl<'a> Splitter<'a> {
    pub(super) fn new(summarizer: Summarizer<'a>) -> Self {
        let mesh = summarizer.mesh;
        let positions = mesh.positions();
        let center = |corners: &[VertexId; 3]| {
            let [a, b, c] = corners.map(|v| positions[v.index()]);
            a + b + c
        };
        Self {
            centers: mesh.triangles().iter().map(center).collect(),
            summarizer,
            tree: Tree::default(),
            triangles: Vec::new(),
            keys: Vec::new(),
            summary: Summary::default(),
            whole: 1,
            max_slots: MAX_SLOTS,
        }
    }

    /// Cuts one part, which must have triangles, and appends its leaves.
    pub(super) fn part(&mut self, part: PartId) -> Branch {
        let triangles = &self.summarizer.mesh.parts()[part.index()].triangles;
        self.triangles.clear();
        self.triangles.extend(triangles.iter().map(|t| t.0));
        self.cut(0..triangles.len(), part)
    }

    /// Copies the tree `from` below `branch`, and cuts the leaves that have too many vertices.
    pub(super) fn recut(&mut self, from: &Tree, branch: Branch) -> Branch {
        match branch {
            Branch::Leaf(index) => {
                let leaf = &from.leaves[index as usize];
                self.triangles.clear();
                self.triangles.extend(leaf.triangles.iter().map(|t| t.0));
                self.cut(0..self.triangles.len(), leaf.part)
            }
            Branch::Fork(index) => {
                let fork = from.forks[index as usize];
                let sides = fork.sides.map(|side| self.recut(from, side));
                self.tree.forks.push(Fork { sides, ..fork });
                Branch::Fork(self.tree.forks.len() as u32 - 1)
            }
        }
    }

    fn cut(&mut self, range: Range<usize>, part: PartId) -> Branch {
        let count = range.len();
        let slots = self
            .summarizer
            .count_corners(self.triangles[range.clone()].iter().copied());
        if count <= MAX_TRIANGLES && slots <= self.max_slots {
            let triangles = self.triangles[range].iter().map(|t| TriangleId(*t));
            self.tree.leaves.push(Leaf {
                part,
                triangles: triangles.collect(),
            });
            return Branch::Leaf(self.tree.leaves.len() as u32 - 1);
        }
        let by_count = count.div_ceil(WANTED_TRIANGLES);
        let clusters = by_count.max(slots.div_ceil(WANTED_SLOTS)).clamp(2, count);
        let left = count * (clusters / 2) / clusters;
        let best = self.choose(range.clone(), left);
        self.order(range.clone(), 1, best.order, left);
        let chosen = self.keys.iter().map(|key| *key as u32);
        for (place, triangle) in self.triangles[range.clone()].iter_mut().zip(chosen) {
            *place = triangle;
        }
        let middle = range.start + left;
        let sides = [
            self.cut(range.start..middle, part),
            self.cut(middle..range.end, part),
        ];
        self.tree.forks.push(Fork {
            sides,
            areas: best.areas,
        });
        Branch::Fork(self.tree.forks.len() as u32 - 1)
    }

    /// The cheapest sort order for a cut after the first `left` triangles.
    fn choose(&mut self, range: Range<usize>, left: usize) -> Candidate {
        let count = range.len();
        let stride = count.div_ceil(SAMPLE);
        let sampled = count.div_ceil(stride);
        let cut = (sampled * left / count).clamp(1, sampled - 1);
        let mut best = Candidate {
            order: Order::Along(Vec3::X),
            cost: f32::INFINITY,
            areas: [0.0; 2],
        };
        for order in self.candidates(range.clone(), stride) {
            self.order(range.clone(), stride, order, cut);
            let mut areas = [0.0; 2];
            let (mut slots, mut cost) = (0, 0.0);
            let sides = [&self.keys[..cut], &self.keys[cut..]];
            for (keys, side_area) in sides.into_iter().zip(&mut areas) {
                let triangles = keys.iter().map(|key| *key as u32);
                self.summarizer.of_corners(triangles, &mut self.summary);
                *side_area = area(&self.summary);
                cost += keys.len() as f32 * *side_area;
                slots += self.summary.vertices;
            }
            cost *= copies_cost(slots as f32 / self.whole as f32);
            if cost < best.cost {
                best = Candidate { order, cost, areas };
            }
        }
        best
    }

    fn candidates(&mut self, range: Range<usize>, stride: usize) -> Vec<Order> {
        let triangles = self.triangles[range].iter().copied().step_by(stride);
        let mut orders = vec![
            Order::Along(Vec3::X),
            Order::Along(Vec3::Y),
            Order::Along(Vec3::Z),
        ];
        let centers = triangles.clone().map(|t| self.centers[t as usize]);
        orders.extend(principal_axes(centers).map(Order::Along));
        self.summarizer.of_corners(triangles, &mut self.summary);
        let vertices = self.summary.vertices;
        self.whole = vertices;
        let spans = self.summary.spans.iter();
        let mut spreads: Vec<_> = spans.map(|s| (s.spread(vertices), s.joint)).collect();
        spreads.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let varying = spreads.iter().filter(|(spread, _)| *spread > 0.0);
        orders.extend(varying.take(JOINT_CANDIDATES).map(|s| Order::Joint(s.1)));
        orders
    }

    /// Fills `keys` with every `stride`th triangle of a range, partitioned so that the first `left` in the sort
    /// order come first.
    fn order(&mut self, range: Range<usize>, stride: usize, order: Order, left: usize) {
        self.keys.clear();
        let (mesh, centers) = (self.summarizer.mesh, &self.centers);
        let triangles = self.triangles[range].iter().step_by(stride);
        let key = |t: &u32| {
            let value = match order {
                Order::Along(axis) => centers[*t as usize].dot(axis),
                Order::Joint(joint) => {
                    let weight = |v: VertexId| {
                        let mut influences = mesh.influences(v);
                        let found = influences.find(|(other, _)| other.0 == joint);
                        found.map_or(0.0, |(_, weight)| weight)
                    };
                    mesh.triangles()[*t as usize].into_iter().map(weight).sum()
                }
            };
            u64::from(ascending_bits(value)) << 32 | u64::from(*t)
        };
        self.keys.extend(triangles.map(key));
        self.keys.select_nth_unstable(left);
    }
}

/// Estimates how often queries reach a set: about the square of the radius of its bound by weight intervals (see
/// [`crate::bounds`]), as if every joint moved the set's centre one radius away.
pub(super) fn area(summary: &Summary) -> f32 {
    let spreads = summary.spans.iter().map(|s| s.spread(summary.vertices));
    let radius = summary.ball.radius * (1.0 + spreads.sum::<f32>());
    radius * radius
}

/// The cost factor of vertices that are stored on both sides of a cut: the tenth power of slots per vertex. With
/// powers below 5, 5 to 15 % more slots remain; powers from 5 on differ little.
fn copies_cost(ratio: f32) -> f32 {
    let second = ratio * ratio;
    let fourth = second * second;
    fourth * fourth * second
}

/// Maps a number to bits, so that comparing them as integers gives the order of `f32::total_cmp`.
pub(super) fn ascending_bits(x: f32) -> u32 {
    let bits = x.to_bits();
    if bits >> 31 == 0 {
        bits | 1 << 31
    } else {
        !bits
    }
}

/// The two directions in which points spread most, by power iteration on their covariance. They are approximate:
/// correctness does not depend on them.
pub(super) fn principal_axes(points: impl Iterator<Item = Vec3> + Clone) -> [Vec3; 2] {
    let sums = points.clone().map(|p| (widen(p), 1.0));
    let (sum, count) = sums.fold((DVec3::ZERO, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
    let mean = sum / f64::max(count, 1.0);
    let mut covariance = DMat3::ZERO;
    for p in points {
        let d = widen(p) - mean;
        covariance += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    }
    let first = dominant_direction(&covariance);
    let along = first.dot(covariance * first);
    let rest =
        covariance - DMat3::from_cols(first * first.x, first * first.y, first * first.z) * along;
    [first.as_vec3(), dominant_direction(&rest).as_vec3()]
}

fn dominant_direction(matrix: &DMat3) -> DVec3 {
    let mut direction = DVec3::new(1.0, 0.9, 0.8);
    for _ in 0..12 {
        let next = *matrix * direction;
        let size = next.abs().max_element();
        // Also taken for NaN.
        if !(size > 0.0 && size < f64::INFINITY) {
            return DVec3::X;
        }
        direction = next / size;
    }
    direction.normalize()
}
