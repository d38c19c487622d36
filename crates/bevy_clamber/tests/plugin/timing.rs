//! Ticks and frames: pauses, jitter, teleports, stillness.

use std::time::Duration;

use bevy_app::{AnimationSystems, App, FixedPostUpdate, FixedUpdate, PostUpdate, Update};
use bevy_clamber::clamber_surface::mesh::VertexId;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::{Fixed, Time, TimeUpdateStrategy, Virtual};
use bevy_transform::components::Transform;

use super::common::{self, Limb, app, bend, limb};

const FRAME: SkinnedCollider = SkinnedCollider::each_frame();
const TICK: SkinnedCollider = SkinnedCollider::each_tick();

/// Metres a second that the root moves along X.
const SPEED: f64 = 3.0;

#[derive(Component)]
struct Walking;

/// Moves the roots by the time of the schedule that it runs in.
fn walk(time: Res<Time>, mut roots: Query<&mut Transform, With<Walking>>) {
    for mut root in &mut roots {
        root.translation.x = (SPEED * time.elapsed().as_secs_f64()) as f32;
    }
}

/// Per tick: its time, and the foot's x in this tick and in the one before.
#[derive(Resource, Default)]
struct Ticks(Vec<[f64; 3]>);

fn note(
    time: Res<Time<Fixed>>,
    surfaces: Query<&PosedSurface, With<SkinnedCollider>>,
    mut ticks: ResMut<Ticks>,
) {
    for surface in &surfaces {
        let world = |p: Option<Vec3>| surface.world_from_model().transform_point_f32(p.unwrap()).x;
        ticks.0.push([
            time.elapsed().as_secs_f64(),
            world(surface.in_model().position(VertexId(0))) - 0.2,
            world(surface.in_model().previous_position(VertexId(0))) - 0.2,
        ]);
    }
}

fn walker(collider: SkinnedCollider) -> (App, Limb) {
    let mut app = app(60.0);
    match collider.root {
        PoseTiming::EachFrame => app.add_systems(Update, walk),
        PoseTiming::EachTick => app.add_systems(FixedUpdate, walk),
    };
    let limb = limb(&mut app, Transform::IDENTITY, collider);
    app.world_mut().entity_mut(limb.root).insert(Walking);
    for _ in 0..4 {
        app.update();
    }
    app.init_resource::<Ticks>()
        .add_systems(FixedPostUpdate, note.after(ClamberSystems::Pose));
    (app, limb)
}

fn frame(app: &mut App, milliseconds: u64) {
    let length = Duration::from_millis(milliseconds);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(length));
    app.update();
}

/// Checks that each tick begins where the last one ended, unless it is a placement, and does not move back. Returns the
/// number of ticks.
fn check(app: &App, what: &str) -> usize {
    let ticks = &app.world().resource::<Ticks>().0;
    for pair in ticks.windows(2) {
        let [[_, last, _], [_, now, before]] = [pair[0], pair[1]];
        assert!(
            (before - last).abs() < 1e-5 || before == now,
            "{what}: {pair:?}"
        );
        assert!(now > last - 1e-6, "{what}: {pair:?}");
    }
    ticks.len()
}

#[test]
fn with_frames_of_any_length_surfaces_move_neither_backwards_nor_ahead() {
    for collider in [FRAME, TICK] {
        let (mut app, limb) = walker(collider);
        let mut state = 7u64;
        let mut drawn = 0.0;
        for _ in 0..600 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(99);
            let before = app.world().resource::<Ticks>().0.len();
            frame(&mut app, 5 + (state >> 33) % 76);
            for [time, now, _] in &app.world().resource::<Ticks>().0[before..] {
                match collider.root {
                    // No farther than the pose that was drawn last.
                    PoseTiming::EachFrame => assert!(*now < drawn + 1e-4, "{now} {drawn}"),
                    PoseTiming::EachTick => assert!((now - SPEED * time).abs() < 1e-4),
                }
            }
            let root = app.world().get::<Transform>(limb.root).unwrap();
            drawn = f64::from(root.translation.x);
        }
        assert!(check(&app, "jitter") > 1000);
    }
}

#[test]
fn ticks_follow_scaled_and_paused_time() {
    for collider in [FRAME, TICK] {
        let (mut app, _) = walker(collider);
        for (speed, paused) in [
            (10.0, false),
            (0.1, false),
            (1.0, true),
            (1.0, false),
            (0.0, false),
            (3.0, false),
        ] {
            let mut time = app.world_mut().resource_mut::<Time<Virtual>>();
            time.set_relative_speed(speed);
            if paused {
                time.pause();
            } else {
                time.unpause();
            }
            let before = app.world().resource::<Ticks>().0.len();
            for length in [16, 7, 33, 16, 16, 5, 60, 16, 20, 16] {
                frame(&mut app, length);
            }
            let ticks = app.world().resource::<Ticks>().0.len() - before;
            assert_eq!(ticks == 0, paused || speed == 0.0, "{speed} {paused}");
        }
        for _ in 0..100 {
            frame(&mut app, 16);
        }
        check(&app, "scaled");
        // In the end it keeps up. With frame timing it lags by the longer frames.
        let [time, now, _] = *app.world().resource::<Ticks>().0.last().unwrap();
        let lag = SPEED * time - now;
        assert!((-1e-4..SPEED * 0.1).contains(&lag), "{lag}");
    }
}

