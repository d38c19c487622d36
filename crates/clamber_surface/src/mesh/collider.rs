use std::fmt;

use glam::Vec3;

use super::adjacency::Adjacency;
use super::clusters::{self, Clusters};
use super::derived::Derived;
use super::hierarchy::Hierarchy;
use super::influences::Influences;
use super::joint_balls::JointBalls;
use super::lineage::{Lineage, MeshId};
use super::parts::{Part, Parts};
use super::weights::WEIGHT_ONE;
use super::{PaletteError, SurfaceTag, SurfaceTags};
use crate::geometry::triangle::scaled_normal;
use crate::geometry::{Affine, MAX_COORDINATE, round_up_to_f32, widen};
use crate::rig::JointId;

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
        pub struct $name(pub u32);

        impl $name {
            /// The id as an index into a slice.
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
    /// Index of a vertex of a collider mesh. Ids of removed vertices are not reused.
    VertexId
}
id! {
    /// Index of a triangle of a collider mesh. Ids of removed triangles are not reused.
    TriangleId
}
id! {
    /// Index of a part of a collider mesh.
    PartId
}

id! {
    /// Index of an island of a collider mesh: a set of triangles connected across shared edges. Islands are
    /// numbered in the order of their lowest triangle ids. Edits renumber them. See [`ColliderMesh::island_of`].
    IslandId
}

/// The rest data of a surface: positions, influences, triangles, tags, parts. Any number of surfaces share a mesh
/// through an `Arc`; a surface that is edited gets a copy of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct ColliderMesh {
    pub(super) lineage: Lineage,
    pub(super) joint_count: usize,
    pub(super) positions: Vec<Vec3>,
    /// By vertex; the weights of one vertex add up to exactly 1.
    pub(super) influences: Influences,
    pub(super) triangles: Vec<[VertexId; 3]>,
    pub(super) tags: SurfaceTags,
    pub(super) parts: Parts,
    /// Per vertex, up to the last one that was removed.
    pub(super) vertex_removed: Vec<bool>,
    /// At least the distance of every vertex from the origin, including removed vertices.
    pub(super) radius: f32,
    pub(super) clusters: Clusters,
    pub(super) hierarchy: Hierarchy,
    pub(super) joint_balls: JointBalls,
    /// See [`ColliderMesh::part_nodes`].
    pub(super) part_nodes: Derived<Hierarchy>,
    /// See [`ColliderMesh::neighbours`].
    pub(super) adjacency: Derived<Adjacency>,
}

impl ColliderMesh {
    /// The mesh's id as it is now. Each vertex or triangle that an edit adds changes it; removals and tags do not.
    ///
    /// Hits and anchors carry the id from when their triangle was built or added. So do not compare their ids with this
    /// one: ask [`ColliderMesh::continues`].
    pub fn id(&self) -> MeshId {
        self.lineage.id()
    }

    /// The id that the mesh had when `triangle` was built or added. Hits on the triangle carry it.
    pub(crate) fn id_of(&self, triangle: TriangleId) -> MeshId {
        self.lineage.id_of(triangle)
    }

    /// True if `id` is this mesh's id, or one that it had before an edit. Points that carry such an id refer to the
    /// same material here.
    pub fn continues(&self, id: MeshId) -> bool {
        self.lineage.has(id)
    }

    /// Number of joints: a palette for this mesh has as many matrices.
    pub fn joint_count(&self) -> usize {
        self.joint_count
    }

    /// Rest positions in mesh space, by vertex id. Includes removed vertices.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Corners of every triangle, by triangle id, counter-clockwise seen from outside. Includes removed triangles.
    pub fn triangles(&self) -> &[[VertexId; 3]] {
        &self.triangles
    }

    /// The tag of every triangle, by triangle id. Includes removed triangles.
    pub fn tags(&self) -> &SurfaceTags {
        &self.tags
    }

