//! Benches of clamber; all of them are in `benches/`, one question each. Run one from the repository's root:
//!
//! ```sh
//! cargo bench -p clamber_benches --bench tick
//! ```
//!
//! With `-- --test` behind it, a bench runs briefly, and still fails if a check of its own fails. The tables go to
//! `target/measure`.
