use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use glam::{DVec3, Vec3};

use crate::geometry::triangle::scaled_normal;
use crate::mesh::{ColliderMesh, PartId, TriangleId, VertexId};
use crate::pose::PosedMesh;
use crate::simd::SimdLevel;

/// A mesh with its current and its previous pose, and its hidden parts and triangles: all data that queries read.
pub(crate) struct Instance {
    pub(crate) mesh: Arc<ColliderMesh>,
    pub(crate) current: PosedMesh,
    /// The pose of the previous tick, expressed in the current model frame.
    pub(crate) previous: PosedMesh,
    /// True if both poses are the same.
    pub(crate) is_still: bool,
    pub(crate) simd_level: SimdLevel,
    pub(crate) part_enabled: Vec<bool>,
    /// Per triangle, up to the last one that was ever hidden; false once the triangle is removed.
    pub(crate) triangle_hidden: Vec<bool>,
    /// Number of triangles that are hidden.
    pub(crate) hidden_triangles: usize,
    /// Hash of the hidden triangles and parts: a number for each of them, all combined by exclusive or. So the hash
    /// does not depend on the order of changes.
    pub(crate) mask: u64,
    pub(crate) triangles_tested: AtomicU64,
    pub(crate) most_cast_steps: AtomicU32,
}

impl Instance {
    /// A mesh at rest.
    pub(crate) fn new(mesh: Arc<ColliderMesh>, simd_level: SimdLevel) -> Self {
        Self {
            current: PosedMesh::at_rest(&mesh, simd_level),
            previous: PosedMesh::at_rest(&mesh, simd_level),
            is_still: true,
            simd_level,
            part_enabled: vec![true; mesh.part_count()],
            triangle_hidden: Vec::new(),
            hidden_triangles: 0,
            mask: 0,
            triangles_tested: AtomicU64::new(0),
            most_cast_steps: AtomicU32::new(0),
            mesh,
        }
    }

    /// True if queries see the triangle: it exists, and neither it nor its part is disabled.
    pub(crate) fn is_enabled(&self, triangle: TriangleId) -> bool {
        self.mesh
            .part_of(triangle)
            .is_some_and(|part| self.part_enabled[part.index()] && self.shows(triangle))
    }

    /// [`Instance::is_enabled`] for a triangle of an enabled part. Reads no memory of the triangle if nothing is
    /// hidden.
    pub(super) fn shows(&self, triangle: TriangleId) -> bool {
        let hidden = || self.triangle_hidden.get(triangle.index());
        self.hidden_triangles == 0 || hidden() != Some(&true)
    }

    /// The position of a vertex in a pose; `None` if it does not exist or was removed.
    pub(crate) fn position_in(&self, pose: &PosedMesh, vertex: VertexId) -> Option<Vec3> {
        let exists = self.mesh.has_vertex(vertex);
        exists.then(|| pose.position(&self.mesh, vertex.index()))
    }

    /// The corners of a triangle in a pose.
    pub(crate) fn corners_in(&self, pose: &PosedMesh, triangle: TriangleId) -> [Vec3; 3] {
        let corners = self.mesh.triangles()[triangle.index()];
        corners.map(|vertex| pose.position(&self.mesh, vertex.index()))
    }

    /// The corners of a triangle now.
    pub(crate) fn corners(&self, triangle: TriangleId) -> [Vec3; 3] {
        self.corners_in(&self.current, triangle)
    }

    /// The outward unit normal of a posed triangle; `None` if it has no area.
    #[inline]
    pub(crate) fn outward_normal(&self, corners: [Vec3; 3], part: PartId) -> Option<DVec3> {
        let normal = scaled_normal(corners).try_normalize()?;
        Some(if self.is_mirrored(part) {
            -normal
        } else {
            normal
        })
    }

    /// True if the joint of a part mirrors in the current pose.
    pub(crate) fn is_mirrored(&self, part: PartId) -> bool {
        let joint = self.mesh.joint_of_part(part);
        self.current.palette()[joint.index()].is_mirrored()
    }

    /// Counts a query's exact triangle tests; `steps` is the most that one of them took.
    pub(super) fn count_tested(&self, triangles: usize, steps: u32) {
        if triangles > 0 {
            let count = triangles as u64;
            self.triangles_tested.fetch_add(count, Ordering::Relaxed);
            self.most_cast_steps.fetch_max(steps, Ordering::Relaxed);
        }
    }
}

impl Clone for Instance {
    /// Copies both poses and all flags. Cached results are not copied: queries compute them again.
    fn clone(&self) -> Self {
        Self {
            mesh: self.mesh.clone(),
            current: self.current.renewed(&self.mesh),
            previous: self.previous.renewed(&self.mesh),
            is_still: self.is_still,
            simd_level: self.simd_level,
            part_enabled: self.part_enabled.clone(),
            triangle_hidden: self.triangle_hidden.clone(),
            hidden_triangles: self.hidden_triangles,
            mask: self.mask,
            triangles_tested: AtomicU64::new(0),
            most_cast_steps: AtomicU32::new(0),
        }
    }
}

impl fmt::Debug for Instance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (mesh, hidden) = (&self.mesh, self.hidden_triangles);
        write!(
            f,
            "{} triangles on {} joints, {hidden} triangles hidden",
            mesh.triangles().len(),
            mesh.joint_count()
        )
    }
}
