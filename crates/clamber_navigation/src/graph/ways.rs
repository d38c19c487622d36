//! Ways between patches.

use std::collections::BTreeMap;

use clamber_surface::mesh::TriangleId;

use super::Patch;

/// How a climber gets from one patch to another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Way {
    /// True if it can walk.
    pub(crate) walks: bool,
    /// True if it can climb.
    pub(crate) climbs: bool,
}

/// A place in a corner where the climber's ball touches the skin of two patches. There the climber changes from one
/// patch to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Corner {
    /// The triangle of a point on the skin of the patch with the lower number.
    pub(crate) triangle: TriangleId,
    /// Barycentric weights of that point.
    pub(crate) barycentric: [f64; 3],
    /// A triangle of the other patch.
    pub(crate) other: TriangleId,
    /// The vector from that point to the ball's middle, as factors of both triangles' normals, metres.
    pub(crate) apart: [f64; 2],
}

/// For each patch, the ways that lead away from it.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Ways {
    /// The ways from patch p are `start[p]..start[p + 1]`.
    start: Vec<u32>,
    to: Vec<u32>,
    way: Vec<Way>,
    /// Length at rest, metres.
    length: Vec<f32>,
    /// The corners on ways that lead around one, by the ways' ends, the lower one first.
    corners: BTreeMap<(u32, u32), Corner>,
}

impl Ways {
    /// Creates the list from ways for both directions, by their ends, the lower one first.
    pub(super) fn new(
        patches: &[Patch],
        found: &BTreeMap<(u32, u32), Way>,
        corners: BTreeMap<(u32, u32), Corner>,
    ) -> Self {
        let mut beside: Vec<Vec<(u32, Way)>> = vec![Vec::new(); patches.len()];
        for (&(from, to), &way) in found {
            beside[from as usize].push((to, way));
            beside[to as usize].push((from, way));
        }
        let mut ways = Self {
            start: vec![0],
            corners,
            ..Self::default()
        };
        for (from, mut beside) in beside.into_iter().enumerate() {
            beside.sort_unstable_by_key(|(to, _)| *to);
            for (to, way) in beside {
                let length = patches[from].seat.distance(patches[to as usize].seat);
                ways.to.push(to);
                ways.way.push(way);
                ways.length.push(length as f32);
            }
            ways.start.push(ways.to.len() as u32);
        }
        ways
    }

    /// The ways from a patch: the other end, how the climber moves, and the length at rest, metres.
    pub(crate) fn of(&self, patch: usize) -> impl Iterator<Item = (usize, Way, f64)> + '_ {
        let range = self.start[patch] as usize..self.start[patch + 1] as usize;
        range.map(|at| {
            (
                self.to[at] as usize,
                self.way[at],
                f64::from(self.length[at]),
            )
        })
    }

    /// The corner on the way between two patches, if the way has one.
    pub(crate) fn corner(&self, from: usize, to: usize) -> Option<&Corner> {
        let ends = (from.min(to) as u32, from.max(to) as u32);
        self.corners.get(&ends)
    }

    /// True if the ways fit this many patches, and their corners a mesh of this many triangles.
    #[cfg(feature = "cache")]
    pub(crate) fn is_sound(&self, patches: usize, triangles: usize) -> bool {
        let corner = |corner: &Corner| {
            let ends = [corner.triangle, corner.other];
            ends.iter().all(|triangle| triangle.index() < triangles)
        };
        crate::cache::divides(&self.start, patches, self.to.len())
            && self.way.len() == self.to.len()
            && self.length.len() == self.to.len()
            && self
                .length
                .iter()
                .all(|length| *length >= 0.0 && length.is_finite())
            && self.to.iter().all(|to| (*to as usize) < patches)
            && self.corners.values().all(corner)
    }

    /// Number of ways; both directions count.
    pub(crate) fn len(&self) -> usize {
        self.to.len()
    }
}
