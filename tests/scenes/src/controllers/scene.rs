//! A scene: its set, the input, and the error that is measured.

use glam::DVec3;

use super::set::{Input, Set};
use super::{ground, platforms, walls};

/// A character's positions in a scene.
pub struct Seen {
    /// Where it came to rest before anything moved; see [`Controller::position`](super::Controller::position).
    pub start: DVec3,
    /// The position after each tick.
    pub positions: Vec<DVec3>,
    /// Seconds a tick.
    pub dt: f64,
}

impl Seen {
    /// Each position with its time.
    pub fn timed(&self) -> impl Iterator<Item = (f64, DVec3)> {
        let ticks = self.positions.iter().enumerate();
        ticks.map(|(tick, p)| (self.dt * (tick as f64 + 1.0), *p))
    }

    /// The last position.
    pub fn end(&self) -> DVec3 {
        self.positions.last().copied().unwrap_or(self.start)
    }

    /// The largest value of a function of time and position; at least 0.
    pub fn most(&self, of: impl Fn(f64, DVec3) -> f64) -> f64 {
        self.timed()
            .map(|(time, p)| of(time, p))
            .fold(0.0, f64::max)
    }
}

/// A scene: a set, an input for each tick, and an error that is measured after the last.
pub struct Scene {
    /// The number of the scenario in `clamber_climber`'s table that it follows.
    pub number: u32,
    /// What is played, for reports.
    pub name: &'static str,
    /// The largest error that passes, in metres.
    pub asked: f64,
    /// Length of the scene.
    pub ticks: u32,
    /// Whether the character has to stand in every tick.
    pub always_stands: bool,
    /// The world.
    pub set: Set,
    /// What the character is told in each tick, the first of which is 1.
    pub input: Box<dyn Fn(u32) -> Input>,
    /// Measures the error, in metres; negative counts as 0.
    pub error: Box<dyn Fn(&Seen) -> f64>,
}

/// All thirty scenes.
pub fn all() -> Vec<Scene> {
    [platforms::scenes(), walls::scenes(), ground::scenes()]
        .into_iter()
        .flatten()
        .collect()
}
