//! Climbers are drawn on the skin as it is drawn, evenly, at any frame rate and however far from the origin.

use std::time::Duration;

use bevy_app::{App, PostUpdate, Update};
use bevy_clamber::clamber_climber::ClimberMode;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Quat, Vec3};
use bevy_time::{Fixed, Time, TimeUpdateStrategy};
use bevy_transform::components::Transform;

use super::common::{self, app_with, limb};

/// Radius of the climber's ball.
const RADIUS: f64 = 0.4;

/// Metres that half a pixel is at 10 m in front of a camera, with 1,080 rows and a field of view of 60 degrees.
const HALF_A_PIXEL: f64 = 0.0053;

#[derive(Component)]
struct Creature;

/// A creature that strides along X, and sways.
fn stride(
    time: Res<Time>,
    origin: Res<WorldOrigin>,
    start: Res<Start>,
    mut roots: Query<&mut Transform, With<Creature>>,
) {
    let seconds = time.elapsed_secs_f64();
    let place = start.0 + DVec3::X * 3.0 * seconds + DVec3::Y * 0.3 * libm::sin(seconds * 4.0);
    for mut root in &mut roots {
        root.translation = (place - origin.0).as_vec3();
        root.rotation = yaw(0.5 * libm::sin(seconds)) * common::LYING;
    }
}

/// A rotation about +Y, radians.
fn yaw(angle: f64) -> Quat {
    let half = 0.5 * angle;
    Quat::from_xyzw(0.0, libm::sin(half) as f32, 0.0, libm::cos(half) as f32)
}

/// Where the creature starts, in world space.
#[derive(Resource, Default)]
struct Start(DVec3);

/// What a frame drew: the climber in world space, its distance from the drawn skin, and its place relative to the
/// creature's root.
#[derive(Clone, Copy, Debug)]
struct Drawn {
    position: DVec3,
    off_skin: f64,
    on_creature: DVec3,
    mode: ClimberMode,
}

#[derive(Resource, Default)]
struct Frames(Vec<Drawn>);

fn note(
    climbers: Query<(&Transform, &ClimberState)>,
    creatures: Query<&Transform, With<Creature>>,
    surfaces: DrawnSurfaceQuery,
    origin: Res<WorldOrigin>,
    mut frames: ResMut<Frames>,
) {
    for (transform, state) in &climbers {
        let near = surfaces.closest_point(transform.translation, 9.0, &SurfaceFilter::default());
        let root = creatures.iter().next().unwrap();
        let relative = (transform.translation - root.translation).as_dvec3();
        frames.0.push(Drawn {
            position: origin.0 + transform.translation.as_dvec3(),
            off_skin: near.map_or(f64::NAN, |near| f64::from(near.distance)) - RADIUS,
            on_creature: root.rotation.as_dquat().inverse() * relative,
            mode: state.mode,
        });
    }
}

fn app(start: DVec3, collider: SkinnedCollider) -> (App, Entity) {
    let mut app = app_with(144.0, (ClamberPlugins::default(), ClimberPlugin::default()));
    app.insert_resource(Time::<Fixed>::from_hz(60.0));
    app.insert_resource(Start(start))
        .insert_resource(WorldOrigin(start));
    app.init_resource::<Frames>();
    // No time passes while the collider is built, which takes more updates on a busy machine.
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    let lying = Transform::from_rotation(common::LYING);
    let creature = limb(&mut app, lying.with_scale(Vec3::splat(10.0)), collider);
    app.world_mut().entity_mut(creature.root).insert(Creature);
    app.add_systems(PostUpdate, note.after(ClamberSystems::Draw));
    rate(&mut app, 144.0);
    (app, creature.root)
}

fn climber(app: &mut App, at: Vec3) -> Entity {
    let climber = (Climber::colossus_climber(), Transform::from_translation(at));
    app.world_mut().spawn(climber).id()
}

fn frames(app: &mut App, count: usize) -> Vec<Drawn> {
    app.world_mut().resource_mut::<Frames>().0.clear();
    for _ in 0..count {
        app.update();
    }
    std::mem::take(&mut app.world_mut().resource_mut::<Frames>().0)
}

fn rate(app: &mut App, rate: f64) {
    let length = Duration::from_secs_f64(1.0 / rate);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(length));
}

#[test]
fn a_rider_is_drawn_on_the_drawn_skin_at_100_km() {
    for start in [DVec3::ZERO, DVec3::new(100e3, 0.0, -100e3)] {
        for fps in [30.0, 60.0, 144.0, 240.0] {
            let (mut app, creature) = app(start, SkinnedCollider::default());
            app.add_systems(Update, stride.before(note));
            rate(&mut app, fps);
            app.update();
            let root = *app.world().get::<Transform>(creature).unwrap();
            climber(&mut app, root.translation + Vec3::new(6.0, 3.0, 0.0));
            frames(&mut app, (1.5 * fps) as usize);
            let ridden = frames(&mut app, (3.0 * fps) as usize);
            let first = ridden[0].on_creature;
            let (mut worst, mut wander) = (0.0f64, 0.0f64);
            for drawn in &ridden {
                assert_eq!(drawn.mode, ClimberMode::Standing, "{fps}");
                worst = worst.max(drawn.off_skin.abs());
                wander = wander.max(drawn.on_creature.distance(first));
            }
            println!("{start} {fps}: {worst} m off the skin, wanders {wander} m");
            assert!(worst < 2e-3, "{start} {fps}: {worst} m off the skin");
            assert!(wander < HALF_A_PIXEL, "{start} {fps}: wanders {wander} m");
        }
    }
}

