//! The giant in an app: entities for its joints, its skin as a mesh asset.

use std::sync::Arc;

use bevy_app::{App, FixedPostUpdate, PostUpdate};
use bevy_asset::{Assets, RenderAssetUsages};
use bevy_clamber::clamber_surface::mesh::{ColliderMesh, VertexId};
use bevy_clamber::clamber_surface::rig::Pose;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::SingleThreadedExecutor;
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Indices, Mesh, Mesh3d, PrimitiveTopology, VertexAttributeValues};
use bevy_transform::components::Transform;
use clamber_scenes::Creature;
use glam::DMat4;

use crate::common;

/// An app with some giants, all at one place.
pub(crate) struct Giants {
    pub(crate) app: App,
    /// Joints per giant, in the order of the skeleton.
    pub(crate) joints: Vec<Vec<Entity>>,
    pub(crate) surfaces: Vec<Entity>,
}

impl Giants {
    pub(crate) fn new(mut app: App, creature: &Creature, count: usize, timing: PoseTiming) -> Self {
        let mesh = common::add_mesh(&mut app, mesh(&creature.rig.collider));
        let joints = creature.rig.skeleton.joints();
        let bind = joints
            .iter()
            .map(|j| DMat4::from(j.inverse_bind.to_f64()).as_mat4());
        let bind = SkinnedMeshInverseBindposes::from(bind.collect::<Vec<_>>());
        let inverse_bindposes = app
            .world_mut()
            .resource_mut::<Assets<SkinnedMeshInverseBindposes>>()
            .add(bind);
        let collider = SkinnedCollider {
            joints: timing,
            root: timing,
            ..SkinnedCollider::each_frame()
        };
        let (mut all_joints, mut surfaces) = (Vec::new(), Vec::new());
        for _ in 0..count {
            let world = app.world_mut();
            let root = world.spawn(Transform::IDENTITY).id();
            let entities: Vec<Entity> = joints
                .iter()
                .map(|_| world.spawn(Transform::IDENTITY).id())
                .collect();
            for (joint, entity) in joints.iter().zip(&entities) {
                let parent = joint
                    .parent
                    .map_or(root, |parent| entities[parent.0 as usize]);
                world.entity_mut(*entity).insert(ChildOf(parent));
            }
            let skin = SkinnedMesh {
                inverse_bindposes: inverse_bindposes.clone(),
                joints: entities.clone(),
            };
            let surface = world.spawn((Mesh3d(mesh.clone()), skin, collider)).id();
            all_joints.push(entities);
            surfaces.push(surface);
        }
        for surface in &surfaces {
            common::wait(&mut app, *surface);
        }
        Self {
            app,
            joints: all_joints,
            surfaces,
        }
    }

    /// Writes a pose to the joints of all giants, as an animation would.
    pub(crate) fn pose(&mut self, pose: &Pose) {
        for joints in &self.joints {
            for (joint, transform) in joints.iter().zip(&pose.transforms) {
                let mut joint = self.app.world_mut().get_mut::<Transform>(*joint).unwrap();
                *joint = Transform {
                    translation: transform.translation,
                    rotation: transform.rotation,
                    scale: transform.scale,
                };
            }
        }
    }

    /// The collider mesh that all giants share.
    pub(crate) fn mesh(&self) -> Arc<ColliderMesh> {
        let surface = self.app.world().get::<PosedSurface>(self.surfaces[0]);
        Arc::clone(surface.unwrap().mesh())
    }
}

/// The app with the measured schedules on one thread, so that no other threads are woken.
pub(crate) fn on_one_thread(mut app: App) -> App {
    app.edit_schedule(FixedPostUpdate, |schedule| {
        schedule.set_executor(SingleThreadedExecutor::new());
    });
    app.edit_schedule(PostUpdate, |schedule| {
        schedule.set_executor(SingleThreadedExecutor::new());
    });
    app
}

/// A collider as an asset.
fn mesh(collider: &ColliderMesh) -> Mesh {
    let (mut joints, mut weights) = (Vec::new(), Vec::new());
    for vertex in 0..collider.positions().len() as u32 {
        let (mut joint, mut weight) = ([0; 4], [0.0; 4]);
        let mut influences: Vec<_> = collider.influences(VertexId(vertex)).collect();
        influences.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        for (slot, (id, share)) in influences.into_iter().take(4).enumerate() {
            joint[slot] = id.0 as u16;
            weight[slot] = share;
        }
        joints.push(joint);
        weights.push(weight);
    }
    let positions: Vec<[f32; 3]> = collider.positions().iter().map(|p| p.to_array()).collect();
    let corners = collider.triangles().iter().flatten().map(|v| v.0);
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_JOINT_INDEX,
        VertexAttributeValues::Uint16x4(joints),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights)
    .with_inserted_indices(Indices::U32(corners.collect()))
}
