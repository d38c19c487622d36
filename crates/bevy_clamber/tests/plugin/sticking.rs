//! Anchors in hard cases: under unusual parents, under each other, on skin that is cut or rebuilt.

use std::time::Duration;

use bevy_app::{AnimationSystems, App, PostUpdate, Update};
use bevy_asset::Assets;
use bevy_clamber::AnchorError;
use bevy_clamber::clamber_surface::mesh::TriangleId;
use bevy_clamber::clamber_surface::surface::SurfaceError;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{Dir3, Quat, Vec3};
use bevy_mesh::{Mesh, Mesh3d};
use bevy_shape::Ray3d;
use bevy_time::TimeUpdateStrategy;
use bevy_transform::components::{GlobalTransform, Transform};
use glam::DVec3;

use super::common::posed;
use super::common::{self, Limb, animate, app, bend, limb};

/// An anchor at the point of the limb that a ray along -X at a height hits.
fn anchor_at(app: &mut App, height: f32) -> SurfaceAnchor {
    let ray = Ray3d::new(Vec3::new(9.0, height, 0.05), Dir3::NEG_X);
    let ask = move |surfaces: SurfaceQuery| {
        let hit = surfaces.cast_ray(ray, 99.0, &SurfaceFilter::default())?;
        surfaces.anchor_at(&hit).ok()
    };
    app.world_mut().run_system_once(ask).unwrap().unwrap()
}

/// The drawn position of an anchor's point, and the outward normal of the skin there.
fn on_skin(app: &App, limb: &Limb, anchor: &SurfaceAnchor) -> (DVec3, DVec3) {
    let posed = posed::positions(app, limb.mesh);
    let surface = app.world().get::<PosedSurface>(limb.mesh).unwrap();
    let corners = surface.mesh().triangles()[anchor.anchor().unwrap().triangle.index()];
    let [a, b, c] = corners.map(|corner| posed[corner.index()]);
    let [u, v, w] = anchor.attachment.material.coordinates;
    (a * u + b * v + c * w, (b - a).cross(c - a).normalize())
}

fn place(app: &App, entity: Entity) -> GlobalTransform {
    *app.world().get::<GlobalTransform>(entity).unwrap()
}

fn jitter(app: &mut App, state: &mut u64) {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(99);
    let length = Duration::from_millis(5 + (*state >> 33) % 30);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(length));
    app.update();
}

#[test]
fn anchored_entities_follow_under_any_parent_and_under_each_other() {
    let mut app = app(60.0);
    app.add_systems(PostUpdate, animate.in_set(AnimationSystems));
    let at = Transform::from_scale(Vec3::splat(1.2));
    let limb = limb(&mut app, at, SkinnedCollider::default());
    let anchor = anchor_at(&mut app, 1.7);
    let turned = Quat::from_xyzw(0.1, 0.7, -0.1, 0.7);
    let mut spawn = |parent: Option<Entity>, own: Transform| {
        let mut entity = app.world_mut().spawn((anchor, own));
        if let Some(parent) = parent {
            entity.insert(ChildOf(parent));
        }
        entity.id()
    };
    // Spawned before their parents, so that they come first in the order of entities.
    let first = spawn(None, Transform::IDENTITY);
    let second = spawn(None, Transform::IDENTITY);
    let third = spawn(None, Transform::IDENTITY);
    let mut under = Vec::new();
    for (scale, rotation) in [
        (Vec3::new(3.0, 0.2, 1.0), Quat::IDENTITY),
        (Vec3::new(-1.0, 1.0, 1.0), turned),
        (Vec3::new(1.0, -2.0, 0.5), turned),
    ] {
        let outer = Transform::from_xyz(1.0, 2.0, 3.0)
            .with_rotation(bend(0.8))
            .with_scale(scale);
        let outer = app.world_mut().spawn(outer).id();
        let inner = Transform::from_xyz(-1.0, 0.4, 0.0).with_rotation(rotation);
        let inner = app.world_mut().spawn((inner, ChildOf(outer))).id();
        let child = app.world_mut().spawn((anchor, ChildOf(inner))).id();
        under.push(child);
    }
    let own = app
        .world_mut()
        .spawn((anchor, ChildOf(limb.joints[1])))
        .id();
    app.world_mut().entity_mut(first).insert(ChildOf(second));
    app.world_mut().entity_mut(second).insert(ChildOf(third));
    under.extend([own, first, second, third]);
    let mut state = 5;
    let mut worst = (0.0f64, 0.0f64);
    for _ in 0..120 {
        jitter(&mut app, &mut state);
        let (point, outward) = on_skin(&app, &limb, &anchor);
        for entity in &under {
            let found = place(&app, *entity);
            let apart = (found.translation().as_dvec3() - point).length();
            let up = found
                .affine()
                .transform_vector3(Vec3::Y)
                .as_dvec3()
                .normalize();
            worst = (worst.0.max(apart), worst.1.max((up - outward).length()));
            let own = app.world().get::<Transform>(*entity).unwrap();
            assert!((own.rotation.length() - 1.0).abs() < 1e-5, "{own:?}");
        }
    }
    println!("{:.1e} m, {:.1e} rad", worst.0, worst.1);
    assert!(worst.0 < 1e-5 && worst.1 < 1e-4, "{worst:?}");
}

