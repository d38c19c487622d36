//! Entities that are anchored to skin follow it as it is drawn.

use bevy_app::{AnimationSystems, PostUpdate};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{Dir3, Quat, Vec3};
use bevy_shape::Ray3d;
use bevy_transform::components::{GlobalTransform, Transform};

use super::common::{animate, app, drawn, limb};

/// Attaches an entity to the point of skin that a ray hits.
fn stick(app: &mut bevy_app::App, from: Vec3, toward: Dir3) -> Entity {
    let ray = Ray3d::new(from, toward);
    let ask = move |surfaces: SurfaceQuery| {
        let hit = surfaces.cast_ray(ray, 99.0, &SurfaceFilter::default())?;
        surfaces.anchor_at(&hit).ok()
    };
    let anchor = app.world_mut().run_system_once(ask).unwrap().unwrap();
    app.world_mut().spawn(anchor).id()
}

#[test]
fn an_anchor_lies_on_the_skin_as_it_is_drawn() {
    for rate in [30.0, 60.0, 144.0] {
        for place in [
            Transform::IDENTITY,
            Transform::from_xyz(300.0, -20.0, 70.0).with_scale(Vec3::splat(1.5)),
        ] {
            let mut app = app(rate);
            app.add_systems(PostUpdate, animate.in_set(AnimationSystems));
            let limb = limb(&mut app, place, SkinnedCollider::default());
            app.update();
            // The ray hits the lower half of the limb.
            let above = place.transform_point(Vec3::new(0.0, 0.5, 0.1)) + Vec3::X * 9.0;
            let arrow = stick(&mut app, above, Dir3::NEG_X);
            let anchor = *app.world().get::<SurfaceAnchor>(arrow).unwrap();
            let surface = app.world().get::<PosedSurface>(limb.mesh).unwrap();
            let corners = surface.mesh().triangles()[anchor.anchor().unwrap().triangle.index()];
            let corners = corners.map(|corner| surface.mesh().positions()[corner.index()]);
            let vertex_of = |position: Vec3| {
                let index = (position.y / 0.1).round() as usize * 4;
                let sides = [(0.2, 0.2), (0.2, -0.2), (-0.2, -0.2), (-0.2, 0.2)];
                index
                    + sides
                        .iter()
                        .position(|s| *s == (position.x, position.z))
                        .unwrap()
            };
            let mut worst = 0.0f64;
            for _ in 0..(3.0 * rate) as usize {
                app.update();
                let mut expected = glam::DVec3::ZERO;
                for (corner, weight) in corners.iter().zip(anchor.attachment.material.coordinates) {
                    expected += drawn(&app, &limb, vertex_of(*corner)) * weight;
                }
                let found = app
                    .world()
                    .get::<GlobalTransform>(arrow)
                    .unwrap()
                    .translation();
                worst = worst.max((found.as_dvec3() - expected).length());
            }
            println!("{rate} Hz at {}: {:.1e} m", place.translation, worst);
            assert!(worst < 1e-3, "{rate} {worst}");
        }
    }
}

#[test]
fn an_anchor_turns_with_the_skin_under_any_parent() {
    let mut app = app(60.0);
    app.add_systems(PostUpdate, animate.in_set(AnimationSystems));
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let shelf =
        Transform::from_xyz(5.0, 6.0, 7.0).with_rotation(Quat::from_xyzw(0.5, 0.5, 0.5, 0.5));
    let shelf = app.world_mut().spawn(shelf).id();
    let other = stick(&mut app, Vec3::new(9.0, 1.7, 0.05), Dir3::NEG_X);
    let twin = *app.world().get::<SurfaceAnchor>(other).unwrap();
    let below = app.world_mut().spawn((twin, ChildOf(shelf))).id();
    for _ in 0..30 {
        app.update();
        let at = |entity| *app.world().get::<GlobalTransform>(entity).unwrap();
        assert!((at(other).translation() - at(below).translation()).length() < 1e-5);
        let up = at(other).rotation() * Vec3::Y;
        let joint = at(limb.joints[1]).rotation() * Vec3::X;
        assert!((up - joint).length() < 1e-4, "{up} {joint}");
    }
}

#[test]
fn an_offset_from_the_skin_moves_and_turns_with_it() {
    let mut app = app(60.0);
    app.add_systems(PostUpdate, animate.in_set(AnimationSystems));
    limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let arrow = stick(&mut app, Vec3::new(9.0, 1.7, 0.05), Dir3::NEG_X);
    let mut off = *app.world().get::<SurfaceAnchor>(arrow).unwrap();
    off.attachment.offset = glam::DVec3::new(0.0, 0.3, 0.4);
    let off = app.world_mut().spawn(off).id();
    let (mut seen, mut turned) = (None, 0.0f32);
    for _ in 0..30 {
        app.update();
        let at = |entity| *app.world().get::<GlobalTransform>(entity).unwrap();
        let (on, off) = (at(arrow), at(off));
        let apart = on.rotation().inverse() * (off.translation() - on.translation());
        assert!((apart.length() - 0.5).abs() < 1e-5, "{apart}");
        let first = *seen.get_or_insert((apart, on.rotation()));
        assert!((apart - first.0).length() < 1e-5, "{apart} {}", first.0);
        turned = turned.max(on.rotation().angle_between(first.1));
    }
    assert!(turned > 0.1, "{turned}");
}

#[test]
fn a_despawned_surface_triggers_anchor_lost() {
    #[derive(Resource, Default)]
    struct Lost(Vec<AnchorLost>);
    let mut app = app(60.0);
    app.init_resource::<Lost>()
        .add_observer(|lost: On<AnchorLost>, mut all: ResMut<Lost>| all.0.push(*lost));
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let arrow = stick(&mut app, Vec3::new(9.0, 1.7, 0.05), Dir3::NEG_X);
    app.update();
    assert!(app.world().resource::<Lost>().0.is_empty());
    app.world_mut().entity_mut(limb.root).despawn();
    for _ in 0..3 {
        app.update();
    }
    let [lost] = app.world().resource::<Lost>().0[..] else {
        panic!("not lost once");
    };
    assert_eq!((lost.entity, lost.surface), (arrow, limb.mesh));
    assert!(app.world().get::<SurfaceAnchor>(arrow).is_none());
}
