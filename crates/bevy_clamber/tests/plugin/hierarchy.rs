//! Joints and the entities above them: moved, reparented, missing, and with invalid transforms.

use std::time::Instant;

use bevy_app::{App, PreUpdate};
use bevy_asset::{Assets, RenderAssetUsages};
use bevy_clamber::ColliderError;
use bevy_clamber::clamber_surface::mesh::VertexId;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{Dir3, Quat, Vec3};
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Indices, Mesh, Mesh3d, PrimitiveTopology, VertexAttributeValues};
use bevy_shape::Ray3d;
use bevy_transform::components::Transform;

use super::common::posed;
use super::common::{Limb, add_bindposes, add_mesh, app, bend, limb, limb_mesh, spawn_limb, wait};

const EACH_TICK: SkinnedCollider = SkinnedCollider {
    joints: PoseTiming::EachTick,
    root: PoseTiming::EachTick,
    ..SkinnedCollider::each_frame()
};
const BOTH: [SkinnedCollider; 2] = [
    EACH_TICK,
    SkinnedCollider {
        joints: PoseTiming::EachFrame,
        root: PoseTiming::EachFrame,
        ..SkinnedCollider::each_frame()
    },
];

fn surface(app: &App, entity: Entity) -> &PosedSurface {
    app.world().get::<PosedSurface>(entity).unwrap()
}

fn transform(app: &mut App, entity: Entity) -> Mut<'_, Transform> {
    app.world_mut().get_mut::<Transform>(entity).unwrap()
}

fn frames(app: &mut App, frames: usize) {
    for _ in 0..frames {
        app.update();
    }
}

/// Every vertex in model space.
fn in_model(app: &App, entity: Entity) -> Vec<Vec3> {
    let surface = surface(app, entity);
    let vertices = 0..surface.mesh().positions().len() as u32;
    vertices
        .map(|v| surface.in_model().position(VertexId(v)).unwrap())
        .collect()
}

/// The largest distance of a vertex from where Bevy draws it. The limb's mesh is neither welded nor reordered.
fn worst(app: &App, entity: Entity) -> f64 {
    let posed = posed::positions(app, entity);
    let surface = surface(app, entity);
    assert_eq!(posed.len(), surface.mesh().positions().len());
    let found = in_model(app, entity);
    let world = |p: &Vec3| surface.world_from_model().transform_point_f32(*p);
    let apart = found
        .iter()
        .zip(&posed)
        .map(|(p, q)| (world(p) - *q).length());
    apart.fold(0.0, f64::max)
}

#[test]
fn far_from_the_origin_the_pose_has_the_same_bits() {
    for timing in BOTH {
        let at = |place: Vec3| {
            let mut app = app(64.0);
            let limb = limb(&mut app, Transform::from_translation(place), timing);
            transform(&mut app, limb.joints[1]).rotation = bend(0.7);
            frames(&mut app, 5);
            (in_model(&app, limb.mesh), worst(&app, limb.mesh))
        };
        let (here, error) = at(Vec3::ZERO);
        assert!(error < 1e-6, "{error}");
        let (there, error) = at(Vec3::new(1e5, -3e4, 7e4));
        assert!(error < 1e-6, "{error}");
        assert_eq!(here, there);
    }
}

/// A limb whose lower joint has no parent.
fn rootless(app: &mut App, timing: SkinnedCollider) -> Limb {
    let limb = limb(app, Transform::IDENTITY, timing);
    app.world_mut()
        .entity_mut(limb.joints[0])
        .remove::<ChildOf>();
    app.update();
    limb
}

#[test]
fn a_skeleton_without_a_parent_is_as_exact_far_away() {
    for timing in BOTH {
        let mut app = app(64.0);
        let limb = rootless(&mut app, timing);
        transform(&mut app, limb.joints[1]).rotation = bend(0.7);
        transform(&mut app, limb.joints[0]).rotation = bend(0.1);
        frames(&mut app, 5);
        let here = in_model(&app, limb.mesh);
        assert!(worst(&app, limb.mesh) < 1e-6);
        transform(&mut app, limb.joints[0]).translation = Vec3::new(1e5, -3e4, 7e4);
        frames(&mut app, 5);
        assert!(worst(&app, limb.mesh) < 1e-6, "{}", worst(&app, limb.mesh));
        assert_eq!(here, in_model(&app, limb.mesh));
        // A translation is motion.
        transform(&mut app, limb.joints[0]).translation.x += 0.5;
        let mut travelled = 0.0;
        for _ in 0..5 {
            app.update();
            let surface = surface(&app, limb.mesh);
            let now = surface.in_model().position(VertexId(3)).unwrap();
            let before = surface.in_model().previous_position(VertexId(3)).unwrap();
            travelled += (now - before).length();
        }
        assert!((travelled - 0.5).abs() < 1e-5, "{travelled}");
    }
}