#[test]
fn ticks_move_evenly_after_the_fixed_clock_has_discarded_time() {
    let (mut app, _) = walker(FRAME);
    // The fixed clock discards its overstep once, as after loading.
    app.world_mut()
        .resource_mut::<Time<Virtual>>()
        .set_max_delta(Duration::from_secs(9));
    app.add_systems(
        bevy_app::PreUpdate,
        |mut fixed: ResMut<Time<Fixed>>, mut done: Local<bool>| {
            if !*done {
                fixed.discard_overstep(Duration::from_secs(9));
                *done = true;
            }
        },
    );
    app.world_mut()
        .resource_mut::<Time<Fixed>>()
        .accumulate_overstep(Duration::from_millis(10));
    for _ in 0..3 {
        frame(&mut app, 40);
    }
    app.world_mut().resource_mut::<Ticks>().0.clear();
    for _ in 0..30 {
        frame(&mut app, 40);
    }
    // All ticks move equally far, but for a slow change of the lag.
    let ticks = &app.world().resource::<Ticks>().0;
    for [_, now, before] in ticks {
        assert!(
            (now - before - SPEED / 64.0).abs() < 0.01 * SPEED / 64.0 + 1e-5,
            "{now} {before}"
        );
    }
}

#[test]
fn a_surface_that_appears_between_ticks_has_not_moved() {
    for collider in [FRAME, TICK] {
        let (mut app, _) = walker(collider);
        for _ in 0..20 {
            let limb = limb(&mut app, Transform::from_xyz(50.0, 0.0, 0.0), collider);
            app.world_mut().resource_mut::<Ticks>().0.clear();
            frame(&mut app, 16);
            let surface = app.world().get::<PosedSurface>(limb.mesh).unwrap();
            let (now, before) = (
                surface.in_model().position(VertexId(0)),
                surface.in_model().previous_position(VertexId(0)),
            );
            assert_eq!(now, before);
            app.world_mut().entity_mut(limb.root).despawn();
            frame(&mut app, 5);
        }
    }
}

#[test]
fn a_teleport_is_no_motion() {
    // The root teleports in a frame's schedule or in a tick's.
    for collider in [FRAME, TICK] {
        for milliseconds in [7, 16, 33] {
            let mut app = app(60.0);
            let limb = limb(&mut app, Transform::IDENTITY, collider);
            app.init_resource::<Ticks>()
                .add_systems(FixedPostUpdate, note.after(ClamberSystems::Pose));
            for _ in 0..10 {
                frame(&mut app, milliseconds);
            }
            let teleport = move |mut surfaces: Query<&mut PosedSurface>,
                                 mut transforms: Query<&mut Transform>,
                                 mut done: Local<u32>| {
                *done += 1;
                if *done == 3 {
                    surfaces.get_mut(limb.mesh).unwrap().forget_motion();
                    transforms.get_mut(limb.root).unwrap().translation.x = 100.0;
                }
            };
            match collider.root {
                PoseTiming::EachFrame => app.add_systems(Update, teleport),
                PoseTiming::EachTick => app.add_systems(FixedUpdate, teleport),
            };
            for _ in 0..20 {
                frame(&mut app, milliseconds);
            }
            let ticks = &app.world().resource::<Ticks>().0;
            let case = format!("{collider:?} {milliseconds} ms: {ticks:?}");
            for [_, now, before] in ticks {
                assert!((now - before).abs() < 1e-4, "{case}");
                assert!(now.abs() < 1e-4 || (now - 100.0).abs() < 1e-4, "{case}");
            }
            assert!((ticks.last().unwrap()[1] - 100.0).abs() < 1e-4, "{case}");
        }
    }
}

