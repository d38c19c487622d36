use std::sync::Arc;

use bevy_asset::{Assets, Handle};
use bevy_ecs::prelude::*;
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Mesh, Mesh3d};
use bevy_transform::components::Transform;
use clamber_gltf::Rig;
use clamber_surface::mesh::SurfaceTag;
use clamber_surface::rig::{self, Pose};
use glam::DMat4;
use thiserror::Error;

use super::mesh::mesh;
use crate::ColliderTag;

/// Joints that a mesh asset of Bevy can name.
const MAX_JOINTS: usize = 1 << 16;

/// A rig has more joints than a mesh asset of Bevy can name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the rig has {0} joints, where a mesh asset can name {MAX_JOINTS}")]
pub struct TooManyJoints(pub usize);

/// A creature that `clamber_gltf` has loaded, as assets of Bevy: made once, [spawned](RigAssets::spawn) any number
/// of times.
///
/// A mesh asset for each primitive of what is to be seen, with the four strongest influences of each vertex, as
/// many as Bevy has, renormalised. Meshes that are for collision only are not among them: see
/// [`Rig::collider`] for these.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RigAssets {
    rig: Arc<Rig>,
    inverse_bindposes: Handle<SkinnedMeshInverseBindposes>,
    meshes: Vec<RigMesh>,
}

/// One primitive.
#[derive(Clone, Debug)]
struct RigMesh {
    name: String,
    mesh: Handle<Mesh>,
    material: Option<usize>,
    tag: SurfaceTag,
}

/// The entities of a creature.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SpawnedRig {
    /// Above all others: despawning it takes all away. Has [`RigJoints`]; moving it moves the creature.
    pub root: Entity,
    /// In the order of the rig's skeleton.
    pub joints: Vec<Entity>,
    /// Skinned meshes, in the order of the rig's visual meshes and their primitives. A `SkinnedCollider` here
    /// makes a surface.
    pub meshes: Vec<Entity>,
}

/// On a mesh of a [`SpawnedRig`]: which of [`Rig::materials`] it has. Without it, glTF's default material.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct RigMaterial(pub usize);

/// On the root of a [`SpawnedRig`]: its joints, and what they were made from.
#[derive(Component, Clone, Debug)]
pub struct RigJoints {
    pub(super) rig: Arc<Rig>,
    #[entities]
    pub(super) joints: Vec<Entity>,
    pub(super) rest: Pose,
    pub(super) pose: Pose,
}

impl RigJoints {
    /// Clips, names, weak points.
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// In the order of the rig's skeleton.
    pub fn joints(&self) -> &[Entity] {
        &self.joints
    }
}

impl RigAssets {
    /// Adds the meshes and inverse bind poses of a rig.
    ///
    /// # Errors
    /// [`TooManyJoints`] beyond 65,536 of them.
    pub fn new(
        rig: Rig,
        meshes: &mut Assets<Mesh>,
        inverse_bindposes: &mut Assets<SkinnedMeshInverseBindposes>,
    ) -> Result<Self, TooManyJoints> {
        let joints = rig.skeleton.joints();
        if joints.len() > MAX_JOINTS {
            return Err(TooManyJoints(joints.len()));
        }
        let matrices = joints.iter().map(|joint| {
            // Widened and rounded back: the same bits.
            DMat4::from(joint.inverse_bind.to_f64()).as_mat4()
        });
        let inverse_bindposes = inverse_bindposes.add(matrices.collect::<Vec<_>>());
        let mut added = Vec::new();
        for visual in &rig.visual {
            for primitive in &visual.primitives {
                added.push(RigMesh {
                    name: visual.name.clone(),
                    mesh: meshes.add(mesh(visual, primitive)),
                    material: primitive.material,
                    tag: primitive.tag,
                });
            }
        }
        Ok(Self {
            rig: Arc::new(rig),
            inverse_bindposes,
            meshes: added,
        })
    }

    /// What it was made from.
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// Spawns a creature at rest: a root at `place`, under it the joints, with names, and the skinned meshes, each
    /// with the [`ColliderTag`] that the file gives its material.
    ///
    /// Materials and visibility are the app's: an app that draws inserts `Visibility` on the root, and a material,
    /// chosen by [`RigMaterial`], on each mesh.
    pub fn spawn(&self, commands: &mut Commands<'_, '_>, place: Transform) -> SpawnedRig {
        let skeleton = &self.rig.skeleton;
        let rest = skeleton.rest_pose();
        let root = commands.spawn(place).id();
        let joints: Vec<Entity> = skeleton
            .joints()
            .iter()
            .map(|joint| {
                let name = Name::new(joint.name.clone());
                commands.spawn((name, transform(&joint.rest))).id()
            })
            .collect();
        for (joint, entity) in skeleton.joints().iter().zip(&joints) {
            let parent = joint
                .parent
                .and_then(|parent| joints.get(parent.0 as usize));
            let parent = parent.copied().unwrap_or(root);
            commands.entity(*entity).insert(ChildOf(parent));
        }
        let meshes = self.meshes.iter().map(|mesh| {
            let skin = SkinnedMesh {
                inverse_bindposes: self.inverse_bindposes.clone(),
                joints: joints.clone(),
            };
            let name = Name::new(mesh.name.clone());
            let tag = ColliderTag(mesh.tag);
            let shown = Mesh3d(mesh.mesh.clone());
            let mut spawned = commands.spawn((name, shown, skin, tag, ChildOf(root)));
            if let Some(material) = mesh.material {
                spawned.insert(RigMaterial(material));
            }
            spawned.id()
        });
        let meshes = meshes.collect();
        commands.entity(root).insert(RigJoints {
            rig: Arc::clone(&self.rig),
            joints: joints.clone(),
            pose: rest.clone(),
            rest,
        });
        SpawnedRig {
            root,
            joints,
            meshes,
        }
    }
}

/// With a rotation of unit length, as Bevy wants it.
pub(super) fn transform(local: &rig::Transform) -> Transform {
    let rotation = local.rotation.as_dquat();
    Transform {
        translation: local.translation,
        rotation: rotation.normalize().as_quat(),
        scale: local.scale,
    }
}
