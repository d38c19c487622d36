//! Measures how far the collider is from the visual meshes.

use std::sync::Arc;

use clamber_gltf::Model;
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{MeshError, VertexId};
use clamber_surface::rig::Palette;
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use glam::Vec3;

use super::report::Distances;

/// Number of random vertices of each mesh at which a distance is measured, in each pose.
const SAMPLES: usize = 100;

/// Distances between the visual meshes and the collider, from random vertices of each to the other.
pub(super) struct VisualDistance {
    /// `None` without visual meshes.
    visual: Option<SkinnedSurface>,
    distances: Vec<f64>,
}

impl VisualDistance {
    pub(super) fn new(model: &Model) -> Result<Self, MeshError> {
        let visual = match model.visual_collider() {
            Ok(mesh) => Some(SkinnedSurface::new(Arc::new(mesh))),
            Err(MeshError::NoTriangles { .. }) => None,
            Err(error) => return Err(error),
        };
        let distances = Vec::new();
        Ok(Self { visual, distances })
    }

    /// Measures the distances from random vertices of each surface to the other one, in the pose of the palette.
    pub(super) fn measure(
        &mut self,
        palette: &Palette,
        collider: &SkinnedSurface,
        rng: &mut fastrand::Rng,
    ) -> Result<(), SurfaceError> {
        let Some(visual) = &mut self.visual else {
            return Ok(());
        };
        visual.advance(palette, Similarity::IDENTITY)?;
        for (from, to) in [(&*visual, collider), (collider, &*visual)] {
            for _ in 0..SAMPLES {
                let vertex = rng.usize(0..from.mesh().positions().len());
                if let Some(place) = from.in_model().position(VertexId(vertex as u32)) {
                    self.distances.push(distance(to, place)?);
                }
            }
        }
        Ok(())
    }

    /// The median and the largest distance, or `None` if nothing was measured.
    pub(super) fn finish(&mut self) -> Option<Distances> {
        let worst = self.distances.iter().copied().reduce(f64::max)?;
        self.distances.sort_by(f64::total_cmp);
        // For an even count the median is the smaller of the middle two.
        let middle = (self.distances.len() - 1) / 2;
        Some(Distances {
            median_m: self.distances[middle],
            worst_m: worst,
        })
    }
}

/// Distance of a point from a surface. The search radius grows in steps, as a small one finds near skin fast.
fn distance(surface: &SkinnedSurface, place: Vec3) -> Result<f64, SurfaceError> {
    // Most points are within a hundredth of the creature's size.
    let mut reach = surface.mesh().radius() * 0.01;
    loop {
        if let Some(hit) = surface.in_model().closest_point(place, reach) {
            return Ok(hit.distance);
        }
        if reach == f32::INFINITY {
            return Ok(f64::INFINITY);
        }
        // A radius of 0 cannot be widened by a factor.
        reach = if reach > 0.0 {
            reach * 4.0
        } else {
            f32::INFINITY
        };
    }
}