#[test]
fn a_parent_with_a_degenerate_scale_leaves_anchored_children_in_place() {
    for scale in [Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0), Vec3::splat(f32::NAN)] {
        let mut app = app(60.0);
        app.add_systems(PostUpdate, animate.in_set(AnimationSystems));
        let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
        let anchor = anchor_at(&mut app, 1.7);
        let flat = Transform::from_scale(scale);
        let flat = app.world_mut().spawn(flat).id();
        let arrow = app.world_mut().spawn((anchor, ChildOf(flat))).id();
        for _ in 0..5 {
            app.update();
            let own = app.world().get::<Transform>(arrow).unwrap();
            assert!(own.is_finite(), "{scale}: {own:?}");
        }
        app.world_mut().get_mut::<Transform>(flat).unwrap().scale = Vec3::ONE;
        app.update();
        let (point, _) = on_skin(&app, &limb, &anchor);
        let apart = place(&app, arrow).translation().as_dvec3() - point;
        assert!(apart.length() < 1e-5, "{apart}");
    }
}

#[test]
fn many_anchors_follow_one_limb_at_any_frame_rate() {
    for rate in [30.0, 60.0, 144.0] {
        let mut app = app(rate);
        app.add_systems(PostUpdate, animate.in_set(AnimationSystems));
        let limb = limb(
            &mut app,
            Transform::from_xyz(9.0, 0.0, 0.0),
            SkinnedCollider::default(),
        );
        let surface = app.world().get::<PosedSurface>(limb.mesh).unwrap();
        let mut anchors = Vec::new();
        for triangle in 0..surface.mesh().triangles().len() as u32 {
            let anchor = surface
                .anchor(TriangleId(triangle), [0.5, 0.25, 0.25])
                .unwrap();
            anchors.push(SurfaceAnchor::new(
                limb.mesh,
                surface,
                anchor,
                Quat::IDENTITY,
            ));
        }
        let arrows: Vec<_> = anchors
            .iter()
            .map(|a| app.world_mut().spawn(*a).id())
            .collect();
        let mut state = 3;
        for _ in 0..rate as usize {
            jitter(&mut app, &mut state);
            let posed = posed::positions(&app, limb.mesh);
            let surface = app.world().get::<PosedSurface>(limb.mesh).unwrap();
            for (arrow, anchor) in arrows.iter().zip(&anchors) {
                let corners = surface.mesh().triangles()[anchor.anchor().unwrap().triangle.index()];
                let [a, b, c] = corners.map(|corner| posed[corner.index()]);
                let apart =
                    place(&app, *arrow).translation().as_dvec3() - (a * 0.5 + (b + c) * 0.25);
                assert!(apart.length() < 1e-5, "{apart}");
            }
        }
    }
}

#[test]
fn the_transform_of_an_anchor_on_still_skin_is_not_marked_as_changed() {
    #[derive(Resource, Default)]
    struct Seen(usize);
    fn look(
        changed: Query<Entity, (Changed<Transform>, With<SurfaceAnchor>)>,
        mut seen: ResMut<Seen>,
    ) {
        seen.0 += changed.iter().count();
    }
    let mut app = app(60.0);
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    app.world_mut()
        .get_mut::<Transform>(limb.joints[1])
        .unwrap()
        .rotation = bend(0.4);
    for _ in 0..5 {
        app.update();
    }
    let anchor = anchor_at(&mut app, 0.9);
    app.world_mut().spawn(anchor);
    app.update();
    app.update();
    app.init_resource::<Seen>().add_systems(Update, look);
    app.update();
    app.world_mut().resource_mut::<Seen>().0 = 0;
    for _ in 0..10 {
        app.update();
    }
    assert_eq!(app.world().resource::<Seen>().0, 0);
}

#[derive(Resource, Default)]
struct Lost(Vec<AnchorLost>);

fn losing(app: &mut App) {
    app.init_resource::<Lost>()
        .add_observer(|lost: On<AnchorLost>, mut all: ResMut<Lost>| all.0.push(*lost));
}

