//! The queries of climbers on the giant in a tick, by a system in Bevy and by the core alone.

use std::error::Error;
use std::sync::Arc;

use bevy_clamber::clamber_surface::geometry::{Capsule, Ray, Similarity};
use bevy_clamber::clamber_surface::mesh::{ColliderMesh, TriangleId};
use bevy_clamber::clamber_surface::rig::Pose;
use bevy_clamber::clamber_surface::surface::{
    Anchor, CastOptions, SkinnedSurface, SurfaceHit, TargetMotion,
};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Dir3, Quat, Vec3};
use bevy_shape::Ray3d;
use clamber_scenes::Creature;

/// Half the length of a climber's segment, its radius, and how far it reaches and looks, metres.
const HALF: f32 = 0.6;
const RADIUS: f32 = 0.3;
const REACH: f32 = 0.1;
const SIGHT: f32 = 5.0;

const TICK: f64 = 1.0 / 64.0;

/// One climber on the skin, in a tick.
#[derive(Clone, Copy)]
pub(crate) struct Rider {
    ends: [Vec3; 2],
    outward: Vec3,
    anchor: Anchor,
}

/// For each pose, climbers that are spread evenly over the triangles.
pub(crate) fn over(
    mesh: &Arc<ColliderMesh>,
    creature: &Creature,
    poses: &[Pose],
    riders: usize,
) -> Result<Vec<Vec<Rider>>, Box<dyn Error>> {
    let mut surface = SkinnedSurface::new(Arc::clone(mesh));
    let triangles = mesh.triangles().len();
    let mut all = Vec::new();
    for pose in poses {
        surface.advance(&creature.rig.skeleton.palette(pose)?, Similarity::IDENTITY)?;
        let rider = |index: usize| -> Result<Rider, Box<dyn Error>> {
            let triangle = TriangleId(((index * 2 + 1) * triangles / (2 * riders)) as u32);
            let anchor = surface.anchor(triangle, [0.5, 0.25, 0.25])?;
            let motion = surface.in_model().motion(&anchor, TICK)?;
            let foot = motion.position + motion.normal * (RADIUS * 0.98);
            Ok(Rider {
                ends: [foot, foot + motion.normal * (2.0 * HALF)],
                outward: motion.normal,
                anchor,
            })
        };
        all.push((0..riders).map(rider).collect::<Result<_, _>>()?);
    }
    Ok(all)
}

impl Rider {
    /// A step along the skin.
    fn step(&self) -> Vec3 {
        self.outward.any_orthonormal_vector() * 0.05 - self.outward * 0.01
    }

    fn body(&self, radius: f32) -> Capsule {
        Capsule::new(self.ends[0], self.ends[1], radius).unwrap()
    }

    fn middle(&self) -> Vec3 {
        (self.ends[0] + self.ends[1]) * 0.5
    }
}

/// Makes the queries of the core, in model space; returns the number of hits.
pub(crate) fn answer(
    surface: &SkinnedSurface,
    riders: &[Rider],
    hits: &mut Vec<SurfaceHit>,
) -> usize {
    let mut found = 0;
    for rider in riders {
        let space = surface.in_model();
        space.overlap_capsule(&rider.body(RADIUS + REACH), hits);
        found += hits.len();
        let motions = [rider.step(); 2];
        let swept = space.cast_capsule(&rider.body(RADIUS), motions, &CastOptions::MOVING);
        found += usize::from(swept.is_some());
        let nearest = space.closest_point(rider.middle(), SIGHT);
        found += usize::from(nearest.is_some());
        let ray = Ray::new(rider.middle(), -rider.outward).unwrap();
        found += usize::from(space.cast_ray(&ray, SIGHT).is_some());
        found += usize::from(surface.in_model().motion(&rider.anchor, TICK).is_ok());
    }
    found
}

/// The climbers that the system makes queries for.
#[derive(Resource, Default)]
pub(crate) struct Asked(Vec<(Rider, SurfaceAnchor)>);

impl Asked {
    pub(crate) fn new(entity: Entity, surface: &SkinnedSurface, riders: &[Rider]) -> Self {
        let anchored =
            |rider: &Rider| SurfaceAnchor::new(entity, surface, rider.anchor, Quat::IDENTITY);
        Self(
            riders
                .iter()
                .map(|rider| (*rider, anchored(rider)))
                .collect(),
        )
    }
}

/// Number of hits.
#[derive(Resource, Default)]
pub(crate) struct Answers(pub(crate) usize);

/// Makes the same queries in world space.
pub(crate) fn ask(
    asked: Res<Asked>,
    surfaces: SurfaceQuery,
    mut answers: ResMut<Answers>,
    mut hits: Local<Vec<EntityHit>>,
) {
    let all = SurfaceFilter::default();
    answers.0 = 0;
    for (rider, anchor) in &asked.0 {
        surfaces.overlap_capsule(&rider.body(RADIUS + REACH), &all, &mut hits);
        answers.0 += hits.len();
        let motions = [rider.step(); 2];
        let swept = surfaces.cast_capsule(&rider.body(RADIUS), motions, TargetMotion::Moving, &all);
        answers.0 += usize::from(swept.is_some());
        let nearest = surfaces.closest_point(rider.middle(), SIGHT, &all);
        answers.0 += usize::from(nearest.is_some());
        let inward = Dir3::new_unchecked(-rider.outward);
        let ray = Ray3d::new(rider.middle(), inward);
        answers.0 += usize::from(surfaces.cast_ray(ray, SIGHT, &all).is_some());
        answers.0 += usize::from(surfaces.motion(anchor, TICK).is_ok());
    }
}
