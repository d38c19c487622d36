//! The entities that pose a skin: joints, what stands between and above them.

use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::rig::{self, Pose, RigError};
use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::ColliderError;

/// The deepest hierarchy that is followed.
const MAX_DEPTH: usize = 4096;

/// How far from a similarity, relative to its scale, the placement of a creature may be and still be taken for
/// one: rotations in f32 are no better.
const SIMILAR: f64 = 1e-6;

/// Transforms of entities, and what they hang under.
pub(crate) type Hierarchy<'w, 's> = Query<'w, 's, (&'static Transform, Option<&'static ChildOf>)>;

/// Whose transforms make the palette, and how.
///
/// Model space is that of the nearest entity above all joints, or the world. The palette is composed there, so
/// that it does not depend on where in the world a creature is.
#[derive(Debug)]
pub(crate) struct Rig {
    joints: Vec<Entity>,
    /// Joints, and what stands between them and model space; parents first.
    nodes: Vec<Node>,
    /// By joint, which node it is.
    node_of_joint: Vec<u32>,
    /// By joint.
    joint_from_mesh: Vec<DAffine3>,
    /// From model space up to the top of the hierarchy.
    above: Vec<Entity>,
}

#[derive(Debug)]
struct Node {
    entity: Entity,
    /// Which node it hangs under; `None` under model space.
    parent: Option<u32>,
}

/// Transforms as they were at some time.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Locals {
    /// Of the joints and what stands between them.
    pub(crate) nodes: Pose,
    /// Of what stands above them.
    pub(crate) above: Pose,
}

/// A transform that was to be read is gone, or hangs elsewhere now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Changed;

impl Rig {
    pub(crate) fn new(
        joints: Vec<Entity>,
        joint_from_mesh: Vec<DAffine3>,
        hierarchy: &Hierarchy<'_, '_>,
    ) -> Result<Self, ColliderError> {
        if joints.len() != joint_from_mesh.len() {
            return Err(ColliderError::InverseBindposes {
                joints: joints.len(),
                inverse_bindposes: joint_from_mesh.len(),
            });
        }
        let mut above: Option<Vec<Entity>> = None;
        let mut paths = Vec::with_capacity(joints.len());
        for (joint, entity) in joints.iter().enumerate() {
            let path = path_up(*entity, hierarchy).ok_or(ColliderError::Joint { joint })?;
            match &mut above {
                None => above = Some(path[1..].to_vec()),
                Some(above) => {
                    if path.last() != paths.first().and_then(|first: &Vec<Entity>| first.last()) {
                        return Err(ColliderError::Hierarchies { joint });
                    }
                    let shared = path[1..].iter().rev().zip(above.iter().rev());
                    let shared = shared.take_while(|(a, b)| a == b).count();
                    above.drain(..above.len() - shared);
                }
            }
            paths.push(path);
        }
        let above = above.unwrap_or_default();
        let mut nodes: Vec<Node> = Vec::new();
        let mut node_of_joint = Vec::with_capacity(joints.len());
        for path in &paths {
            let mut parent = None;
            for entity in path[..path.len() - above.len()].iter().rev() {
                let known = nodes.iter().position(|node| node.entity == *entity);
                let node = known.unwrap_or(nodes.len()) as u32;
                if known.is_none() {
                    let entity = *entity;
                    nodes.push(Node { entity, parent });
                }
                parent = Some(node);
            }
            node_of_joint.extend(parent);
        }
        Ok(Self {
            joints,
            nodes,
            node_of_joint,
            joint_from_mesh,
            above,
        })
    }

    /// Follows a hierarchy that has changed.
    pub(crate) fn follow(&mut self, hierarchy: &Hierarchy<'_, '_>) -> Result<(), ColliderError> {
        *self = Self::new(self.joints.clone(), self.joint_from_mesh.clone(), hierarchy)?;
        Ok(())
    }

    /// Reads all.
    pub(crate) fn read(
        &self,
        hierarchy: &Hierarchy<'_, '_>,
        into: &mut Locals,
    ) -> Result<(), Changed> {
        self.read_joints(hierarchy, &mut into.nodes)?;
        self.read_root(hierarchy, &mut into.above)
    }

    /// Reads the joints and what stands between them.
    pub(crate) fn read_joints(
        &self,
        hierarchy: &Hierarchy<'_, '_>,
        into: &mut Pose,
    ) -> Result<(), Changed> {
        into.transforms.clear();
        for node in &self.nodes {
            let parent = match node.parent {
                Some(parent) => Some(self.nodes[parent as usize].entity),
                None => self.above.first().copied(),
            };
            into.transforms.push(read(node.entity, parent, hierarchy)?);
        }
        Ok(())
    }

