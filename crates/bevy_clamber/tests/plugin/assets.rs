//! Mesh assets that are loaded late, change, are removed, or are broken.

use std::sync::Arc;

use bevy_app::App;
use bevy_asset::{Assets, Handle, RenderAssetUsages};
use bevy_clamber::clamber_surface::mesh::{ColliderMesh, MeshError};
use bevy_clamber::prelude::*;
use bevy_clamber::{ColliderError, ColliderNeeds};
use bevy_ecs::prelude::*;
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{
    Indices, Mesh, Mesh3d, MeshCompressionArgs, PrimitiveTopology, VertexAttributeValues,
};
use bevy_transform::components::Transform;

use super::common::{Limb, add_bindposes, add_mesh, app, limb_mesh, spawn_limb, wait};

fn collider(app: &mut App, limb: &Limb) {
    app.world_mut()
        .entity_mut(limb.mesh)
        .insert(SkinnedCollider::default());
}

/// A limb with a collider, and its assets.
fn limb(app: &mut App) -> (Limb, Handle<Mesh>, Handle<SkinnedMeshInverseBindposes>) {
    let mesh = add_mesh(app, limb_mesh());
    let bindposes = add_bindposes(app);
    let limb = spawn_limb(app, mesh.clone(), bindposes.clone(), Transform::IDENTITY);
    collider(app, &limb);
    wait(app, limb.mesh);
    (limb, mesh, bindposes)
}

fn mesh_of(app: &App, entity: Entity) -> Arc<ColliderMesh> {
    let surface = app.world().get::<PosedSurface>(entity).unwrap();
    Arc::clone(surface.mesh())
}

fn status(app: &App, entity: Entity) -> ColliderStatus {
    app.world().get::<ColliderStatus>(entity).unwrap().clone()
}

fn frames(app: &mut App, frames: usize) {
    for _ in 0..frames {
        app.update();
    }
}

/// Inverse bind poses, each a translation along Y.
fn bindposes_at(lifts: impl IntoIterator<Item = f32>) -> SkinnedMeshInverseBindposes {
    let poses = lifts
        .into_iter()
        .map(|y| Transform::from_xyz(0.0, y, 0.0).to_matrix());
    SkinnedMeshInverseBindposes::from(poses.collect::<Vec<_>>())
}

/// The limb's vertices, without indices, with another topology.
fn listed_as(topology: PrimitiveTopology) -> Mesh {
    let (from, mut mesh) = (
        limb_mesh(),
        Mesh::new(topology, RenderAssetUsages::default()),
    );
    for attribute in [
        Mesh::ATTRIBUTE_POSITION,
        Mesh::ATTRIBUTE_JOINT_INDEX,
        Mesh::ATTRIBUTE_JOINT_WEIGHT,
    ] {
        mesh.insert_attribute(attribute, from.attribute(attribute).unwrap().clone());
    }
    mesh
}

/// The limb's mesh, half as high.
fn short() -> Mesh {
    let mut mesh = limb_mesh();
    let Some(VertexAttributeValues::Float32x3(positions)) =
        mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION)
    else {
        panic!("positions");
    };
    for p in positions {
        p[1] *= 0.5;
    }
    mesh
}

fn height(app: &App, entity: Entity) -> f32 {
    let mesh = mesh_of(app, entity);
    mesh.positions().iter().map(|p| p.y).fold(0.0, f32::max)
}

