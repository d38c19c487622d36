//! Changing a surface while it lives: a broken plate, a hole, a scab.

use std::sync::Arc;

use super::{SkinnedSurface, SurfaceError};
use crate::mesh::{PartId, SurfaceTag, TriangleId, VertexId};

impl SkinnedSurface {
    /// Queries see the part's triangles again, but for those disabled one by one.
    ///
    /// # Errors
    /// [`SurfaceError::Part`] if there is no such part.
    pub fn enable_part(&mut self, part: PartId) -> Result<(), SurfaceError> {
        *self.part_flag(part)? = true;
        Ok(())
    }

    /// Queries no longer see the part's triangles. They are still skinned, and anchors on them
    /// still move.
    ///
    /// # Errors
    /// [`SurfaceError::Part`] if there is no such part.
    pub fn disable_part(&mut self, part: PartId) -> Result<(), SurfaceError> {
        *self.part_flag(part)? = false;
        Ok(())
    }

    /// Queries see the triangle again, if its part is enabled.
    ///
    /// # Errors
    /// [`SurfaceError::Triangle`] if it does not exist or was removed.
    pub fn enable_triangle(&mut self, triangle: TriangleId) -> Result<(), SurfaceError> {
        let hidden = !std::mem::replace(self.triangle_flag(triangle)?, true);
        self.hidden_triangles -= usize::from(hidden);
        Ok(())
    }

    /// Queries no longer see the triangle.
    ///
    /// # Errors
    /// [`SurfaceError::Triangle`] if it does not exist or was removed.
    pub fn disable_triangle(&mut self, triangle: TriangleId) -> Result<(), SurfaceError> {
        let shown = std::mem::replace(self.triangle_flag(triangle)?, false);
        self.hidden_triangles += usize::from(shown);
        Ok(())
    }

    /// Adds a triangle between existing vertices, counter-clockwise seen from outside. It joins
    /// the part of the joint that moves it most; if that part is new, it comes last and enabled.
    ///
    /// A surface that shares its mesh gets a copy of its own with the first such edit. All clusters
    /// are made anew, which takes as long as building the mesh.
    ///
    /// # Errors
    /// [`SurfaceError::Mesh`] if a vertex does not exist or the triangle has no area at rest.
    pub fn add_triangle(
        &mut self,
        corners: [VertexId; 3],
        tag: SurfaceTag,
    ) -> Result<TriangleId, SurfaceError> {
        self.mesh.check_triangle(corners)?;
        let triangle = Arc::make_mut(&mut self.mesh).add_triangle(corners, tag);
        self.triangle_enabled.push(true);
        self.part_enabled.resize(self.mesh.parts().len(), true);
        self.current = self.current.renewed(&self.mesh);
        self.previous = self.previous.renewed(&self.mesh);
        Ok(triangle)
    }

    /// Removes a triangle for good. Its id is never used again; anchors on it report
    /// [`SurfaceError::Triangle`].
    ///
    /// A surface that shares its mesh gets a copy of its own with the first such edit.
    ///
    /// # Errors
    /// [`SurfaceError::Triangle`] if it does not exist or was removed before.
    pub fn remove_triangle(&mut self, triangle: TriangleId) -> Result<(), SurfaceError> {
        let part = self.mesh.part_of(triangle);
        let part = part.ok_or(SurfaceError::Triangle(triangle))?;
        self.disable_triangle(triangle)?;
        Arc::make_mut(&mut self.mesh).remove_triangle(triangle, part);
        Ok(())
    }

    /// True if queries see the triangle: it exists, and neither it nor its part is disabled.
    pub fn is_enabled(&self, triangle: TriangleId) -> bool {
        self.mesh.part_of(triangle).is_some_and(|part| {
            self.part_enabled[part.index()] && self.triangle_enabled[triangle.index()]
        })
    }

    /// [`SkinnedSurface::is_enabled`] for a triangle of an enabled part. Where nothing is hidden, it
    /// reads nothing.
    pub(super) fn shows(&self, triangle: TriangleId) -> bool {
        self.hidden_triangles == 0 || self.triangle_enabled[triangle.index()]
    }

    fn part_flag(&mut self, part: PartId) -> Result<&mut bool, SurfaceError> {
        self.part_enabled
            .get_mut(part.index())
            .ok_or(SurfaceError::Part(part))
    }

    fn triangle_flag(&mut self, triangle: TriangleId) -> Result<&mut bool, SurfaceError> {
        let exists = self.mesh.part_of(triangle).is_some();
        self.triangle_enabled
            .get_mut(triangle.index())
            .filter(|_| exists)
            .ok_or(SurfaceError::Triangle(triangle))
    }
}
