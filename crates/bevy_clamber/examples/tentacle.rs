//! A climber rides a tentacle that waves, without a window and without any asset file.
//!
//! `cargo run -p bevy_clamber --example tentacle` prints what happens, and checks that the climber was carried.

use bevy_app::prelude::*;
use bevy_asset::{AssetPlugin, Assets, RenderAssetUsages};
use bevy_clamber::events::{ClimberGrabbed, ClimberShakenOff};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Indices, Mesh, Mesh3d, MeshPlugin, PrimitiveTopology, VertexAttributeValues};
use bevy_time::{Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

/// Joints, 2 m apart, and corners of each ring of the mesh.
const JOINTS: u16 = 10;
const CORNERS: u16 = 12;

#[derive(Component)]
struct Waving(f64);

fn main() {
    let bevy = (
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        AssetPlugin::default(),
        MeshPlugin,
    );
    let mut app = App::new();
    app.add_plugins((bevy, ClamberPlugins::default(), ClimberPlugin::default()))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1)) // each update is one tick
        .add_systems(Startup, spawn)
        .add_systems(FixedUpdate, wave)
        .add_observer(|_: On<ClimberGrabbed>| println!("it holds on"))
        .add_observer(|lost: On<ClimberShakenOff>| println!("shaken off at {} m/s²", lost.shake));
    app.finish();
    app.cleanup();
    let mut climbers = app.world_mut().query::<&ClimberState>();
    let (mut held, mut low, mut high) = (0, f64::MAX, f64::MIN);
    for tick in 0..1500 {
        app.update();
        for state in climbers
            .iter(app.world())
            .filter(|state| state.support.is_some())
        {
            held += 1;
            (low, high) = (low.min(state.position.y), high.max(state.position.y));
            if tick % 100 == 0 {
                println!(
                    "{:?} at {:.2}, stamina {:.2}",
                    state.mode, state.position, state.stamina
                );
            }
        }
    }
    println!(
        "on the tentacle for {held} ticks, carried up and down by {:.2} m",
        high - low
    );
    assert!(
        held > 500 && high - low > 0.5,
        "the climber was not carried"
    );
}

/// A tentacle along +X that tapers off, and a climber above it.
fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut bindposes: ResMut<Assets<SkinnedMeshInverseBindposes>>,
) {
    let (mut positions, mut joints, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for ring in 0..JOINTS {
        for corner in 0..CORNERS {
            let angle = core::f32::consts::TAU * f32::from(corner) / f32::from(CORNERS);
            let radius = 1.5 - 0.1 * f32::from(ring);
            let (sin, cos) = libm::sincosf(angle);
            positions.push([2.0 * f32::from(ring), radius * cos, radius * sin]);
            joints.push([ring, 0, 0, 0]);
            let [a, b] = [corner, (corner + 1) % CORNERS].map(|corner| ring * CORNERS + corner);
            if ring + 1 < JOINTS {
                indices.extend([a, b, a + CORNERS, a + CORNERS, b, b + CORNERS]);
            }
        }
    }
    let weights = vec![[1.0, 0.0, 0.0, 0.0]; positions.len()];
    let mesh = Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_JOINT_INDEX,
        VertexAttributeValues::Uint16x4(joints),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights)
    .with_inserted_indices(Indices::U16(indices));
    let root = commands.spawn(Transform::from_xyz(0.0, 5.0, 0.0)).id();
    let (mut parent, mut all, mut inverse) = (root, Vec::new(), Vec::new());
    for joint in 0..JOINTS {
        let place = Vec3::X * if joint == 0 { 0.0 } else { 2.0 };
        let waving = Waving(f64::from(joint));
        parent = commands
            .spawn((Transform::from_translation(place), waving, ChildOf(parent)))
            .id();
        all.push(parent);
        inverse.push(Transform::from_xyz(-2.0 * f32::from(joint), 0.0, 0.0).to_matrix());
    }
    let inverse_bindposes = bindposes.add(inverse);
    let skin = SkinnedMesh {
        inverse_bindposes,
        joints: all,
    };
    let fur = ColliderTag(SurfaceTag::new(SurfaceKind::Fur));
    commands.spawn((
        Mesh3d(meshes.add(mesh)),
        skin,
        SkinnedCollider::each_tick(),
        fur,
        ChildOf(root),
    ));
    let input = ClimberInput {
        grip: true,
        ..ClimberInput::default()
    };
    commands.spawn((
        Climber::colossus_climber(),
        input,
        Transform::from_xyz(8.0, 9.0, 0.0),
    ));
}

fn wave(time: Res<Time>, mut joints: Query<(&Waving, &mut Transform)>) {
    for (waving, mut joint) in &mut joints {
        let angle = 0.06 * libm::sin(time.elapsed_secs_f64() - 0.5 * waving.0);
        let half = 0.5 * angle;
        joint.rotation = Quat::from_xyzw(0.0, 0.0, libm::sin(half) as f32, libm::cos(half) as f32);
    }
}
