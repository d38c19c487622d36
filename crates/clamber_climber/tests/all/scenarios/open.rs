//! Open scenarios: scenarios that fail in some settings, with the size of the failure.

/// One line per failure: the scenario, the setting as [`Setting`](crate::stage::Setting) prints it (or `in every
/// setting`), and the result.
///
/// A listed scenario that passes fails the suite, so that a fix also removes its lines. `CLAMBER_OPEN=1 cargo test -p
/// clamber_climber --test all scenarios -- --nocapture | grep '^OPEN ' | cut -c6- | sort` prints the lines that the
/// file should have.
const OPEN: &str = include_str!("open.txt");

/// Scenario and setting of each line.
pub(crate) fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    OPEN.lines().filter_map(|line| {
        let mut parts = line.split(" | ");
        Some((parts.next()?, parts.next()?))
    })
}

/// The reasons why the scenarios of the file are open. They were found by starting the climber off its place by 1e-12
/// to 1e-5 m, and by comparing its contacts.
const REASONS: &[(&str, &str)] = &[
    (
        "a_hold_that_shakes_is_hung_from_until_it_is_calm",
        "who hangs swings by the hold's acceleration, which is a second difference of positions: up to four f32 steps a \
         tick, of which it has less than three, where two are allowed for velocities",
    ),
    (
        "root_and_joint_carry_a_walker_alike_through_a_storm",
        "the jump comes down on a fold of the hills. A sweep stops up to 0.1 mm early there, where either of the fold's \
         two triangles may be the nearer one. The velocity after it differs by the 0.7 degrees between both, and where it \
         comes down differs by the f32 rounding of the jump's velocity",
    ),
    (
        "two_walls_through_the_body_lift_it_out_and_let_it_go",
        "both walls are as deep in the body, and rounding decides which one lifts it out first: a start that is off by \
         1e-12 m leads to either of two results 4.6 um apart",
    ),
];

/// The reason why a scenario is open.
pub(crate) fn reason(test: &str) -> Option<&'static str> {
    let mut reasons = REASONS.iter();
    reasons.find_map(|(name, why)| (*name == test).then_some(*why))
}

/// The scenarios that have a reason.
pub(crate) fn explained() -> impl Iterator<Item = &'static str> {
    REASONS.iter().map(|(name, _)| *name)
}