    /// The same mesh with other tags: `tag` is called once for each triangle, in ascending order, removed ones
    /// included, with the tag that it has. Ids and points of either mesh are valid on both.
    ///
    /// ```
    /// use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource, SurfaceKind, SurfaceTag};
    /// use glam::Vec3;
    ///
    /// let source = MeshSource::rigid(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
    /// let (skin, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default())?;
    /// let fur = skin.with_tags(|_, tag| SurfaceTag { kind: SurfaceKind::Fur, ..tag });
    /// assert_eq!(fur.tags()[0].kind, SurfaceKind::Fur);
    /// assert_eq!(fur.id(), skin.id());
    /// # Ok::<(), clamber_surface::mesh::MeshError>(())
    /// ```
    #[must_use]
    pub fn with_tags(&self, mut tag: impl FnMut(TriangleId, SurfaceTag) -> SurfaceTag) -> Self {
        let tags = (0..).map(TriangleId).zip(self.tags.iter());
        let tags = tags.map(|(triangle, old)| tag(triangle, *old)).collect();
        Self {
            tags,
            ..self.clone()
        }
    }

    /// The parts, with lists of their triangles and vertices. A build sorts them by joint; edits may append more, and
    /// may leave a part without triangles. The lists are made on first use, which takes O(n log n) for n triangles: by
    /// this call, an edit, or [`ModelSpace::part_spheres`](crate::surface::ModelSpace::part_spheres). From then on the
    /// mesh keeps them: they take some six bytes a triangle.
    ///
    /// [`ColliderMesh::part_count`], [`ColliderMesh::part_joint`] and [`ColliderMesh::part_of`] need no lists.
    pub fn parts(&self) -> &[Part] {
        self.parts.lists(&self.triangles)
    }

    /// Number of parts.
    pub fn part_count(&self) -> usize {
        self.parts.count()
    }

    /// The joint that moves the triangles of a part most; `None` if there is no such part.
    pub fn part_joint(&self, part: PartId) -> Option<JointId> {
        (part.index() < self.parts.count()).then(|| self.parts.joint(part))
    }

    /// The part that a triangle belongs to; `None` if the triangle was removed or never existed.
    pub fn part_of(&self, triangle: TriangleId) -> Option<PartId> {
        self.parts.of(triangle)
    }

    /// The joint that moves a triangle most; `None` if the triangle was removed or never existed.
    pub fn joint_of(&self, triangle: TriangleId) -> Option<JointId> {
        Some(self.parts.joint(self.part_of(triangle)?))
    }

    /// [`ColliderMesh::part_joint`] of a part that exists.
    #[inline]
    pub(crate) fn joint_of_part(&self, part: PartId) -> JointId {
        self.parts.joint(part)
    }

    /// True if the vertex exists and was not removed.
    pub fn has_vertex(&self, vertex: VertexId) -> bool {
        let removed = self.vertex_removed.get(vertex.index());
        vertex.index() < self.positions.len() && !removed.is_some_and(|removed| *removed)
    }

    /// Joints and weights of a vertex, in ascending joint order. Weights are positive multiples of 2^-24 and add up
    /// to exactly 1. Empty for a vertex out of range.
    #[inline]
    pub fn influences(
        &self,
        vertex: VertexId,
    ) -> impl ExactSizeIterator<Item = (JointId, f32)> + Clone {
        self.influences.of(vertex.index())
    }

    /// The largest distance of a rest position from the mesh's origin, rounded up. Includes removed vertices.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The most influences that one vertex has.
    pub fn max_influences(&self) -> usize {
        self.influences.most()
    }

    /// The clusters: vertices and triangles that are skinned together.
    pub(crate) fn clusters(&self) -> &Clusters {
        &self.clusters
    }

    /// The tree over the clusters.
    pub(crate) fn hierarchy(&self) -> &Hierarchy {
        &self.hierarchy
    }

