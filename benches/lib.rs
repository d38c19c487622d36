//! Benches of clamber. Each answers one question. Run one from the repository's root:
//!
//! ```sh
//! cargo bench -p clamber_benches --bench tick
//! ```
//!
//! With `-- --test` at the end, a bench runs briefly, and still fails if one of its own checks fails. The tables go to
//! `target/measure`.