    /// Reads what stands above the joints.
    pub(crate) fn read_root(
        &self,
        hierarchy: &Hierarchy<'_, '_>,
        into: &mut Pose,
    ) -> Result<(), Changed> {
        into.transforms.clear();
        for (index, entity) in self.above.iter().enumerate() {
            let parent = self.above.get(index + 1).copied();
            into.transforms.push(read(*entity, parent, hierarchy)?);
        }
        Ok(())
    }

    /// Where the creature stands, and its palette in model space, joint by joint.
    ///
    /// What of the placement is no similarity goes into the palette. `None` if the placement has no volume or is
    /// not finite.
    pub(crate) fn compose(
        &self,
        locals: &Locals,
        model_from_node: &mut Vec<DAffine3>,
        matrices: &mut Vec<Affine>,
    ) -> Option<Similarity> {
        let mut world_from_model = DAffine3::IDENTITY;
        for transform in &locals.above.transforms {
            world_from_model = transform.to_affine() * world_from_model;
        }
        let (similarity, rest) = split(&world_from_model)?;
        model_from_node.clear();
        for (node, local) in self.nodes.iter().zip(&locals.nodes.transforms) {
            let parent = match node.parent {
                Some(parent) => model_from_node[parent as usize],
                None => rest,
            };
            model_from_node.push(parent * local.to_affine());
        }
        matrices.clear();
        let joints = self.node_of_joint.iter().zip(&self.joint_from_mesh);
        matrices.extend(joints.map(|(node, joint_from_mesh)| {
            Affine::from_f64(&(model_from_node[*node as usize] * *joint_from_mesh))
        }));
        Some(similarity)
    }
}

/// One entity's transform, if it still hangs where it did.
fn read(
    entity: Entity,
    parent: Option<Entity>,
    hierarchy: &Hierarchy<'_, '_>,
) -> Result<rig::Transform, Changed> {
    let (transform, child_of) = hierarchy.get(entity).map_err(|_| Changed)?;
    if child_of.map(ChildOf::parent) != parent {
        return Err(Changed);
    }
    Ok(rig::Transform {
        translation: transform.translation,
        rotation: transform.rotation,
        scale: transform.scale,
    })
}

/// An entity and all above it; `None` if one of them has no transform.
fn path_up(entity: Entity, hierarchy: &Hierarchy<'_, '_>) -> Option<Vec<Entity>> {
    let mut path = vec![entity];
    let mut next = hierarchy.get(entity).ok()?.1;
    while let Some(child_of) = next {
        if path.len() > MAX_DEPTH {
            return None;
        }
        path.push(child_of.parent());
        next = hierarchy.get(child_of.parent()).ok()?.1;
    }
    Some(path)
}

/// A placement as a similarity, and what stands before it: nothing, if it is one.
fn split(map: &DAffine3) -> Option<(Similarity, DAffine3)> {
    let linear = map.matrix3;
    let scale = libm::cbrt(linear.determinant().abs());
    let x = linear.x_axis.try_normalize()?;
    let z = x.cross(linear.y_axis).try_normalize()?;
    let axes = DMat3::from_cols(x, z.cross(x), z);
    let similarity = Similarity {
        rotation: DQuat::from_mat3(&axes).normalize(),
        scale,
        translation: map.translation,
    };
    if !similarity.is_valid() {
        return None;
    }
    let columns = [
        (linear.x_axis, axes.x_axis),
        (linear.y_axis, axes.y_axis),
        (linear.z_axis, axes.z_axis),
    ];
    let apart = |(found, axis): (DVec3, DVec3)| (found - axis * scale).length();
    let worst = columns.map(apart).into_iter().fold(0.0, f64::max);
    let rest = if worst <= SIMILAR * scale {
        DAffine3::IDENTITY
    } else {
        DAffine3::from_mat3(axes.transpose() * linear * (1.0 / scale))
    };
    Some((similarity, rest))
}

/// Sets what lies between two, at a fraction from 0 to 1 of the way.
pub(crate) fn set_between(
    pose: &mut Pose,
    from: &Pose,
    to: &Pose,
    fraction: f64,
) -> Result<(), RigError> {
    pose.transforms.clone_from(&from.transforms);
    if from == to {
        return Ok(());
    }
    pose.blend_in(to, fraction)
}
