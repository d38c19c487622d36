//! Helpers that the scenes of rules share.

use core::fmt;

use clamber_climber::{ClimberConfig, ContactQuery, ContactRule};
use glam::DVec3;

use crate::stage::{Played, Run, Shape, Stage, Trace, every};

/// Radius of the body, metres.
pub(crate) const RADIUS: f64 = 0.4;

/// Gravity, metres a second squared.
pub(crate) const G: f64 = 9.81;

/// Number of the shape that a rule treats differently; all other shapes have the number 0.
pub(crate) const ODD: u32 = 1;

/// Kind of the obstacles, and ticks a second.
#[derive(Clone, Copy)]
pub(crate) struct Case {
    played: Played,
    pub(crate) rate: f64,
}

impl Case {
    pub(crate) fn stage(self) -> Stage {
        Stage::at(self.played, 1.0 / self.rate, DVec3::ZERO)
    }

    /// The number of ticks in a time in seconds.
    pub(crate) fn ticks(self, seconds: f64) -> u32 {
        (self.rate * seconds).round() as u32
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}, {} Hz", self.played, self.rate)
    }
}

/// Plays a scene at every rate on every kind of obstacle.
pub(crate) fn at_every_rate(play: impl Fn(Case) -> Trace) {
    for rate in [30.0, 60.0, 240.0] {
        every(0.0, |played| play(Case { played, rate }));
    }
}

/// The usual rule, with the rule `odd` for the shape with the number [`ODD`].
pub(crate) fn but(
    odd: impl Fn(&ContactQuery<'_>) -> ContactRule,
) -> impl Fn(&ContactQuery<'_>) -> ContactRule {
    move |query| {
        if query.tag().user == ODD {
            odd(query)
        } else {
            query.usual()
        }
    }
}

/// A climber that neither tires nor is hurt.
pub(crate) fn person() -> ClimberConfig {
    ClimberConfig {
        stamina: None,
        health: None,
        tumble: None,
        ..ClimberConfig::colossus_climber()
    }
}

/// A wall whose face is at z 0, from one height to another.
pub(crate) fn wall(from: f64, to: f64) -> Shape {
    Shape::boxed(DVec3::new(-3.0, from, -1.0), DVec3::new(3.0, to, 0.0))
}

/// A climber that holds a wall, with its centre at a height.
pub(crate) fn at_wall(stage: Stage, height: f64) -> Run {
    let feet = DVec3::new(0.0, height - RADIUS, RADIUS);
    Run::new(stage, person(), feet)
}
