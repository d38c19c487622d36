//! Builds the upper levels of the tree: sets of whole parts, cut in two until one part is left.

use glam::Vec3;

use super::super::PartId;
use super::split::{Splitter, area, ascending_bits, principal_axes};
use super::tree::{Branch, Fork};
use crate::mesh::summary::Summary;

/// The smallest share of the triangles that either side of a cut gets. If one large part prevents this, the cut is made
/// beside that part, which then stands alone two cuts later. So the tree is at most `2 log2(triangles) + 2` deep.
const LEAST_SHARE: f64 = 0.3;

/// The most places per sort order at which a cut is tried.
const PLACES: usize = 8;

/// One part of a set.
struct Piece {
    part: PartId,
    triangles: usize,
    summary: Summary,
}

impl Splitter<'_> {
    /// Builds the tree of all parts that have triangles.
    pub(super) fn mesh(&mut self) {
        let parts = self.summarizer.mesh.parts().iter().enumerate();
        let filled = parts.filter(|(_, part)| !part.triangles.is_empty());
        let mut pieces = Vec::new();
        for (index, part) in filled {
            let mut summary = Summary::default();
            let triangles = part.triangles.iter().map(|t| t.0);
            self.summarizer.of_corners(triangles, &mut summary);
            pieces.push(Piece {
                part: PartId(index as u32),
                triangles: part.triangles.len(),
                summary,
            });
        }
        if !pieces.is_empty() {
            let mut pieces: Vec<&Piece> = pieces.iter().collect();
            self.tree.root = Some(self.cut_parts(&mut pieces));
        }
    }

    fn cut_parts(&mut self, pieces: &mut [&Piece]) -> Branch {
        if let [piece] = pieces {
            return self.part(piece.part);
        }
        let mut best = (f32::INFINITY, [0.0; 2], Vec3::X, 1);
        let centers = pieces.iter().map(|p| center(p));
        let [first, second] = principal_axes(centers);
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, first, second] {
            sort(pieces, axis);
            for place in places(pieces) {
                let (left, right) = pieces.split_at(place);
                let areas = [left, right].map(|side| self.area(side));
                let cost = areas[0] * triangles(left) + areas[1] * triangles(right);
                if cost < best.0 {
                    best = (cost, areas, axis, place);
                }
            }
        }
        let (_, areas, axis, place) = best;
        sort(pieces, axis);
        let (left, right) = pieces.split_at_mut(place);
        let sides = [self.cut_parts(left), self.cut_parts(right)];
        self.tree.forks.push(Fork { sides, areas });
        Branch::Fork(self.tree.forks.len() as u32 - 1)
    }

    fn area(&mut self, pieces: &[&Piece]) -> f32 {
        area(&self.summarizer.union(pieces.iter().map(|p| &p.summary)))
    }
}

fn triangles(pieces: &[&Piece]) -> f32 {
    pieces.iter().map(|p| p.triangles).sum::<usize>() as f32
}

fn center(piece: &Piece) -> Vec3 {
    piece.summary.middle()
}

fn sort(pieces: &mut [&Piece], axis: Vec3) {
    pieces.sort_unstable_by_key(|p| (ascending_bits(center(p).dot(axis)), p.part));
}

/// The places where a sorted set may be cut, as the number of pieces on the left side.
fn places(pieces: &[&Piece]) -> Vec<usize> {
    let all: usize = pieces.iter().map(|p| p.triangles).sum();
    let least = all as f64 * LEAST_SHARE;
    let mut left = 0;
    let (mut balanced, mut before_heavy) = (Vec::new(), 0);
    for (index, piece) in pieces.iter().enumerate() {
        let (sum, rest) = (left as f64, (all - left) as f64);
        if index > 0 && sum >= least && rest >= least {
            balanced.push(index);
        }
        if sum < least {
            before_heavy = index;
        }
        left += piece.triangles;
    }
    if balanced.is_empty() {
        let beside = [before_heavy, before_heavy + 1].into_iter();
        return beside.filter(|p| (1..pieces.len()).contains(p)).collect();
    }
    let stride = balanced.len().div_ceil(PLACES);
    balanced.into_iter().step_by(stride).collect()
}
