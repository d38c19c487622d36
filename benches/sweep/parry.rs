//! parry's triangle mesh with the surface's positions.

use std::error::Error;

use clamber::prelude::*;
use clamber::world::rapier3d::parry::math::Pose;
use clamber::world::rapier3d::parry::query::{ShapeCastOptions, cast_shapes};
use clamber::world::rapier3d::parry::shape::{Ball, TriMesh};

use crate::casts::Cast;

pub(crate) struct Parry(TriMesh);

impl Parry {
    /// A mesh with the surface's current positions.
    pub(crate) fn new(surface: &SkinnedSurface) -> Result<Self, Box<dyn Error>> {
        let mut positions = Vec::new();
        surface.skin_all(&mut positions);
        let triangles = surface.mesh().triangles().iter();
        let triangles = triangles.map(|corners| corners.map(|v| v.0)).collect();
        Ok(Self(TriMesh::new(positions, triangles)?))
    }

    /// The time of contact as a share of the motion; `None` if the ball does not touch.
    pub(crate) fn cast(&self, cast: &Cast) -> Option<f64> {
        let options = ShapeCastOptions {
            max_time_of_impact: 1.0,
            ..ShapeCastOptions::default()
        };
        let start = Pose::from_translation(cast.sphere.center);
        let ball = Ball::new(cast.sphere.radius);
        let still = glam::Vec3::ZERO;
        let hit = cast_shapes(
            &start,
            cast.motion,
            &ball,
            &Pose::IDENTITY,
            still,
            &self.0,
            options,
        );
        hit.ok().flatten().map(|hit| f64::from(hit.time_of_impact))
    }
}
