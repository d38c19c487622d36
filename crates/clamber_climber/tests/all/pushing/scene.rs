//! A climber in a rapier world, whose bodies get its pushes.

use clamber_climber::{
    Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, ClimberState, Push,
    StepReport, StepRules,
};
use clamber_world::rapier3d::prelude::{
    Collider, ColliderBuilder, ColliderHandle, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle,
    Vector,
};
use clamber_world::{BodyPoses, ObstacleId, RapierTerrain, SurfaceKind, SurfaceTag, apply_push};
use glam::DVec3;

use crate::numbers::in_world_of_size;
use crate::scene::DT;

/// Mass of the climber, kg.
pub(crate) const MASS: f64 = 80.0;

/// The user data of colliders with fur.
pub(crate) const FUR: u128 = 1;

/// A world without friction, and a climber of 80 kg that walks at 3 m/s and pushes with up to 600 N.
pub(crate) struct Scene {
    pub(crate) world: PhysicsWorld,
    pub(crate) climber: Climber,
    /// Pushes of the last step, not applied yet.
    pub(crate) pushes: Vec<Push>,
    before: BodyPoses,
    dt: f64,
}

impl Scene {
    /// An empty world with the climber's centre at a position.
    pub(crate) fn new(gravity: f64, position: DVec3) -> Self {
        Self::with(ClimberConfig::walker(), 1.0, DT, gravity, position)
    }

    /// [`Scene::new`] in a world of another size, in which every motion takes as long as at size 1.
    pub(crate) fn with(
        config: ClimberConfig,
        size: f64,
        dt: f64,
        gravity: f64,
        position: DVec3,
    ) -> Self {
        let mut world = PhysicsWorld {
            gravity: Vector::new(0.0, (-gravity * size) as f32, 0.0),
            ..PhysicsWorld::default()
        };
        world.integration_parameters.dt = dt as f32;
        world.integration_parameters.length_unit = size as f32;
        let config = in_world_of_size(config, size);
        Self {
            world,
            climber: Climber::new(config, position * size).unwrap(),
            pushes: Vec::new(),
            before: BodyPoses::new(),
            dt,
        }
    }

    /// Makes the climber move at a velocity, in the air.
    pub(crate) fn throw(&mut self, velocity: DVec3, frame: DVec3) {
        let state = ClimberState {
            velocity: velocity + frame,
            base_velocity: frame,
            ..*self.climber.state()
        };
        self.climber.restore(state).unwrap();
    }

    /// Adds a fixed floor with its top at height 0.
    pub(crate) fn with_floor(mut self) -> Self {
        let floor = cuboid(50.0, 0.5, 50.0).translation(Vector::new(0.0, -0.5, 0.0));
        self.world.insert_collider(floor, None);
        self
    }

    /// Adds a body of some boxes, each with its mass.
    pub(crate) fn add(
        &mut self,
        body: RigidBodyBuilder,
        boxes: impl IntoIterator<Item = (ColliderBuilder, f64)>,
    ) -> RigidBodyHandle {
        let handle = self.world.insert_body(body);
        for (collider, mass) in boxes {
            let collider = collider.mass(mass as f32);
            self.world.insert_collider(collider, Some(handle));
        }
        // Makes the boxes visible to queries, and computes masses.
        self.world.detect_collisions(&(), &());
        handle
    }

    /// Applies the last pushes, steps the world, then the climber.
    pub(crate) fn tick(&mut self, input: &ClimberInput) -> StepReport {
        self.apply();
        self.step(input)
    }

    /// Ticks with the same input.
    pub(crate) fn ticks(&mut self, count: u32, input: &ClimberInput) {
        for _ in 0..count {
            self.tick(input);
        }
    }

    /// Steps, and applies the pushes at once.
    pub(crate) fn step_and_apply(&mut self, input: &ClimberInput) -> StepReport {
        let report = self.step(input);
        self.apply();
        report
    }

    pub(crate) fn apply(&mut self) {
        for push in self.pushes.drain(..) {
            let world = &mut self.world;
            apply_push(
                &mut world.bodies,
                &world.colliders,
                &push.material,
                push.impulse,
            );
        }
    }

    pub(crate) fn step(&mut self, input: &ClimberInput) -> StepReport {
        self.step_by(input, &StepRules::default())
    }

    pub(crate) fn step_by(&mut self, input: &ClimberInput, rules: &StepRules<'_>) -> StepReport {
        self.before.record(&self.world.bodies);
        self.world.step();
        let fur = |_: ColliderHandle, collider: &Collider| {
            if collider.user_data == FUR {
                SurfaceTag::new(SurfaceKind::Fur)
            } else {
                SurfaceTag::default()
            }
        };
        let terrain = RapierTerrain::of_world(&self.world, &self.before).with_tags(&fur);
        let report = self
            .climber
            .step_with(input, &[(ObstacleId(0), &terrain)], rules, self.dt)
            .unwrap();
        self.pushes.clone_from(&report.pushes);
        report
    }

    pub(crate) fn momentum(&self, body: RigidBodyHandle) -> DVec3 {
        let body = &self.world.bodies[body];
        (body.linvel() * body.mass()).as_dvec3()
    }

    /// Momentum of some bodies and the climber.
    pub(crate) fn momenta(&self, bodies: &[RigidBodyHandle]) -> DVec3 {
        let of_bodies: DVec3 = bodies.iter().map(|body| self.momentum(*body)).sum();
        of_bodies + self.climber.state().velocity * MASS
    }

    pub(crate) fn set_velocity(&mut self, body: RigidBodyHandle, velocity: DVec3) {
        self.world.bodies[body].set_linvel(velocity.as_vec3(), true);
    }

    pub(crate) fn velocity(&self, body: RigidBodyHandle) -> DVec3 {
        self.world.bodies[body].linvel().as_dvec3()
    }

    pub(crate) fn place(&self, body: RigidBodyHandle) -> DVec3 {
        self.world.bodies[body].translation().as_dvec3()
    }

    pub(crate) fn assert_standing(&self, told: &str) {
        let state = self.climber.state();
        assert_eq!(state.mode, ClimberMode::Standing, "{told}: {state:?}");
    }
}

/// A cuboid by its half extents, without friction.
pub(crate) fn cuboid(x: f32, y: f32, z: f32) -> ColliderBuilder {
    ColliderBuilder::cuboid(x, y, z).friction(0.0)
}

/// A [`cuboid`] by a vector.
pub(crate) fn boxed(half: DVec3) -> ColliderBuilder {
    let half = half.as_vec3();
    cuboid(half.x, half.y, half.z)
}

/// The sum of all impulses.
pub(crate) fn sum(pushes: &[Push]) -> DVec3 {
    pushes.iter().map(|push| push.impulse).sum()
}

pub(crate) fn landing_speed(report: &StepReport) -> Option<f64> {
    report.events.iter().find_map(|event| match event {
        ClimberEvent::Landed { speed, .. } => Some(*speed),
        _ => None,
    })
}
