//! The commands of `clamber`.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod commands;
