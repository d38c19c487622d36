use thiserror::Error;

use crate::ClimberMode;

/// Why a climber could not be made or stepped. Nothing was changed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ClimberError {
    /// A position, velocity or input is infinite or NaN.
    #[error("{0} must be finite")]
    NotFinite(&'static str),
    /// `support` is inconsistent with `mode`.
    #[error("a state has a support if and only if it stands, holds or hangs; this one is {0:?}")]
    Support(ClimberMode),
    /// A new configuration switches the mode off that the climber is in.
    #[error(
        "a climber that is {0:?} cannot take a configuration without what that needs (`grip`, `ledge` or `tumble` is \
         `None`); let it end the mode first: step it without `ClimberInput::grip`, or until it has got up"
    )]
    ModeInUse(ClimberMode),
    /// Two handlers of modes have the same number.
    #[error("two modes have the number {0}")]
    SameMode(u16),
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

impl From<clamber_mover::MoverError> for ClimberError {
    fn from(error: clamber_mover::MoverError) -> Self {
        match error {
            clamber_mover::MoverError::OutOfRange { name, range, found } => {
                Self::OutOfRange { name, range, found }
            }
            clamber_mover::MoverError::NotFinite(name) => Self::NotFinite(name),
            _ => Self::NotFinite("body"),
        }
    }
}
