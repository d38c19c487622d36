//! Jolt's `CharacterVirtual`, moved as in Jolt's own sample (`Samples/Tests/Character/CharacterVirtualTest.cpp`).
//!
//! In a tick, `MoveKinematic` sets the bodies' next poses, and the ground's velocity is updated. The character's
//! velocity is the ground's velocity plus its walk and the fall of a tick. `ExtendedUpdate` moves the character, sticks
//! it to the floor and moves it up steps. Then the world steps. "Character inertia", an option of the sample, is off:
//! feet stick to the ground, as with the other controllers. The sample's listener keeps a character that does not walk
//! from sliding on still ground.
//!
//! The crate `oxijolt-sys` builds Jolt and joltc, a wrapper in C, from their sources, in single precision.

mod world;

use std::error::Error;
use std::time::Instant;

use clamber_scenes::controllers::{Controller, Input, RADIUS, Set};
use glam::{DVec3, Vec3};

use self::world::{Start, World};
use super::Entry;

/// Jolt's controller.
pub(super) const ENTRIES: [Entry; 1] = [Entry {
    name: "Jolt 5.6",
    is_ours: false,
    make: |set| Ok(Box::new(Jolt::new(set)?)),
}];

struct Jolt {
    world: World,
    gravity: f32,
    jump: f32,
    dt: f32,
}

impl Jolt {
    fn new(set: &Set) -> Result<Self, Box<dyn Error>> {
        let start = Start {
            feet: set.feet.as_vec3(),
            max_slope: set.max_slope as f32,
            gravity: set.gravity as f32,
        };
        Ok(Self {
            world: World::new(&set.pieces, &start)?,
            gravity: set.gravity as f32,
            jump: set.jump as f32,
            dt: set.dt as f32,
        })
    }

    /// The character's velocity, added up as Jolt's documentation describes.
    fn velocity(&self, input: &Input) -> Vec3 {
        let now = self.world.velocity();
        let ground = self.world.ground_velocity();
        let upwards = Vec3::Y * now.y;
        let stays = now.y - ground.y < 0.1;
        let sticks = !self.world.is_on_steep();
        let mut next = if self.world.is_on_ground() && sticks {
            let jump = if input.jump && stays { self.jump } else { 0.0 };
            ground + Vec3::Y * jump
        } else {
            upwards
        };
        next.y -= self.gravity * self.dt;
        if self.world.is_on_ground() {
            next + input.walk.as_vec3()
        } else {
            next + now - upwards
        }
    }
}

impl Controller for Jolt {
    fn step(&mut self, time: f64, input: &Input) -> Result<f64, Box<dyn Error>> {
        self.world.drive(time, self.dt);
        let start = Instant::now();
        self.world.look_at_ground();
        let velocity = self.velocity(input);
        self.world
            .update(velocity, input.walk != DVec3::ZERO, self.dt);
        let took = start.elapsed();
        self.world.step(self.dt)?;
        Ok(took.as_secs_f64() * 1e6)
    }

    fn position(&self) -> DVec3 {
        self.world.feet().as_dvec3() + DVec3::Y * RADIUS
    }

    fn stands(&self) -> bool {
        self.world.is_on_ground()
    }
}