#[test]
fn joints_and_root_may_have_different_timings() {
    for (joints, root) in [
        (PoseTiming::EachTick, PoseTiming::EachFrame),
        (PoseTiming::EachFrame, PoseTiming::EachTick),
    ] {
        let (mut app, limb) = walker(SkinnedCollider {
            joints,
            root,
            ..SkinnedCollider::each_frame()
        });
        match joints {
            PoseTiming::EachTick => app.add_systems(FixedUpdate, common::animate),
            PoseTiming::EachFrame => {
                app.add_systems(PostUpdate, common::animate.in_set(AnimationSystems))
            }
        };
        let rate = 40.0;
        for _ in 0..300 {
            frame(&mut app, 25);
        }
        check(&app, "mixed");
        let [time, foot, _] = *app.world().resource::<Ticks>().0.last().unwrap();
        let lag = |timing| match timing {
            PoseTiming::EachFrame => 1.0 / rate,
            PoseTiming::EachTick => 0.0,
        };
        assert!(
            (foot - SPEED * (time - lag(root))).abs() < 1e-4,
            "{foot} {time}"
        );
        let surface = app.world().get::<PosedSurface>(limb.mesh).unwrap();
        let tip = surface.in_model().position(VertexId(80)).unwrap();
        let angle = bend(time - lag(joints)) * Vec3::new(0.2, 1.0, 0.2) + Vec3::Y;
        assert!((tip - angle).length() < 1e-4, "{tip} {angle}");
    }
}

#[test]
fn only_surfaces_that_move_are_marked_as_changed() {
    #[derive(Resource, Default)]
    struct Seen(Vec<Entity>);
    fn look(changed: Query<Entity, Changed<PosedSurface>>, mut seen: ResMut<Seen>) {
        seen.0.extend(&changed);
    }
    for collider in [FRAME, TICK] {
        let mut app = app(64.0);
        let still = limb(&mut app, Transform::IDENTITY, collider);
        let moving = limb(&mut app, Transform::from_xyz(4.0, 0.0, 0.0), collider);
        for _ in 0..4 {
            app.update();
        }
        app.init_resource::<Seen>()
            .add_systems(FixedPostUpdate, look.after(ClamberSystems::Pose));
        app.update();
        app.world_mut().resource_mut::<Seen>().0.clear();
        for step in 1..=20 {
            let mut joint = app
                .world_mut()
                .get_mut::<Transform>(moving.joints[1])
                .unwrap();
            joint.rotation = bend(0.01 * f64::from(step));
            app.update();
        }
        let seen = &app.world().resource::<Seen>().0;
        assert!(!seen.contains(&still.mesh), "{collider:?}");
        assert!(seen.len() >= 19, "{collider:?} {}", seen.len());
        // After it stops, one more tick changes the surface: its motion ends.
        for _ in 0..3 {
            app.update();
        }
        app.world_mut().resource_mut::<Seen>().0.clear();
        for _ in 0..10 {
            app.update();
        }
        assert!(app.world().resource::<Seen>().0.is_empty(), "{collider:?}");
        let surface = app.world().get::<PosedSurface>(moving.mesh).unwrap();
        let (now, before) = (
            surface.in_model().position(VertexId(80)),
            surface.in_model().previous_position(VertexId(80)),
        );
        assert_eq!(now, before);
    }
}

#[test]
fn two_apps_on_two_threads_pose_as_one_alone_does() {
    fn run() -> Vec<[f64; 3]> {
        let (mut app, _) = walker(FRAME);
        for _ in 0..100 {
            frame(&mut app, 11);
        }
        app.world().resource::<Ticks>().0.clone()
    }
    let alone: Vec<_> = run()
        .into_iter()
        .map(|[_, now, before]| now - before)
        .collect();
    let threads = [std::thread::spawn(run), std::thread::spawn(run)];
    for thread in threads {
        let found = thread.join().unwrap();
        // The number of frames differs that passed while the collider was built. Those frames were longer.
        for [_, now, before] in &found[5..] {
            assert!((now - before - alone[50]).abs() < 1e-3, "{now} {before}");
        }
    }
    let (mut first, mut second) = (walker(FRAME).0, walker(TICK).0);
    for _ in 0..100 {
        frame(&mut first, 11);
        frame(&mut second, 13);
    }
    assert!(check(&first, "first") > 60 && check(&second, "second") > 60);
}

#[test]
fn a_pose_that_is_set_by_hand_lasts_until_the_next_tick() {
    let mut app = app(64.0);
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    for _ in 0..4 {
        app.update();
    }
    let mut surface = app.world_mut().get_mut::<PosedSurface>(limb.mesh).unwrap();
    let palette = bevy_clamber::clamber_surface::rig::Palette::from_matrices(
        [bevy_clamber::clamber_surface::geometry::Affine::IDENTITY; 2],
    );
    let far =
        bevy_clamber::clamber_surface::geometry::Similarity::from_translation(glam::DVec3::X * 9.0);
    surface.surface_mut().teleport(&palette, far).unwrap();
    app.update();
    let surface = app.world().get::<PosedSurface>(limb.mesh).unwrap();
    assert_eq!(surface.world_from_model().translation.x, 0.0);
}
