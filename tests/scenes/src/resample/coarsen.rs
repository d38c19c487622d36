//! Fewer vertices: collapses the shortest edge again and again, as long as the surface stays a manifold.
//!
//! The edge's ends may have no common neighbours except the two opposite the edge (the link condition,
//! Dey et al. 1999), and no triangle may flip.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use glam::DVec3;

use super::{Edge, Pieces, Point, edge};

/// Smallest cosine between a triangle's normals before and after a collapse: about 70 degrees, so that
/// creases may close but no triangle flips.
const MIN_COSINE: f64 = 0.3;

struct Coarsening<'a> {
    pieces: &'a mut Pieces,
    /// The triangles of each point.
    around: Vec<BTreeSet<u32>>,
    /// How often each point has moved.
    moves: Vec<u32>,
}

pub(super) fn coarsen(pieces: &mut Pieces, vertices: usize) {
    let mut around = vec![BTreeSet::new(); pieces.points.len()];
    for (index, triangle) in pieces.triangles.iter().enumerate() {
        for corner in triangle.corners {
            around[corner as usize].insert(index as u32);
        }
    }
    let unused = around.iter().filter(|triangles| triangles.is_empty());
    let mut left = around.len() - unused.count();
    let mut coarsening = Coarsening {
        moves: vec![0; around.len()],
        around,
        pieces,
    };
    let mut queue = BinaryHeap::new();
    for point in 0..coarsening.around.len() as u32 {
        coarsening.push_edges(point, true, &mut queue);
    }
    while left > vertices {
        let Some(Reverse((_, ends, moves))) = queue.pop() else {
            break;
        };
        if moves == coarsening.moves_of(ends) && coarsening.collapse(ends) {
            left -= 1;
            coarsening.push_edges(ends[0], false, &mut queue);
        }
    }
    let alive: BTreeSet<u32> = coarsening.around.iter().flatten().copied().collect();
    let kept = alive.iter().map(|index| pieces.triangles[*index as usize]);
    pieces.triangles = kept.collect();
}

/// [`Pieces::length`] of an edge, the edge, and how often each end had moved by then. The shortest edge comes
/// first; ties go to the smaller edge.
type Queue = BinaryHeap<Reverse<(u64, Edge, [u32; 2])>>;

impl Coarsening<'_> {
    fn moves_of(&self, ends: Edge) -> [u32; 2] {
        ends.map(|end| self.moves[end as usize])
    }

    fn corners(&self, triangle: u32) -> [u32; 3] {
        self.pieces.triangles[triangle as usize].corners
    }

    fn neighbours(&self, point: u32) -> BTreeSet<u32> {
        let triangles = self.around[point as usize].iter();
        let all = triangles.flat_map(|triangle| self.corners(*triangle));
        all.filter(|corner| *corner != point).collect()
    }

    /// Puts the edges of a point into the queue; if `half`, only those to points with a greater index.
    fn push_edges(&self, point: u32, half: bool, queue: &mut Queue) {
        for neighbour in self.neighbours(point) {
            if !half || neighbour > point {
                let ends = edge(point, neighbour);
                let length = self.pieces.length(ends);
                queue.push(Reverse((length, ends, self.moves_of(ends))));
            }
        }
    }

    /// Collapses an edge into its first end, at its middle. Changes nothing and returns false if the surface
    /// would not stay a manifold, or a triangle would flip.
    fn collapse(&mut self, ends: Edge) -> bool {
        let [a, b] = ends.map(|end| end as usize);
        let shared = self.around[a].intersection(&self.around[b]);
        let shared: Vec<u32> = shared.copied().collect();
        let (of_a, of_b) = (self.neighbours(ends[0]), self.neighbours(ends[1]));
        if shared.len() != 2 || of_a.intersection(&of_b).count() != 2 {
            return false;
        }
        let middle = Point::between(&self.pieces.points[a], &self.pieces.points[b]);
        let mut touched = self.around[a].symmetric_difference(&self.around[b]);
        if touched.any(|triangle| self.turns(*triangle, ends, middle.position)) {
            return false;
        }
        for triangle in shared {
            for corner in self.corners(triangle) {
                self.around[corner as usize].remove(&triangle);
            }
        }
        for triangle in std::mem::take(&mut self.around[b]) {
            let corners = &mut self.pieces.triangles[triangle as usize].corners;
            for corner in corners.iter_mut().filter(|corner| **corner == ends[1]) {
                *corner = ends[0];
            }
            self.around[a].insert(triangle);
        }
        self.pieces.points[a] = middle;
        self.moves[a] += 1;
        self.moves[b] += 1;
        true
    }

    /// True if a triangle flips, or nearly, when both ends of an edge move to `middle`.
    fn turns(&self, triangle: u32, ends: Edge, middle: DVec3) -> bool {
        let corners = self.corners(triangle);
        let before = corners.map(|corner| self.pieces.points[corner as usize].position);
        let mut after = before;
        for (position, corner) in after.iter_mut().zip(corners) {
            if ends.contains(&corner) {
                *position = middle;
            }
        }
        let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
        let (before, after) = (normal(before), normal(after));
        before.dot(after) <= MIN_COSINE * before.length() * after.length()
    }
}
