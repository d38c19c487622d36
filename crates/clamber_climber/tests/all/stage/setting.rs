//! Settings of scenarios: kinds of obstacles, a moving frame and a scale.
//!
//! A scenario's code depends neither on frame nor on scale: it is written in its own units, at rest. The stage maps it
//! to the world by the setting of the test's thread, and [`Run`](super::Run) maps the results back to the scenario's
//! units and frame.

use core::fmt;
use std::cell::{Cell, RefCell};

use glam::DVec3;

use super::{Played, Trace};

/// One way to play a scenario.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Setting {
    /// Kinds of obstacles on which a scenario is played in turn, unless it chooses the kind itself.
    pub(crate) kinds: &'static [Played],
    /// Velocity of the whole scene, metres a second.
    pub(crate) frame: DVec3,
    /// Factor on all lengths, speeds and accelerations of the scene and of the climber. Times stay.
    pub(crate) scale: f64,
}

impl Setting {
    /// At rest, in metres, on the kinds of obstacles that most games have: the setting for which scenarios are written.
    pub(crate) const PLAIN: Self = Self::on(&[Played::Root, Played::Joint, Played::Body]);

    /// At rest, in metres, on some kinds of obstacles.
    pub(crate) const fn on(kinds: &'static [Played]) -> Self {
        Self {
            kinds,
            frame: DVec3::ZERO,
            scale: 1.0,
        }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.frame != DVec3::ZERO {
            write!(f, "at {} m/s ", self.frame)?;
        }
        if self.scale != 1.0 {
            write!(f, "times {} ", self.scale)?;
        }
        match self.kinds {
            [one] => write!(f, "on {one:?}"),
            _ => write!(f, "plain"),
        }
    }
}

thread_local! {
    static SETTING: Cell<Setting> = const { Cell::new(Setting::PLAIN) };
    static RUNS: RefCell<Vec<Trace>> = const { RefCell::new(Vec::new()) };
}

/// The setting of this thread.
pub(crate) fn setting() -> Setting {
    SETTING.get()
}

/// Kinds of obstacles on which to play the scenario.
pub(crate) fn kinds() -> &'static [Played] {
    setting().kinds
}

/// The kind of obstacle for a scene that is played on only one.
pub(crate) fn one_kind() -> Played {
    kinds()[0]
}

/// Stores the trace of a finished run for the comparison of settings.
pub(super) fn remember(trace: Trace) {
    RUNS.with_borrow_mut(|runs| runs.push(trace));
}

/// Plays a scenario in a setting. Returns its runs in order, or the message of its failure.
pub(crate) fn play(setting: Setting, scenario: fn()) -> Result<Vec<Trace>, String> {
    SETTING.set(setting);
    RUNS.take();
    let outcome = std::panic::catch_unwind(scenario);
    SETTING.set(Setting::PLAIN);
    let runs = RUNS.take();
    match outcome {
        Ok(()) => Ok(runs),
        Err(cause) => Err(text_of(cause.as_ref())),
    }
}

/// The message of a panic.
fn text_of(cause: &(dyn core::any::Any + Send)) -> String {
    let text = cause.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| cause.downcast_ref::<&str>().copied());
    let text = text.unwrap_or("no reason");
    let text = text.replace("assertion `left == right` failed: ", "");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
