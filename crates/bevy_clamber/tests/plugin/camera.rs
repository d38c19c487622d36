//! The camera keeps out of skin, comes near at once and goes back slowly, and does not lag on what moves.

use std::time::Duration;

use bevy_app::{App, PostUpdate, Update};
use bevy_clamber::clamber_climber::ClimberMode;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Quat, Vec2, Vec3};
use bevy_time::{Time, TimeUpdateStrategy};
use bevy_transform::components::Transform;

use super::common::{self, LYING, app_with, limb};

#[derive(Component)]
struct Moving(Vec3);

fn carry(time: Res<Time>, mut roots: Query<(&mut Transform, &Moving)>) {
    for (mut root, moving) in &mut roots {
        root.translation += moving.0 * time.delta_secs();
    }
}

/// What a frame drew: the camera, its distance from the nearest skin, and the climber.
#[derive(Clone, Copy, Debug)]
struct Seen {
    camera: DVec3,
    off_skin: f32,
    climber: DVec3,
}

#[derive(Resource, Default)]
struct Frames(Vec<Seen>);

fn note(
    cameras: Query<(&ClimberCamera, &Transform)>,
    climbers: Query<&Transform, With<Climber>>,
    surfaces: DrawnSurfaceQuery,
    mut frames: ResMut<Frames>,
) {
    for (camera, transform) in &cameras {
        let near = surfaces.closest_point(transform.translation, 99.0, &SurfaceFilter::default());
        frames.0.push(Seen {
            camera: transform.translation.as_dvec3(),
            off_skin: near.map_or(99.0, |near| near.distance),
            climber: climbers.get(camera.target).unwrap().translation.as_dvec3(),
        });
    }
}

/// A climber on a floor of 20 m by 4 m at a height of 2 m, and a camera.
fn scene(make: impl Fn(Entity) -> ClimberCamera) -> (App, Entity, Entity, Entity) {
    let plugins = (
        ClamberPlugins::default(),
        ClimberPlugin::default(),
        ClimberCameraPlugin,
    );
    let mut app = app_with(144.0, plugins);
    app.init_resource::<Frames>()
        .add_systems(Update, carry)
        .add_systems(PostUpdate, note.after(ClamberSystems::Follow));
    let lying = Transform::from_rotation(LYING).with_scale(Vec3::splat(10.0));
    let floor = limb(&mut app, lying, SkinnedCollider::default());
    // The floor itself stays as it is.
    let mut joint = app.world_mut().entity_mut(floor.joints[1]);
    joint.remove::<common::Bending>();
    let climber = (
        Climber::colossus_climber(),
        Transform::from_xyz(10.0, 2.5, 0.0),
    );
    let climber = app.world_mut().spawn(climber).id();
    let camera = app.world_mut().spawn(make(climber)).id();
    frames(&mut app, 144);
    let state = app.world().get::<ClimberState>(climber).unwrap();
    assert_eq!(state.mode, ClimberMode::Standing);
    (app, floor.root, climber, camera)
}

fn frames(app: &mut App, count: usize) -> Vec<Seen> {
    app.world_mut().resource_mut::<Frames>().0.clear();
    for _ in 0..count {
        app.update();
    }
    std::mem::take(&mut app.world_mut().resource_mut::<Frames>().0)
}

