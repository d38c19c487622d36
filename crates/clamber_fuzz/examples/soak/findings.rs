//! Panics, caught and kept.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::task::Task;

/// A task that found something.
#[derive(Clone, Debug)]
pub(crate) struct Finding {
    pub(crate) task: Task,
    /// What the panic said, and where.
    pub(crate) message: String,
}

thread_local! {
    static SAID: RefCell<String> = const { RefCell::new(String::new()) };
}

/// From now on panics are kept for [`caught`], and not printed.
pub(crate) fn keep_panics() {
    std::panic::set_hook(Box::new(|panic| {
        SAID.with_borrow_mut(|said| *said = panic.to_string());
    }));
}

/// Does something; what the panic said, if there was one.
pub(crate) fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|_| SAID.with_borrow_mut(std::mem::take))
}
