//! What tests demand, and by how much it was met.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt::Arguments;
use std::panic::Location;

use super::alike::slack;

/// The most that each place of a test has seen, by its line and the bits of what it allows.
struct Reached(BTreeMap<(&'static str, u32, u64), f64>);

thread_local! {
    static REACHED: RefCell<Reached> = const { RefCell::new(Reached(BTreeMap::new())) };
}

impl Drop for Reached {
    /// At the end of a test's thread: with CLAMBER_REACHED set, its numbers.
    fn drop(&mut self) {
        if std::env::var_os("CLAMBER_REACHED").is_none() {
            return;
        }
        let thread = std::thread::current();
        let test = thread.name().unwrap_or("?").to_owned();
        for ((_, line, allowed), most) in &self.0 {
            let allowed = f64::from_bits(*allowed);
            println!("{test}, line {line}: {most:.1e} of {allowed:.0e}");
        }
    }
}

/// Fails if a number is more than allowed, or none; remembers the largest.
#[track_caller]
pub(crate) fn demand(found: f64, allowed: f64, case: Arguments<'_>) {
    let allowed = allowed + slack();
    assert!(found <= allowed, "{found:e} of at most {allowed:e}: {case}");
    let place = Location::caller();
    REACHED.with_borrow_mut(|reached| {
        let key = (place.file(), place.line(), allowed.to_bits());
        let most = reached.0.entry(key).or_insert(found);
        *most = most.max(found);
    });
}

/// [`demand`], with what to say when it fails.
macro_rules! within {
    ($found:expr, $allowed:expr, $($case:tt)+) => {
        $crate::stage::demand($found, $allowed, format_args!($($case)+))
    };
}
pub(crate) use within;
