//! Patches on the creature in its present pose.

use clamber_surface::mesh::TriangleId;
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use super::{Patch, axes, corners};

/// A place on the skin in its present pose, in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    pub(crate) point: DVec3,
    /// Outward unit normal; zero where the skin has no area.
    pub(crate) normal: DVec3,
    /// The middle of the climber's ball there.
    pub(crate) seat: DVec3,
}

impl Spot {
    /// The spot of a patch.
    pub(crate) fn of(surface: &SkinnedSurface, patch: &Patch) -> Self {
        let known = spot_on(surface, patch.triangle, patch.barycentric);
        let Some((point, [along, across, normal])) = known else {
            return Self {
                point: patch.point,
                normal: DVec3::ZERO,
                seat: patch.seat,
            };
        };
        let place = surface.world_from_model();
        let point = place.transform_point(point);
        let [x, y, z] = patch.away;
        Self {
            point,
            normal: place.rotation * normal,
            seat: point + place.rotation * (along * x + across * y + normal * z),
        }
    }
}

/// A point of the skin, given by a triangle and barycentric weights, and the triangle's axes, all in model space.
/// `None` if the triangle has no area.
pub(crate) fn spot_on(
    surface: &SkinnedSurface,
    triangle: TriangleId,
    weights: [f64; 3],
) -> Option<(DVec3, [DVec3; 3])> {
    let corners = corners(surface, triangle)?;
    let [u, v, w] = weights;
    let point = corners[0] * u + corners[1] * v + corners[2] * w;
    Some((point, axes(corners)?))
}