#[test]
fn a_collider_waits_for_assets_that_are_loaded_later() {
    for mesh_first in [true, false] {
        let mut app = app(64.0);
        let mesh = app.world().resource::<Assets<Mesh>>().reserve_handle();
        let bindposes = app
            .world()
            .resource::<Assets<SkinnedMeshInverseBindposes>>()
            .reserve_handle();
        let limb = spawn_limb(
            &mut app,
            mesh.clone(),
            bindposes.clone(),
            Transform::IDENTITY,
        );
        collider(&mut app, &limb);
        frames(&mut app, 3);
        assert_eq!(
            status(&app, limb.mesh),
            ColliderStatus::Waiting(ColliderNeeds::MeshAsset)
        );
        let add_mesh = |app: &mut App| {
            let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
            meshes.insert(&mesh, limb_mesh()).unwrap();
        };
        let add_poses = |app: &mut App| {
            app.world_mut()
                .resource_mut::<Assets<SkinnedMeshInverseBindposes>>()
                .insert(&bindposes, bindposes_at([0.0, -1.0]))
                .unwrap();
        };
        if mesh_first {
            add_mesh(&mut app);
        } else {
            add_poses(&mut app);
        }
        frames(&mut app, 5);
        assert!(app.world().get::<PosedSurface>(limb.mesh).is_none());
        if mesh_first {
            add_poses(&mut app);
        } else {
            add_mesh(&mut app);
        }
        wait(&mut app, limb.mesh);
        assert!(app.world().get::<PosedSurface>(limb.mesh).is_some());
    }
}

#[test]
fn a_changed_mesh_is_rebuilt_once_and_shared() {
    let mut app = app(64.0);
    let (first, mesh, bindposes) = limb(&mut app);
    let second = spawn_limb(
        &mut app,
        mesh.clone(),
        bindposes,
        Transform::from_xyz(3.0, 0.0, 0.0),
    );
    collider(&mut app, &second);
    wait(&mut app, second.mesh);
    let old = mesh_of(&app, first.mesh);
    assert!(Arc::ptr_eq(&old, &mesh_of(&app, second.mesh)));
    for replaced in [true, false] {
        let before = mesh_of(&app, first.mesh);
        let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
        if replaced {
            meshes.insert(&mesh, short()).unwrap();
        } else {
            *meshes.get_mut(&mesh).unwrap() = limb_mesh();
        }
        let mut seen = vec![before];
        for _ in 0..200 {
            app.update();
            std::thread::yield_now();
            for limb in [&first, &second] {
                // The old mesh stays in use until the new one is built.
                let now = mesh_of(&app, limb.mesh);
                if !seen.iter().any(|mesh| Arc::ptr_eq(mesh, &now)) {
                    seen.push(now);
                }
            }
        }
        assert_eq!(seen.len(), 2, "built once");
        let expected = if replaced { 1.0 } else { 2.0 };
        for limb in [&first, &second] {
            assert_eq!(height(&app, limb.mesh), expected);
            assert!(Arc::ptr_eq(&seen[1], &mesh_of(&app, limb.mesh)));
        }
    }
}

#[test]
fn a_collider_is_freed_with_its_mesh_asset() {
    let mut app = app(64.0);
    let (limb, mesh, _) = limb(&mut app);
    let weak = Arc::downgrade(&mesh_of(&app, limb.mesh));
    app.world_mut().resource_mut::<Assets<Mesh>>().remove(&mesh);
    frames(&mut app, 3);
    assert!(app.world().get::<PosedSurface>(limb.mesh).is_none());
    let waits = ColliderStatus::Waiting(ColliderNeeds::MeshAsset);
    assert_eq!(status(&app, limb.mesh), waits);
    assert!(weak.upgrade().is_none());
    let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
    meshes.insert(&mesh, short()).unwrap();
    wait(&mut app, limb.mesh);
    assert_eq!(height(&app, limb.mesh), 1.0);
    // The asset goes with its last handle.
    let weak = Arc::downgrade(&mesh_of(&app, limb.mesh));
    app.world_mut().entity_mut(limb.mesh).despawn();
    drop(mesh);
    frames(&mut app, 3);
    assert!(weak.upgrade().is_none());
}

