//! What a scene is made of: solids that move as functions of time, and the rules of who walks on them.

use std::rc::Rc;

use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use glam::DVec3;

use crate::solid::Solid;

/// A rigid pose as a function of time.
pub(crate) type Motion = Rc<dyn Fn(f64) -> Similarity>;

/// A solid, and where it is.
pub(crate) struct Piece {
    pub(crate) solid: Solid,
    pub(crate) motion: Motion,
    pub(crate) moves: bool,
}

/// A scene's world, and the rules of who walks in it.
pub(crate) struct Set {
    pub(crate) pieces: Vec<Piece>,
    /// Where its feet begin.
    pub(crate) feet: DVec3,
    pub(crate) dt: f64,
    /// Down along Y, metres a second squared.
    pub(crate) gravity: f64,
    /// Radians.
    pub(crate) max_slope: f64,
    /// The fastest that it is asked to walk, metres a second.
    pub(crate) speed: f64,
    /// What a jump adds, metres a second.
    pub(crate) jump: f64,
}

/// What a character is told in a tick.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Input {
    /// Level, metres a second, relative to the ground.
    pub(crate) walk: DVec3,
    pub(crate) jump: bool,
}

/// No input.
pub(crate) const IDLE: Input = Input {
    walk: DVec3::ZERO,
    jump: false,
};

/// Radius of the body: what it is kept off by included.
pub(crate) const RADIUS: f64 = 0.32;
/// From the middle of its lower ball to the middle of its upper.
pub(crate) const HEIGHT: f64 = 1.35;
/// What it is kept off by: clamber's skin width, rapier's offset.
pub(crate) const PADDING: f64 = 0.02;
/// How far below it the ground is still found.
pub(crate) const SNAP: f64 = 0.5;
/// The highest step.
pub(crate) const STEP: f64 = 0.4;

/// Ticks at 60 Hz.
pub(crate) const TICK: f64 = 1.0 / 60.0;

impl Set {
    pub(crate) fn new(feet: DVec3) -> Self {
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

    #[must_use]
    pub(crate) fn with(
        mut self,
        solid: Solid,
        motion: impl Fn(f64) -> Similarity + 'static,
    ) -> Self {
        self.pieces.push(Piece {
            solid,
            motion: Rc::new(motion),
            moves: true,
        });
        self
    }

    #[must_use]
    pub(crate) fn with_still(self, solid: Solid) -> Self {
        self.with_placed(solid, Similarity::IDENTITY)
    }

    #[must_use]
    pub(crate) fn with_placed(mut self, solid: Solid, pose: Similarity) -> Self {
        self.pieces.push(Piece {
            solid,
            motion: Rc::new(move |_| pose),
            moves: false,
        });
        self
    }
}

/// Moves without turning.
pub(crate) fn shifted(by: DVec3) -> Similarity {
    Similarity::from_translation(by)
}

/// Turns about an axis through the origin.
pub(crate) fn turned(axis: DVec3, angle: f64) -> Similarity {
    Similarity {
        rotation: rotation_from_axis_angle(axis, angle),
        ..Similarity::IDENTITY
    }
}

pub(crate) fn radians(degrees: f64) -> f64 {
    degrees * core::f64::consts::PI / 180.0
}
