//! The commands of `clamber`.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod commands;
