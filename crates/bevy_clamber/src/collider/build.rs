use std::sync::Arc;

use bevy_asset::{AssetEvent, Assets};
use bevy_ecs::prelude::*;
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Mesh, Mesh3d};
use clamber_surface::geometry::Affine;
use glam::DAffine3;

use super::meshes::ColliderKey;
use super::{ColliderError, ColliderMeshes, ColliderStatus, ColliderTag, SkinnedCollider};
use crate::surface::{Hierarchy, PoseClock, Rig, Scene};
use crate::{PosedSurface, WorldOrigin};

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
    wait(status);
    if gone {
        commands.entity(entity).try_remove::<PosedSurface>();
    }
}

/// Components that a collider is built from.
type Source = (
    Entity,
    Ref<'static, SkinnedCollider>,
    Ref<'static, ColliderTag>,
    Option<Ref<'static, Mesh3d>>,
    Option<Ref<'static, SkinnedMesh>>,
    &'static mut ColliderStatus,
    Option<&'static mut PosedSurface>,
);

/// Builds surfaces whose assets are loaded, and removes those whose components are gone.
pub(crate) fn build_colliders(
    mut sources: Query<Source>,
    meshes: Res<Assets<Mesh>>,
    bindposes: Res<Assets<SkinnedMeshInverseBindposes>>,
    mut colliders: ResMut<ColliderMeshes>,
    hierarchy: Hierarchy<'_, '_>,
    (clock, origin): (Res<PoseClock>, Res<WorldOrigin>),
    mut commands: Commands,
) {
    let scene = Scene {
        hierarchy: &hierarchy,
        origin: origin.0,
    };
    for (entity, collider, tag, mesh, skin, mut status, surface) in &mut sources {
        let (Some(mesh), Some(skin)) = (mesh, skin) else {
            if surface.is_some() {
                commands.entity(entity).try_remove::<PosedSurface>();
            }
            wait(&mut status);
            continue;
        };
        if tag.is_changed() || mesh.is_changed() || skin.is_changed() {
            wait(&mut status);
        }
        if let Some(mut surface) = surface
            && collider.is_changed()
        {
            surface.set_timing(*collider);
        }
        let wanted = match &*status {
            ColliderStatus::Waiting | ColliderStatus::Building => true,
            // Parents and transforms may be added after the mesh, and no asset event reports it.
            ColliderStatus::Failed(error) => error.is_of_hierarchy(),
            ColliderStatus::Ready => false,
        };
        if !wanted {
            continue;
        }
        let (Some(asset), Some(inverse_bindposes)) = (
            meshes.get(mesh.id()),
            bindposes.get(&skin.inverse_bindposes),
        ) else {
            continue;
        };
        let key = ColliderKey {
            mesh: mesh.id(),
            joint_count: skin.joints.len(),
            tag: tag.0,
        };
        let Some(built) = colliders.get_or_build(key, asset) else {
            if !matches!(*status, ColliderStatus::Building) {
                *status = ColliderStatus::Building;
            }
            continue;
        };
        let surface = built.and_then(|built| {
            let inverse = inverse_bindposes.iter().map(|m| widen(&m.to_cols_array()));
            let rig = Rig::new(skin.joints.clone(), inverse.collect(), &hierarchy);
            Ok(PosedSurface::new(
                entity,
                built,
                rig.map_err(Arc::new)?,
                *collider,
                &scene,
                &clock,
            ))
        });
        match surface {
            Ok(surface) => {
                commands.entity(entity).try_insert(surface);
                *status = ColliderStatus::Ready;
            }
            // The same error as before: logged already.
            Err(error) if matches!(&*status, ColliderStatus::Failed(known) if *known == error) => {}
            Err(error) => {
                if error.is_of_hierarchy()
                    || matches!(*error, ColliderError::InverseBindposes { .. })
                {
                    tracing::error!("no surface for {entity}: {error}");
                }
                commands.entity(entity).try_remove::<PosedSurface>();
                *status = ColliderStatus::Failed(error);
            }
        }
    }
}

/// Sets a status to waiting; marks it as changed only if it was not.
fn wait(status: &mut Mut<'_, ColliderStatus>) {
    if !matches!(**status, ColliderStatus::Waiting) {
        **status = ColliderStatus::Waiting;
    }
}

/// An affine map from a matrix by columns; its last row is ignored.
fn widen(columns: &[f32; 16]) -> DAffine3 {
    Affine::from_cols_array(columns).to_f64()
}
