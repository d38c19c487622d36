//! The entities that pose a skin: joints, and the entities between and above them.

use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::rig::{self, Palette, Pose, RigError};
use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::ColliderError;

/// The deepest hierarchy that is followed.
const MAX_DEPTH: usize = 4096;

/// Largest deviation from a similarity, relative to its scale, at which a creature's placement is taken for one:
/// rotations in f32 are no more accurate.
const SIMILAR: f64 = 1e-6;

/// The entities from which poses are read.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a, 'w, 's> {
    pub(crate) hierarchy: &'a Hierarchy<'w, 's>,
    /// The [`WorldOrigin`](crate::WorldOrigin).
    pub(crate) origin: DVec3,
}

/// Transforms of entities, and their parents.
pub(crate) type Hierarchy<'w, 's> = Query<'w, 's, (&'static Transform, Option<&'static ChildOf>)>;

/// The entities whose transforms make the palette.
///
/// Model space is the space of the nearest entity above all joints. If a skeleton has no such entity, it is world
/// space, moved to the topmost joint. The palette is composed in model space, so that it does not depend on the
/// creature's place in the world.
#[derive(Debug)]
pub(crate) struct Rig {
    joints: Vec<Entity>,
    /// Per joint.
    joint_from_mesh: Vec<DAffine3>,
    tree: Tree,
}

/// The hierarchy of the joints.
#[derive(Debug)]
struct Tree {
    /// Joints, and the entities between them and model space; parents first.
    nodes: Vec<Node>,
    /// Per joint: its node.
    node_of_joint: Vec<u32>,
    /// Entities from model space up to the top of the hierarchy.
    above: Vec<Entity>,
}

#[derive(Debug)]
struct Node {
    entity: Entity,
    /// The parent's node; `None` for a child of model space.
    parent: Option<u32>,
}

/// Transforms at some time.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Locals {
    /// Transforms of the joints and of the entities between them.
    nodes: Pose,
    /// Transforms of the entities above them.
    above: Pose,
    /// The [`WorldOrigin`](crate::WorldOrigin), which the topmost of these transforms is relative to.
    origin: DVec3,
}

impl Locals {
    /// The topmost transform: of the last entity above the joints, or of the first joint.
    fn top(&self) -> Option<&rig::Transform> {
        self.above
            .transforms
            .last()
            .or(self.nodes.transforms.first())
    }

    /// Where the topmost entity is, in world space.
    pub(crate) fn place(&self) -> Option<DVec3> {
        Some(self.origin + self.top()?.translation.as_dvec3())
    }

    pub(crate) fn copy_joints(&mut self, from: &Self) -> Result<(), RigError> {
        self.nodes.clone_from(&from.nodes);
        if from.above.transforms.is_empty() {
            self.origin = from.origin;
        }
        Ok(())
    }

    pub(crate) fn copy_root(&mut self, from: &Self) -> Result<(), RigError> {
        self.above.clone_from(&from.above);
        if !from.above.transforms.is_empty() {
            self.origin = from.origin;
        }
        Ok(())
    }

    /// The joints between two poses.
    pub(crate) fn blend_joints(
        &mut self,
        from: &Self,
        to: &Self,
        fraction: f64,
    ) -> Result<(), RigError> {
        self.copy_joints(from)?;
        if to.origin == from.origin {
            return self.nodes.blend_in(&to.nodes, fraction);
        }
        self.nodes
            .blend_in(&to.relative_to(from.origin).nodes, fraction)
    }

    /// The transform above the joints, between two poses.
    pub(crate) fn blend_root(
        &mut self,
        from: &Self,
        to: &Self,
        fraction: f64,
    ) -> Result<(), RigError> {
        self.copy_root(from)?;
        if to.origin == from.origin {
            return self.above.blend_in(&to.above, fraction);
        }
        self.above
            .blend_in(&to.relative_to(from.origin).above, fraction)
    }

    /// The same pose relative to another origin.
    fn relative_to(&self, origin: DVec3) -> Self {
        let mut moved = self.clone();
        let top = moved.above.transforms.last_mut();
        if let Some(top) = top.or(moved.nodes.transforms.first_mut()) {
            let place = self.origin + top.translation.as_dvec3() - origin;
            top.translation = place.as_vec3();
        }
        moved.origin = origin;
        moved
    }
}

