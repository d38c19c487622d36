//! rapier's `KinematicCharacterController`, used in two ways.
//!
//! In both ways, the world steps first, as in rapier's own test of a moving wall (`issue_485_kcc_depenetration.rs`),
//! and then the controller moves the character. A character that walks, or that its caller carries, falls by the
//! distance that gravity adds in a tick. A character that the controller should carry along is pressed down by 0.1 m a
//! tick while it does not walk, as in rapier's own test of ground (`character_ground_detection`). Without any motion,
//! the controller makes no casts and follows no platform, and with the fall of one tick it loses lifts of 5 m/s. A
//! character that is pressed down climbs no steps, so it is not pressed while it walks. The character is only a shape:
//! no other body in these scenes would react to a rigid body of its own.

use std::error::Error;
use std::time::Instant;

use clamber_scenes::controllers::{Controller, HEIGHT, Input, PADDING, RADIUS, SNAP, STEP, Set};
use clamber_world::rapier3d::control::{
    CharacterAutostep, CharacterLength, KinematicCharacterController,
};
use clamber_world::rapier3d::parry::query::ShapeCastOptions;
use clamber_world::rapier3d::parry::shape::Capsule;
use clamber_world::rapier3d::prelude::{
    Pose, QueryFilter, RigidBody, RigidBodyBuilder, RigidBodyHandle, Vector,
};
use glam::{DQuat, DVec3};

use super::Entry;
use super::bodies::{Bodies, pose};

/// The two ways of using the controller.
pub(super) const ENTRIES: [Entry; 2] = [
    Entry {
        name: "rapier",
        is_ours: false,
        make: |set| Ok(Box::new(Rapier::new(set, Carried::ByController)?)),
    },
    Entry {
        name: "rapier, carried",
        is_ours: false,
        make: |set| Ok(Box::new(Rapier::new(set, Carried::ByCaller)?)),
    },
];

/// The part of the program that carries the character along with its ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Carried {
    /// The controller carries it, by the velocities of bodies, as its documentation promises.
    ByController,
    /// The controller's caller carries it. It moves the character with its point of the body, hides the bodies'
    /// velocities from the controller, and moves the character out of bodies that moved into it. Then the controller
    /// moves the character.
    ByCaller,
}

/// Distance by which a character that does not walk is pressed down in a tick, metres.
const PRESS: f32 = 0.1;

/// The body that the character stands on.
#[derive(Clone, Copy, Debug)]
struct Ground {
    body: RigidBodyHandle,
    /// Centre of the character's lower ball in the body's space.
    local: Vector,
}

struct Rapier {
    bodies: Bodies,
    controller: KinematicCharacterController,
    shape: Capsule,
    pose: Pose,
    carried: Carried,
    stands: bool,
    ground: Option<Ground>,
    /// The character's own velocity, metres a second. It is vertical, except after a jump off a moving body.
    velocity: Vector,
    /// Velocity of the ground that the character stood on last.
    ground_velocity: Vector,
    gravity: f32,
    jump: f32,
    dt: f32,
}

impl Rapier {
    fn new(set: &Set, carried: Carried) -> Result<Self, Box<dyn Error>> {
        let half = HEIGHT as f32 * 0.5;
        let middle = set.feet + DVec3::Y * (RADIUS + HEIGHT * 0.5);
        // The velocities of bodies that are moved by position cannot be hidden.
        let kinematic = match carried {
            Carried::ByController => RigidBodyBuilder::kinematic_position_based,
            Carried::ByCaller => RigidBodyBuilder::kinematic_velocity_based,
        };
        Ok(Self {
            bodies: Bodies::new(set, kinematic)?,
            controller: KinematicCharacterController {
                // Ten times the default, as rapier's documentation advises for a character that gets stuck. With it,
                // the character passes one more scene.
                normal_nudge_factor: 1e-3,
                offset: CharacterLength::Absolute(PADDING as f32),
                snap_to_ground: Some(CharacterLength::Absolute(SNAP as f32)),
                autostep: Some(CharacterAutostep {
                    max_height: CharacterLength::Absolute(STEP as f32),
                    // The default, half its width, finds no room on a tread of 0.3 m.
                    min_width: CharacterLength::Absolute(0.1),
                    include_dynamic_bodies: false,
                }),
                max_slope_climb_angle: set.max_slope as f32,
                min_slope_slide_angle: set.max_slope as f32,
                ..KinematicCharacterController::default()
            },
            shape: Capsule::new_y(half, (RADIUS - PADDING) as f32),
            pose: Pose::from_translation(middle.as_vec3()),
            carried,
            stands: false,
            ground: None,
            velocity: Vector::ZERO,
            ground_velocity: Vector::ZERO,
            gravity: set.gravity as f32,
            jump: set.jump as f32,
            dt: set.dt as f32,
        })
    }

    /// Moves each body to its pose at `time`, and steps the world.
    fn drive(&mut self, time: f64) {
        let Bodies { world, moving } = &mut self.bodies;
        for (handle, motion) in moving {
            if let Some(body) = world.bodies.get_mut(*handle) {
                let next = pose(&motion(time));
                let (linear, angular) = velocities(body, &next, f64::from(self.dt));
                body.set_linvel(linear, true);
                body.set_angvel(angular, true);
                body.set_next_kinematic_position(next);
            }
        }
        world.step();
    }

