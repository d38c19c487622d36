use rapier3d::prelude::*;

use super::*;
use crate::{BodyPoses, Obstacle, RapierTerrain};

static NO_POSES: BodyPoses = BodyPoses::new();

/// A box of random size and pose, whose centre is not at its body's origin.
fn free_box(rng: &mut fastrand::Rng, body: RigidBodyBuilder) -> (PhysicsWorld, RigidBodyHandle) {
    let mut world = PhysicsWorld {
        gravity: Vector::ZERO,
        ..PhysicsWorld::default()
    };
    let mut point =
        |size: f32| Vector::new(rng.f32() - 0.5, rng.f32() - 0.5, rng.f32() - 0.5) * size;
    let body = body.translation(point(10.0)).rotation(point(3.0));
    let half = point(1.0).abs() + Vector::splat(0.1);
    let collider = ColliderBuilder::cuboid(half.x, half.y, half.z)
        .translation(point(1.0))
        .rotation(point(3.0))
        .density(200.0);
    let (handle, _) = world.insert(body, collider);
    world.step();
    (world, handle)
}

fn touched(world: &PhysicsWorld, rng: &mut fastrand::Rng) -> crate::Contact {
    let terrain = RapierTerrain::of_world(world, &NO_POSES);
    let from = direction(rng) * 30.0;
    terrain.closest_point(from, f64::INFINITY).unwrap()
}

fn direction(rng: &mut fastrand::Rng) -> DVec3 {
    DVec3::new(rng.f64() - 0.5, rng.f64() - 0.5, rng.f64() - 0.5).normalize()
}

/// The speed that a contact's point gains along a direction, for each N s.
fn response(world: &PhysicsWorld, contact: &crate::Contact, along: DVec3) -> f64 {
    let terrain = RapierTerrain::of_world(world, &NO_POSES);
    terrain.inverse_effective_mass(&contact.material, along)
}

fn push(world: &mut PhysicsWorld, contact: &crate::Contact, impulse: DVec3) {
    let (bodies, colliders) = (&mut world.bodies, &world.colliders);
    apply_push(bodies, colliders, &contact.material, impulse);
}

/// The speed along an impulse that the point gains in the next step, for each N s.
fn response_by_step(
    world: &mut PhysicsWorld,
    body: RigidBodyHandle,
    contact: &crate::Contact,
    impulse: DVec3,
) -> f64 {
    let point = contact.point.as_vec3();
    let local = world.bodies[body].position().inverse_transform_point(point);
    push(world, contact, impulse);
    world.step();
    let dt = f64::from(world.integration_parameters.dt);
    let now = world.bodies[body].position().transform_point(local);
    (now - point).as_dvec3().dot(impulse.normalize()) / dt / impulse.length()
}

#[test]
fn responses_agree_with_rapiers_own_step() {
    let mut rng = fastrand::Rng::with_seed(81);
    for round in 0..200 {
        let (mut world, body) = free_box(&mut rng, RigidBodyBuilder::dynamic());
        let contact = touched(&world, &mut rng);
        let along = direction(&mut rng);
        let expected = response(&world, &contact, along);
        // Makes the point move by about a centimetre: far more than rounding, and with hardly any rotation.
        let impulse = along * (0.6 / expected);
        let seen = response_by_step(&mut world, body, &contact, impulse);
        assert!(
            (seen / expected - 1.0).abs() < 0.05,
            "{round}: {seen} for {expected}"
        );
    }
}

#[test]
fn impulses_change_velocities_by_exactly_the_response() {
    let mut rng = fastrand::Rng::with_seed(82);
    for round in 0..200 {
        let body = match round % 3 {
            0 => RigidBodyBuilder::dynamic(),
            1 => RigidBodyBuilder::dynamic().lock_rotations(),
            _ => RigidBodyBuilder::dynamic().enabled_translations(true, false, true),
        };
        let (mut world, handle) = free_box(&mut rng, body);
        let contact = touched(&world, &mut rng);
        let along = direction(&mut rng);
        let expected = response(&world, &contact, along);
        let impulse = along * 3.0;
        push(&mut world, &contact, impulse);
        let velocity = world.bodies[handle].velocity_at_point(contact.point.as_vec3());
        let seen = velocity.as_dvec3().dot(along) / 3.0;
        assert!(
            (seen - expected).abs() < 1e-5 * expected.max(0.1),
            "{round}: {seen} for {expected}"
        );
    }
}

#[test]
fn a_body_that_cannot_be_pushed_responds_with_zero_and_stays_unchanged() {
    let mut rng = fastrand::Rng::with_seed(83);
    let locked = RigidBodyBuilder::dynamic();
    let kinds = [
        RigidBodyBuilder::fixed(),
        RigidBodyBuilder::kinematic_velocity_based(),
        RigidBodyBuilder::kinematic_position_based(),
        locked.lock_translations().lock_rotations(),
    ];
    for body in kinds {
        let (mut world, handle) = free_box(&mut rng, body);
        let contact = touched(&world, &mut rng);
        assert_eq!(response(&world, &contact, DVec3::X), 0.0);
        let velocities = |world: &PhysicsWorld| {
            let body = &world.bodies[handle];
            (body.linvel(), body.angvel())
        };
        let before = velocities(&world);
        push(&mut world, &contact, DVec3::splat(100.0));
        assert_eq!(velocities(&world), before);
    }
    let (mut world, handle) = free_box(&mut rng, RigidBodyBuilder::dynamic());
    let contact = touched(&world, &mut rng);
    for bad in [DVec3::NAN, DVec3::INFINITY, DVec3::splat(1e200)] {
        assert_eq!(response(&world, &contact, bad), 0.0, "{bad}");
        push(&mut world, &contact, bad);
        assert_eq!(world.bodies[handle].linvel(), Vector::ZERO, "{bad}");
    }
    world.remove_body(handle);
    assert_eq!(response(&world, &contact, DVec3::X), 0.0);
    push(&mut world, &contact, DVec3::X);
}

#[test]
fn a_push_wakes_a_sleeping_body() {
    let mut rng = fastrand::Rng::with_seed(84);
    let (mut world, handle) = free_box(&mut rng, RigidBodyBuilder::dynamic().sleeping(true));
    let contact = touched(&world, &mut rng);
    assert!(world.bodies[handle].is_sleeping());
    push(&mut world, &contact, DVec3::X * 50.0);
    assert!(!world.bodies[handle].is_sleeping());
    assert!(world.bodies[handle].linvel().x > 0.0);
}
