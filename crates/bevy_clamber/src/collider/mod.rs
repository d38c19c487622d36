//! Collider meshes from mesh assets: read, built off the main thread, shared between entities, freed with the asset.

mod build;
mod error;
#[cfg(feature = "gltf")]
mod gltf_tag;
mod meshes;
mod raw;
mod tag;

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
use std::fmt;
use std::sync::Arc;

use crate::PoseTiming;

pub(crate) use build::{build_colliders, forget_changed_assets, tell_waiting};
pub use error::ColliderError;
pub(crate) use meshes::{BuiltCollider, ColliderMeshes};
pub use tag::ColliderTag;
pub(crate) use tag::tag_colliders;

/// Makes the skinned mesh of this entity (its `Mesh3d` and `SkinnedMesh`) a surface.
///
/// Once the mesh and the inverse bind poses are loaded, the collider is built off the main thread. Entities with the
/// same mesh, number of joints and [`ColliderTag`] share it. When it is ready, a [`PosedSurface`](crate::PosedSurface)
/// is inserted on this entity. [`ColliderStatus`] holds the progress, or the error.
///
/// ```
/// # use bevy_ecs::prelude::*;
/// # use bevy_mesh::skinning::SkinnedMesh;
/// # use bevy_clamber::prelude::*;
/// /// Gives every skinned mesh a collider as it is spawned.
/// fn add_colliders(added: On<Add<SkinnedMesh>>, mut commands: Commands) {
///     commands.entity(added.entity).insert(SkinnedCollider::default());
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[require(ColliderStatus)]
pub struct SkinnedCollider {
    /// When the joints are animated. Default: once a frame, as Bevy's `AnimationPlugin` does.
    pub joints: PoseTiming,
    /// When the entities above the joints are moved, such as the root of a scene. Default: once a frame.
    pub root: PoseTiming,
    /// The highest plausible speed of a joint, metres a second. Default: 100. A skin that moves faster counts as
    /// teleported: it has no velocity in that tick, and a warning is logged once.
    pub max_speed: f32,
}

impl Default for SkinnedCollider {
    fn default() -> Self {
        Self::each_frame()
    }
}

impl SkinnedCollider {
    /// For a creature that is animated and moved once a frame, as Bevy's `AnimationPlugin` does. The default.
    pub const fn each_frame() -> Self {
        Self {
            joints: PoseTiming::EachFrame,
            root: PoseTiming::EachFrame,
            max_speed: 100.0,
        }
    }

    /// For a creature that is animated and moved in the fixed loop. Ticks see its pose without lag.
    pub const fn each_tick() -> Self {
        Self {
            joints: PoseTiming::EachTick,
            root: PoseTiming::EachTick,
            ..Self::each_frame()
        }
    }

    pub(crate) fn follows_frames(&self) -> bool {
        [self.joints, self.root].contains(&PoseTiming::EachFrame)
    }

    pub(crate) fn follows_ticks(&self) -> bool {
        [self.joints, self.root].contains(&PoseTiming::EachTick)
    }
}

/// The build state of a [`SkinnedCollider`].
///
/// A collider that has waited for 5 seconds logs once what for.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Default, Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ColliderStatus {
    /// Waits for something that is not there yet.
    Waiting(ColliderNeeds),
    /// The collider is being built.
    Building,
    /// The entity has a [`PosedSurface`](crate::PosedSurface).
    Ready,
    /// The surface cannot be built, or it has lost its joints. The build is tried again when one of its assets or
    /// components changes, and each frame after [`ColliderError::Joint`] and [`ColliderError::Hierarchies`].
    Failed(ColliderFailure),
}

impl Default for ColliderStatus {
    fn default() -> Self {
        Self::Waiting(ColliderNeeds::Mesh)
    }
}

/// The reason why a [`SkinnedCollider`] waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Reflect, thiserror::Error)]
#[reflect(Clone, Debug, PartialEq, Hash)]
#[non_exhaustive]
pub enum ColliderNeeds {
    /// The component `Mesh3d`.
    #[error(
        "a `Mesh3d` on its entity; put `SkinnedCollider` on the entity that has `Mesh3d` and `SkinnedMesh`"
    )]
    Mesh,
    /// The component `SkinnedMesh`.
    #[error("a `SkinnedMesh` on its entity; meshes without a skin cannot be surfaces")]
    Skin,
    /// The mesh asset, which is not loaded.
    #[error("its mesh asset to be loaded")]
    MeshAsset,
    /// The asset of inverse bind poses, which is not loaded.
    #[error("its asset `SkinnedMeshInverseBindposes` to be loaded")]
    InverseBindposes,
}

/// Why a collider has failed.
#[derive(Clone, Debug, PartialEq, Reflect)]
#[reflect(Clone, Debug, PartialEq)]
pub struct ColliderFailure {
    /// The error, in words.
    reason: String,
    #[reflect(ignore, clone)]
    error: Option<Arc<ColliderError>>,
}

impl ColliderFailure {
    pub(crate) fn new(error: Arc<ColliderError>) -> Self {
        Self {
            reason: error.to_string(),
            error: Some(error),
        }
    }

    /// The error; `None` for a failure that was made by reflection.
    pub fn error(&self) -> Option<&ColliderError> {
        self.error.as_deref()
    }
}

impl fmt::Display for ColliderFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.reason)
    }
}
