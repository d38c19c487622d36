//! `clamber_fuzz`'s example `soak`, as released.

use crate::run::cargo;

/// Builds and runs it; an error if it found something.
pub(crate) fn run(minutes: f64, seed: u64, case: Option<&str>) -> Result<(), String> {
    let (minutes, seed) = (minutes.to_string(), seed.to_string());
    let run = [
        "run",
        "--release",
        "--package",
        "clamber_fuzz",
        "--features",
        "clamber_surface/scalar",
    ];
    let soak = ["--example", "soak", "--", "--minutes", &minutes];
    let case = case.map_or(vec![], |case| vec!["--case", case]);
    cargo(&[&run[..], &soak, &["--seed", &seed], &case].concat())
}