#[test]
fn changed_inverse_bind_poses_pose_the_surface() {
    let mut app = app(64.0);
    let (limb, _, bindposes) = limb(&mut app);
    let lifted = |app: &App| {
        let surface = app.world().get::<PosedSurface>(limb.mesh).unwrap();
        let top = surface.mesh().positions().len() as u32 - 1;
        let top = bevy_clamber::clamber_surface::mesh::VertexId(top);
        surface.in_model().position(top).unwrap().y - surface.mesh().positions()[top.index()].y
    };
    assert_eq!(lifted(&app), 0.0);
    // The asset is modified, then removed and inserted anew.
    for (lift, remove) in [(0.25, false), (0.5, true)] {
        let mut assets = app
            .world_mut()
            .resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
        if remove {
            assets.remove(&bindposes);
            frames(&mut app, 2);
            assert!(app.world().get::<PosedSurface>(limb.mesh).is_none());
        }
        let mut assets = app
            .world_mut()
            .resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
        assets
            .insert(&bindposes, bindposes_at([lift, lift - 1.0]))
            .unwrap();
        frames(&mut app, 5);
        assert_eq!(lifted(&app), lift);
    }
}

#[test]
fn changed_components_rebuild_the_surface() {
    let mut app = app(64.0);
    let (limb, _, _) = limb(&mut app);
    let other = add_mesh(&mut app, short());
    app.world_mut().entity_mut(limb.mesh).insert(Mesh3d(other));
    wait(&mut app, limb.mesh);
    frames(&mut app, 2);
    assert_eq!(height(&app, limb.mesh), 1.0);
    // Without one of the components there is no surface.
    let skin = app.world_mut().entity_mut(limb.mesh).take::<SkinnedMesh>();
    frames(&mut app, 2);
    assert!(app.world().get::<PosedSurface>(limb.mesh).is_none());
    let waits = ColliderStatus::Waiting(ColliderNeeds::Skin);
    assert_eq!(status(&app, limb.mesh), waits);
    // It is posed anew, if the app removes the surface.
    app.world_mut().entity_mut(limb.mesh).insert(skin.unwrap());
    wait(&mut app, limb.mesh);
    app.world_mut()
        .entity_mut(limb.mesh)
        .remove::<PosedSurface>();
    app.update();
    wait(&mut app, limb.mesh);
    assert!(app.world().get::<PosedSurface>(limb.mesh).is_some());
    let tag = SurfaceTag::new(SurfaceKind::Fur).with_user(1);
    app.world_mut()
        .entity_mut(limb.mesh)
        .insert(ColliderTag(tag));
    frames(&mut app, 1);
    wait(&mut app, limb.mesh);
    assert!(mesh_of(&app, limb.mesh).tags().iter().all(|t| *t == tag));
    // The tag stays when the collider is removed and inserted again.
    let mut entity = app.world_mut().entity_mut(limb.mesh);
    entity.remove::<SkinnedCollider>();
    assert!(app.world().get::<PosedSurface>(limb.mesh).is_none());
    assert!(app.world().get::<ColliderStatus>(limb.mesh).is_none());
    collider(&mut app, &limb);
    wait(&mut app, limb.mesh);
    assert!(mesh_of(&app, limb.mesh).tags().iter().all(|t| *t == tag));
}

