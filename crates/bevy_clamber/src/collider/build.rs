use std::sync::Arc;
use std::time::Duration;

use bevy_asset::{AssetEvent, Assets};
use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Mesh, Mesh3d};
use bevy_time::{Real, Time};
use clamber_surface::geometry::Affine;
use glam::DAffine3;

use super::meshes::ColliderKey;
use super::{
    ColliderError, ColliderFailure, ColliderMeshes, ColliderNeeds, ColliderStatus, ColliderTag,
    SkinnedCollider,
};
use crate::surface::{FrameClock, Hierarchy, Rig, Scene};
use crate::{DrawnSurface, PosedSurface, WorldOrigin};

/// Restarts the build of colliders whose assets changed, and removes surfaces whose assets are gone.
pub(crate) fn forget_changed_assets(
    mut meshes: MessageReader<AssetEvent<Mesh>>,
    mut bindposes: MessageReader<AssetEvent<SkinnedMeshInverseBindposes>>,
    mut colliders: ResMut<ColliderMeshes>,
    mut entities: Query<(Entity, &Mesh3d, &SkinnedMesh, &mut ColliderStatus)>,
    mut commands: Commands,
) {
    for event in meshes.read() {
        let (id, gone) = match event {
            AssetEvent::Modified { id } => (*id, false),
            AssetEvent::Removed { id } => (*id, true),
            _ => continue,
        };
        colliders.forget(id);
        for (entity, mesh, _, mut status) in &mut entities {
            if mesh.id() == id {
                begin_anew(entity, &mut status, gone, &mut commands);
            }
        }
    }
    for event in bindposes.read() {
        let (id, gone) = match event {
            AssetEvent::Modified { id } => (*id, false),
            AssetEvent::Removed { id } => (*id, true),
            _ => continue,
        };
        for (entity, _, skin, mut status) in &mut entities {
            if skin.inverse_bindposes.id() == id {
                begin_anew(entity, &mut status, gone, &mut commands);
            }
        }
    }
}

/// Sets a collider back to waiting. Its surface stays until the next build is done, unless the asset is gone.
fn begin_anew(
    entity: Entity,
    status: &mut Mut<'_, ColliderStatus>,
    gone: bool,
    commands: &mut Commands<'_, '_>,
) {
    set(status, ColliderStatus::default());
    if gone {
        remove_surface(entity, commands);
    }
}

fn remove_surface(entity: Entity, commands: &mut Commands<'_, '_>) {
    let mut entity = commands.entity(entity);
    entity.try_remove::<(PosedSurface, DrawnSurface)>();
}

/// Components that a collider is built from.
type Source = (
    Entity,
    &'static SkinnedCollider,
    Option<Ref<'static, ColliderTag>>,
    Option<Ref<'static, Mesh3d>>,
    Option<Ref<'static, SkinnedMesh>>,
    &'static mut ColliderStatus,
    Option<&'static PosedSurface>,
);

