use thiserror::Error;

use crate::ClimberMode;

/// Why a climber could not be made or stepped. Nothing was changed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ClimberError {
    /// A position, velocity or input is infinite or NaN.
    #[error("{0} must be finite")]
    NotFinite(&'static str),
    /// A state has a support that its mode has not, or lacks one.
    #[error("a state has a support if and only if it stands, holds or hangs; this one is {0:?}")]
    Support(ClimberMode),
    /// A number is outside its range.
    #[error("{name} must be {range}, found {found}")]
    OutOfRange {
        /// Which number.
        name: &'static str,
        /// What it may be.
        range: &'static str,
        /// What it is.
        found: f64,
    },
}
