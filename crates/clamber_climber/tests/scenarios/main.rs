//! What others test characters with, and where others fail: fifty scenarios in a table that is checked, each played
//! on skin and on bodies, and scenes after known failures.
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
