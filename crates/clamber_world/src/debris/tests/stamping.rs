use clamber_surface::geometry::rotation_from_axis_angle;
use glam::{DVec3, Vec3};
use rapier3d::parry::utils::Array2;
use rapier3d::prelude::*;

use super::scene::{DT, Scene, at, lifted, slab};

/// Half the size of the foot, metres.
const HALF: Vec3 = Vec3::new(1.2, 1.0, 1.2);

/// Height of the sole over the ground: it comes down at `speed` metres a second, stands and lifts again.
fn sole(seconds: f64, speed: f64) -> f64 {
    let down = 1.8 - speed * (seconds - 0.5).max(0.0);
    let up = speed.min(4.0) * (seconds - 5.0).max(0.0);
    down.max(-0.05) + up.min(3.0)
}

/// The foot comes down on a rock on level ground, stands and lifts; beside the rock again, it shoves the rock aside.
/// True if the foot came down on the rock.
fn stamp(shape: &ColliderBuilder, start: Pose, speed: f64, tilt: f64, plate: bool) -> bool {
    let mut scene = Scene::new(slab(HALF, 0.5, 2));
    if plate {
        // Ground without an inside.
        let flat = Array2::new(21, 21, vec![0.0; 441]);
        let ground = ColliderBuilder::heightfield(flat, Vector::new(400.0, 1.0, 400.0));
        scene.world.insert_collider(ground, None);
    } else {
        scene.ground(0.0);
    }
    let (rock, _) = scene.drop(shape.clone(), Vector::ZERO);
    scene.world.bodies[rock].set_position(start, true);
    // A rock that a tilted sole squeezes out must stop rolling.
    scene.world.bodies[rock].set_angular_damping(5.0);
    let kind = shape.shape.shape_type();
    let case = format!("plate {plate}, {kind:?} at {start:?}, {speed} m/s, tilt {tilt}");
    let still = lifted(2, |_| 0.0);
    let foot = |tick: u32| {
        let height = sole(f64::from(tick) * DT, speed) + f64::from(HALF.y);
        at(DVec3::Y * height, DVec3::Z, tilt)
    };
    scene.surface.teleport(&still, foot(0)).unwrap();
    for tick in 0..660 {
        scene.tick(&still, foot(tick));
        let place = scene.world.bodies[rock].translation();
        assert!(place.y > 0.0, "{case}: at {place} in tick {tick}");
    }
    let place = scene.world.bodies[rock].translation();
    assert!(place.y < 0.9, "{case}: carried up to {place}");
    assert!(scene.depth(rock, HALF) < 0.0, "{case}: in the foot");
    let body = &mut scene.world.bodies[rock];
    let (along, up) = (body.linvel().length(), body.linvel().y.abs());
    assert!(along < 1.0 && up < 0.1, "{case}: {along} m/s, {up} up");
    body.set_linvel(Vector::ZERO, true);
    body.set_angvel(Vector::ZERO, true);
    let stamped = scene.caught > 0;
    assert!(!scene.debris.is_let_through(rock), "{case}");
    // The foot collides with the rock again.
    let from = f64::from(place.x - HALF.x) - 1.0;
    let beside = |x: f64| at(DVec3::new(x, 1.1, f64::from(place.z)), DVec3::Y, 0.0);
    scene.surface.teleport(&still, beside(from)).unwrap();
    for tick in 1..=120 {
        let x = from + 2.0 * DT * f64::from(tick);
        scene.tick(&still, beside(x));
    }
    let pushed = scene.world.bodies[rock].translation().x - place.x;
    assert!(pushed > 1.5, "{case}: pushed by {pushed}");
    stamped
}

#[test]
fn a_rock_under_a_stamping_foot_is_not_driven_into_the_ground_and_stays_there() {
    let mut rng = fastrand::Rng::with_seed(1);
    let mut between = |low: f32, high: f32| low + (high - low) * rng.f32();
    let (mut all, mut stamped) = (0, 0);
    for round in 0..20 {
        let size = between(0.25, 0.7);
        let shapes = [
            ColliderBuilder::ball(size * 0.5),
            ColliderBuilder::cuboid(size, size * 0.7, size * 0.8),
            ColliderBuilder::capsule_x(size, size * 0.4),
        ];
        let place = Vector::new(between(-0.8, 0.8), 0.7, between(-0.8, 0.8));
        let axis = Vector::new(between(-1.0, 1.0), between(-1.0, 1.0), 1.0).normalize();
        let turn = rotation_from_axis_angle(axis.as_dvec3(), f64::from(between(0.0, 3.0)));
        let start = Pose::from_parts(place, turn.as_quat());
        let tilt = f64::from(between(-0.4, 0.4));
        for shape in &shapes {
            for speed in [0.5, 4.0, 30.0] {
                all += 1;
                stamped += usize::from(stamp(shape, start, speed, tilt, round % 2 == 0));
            }
        }
    }
    assert!(stamped * 2 > all, "{stamped} of {all}");
}
