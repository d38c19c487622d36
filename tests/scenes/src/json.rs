//! Numbers in JSON that may be infinite or NaN.

use serde::Serializer;

/// Serialises a finite number as a number, any other as text (`inf`, `-inf`, `NaN`), where JSON would have `null`.
pub(crate) fn number<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if number.is_finite() {
        serializer.serialize_f64(*number)
    } else {
        serializer.serialize_str(&number.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn infinity_and_nan_are_written_as_text() {
        #[derive(serde::Serialize)]
        struct One(#[serde(serialize_with = "number")] f64);
        let written = |number| serde_json::to_string(&One(number)).unwrap();
        assert_eq!(written(0.5), "0.5");
        assert_eq!(written(f64::INFINITY), "\"inf\"");
        assert_eq!(written(f64::NAN), "\"NaN\"");
    }
}
