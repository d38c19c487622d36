//! A character in a scene.

use std::error::Error;

use clamber_scenes::measure::quantile;

use crate::controller::Entry;
use crate::scenes::{Scene, Seen};
use crate::set::IDLE;

/// Ticks in which nothing moves, for it to come to rest.
const SETTLE: u32 = 60;

/// How a character fared.
pub(crate) struct Outcome {
    /// Metres; not a number where a position is none.
    pub(crate) error: f64,
    /// Ticks in which it did not stand.
    pub(crate) in_air: u32,
    /// Whether it did what is asked.
    pub(crate) passes: bool,
    /// Of a tick, median.
    pub(crate) micros: f64,
}

/// Plays a scene, or its first ticks.
pub(crate) fn play(scene: &Scene, entry: &Entry, most: u32) -> Result<Outcome, Box<dyn Error>> {
    let set = &scene.set;
    let mut character = (entry.make)(set)?;
    for _ in 0..SETTLE {
        character.step(0.0, &IDLE)?;
    }
    let mut seen = Seen {
        start: character.position(),
        positions: Vec::new(),
        dt: set.dt,
    };
    let mut in_air = 0;
    let mut times = Vec::new();
    for tick in 1..=scene.ticks.min(most) {
        let time = f64::from(tick) * set.dt;
        times.push(character.step(time, &(scene.input)(tick))?);
        seen.positions.push(character.position());
        in_air += u32::from(!character.stands());
    }
    // Here, because the largest of numbers passes over what is none.
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
