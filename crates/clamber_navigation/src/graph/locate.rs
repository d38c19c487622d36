//! Finds the patch of a point of the skin.

use clamber_surface::mesh::{ColliderMesh, TriangleId};
use glam::DVec3;

use super::patch::NO_PATCH;
use crate::survey::Survey;

/// For each triangle, its bits and their patches.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Locator {
    /// The places of triangle t are `start[t]..start[t + 1]`.
    start: Vec<u32>,
    pieces: Vec<Place>,
}

/// The middle of a bit of a triangle, and its patch or the nearest one.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
struct Place {
    weights: [f32; 3],
    patch: u32,
    is_on_it: bool,
}

impl Locator {
    /// Creates the locator. A piece without a patch takes the patch that is nearest at rest.
    pub(super) fn new(survey: &Survey, patch_of: &[u32], mesh: &ColliderMesh) -> Self {
        let nearest = nearest(survey, patch_of);
        let mut of: Vec<Vec<Place>> = vec![Vec::new(); mesh.triangles().len()];
        for bit in &survey.bits {
            let piece = bit.piece as usize;
            let (patch, own) = (nearest[piece], patch_of[piece]);
            if patch != NO_PATCH {
                of[bit.triangle.index()].push(Place {
                    weights: bit.barycentric,
                    patch,
                    is_on_it: own == patch,
                });
            }
        }
        let mut locator = Self {
            start: vec![0],
            pieces: Vec::new(),
        };
        for pieces in of {
            locator.pieces.extend(pieces);
            locator.start.push(locator.pieces.len() as u32);
        }
        locator
    }

    /// True if the locator has a range for each of `triangles` triangles, and its patches are below `patches`.
    #[cfg(feature = "cache")]
    pub(crate) fn is_sound(&self, patches: usize, triangles: usize) -> bool {
        let mut found = self.pieces.iter();
        crate::cache::divides(&self.start, triangles, self.pieces.len())
            && found.all(|place| (place.patch as usize) < patches)
    }

    /// The patch of a point, and whether the point is on the patch or only near it.
    pub(super) fn find(
        &self,
        triangle: TriangleId,
        barycentric: [f32; 3],
    ) -> Option<(usize, bool)> {
        let from = *self.start.get(triangle.index())? as usize;
        let to = *self.start.get(triangle.index() + 1)? as usize;
        let apart = |place: &Place| -> f32 {
            (0..3)
                .map(|k| place.weights[k] - barycentric[k])
                .map(|off| off * off)
                .sum()
        };
        let places = self.pieces.get(from..to)?.iter();
        let nearest = places.min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        Some((nearest.patch as usize, nearest.is_on_it))
    }
}

/// Pieces farther from all patches than this get no patch, radii of the climber.
const FARTHEST_PATCH: f64 = 5.0;

fn nearest(survey: &Survey, patch_of: &[u32]) -> Vec<u32> {
    // Pieces that have a patch, sorted by their cell in a grid.
    let far = FARTHEST_PATCH * survey.config.radius();
    let cell = |point: DVec3| (point / far).floor().as_i64vec3().to_array();
    let mut cells: Vec<([i64; 3], usize)> = (0..patch_of.len())
        .filter(|piece| patch_of[*piece] != NO_PATCH)
        .map(|piece| (cell(survey.pieces[piece].point), piece))
        .collect();
    cells.sort_unstable();
    let mut all = patch_of.to_vec();
    for (piece, patch) in all.iter_mut().enumerate() {
        if *patch != NO_PATCH {
            continue;
        }
        let here = &survey.pieces[piece];
        let middle = cell(here.point);
        let mut best = (far, NO_PATCH);
        for k in 0..27 {
            let beside = [k % 3, k / 3 % 3, k / 9];
            let at: [i64; 3] = std::array::from_fn(|axis| middle[axis] + beside[axis] - 1);
            let from = cells.partition_point(|(cell, _)| *cell < at);
            for (_, other) in cells[from..].iter().take_while(|(cell, _)| *cell == at) {
                let there = &survey.pieces[*other];
                // Skin on the other side of a thin part is not a neighbour.
                let faces = there.normal.dot(here.normal) > -0.5;
                let apart = there.point.distance(here.point);
                if faces && apart < best.0 {
                    best = (apart, patch_of[*other]);
                }
            }
        }
        *patch = best.1;
    }
    all
}