#[test]
fn the_origin_may_move_under_a_rider() {
    let (mut app, creature) = app(DVec3::ZERO, SkinnedCollider::default());
    app.add_systems(Update, stride);
    app.update();
    let root = *app.world().get::<Transform>(creature).unwrap();
    let rider = climber(&mut app, root.translation + Vec3::new(6.0, 3.0, 0.0));
    frames(&mut app, 300);
    for shift in [DVec3::new(100.0, 0.0, 0.0), DVec3::new(-4e4, 1e3, 7e3)] {
        let last = frames(&mut app, 2)[1];
        app.world_mut().resource_mut::<WorldOrigin>().0 += shift;
        let mut roots = app
            .world_mut()
            .query_filtered::<&mut Transform, Without<ChildOf>>();
        for mut root in roots.iter_mut(app.world_mut()) {
            root.translation -= shift.as_vec3();
        }
        let next = frames(&mut app, 1)[0];
        // A frame of 1/144 s.
        assert!(
            next.position.distance(last.position) < 0.1,
            "{last:?} {next:?}"
        );
        for drawn in frames(&mut app, 60) {
            assert_eq!(drawn.mode, ClimberMode::Standing);
            // The origin is far from the creature now: f32 has steps of 4 mm there.
            assert!(drawn.off_skin.abs() < 0.02, "{drawn:?}");
        }
        // The sway alone shakes by up to 5 m/s²; rounding to steps of 4 mm adds to it.
        let state = app.world().get::<ClimberState>(rider).unwrap();
        assert!(state.shake.length() < 8.0, "{}", state.shake);
    }
}

/// Largest change of a walker's drawn step from frame to frame, metres.
fn unevenness(walked: &[Drawn]) -> f64 {
    let steps: Vec<DVec3> = walked
        .windows(2)
        .map(|pair| pair[1].position - pair[0].position)
        .collect();
    let changes = steps.windows(2).map(|pair| pair[1].distance(pair[0]));
    changes.fold(0.0, f64::max)
}

#[test]
fn a_walker_on_still_ground_is_drawn_evenly() {
    for fps in [30.0, 60.0, 144.0, 240.0] {
        let (mut app, _) = app(DVec3::ZERO, SkinnedCollider::default());
        rate(&mut app, fps);
        app.update();
        let walker = climber(&mut app, Vec3::new(2.0, 2.5, 0.0));
        frames(&mut app, fps as usize);
        let mut input = app.world_mut().get_mut::<ClimberInput>(walker).unwrap();
        input.walk = Vec3::X;
        frames(&mut app, fps as usize);
        let walked = frames(&mut app, fps as usize);
        let worst = unevenness(&walked);
        println!("{fps}: {worst} m");
        assert!(worst < HALF_A_PIXEL, "{fps}: {worst}");
        assert!(walked.last().unwrap().position.x - walked[0].position.x > 2.0);
    }
}

#[test]
fn landing_on_a_creature_whose_skin_is_ahead_is_drawn_without_a_jump() {
    for (fps, phase) in (0..12).flat_map(|phase| [(60.0, phase), (144.0, phase)]) {
        let (mut app, creature) = app(DVec3::ZERO, SkinnedCollider::default());
        app.add_systems(Update, stride);
        // Frames begin at some time of a tick.
        let begins = f64::from(phase) / (12.0 * 60.0);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(
            begins,
        )));
        app.update();
        rate(&mut app, fps);
        app.update();
        let root = *app.world().get::<Transform>(creature).unwrap();
        let jumper = climber(&mut app, root.translation + Vec3::new(6.0, 4.0, 0.0));
        let landing = frames(&mut app, (1.5 * fps) as usize);
        let mut input = app.world_mut().get_mut::<ClimberInput>(jumper).unwrap();
        input.jump = true;
        let jump = frames(&mut app, (1.5 * fps) as usize);
        let all = [landing, jump].concat();
        assert!(all.iter().any(|drawn| drawn.mode == ClimberMode::Standing));
        let airborne = all
            .iter()
            .filter(|drawn| drawn.mode == ClimberMode::Falling)
            .count();
        assert!(airborne as f64 > 0.8 * fps, "{airborne}");
        // A climber that lands takes the skin's 3.6 m/s at once. The way that the skin is ahead, some 0.1 m, fades at 1
        // m/s at most. A jump of that way would be 6 m/s at 60 frames a second, and 14 m/s at 144.
        let steps: Vec<DVec3> = all
            .windows(2)
            .map(|pair| pair[1].position - pair[0].position)
            .collect();
        for pair in steps.windows(2) {
            let change = (pair[1] - pair[0]) * DVec3::new(1.0, 0.0, 1.0);
            assert!(change.length() < 4.6 / fps, "{fps}, {phase}: {change}");
        }
    }
}
