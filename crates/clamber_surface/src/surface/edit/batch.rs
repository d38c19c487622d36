use std::collections::BTreeSet;
use std::sync::Arc;

use glam::Vec3;

use crate::mesh::{
    ColliderMesh, Influence, PartId, Reclustered, SurfaceTag, TriangleId, VertexId, check_matrices,
};
use crate::surface::{SkinnedSurface, SurfaceError};

/// A batch of changes to triangles, vertices and tags; see [`SkinnedSurface::edit`].
///
/// The ids of removed vertices and triangles are never used again, so memory grows by some tens of bytes with each
/// vertex and each triangle that is added.
#[derive(Debug)]
pub struct SurfaceEdit<'a> {
    surface: &'a mut SkinnedSurface,
    /// Parts whose triangles have changed.
    touched: BTreeSet<PartId>,
}

impl<'a> SurfaceEdit<'a> {
    pub(super) fn new(surface: &'a mut SkinnedSurface) -> Self {
        Self {
            surface,
            touched: BTreeSet::new(),
        }
    }

    /// Adds a vertex at a rest position in mesh space, moved by any number of joints.
    ///
    /// Weights are normalised as in a mesh build. The vertex is not welded to others, and queries do not see it until
    /// it has a triangle. Its position a tick ago is the one that the palette of that tick gives it.
    ///
    /// # Errors
    /// [`SurfaceError::Mesh`] for a position, a joint or weights that a build would refuse, and for too many vertices
    /// or influences ([`MeshError::TooLarge`](crate::mesh::MeshError::TooLarge)); [`SurfaceError::Palette`] if a matrix
    /// of the current or the previous palette could move a vertex at that distance from the mesh's origin beyond 2^100.
    pub fn add_vertex(
        &mut self,
        position: Vec3,
        influences: &[Influence],
    ) -> Result<VertexId, SurfaceError> {
        let instance = &self.surface.instance;
        let vertex = instance.mesh.check_vertex(position, influences)?;
        if vertex.radius > instance.mesh.radius() {
            for pose in [&instance.current, &instance.previous] {
                check_matrices(pose.palette().iter().copied(), vertex.radius)?;
            }
        }
        Ok(self.mesh_mut().add_vertex(vertex))
    }

    /// Adds a triangle, counter-clockwise seen from outside. It joins the part of the joint that moves it most. If that
    /// part is new, it is enabled and comes after all others.
    ///
    /// # Errors
    /// [`SurfaceError::Vertex`] if a vertex does not exist or was removed, [`SurfaceError::Mesh`] if the
    /// triangle has no area at rest, or for too many triangles
    /// ([`MeshError::TooLarge`](crate::mesh::MeshError::TooLarge)).
    pub fn add_triangle(
        &mut self,
        corners: [VertexId; 3],
        tag: SurfaceTag,
    ) -> Result<TriangleId, SurfaceError> {
        let mesh = self.surface.mesh();
        if let Some(bad) = corners.iter().find(|vertex| !mesh.has_vertex(**vertex)) {
            return Err(SurfaceError::Vertex(*bad));
        }
        mesh.check_triangle(corners)?;
        let (triangle, part) = self.mesh_mut().add_triangle(corners, tag);
        self.touched.insert(part);
        let instance = &mut self.surface.instance;
        let parts = instance.mesh.part_count();
        instance.part_enabled.resize(parts, true);
        Ok(triangle)
    }

    /// Removes a triangle for good: queries no longer see it, and anchors on it report
    /// [`SurfaceError::Triangle`]. Its vertices stay.
    ///
    /// # Errors
    /// [`SurfaceError::Triangle`] if it does not exist or was removed before.
    pub fn remove_triangle(&mut self, triangle: TriangleId) -> Result<(), SurfaceError> {
        let part = self.surface.mesh().part_of(triangle);
        let part = part.ok_or(SurfaceError::Triangle(triangle))?;
        // A removed triangle no longer counts as hidden.
        self.surface.enable_triangle(triangle)?;
        self.mesh_mut().remove_triangle(triangle);
        self.touched.insert(part);
        Ok(())
    }

    /// Removes a vertex for good, and all triangles that have it as a corner.
    ///
    /// # Errors
    /// [`SurfaceError::Vertex`] if it does not exist or was removed before.
    pub fn remove_vertex(&mut self, vertex: VertexId) -> Result<(), SurfaceError> {
        if !self.surface.mesh().has_vertex(vertex) {
            return Err(SurfaceError::Vertex(vertex));
        }
        let around = self.surface.mesh().triangles_around(vertex, &self.touched);
        for triangle in around {
            self.remove_triangle(triangle)?;
        }
        self.mesh_mut().remove_vertex(vertex);
        Ok(())
    }

    /// Replaces the tag of a triangle.
    ///
    /// # Errors
    /// [`SurfaceError::Triangle`] if it does not exist or was removed.
    pub fn set_tag(&mut self, triangle: TriangleId, tag: SurfaceTag) -> Result<(), SurfaceError> {
        if self.surface.mesh().part_of(triangle).is_none() {
            return Err(SurfaceError::Triangle(triangle));
        }
        self.mesh_mut().set_tag(triangle, tag);
        Ok(())
    }

    /// The mesh, copied first if other surfaces share it.
    fn mesh_mut(&mut self) -> &mut ColliderMesh {
        Arc::make_mut(&mut self.surface.instance.mesh)
    }
}

impl Drop for SurfaceEdit<'_> {
    /// Brings clusters and caches up to date, even if the closure panicked.
    fn drop(&mut self) {
        let reclustered = if self.touched.is_empty() {
            Reclustered::Parts(Vec::new())
        } else {
            Arc::make_mut(&mut self.surface.instance.mesh).recluster(&self.touched)
        };
        let instance = &mut self.surface.instance;
        for pose in [&mut instance.current, &mut instance.previous] {
            match &reclustered {
                Reclustered::All => *pose = pose.renewed(&instance.mesh),
                Reclustered::Parts(dead) => pose.follow(&instance.mesh, dead),
            }
        }
        self.surface.bound();
    }
}