#[test]
fn an_anchor_on_a_removed_triangle_is_lost_once() {
    let mut app = app(60.0);
    losing(&mut app);
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let (cut, kept) = (anchor_at(&mut app, 1.7), anchor_at(&mut app, 0.3));
    let [cut_arrow, kept_arrow] = [cut, kept].map(|anchor| app.world_mut().spawn(anchor).id());
    app.update();
    let mut surface = app.world_mut().get_mut::<PosedSurface>(limb.mesh).unwrap();
    surface
        .surface_mut()
        .edit(|edit| edit.remove_triangle(cut.anchor().unwrap().triangle))
        .unwrap();
    for _ in 0..5 {
        app.update();
    }
    let [lost] = app.world().resource::<Lost>().0[..] else {
        panic!("not lost once");
    };
    assert_eq!((lost.entity, lost.surface), (cut_arrow, limb.mesh));
    assert_eq!(lost.anchor.attachment.material, cut.attachment.material);
    assert!(app.world().get::<SurfaceAnchor>(kept_arrow).is_some());
    // A disabled triangle is still skin.
    let mut surface = app.world_mut().get_mut::<PosedSurface>(limb.mesh).unwrap();
    let hidden = surface
        .surface_mut()
        .disable_triangle(kept.anchor().unwrap().triangle);
    hidden.unwrap();
    app.world_mut()
        .get_mut::<Transform>(limb.root)
        .unwrap()
        .translation
        .x = 3.0;
    app.update();
    let (point, _) = on_skin(&app, &limb, &kept);
    let apart = place(&app, kept_arrow).translation().as_dvec3() - point;
    assert!(apart.length() < 1e-5, "{apart}");
    assert_eq!(app.world().resource::<Lost>().0.len(), 1);
}

#[test]
fn anchors_stay_when_the_same_mesh_is_rebuilt() {
    let mut app = app(60.0);
    losing(&mut app);
    app.add_systems(PostUpdate, animate.in_set(AnimationSystems));
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let anchor = anchor_at(&mut app, 1.7);
    let arrow = app.world_mut().spawn(anchor).id();
    for round in 0..40 {
        if round % 10 == 3 {
            let mesh = app.world().get::<Mesh3d>(limb.mesh).unwrap().0.clone();
            let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
            meshes.insert(&mesh, common::limb_mesh()).unwrap();
        }
        app.update();
        let (point, _) = on_skin(&app, &limb, &anchor);
        let apart = place(&app, arrow).translation().as_dvec3() - point;
        assert!(apart.length() < 1e-5, "{round} {apart}");
    }
    assert!(app.world().resource::<Lost>().0.is_empty());
}

#[test]
fn a_hit_on_a_mesh_that_was_replaced_gives_no_anchor() {
    let mut app = app(60.0);
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let ray = Ray3d::new(Vec3::new(9.0, 1.7, 0.05), Dir3::NEG_X);
    let ask = move |surfaces: SurfaceQuery| surfaces.cast_ray(ray, 99.0, &SurfaceFilter::default());
    let hit = app.world_mut().run_system_once(ask).unwrap().unwrap();
    let stick = move |surfaces: SurfaceQuery| surfaces.anchor_at(&hit);
    let anchor = app.world_mut().run_system_once(stick).unwrap().unwrap();
    assert_eq!(anchor.mesh, hit.mesh);
    // A mesh of another shape with the same triangles.
    let handle = app.world().get::<Mesh3d>(limb.mesh).unwrap().0.clone();
    let mut other = common::limb_mesh();
    other.scale_by(Vec3::new(1.5, 1.0, 1.5));
    let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
    meshes.insert(&handle, other).unwrap();
    for _ in 0..6 {
        app.update();
    }
    let refused = app.world_mut().run_system_once(stick).unwrap().unwrap_err();
    assert!(
        matches!(
            refused,
            AnchorError::Surface(SurfaceError::ForeignMesh { found, .. }) if found == hit.mesh
        ),
        "{refused}"
    );
    let motion = move |surfaces: SurfaceQuery| surfaces.motion(&anchor, 0.1);
    let refused = app
        .world_mut()
        .run_system_once(motion)
        .unwrap()
        .unwrap_err();
    assert!(matches!(refused, AnchorError::Surface(_)), "{refused}");
    app.world_mut().entity_mut(limb.root).despawn();
    app.update();
    let gone = app.world_mut().run_system_once(stick).unwrap().unwrap_err();
    assert_eq!(gone, AnchorError::NoSurface(limb.mesh));
}

#[test]
fn arrow_and_creature_may_be_despawned_together() {
    let mut app = app(60.0);
    losing(&mut app);
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let anchor = anchor_at(&mut app, 1.7);
    let arrows = [0; 5].map(|_| app.world_mut().spawn(anchor).id());
    // The first arrow that is lost despawns all others.
    app.add_observer(move |lost: On<AnchorLost>, mut commands: Commands| {
        for arrow in arrows.iter().filter(|arrow| **arrow != lost.entity) {
            commands.entity(*arrow).try_despawn();
        }
        commands.entity(lost.entity).try_despawn();
    });
    // In the same schedule, by deferred commands, like the plugin's own.
    app.add_systems(
        PostUpdate,
        move |mut commands: Commands, mut done: Local<bool>| {
            if !*done {
                *done = true;
                commands.entity(arrows[4]).try_despawn();
                commands.entity(limb.root).try_despawn();
            }
        },
    );
    for _ in 0..4 {
        app.update();
    }
    for arrow in arrows {
        assert!(app.world().get_entity(arrow).is_err());
    }
}
