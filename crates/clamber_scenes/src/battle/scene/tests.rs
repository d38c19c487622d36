//! Rocks and riders that get lost are brought back, at rest.

use clamber_world::rapier3d::prelude::Vector;

use super::super::checks::{FALLS, ROCKS_INSIDE};
use super::*;
use crate::beast::beast;

fn with_battle<R>(rocks: u32, test: impl FnOnce(&mut Battle<'_>) -> R) -> R {
    let creature = beast(1_000);
    let options = BattleOptions {
        height: Some(20.0),
        ..BattleOptions::ride(rocks, 1)
    };
    test(&mut Battle::new(&creature, &options).unwrap())
}

/// Moves the first rock to a place, spinning and fast, and steps once. Returns its speed, its spin and its distance
/// from the climber.
fn throw_a_rock(battle: &mut Battle<'_>, to: DVec3) -> [f64; 3] {
    let rock = battle.rocks.bodies()[0];
    let body = &mut battle.world.bodies[rock];
    body.set_translation(to.as_vec3(), true);
    body.set_linvel(Vector::new(30.0, -50.0, 0.0), true);
    body.set_angvel(Vector::new(0.0, 200.0, 0.0), true);
    battle.step(Intent::Stand).unwrap();
    let body = &battle.world.bodies[rock];
    let place = body.translation().as_dvec3();
    [
        f64::from(body.linvel().length()),
        f64::from(body.angvel().length()),
        place.distance(battle.climber.state().position),
    ]
}

#[test]
fn a_rock_out_of_the_valley_is_counted_apart_and_falls_again_from_rest() {
    with_battle(3, |battle| {
        let drops = battle.rocks.report().drops;
        let out = DVec3::new(valley::SIZE, -20.0, 0.0);
        let [speed, spin, away] = throw_a_rock(battle, out);
        let report = *battle.rocks.report();
        assert_eq!((report.left, report.fell_through), (1, 0));
        assert_eq!(report.drops, drops + 1);
        assert!(
            speed == 0.0 && spin == 0.0,
            "{speed} m/s, {spin} radians a second"
        );
        assert!(away < 20.0, "{away} m from the rider");
        assert!(battle.watch.faults.first(ROCKS_INSIDE).is_none());
    });
}

#[test]
fn a_rock_under_the_ground_is_a_fault_and_counts_once() {
    with_battle(3, |battle| {
        throw_a_rock(battle, DVec3::new(5.0, -3.0, 5.0));
        for _ in 0..40 {
            battle.step(Intent::Stand).unwrap();
        }
        let report = *battle.rocks.report();
        assert_eq!((report.left, report.fell_through), (0, 1));
        let cause = battle.watch.faults.first(ROCKS_INSIDE).unwrap();
        assert!(cause.contains("rock 0 below the ground"), "{cause}");
    });
}

#[test]
fn a_rider_out_of_the_valley_is_dropped_again_with_the_velocity_of_the_creature_as_a_whole() {
    with_battle(0, |battle| {
        // The beast walks by now.
        for _ in 0..600 {
            battle.step(Intent::Stand).unwrap();
        }
        let lost = ClimberState {
            position: DVec3::new(valley::SIZE, 80.0, 0.0),
            velocity: DVec3::new(45.0, 0.0, 0.0),
            ..*rider_above(DVec3::ZERO, 0.0).unwrap().state()
        };
        battle.climber.restore(lost).unwrap();
        battle.step(Intent::Stand).unwrap();
        assert_eq!((battle.drops, battle.watch.falls), (2, 1));
        let state = battle.climber.state();
        assert_eq!(state.velocity, battle.choreography.velocity());
        let speed = state.velocity.length();
        assert!((1.0..10.0).contains(&speed), "{speed} m/s");
        assert!(battle.watch.faults.first(FALLS).is_some());
    });
}
