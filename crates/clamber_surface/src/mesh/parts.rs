//! The parts of a mesh: the triangles that one joint moves most.

use super::derived::Derived;
use super::{PartId, TriangleId, VertexId};
use crate::rig::JointId;

/// The triangles that one joint moves most, bounded together.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Part {
    /// The joint with the largest sum of weights over the three corners of each triangle; on a tie, the smaller id.
    pub joint: JointId,
    /// The triangles, in ascending order.
    pub triangles: Vec<TriangleId>,
    /// The corners of the triangles, each once, in ascending order.
    pub vertices: Vec<VertexId>,
}

impl Part {
    fn without_triangles(joint: JointId) -> Self {
        Self {
            joint,
            triangles: Vec::new(),
            vertices: Vec::new(),
        }
    }

    /// Updates the vertices from the triangles. `corners` holds the corners of all triangles of the mesh.
    fn collect_vertices(&mut self, corners: &[[VertexId; 3]]) {
        self.vertices.clear();
        let own = self.triangles.iter().flat_map(|t| corners[t.index()]);
        self.vertices.extend(own);
        self.vertices.sort_unstable();
        self.vertices.dedup();
    }
}

/// The joint of every part, and the part of every triangle. Most queries need no more than this, so the lists of a
/// part's triangles and vertices are made on first use: by edits, by spheres around parts, and by callers of
/// [`Parts::lists`].
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Parts {
    /// By part.
    joints: Vec<JointId>,
    of: PartOf,
    lists: Derived<Vec<Part>>,
}

impl Parts {
    /// One part for every joint that some triangle has as its dominant one, by ascending joint.
    pub(super) fn of_joints(joints: &[JointId]) -> Self {
        let mut parts: Vec<JointId> = joints.to_vec();
        parts.sort_unstable();
        parts.dedup();
        parts.shrink_to_fit();
        let mut of = PartOf::default();
        for joint in joints {
            of.push(parts.partition_point(|other| other < joint));
        }
        Self {
            joints: parts,
            of,
            lists: Derived::default(),
        }
    }

    /// Number of parts.
    pub(super) fn count(&self) -> usize {
        self.joints.len()
    }

    /// The joint of a part.
    ///
    /// # Panics
    /// If there is no such part.
    pub(super) fn joint(&self, part: PartId) -> JointId {
        self.joints[part.index()]
    }

    /// The part that a triangle belongs to; `None` if it was removed or never existed.
    #[inline]
    pub(super) fn of(&self, triangle: TriangleId) -> Option<PartId> {
        self.of.get(triangle.index()).map(PartId)
    }

    /// All parts with their lists. `corners` holds the corners of all triangles.
    pub(super) fn lists(&self, corners: &[[VertexId; 3]]) -> &[Part] {
        self.lists.get_or(|| self.list(corners))
    }

    fn list(&self, corners: &[[VertexId; 3]]) -> Vec<Part> {
        let parts = self.joints.iter().copied();
        let mut parts: Vec<Part> = parts.map(Part::without_triangles).collect();
        for index in 0..corners.len() {
            let triangle = TriangleId(index as u32);
            if let Some(part) = self.of(triangle) {
                parts[part.index()].triangles.push(triangle);
            }
        }
        for part in &mut parts {
            part.collect_vertices(corners);
            part.triangles.shrink_to_fit();
            part.vertices.shrink_to_fit();
        }
        parts
    }

    /// Drops the lists, and memory that is not used.
    pub(super) fn shrink(&mut self) {
        self.lists.forget();
        match &mut self.of {
            PartOf::Two(parts) => parts.shrink_to_fit(),
            PartOf::Four(parts) => parts.shrink_to_fit(),
        }
    }

    /// Adds the next triangle to the part of a joint; adds the part if the joint has none. From then on the part's
    /// lists are out of date, until [`Parts::renew`].
    pub(super) fn push(&mut self, triangle: TriangleId, joint: JointId) -> PartId {
        let known = self.joints.iter().position(|other| *other == joint);
        let part = known.unwrap_or(self.joints.len());
        if known.is_none() {
            self.joints.push(joint);
        }
        self.of.push(part);
        if let Some(lists) = self.lists.get_mut() {
            if known.is_none() {
                lists.push(Part::without_triangles(joint));
            }
            lists[part].triangles.push(triangle);
        }
        PartId(part as u32)
    }

    /// Takes a triangle out of its part. From then on the part's lists are out of date, until [`Parts::renew`].
    pub(super) fn remove(&mut self, triangle: TriangleId) {
        self.of.remove(triangle.index());
    }

    /// Brings the lists of a part up to date, if there are lists. `corners` holds the corners of all triangles.
    pub(super) fn renew(&mut self, part: PartId, corners: &[[VertexId; 3]]) {
        let of = &self.of;
        if let Some(lists) = self.lists.get_mut() {
            let own = &mut lists[part.index()];
            own.triangles
                .retain(|triangle| of.get(triangle.index()) == Some(part.0));
            own.collect_vertices(corners);
        }
    }

