//! Limits of tests, and how close runs came to them.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt::Arguments;
use std::panic::Location;

use super::alike::slack;

/// The largest number at each limit of a test, by source line and the bits of the limit.
struct Reached(BTreeMap<(&'static str, u32, u64), f64>);

thread_local! {
    static REACHED: RefCell<Reached> = const { RefCell::new(Reached(BTreeMap::new())) };
}

impl Drop for Reached {
    /// Prints the numbers at the end of a test's thread, if CLAMBER_REACHED is set.
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

/// Fails if a number is above its limit or NaN. Records the largest number.
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

/// [`demand`] with a message for failures.
macro_rules! within {
    ($found:expr, $allowed:expr, $($case:tt)+) => {
        $crate::stage::demand($found, $allowed, format_args!($($case)+))
    };
}
pub(crate) use within;