#[test]
fn surfaces_with_any_scale_are_posed_as_they_are_drawn() {
    let turned = Quat::from_xyzw(0.5, -0.5, 0.5, 0.5);
    let places = [
        Transform::from_scale(Vec3::splat(40.0)),
        Transform::from_scale(Vec3::splat(-1.0)),
        Transform::from_scale(Vec3::new(1.0, -2.0, 1.0)).with_rotation(turned),
        Transform::from_scale(Vec3::new(0.01, 3.0, 1.0)).with_rotation(turned),
    ];
    for place in places {
        for timing in BOTH {
            let mut app = app(64.0);
            let limb = limb(&mut app, place, timing);
            let above = Transform::from_xyz(1.0, 2.0, 3.0)
                .with_rotation(bend(0.5))
                .with_scale(Vec3::new(2.0, 0.5, 1.0));
            let above = app.world_mut().spawn(above).id();
            app.world_mut().entity_mut(limb.root).insert(ChildOf(above));
            *transform(&mut app, limb.joints[1]) = Transform::from_xyz(0.0, 1.0, 0.0)
                .with_rotation(bend(0.6))
                .with_scale(Vec3::new(1.0, 0.7, -1.2));
            frames(&mut app, 5);
            let error = worst(&app, limb.mesh) / f64::from(place.scale.abs().max_element());
            assert!(error < 2e-6, "{place:?} {timing:?}: {error}");
            assert_eq!(surface(&app, limb.mesh).error(), None);
        }
    }
}

#[test]
fn an_invalid_transform_is_an_error_and_keeps_the_last_pose_until_it_is_repaired() {
    type Spoil = fn(&mut Transform);
    let spoils: [Spoil; 4] = [
        |t| t.scale = Vec3::ZERO,
        |t| t.translation.x = f32::NAN,
        |t| t.rotation = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0),
        |t| t.translation.y = f32::INFINITY,
    ];
    for timing in BOTH {
        for (index, spoil) in spoils.iter().enumerate() {
            for of_root in [true, false] {
                if !of_root && index == 0 {
                    // A joint may have a scale of zero: its skin is a point then.
                    continue;
                }
                let case = format!("{index} {of_root} {timing:?}");
                let mut app = app(64.0);
                let place = Transform::from_xyz(4.0, 0.0, 0.0);
                let limb = limb(&mut app, place, timing);
                transform(&mut app, limb.joints[1]).rotation = bend(0.7);
                frames(&mut app, 5);
                let posed = in_model(&app, limb.mesh);
                let whose = if of_root { limb.root } else { limb.joints[1] };
                let sound = *transform(&mut app, whose);
                spoil(&mut transform(&mut app, whose));
                for frame in 0..5 {
                    app.update();
                    let surface = surface(&app, limb.mesh);
                    // With frame timing, ticks see the transform one frame later.
                    let told = surface.error().is_some();
                    assert!(told || frame == 0, "{case} {frame}");
                    assert_eq!(surface.world_from_model().translation.x, 4.0, "{case}");
                    assert_eq!(in_model(&app, limb.mesh), posed, "{case} {frame}");
                }
                *transform(&mut app, whose) = sound;
                frames(&mut app, 3);
                assert_eq!(surface(&app, limb.mesh).error(), None, "{case}");
                transform(&mut app, limb.joints[1]).rotation = bend(0.2);
                frames(&mut app, 3);
                assert!(worst(&app, limb.mesh) < 1e-5, "{case}");
            }
        }
    }
}

