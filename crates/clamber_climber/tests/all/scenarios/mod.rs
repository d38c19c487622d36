//! Scenarios by which other engines test characters (a table, in `table.rs`), and scenes after known failures of other
//! engines. Each is played on skin, on bodies and on an obstacle of its own, in moving frames and at other scales
//! (`plays.rs`).
//!
//! `cargo test -p clamber_climber --test all -- --nocapture the_table_in_markdown` prints the table. With
//! CLAMBER_REACHED set, every test prints how close it came to its limits.

mod air;
mod along_ledges;
mod belt;
mod crouching;
mod drops;
mod edges;
mod failures;
mod frames;
mod ground;
mod hands;
mod holds;
mod nonsense;
mod open;
mod platforms;
mod plays;
mod pull_ups;
mod queries;
mod rules;
mod skins;
mod stairs;
mod table;
mod walls;
mod wedges;