#[test]
fn a_camera_keeps_its_distance_from_skin_while_it_is_turned_and_the_climber_walks() {
    let (mut app, _, climber, camera) = scene(ClimberCamera::new);
    // Two more limbs stand beside the floor, and one waves through where the camera would be.
    for (x, z) in [(8.0, 4.0), (13.0, -3.5)] {
        let standing = Transform::from_xyz(x, 0.0, z).with_scale(Vec3::splat(5.0));
        limb(&mut app, standing, SkinnedCollider::default());
    }
    app.add_systems(Update, common::animate);
    let mut random = fastrand::Rng::with_seed(1);
    let (mut near, mut all) = (0, 0);
    for _ in 0..100 {
        let angle = random.f64() * core::f64::consts::TAU;
        let mut input = app.world_mut().get_mut::<ClimberInput>(climber).unwrap();
        let at = libm::cos(angle);
        input.walk = Vec3::new(at as f32, 0.0, 0.3 * libm::sin(angle) as f32) * 0.5;
        let mut turn = app
            .world_mut()
            .get_mut::<ClimberCameraInput>(camera)
            .unwrap();
        turn.stick = Vec2::new(random.f32() * 2.0 - 1.0, random.f32() * 2.0 - 1.0);
        for seen in frames(&mut app, 72) {
            assert!(seen.camera.is_finite());
            all += 1;
            near += usize::from(seen.off_skin < 0.2);
            assert!(seen.camera.distance(seen.climber) < 9.0, "{seen:?}");
        }
    }
    println!("{near} of {all} frames within 0.2 m of skin");
    assert!(
        near * 1000 <= all,
        "{near} of {all} frames within 0.2 m of skin"
    );
}

#[test]
fn a_camera_begins_behind_its_climber() {
    let (mut app, _, _, _) = scene(ClimberCamera::new);
    for degrees in [0.0f32, 50.0, 130.0, 180.0, -100.0] {
        let half = 0.5 * degrees.to_radians();
        let turned = Quat::from_xyzw(0.0, libm::sinf(half), 0.0, libm::cosf(half));
        let place = Transform::from_xyz(10.0, 2.5, 0.0).with_rotation(turned);
        let climber = app.world_mut().spawn((Climber::default(), place)).id();
        let camera = app.world_mut().spawn(ClimberCamera::new(climber)).id();
        frames(&mut app, 6);
        let looks = app.world().get::<Transform>(camera).unwrap().forward();
        let (looks, ahead) = (looks.with_y(0.0).normalize(), place.forward());
        assert!(looks.distance(*ahead) < 1e-3, "{degrees}: {looks} {ahead}");
        app.world_mut().despawn(climber);
        app.world_mut().despawn(camera);
    }
}

#[test]
fn a_camera_comes_near_at_once_and_goes_back_over_half_a_second() {
    let (mut app, _, _, _) = scene(ClimberCamera::new);
    let far = frames(&mut app, 1)[0];
    let distance = |seen: &Seen| seen.camera.distance(seen.climber + DVec3::Y);
    assert!((distance(&far) - 7.0).abs() < 0.01, "{}", distance(&far));
    // A wall between climber and camera: a limb that stands in the way.
    let way = (far.camera - far.climber).as_vec3();
    let at = far.climber.as_vec3() + way * 0.5;
    let wall = Transform::from_xyz(at.x, at.y - 5.0, at.z).with_scale(Vec3::splat(5.0));
    let wall = limb(&mut app, wall, SkinnedCollider::default());
    let near = frames(&mut app, 14);
    assert!(
        distance(near.last().unwrap()) < 4.0,
        "{}",
        distance(near.last().unwrap())
    );
    app.world_mut().entity_mut(wall.root).despawn();
    let back = frames(&mut app, 288);
    let reached = |share: f64| {
        let start = distance(&back[0]);
        let end = start + (7.0 - start) * share;
        back.iter().position(|seen| distance(seen) >= end).unwrap() as f64 / 144.0
    };
    assert!(reached(0.9) > 0.4 && reached(0.9) < 0.8, "{}", reached(0.9));
    assert!(reached(0.5) > 0.1, "{}", reached(0.5));
}