#[test]
fn a_surface_without_a_valid_pose_is_not_found_by_queries() {
    for timing in BOTH {
        let mut app = app(64.0);
        let place = Transform::from_xyz(5.0, 0.0, 0.0).with_scale(Vec3::ZERO);
        let limb = limb(&mut app, place, timing);
        let seen = |app: &mut App, x: f32| {
            let ray = Ray3d::new(Vec3::new(x, 9.0, 0.19), Dir3::NEG_Y);
            let ray = Ray3d::new(ray.origin, Dir3::new(Vec3::new(0.01, -1.0, 0.0)).unwrap());
            let ask = move |s: SurfaceQuery| {
                s.cast_ray(ray, 20.0, &SurfaceFilter::default()).is_some()
                    || s.closest_point(Vec3::X * x, 1.0, &SurfaceFilter::default())
                        .is_some()
            };
            app.world_mut().run_system_once(ask).unwrap()
        };
        frames(&mut app, 3);
        assert!(!seen(&mut app, 0.0), "{timing:?}");
        transform(&mut app, limb.root).scale = Vec3::ONE;
        frames(&mut app, 4);
        assert!(seen(&mut app, 5.0), "{timing:?}");
        let surface = surface(&app, limb.mesh);
        assert_eq!(
            surface.in_model().position(VertexId(0)),
            surface.in_model().previous_position(VertexId(0)),
            "it appears without motion"
        );
    }
}

/// For example when entities arrive over a network, in any order.
#[test]
fn a_joint_that_gets_its_transform_late_makes_a_surface() {
    let mut app = app(64.0);
    let (mesh, bindposes) = (add_mesh(&mut app, limb_mesh()), add_bindposes(&mut app));
    let limb = spawn_limb(&mut app, mesh, bindposes, Transform::IDENTITY);
    let mut joint = app.world_mut().entity_mut(limb.joints[1]);
    let late = joint.take::<Transform>().unwrap();
    let collider = SkinnedCollider::default();
    app.world_mut().entity_mut(limb.mesh).insert(collider);
    let failed = |app: &App| {
        let status = app.world().get::<ColliderStatus>(limb.mesh);
        matches!(status, Some(ColliderStatus::Failed(_)))
    };
    let begin = Instant::now();
    while !failed(&app) {
        assert!(begin.elapsed().as_secs() < 30);
        app.update();
    }
    frames(&mut app, 3);
    assert!(failed(&app));
    app.world_mut().entity_mut(limb.joints[1]).insert(late);
    wait(&mut app, limb.mesh);
    frames(&mut app, 2);
    assert!(worst(&app, limb.mesh) < 1e-6);
}

/// The creature is hidden by a scale of zero, moved, and shown again.
#[test]
fn a_creature_that_is_hidden_and_shown_elsewhere_has_no_motion() {
    for timing in BOTH {
        let mut app = app(64.0);
        let limb = limb(&mut app, Transform::IDENTITY, timing);
        frames(&mut app, 4);
        transform(&mut app, limb.root).scale = Vec3::ZERO;
        frames(&mut app, 10);
        assert!(surface(&app, limb.mesh).error().is_some());
        transform(&mut app, limb.root).translation.x += 96.0;
        frames(&mut app, 10);
        transform(&mut app, limb.root).scale = Vec3::ONE;
        for frame in 0..6 {
            app.update();
            let surface = surface(&app, limb.mesh);
            for v in (0..surface.mesh().positions().len() as u32).map(VertexId) {
                let (now, before) = (
                    surface.in_model().position(v),
                    surface.in_model().previous_position(v),
                );
                let moved = now.unwrap().distance(before.unwrap());
                assert!(moved < 5.0, "{timing:?} frame {frame}: {moved}");
            }
        }
        let place = surface(&app, limb.mesh).world_from_model().translation;
        assert!((place.x - 96.0).abs() < 1e-3, "{timing:?}: {place}");
        assert!(worst(&app, limb.mesh) < 1e-4, "{timing:?}");
    }
}

#[derive(Resource, Default)]
struct Lost(Vec<AnchorLost>);