    /// Size of the arrays in bytes, lists included if they were made.
    pub(super) fn memory(&self) -> usize {
        let lists = self.lists.get().into_iter().flatten();
        let lists = lists.map(|p| size_of_val(&p.triangles[..]) + size_of_val(&p.vertices[..]));
        size_of_val(&self.joints[..]) + self.of.memory() + lists.sum::<usize>()
    }
}

/// A part for each triangle, or none. Takes two bytes a triangle while all numbers of parts fit, otherwise four.
#[derive(Clone, Debug)]
enum PartOf {
    Two(Vec<u16>),
    Four(Vec<u32>),
}

impl PartOf {
    #[inline]
    fn get(&self, triangle: usize) -> Option<u32> {
        match self {
            Self::Two(parts) => {
                let part = *parts.get(triangle)?;
                (part != u16::MAX).then_some(u32::from(part))
            }
            Self::Four(parts) => {
                let part = *parts.get(triangle)?;
                (part != u32::MAX).then_some(part)
            }
        }
    }

    /// Adds the part of another triangle.
    fn push(&mut self, part: usize) {
        if let Self::Two(parts) = self
            && part >= usize::from(u16::MAX)
        {
            let wide = |part: &u16| match *part {
                u16::MAX => u32::MAX,
                part => u32::from(part),
            };
            *self = Self::Four(parts.iter().map(wide).collect());
        }
        match self {
            Self::Two(parts) => parts.push(part as u16),
            Self::Four(parts) => parts.push(part as u32),
        }
    }

    /// # Panics
    /// If there is no such triangle.
    fn remove(&mut self, triangle: usize) {
        match self {
            Self::Two(parts) => parts[triangle] = u16::MAX,
            Self::Four(parts) => parts[triangle] = u32::MAX,
        }
    }

    fn memory(&self) -> usize {
        match self {
            Self::Two(parts) => size_of_val(&parts[..]),
            Self::Four(parts) => size_of_val(&parts[..]),
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Two(parts) => parts.len(),
            Self::Four(parts) => parts.len(),
        }
    }
}

impl Default for PartOf {
    fn default() -> Self {
        Self::Two(Vec::new())
    }
}

/// Equal if each triangle has the same part.
impl PartialEq for PartOf {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && (0..self.len()).all(|t| self.get(t) == other.get(t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three corners that no other triangle has.
    fn corners(triangle: u32) -> [VertexId; 3] {
        [0, 1, 2].map(|corner| VertexId(3 * triangle + corner))
    }

    #[test]
    fn lists_are_the_same_whether_they_follow_edits_or_are_made_after_them() {
        let mut rng = fastrand::Rng::with_seed(5);
        for _ in 0..200 {
            let joints: Vec<JointId> = (0..20).map(|_| JointId(2 * rng.u32(0..6))).collect();
            let mut all: Vec<_> = (0..20).map(corners).collect();
            let mut late = Parts::of_joints(&joints);
            let mut early = late.clone();
            early.lists(&all);
            for _ in 0..30 {
                let next = TriangleId(all.len() as u32);
                let (joint, gone) = (JointId(rng.u32(0..14)), TriangleId(rng.u32(0..next.0)));
                all.push(corners(next.0));
                let added = early.push(next, joint);
                assert_eq!(late.push(next, joint), added);
                assert_eq!((early.joint(added), early.of(next)), (joint, Some(added)));
                let touched = early.of(gone);
                for parts in [&mut early, &mut late] {
                    parts.remove(gone);
                    assert_eq!(parts.of(gone), None);
                    parts.renew(added, &all);
                    if let Some(part) = touched {
                        parts.renew(part, &all);
                    }
                }
            }
            let lists = late.lists(&all).to_vec();
            assert_eq!(early.lists(&all), lists);
            assert_eq!((early.count(), &early), (lists.len(), &late));
            let held: usize = lists.iter().map(|part| part.triangles.len()).sum();
            let triangles = (0..all.len() as u32).map(TriangleId);
            assert_eq!(held, triangles.filter(|t| late.of(*t).is_some()).count());
        }
    }

    #[test]
    fn more_parts_than_two_bytes_can_number_are_told_apart() {
        let mut parts = Parts::default();
        let mut removed = Parts::default();
        for index in 0..70_000 {
            let triangle = TriangleId(index);
            parts.of.push(index as usize);
            removed.of.push(index as usize);
            if index % 7 == 0 {
                removed.remove(triangle);
            }
        }
        for index in 0..70_000 {
            assert_eq!(parts.of(TriangleId(index)), Some(PartId(index)));
            let kept = (index % 7 != 0).then_some(PartId(index));
            assert_eq!(removed.of(TriangleId(index)), kept);
        }
        assert_eq!(parts.of(TriangleId(70_000)), None);
        assert_ne!(parts, removed);
    }
}
