use thiserror::Error;

/// An invalid number in a body or a tick.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MoverError {
    /// A number, named here, is infinite or NaN.
    #[error("{0} must be finite")]
    NotFinite(&'static str),
    /// A number is outside its range.
    #[error("{name} must be {range}, found {found}")]
    OutOfRange {
        /// Name of the number.
        name: &'static str,
        /// Valid range of the number.
        range: &'static str,
        /// Value of the number.
        found: f64,
    },
}
