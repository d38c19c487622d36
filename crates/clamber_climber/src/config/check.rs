//! Range checks for the numbers of a configuration.

use crate::ClimberError;

pub(super) fn check(
    name: &'static str,
    range: &'static str,
    found: f64,
    holds: bool,
) -> Result<(), ClimberError> {
    if holds {
        Ok(())
    } else {
        Err(ClimberError::OutOfRange { name, range, found })
    }
}

pub(super) fn positive(name: &'static str, x: f64) -> Result<(), ClimberError> {
    check(name, "positive and finite", x, x > 0.0 && x.is_finite())
}

pub(super) fn not_negative(name: &'static str, x: f64) -> Result<(), ClimberError> {
    check(
        name,
        "not negative and finite",
        x,
        x >= 0.0 && x.is_finite(),
    )
}

/// A limit may be infinite; it is then never reached.
pub(super) fn limit(name: &'static str, x: f64) -> Result<(), ClimberError> {
    check(name, "not negative", x, x >= 0.0)
}

pub(super) fn share(name: &'static str, x: f64) -> Result<(), ClimberError> {
    check(name, "from 0 to 1", x, (0.0..=1.0).contains(&x))
}
