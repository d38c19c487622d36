//! Places of creatures in the world.

use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use glam::{DQuat, DVec3};

use super::Place;
use super::soups::{random_direction, random_turn};

/// Largest distance of a start from the world's origin, metres.
const FARTHEST: f64 = 1e5;

/// The motion of a creature through the world.
#[derive(Debug)]
pub(super) struct Journey {
    /// The creature's size in model units.
    pub(super) extent: f64,
    scale: f64,
    start: DVec3,
    turn: DQuat,
    /// Displacement per tick, metres.
    way: DVec3,
    spin: (DVec3, f64),
}

impl Journey {
    pub(super) fn new(place: Place, rng: &mut fastrand::Rng) -> Self {
        let metres = match place {
            Place::Home | Place::Near | Place::Far => 1.0 + 49.0 * rng.f64(),
            Place::Tiny => 0.01,
            Place::Vast => 1_000.0,
        };
        // The size comes from the model's coordinates, from the creature's scale in the world, or from both.
        let extent = [metres, 1.0, metres * 0.3][rng.usize(0..3)];
        let anywhere = libm::exp10(5.0 * rng.f64());
        let away = match place {
            Place::Home => 0.0,
            Place::Near => 100.0 * rng.f64(),
            Place::Far => FARTHEST,
            Place::Tiny | Place::Vast => anywhere.min(FARTHEST),
        };
        let moves = place != Place::Home;
        let (turn, way) = (random_turn(rng), random_direction(rng));
        let spin = (random_direction(rng), 0.3 * rng.f64());
        Self {
            extent,
            scale: metres / extent,
            start: random_direction(rng) * away,
            turn: if moves { turn } else { DQuat::IDENTITY },
            way: if moves {
                way * (0.2 * metres * rng.f64())
            } else {
                DVec3::ZERO
            },
            spin: if moves { spin } else { (DVec3::Y, 0.0) },
        }
    }

    /// The creature's place in the world at a tick.
    pub(super) fn at(&self, tick: usize) -> Similarity {
        let (axis, angle) = self.spin;
        Similarity {
            rotation: rotation_from_axis_angle(axis, angle * tick as f64) * self.turn,
            scale: self.scale,
            translation: self.start + self.way * tick as f64,
        }
    }
}
