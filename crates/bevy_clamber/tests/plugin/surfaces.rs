//! A skinned mesh becomes a surface, which has the pose of its animation.

use bevy_app::{AnimationSystems, FixedUpdate, PostUpdate};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{Dir3, Quat, Vec3};
use bevy_shape::Ray3d;
use bevy_time::{Fixed, Time};
use bevy_transform::components::Transform;
use glam::DVec3;

use super::common::{SPIN, animate, app, limb};

/// The hit of a ray from the right, at a height.
fn meet(app: &mut bevy_app::App, height: f32) -> Option<EntityHit> {
    let ray = Ray3d::new(Vec3::new(9.0, height, 0.05), Dir3::NEG_X);
    let ask = move |surfaces: SurfaceQuery| surfaces.cast_ray(ray, 20.0, &SurfaceFilter::default());
    app.world_mut().run_system_once(ask).unwrap()
}

#[test]
fn a_ray_hits_a_limb_at_rest_and_where_it_is_bent_to() {
    let mut app = app(64.0);
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let hit = meet(&mut app, 1.8).unwrap();
    assert_eq!(hit.entity, limb.mesh);
    assert!(
        (hit.point - Vec3::new(0.2, 1.8, 0.05)).length() < 1e-5,
        "{hit:?}"
    );
    assert!((hit.normal - Vec3::X).length() < 1e-5, "{hit:?}");
    assert!((hit.distance - 8.8).abs() < 1e-5, "{hit:?}");
    // A quarter turn: the upper half lies along -X, and nothing is up there.
    let mut joint = app.world_mut().entity_mut(limb.joints[1]);
    let quarter = core::f32::consts::FRAC_1_SQRT_2;
    joint.get_mut::<Transform>().unwrap().rotation = Quat::from_xyzw(0.0, 0.0, quarter, quarter);
    for _ in 0..4 {
        app.update();
    }
    assert_eq!(meet(&mut app, 1.8), None);
    assert!(meet(&mut app, 1.0).is_some());
}

/// Position of the tip's last corner at a time.
fn tip(seconds: f64) -> DVec3 {
    let (sin, cos) = (libm::sin(SPIN * seconds), libm::cos(SPIN * seconds));
    let local = DVec3::new(-0.2, 1.0, 0.2);
    DVec3::new(
        cos * local.x - sin * local.y,
        1.0 + sin * local.x + cos * local.y,
        local.z,
    )
}

/// Checks each tick of two seconds against the pose that it should have: one frame late for `PoseTiming::EachFrame`.
fn check_ticks(rate: f64, timing: PoseTiming) {
    #[derive(Resource, Default)]
    struct Ticks(Vec<(f64, DVec3, DVec3)>);
    let mut app = app(rate);
    match timing {
        PoseTiming::EachFrame => app.add_systems(PostUpdate, animate.in_set(AnimationSystems)),
        PoseTiming::EachTick => app.add_systems(FixedUpdate, animate),
    };
    let note =
        |time: Res<Time<Fixed>>, surface: Single<&PosedSurface>, mut ticks: ResMut<Ticks>| {
            let vertex = surface.mesh().triangles().iter().flatten().max().unwrap();
            let at = |p: Vec3| surface.world_from_model().transform_point_f32(p);
            ticks.0.push((
                time.elapsed().as_secs_f64(),
                at(surface.in_model().position(*vertex).unwrap()),
                at(surface.in_model().previous_position(*vertex).unwrap()),
            ));
        };
    let collider = SkinnedCollider {
        joints: timing,
        root: timing,
        ..SkinnedCollider::each_frame()
    };
    limb(&mut app, Transform::IDENTITY, collider);
    for _ in 0..3 {
        app.update();
    }
    app.init_resource::<Ticks>()
        .add_systems(bevy_app::FixedPostUpdate, note.after(ClamberSystems::Pose));
    for _ in 0..(2.0 * rate) as usize {
        app.update();
    }
    let ticks = &app.world().resource::<Ticks>().0;
    assert!(ticks.len() > 120, "{}", ticks.len());
    let lag = match timing {
        PoseTiming::EachFrame => 1.0 / rate,
        PoseTiming::EachTick => 0.0,
    };
    for (index, (time, now, before)) in ticks.iter().enumerate() {
        let expected = tip(time - lag);
        assert!(
            (*now - expected).length() < 2e-5,
            "tick {index} at {time}: {now} not {expected}, {timing:?} {rate}"
        );
        if index > 0 {
            assert!(
                (ticks[index - 1].1 - *before).length() < 2e-6,
                "tick {index}"
            );
        }
    }
}

#[test]
fn ticks_lag_by_one_frame_when_each_frame_animates() {
    for rate in [30.0, 60.0, 144.0] {
        check_ticks(rate, PoseTiming::EachFrame);
    }
}

#[test]
fn ticks_do_not_lag_when_each_tick_animates() {
    for rate in [30.0, 60.0, 144.0] {
        check_ticks(rate, PoseTiming::EachTick);
    }
}