/// A transform that should be read is gone, or its entity has another parent now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Changed;

impl Rig {
    pub(crate) fn new(
        joints: Vec<Entity>,
        joint_from_mesh: Vec<DAffine3>,
        hierarchy: &Hierarchy<'_, '_>,
    ) -> Result<Self, ColliderError> {
        if joints.len() > joint_from_mesh.len() {
            return Err(ColliderError::InverseBindposes {
                joints: joints.len(),
                inverse_bindposes: joint_from_mesh.len(),
            });
        }
        Ok(Self {
            tree: Tree::new(&joints, hierarchy)?,
            joints,
            joint_from_mesh,
        })
    }

    /// Follows a hierarchy that has changed.
    pub(crate) fn follow(&mut self, hierarchy: &Hierarchy<'_, '_>) -> Result<(), ColliderError> {
        self.tree = Tree::new(&self.joints, hierarchy)?;
        Ok(())
    }

    /// Reads all transforms. True if they are equal to `last`.
    pub(crate) fn read(
        &self,
        scene: &Scene<'_, '_, '_>,
        last: &Locals,
        into: &mut Locals,
    ) -> Result<bool, Changed> {
        let joints = self.read_joints(scene, last, into)?;
        let root = self.read_root(scene, last, into)?;
        Ok(joints && root)
    }

    /// Reads the joints and the entities between them. True if they are equal to `last`.
    pub(crate) fn read_joints(
        &self,
        scene: &Scene<'_, '_, '_>,
        last: &Locals,
        into: &mut Locals,
    ) -> Result<bool, Changed> {
        let nodes = self.tree.nodes.iter().map(|node| {
            let parent = match node.parent {
                Some(parent) => Some(self.tree.nodes[parent as usize].entity),
                None => self.tree.above.first().copied(),
            };
            (node.entity, parent)
        });
        let same = read_all(nodes, scene.hierarchy, &last.nodes, &mut into.nodes)?;
        if !self.tree.above.is_empty() {
            return Ok(same);
        }
        into.origin = scene.origin;
        Ok(same && into.origin == last.origin)
    }

    /// Reads the entities above the joints. True if they are equal to `last`.
    pub(crate) fn read_root(
        &self,
        scene: &Scene<'_, '_, '_>,
        last: &Locals,
        into: &mut Locals,
    ) -> Result<bool, Changed> {
        let above = &self.tree.above;
        let entities = above.iter().enumerate();
        let entities = entities.map(|(index, entity)| (*entity, above.get(index + 1).copied()));
        let same = read_all(entities, scene.hierarchy, &last.above, &mut into.above)?;
        if above.is_empty() {
            return Ok(same);
        }
        into.origin = scene.origin;
        Ok(same && into.origin == last.origin)
    }

    /// Computes the creature's placement in the world, and its palette in model space, joint by joint.
    ///
    /// The part of the placement that is not a similarity goes into the palette. `None` if the placement has no volume
    /// or is not finite, or if `locals` are of another hierarchy.
    pub(crate) fn compose(
        &self,
        locals: &Locals,
        model_from_node: &mut Vec<DAffine3>,
        palette: &mut Palette,
    ) -> Option<Similarity> {
        let mut world_from_model = DAffine3::IDENTITY;
        for transform in &locals.above.transforms {
            world_from_model = transform.to_affine() * world_from_model;
        }
        let (mut similarity, mut rest) = split(&world_from_model)?;
        if self.tree.above.is_empty()
            && let Some(topmost) = locals.nodes.transforms.first()
        {
            similarity.translation = topmost.translation.as_dvec3();
            rest.translation = -similarity.translation;
        }
        similarity.translation += locals.origin;
        if locals.nodes.transforms.len() != self.tree.nodes.len() || !similarity.is_valid() {
            return None;
        }
        model_from_node.resize(self.tree.nodes.len(), DAffine3::IDENTITY);
        let nodes = self.tree.nodes.iter().zip(&locals.nodes.transforms);
        for (index, (node, local)) in nodes.enumerate() {
            let parent = match node.parent {
                Some(parent) => &model_from_node[parent as usize],
                None => &rest,
            };
            model_from_node[index] = *parent * local.to_affine();
        }
        let joints = self.tree.node_of_joint.iter().zip(&self.joint_from_mesh);
        palette.set_matrices(joints.map(|(node, joint_from_mesh)| {
            Affine::from_f64(&(model_from_node[*node as usize] * *joint_from_mesh))
        }));
        Some(similarity)
    }
}