    /// Sets the bodies' velocities to 0, so that the controller treats the bodies as still.
    fn hide_velocities(&mut self) {
        let Bodies { world, moving } = &mut self.bodies;
        for (handle, _) in moving {
            if let Some(body) = world.bodies.get_mut(*handle) {
                body.set_linvel(Vector::ZERO, false);
                body.set_angvel(Vector::ZERO, false);
            }
        }
    }

    fn shift(&mut self, by: Vector, filter: QueryFilter<'_>) {
        let queries = self.bodies.world.query_pipeline_with_filter(filter);
        let (dt, shape, pose) = (self.dt, &self.shape, &self.pose);
        let moved = self
            .controller
            .move_shape(dt, &queries, shape, pose, by, |_| {});
        self.pose.translation += moved.translation;
        self.stands = moved.grounded;
    }

    /// A tick of walking, jumping and falling. On the way up, the character has no ground. `carried` is the velocity
    /// with which the character was carried in this tick; a jump keeps it from the next tick on.
    fn walk(&mut self, input: &Input, carried: Vector) {
        let mut walk = Vector::ZERO;
        let mut made = Vector::ZERO;
        let jumps = input.jump && self.stands;
        if self.stands {
            walk = input.walk.as_vec3();
            self.ground_velocity = carried;
            self.velocity = Vector::ZERO;
            if jumps {
                self.velocity = Vector::Y * self.jump + carried;
                made = carried;
            } else if walk == Vector::ZERO && self.carried == Carried::ByController {
                self.velocity = Vector::Y * (self.gravity * self.dt - PRESS / self.dt);
            }
        }
        self.velocity.y -= self.gravity * self.dt;
        let flies = jumps || !self.stands;
        let rises = flies && self.velocity.y > self.ground_velocity.y;
        let snap = CharacterLength::Absolute(SNAP as f32);
        self.controller.snap_to_ground = (!rises).then_some(snap);
        let way = (walk + self.velocity - made) * self.dt;
        self.shift(way, QueryFilter::default());
        self.stands &= !rises;
    }

    /// As [`Rapier::walk`], after the caller has carried the character along with its ground.
    fn walk_carried(&mut self, input: &Input) {
        let carried = self.carry();
        // The controller resolves overlaps only in a call without motion. The ground is left out, since overlaps with
        // it would throw the character off steps.
        let mut moving = QueryFilter::only_kinematic();
        if let Some(ground) = self.ground {
            moving = moving.exclude_rigid_body(ground.body);
        }
        let stood = self.stands;
        self.shift(Vector::ZERO, moving);
        self.stands = stood;
        self.walk(input, carried);
        self.ground = if self.stands { self.below() } else { None };
    }

    /// Moves the character with its point of the ground, and returns the velocity of this motion.
    fn carry(&mut self) -> Vector {
        let Some(ground) = self.ground else {
            return Vector::ZERO;
        };
        let Some(body) = self.bodies.world.bodies.get(ground.body) else {
            return Vector::ZERO;
        };
        let way = body.position().transform_point(ground.local) - self.lower();
        self.pose.translation += way;
        way / self.dt
    }

    /// The ground below the character.
    fn below(&self) -> Option<Ground> {
        let world = &self.bodies.world;
        let options = ShapeCastOptions {
            max_time_of_impact: SNAP as f32,
            target_distance: PADDING as f32,
            stop_at_penetration: false,
            compute_impact_geometry_on_penetration: true,
        };
        let queries = world.query_pipeline();
        let (handle, _) = queries.cast_shape(&self.pose, -Vector::Y, &self.shape, options)?;
        let body = world.colliders.get(handle)?.parent()?;
        let place = world.bodies.get(body)?.position();
        Some(Ground {
            body,
            local: place.inverse_transform_point(self.lower()),
        })
    }

    /// Centre of the character's lower ball.
    fn lower(&self) -> Vector {
        self.pose.translation - Vector::Y * (HEIGHT as f32 * 0.5)
    }
}

/// The linear velocity of a body's centre of mass and the angular velocity that take the body to a pose in a tick.
fn velocities(body: &RigidBody, next: &Pose, dt: f64) -> (Vector, Vector) {
    let now = body.position();
    let center = body.center_of_mass();
    let there = next.transform_point(now.inverse_transform_point(center));
    let wide = |pose: &Pose| {
        let q = pose.rotation;
        DQuat::from_xyzw(q.x.into(), q.y.into(), q.z.into(), q.w.into()).normalize()
    };
    let turn = wide(next) * wide(now).conjugate();
    let shorter = if turn.w < 0.0 { -turn } else { turn };
    let axis = DVec3::new(shorter.x, shorter.y, shorter.z);
    let sine = axis.length();
    let angle = 2.0 * libm::atan2(sine, shorter.w);
    let angular = axis.normalize_or_zero() * (angle / dt);
    (
        ((there - center).as_dvec3() / dt).as_vec3(),
        angular.as_vec3(),
    )
}

impl Controller for Rapier {
    fn step(&mut self, time: f64, input: &Input) -> Result<f64, Box<dyn Error>> {
        self.drive(time);
        if self.carried == Carried::ByCaller {
            self.hide_velocities();
        }
        let start = Instant::now();
        match self.carried {
            Carried::ByController => self.walk(input, Vector::ZERO),
            Carried::ByCaller => self.walk_carried(input),
        }
        Ok(start.elapsed().as_secs_f64() * 1e6)
    }

    fn position(&self) -> DVec3 {
        self.lower().as_dvec3()
    }

    fn stands(&self) -> bool {
        self.stands
    }
}
