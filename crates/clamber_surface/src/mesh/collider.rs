use std::fmt;

use glam::Vec3;

use super::clusters::{self, Clusters};
use super::hierarchy::Hierarchy;
use super::{SurfaceTag, WEIGHT_ONE};
use crate::geometry::triangle::scaled_normal;
use crate::geometry::{Affine, round_up_to_f32, widen};
use crate::rig::{JointId, Palette};
use crate::surface::{JointMaps, RootBalls, SurfaceError};

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u32);

        impl $name {
            /// As an index into a slice.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}", self.0)
            }
        }
    };
}

id! {
    /// Index of a vertex of a collider mesh. Never reused, as those of triangles.
    VertexId
}
id! {
    /// Index of a triangle of a collider mesh. Never reused: a removed triangle's id stays free.
    TriangleId
}
id! {
    /// Index of a part of a collider mesh.
    PartId
}

/// The triangles that one joint moves most, bounded together.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The joint with the largest weight over each triangle's three corners.
    pub joint: JointId,
    /// Ascending.
    pub triangles: Vec<TriangleId>,
    /// All corners of the triangles, ascending.
    pub vertices: Vec<VertexId>,
}

/// The rest data of a surface: positions, influences, triangles, tags, parts. Shared by any number of
/// surfaces through an `Arc`; one that is edited has its own.
#[derive(Clone, Debug, PartialEq)]
pub struct ColliderMesh {
    pub(super) joint_count: usize,
    pub(super) positions: Vec<Vec3>,
    /// Influences of vertex v stand at `influence_start[v]..influence_start[v + 1]`.
    pub(super) influence_start: Vec<u32>,
    pub(super) joints: Vec<u32>,
    /// Multiples of 2^-24; a vertex's add up to exactly 1.
    pub(super) weights: Vec<f32>,
    pub(super) triangles: Vec<[VertexId; 3]>,
    pub(super) tags: Vec<SurfaceTag>,
    /// `None` for a removed triangle.
    pub(super) part_of: Vec<Option<PartId>>,
    pub(super) parts: Vec<Part>,
    /// By vertex, as far as the last one that was removed.
    pub(super) vertex_removed: Vec<bool>,
    /// At least that of every vertex there is or was.
    pub(super) radius: f32,
    /// Palettes that clusters are made for; see [`ColliderMesh::tuned`].
    pub(super) poses: Vec<Vec<Affine>>,
    pub(super) clusters: Clusters,
    pub(super) hierarchy: Hierarchy,
    pub(super) root_balls: RootBalls,
}

impl ColliderMesh {
    /// How many matrices a palette for this mesh has.
    pub fn joint_count(&self) -> usize {
        self.joint_count
    }

