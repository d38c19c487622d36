use std::sync::Arc;

use bevy_asset::{Assets, Handle};
use bevy_ecs::prelude::*;
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Mesh, Mesh3d};
use bevy_transform::components::Transform;
use clamber_animation::{AnimationError, AnimationSet};
use clamber_gltf::Model;
use clamber_surface::mesh::Rig;
use clamber_surface::mesh::SurfaceTag;
use clamber_surface::rig;
use glam::DMat4;
use thiserror::Error;

use super::mesh::mesh;
use super::player::Played;
use crate::ColliderTag;

/// Maximum number of joints that a Bevy mesh can index: its joint indices have 16 bits.
const MAX_JOINTS: usize = 1 << 16;

/// The rig has this many joints, more than a Bevy mesh can index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the rig has {0} joints, but a Bevy mesh can index at most {MAX_JOINTS}")]
pub struct TooManyJoints(pub usize);

/// A creature that `clamber_gltf` loaded, as Bevy assets: made once, [spawned](RigAssets::spawn) any number of times.
///
/// Each primitive of the visual meshes becomes a mesh asset. Its vertices keep their four strongest influences, as many
/// as Bevy supports, with weights normalised to a sum of 1. Meshes for collision only are left out; see
/// [`Rig::collider`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RigAssets {
    model: Arc<Model>,
    /// The model's clips, or the reason why they do not fit its skeleton.
    animations: Result<Arc<AnimationSet>, AnimationError>,
    inverse_bindposes: Handle<SkinnedMeshInverseBindposes>,
    meshes: Vec<RigMesh>,
}

/// One primitive of a visual mesh.
#[derive(Clone, Debug)]
struct RigMesh {
    name: String,
    mesh: Handle<Mesh>,
    material: Option<usize>,
    tag: SurfaceTag,
}

/// The entities of a creature that [`RigAssets::spawn`] spawned.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SpawnedRig {
    /// The parent of the whole creature: moving it moves the creature, despawning it despawns all. Has [`RigJoints`].
    pub root: Entity,
    /// Joints, in the order of the rig's skeleton.
    pub joints: Vec<Entity>,
    /// Skinned meshes, in the order of the rig's visual meshes and their primitives. Insert a `SkinnedCollider` on one
    /// to make it a surface.
    pub meshes: Vec<Entity>,
}

/// The material of a mesh of a [`SpawnedRig`], as an index into [`Model::materials`](clamber_gltf::Model::materials).
///
/// A mesh without this component has glTF's default material.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct RigMaterial(pub usize);

/// A component on the root of a [`SpawnedRig`]: its joints, and the rig that they were made from.
#[derive(Component, Clone, Debug)]
pub struct RigJoints {
    pub(super) model: Arc<Model>,
    #[entities]
    pub(super) joints: Vec<Entity>,
    pub(super) animations: Result<Arc<AnimationSet>, AnimationError>,
    pub(super) played: Played,
}

impl RigJoints {
    /// The rig: skeleton, clips, skin, weak points.
    pub fn rig(&self) -> &Rig {
        &self.model.rig
    }

    /// The joints' entities, in the order of the rig's skeleton.
    pub fn joints(&self) -> &[Entity] {
        &self.joints
    }
}

impl RigAssets {
    /// Adds the visual meshes and inverse bind poses of a rig to the assets.
    ///
    /// # Errors
    /// [`TooManyJoints`] if the rig has more than 65,536 joints.
    pub fn new(
        model: Model,
        meshes: &mut Assets<Mesh>,
        inverse_bindposes: &mut Assets<SkinnedMeshInverseBindposes>,
    ) -> Result<Self, TooManyJoints> {
        let joints = model.rig.skeleton.joints();
        if joints.len() > MAX_JOINTS {
            return Err(TooManyJoints(joints.len()));
        }
        let matrices = joints.iter().map(|joint| {
            // Widening to f64 and rounding back keeps the bits.
            DMat4::from(joint.inverse_bind.to_f64()).as_mat4()
        });
        let inverse_bindposes = inverse_bindposes.add(matrices.collect::<Vec<_>>());
        let mut added = Vec::new();
        for visual in &model.visual {
            for primitive in &visual.primitives {
                added.push(RigMesh {
                    name: visual.name.clone(),
                    mesh: meshes.add(mesh(visual, primitive)),
                    material: primitive.material,
                    tag: primitive.tag,
                });
            }
        }
        let animations =
            AnimationSet::new(&model.rig.skeleton, model.rig.clips.clone()).map(Arc::new);
        Ok(Self {
            model: Arc::new(model),
            animations,
            inverse_bindposes,
            meshes: added,
        })
    }

    /// The rig that the assets were made from.
    pub fn rig(&self) -> &Rig {
        &self.model.rig
    }

    /// The whole content of the file, with the meshes to draw and their materials.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Spawns a creature in its rest pose: a root at `place`, and below it the named joints and the skinned meshes.
    ///
    /// Each mesh gets the [`ColliderTag`] of its material in the file. Materials and visibility are left to the app: to
    /// draw the creature, insert `Visibility` on the root, and on each mesh a material chosen by its [`RigMaterial`].
    pub fn spawn(&self, commands: &mut Commands<'_, '_>, place: Transform) -> SpawnedRig {
        let skeleton = &self.model.rig.skeleton;
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
            model: Arc::clone(&self.model),
            joints: joints.clone(),
            animations: self.animations.clone(),
            played: Played::default(),
        });
        SpawnedRig {
            root,
            joints,
            meshes,
        }
    }
}

/// A Bevy `Transform`, whose rotation has unit length.
pub(crate) fn transform(local: &rig::Transform) -> Transform {
    let rotation = local.rotation.as_dquat();
    Transform {
        translation: local.translation,
        rotation: rotation.normalize().as_quat(),
        scale: local.scale,
    }
}