#[test]
fn a_camera_stays_away_from_a_climber_below_an_overhang() {
    for lean in [10.0f32, 25.0, 40.0] {
        let (mut app, _, climber, _) = scene(ClimberCamera::new);
        // Leans over the climber, which runs against it. The camera has free way behind the climber.
        let half = 0.5 * lean.to_radians();
        let lean_over = Quat::from_xyzw(libm::sinf(half), 0.0, 0.0, libm::cosf(half));
        let wall = Transform::from_xyz(10.0, 0.0, -4.0)
            .with_rotation(lean_over)
            .with_scale(Vec3::splat(5.0));
        limb(&mut app, wall, SkinnedCollider::default());
        let mut input = app.world_mut().get_mut::<ClimberInput>(climber).unwrap();
        input.walk = Vec3::NEG_Z;
        frames(&mut app, 288);
        let seen = frames(&mut app, 144);
        let nearest = seen
            .iter()
            .map(|seen| seen.camera.distance(seen.climber))
            .fold(f64::MAX, f64::min);
        assert!(nearest > 5.0, "leaning by {lean} degrees: {nearest}");
    }
}

#[test]
fn a_camera_does_not_lag_on_a_fast_creature() {
    let (mut app, root, climber, _) = scene(ClimberCamera::new);
    let before = frames(&mut app, 1)[0];
    let mut speed = 0.0;
    app.world_mut().entity_mut(root).insert(Moving(Vec3::ZERO));
    while speed < 30.0 {
        speed += 0.02;
        app.world_mut().get_mut::<Moving>(root).unwrap().0 = Vec3::new(speed, 0.0, 0.1 * speed);
        app.update();
    }
    for seen in frames(&mut app, 144) {
        let offset = (seen.camera - seen.climber) - (before.camera - before.climber);
        assert!(offset.length() < 0.01, "{offset}");
    }
    let state = app.world().get::<ClimberState>(climber).unwrap();
    assert_eq!(state.mode, ClimberMode::Standing);
    assert!(state.velocity.x > 29.0);
}

#[test]
fn a_stick_turns_and_a_mouse_swings() {
    for (make, fastest, at_once) in [
        (ClimberCamera::new as fn(Entity) -> ClimberCamera, 3.0, true),
        (ClimberCamera::like_2005, 5.236, false),
    ] {
        let (mut app, _, _, camera) = scene(make);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(
            10,
        )));
        let yaw = |app: &App| {
            let ahead = app.world().get::<Transform>(camera).unwrap().forward();
            libm::atan2f(-ahead.x, -ahead.z)
        };
        let turn = |app: &mut App, stick: Vec2, count: usize| {
            app.world_mut()
                .get_mut::<ClimberCameraInput>(camera)
                .unwrap()
                .stick = stick;
            let mut turned = 0.0f32;
            for _ in 0..count {
                let before = yaw(app);
                app.update();
                let mut step = before - yaw(app);
                if step > core::f32::consts::PI {
                    step -= core::f32::consts::TAU;
                }
                if step < -core::f32::consts::PI {
                    step += core::f32::consts::TAU;
                }
                turned += step;
            }
            turned
        };
        // To the right, at full speed.
        let first = turn(&mut app, Vec2::X, 10);
        let expected = if at_once {
            0.3
        } else {
            0.5 * 5.236 / 0.87 * 0.01
        };
        assert!(
            (first - expected).abs() < 0.25 * expected,
            "{first} {expected}"
        );
        turn(&mut app, Vec2::X, 90);
        let fast = turn(&mut app, Vec2::X, 100);
        assert!((fast - fastest).abs() < 0.02, "{fast}");
        turn(&mut app, Vec2::ZERO, 100);
        let still = turn(&mut app, Vec2::ZERO, 10);
        assert!(still.abs() < 1e-3, "{still}");
        // A mouse turns at once, and only once.
        let mut input = app
            .world_mut()
            .get_mut::<ClimberCameraInput>(camera)
            .unwrap();
        input.swing = Vec2::new(0.5, 0.0);
        let swung = turn(&mut app, Vec2::ZERO, 5);
        assert!((swung - 0.5).abs() < 1e-3, "{swung}");
        // Nothing that a broken device says gets through.
        turn(&mut app, Vec2::splat(f32::NAN), 3);
        assert!(app.world().get::<Transform>(camera).unwrap().is_finite());
    }
}
