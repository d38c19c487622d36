//! Scenes, and what is asked in them.

mod ground;
mod platforms;
mod walls;

use glam::DVec3;

use crate::set::{Input, Set};

/// What a character did.
pub(crate) struct Seen {
    /// Where it came to rest before anything moved, as [`Controller::position`](crate::controller::Controller).
    pub(crate) start: DVec3,
    /// After each tick.
    pub(crate) positions: Vec<DVec3>,
    pub(crate) dt: f64,
}

impl Seen {
    /// Each position with its time.
    pub(crate) fn timed(&self) -> impl Iterator<Item = (f64, DVec3)> {
        let ticks = self.positions.iter().enumerate();
        ticks.map(|(tick, p)| (self.dt * (tick as f64 + 1.0), *p))
    }

    pub(crate) fn end(&self) -> DVec3 {
        self.positions.last().copied().unwrap_or(self.start)
    }

    /// The largest of what is told of each time and position.
    pub(crate) fn most(&self, of: impl Fn(f64, DVec3) -> f64) -> f64 {
        self.timed()
            .map(|(time, p)| of(time, p))
            .fold(0.0, f64::max)
    }
}

/// A scene.
pub(crate) struct Scene {
    /// In the table of `clamber_climber`'s scenarios.
    pub(crate) number: u32,
    pub(crate) name: &'static str,
    /// The error's bound, metres.
    pub(crate) asked: f64,
    pub(crate) ticks: u32,
    /// Whether it may never be in the air.
    pub(crate) always_stands: bool,
    pub(crate) set: Set,
    pub(crate) input: Box<dyn Fn(u32) -> Input>,
    /// Metres.
    pub(crate) error: Box<dyn Fn(&Seen) -> f64>,
}

/// All scenes.
pub(crate) fn all() -> Vec<Scene> {
    [platforms::scenes(), walls::scenes(), ground::scenes()]
        .into_iter()
        .flatten()
        .collect()
}
