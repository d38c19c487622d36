use thiserror::Error;

/// Why a mover could not be made.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MoverError {
    /// A number is infinite or NaN.
    #[error("{0} must be finite")]
    NotFinite(&'static str),
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
