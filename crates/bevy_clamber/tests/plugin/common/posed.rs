//! The triangles of skinned meshes in f64, posed from the entities' transforms alone.

use bevy_app::App;
use bevy_asset::Assets;
use bevy_ecs::prelude::*;
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Mesh, Mesh3d, VertexAttributeValues};
use bevy_transform::components::Transform;
use clamber_verify::brute_force::Corners;
use glam::{DAffine3, DQuat, DVec3};

/// An entity's transform in world space, from the `Transform`s of the entity and its ancestors.
pub(crate) fn world_from(app: &App, entity: Entity) -> DAffine3 {
    let transform = app.world().get::<Transform>(entity).unwrap();
    let q = transform.rotation;
    let local = DAffine3::from_scale_rotation_translation(
        transform.scale.as_dvec3(),
        DQuat::from_xyzw(q.x.into(), q.y.into(), q.z.into(), q.w.into()).normalize(),
        transform.translation.as_dvec3(),
    );
    match app.world().get::<ChildOf>(entity) {
        Some(child_of) => world_from(app, child_of.parent()) * local,
        None => local,
    }
}

/// The current positions of a skinned mesh's vertices, in world space.
pub(crate) fn positions(app: &App, entity: Entity) -> Vec<DVec3> {
    let world = app.world();
    let skin = world.get::<SkinnedMesh>(entity).unwrap();
    let bind = world.resource::<Assets<SkinnedMeshInverseBindposes>>();
    let bind = bind.get(&skin.inverse_bindposes).unwrap();
    let palette: Vec<DAffine3> = skin
        .joints
        .iter()
        .zip(bind.iter())
        .map(|(joint, bind)| world_from(app, *joint) * DAffine3::from_mat4(bind.as_dmat4()))
        .collect();
    let mesh = world.get::<Mesh3d>(entity).unwrap();
    let mesh = world.resource::<Assets<Mesh>>().get(mesh).unwrap();
    let (
        VertexAttributeValues::Float32x3(positions),
        VertexAttributeValues::Uint16x4(joints),
        VertexAttributeValues::Float32x4(weights),
    ) = (
        mesh.attribute(Mesh::ATTRIBUTE_POSITION).unwrap(),
        mesh.attribute(Mesh::ATTRIBUTE_JOINT_INDEX).unwrap(),
        mesh.attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT).unwrap(),
    )
    else {
        panic!("formats");
    };
    let skinned = positions.iter().zip(joints).zip(weights);
    skinned
        .map(|((position, joints), weights)| {
            let rest = DVec3::from_array(position.map(f64::from));
            let images = joints.iter().zip(weights);
            // The weights add up to 1 in f32 only, which matters far from the origin.
            let sum: f64 = weights.iter().map(|weight| f64::from(*weight)).sum();
            let position: DVec3 = images
                .map(|(joint, weight)| {
                    palette[usize::from(*joint)].transform_point3(rest) * f64::from(*weight)
                })
                .sum();
            position / sum
        })
        .collect()
}

/// The triangles of a skinned mesh as posed now.
pub(crate) fn triangles(app: &App, entity: Entity) -> Vec<Corners> {
    let positions = positions(app, entity);
    let mesh = app.world().get::<Mesh3d>(entity).unwrap();
    let mesh = app.world().resource::<Assets<Mesh>>().get(mesh).unwrap();
    let indices: Vec<usize> = mesh.indices().unwrap().iter().collect();
    let corners = indices.as_chunks::<3>().0;
    corners.iter().map(|c| c.map(|i| positions[i])).collect()
}
