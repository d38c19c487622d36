//! Numbers in JSON, which has none that are infinite.

use serde::Serializer;

/// A number; as text, `inf` or `NaN`, where JSON would have `null`.
///
/// # Errors
/// Those of the serializer.
pub(crate) fn number<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if number.is_finite() {
        serializer.serialize_f64(*number)
    } else {
        serializer.serialize_str(&number.to_string())
    }
}