    /// The rest data that bound the whole mesh in any pose.
    pub(crate) fn joint_balls(&self) -> &JointBalls {
        &self.joint_balls
    }

    /// The rest data that bound every part in any pose. Computed on first use.
    pub(crate) fn part_nodes(&self) -> &Hierarchy {
        self.part_nodes.get_or(|| Hierarchy::of_parts(self))
    }

    /// Checks whether a surface of this mesh accepts a palette.
    ///
    /// # Errors
    /// [`PaletteError::JointCount`] if there is not one matrix per joint of the mesh; [`PaletteError::Matrix`] if a
    /// matrix is not finite or could move a vertex farther than 2^100 from the origin.
    pub fn check_palette(&self, matrices: &[Affine]) -> Result<(), PaletteError> {
        self.check_joint_count(matrices.len())?;
        check_matrices(matrices.iter().copied(), self.radius)
    }

    pub(crate) fn check_joint_count(&self, found: usize) -> Result<(), PaletteError> {
        let expected = self.joint_count;
        if found == expected {
            Ok(())
        } else {
            Err(PaletteError::JointCount { expected, found })
        }
    }

    /// Rebuilds the clusters, the hierarchy and the joint balls.
    pub(crate) fn cluster(&mut self) {
        (self.clusters, self.hierarchy) = clusters::build(self);
        self.joint_balls = JointBalls::new(self);
        self.part_nodes.forget();
    }

    /// Size of the rest data in bytes. Includes the lists of parts once they were made, but no other derived data.
    pub(crate) fn memory(&self) -> usize {
        size_of_val(&self.positions[..])
            + self.influences.memory()
            + size_of_val(&self.triangles[..])
            + self.tags.memory()
            + self.parts.memory()
            + size_of_val(&self.vertex_removed[..])
            + self.clusters.memory()
            + self.hierarchy.memory()
            + self.joint_balls.memory()
            + self.lineage.memory()
    }

    pub(crate) fn rest_corners(&self, triangle: TriangleId) -> [Vec3; 3] {
        self.triangles[triangle.index()].map(|v| self.positions[v.index()])
    }

    /// The joint with the largest sum of weights over three corners; on a tie, the smaller id.
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

    /// The largest distance of a position from the origin, rounded up.
    pub(super) fn radius_of(positions: &[Vec3]) -> f32 {
        let farthest = positions
            .iter()
            .map(|p| widen(*p).length())
            .fold(0.0, f64::max);
        round_up_to_f32(farthest * (1.0 + 1e-15))
    }
}

/// Rejects a matrix if [`Affine::reach`] at `radius` exceeds 2^100 or is NaN: it could move a vertex that far from
/// the model's origin.
pub(crate) fn check_matrices(
    mut matrices: impl Iterator<Item = Affine>,
    radius: f32,
) -> Result<(), PaletteError> {
    match matrices.position(|matrix| !keeps(&matrix, radius)) {
        None => Ok(()),
        Some(joint) => Err(PaletteError::Matrix(JointId(joint as u32))),
    }
}

/// True if [`Affine::reach`] at `radius` is at most 2^100. False for NaN.
#[inline]
fn keeps(matrix: &Affine, radius: f32) -> bool {
    // The usual case. Nine products of such numbers, and three such numbers more, add up to less than 2^100.
    let usual = |x: &f32| x.abs() < USUAL_COORDINATE;
    if usual(&radius) && matrix.rows.as_flattened().iter().all(usual) {
        return true;
    }
    matrix.reach(f64::from(radius)) <= MAX_COORDINATE
}

/// 2^40: matrices with smaller elements, on creatures with a smaller radius, need no closer check.
const USUAL_COORDINATE: f32 = (1u64 << 40) as f32;

/// True unless the corners lie on one line or at one point.
pub(super) fn has_area(corners: [Vec3; 3]) -> bool {
    scaled_normal(corners) != glam::DVec3::ZERO
}
