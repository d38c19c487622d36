//! Open scenarios: those that fail in some settings, and by how much.

/// One line per failure: the scenario, the setting as [`Setting`](crate::stage::Setting) prints it (or `in every
/// setting`), and the result.
///
/// A listed scenario that passes fails the suite, so that a fix also removes its lines. `CLAMBER_OPEN=1 cargo test -p
/// clamber_climber --test scenarios -- --nocapture | grep '^OPEN ' | cut -c6- | sort` prints the lines that the file
/// should have.
const OPEN: &str = include_str!("open.txt");

/// Scenario and setting of each line.
pub(crate) fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    OPEN.lines().filter_map(|line| {
        let mut parts = line.split(" | ");
        Some((parts.next()?, parts.next()?))
    })
}