    /// Rest positions, in mesh space, those of removed vertices included.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Corners of every triangle, removed ones included, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[VertexId; 3]] {
        &self.triangles
    }

    /// The tag of every triangle, removed ones included.
    pub fn tags(&self) -> &[SurfaceTag] {
        &self.tags
    }

    /// The parts, at first by ascending joint; edits may append more.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The part that a triangle belongs to; `None` if it was removed or never was.
    pub fn part_of(&self, triangle: TriangleId) -> Option<PartId> {
        self.part_of.get(triangle.index()).copied().flatten()
    }

    /// True if there is such a vertex: false for one that was removed or never was.
    pub fn has_vertex(&self, vertex: VertexId) -> bool {
        let removed = self.vertex_removed.get(vertex.index());
        vertex.index() < self.positions.len() && !removed.is_some_and(|removed| *removed)
    }

    /// Joints and weights of a vertex, by ascending joint. Weights are positive multiples of 2^-24
    /// and add up to exactly 1. Empty for a vertex out of range.
    pub fn influences(&self, vertex: VertexId) -> impl ExactSizeIterator<Item = (JointId, f32)> {
        let (joints, weights) = if vertex.index() < self.positions.len() {
            self.influence_slices(vertex.index())
        } else {
            (&[][..], &[][..])
        };
        let pairs = joints.iter().zip(weights);
        pairs.map(|(joint, weight)| (JointId(*joint), *weight))
    }

    /// The largest distance of a rest position from the mesh's origin, rounded up; those of removed
    /// vertices count.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The most influences that one vertex has.
    pub fn max_influences(&self) -> usize {
        let counts = self.influence_start.windows(2).map(|w| w[1] - w[0]);
        counts.max().unwrap_or(0) as usize
    }

    /// What is skinned together.
    pub(crate) fn clusters(&self) -> &Clusters {
        &self.clusters
    }

    /// The tree over the clusters.
    pub(crate) fn hierarchy(&self) -> &Hierarchy {
        &self.hierarchy
    }

    /// What bounds the whole mesh in any pose.
    pub(crate) fn root_balls(&self) -> &RootBalls {
        &self.root_balls
    }

    /// The same mesh, its clusters and hierarchy made for these poses: cut so that bounds are small in
    /// them, where a build without poses takes weights that differ and sizes at rest for a sign of what
    /// they will be. For creatures whose clips are known, a few poses of each; more than some ten in all
    /// change little. Queries give the same answers, and edits keep to the poses. (Bittner and Meister
    /// 2015, "T-SAH: Animation Optimized Bounding Volume Hierarchies", for one tree over all frames.)
    ///
    /// # Errors
    /// [`SurfaceError::JointCount`] or [`SurfaceError::Palette`] for a palette that a surface of this
    /// mesh would refuse.
    pub fn tuned(&self, poses: &[Palette]) -> Result<Self, SurfaceError> {
        let mut maps = JointMaps::default();
        for pose in poses {
            maps.update(self, pose)?;
        }
        let mut tuned = self.clone();
        tuned.poses = poses.iter().map(|pose| pose.matrices().to_vec()).collect();
        (tuned.clusters, tuned.hierarchy) = clusters::build(self, &tuned.poses);
        Ok(tuned)
    }

    /// Makes clusters and hierarchy anew.
    pub(crate) fn cluster(&mut self) {
        (self.clusters, self.hierarchy) = clusters::build(self, &self.poses);
        self.root_balls = RootBalls::new(self);
    }

    /// Bytes of all rest data.
    pub(crate) fn memory(&self) -> usize {
        let parts = self.parts.iter();
        let parts = parts.map(|p| size_of_val(&p.triangles[..]) + size_of_val(&p.vertices[..]));
        size_of_val(&self.positions[..])
            + size_of_val(&self.influence_start[..])
            + size_of_val(&self.joints[..])
            + size_of_val(&self.weights[..])
            + size_of_val(&self.triangles[..])
            + size_of_val(&self.tags[..])
            + size_of_val(&self.part_of[..])
            + size_of_val(&self.vertex_removed[..])
            + self
                .poses
                .iter()
                .map(|p| size_of_val(&p[..]))
                .sum::<usize>()
            + parts.sum::<usize>()
            + self.clusters.memory()
            + self.hierarchy.memory()
    }

    /// Joints and weights of vertex `v` as slices of equal length.
    #[inline]
    pub(crate) fn influence_slices(&self, v: usize) -> (&[u32], &[f32]) {
        let range = self.influence_start[v] as usize..self.influence_start[v + 1] as usize;
        (&self.joints[range.clone()], &self.weights[range])
    }

    pub(crate) fn rest_corners(&self, triangle: TriangleId) -> [Vec3; 3] {
        self.triangles[triangle.index()].map(|v| self.positions[v.index()])
    }

    /// The joint with the largest weight over three corners; the smaller id where two are equal.
    pub(super) fn dominant_joint(&self, corners: [VertexId; 3]) -> JointId {
        // Exact: a weight is an integer times 2^-24.
        let units = |weight: f32| (weight * WEIGHT_ONE as f32) as u64;
        let influences = corners
            .into_iter()
            .flat_map(|corner| self.influences(corner));
        let mut sums: Vec<(JointId, u64)> = influences.map(|(j, w)| (j, units(w))).collect();
        sums.sort_unstable();
        sums.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        sums.iter()
            .max_by(|a, b| a.1.cmp(&b.1).then(b.0.cmp(&a.0)))
            .map_or(JointId(0), |(joint, _)| *joint)
    }

    /// Fills a part's vertices from its triangles.
    pub(super) fn collect_vertices(&mut self, part: usize) {
        let triangles = &self.triangles;
        let part = &mut self.parts[part];
        part.vertices.clear();
        let corners = part.triangles.iter().flat_map(|t| triangles[t.index()]);
        part.vertices.extend(corners);
        part.vertices.sort_unstable();
        part.vertices.dedup();
    }

    /// The radius for a set of positions.
    pub(super) fn radius_of(positions: &[Vec3]) -> f32 {
        let farthest = positions
            .iter()
            .map(|p| widen(*p).length())
            .fold(0.0, f64::max);
        round_up_to_f32(farthest * (1.0 + 1e-15))
    }
}

/// False for a triangle whose corners stand on one line, or on one point.
pub(super) fn has_area(corners: [Vec3; 3]) -> bool {
    scaled_normal(corners) != glam::DVec3::ZERO
}
