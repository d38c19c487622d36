//! Changes to a surface at run time: a broken plate, a hole, a scab.

mod batch;

pub use batch::SurfaceEdit;

use super::{SkinnedSurface, SurfaceError};
use crate::mesh::{PartId, TriangleId};

impl SkinnedSurface {
    /// Shows the part's triangles to queries again, except those that were disabled one by one.
    ///
    /// # Errors
    /// [`SurfaceError::Part`] if there is no such part.
    pub fn enable_part(&mut self, part: PartId) -> Result<(), SurfaceError> {
        self.set_part(part, true)
    }

    /// Hides the part's triangles from queries. They are still skinned, and anchors on them still move.
    ///
    /// # Errors
    /// [`SurfaceError::Part`] if there is no such part.
    pub fn disable_part(&mut self, part: PartId) -> Result<(), SurfaceError> {
        self.set_part(part, false)
    }

    /// Shows the triangle to queries again, if its part is enabled.
    ///
    /// # Errors
    /// [`SurfaceError::Triangle`] if it does not exist or was removed.
    pub fn enable_triangle(&mut self, triangle: TriangleId) -> Result<(), SurfaceError> {
        self.check_triangle(triangle)?;
        let hidden = self.instance.triangle_hidden.get_mut(triangle.index());
        if hidden.is_some_and(std::mem::take) {
            self.instance.hidden_triangles -= 1;
            self.instance.mask ^= number(u64::from(triangle.0));
        }
        Ok(())
    }

    /// Hides the triangle from queries. It is still skinned, and anchors on it still move.
    ///
    /// # Errors
    /// [`SurfaceError::Triangle`] if it does not exist or was removed.
    pub fn disable_triangle(&mut self, triangle: TriangleId) -> Result<(), SurfaceError> {
        self.check_triangle(triangle)?;
        let hidden = &mut self.instance.triangle_hidden;
        hidden.resize(hidden.len().max(triangle.index() + 1), false);
        if !std::mem::replace(&mut hidden[triangle.index()], true) {
            self.instance.hidden_triangles += 1;
            self.instance.mask ^= number(u64::from(triangle.0));
        }
        Ok(())
    }

    /// Runs a closure that changes triangles, vertices and tags, any number of them, and returns the closure's result.
    ///
    /// A change that is refused changes nothing; the changes made before it stay.
    ///
    /// When the closure returns, the clusters of the parts whose triangles changed are rebuilt, once each; results that
    /// queries have cached for other parts stay. That takes as long as building a mesh of those parts. Once edits have
    /// replaced more than half of all clusters, the edit rebuilds all of them, which takes as long as building the
    /// whole mesh. The first edit that adds or removes triangles also makes the lists of
    /// [`ColliderMesh::parts`](crate::mesh::ColliderMesh::parts). The first change of a surface that shares its mesh
    /// gives the surface a copy of its own.
    ///
    /// ```
    /// # use std::sync::Arc;
    /// # use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, Influence, MeshSource, SurfaceTag};
    /// # use clamber_surface::mesh::{TriangleId, VertexId};
    /// # use clamber_surface::rig::JointId;
    /// # use clamber_surface::surface::{SkinnedSurface, SurfaceError};
    /// # use glam::Vec3;
    /// # let bone = Influence { joint: JointId(0), weight: 1.0 };
    /// # let source = MeshSource::rigid(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
    /// # let mesh = ColliderMesh::build(&source, &ColliderBuildOptions::default())?.0;
    /// # let mut surface = SkinnedSurface::new(Arc::new(mesh));
    /// let scab = surface.edit(|edit| {
    ///     let tip = edit.add_vertex(Vec3::Z, &[bone])?;
    ///     edit.remove_triangle(TriangleId(0))?;
    ///     edit.add_triangle([VertexId(0), VertexId(1), tip], SurfaceTag::default())
    /// })?;
    /// assert!(surface.is_enabled(scab) && !surface.is_enabled(TriangleId(0)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn edit<R>(&mut self, edits: impl FnOnce(&mut SurfaceEdit<'_>) -> R) -> R {
        let mut edit = SurfaceEdit::new(self);
        edits(&mut edit)
    }

    /// True if queries see the triangle: it exists, and neither it nor its part is disabled.
    pub fn is_enabled(&self, triangle: TriangleId) -> bool {
        self.instance.is_enabled(triangle)
    }

    /// Hash of the hidden triangles and parts: the same whenever the same ones are hidden, and 0 if none is hidden.
    #[doc(hidden)]
    pub fn mask(&self) -> u64 {
        self.instance.mask
    }

    fn set_part(&mut self, part: PartId, enabled: bool) -> Result<(), SurfaceError> {
        let instance = &mut self.instance;
        let known = instance.part_enabled.get_mut(part.index());
        let known = known.ok_or(SurfaceError::Part(part))?;
        if std::mem::replace(known, enabled) != enabled {
            instance.mask ^= number(1 << 32 | u64::from(part.0));
        }
        Ok(())
    }

    fn check_triangle(&self, triangle: TriangleId) -> Result<(), SurfaceError> {
        let part = self.mesh().part_of(triangle);
        part.map(|_| ()).ok_or(SurfaceError::Triangle(triangle))
    }
}

/// A number with well spread bits for each key: the finalizer of SplitMix64 (Steele, Lea, Flood 2014).
fn number(key: u64) -> u64 {
    let mixed = key.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ mixed >> 31
}

#[cfg(test)]
mod tests;
