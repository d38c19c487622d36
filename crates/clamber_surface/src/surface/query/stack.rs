/// Nodes and clusters still to be visited, each with a number of the caller's. The hierarchy is
/// balanced, some 27 binary levels for 2^32 triangles, and each level leaves at most seven.
pub(super) struct Stack<T> {
    entries: [T; CAPACITY],
    count: usize,
}

const CAPACITY: usize = 256;

impl<T: Copy> Stack<T> {
    /// Holds one entry.
    pub(super) fn new(first: T) -> Self {
        Self {
            entries: [first; CAPACITY],
            count: 1,
        }
    }

    pub(super) fn push(&mut self, entry: T) {
        self.entries[self.count] = entry;
        self.count += 1;
    }

    pub(super) fn pop(&mut self) -> Option<T> {
        self.count = self.count.checked_sub(1)?;
        Some(self.entries[self.count])
    }
}
