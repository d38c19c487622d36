//! A climber in a rapier world, at any size, rate and in any steadily moving frame.

use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberMode, StepReport, StepRules};
use clamber_world::rapier3d::prelude::{
    Collider, ColliderBuilder, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, Vector,
};
use clamber_world::{
    BodyPoses, ClimberProxy, Obstacle, ObstacleId, ProxyImpulse, RapierTerrain, apply_push,
};
use glam::DVec3;

use crate::input::IDLE;
use crate::scene::throw;

/// Id of rapier's world.
pub(crate) const WORLD: ObstacleId = ObstacleId(7);

/// Size, ticks a second, velocity of the frame along Z before it is scaled.
pub(crate) type Setting = (f64, f64, f64);

pub(crate) struct Scene {
    pub(crate) world: PhysicsWorld,
    pub(crate) climber: Climber,
    pub(crate) setting: Setting,
    pub(crate) before: BodyPoses,
    pub(crate) proxy: Option<ClimberProxy>,
    /// The hit on the climber in the last tick.
    pub(crate) hit: Option<ProxyImpulse>,
    /// Velocity of all bodies and of the climber at the start.
    pub(crate) frame: DVec3,
}

impl Scene {
    /// A climber of the walker's proportions, its centre at a position, in sizes.
    pub(crate) fn new(setting: Setting, config: ClimberConfig, position: DVec3) -> Self {
        let (size, hz, frame) = setting;
        let mut world = PhysicsWorld {
            gravity: Vector::new(0.0, -9.81, 0.0),
            ..PhysicsWorld::default()
        };
        world.integration_parameters.dt = (1.0 / hz) as f32;
        world.integration_parameters.length_unit = size as f32;
        // Rapier clips speeds at 400 m/s, which would make fast frames differ.
        world.integration_parameters.normalized_max_linear_velocity = 1e4;
        let frame = DVec3::Z * frame;
        let mut climber = Climber::new(config.scaled(size), position * size).unwrap();
        throw(&mut climber, frame, frame);
        let body = climber.proxy_body(WORLD);
        let proxy =
            ClimberProxy::insert(&body, DVec3::ZERO, &mut world.bodies, &mut world.colliders);
        Self {
            world,
            climber,
            setting,
            before: BodyPoses::new(),
            proxy: Some(proxy),
            hit: None,
            frame,
        }
    }

    /// A climber with every ability that stands on a floor.
    pub(crate) fn standing(setting: Setting) -> Self {
        let mut scene = Self::on_floor(setting);
        scene.rest(0.5);
        assert_eq!(scene.climber.state().mode, ClimberMode::Standing);
        scene
    }

    /// A climber with every ability, just above a floor.
    pub(crate) fn on_floor(setting: Setting) -> Self {
        let config = ClimberConfig::colossus_climber();
        Self::new(setting, config, DVec3::Y * 0.41).with_floor()
    }

    /// Ticks without input for some seconds of a body of size 1.
    pub(crate) fn rest(&mut self, seconds: f64) {
        for _ in 0..self.ticks(seconds) {
            self.tick(&IDLE);
        }
    }

    /// The same climber without a proxy, so that bodies do not collide with it.
    pub(crate) fn without_proxy(mut self) -> Self {
        if let Some(proxy) = self.proxy.take() {
            proxy.remove(&mut self.world);
        }
        self
    }

    pub(crate) fn dt(&self) -> f64 {
        1.0 / self.setting.1
    }

    /// Adds a kinematic floor with its top at height 0.
    pub(crate) fn with_floor(mut self) -> Self {
        let floor = RigidBodyBuilder::kinematic_velocity_based();
        self.add(floor, [60.0, 1.0, 60.0], DVec3::Y * -0.5, 0.0);
        self
    }

    /// Adds a box by its sides, in sizes, that moves with the frame.
    pub(crate) fn add(
        &mut self,
        body: RigidBodyBuilder,
        sides: [f64; 3],
        at: DVec3,
        mass: f64,
    ) -> RigidBodyHandle {
        let size = self.setting.0;
        let [x, y, z] = sides.map(|side| (side * 0.5 * size) as f32);
        let body = body
            .translation((at * size).as_vec3())
            .linvel(self.frame.as_vec3())
            // Rapier puts slow bodies to sleep, such as a giant's falling crate, or a heavy body that was pushed.
            .can_sleep(false);
        let collider = ColliderBuilder::cuboid(x, y, z)
            .mass(mass as f32)
            .friction(0.0);
        let (handle, _) = self.world.insert(body, collider);
        handle
    }