#[test]
fn a_missing_joint_ends_the_surface_until_it_is_back() {
    for timing in BOTH {
        let mut app = app(64.0);
        app.init_resource::<Lost>();
        app.add_observer(|lost: On<AnchorLost>, mut all: ResMut<Lost>| all.0.push(*lost));
        let limb = limb(&mut app, Transform::IDENTITY, timing);
        transform(&mut app, limb.joints[1]).rotation = bend(0.7);
        frames(&mut app, 5);
        let failed = |app: &App| {
            let status = app.world().get::<ColliderStatus>(limb.mesh).unwrap();
            match status {
                ColliderStatus::Failed(failure) => failure.error().cloned(),
                _ => None,
            }
        };
        let arrow = app
            .world_mut()
            .run_system_once(|surfaces: SurfaceQuery| {
                let near = surfaces.closest_point(Vec3::ONE, 9.0, &SurfaceFilter::default());
                surfaces.anchor_at(&near.unwrap()).unwrap()
            })
            .unwrap();
        let arrow = app.world_mut().spawn(arrow).id();
        frames(&mut app, 2);
        let mut joint = app.world_mut().entity_mut(limb.joints[1]);
        let taken = joint.take::<Transform>().unwrap();
        frames(&mut app, 3);
        assert_eq!(failed(&app), Some(ColliderError::Joint { joint: 1 }));
        assert!(app.world().get::<PosedSurface>(limb.mesh).is_none());
        let lost = std::mem::take(&mut app.world_mut().resource_mut::<Lost>().0);
        let entities: Vec<_> = lost
            .iter()
            .map(|lost| (lost.entity, lost.surface))
            .collect();
        assert_eq!(entities, [(arrow, limb.mesh)]);
        app.world_mut().entity_mut(limb.joints[1]).insert(taken);
        frames(&mut app, 3);
        assert_eq!(surface(&app, limb.mesh).error(), None);
        // Into another hierarchy, and back into this one, but under the root instead of joint 0, which is off the root.
        transform(&mut app, limb.joints[0]).translation.y += 0.3;
        frames(&mut app, 4);
        let elsewhere = app.world_mut().spawn(Transform::IDENTITY).id();
        app.world_mut()
            .entity_mut(limb.joints[1])
            .insert(ChildOf(elsewhere));
        frames(&mut app, 3);
        let expected = ColliderError::Hierarchies { joint: 1 };
        assert_eq!(failed(&app), Some(expected));
        app.world_mut()
            .entity_mut(limb.joints[1])
            .insert(ChildOf(limb.root));
        frames(&mut app, 4);
        assert_eq!(surface(&app, limb.mesh).error(), None);
        assert!(worst(&app, limb.mesh) < 1e-6);
        // Back under joint 0, in the same hierarchy, while nothing moves.
        app.world_mut()
            .entity_mut(limb.joints[1])
            .insert(ChildOf(limb.joints[0]));
        frames(&mut app, 4);
        assert!(worst(&app, limb.mesh) < 1e-6);
        app.world_mut().entity_mut(limb.joints[0]).despawn();
        frames(&mut app, 4);
        assert!(app.world().get::<PosedSurface>(limb.mesh).is_none());
        assert_eq!(failed(&app), Some(ColliderError::Joint { joint: 0 }));
    }
}

#[test]
fn a_root_that_is_reparented_while_it_moves_is_followed() {
    for timing in BOTH {
        let mut app = app(64.0);
        let limb = limb(&mut app, Transform::IDENTITY, timing);
        let mut above = None;
        for step in 0..60 {
            transform(&mut app, limb.root).translation.x += 0.02;
            if step % 7 == 3 {
                let next = Transform::from_xyz(0.01 * step as f32, 0.0, 0.0);
                let next = app.world_mut().spawn(next).id();
                app.world_mut().entity_mut(limb.root).insert(ChildOf(next));
                above = Some(next);
            }
            if step % 14 == 9 {
                app.world_mut().entity_mut(limb.root).remove::<ChildOf>();
                if let Some(above) = above {
                    app.world_mut().entity_mut(above).despawn();
                }
            }
            app.update();
            assert_eq!(surface(&app, limb.mesh).error(), None, "{step}");
        }
        frames(&mut app, 2);
        assert!(worst(&app, limb.mesh) < 1e-5);
    }
}

