use std::sync::Arc;

use clamber_surface::mesh::ColliderMesh;
use clamber_surface::surface::PartBounds;

/// Rest data of parts, by mesh, for as long as a surface draws it.
#[derive(Default)]
pub(super) struct PartBoundsCache {
    meshes: Vec<Cached>,
}

struct Cached {
    mesh: Arc<ColliderMesh>,
    bounds: PartBounds,
    wanted: bool,
}

impl PartBoundsCache {
    /// Those of a mesh, read from it if nobody asked before.
    pub(super) fn get(&mut self, mesh: &Arc<ColliderMesh>) -> &PartBounds {
        let known = self.meshes.iter().position(|c| Arc::ptr_eq(&c.mesh, mesh));
        let index = known.unwrap_or(self.meshes.len());
        if known.is_none() {
            self.meshes.push(Cached {
                mesh: Arc::clone(mesh),
                bounds: PartBounds::new(mesh),
                wanted: true,
            });
        }
        self.meshes[index].wanted = true;
        &self.meshes[index].bounds
    }

    /// Forgets those that nobody has asked for since the last call.
    pub(super) fn forget_unwanted(&mut self) {
        self.meshes.retain(|cached| cached.wanted);
        for cached in &mut self.meshes {
            cached.wanted = false;
        }
    }
}
