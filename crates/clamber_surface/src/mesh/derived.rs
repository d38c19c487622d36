use std::sync::OnceLock;

/// A value derived from the rest of its owner: computed on first use, and ignored by comparison.
#[derive(Clone, Debug)]
pub(crate) struct Derived<T>(OnceLock<T>);

impl<T> Derived<T> {
    pub(crate) fn get_or(&self, compute: impl FnOnce() -> T) -> &T {
        self.0.get_or_init(compute)
    }

    /// The value, if it was computed.
    pub(super) fn get(&self) -> Option<&T> {
        self.0.get()
    }

    /// The value, if it was computed.
    pub(super) fn get_mut(&mut self) -> Option<&mut T> {
        self.0.get_mut()
    }

    /// Drops the value. Call it when the data that it is derived from change.
    pub(crate) fn forget(&mut self) {
        self.0.take();
    }
}

impl<T> Default for Derived<T> {
    fn default() -> Self {
        Self(OnceLock::new())
    }
}

impl<T> PartialEq for Derived<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