/// A ribbon with a chain of joints, each the parent of the next.
fn ribbon(app: &mut App, count: usize, place: Transform) -> Entity {
    let (mut positions, mut joints, mut weights) = (Vec::new(), Vec::new(), Vec::new());
    for joint in 0..count {
        for x in [0.0, 0.1] {
            positions.push([x, joint as f32 * 0.01, 0.0]);
            joints.push([joint as u16, 0, 0, 0]);
            weights.push([1.0, 0.0, 0.0, 0.0]);
        }
    }
    let indices = (0..2 * count as u32 - 2).flat_map(|i| [i, i + 1, i + 2]);
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
    .with_inserted_indices(Indices::U32(indices.collect()));
    let mesh = add_mesh(app, mesh);
    let bind = |joint: usize| Transform::from_xyz(0.0, joint as f32 * -0.01, 0.0).to_matrix();
    let bindposes: Vec<_> = (0..count).map(bind).collect();
    let inverse_bindposes = app
        .world_mut()
        .resource_mut::<Assets<SkinnedMeshInverseBindposes>>()
        .add(SkinnedMeshInverseBindposes::from(bindposes));
    let world = app.world_mut();
    let mut parent = world.spawn(place).id();
    let mut entities = Vec::new();
    for joint in 0..count {
        let up = Transform::from_xyz(0.0, if joint == 0 { 0.0 } else { 0.01 }, 0.0);
        parent = world.spawn((up, ChildOf(parent))).id();
        entities.push(parent);
    }
    let joints = entities;
    let skin = SkinnedMesh {
        inverse_bindposes,
        joints,
    };
    let entity = world
        .spawn((Mesh3d(mesh), skin, SkinnedCollider::default()))
        .id();
    wait(app, entity);
    entity
}

#[test]
fn a_chain_of_a_thousand_joints_is_followed_fast() {
    let mut app = app(64.0);
    let start = Instant::now();
    let entity = ribbon(&mut app, 1000, Transform::from_xyz(9.0, 0.0, 0.0));
    let built = start.elapsed();
    frames(&mut app, 3);
    assert!(worst(&app, entity) < 1e-4, "{}", worst(&app, entity));
    // The hierarchy changes in every frame.
    let top = app.world().get::<SkinnedMesh>(entity).unwrap().joints[0];
    let start = Instant::now();
    for _ in 0..20 {
        let above = app.world_mut().spawn(Transform::IDENTITY).id();
        app.world_mut().entity_mut(top).insert(ChildOf(above));
        app.update();
    }
    let followed = start.elapsed() / 20;
    println!("built in {built:?}, followed in {followed:?}");
    assert!(followed.as_millis() < 30, "{followed:?}");
    assert_eq!(surface(&app, entity).error(), None);
}

#[test]
fn duplicate_joints_make_a_surface_and_no_joints_are_an_error() {
    let mut app = app(64.0);
    let twice = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let mut skin = app.world_mut().get_mut::<SkinnedMesh>(twice.mesh).unwrap();
    let bindposes = skin.inverse_bindposes.clone();
    skin.joints = vec![twice.joints[0]; 2];
    frames(&mut app, 1);
    wait(&mut app, twice.mesh);
    frames(&mut app, 3);
    assert!(worst(&app, twice.mesh) < 1e-6);
    let mesh = app_mesh(&app, twice.mesh);
    let none = app
        .world_mut()
        .spawn((
            mesh,
            SkinnedMesh {
                inverse_bindposes: bindposes,
                joints: Vec::new(),
            },
            SkinnedCollider::default(),
        ))
        .id();
    wait(&mut app, none);
    let status = app.world().get::<ColliderStatus>(none).unwrap();
    assert!(matches!(status, ColliderStatus::Failed(_)), "{status:?}");
}

fn app_mesh(app: &App, entity: Entity) -> Mesh3d {
    app.world().get::<Mesh3d>(entity).unwrap().clone()
}

#[test]
fn a_cycle_of_joints_is_an_error() {
    let mut app = app(64.0);
    let mesh = add_mesh(&mut app, limb_mesh());
    let bindposes = add_bindposes(&mut app);
    let limb = spawn_limb(&mut app, mesh, bindposes, Transform::IDENTITY);
    app.world_mut()
        .entity_mut(limb.joints[0])
        .insert(ChildOf(limb.joints[1]));
    app.world_mut()
        .entity_mut(limb.mesh)
        .insert(SkinnedCollider::default());
    // Not a whole update: Bevy's own systems never end on such a cycle.
    for _ in 0..100_000 {
        app.world_mut().run_schedule(PreUpdate);
        std::thread::yield_now();
        let status = app.world().get::<ColliderStatus>(limb.mesh).unwrap();
        if let ColliderStatus::Failed(error) = status {
            let expected = ColliderError::Joint { joint: 0 };
            assert_eq!(error.error(), Some(&expected));
            return;
        }
    }
    panic!("the cycle is not reported");
}
