//! Catches panics and keeps their messages.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::task::Task;

/// A task whose check failed, or that panicked otherwise.
#[derive(Clone, Debug)]
pub(crate) struct Finding {
    pub(crate) task: Task,
    /// The panic's message and its place in the source.
    pub(crate) message: String,
}

thread_local! {
    /// The message of this thread's last panic.
    static SAID: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Installs a hook that keeps panics for [`caught`] instead of printing them.
pub(crate) fn keep_panics() {
    std::panic::set_hook(Box::new(|panic| {
        SAID.with_borrow_mut(|said| *said = panic.to_string());
    }));
}

/// Calls `work`; returns the message of its panic as an error.
pub(crate) fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|_| SAID.with_borrow_mut(std::mem::take))
}
