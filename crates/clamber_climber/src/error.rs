use thiserror::Error;

use crate::ClimberMode;

/// The reason why a climber could not be made, configured, restored or stepped. The climber is unchanged.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ClimberError {
    /// A position, state, configuration or input contains an infinity or NaN.
    #[error("{0} must be finite")]
    NotFinite(&'static str),
    /// `support` is inconsistent with `mode`.
    #[error(
        "the `support` of a state must be `Some` in the modes Standing, Holding, Hanging and LedgeHanging, and `None` \
         in the other modes of this crate; this state's mode is {0:?}"
    )]
    Support(ClimberMode),
    /// A new configuration switches off the climber's current mode.
    #[error(
        "the climber is in mode {0:?}, which the new configuration switches off (`grip`, `ledge` or `tumble` is \
         `None`); end the mode first: step the climber without `ClimberInput::grip`, or until it has got up"
    )]
    ModeInUse(ClimberMode),
    /// The body of a new configuration has no room where the climber is.
    #[error(
        "the new body would be {} m deep in what is around the climber; try again elsewhere, or with a smaller one",
        to_three_digits(*lacks)
    )]
    NoRoom {
        /// Depth of the body in the obstacles around it, metres.
        lacks: f64,
    },
    /// Two custom modes have the same id.
    #[error("two custom modes have the id {0}")]
    SameMode(u16),
    /// A number is outside its range.
    #[error("{name} must be {range}, found {found}")]
    OutOfRange {
        /// Name of the number.
        name: &'static str,
        /// The allowed range, in words.
        range: &'static str,
        /// The value found.
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

/// The number to three digits, so that messages are short for bodies of any size.
fn to_three_digits(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lack_of_room_is_told_to_three_digits_at_any_size() {
        for (size, told) in [
            (0.02, " 0.005 m "),
            (1.0, " 0.25 m "),
            (3.0, " 0.75 m "),
            (100.0, " 25 m "),
            (512.345, " 128 m "),
        ] {
            let lacks = 0.249_999_976_470_642_12 * size;
            let found = ClimberError::NoRoom { lacks }.to_string();
            assert!(found.contains(told), "size {size}: {found}");
        }
    }
}