/// The result of building a mesh: the height of the collider, or the error.
fn outcome(mesh: Mesh) -> Result<f32, ColliderError> {
    let mut app = app(64.0);
    let mesh = add_mesh(&mut app, mesh);
    let bindposes = add_bindposes(&mut app);
    let limb = spawn_limb(&mut app, mesh, bindposes, Transform::IDENTITY);
    collider(&mut app, &limb);
    wait(&mut app, limb.mesh);
    match status(&app, limb.mesh) {
        ColliderStatus::Ready => Ok(height(&app, limb.mesh)),
        ColliderStatus::Failed(error) => {
            assert!(app.world().get::<PosedSurface>(limb.mesh).is_none());
            Err(error.error().unwrap().clone())
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn compressed_meshes_and_triangle_strips_are_read() {
    let compressed = limb_mesh().compressed_mesh(&MeshCompressionArgs::regular());
    let height = outcome(compressed.unwrap()).unwrap();
    assert!((height - 2.0).abs() < 1e-4, "{height}");
    let strip = || listed_as(PrimitiveTopology::TriangleStrip);
    assert_eq!(outcome(strip()), Ok(2.0));
    // Two strips, separated by the index that starts a new one.
    let ends = [0, 1, 4, 5];
    let wide = ends.iter().chain(&[u32::MAX]).chain(&[76, 77, 80, 81]);
    let wide: Vec<u32> = wide.copied().collect();
    let narrow = wide.iter().map(|i| *i as u16).collect();
    assert_eq!(
        outcome(strip().with_inserted_indices(Indices::U32(wide))),
        Ok(2.0)
    );
    assert_eq!(
        outcome(strip().with_inserted_indices(Indices::U16(narrow))),
        Ok(2.0)
    );
}

#[test]
fn strips_wind_as_lists_do() {
    let mut app = app(64.0);
    let mut strip = listed_as(PrimitiveTopology::TriangleStrip);
    // One wall of the tube, upward.
    let wall = (0..21).flat_map(|ring| [4 * ring, 4 * ring + 1]);
    strip.insert_indices(Indices::U32(wall.collect()));
    let mesh = add_mesh(&mut app, strip);
    let bindposes = add_bindposes(&mut app);
    let limb = spawn_limb(&mut app, mesh, bindposes, Transform::IDENTITY);
    collider(&mut app, &limb);
    wait(&mut app, limb.mesh);
    let mesh = mesh_of(&app, limb.mesh);
    assert_eq!(mesh.triangles().len(), 40);
    for corners in mesh.triangles() {
        let [a, b, c] = corners.map(|v| mesh.positions()[v.index()]);
        let normal = (b - a).cross(c - a);
        assert!(normal.x > 0.0, "{corners:?} {normal}");
    }
}

#[test]
fn each_broken_mesh_gives_its_own_error() {
    type Break = fn(&mut Mesh);
    type Wanted = fn(&ColliderError) -> bool;
    fn values(mesh: &mut Mesh, change: impl Fn(&mut Vec<[f32; 4]>)) {
        let weights = mesh.attribute_mut(Mesh::ATTRIBUTE_JOINT_WEIGHT).unwrap();
        let VertexAttributeValues::Float32x4(weights) = weights else {
            panic!("weights");
        };
        change(weights);
    }
    let cases: [(Break, Wanted); 9] = [
        (
            |mesh| mesh.insert_indices(Indices::U32(vec![0, 1, 900])),
            |e| matches!(e, ColliderError::Mesh(MeshError::VertexOutOfRange { .. })),
        ),
        (
            |mesh| mesh.insert_indices(Indices::U32(vec![0, 1])),
            |e| matches!(e, ColliderError::Mesh(MeshError::NoTriangles { .. })),
        ),
        (
            |mesh| mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, vec![[f32::NAN; 3]; 84]),
            |e| matches!(e, ColliderError::Mesh(MeshError::Position { .. })),
        ),
        (
            |mesh| values(mesh, |weights| weights[3] = [0.0; 4]),
            |e| matches!(e, ColliderError::Mesh(MeshError::Weights { vertex: 3, .. })),
        ),
        (
            |mesh| values(mesh, |weights| weights[3][0] = f32::NAN),
            |e| matches!(e, ColliderError::Mesh(MeshError::Weights { vertex: 3, .. })),
        ),
        (
            |mesh| {
                let far = VertexAttributeValues::Uint16x4(vec![[65535, 1, 2, 3]; 84]);
                mesh.insert_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, far);
            },
            |e| matches!(e, ColliderError::Mesh(MeshError::JointOutOfRange { .. })),
        ),
        (
            |mesh| values(mesh, |weights| weights.truncate(7)),
            |e| matches!(e, ColliderError::Length { found: 7, .. }),
        ),
        (
            |mesh| {
                mesh.remove_attribute(Mesh::ATTRIBUTE_JOINT_INDEX);
            },
            |e| *e == ColliderError::Missing("joint indices"),
        ),
        (
            |mesh| *mesh = mesh.take_gpu_data().map(|_| mesh.clone()).unwrap(),
            |e| *e == ColliderError::MovedToRenderWorld,
        ),
    ];
    for (index, (broken, expected)) in cases.into_iter().enumerate() {
        let mut mesh = limb_mesh();
        broken(&mut mesh);
        let error = outcome(mesh).unwrap_err();
        assert!(expected(&error), "case {index}: {error:?}");
    }
    for topology in [
        PrimitiveTopology::LineList,
        PrimitiveTopology::LineStrip,
        PrimitiveTopology::PointList,
    ] {
        let lines = outcome(listed_as(topology));
        assert_eq!(lines, Err(ColliderError::Topology(topology)));
    }
}

#[test]
fn a_repaired_mesh_becomes_a_surface() {
    let mut app = app(64.0);
    let mut broken = limb_mesh();
    broken.remove_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT);
    let mesh = add_mesh(&mut app, broken);
    let bindposes = add_bindposes(&mut app);
    let limb = spawn_limb(&mut app, mesh.clone(), bindposes, Transform::IDENTITY);
    collider(&mut app, &limb);
    wait(&mut app, limb.mesh);
    assert!(matches!(status(&app, limb.mesh), ColliderStatus::Failed(_)));
    let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&mesh).unwrap() = limb_mesh();
    frames(&mut app, 2);
    wait(&mut app, limb.mesh);
    assert_eq!(height(&app, limb.mesh), 2.0);
}

