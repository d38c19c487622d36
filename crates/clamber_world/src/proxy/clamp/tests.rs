use clamber_surface::geometry::rotation_from_axis_angle;
use fastrand::Rng;
use glam::{DQuat, Vec3};
use parry3d::math::Pose;
use parry3d::shape::{Ball, Capsule, Compound, Cuboid, SharedShape};

use super::*;
use crate::testing::point;

/// A moving climber of a size, for a physics engine.
fn climber(rng: &mut Rng, size: f64) -> ProxyBody {
    let axis = [DVec3::ZERO, DVec3::Y, point(rng, 1.0)][rng.usize(0..3)] * size;
    let first = point(rng, size);
    ProxyBody {
        capsule: WorldCapsule {
            ends: [first, first + axis],
            radius: 0.4 * size,
        },
        margin: 0.01 * size,
        mass: 80.0,
        velocity: DVec3::ZERO,
        drift: point(rng, 5.0 * size),
        frame_velocity: DVec3::ZERO,
        up: DVec3::Y,
        support_normal: None,
        gentle: 0.0,
        support: None,
    }
}

/// A rotation by a vector: the axis times radians.
fn turned(by: DVec3) -> DQuat {
    let angle = by.length();
    if angle > 0.0 {
        rotation_from_axis_angle(by / angle, angle)
    } else {
        DQuat::IDENTITY
    }
}

fn turn(rng: &mut Rng) -> DQuat {
    turned(point(rng, 2.0))
}

/// A pose within reach of a climber of a size.
fn pose(rng: &mut Rng, size: f64) -> RigidPose {
    RigidPose {
        rotation: turn(rng),
        translation: point(rng, 4.0 * size),
    }
}

/// Shapes in the middle of their body or beside it.
fn shapes(rng: &mut Rng, size: f32) -> Vec<(SharedShape, RigidPose)> {
    let side = |rng: &mut Rng| size * (0.05 + rng.f32());
    let cuboid = Cuboid::new(Vec3::new(side(rng), side(rng), side(rng)));
    let beside = Pose::from_translation(Vec3::X * size);
    let both = vec![
        (beside, SharedShape::new(Ball::new(side(rng)))),
        (Pose::IDENTITY, SharedShape::new(cuboid)),
    ];
    let shape = match rng.u8(0..4) {
        0 => SharedShape::new(Ball::new(side(rng))),
        1 => SharedShape::new(cuboid),
        2 => SharedShape::new(Capsule::new(Vec3::X * side(rng), Vec3::Y, side(rng))),
        _ => SharedShape::new(Compound::new(both)),
    };
    let aside = point(rng, f64::from(size)) * f64::from(rng.u8(0..2));
    let pose = RigidPose {
        rotation: turn(rng),
        translation: aside,
    };
    vec![(shape, pose)]
}

fn solids(
    shapes: &[(SharedShape, RigidPose)],
) -> impl Iterator<Item = (&dyn Shape, RigidPose)> + Clone {
    shapes.iter().map(|(shape, pose)| (&**shape, *pose))
}

#[test]
fn what_is_passed_over_as_far_away_does_not_touch() {
    let mut rng = Rng::with_seed(11);
    let (mut far, mut touched) = (0, 0);
    for round in 0..20_000 {
        let size = [0.02, 1.0, 100.0][round % 3];
        let climber = climber(&mut rng, size);
        let shapes = shapes(&mut rng, size as f32);
        let [from, to] = [(); 2].map(|()| pose(&mut rng, size));
        let path = [from.translation, to.translation - climber.drift * 0.1];
        let capsule = &climber.capsule;
        let is_far = solids(&shapes).all(|solid| is_far(solid, path, capsule));
        let touch = climber.entered(capsule, [&from, &to], solids(&shapes), 0.1);
        assert!(!is_far || touch.is_none(), "round {round}");
        far += u32::from(is_far);
        touched += u32::from(touch.is_some());
    }
    assert!(far > 2_000 && touched > 2_000, "{far}, {touched}");
}

#[test]
fn a_stopped_body_is_in_the_layer_around_the_climber_and_not_in_it() {
    let mut rng = Rng::with_seed(12);
    let (mut stopped, dt) = (0, 0.1);
    for round in 0..20_000 {
        let size = [0.02, 1.0, 100.0][round % 3];
        let climber = climber(&mut rng, size);
        // Every body that touches the climber has come by itself, and no body is ground for it.
        let climber = ProxyBody {
            frame_velocity: climber.drift,
            up: DVec3::ZERO,
            ..climber
        };
        let shapes = shapes(&mut rng, size as f32);
        let [from, mut to] = [(); 2].map(|()| pose(&mut rng, size));
        let turns = point(&mut rng, 1.0).normalize() * rng.f64();
        to.rotation = turned(turns) * from.rotation;
        if deepest(&from, solids(&shapes), &climber.capsule).is_some() {
            continue;
        }
        let Some(pose) = climber.stop(DVec3::ZERO, [&from, &to], solids(&shapes), dt) else {
            continue;
        };
        stopped += 1;
        let after = climber.capsule.moved(climber.drift * dt);
        let depth = deepest(&pose, solids(&shapes), &after).map_or(0.0, |(depth, _)| depth);
        assert_eq!(depth, 0.0, "round {round}");
    }
    assert!(stopped > 2_000, "{stopped}");
}

#[test]
fn numbers_that_are_not_finite_stop_nothing() {
    let sound = ProxyBody {
        drift: DVec3::ZERO,
        ..climber(&mut Rng::with_seed(13), 1.0)
    };
    let at = |x: f64| RigidPose {
        rotation: DQuat::IDENTITY,
        translation: sound.capsule.ends[0] + DVec3::X * x,
    };
    let (from, to) = (at(3.0), at(-3.0));
    let ball = vec![(SharedShape::new(Ball::new(0.2)), RigidPose::IDENTITY)];
    let stop = |climber: &ProxyBody, origin, poses: [&RigidPose; 2], dt| {
        climber.stop(origin, poses, solids(&ball), dt)
    };
    assert!(stop(&sound, DVec3::ZERO, [&from, &to], 0.1).is_some());
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
        let told = format!("{x}");
        let lost = |axis: DVec3| ProxyBody {
            drift: axis * x,
            ..sound
        };
        let mut results = vec![
            stop(&lost(DVec3::X), DVec3::ZERO, [&from, &to], 0.1),
            stop(&sound, DVec3::Z * x, [&from, &to], 0.1),
            stop(&sound, DVec3::ZERO, [&at(x), &to], 0.1),
            stop(&sound, DVec3::ZERO, [&from, &at(x)], 0.1),
        ];
        // Only the body itself moves.
        let by_time = stop(&sound, DVec3::ZERO, [&from, &to], x);
        assert!(
            by_time.is_none_or(|pose| pose.translation.is_finite()),
            "{told}"
        );
        let wide = ProxyBody { margin: x, ..sound };
        results.push(stop(&wide, DVec3::ZERO, [&from, &to], 0.1));
        for (index, result) in results.iter().enumerate() {
            assert!(result.is_none(), "{told}, {index}: {result:?}");
        }
    }
}