    pub(crate) fn tick(&mut self, input: &ClimberInput) -> StepReport {
        self.tick_with(input, &[])
    }

    /// A tick with more obstacles beside rapier's world.
    pub(crate) fn tick_with(
        &mut self,
        input: &ClimberInput,
        more: &[(ObstacleId, &dyn Obstacle)],
    ) -> StepReport {
        let dt = self.dt();
        self.before.record(&self.world.bodies);
        self.world.step();
        self.hit = self.proxy.as_mut().and_then(|proxy| {
            let world = &mut self.world;
            let (bodies, colliders) = (&mut world.bodies, &mut world.colliders);
            proxy.after_step(&self.before, bodies, colliders, &world.narrow_phase, dt)
        });
        let knockback = self
            .hit
            .and_then(|hit| self.climber.knockback_of(hit.impulse, Some(WORLD)));
        let own = self.proxy.as_ref().map(ClimberProxy::collider);
        let seen = |handle, _: &Collider| Some(handle) != own;
        let terrain = RapierTerrain::of_world(&self.world, &self.before).with_filter(&seen);
        let rules = StepRules {
            air_velocity: self.frame,
            knockback,
            ..StepRules::default()
        };
        let mut obstacles: Vec<(ObstacleId, &dyn Obstacle)> = vec![(WORLD, &terrain)];
        obstacles.extend(more);
        let report = self
            .climber
            .step_with(input, &obstacles, &rules, dt)
            .unwrap();
        for push in &report.pushes {
            let world = &mut self.world;
            apply_push(
                &mut world.bodies,
                &world.colliders,
                &push.material,
                push.impulse,
            );
        }
        if let Some(proxy) = &mut self.proxy {
            let world = &mut self.world;
            proxy.follow(
                &self.climber.proxy_body(WORLD),
                self.climber.proxy_touches(WORLD),
                &mut world.bodies,
                &mut world.colliders,
                &mut world.impulse_joints,
            );
        }
        report
    }

    /// Ticks in some seconds of a body of size 1.
    pub(crate) fn ticks(&self, seconds: f64) -> u32 {
        (seconds * self.setting.0.sqrt() * self.setting.1) as u32
    }

    /// Speed of a body of this size that would be 1 m/s for one of size 1.
    pub(crate) fn speed(&self) -> f64 {
        self.setting.0.sqrt()
    }

    /// A body's velocity in the frame.
    pub(crate) fn velocity(&self, body: RigidBodyHandle) -> DVec3 {
        self.world.bodies[body].linvel().as_dvec3() - self.frame
    }

    /// Sets a body's velocity in the frame.
    pub(crate) fn send(&mut self, body: RigidBodyHandle, velocity: DVec3) {
        let velocity = (self.frame + velocity).as_vec3();
        self.world.bodies[body].set_linvel(velocity, true);
    }

    /// The climber's velocity in the frame.
    pub(crate) fn own(&self) -> DVec3 {
        self.climber.state().velocity - self.frame
    }

    /// A place relative to the climber, in sizes.
    pub(crate) fn beside(&self, offset: DVec3) -> DVec3 {
        self.climber.state().position / self.setting.0 + offset
    }

    /// Adds a cube above the climber that does not turn, by its sides and its height over the climber, in sizes.
    pub(crate) fn drop_crate(&mut self, side: f64, height: f64, mass: f64) -> RigidBodyHandle {
        let body = RigidBodyBuilder::dynamic().lock_rotations();
        self.add(body, [side; 3], self.beside(DVec3::Y * height), mass)
    }

    /// A body's place relative to the climber, in sizes.
    pub(crate) fn above(&self, body: RigidBodyHandle) -> DVec3 {
        let place = self.world.bodies[body].translation().as_dvec3();
        (place - self.climber.state().position) / self.setting.0
    }
}

/// Sizes, rates and frames.
pub(crate) const SETTINGS: [Setting; 9] = [
    (1.0, 60.0, 0.0),
    (1.0, 30.0, 0.0),
    (1.0, 240.0, 0.0),
    (1.0, 60.0, 30.0),
    (1.0, 60.0, 300.0),
    (0.02, 240.0, 0.0),
    (0.1, 120.0, 30.0),
    (10.0, 30.0, 30.0),
    (100.0, 30.0, 0.0),
];