impl Tree {
    /// Visits each entity once, however deep the hierarchy is.
    fn new(joints: &[Entity], hierarchy: &Hierarchy<'_, '_>) -> Result<Self, ColliderError> {
        let mut nodes: Vec<Node> = Vec::with_capacity(joints.len());
        let mut known = EntityHashMap::<u32>::default();
        let mut node_of_joint = Vec::with_capacity(joints.len());
        let mut path = Vec::new();
        for (joint, entity) in joints.iter().enumerate() {
            let met = path_up(*entity, hierarchy, &known, &mut path);
            let met = met.ok_or(ColliderError::Joint { joint })?;
            if met.is_none() && joint > 0 {
                return Err(ColliderError::Hierarchies { joint });
            }
            let mut parent = met;
            for entity in path.drain(..).rev() {
                let node = nodes.len() as u32;
                nodes.push(Node { entity, parent });
                known.insert(entity, node);
                parent = Some(node);
            }
            node_of_joint.extend(parent);
        }
        let above = above_all(&nodes, &node_of_joint);
        let beyond = above as u32;
        for node in &mut nodes {
            node.parent = node.parent.and_then(|parent| parent.checked_sub(beyond));
        }
        let mut above: Vec<Entity> = nodes.drain(..above).map(|node| node.entity).collect();
        above.reverse();
        for node in &mut node_of_joint {
            *node -= beyond;
        }
        Ok(Self {
            nodes,
            node_of_joint,
            above,
        })
    }
}

/// Number of the first nodes that are above all joints: from the top to the first node with several children, or to the
/// node before the first joint, whichever comes first.
fn above_all(nodes: &[Node], node_of_joint: &[u32]) -> usize {
    let mut children = vec![0; nodes.len()];
    for parent in nodes.iter().filter_map(|node| node.parent) {
        children[parent as usize] += 1;
    }
    let mut is_joint = vec![false; nodes.len()];
    for node in node_of_joint {
        is_joint[*node as usize] = true;
    }
    // The first nodes are the path down to joint 0.
    let joint = is_joint.iter().position(|is_joint| *is_joint);
    let fork = children.iter().position(|children| *children > 1);
    let joint = joint.unwrap_or(0);
    fork.map_or(joint, |fork| joint.min(fork + 1))
}

/// Reads the transforms of entities that have these parents. True if they are equal to `last`.
fn read_all(
    entities: impl ExactSizeIterator<Item = (Entity, Option<Entity>)>,
    hierarchy: &Hierarchy<'_, '_>,
    last: &Pose,
    into: &mut Pose,
) -> Result<bool, Changed> {
    let mut same = last.transforms.len() == entities.len();
    into.transforms.clear();
    into.transforms.reserve(entities.len());
    for (index, (entity, parent)) in entities.enumerate() {
        let transform = read(entity, parent, hierarchy)?;
        same = same && last.transforms[index] == transform;
        into.transforms.push(transform);
    }
    Ok(same)
}

/// The transform of an entity, if it still has the same parent.
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

/// Writes an entity and its ancestors to `path`, up to the first known node, and returns that node, or `Some(None)` at
/// the top of the hierarchy. `None` if one of them has no transform, or they form a cycle.
fn path_up(
    entity: Entity,
    hierarchy: &Hierarchy<'_, '_>,
    known: &EntityHashMap<u32>,
    path: &mut Vec<Entity>,
) -> Option<Option<u32>> {
    path.clear();
    let mut next = Some(entity);
    while let Some(entity) = next {
        if let Some(node) = known.get(&entity) {
            return Some(Some(*node));
        }
        if path.len() > MAX_DEPTH {
            return None;
        }
        path.push(entity);
        next = hierarchy.get(entity).ok()?.1.map(ChildOf::parent);
    }
    Some(None)
}

/// Splits a placement into a similarity and a map that is applied before it: the identity, if the placement is one.
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
