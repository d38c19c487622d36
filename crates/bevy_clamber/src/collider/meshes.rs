use std::collections::HashMap;
use std::sync::Arc;

use bevy_asset::AssetId;
use bevy_ecs::prelude::*;
use bevy_mesh::Mesh;
use bevy_tasks::{AsyncComputeTaskPool, Task, futures::check_ready};
use clamber_surface::mesh::{ColliderMesh, SurfaceTag};

use super::ColliderError;
use super::raw::RawMesh;

/// A collider mesh, and the source of its triangles.
#[derive(Debug)]
pub(crate) struct BuiltCollider {
    pub(crate) mesh: Arc<ColliderMesh>,
    /// Per triangle of the collider: its index among the triangles of the mesh asset.
    pub(crate) source_triangles: Vec<u32>,
}

/// Entities with equal keys share a collider mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ColliderKey {
    pub(crate) mesh: AssetId<Mesh>,
    pub(crate) joint_count: usize,
    pub(crate) tag: SurfaceTag,
}

/// The result of a build, shared by all entities that use it.
pub(crate) type Built = Result<Arc<BuiltCollider>, Arc<ColliderError>>;

enum Entry {
    Building(Task<Result<BuiltCollider, ColliderError>>),
    Done(Built),
}

/// Collider meshes, kept until their mesh asset changes or is removed.
#[derive(Resource, Default)]
pub(crate) struct ColliderMeshes {
    entries: HashMap<ColliderKey, Entry>,
}

impl ColliderMeshes {
    /// The result of a build; `None` while it runs. The first call for a key copies `mesh` and starts the build.
    pub(crate) fn get_or_build(&mut self, key: ColliderKey, mesh: &Mesh) -> Option<Built> {
        let entry = self
            .entries
            .entry(key)
            .or_insert_with(|| match RawMesh::copy(mesh) {
                Ok(raw) => {
                    let build = async move { raw.build(key.joint_count, key.tag) };
                    Entry::Building(AsyncComputeTaskPool::get().spawn(build))
                }
                Err(error) => {
                    tracing::error!("no collider for {}: {error}", key.mesh);
                    Entry::Done(Err(Arc::new(error)))
                }
            });
        if let Entry::Building(task) = entry
            && let Some(built) = check_ready(task)
        {
            if let Err(error) = &built {
                tracing::error!("no collider for {}: {error}", key.mesh);
            }
            *entry = Entry::Done(built.map(Arc::new).map_err(Arc::new));
        }
        match entry {
            Entry::Building(_) => None,
            Entry::Done(built) => Some(built.clone()),
        }
    }

    /// Forgets the colliders that were built, or are being built, from a mesh asset.
    pub(crate) fn forget(&mut self, mesh: AssetId<Mesh>) {
        self.entries.retain(|key, _| key.mesh != mesh);
    }
}