/// Builds surfaces whose assets are loaded, and removes those whose components or joints are gone.
pub(crate) fn build_colliders(
    mut sources: Query<Source>,
    meshes: Res<Assets<Mesh>>,
    bindposes: Res<Assets<SkinnedMeshInverseBindposes>>,
    mut colliders: ResMut<ColliderMeshes>,
    hierarchy: Hierarchy<'_, '_>,
    (clock, origin): (Res<FrameClock>, Res<WorldOrigin>),
    mut commands: Commands,
) {
    let scene = Scene {
        hierarchy: &hierarchy,
        origin: origin.0,
    };
    for (entity, collider, tag, mesh, skin, mut status, surface) in &mut sources {
        let has_surface = surface.is_some();
        let lost = surface.and_then(PosedSurface::lost_joints).cloned();
        let needs = if mesh.is_none() {
            ColliderNeeds::Mesh
        } else {
            ColliderNeeds::Skin
        };
        let (Some(mesh), Some(skin)) = (mesh, skin) else {
            if has_surface {
                remove_surface(entity, &mut commands);
            }
            set(&mut status, ColliderStatus::Waiting(needs));
            continue;
        };
        // Inserted as soon as there are mesh and skin.
        let Some(tag) = tag else {
            continue;
        };
        let has_changed = tag.is_changed() || mesh.is_changed() || skin.is_changed();
        let is_wanted = match &*status {
            ColliderStatus::Waiting(_) | ColliderStatus::Building => true,
            // Parents and transforms may be added after the mesh, and no asset event reports it.
            ColliderStatus::Failed(failure) => {
                failure.error().is_some_and(ColliderError::is_of_hierarchy)
            }
            ColliderStatus::Ready => !has_surface,
        };
        let surface = if let (Some(error), false) = (lost, has_changed) {
            Err(Arc::new(error))
        } else if !(is_wanted || has_changed) {
            continue;
        } else {
            let Some(asset) = meshes.get(mesh.id()) else {
                set(
                    &mut status,
                    ColliderStatus::Waiting(ColliderNeeds::MeshAsset),
                );
                continue;
            };
            let Some(inverse_bindposes) = bindposes.get(&skin.inverse_bindposes) else {
                let needs = ColliderNeeds::InverseBindposes;
                set(&mut status, ColliderStatus::Waiting(needs));
                continue;
            };
            let key = ColliderKey {
                mesh: mesh.id(),
                joint_count: skin.joints.len(),
                tag: tag.0,
            };
            let Some(built) = colliders.get_or_build(key, asset) else {
                set(&mut status, ColliderStatus::Building);
                continue;
            };
            built.and_then(|built| {
                let inverse = inverse_bindposes.iter().map(|m| widen(&m.to_cols_array()));
                let rig = Rig::new(skin.joints.clone(), inverse.collect(), &hierarchy);
                let mut drawn = DrawnSurface::new(rig.map_err(Arc::new)?);
                let posed = PosedSurface::new(entity, built, collider, &mut drawn, &scene, &clock);
                Ok((posed, drawn))
            })
        };
        match surface {
            Ok(surface) => {
                commands.entity(entity).try_insert(surface);
                set(&mut status, ColliderStatus::Ready);
            }
            Err(error) => {
                if has_surface {
                    remove_surface(entity, &mut commands);
                }
                let failure = ColliderStatus::Failed(ColliderFailure::new(error));
                if *status != failure {
                    // A mesh's own errors are logged once for all its entities.
                    if let ColliderStatus::Failed(failure) = &failure
                        && failure.error().is_some_and(ColliderError::is_of_entity)
                    {
                        tracing::error!("no surface for {entity}: {failure}");
                    }
                    *status = failure;
                }
            }
        }
    }
}

/// Sets a status; marks it as changed only if it was another.
fn set(status: &mut Mut<'_, ColliderStatus>, to: ColliderStatus) {
    status.set_if_neq(to);
}

/// How long a collider may wait before what it waits for is logged.
const PATIENCE: Duration = Duration::from_secs(5);

/// Logs once which data a collider lacks, if it has waited for longer than [`PATIENCE`].
pub(crate) fn tell_waiting(
    colliders: Query<(Entity, Ref<ColliderStatus>)>,
    time: Res<Time<Real>>,
    mut waiting: Local<EntityHashMap<Duration>>,
) {
    for (entity, status) in &colliders {
        if status.is_changed() {
            waiting.remove(&entity);
            if matches!(*status, ColliderStatus::Waiting(_)) {
                waiting.insert(entity, time.elapsed());
            }
        }
    }
    waiting.retain(|entity, since| {
        let Ok((_, status)) = colliders.get(*entity) else {
            return false;
        };
        let ColliderStatus::Waiting(needs) = &*status else {
            return false;
        };
        let is_long = time.elapsed().saturating_sub(*since) >= PATIENCE;
        if is_long {
            tracing::warn!("the SkinnedCollider of {entity} waits for {needs}");
        }
        !is_long
    });
}

/// An affine map from a matrix by columns; its last row is ignored.
fn widen(columns: &[f32; 16]) -> DAffine3 {
    Affine::from_cols_array(columns).to_f64()
}
