//! What others test characters with, and where others fail: scenarios in a table that is checked, and scenes after known
//! failures, each played on skin, on bodies and on own obstacles, in moving frames and at other scales (`plays.rs`).
//!
//! `cargo test -p clamber_climber --test scenarios -- --nocapture the_table_in_markdown` prints the table;
//! with CLAMBER_REACHED set, every test prints how near it came to what is demanded.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod belt;
mod edges;
mod failures;
mod frames;
mod ground;
mod hands;
mod nonsense;
mod open;
mod platforms;
mod plays;
mod queries;
mod skins;
mod stage;
mod stairs;
mod table;
mod walls;
mod wedges;
