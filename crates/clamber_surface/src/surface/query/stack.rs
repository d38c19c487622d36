/// Nodes and clusters still to be visited, each with a number of the caller's. The trees of the
/// hierarchy are balanced, some 27 binary levels for 2^32 triangles, and each level leaves at most
/// seven; a further root comes when all below the one before it was visited.
pub(super) struct Stack<T, R> {
    entries: [T; CAPACITY],
    count: usize,
    further_roots: R,
}

const CAPACITY: usize = 256;

impl<T: Copy, R: Iterator<Item = T>> Stack<T, R> {
    /// Holds one root and those to come after it.
    pub(super) fn new(root: T, further_roots: R) -> Self {
        Self {
            entries: [root; CAPACITY],
            count: 1,
            further_roots,
        }
    }

    pub(super) fn push(&mut self, entry: T) {
        self.entries[self.count] = entry;
        self.count += 1;
    }

    pub(super) fn pop(&mut self) -> Option<T> {
        if self.count == 0 {
            return self.further_roots.next();
        }
        self.count -= 1;
        Some(self.entries[self.count])
    }
}
