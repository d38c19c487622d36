//! From mesh assets to collider meshes: read, build away from the main thread, share, forget.

mod build;
mod error;
#[cfg(feature = "gltf")]
mod gltf_tag;
mod meshes;
mod raw;
mod tag;

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
use std::sync::Arc;

use crate::PoseTiming;

pub(crate) use build::{build_colliders, forget_changed_assets};
pub use error::ColliderError;
pub(crate) use meshes::{BuiltCollider, ColliderMeshes};
pub(crate) use tag::tag_colliders;
pub use tag::{ColliderTag, SurfaceTagger};

/// Makes a surface of the skinned mesh on this entity: its `Mesh3d` and `SkinnedMesh`.
///
/// Once both assets are loaded, the collider is built away from the main thread, and shared by all that show
/// the same mesh; then a [`PosedSurface`](crate::PosedSurface) appears here. [`ColliderStatus`] says how far it
/// is, or what is wrong.
///
/// ```
/// # use bevy_ecs::prelude::*;
/// # use bevy_mesh::skinning::SkinnedMesh;
/// # use bevy_clamber::prelude::*;
/// /// Whatever has a skinned mesh gets a collider, as scenes spawn.
/// fn add_colliders(added: On<Add<SkinnedMesh>>, mut commands: Commands) {
///     commands.entity(added.entity).insert(SkinnedCollider::default());
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[require(ColliderStatus)]
pub struct SkinnedCollider {
    /// When the joints are animated. Default: once a frame, as by Bevy's `AnimationPlugin`.
    pub joints: PoseTiming,
    /// When what stands above the joints is moved, as the root of a scene. Default: once a frame.
    pub root: PoseTiming,
}

impl SkinnedCollider {
    /// For a creature that is animated and moved in the fixed loop: ticks see it without lag.
    pub const fn each_tick() -> Self {
        Self {
            joints: PoseTiming::EachTick,
            root: PoseTiming::EachTick,
        }
    }
}

/// How far a [`SkinnedCollider`] is.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Default, Clone, Debug)]
#[non_exhaustive]
pub enum ColliderStatus {
    /// For mesh, inverse bind poses, `Mesh3d` or `SkinnedMesh`.
    #[default]
    Waiting,
    /// Being built.
    Building,
    /// There is a [`PosedSurface`](crate::PosedSurface).
    Ready,
    /// It cannot be built. Tried again when one of its assets or components changes.
    Failed(Arc<ColliderError>),
}
