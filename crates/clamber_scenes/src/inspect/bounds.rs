//! Bounds against the vertices that they are to hold.

use clamber_surface::geometry::Sphere;
use clamber_surface::mesh::{ColliderMesh, PartId};
use clamber_surface::rig::Palette;
use clamber_surface::surface::{JointMaps, PartBounds, SurfaceError, refit_part_spheres};
use glam::Vec3;

/// Rest data for the bounds of a mesh.
pub(super) struct BoundCheck {
    bounds: PartBounds,
    maps: JointMaps,
    refitted: Vec<Option<Sphere>>,
}

impl BoundCheck {
    pub(super) fn new(mesh: &ColliderMesh) -> Self {
        Self {
            bounds: PartBounds::new(mesh),
            maps: JointMaps::default(),
            refitted: Vec::new(),
        }
    }

    /// How many skinned vertices are outside a bound of their part, counted once for each bound:
    /// by hull, by weight interval, the capsule, and the sphere refitted to the positions.
    pub(super) fn violations(
        &mut self,
        mesh: &ColliderMesh,
        palette: &Palette,
        positions: &[Vec3],
    ) -> Result<usize, SurfaceError> {
        self.maps.update(mesh, palette)?;
        refit_part_spheres(mesh, positions, &mut self.refitted);
        let mut outside = 0;
        for (index, part) in mesh.parts().iter().enumerate() {
            let id = PartId(index as u32);
            let Some(node) = self.bounds.node(id) else {
                continue;
            };
            let refitted = self.refitted.get(index).copied().flatten();
            let capsule = node.capsule(&self.maps);
            let spheres = [node.hull(&self.maps), node.weight_interval(&self.maps)];
            for vertex in &part.vertices {
                let position = positions[vertex.index()];
                let spheres = spheres.iter().chain(&refitted);
                outside += spheres.filter(|sphere| !sphere.contains(position)).count();
                outside += usize::from(!capsule.contains(position));
            }
        }
        Ok(outside)
    }
}
