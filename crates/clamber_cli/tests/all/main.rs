//! The commands of `clamber`, and the checks of its inspection on real models.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod commands;
mod query_agreement;
mod skinning_accuracy;
