//! Frames that come unevenly, hitches, pauses and changes of speed: the skin moves evenly, and who stands on it feels
//! nothing.

use std::time::Duration;

use bevy_app::{App, FixedPostUpdate, Update};
use bevy_clamber::clamber_climber::ClimberMode;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::{Time, TimeUpdateStrategy, Virtual};
use bevy_transform::components::Transform;

use super::common::{self, app_with, limb};

/// Metres a second that the creature moves along X.
const SPEED: f64 = 2.0;

#[derive(Component)]
struct Walking;

fn walk(time: Res<Time>, mut roots: Query<&mut Transform, With<Walking>>) {
    for mut root in &mut roots {
        root.translation.x = (SPEED * time.elapsed_secs_f64()) as f32;
    }
}

/// What a rider saw in each tick: how fast its support was and how much it shook, or `None` while it had none.
#[derive(Resource, Default)]
struct Felt(Vec<Option<(f64, f64)>>);

fn feel(climbers: Query<&ClimberState>, mut felt: ResMut<Felt>) {
    for state in &climbers {
        let on = state.support.is_some() && state.mode == ClimberMode::Standing;
        felt.0.push(on.then(|| {
            (
                state.support_velocity.map_or(f64::NAN, |v| v.x),
                state.shake.length(),
            )
        }));
    }
}

/// A creature that walks under a climber, after it has settled.
fn ride() -> App {
    let mut app = app_with(60.0, (ClamberPlugins::default(), ClimberPlugin::default()));
    app.add_systems(Update, walk);
    let lying = Transform::from_rotation(common::LYING).with_scale(Vec3::splat(10.0));
    let floor = limb(&mut app, lying, SkinnedCollider::default());
    app.world_mut().entity_mut(floor.root).insert(Walking);
    app.update();
    let x = app
        .world()
        .get::<Transform>(floor.root)
        .unwrap()
        .translation
        .x;
    let at = Transform::from_xyz(x + 10.0, 2.5, 0.0);
    app.world_mut().spawn((Climber::colossus_climber(), at));
    for _ in 0..240 {
        app.update();
    }
    app.init_resource::<Felt>()
        .add_systems(FixedPostUpdate, feel.after(ClamberSystems::Climb));
    app
}

fn frame(app: &mut App, milliseconds: f64) {
    let length = Duration::from_secs_f64(milliseconds / 1000.0);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(length));
    app.update();
}

/// Checks what the rider felt: it never lost its feet, and shook by at most so much; its speed, where it is known, was
/// within a share of the creature's.
fn check(app: &mut App, what: &str, shake: f64, share: f64) {
    let felt = std::mem::take(&mut app.world_mut().resource_mut::<Felt>().0);
    assert!(!felt.is_empty(), "{what}: no ticks");
    for (tick, felt) in felt.iter().enumerate() {
        let Some((speed, shook)) = felt else {
            panic!("{what}: lost its feet in tick {tick}");
        };
        assert!(*shook <= shake, "{what}: shaken by {shook} in tick {tick}");
        let apart = (speed / SPEED - 1.0).abs();
        assert!(
            speed.is_nan() || *speed == 0.0 || apart <= share,
            "{what}: {speed} m/s in tick {tick}"
        );
    }
    let unknown = felt
        .iter()
        .flatten()
        .filter(|(speed, _)| speed.is_nan() || *speed == 0.0)
        .count();
    println!(
        "{what}: {} ticks, {unknown} placed, worst {:?}",
        felt.len(),
        felt.iter().flatten().map(|f| f.1).fold(0.0, f64::max)
    );
}

#[test]
fn with_jitter_the_skin_is_within_a_hundredth_of_its_speed() {
    for (low, high) in [(15.67, 17.67), (10.0, 23.0), (4.0, 8.0), (25.0, 40.0)] {
        let mut app = ride();
        let mut random = fastrand::Rng::with_seed(5);
        let mut frames = |app: &mut App, count: usize| {
            for _ in 0..count {
                frame(app, low + (high - low) * random.f64());
            }
        };
        frames(&mut app, 100);
        app.world_mut().resource_mut::<Felt>().0.clear();
        frames(&mut app, 1000);
        check(&mut app, &format!("{low} to {high} ms"), 1.0, 0.01);
    }
}

#[test]
fn hitches_are_not_felt() {
    for hitch in [34.0, 50.0, 100.0, 250.0, 2000.0] {
        let mut app = ride();
        for _ in 0..15 {
            frame(&mut app, hitch);
            for _ in 0..50 {
                frame(&mut app, 1000.0 / 60.0);
            }
        }
        check(&mut app, &format!("hitch of {hitch} ms"), 1.0, 0.01);
    }
}

/// Frames and ticks meet in any phase: of 60 frames and 64 ticks a second there are 15.
#[test]
fn pauses_and_changes_of_speed_are_not_felt() {
    for phase in 0..15 {
        let mut app = ride();
        for _ in 0..phase {
            frame(&mut app, 1000.0 / 60.0);
        }
        change_speed(&mut app);
    }
}

fn change_speed(app: &mut App) {
    for (speed, paused) in [
        (1.0, true),
        (1.0, false),
        (0.2, false),
        (5.0, false),
        (1.0, false),
        (0.0, false),
        (1.0, false),
    ] {
        let mut time = app.world_mut().resource_mut::<Time<Virtual>>();
        time.set_relative_speed(speed);
        if paused {
            time.pause();
        } else {
            time.unpause();
        }
        for _ in 0..60 {
            frame(app, 1000.0 / 60.0);
        }
        if !paused && speed > 0.0 {
            check(app, &format!("{speed} times as fast"), 1.0, 0.01);
        }
    }
}

#[test]
fn slower_and_faster_frames_are_not_felt() {
    let mut app = ride();
    for rate in [30.0, 144.0, 20.0, 60.0, 240.0] {
        for _ in 0..(2.0 * rate) as usize {
            frame(&mut app, 1000.0 / rate);
        }
        check(&mut app, &format!("{rate} frames a second"), 1.0, 0.01);
    }
}
