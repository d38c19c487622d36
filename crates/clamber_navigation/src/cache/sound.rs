//! Checks that a graph from a file can be used: all of its indices are within their lists.

use crate::ClimbGraph;

impl ClimbGraph {
    /// True if the graph fits a mesh of this many triangles, and its own lists.
    pub(super) fn is_sound(&self, triangles: usize) -> bool {
        let patches = self.patches.len();
        let is_there = |triangle: usize| triangle < triangles;
        let parts = [
            self.patches
                .iter()
                .all(|patch| is_there(patch.triangle.index())),
            self.entries.iter().all(|entry| entry.patch < patches),
            self.config
                .plates
                .iter()
                .flatten()
                .all(|triangle| is_there(triangle.index())),
            self.ways.is_sound(patches, triangles),
            self.leaps.is_sound(&self.patches, self.clips.clips.len()),
            self.locator.is_sound(patches, triangles),
            self.clips.is_sound(patches),
        ];
        parts.into_iter().all(|part| part)
    }
}

/// True if `start` divides a list of `items` items into `ranges` ranges.
pub(crate) fn divides(start: &[u32], ranges: usize, items: usize) -> bool {
    start.len() == ranges + 1
        && start.first() == Some(&0)
        && start.last().is_some_and(|last| *last as usize == items)
        && start.is_sorted()
}
