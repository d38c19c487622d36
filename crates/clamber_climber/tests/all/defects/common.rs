//! Helpers that several of the tests share.

use clamber_climber::{
    Climber, ClimberEvent, ClimberInput, ClimberState, ContactQuery, StepReport, StepRules,
};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::rapier3d::prelude::{ColliderBuilder, Vector};
use clamber_world::{
    Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion, SweepContact, TargetMotion,
    WorldCapsule,
};
use glam::{DQuat, DVec3};

use crate::scene::{DT, placed};
use crate::stage::Shape;

pub(crate) const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Places a surface at its first position.
pub(crate) fn at(mut surface: SkinnedSurface, place: DVec3) -> SkinnedSurface {
    placed(&mut surface, place, DQuat::IDENTITY);
    surface
}

/// Obstacles with the ids 0, 1, 2 and so on.
pub(crate) fn list<'a>(obstacles: &[&'a dyn Obstacle]) -> Vec<(ObstacleId, &'a dyn Obstacle)> {
    let ids = (0..).map(ObstacleId);
    ids.zip(obstacles.iter().copied()).collect()
}

/// Steps a climber by one tick at 60 Hz.
pub(crate) fn tick(
    climber: &mut Climber,
    obstacles: &[&dyn Obstacle],
    input: &ClimberInput,
) -> StepReport {
    climber.step(input, &list(obstacles), DT).unwrap()
}

/// Steps a climber by one tick at 60 Hz, in which every contact can be gripped, or none.
pub(crate) fn tick_gripping(
    climber: &mut Climber,
    obstacles: &[&dyn Obstacle],
    input: &ClimberInput,
    can_grip: bool,
) -> StepReport {
    let rule = move |query: &ContactQuery<'_>| query.usual().with_grip(can_grip);
    let rules = StepRules::by(&rule);
    climber
        .step_with(input, &list(obstacles), &rules, DT)
        .unwrap()
}

/// Sets a climber's position and velocity, and keeps the rest of its state.
pub(crate) fn put(climber: &mut Climber, position: DVec3, velocity: DVec3) {
    let state = ClimberState {
        position,
        velocity,
        ..*climber.state()
    };
    climber.restore(state).unwrap();
}

pub(crate) fn count(events: &[ClimberEvent], is_counted: impl Fn(&ClimberEvent) -> bool) -> usize {
    events.iter().filter(|event| is_counted(event)).count()
}

pub(crate) fn is_lost_footing(event: &ClimberEvent) -> bool {
    matches!(event, ClimberEvent::LostFooting { .. })
}

pub(crate) fn is_landed(event: &ClimberEvent) -> bool {
    matches!(event, ClimberEvent::Landed { .. })
}

/// True if the climber gripped a hold, caught a ledge or landed.
pub(crate) fn is_attached(event: &ClimberEvent) -> bool {
    is_landed(event)
        || matches!(
            event,
            ClimberEvent::Grabbed { .. } | ClimberEvent::LedgeCaught { .. }
        )
}

/// An obstacle that answers queries, but reports motion only while `tells` is true.
pub(crate) struct Mute<'a> {
    pub(crate) inner: &'a dyn Obstacle,
    pub(crate) tells: bool,
}

impl Obstacle for Mute<'_> {
    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        self.inner.cast_ray(origin, direction, max_distance)
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        self.inner.closest_point(point, max_distance)
    }

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        self.inner.overlap_capsule(capsule, contacts);
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        self.inner.cast_capsule(capsule, displacements, target)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        self.tells.then(|| self.inner.motion(point, dt))?
    }
}

/// A shape as a triangle mesh collider of rapier.
pub(crate) fn trimesh(shape: &Shape) -> ColliderBuilder {
    let corners: Vec<Vector> = shape.positions.iter().map(|p| p.as_vec3()).collect();
    ColliderBuilder::trimesh(corners, shape.triangles.clone()).unwrap()
}
