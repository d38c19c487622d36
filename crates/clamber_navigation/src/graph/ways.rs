//! Ways from patch to patch.

use std::collections::BTreeMap;

use clamber_surface::mesh::TriangleId;

use super::Patch;

/// How a climber gets from one patch to another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Way {
    /// It walks.
    pub(crate) walks: bool,
    /// It climbs.
    pub(crate) climbs: bool,
}

/// A place in a corner, where the climber's ball touches the skin of two patches: it gets from one to the other there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Corner {
    /// A point of the skin of the patch with the lower number, and a triangle of the other one's.
    pub(crate) triangle: TriangleId,
    pub(crate) barycentric: [f64; 3],
    pub(crate) other: TriangleId,
    /// How far the ball is from that point, along the normals of both triangles, metres.
    pub(crate) apart: [f64; 2],
}

/// Of each patch, the ways that lead away from it.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Ways {
    /// Those of patch p are `start[p]..start[p + 1]`.
    start: Vec<u32>,
    to: Vec<u32>,
    way: Vec<Way>,
    /// Length at rest, metres.
    length: Vec<f32>,
    /// The corners of ways that lead around one, by their ends, the lower one first.
    corners: BTreeMap<(u32, u32), Corner>,
}

impl Ways {
    /// From ways that lead there and back, by their ends, the lower one first.
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

    /// Those that lead away from a patch: where to, how, and how far it is at rest, metres.
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

    /// The corner on the way between two patches, if there is one.
    pub(crate) fn corner(&self, from: usize, to: usize) -> Option<&Corner> {
        let ends = (from.min(to) as u32, from.max(to) as u32);
        self.corners.get(&ends)
    }

    /// True if they lead from and to so many patches, over a mesh of so many triangles.
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

    /// Number of them.
    pub(crate) fn len(&self) -> usize {
        self.to.len()
    }
}
