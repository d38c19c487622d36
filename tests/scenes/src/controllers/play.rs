//! Steps a character through a scene.

use std::error::Error;

use glam::DVec3;

use super::scene::{Scene, Seen};
use super::set::{IDLE, Input};
use crate::measure::quantile;

/// Ticks in which nothing moves, for the character to come to rest.
const SETTLE: u32 = 60;

/// A character controller in a world of its own.
pub trait Controller {
    /// Takes the world to a time, in seconds, and the character with it. Returns the time that the character's part of
    /// the tick took, in microseconds.
    ///
    /// # Errors
    /// Whatever kept the controller from stepping.
    fn step(&mut self, time: f64, input: &Input) -> Result<f64, Box<dyn Error>>;

    /// The centre of the capsule's lower ball: [`RADIUS`](super::RADIUS) above the feet.
    fn position(&self) -> DVec3;

    /// Whether the controller reports that it stands on something.
    fn stands(&self) -> bool;
}

/// How a character fared in a scene.
pub struct Outcome {
    /// Metres; NaN if a position was not finite.
    pub error: f64,
    /// Ticks in which it did not stand.
    pub in_air: u32,
    /// Whether the error is within the scene's bound, and it stood throughout where the scene asks for that.
    pub passes: bool,
    /// Median time of a tick, in microseconds.
    pub micros: f64,
}

/// Plays a scene, or its first `most` ticks.
///
/// # Errors
/// The first of the controller's.
pub fn play(
    scene: &Scene,
    character: &mut dyn Controller,
    most: u32,
) -> Result<Outcome, Box<dyn Error>> {
    for _ in 0..SETTLE {
        character.step(0.0, &IDLE)?;
    }
    let mut seen = Seen {
        start: character.position(),
        positions: Vec::new(),
        dt: scene.set.dt,
    };
    let mut in_air = 0;
    let mut times = Vec::new();
    for tick in 1..=scene.ticks.min(most) {
        let time = f64::from(tick) * scene.set.dt;
        times.push(character.step(time, &(scene.input)(tick))?);
        seen.positions.push(character.position());
        in_air += u32::from(!character.stands());
    }
    // Checked here, because `f64::max` ignores NaN.
    let is_finite = seen.positions.iter().all(|p| p.is_finite());
    let error = if is_finite {
        (scene.error)(&seen).max(0.0)
    } else {
        f64::NAN
    };
    Ok(Outcome {
        error,
        in_air,
        passes: error <= scene.asked && !(scene.always_stands && in_air > 0),
        micros: quantile(&mut times, 0.5),
    })
}
