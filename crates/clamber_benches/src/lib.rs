//! Benches of clamber; all of them are in `benches/`, one question each. Run one from the repository's root:
//!
//! ```sh
//! cargo bench -p clamber_benches --bench tick
//! ```
//!
//! With `-- --test` behind it, a bench runs briefly and checks what it checks. The tables go to `target/measure`.
