//! A climber rides a tentacle that waves, without a window and without any asset file.
//!
//! `cargo run -p bevy_clamber --example tentacle` prints what happens, and checks that the climber was carried.

use bevy_app::prelude::*;
use bevy_asset::{AssetPlugin, Assets};
use bevy_clamber::events::{ClimberGrabbed, ClimberShakenOff};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Mesh, Mesh3d, MeshBuilder, MeshPlugin, Meshable, VertexAttributeValues};
use bevy_shape::Capsule3d;
use bevy_time::{Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

/// Joints, 2 m apart.
const JOINTS: u16 = 10;

#[derive(Component)]
struct Waving(f64);

fn main() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin))
        .add_plugins((AssetPlugin::default(), MeshPlugin))
        .add_plugins((ClamberPlugins::default(), ClimberPlugin::default()))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1)) // each update is one tick
        .add_systems(Startup, spawn)
        .add_systems(FixedUpdate, wave)
        .add_observer(|_: On<ClimberGrabbed>| println!("it holds on"))
        .add_observer(|lost: On<ClimberShakenOff>| println!("shaken off at {} m/s²", lost.shake));
    app.finish();
    app.cleanup();
    let mut climbers = app.world_mut().query::<&ClimberState>();
    let mut heights = Vec::new();
    for _ in 0..1500 {
        app.update();
        let held = climbers
            .iter(app.world())
            .filter(|state| state.support.is_some());
        heights.extend(held.map(|state| state.position.y));
    }
    let (low, high) = heights
        .iter()
        .fold((f64::MAX, f64::MIN), |(low, high), height| {
            (low.min(*height), high.max(*height))
        });
    println!(
        "on the tentacle for {} ticks, between {low:.2} and {high:.2} m",
        heights.len()
    );
    assert!(
        heights.len() > 500 && high - low > 0.5,
        "the climber was not carried"
    );
}

/// A tentacle along +X, and a climber above it.
fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut bindposes: ResMut<Assets<SkinnedMeshInverseBindposes>>,
) {
    let along_x = Quat::from_rotation_arc(Vec3::Y, Vec3::X);
    let mesh = Capsule3d::new(1.3, 18.0).mesh().rings(36).build();
    let mut mesh = mesh.rotated_by(along_x).translated_by(Vec3::X * 9.0);
    let positions = mesh
        .attribute(Mesh::ATTRIBUTE_POSITION)
        .and_then(|p| p.as_float3());
    let joint = |x: f32| (0.5 * x).round().clamp(0.0, f32::from(JOINTS - 1)) as u16;
    let joints: Vec<_> = positions
        .unwrap_or_default()
        .iter()
        .map(|p| [joint(p[0]), 0, 0, 0])
        .collect();
    mesh.insert_attribute(
        Mesh::ATTRIBUTE_JOINT_WEIGHT,
        vec![[1.0, 0.0, 0.0, 0.0]; joints.len()],
    );
    mesh.insert_attribute(
        Mesh::ATTRIBUTE_JOINT_INDEX,
        VertexAttributeValues::Uint16x4(joints),
    );

    let (mut parent, mut joints) = (
        commands.spawn(Transform::from_xyz(0.0, 5.0, 0.0)).id(),
        Vec::new(),
    );
    for joint in 0..JOINTS {
        let place = Transform::from_xyz(if joint == 0 { 0.0 } else { 2.0 }, 0.0, 0.0);
        parent = commands
            .spawn((place, Waving(joint.into()), ChildOf(parent)))
            .id();
        joints.push(parent);
    }
    let inverse =
        (0..JOINTS).map(|joint| Transform::from_xyz(-2.0 * f32::from(joint), 0.0, 0.0).to_matrix());
    let inverse_bindposes = bindposes.add(inverse.collect::<Vec<_>>());
    let skin = SkinnedMesh {
        inverse_bindposes,
        joints,
    };
    let fur = ColliderTag(SurfaceTag::new(SurfaceKind::Fur));
    commands.spawn((
        Mesh3d(meshes.add(mesh)),
        skin,
        SkinnedCollider::each_tick(),
        fur,
    ));
    let holds_on = ClimberInput {
        grip: true,
        ..ClimberInput::default()
    };
    commands.spawn((
        Climber::colossus_climber(),
        holds_on,
        Transform::from_xyz(8.0, 9.0, 0.0),
    ));
}

fn wave(time: Res<Time>, mut joints: Query<(&Waving, &mut Transform)>) {
    for (waving, mut joint) in &mut joints {
        let half = 0.03 * libm::sin(time.elapsed_secs_f64() - 0.5 * waving.0);
        joint.rotation = Quat::from_xyzw(0.0, 0.0, libm::sin(half) as f32, libm::cos(half) as f32);
    }
}
