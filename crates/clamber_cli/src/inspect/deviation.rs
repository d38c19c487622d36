//! Measures how far skinned vertices are from exact arithmetic, and the collider from the visual meshes.

use clamber_gltf::Rig;
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::measure::{error_bound, skin_vertex_reference};
use clamber_surface::mesh::{ColliderMesh, MeshError, VertexId};
use clamber_surface::rig::Palette;
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use glam::Vec3;
use std::sync::Arc;

use super::median;
use super::report::Distances;

/// The largest error of a vertex coordinate against skinning in f64, as a share of its bound. It is infinite if a
/// position is NaN or a bound of 0 is exceeded. `positions` are the mesh's vertices, skinned with `matrices`.
pub fn skinning_error_share(mesh: &ColliderMesh, matrices: &[Affine], positions: &[Vec3]) -> f64 {
    let mut worst = 0.0f64;
    for (index, position) in positions.iter().enumerate() {
        let vertex = VertexId(index as u32);
        let exact = skin_vertex_reference(mesh, matrices, vertex);
        let bound = error_bound(mesh, matrices, vertex);
        if let (Some(exact), Some(bound)) = (exact, bound) {
            let error = (position.as_dvec3() - exact).abs();
            for (error, bound) in error.to_array().into_iter().zip(bound.to_array()) {
                // A bound of zero allows no error at all, and NaN is the worst error.
                let share = if error == 0.0 { 0.0 } else { error / bound };
                worst = worst.max(if share.is_nan() { f64::INFINITY } else { share });
            }
        }
    }
    worst
}

/// Number of random vertices of each mesh at which a distance is measured, in each pose.
const SAMPLES: usize = 100;

/// Distances between the visual meshes and the collider, from random vertices of each to the other.
pub(super) struct VisualDistance {
    /// `None` without visual meshes.
    visual: Option<SkinnedSurface>,
    distances: Vec<f64>,
}

impl VisualDistance {
    pub(super) fn new(rig: &Rig) -> Result<Self, MeshError> {
        let visual = match rig.visual_collider() {
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
        Some(Distances {
            median_m: median(&mut self.distances)?,
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

#[cfg(test)]
mod tests {
    use super::*;
    use clamber_scenes::giant::giant;

    #[test]
    fn a_moved_vertex_and_nan_exceed_the_bound() {
        let giant = giant().unwrap();
        let palette = giant.skeleton.palette(&giant.skeleton.rest_pose()).unwrap();
        let mesh = &giant.collider;
        let mut positions = clamber_surface::skin::skin(mesh, palette.matrices()).unwrap();
        let share = |p: &[Vec3]| skinning_error_share(mesh, palette.matrices(), p);
        assert!((0.01..1.0).contains(&share(&positions)));
        positions[7].x += 1e-3;
        assert!(share(&positions) > 10.0);
        positions[8].y = f32::NAN;
        assert_eq!(share(&positions), f64::INFINITY);
    }
}
