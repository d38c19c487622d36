//! How scenarios are played: on which obstacles, in which moving frame, at which scale.
//!
//! A scenario's text has neither frame nor scale: it says where things are in its own units, at rest. The stage puts it
//! into the world of the setting of the test's thread, and [`Run`](super::Run) gives back what happened in the
//! scenario's units and frame.

use core::fmt;
use std::cell::{Cell, RefCell};

use glam::DVec3;

use super::{Played, Trace};

/// One way to play a scenario.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Setting {
    /// Obstacles that a scenario which does not care is played on, one after the other.
    pub(crate) kinds: &'static [Played],
    /// Velocity of the whole scene, metres a second.
    pub(crate) frame: DVec3,
    /// By which all lengths, speeds and accelerations of the scene and of the climber are multiplied; times are as they
    /// are.
    pub(crate) scale: f64,
}

impl Setting {
    /// At rest, in metres, on all that most games have: the setting that scenarios are written in.
    pub(crate) const PLAIN: Self = Self::on(&[Played::Root, Played::Joint, Played::Body]);

    /// At rest, in metres.
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

/// Obstacles that the scenario is to be played on.
pub(crate) fn kinds() -> &'static [Played] {
    setting().kinds
}

/// The obstacle of a scene that is played on one.
pub(crate) fn one_kind() -> Played {
    kinds()[0]
}

/// Remembers a run that has ended, for what compares settings.
pub(super) fn remember(trace: Trace) {
    RUNS.with_borrow_mut(|runs| runs.push(trace));
}

/// Plays a scenario in a setting: its runs in their order, or how it failed.
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

/// What a panic said.
fn text_of(cause: &(dyn core::any::Any + Send)) -> String {
    let text = cause.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| cause.downcast_ref::<&str>().copied());
    let text = text.unwrap_or("no reason");
    let text = text.replace("assertion `left == right` failed: ", "");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
