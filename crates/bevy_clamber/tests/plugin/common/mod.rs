//! A headless app, and a limb of two joints that bends.

#![allow(dead_code, reason = "no program uses all of it")]

pub(crate) mod posed;

use std::time::Duration;

use bevy_app::{App, Plugins, TaskPoolPlugin};
use bevy_asset::{AssetApp, AssetPlugin, Assets, Handle, RenderAssetUsages};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Indices, Mesh, Mesh3d, PrimitiveTopology, VertexAttributeValues};
use bevy_time::{Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use bevy_transform::components::{GlobalTransform, Transform};

/// Radians a second that the limb's upper joint turns.
pub(crate) const SPIN: f64 = 2.0;

/// An app without a window, each of whose updates is a frame of `1 / rate` seconds.
pub(crate) fn app(rate: f64) -> App {
    app_with(rate, ClamberPlugins::default())
}

pub(crate) fn app_with<Marker>(rate: f64, plugins: impl Plugins<Marker>) -> App {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        AssetPlugin::default(),
        plugins,
    ))
    .init_asset::<Mesh>()
    .init_asset::<SkinnedMeshInverseBindposes>()
    .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(
        1.0 / rate,
    )));
    app.finish();
    app.cleanup();
    app
}

/// Rotation of the upper joint at a time.
pub(crate) fn bend(seconds: f64) -> Quat {
    let half = 0.5 * SPIN * seconds;
    Quat::from_xyzw(0.0, 0.0, libm::sin(half) as f32, libm::cos(half) as f32)
}

/// Marks the joints that the animation turns.
#[derive(Component)]
pub(crate) struct Bending;

/// Turns the marked joints by the time of the schedule that it runs in.
pub(crate) fn animate(time: Res<Time>, mut joints: Query<&mut Transform, With<Bending>>) {
    for mut joint in &mut joints {
        joint.rotation = bend(time.elapsed().as_secs_f64());
    }
}

/// A rotation that lays a limb along +X.
pub(crate) const LYING: Quat = Quat::from_xyzw(
    0.0,
    0.0,
    -core::f32::consts::FRAC_1_SQRT_2,
    core::f32::consts::FRAC_1_SQRT_2,
);

/// Entities of a limb.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limb {
    pub(crate) root: Entity,
    pub(crate) joints: [Entity; 2],
    pub(crate) mesh: Entity,
}

/// A square tube along Y, 2 m high and 0.4 m wide. The lower half follows a joint at its foot, the upper half one in
/// the middle, with blended weights around it.
pub(crate) fn limb_mesh() -> Mesh {
    let rings = 21;
    let (mut positions, mut joints, mut weights) = (Vec::new(), Vec::new(), Vec::new());
    let mut indices = Vec::new();
    for ring in 0..rings {
        let y = 0.1 * ring as f32;
        for (x, z) in [(0.2, 0.2), (0.2, -0.2), (-0.2, -0.2), (-0.2, 0.2)] {
            positions.push([x, y, z]);
            let upper = ((y - 0.7) / 0.6).clamp(0.0, 1.0);
            joints.push([0, 1, 0, 0]);
            weights.push([1.0 - upper, upper, 0.0, 0.0]);
        }
        for side in 0..4 {
            if ring + 1 < rings {
                let [a, b] = [side, (side + 1) % 4].map(|side| 4 * ring + side);
                indices.extend([a, b, a + 4, a + 4, b, b + 4]);
            }
        }
    }
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
    .with_inserted_indices(Indices::U32(indices))
}

pub(crate) fn add_mesh(app: &mut App, mesh: Mesh) -> Handle<Mesh> {
    app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh)
}

pub(crate) fn add_bindposes(app: &mut App) -> Handle<SkinnedMeshInverseBindposes> {
    let foot = Transform::IDENTITY;
    let poses = vec![
        foot.to_matrix(),
        Transform::from_translation(Vec3::NEG_Y).to_matrix(),
    ];
    let mut assets = app
        .world_mut()
        .resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
    assets.add(SkinnedMeshInverseBindposes::from(poses))
}

/// Spawns a limb at a place, without a collider.
pub(crate) fn spawn_limb(
    app: &mut App,
    mesh: Handle<Mesh>,
    inverse_bindposes: Handle<SkinnedMeshInverseBindposes>,
    place: Transform,
) -> Limb {
    let world = app.world_mut();
    let root = world.spawn(place).id();
    let lower = world.spawn((Transform::IDENTITY, ChildOf(root))).id();
    let middle = Transform::from_translation(Vec3::Y);
    let upper = world.spawn((middle, Bending, ChildOf(lower))).id();
    let joints = [lower, upper];
    let skin = SkinnedMesh {
        inverse_bindposes,
        joints: joints.to_vec(),
    };
    let mesh = world
        .spawn((Mesh3d(mesh), skin, Transform::IDENTITY, ChildOf(root)))
        .id();
    Limb { root, joints, mesh }
}

/// Spawns a limb with a collider, and waits for its surface.
pub(crate) fn limb(app: &mut App, place: Transform, collider: SkinnedCollider) -> Limb {
    let mesh = add_mesh(app, limb_mesh());
    let inverse_bindposes = add_bindposes(app);
    let limb = spawn_limb(app, mesh, inverse_bindposes, place);
    app.world_mut().entity_mut(limb.mesh).insert(collider);
    wait(app, limb.mesh);
    limb
}

/// Updates the app until a collider is ready or has failed.
pub(crate) fn wait(app: &mut App, entity: Entity) {
    wait_with(app, entity, |_| ());
}

/// [`wait`], with a function that is called after each update. Messages live for two updates only, and the number of
/// updates depends on how busy the machine is.
pub(crate) fn wait_with(app: &mut App, entity: Entity, mut look: impl FnMut(&App)) {
    for _ in 0..10_000 {
        app.update();
        look(app);
        let status = app.world().get::<ColliderStatus>(entity);
        if matches!(
            status,
            Some(ColliderStatus::Ready | ColliderStatus::Failed(_))
        ) {
            // The commands of this update have inserted the surface.
            return;
        }
        std::thread::yield_now();
    }
    panic!("the collider of {entity} is neither ready nor failed");
}

/// Where a vertex of the limb's mesh is drawn, as Bevy's shader computes it, in f64.
pub(crate) fn drawn(app: &App, limb: &Limb, vertex: usize) -> glam::DVec3 {
    let world = app.world();
    let mesh = world.get::<Mesh3d>(limb.mesh).unwrap();
    let mesh = world.resource::<Assets<Mesh>>().get(mesh).unwrap();
    let floats = |name| mesh.attribute(name).unwrap();
    let VertexAttributeValues::Float32x3(positions) = floats(Mesh::ATTRIBUTE_POSITION) else {
        panic!("positions");
    };
    let VertexAttributeValues::Float32x4(weights) = floats(Mesh::ATTRIBUTE_JOINT_WEIGHT) else {
        panic!("weights");
    };
    let rest = Vec3::from_array(positions[vertex]).as_dvec3();
    let mut position = glam::DVec3::ZERO;
    for (joint, weight) in [0, 1].into_iter().zip(weights[vertex]) {
        let world_from_joint = world.get::<GlobalTransform>(limb.joints[joint]).unwrap();
        let matrix = world_from_joint.to_matrix().as_dmat4();
        let local = rest - glam::DVec3::Y * joint as f64;
        position += f64::from(weight) * matrix.transform_point3(local);
    }
    position
}