#[test]
fn more_inverse_bind_poses_than_joints_are_fine_and_fewer_are_an_error() {
    for (count, fine) in [(5, true), (1, false), (0, false)] {
        let mut app = app(64.0);
        let mesh = add_mesh(&mut app, limb_mesh());
        let bindposes = app
            .world_mut()
            .resource_mut::<Assets<SkinnedMeshInverseBindposes>>()
            .add(bindposes_at(vec![0.0; count]));
        let limb = spawn_limb(&mut app, mesh, bindposes, Transform::IDENTITY);
        collider(&mut app, &limb);
        wait(&mut app, limb.mesh);
        match status(&app, limb.mesh) {
            ColliderStatus::Ready => assert!(fine, "{count}"),
            ColliderStatus::Failed(error) => {
                let expected = ColliderError::InverseBindposes {
                    joints: 2,
                    inverse_bindposes: count,
                };
                assert!(!fine && error.error() == Some(&expected), "{count} {error}");
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn an_entity_may_be_despawned_as_its_surface_is_inserted() {
    fn rival(
        added: On<Add<PosedSurface>>,
        all: Query<Entity, With<SkinnedCollider>>,
        mut commands: Commands,
    ) {
        for entity in all.iter().filter(|entity| *entity != added.entity) {
            commands.entity(entity).try_despawn();
        }
    }
    let mut app = app(64.0);
    app.add_observer(rival);
    let mesh = add_mesh(&mut app, limb_mesh());
    let bindposes = add_bindposes(&mut app);
    let limbs = [0.0, 3.0].map(|x| {
        let place = Transform::from_xyz(x, 0.0, 0.0);
        let limb = spawn_limb(&mut app, mesh.clone(), bindposes.clone(), place);
        collider(&mut app, &limb);
        limb.mesh
    });
    for _ in 0..200 {
        app.update();
        std::thread::yield_now();
    }
    let left = limbs.map(|entity| app.world().get::<PosedSurface>(entity).is_some());
    assert_eq!(left.iter().filter(|left| **left).count(), 1, "{left:?}");
}
