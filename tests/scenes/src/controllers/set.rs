//! The world of a scene: solids that move as functions of time, and the character's parameters.

use std::rc::Rc;

use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use glam::DVec3;

use super::solid::Solid;

/// A rigid pose as a function of time.
pub type Motion = Rc<dyn Fn(f64) -> Similarity>;

/// A solid and its motion.
pub struct Piece {
    /// The shape, in its own space.
    pub solid: Solid,
    /// The pose that puts the shape into the world, at a time in seconds.
    pub motion: Motion,
    /// False for terrain, whose pose never changes.
    pub moves: bool,
}

/// A scene's world and the parameters of the character in it.
pub struct Set {
    /// The solids.
    pub pieces: Vec<Piece>,
    /// Where the character's feet start.
    pub feet: DVec3,
    /// Seconds a tick.
    pub dt: f64,
    /// Acceleration along -Y, in metres per second squared.
    pub gravity: f64,
    /// The steepest slope that it stands on, in radians.
    pub max_slope: f64,
    /// The highest walking speed of the scene's inputs, in metres per second.
    pub speed: f64,
    /// The speed that a jump adds, in metres per second.
    pub jump: f64,
}

/// What a character is told in a tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Input {
    /// Horizontal velocity relative to the ground, in metres per second.
    pub walk: DVec3,
    /// Whether it jumps in this tick.
    pub jump: bool,
}

/// No input.
pub const IDLE: Input = Input {
    walk: DVec3::ZERO,
    jump: false,
};

/// Radius of the capsule, [`PADDING`] included, in metres.
pub const RADIUS: f64 = 0.32;
/// From the centre of the capsule's lower ball to that of the upper, in metres.
pub const HEIGHT: f64 = 1.35;
/// The contact offset that the controllers keep, in metres: part of [`RADIUS`].
pub const PADDING: f64 = 0.02;
/// How far below the feet the ground is still found, in metres.
pub const SNAP: f64 = 0.5;
/// The highest step that it climbs, in metres.
pub const STEP: f64 = 0.4;

/// Seconds a tick at 60 Hz.
pub const TICK: f64 = 1.0 / 60.0;

impl Set {
    /// An empty world with gravity of 9.81 m/s², slopes to 50 degrees, and a character that neither walks nor jumps.
    #[must_use]
    pub fn new(feet: DVec3) -> Self {
        Self {
            pieces: Vec::new(),
            feet,
            dt: TICK,
            gravity: 9.81,
            max_slope: radians(50.0),
            speed: 0.0,
            jump: 0.0,
        }
    }

    /// Adds a solid that moves.
    #[must_use]
    pub fn with(self, solid: Solid, motion: impl Fn(f64) -> Similarity + 'static) -> Self {
        self.with_piece(solid, Rc::new(motion), true)
    }

    /// Adds terrain, in world space.
    #[must_use]
    pub fn with_still(self, solid: Solid) -> Self {
        self.with_placed(solid, Similarity::IDENTITY)
    }

    /// Adds terrain at a pose.
    #[must_use]
    pub fn with_placed(self, solid: Solid, pose: Similarity) -> Self {
        self.with_piece(solid, Rc::new(move |_| pose), false)
    }

    fn with_piece(mut self, solid: Solid, motion: Motion, moves: bool) -> Self {
        self.pieces.push(Piece {
            solid,
            motion,
            moves,
        });
        self
    }
}

/// A translation.
pub fn shifted(by: DVec3) -> Similarity {
    Similarity::from_translation(by)
}

/// A rotation about an axis through the origin, by radians.
pub fn turned(axis: DVec3, angle: f64) -> Similarity {
    Similarity {
        rotation: rotation_from_axis_angle(axis, angle),
        ..Similarity::IDENTITY
    }
}

/// Radians of an angle in degrees.
pub fn radians(degrees: f64) -> f64 {
    degrees * core::f64::consts::PI / 180.0
}
