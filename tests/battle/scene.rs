//! Rocks, riders and climbers that get lost are brought back, at rest; brains are read from files.

use clamber::climber::{Climber, ClimberState};
use clamber::glam::DVec3;
use clamber::world::rapier3d::prelude::Vector;
use clamber_scenes::battle::{
    Battle, BattleOptions, FALLS, Intent, ROCKS_INSIDE, Story, TICK, Watch,
};
use clamber_scenes::giant::giant_of;
use clamber_scenes::{giant, valley};

fn with_battle<R>(rocks: u32, test: impl FnOnce(&mut Battle<'_>) -> R) -> R {
    let creature = giant_of(1_000).unwrap();
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
        place.distance(battle.climber().state().position),
    ]
}

#[test]
fn a_rock_out_of_the_valley_is_counted_apart_and_falls_again_from_rest() {
    with_battle(3, |battle| {
        let drops = battle.rocks.drops;
        let out = DVec3::new(valley::SIZE, -20.0, 0.0);
        let [speed, spin, away] = throw_a_rock(battle, out);
        let rocks = &battle.rocks;
        assert_eq!((rocks.left, rocks.faults.len()), (1, 0));
        assert_eq!(rocks.drops, drops + 1);
        assert!(
            speed == 0.0 && spin == 0.0,
            "{speed} m/s, {spin} radians a second"
        );
        assert!(away < 20.0, "{away} m from the rider");
    });
}

#[test]
fn a_rock_under_the_ground_is_a_fault_and_counts_once() {
    with_battle(3, |battle| {
        let mut watch = Watch::default();
        throw_a_rock(battle, DVec3::new(5.0, -3.0, 5.0));
        watch.tick(battle);
        for _ in 0..40 {
            battle.step(Intent::Stand).unwrap();
            watch.tick(battle);
        }
        assert_eq!((battle.rocks.left, watch.found(ROCKS_INSIDE)), (0, 1.0));
        let cause = watch.first_fault(ROCKS_INSIDE).unwrap();
        assert!(cause.contains("rock 0 below the ground"), "{cause}");
    });
}

#[test]
fn a_rider_out_of_the_valley_is_dropped_again_with_the_velocity_of_the_creature_as_a_whole() {
    with_battle(0, |battle| {
        // The giant walks by now.
        for _ in 0..600 {
            battle.step(Intent::Stand).unwrap();
        }
        let mut watch = Watch::default();
        watch.tick(battle);
        let lost = ClimberState {
            position: DVec3::new(valley::SIZE, 80.0, 0.0),
            velocity: DVec3::new(45.0, 0.0, 0.0),
            support: None,
            ..*Climber::new(*battle.climber().config(), DVec3::ZERO)
                .unwrap()
                .state()
        };
        for falls in [1, 2] {
            battle.restore(&battle.snapshot(), lost).unwrap();
            let before = battle.surface().world_from_model().translation;
            battle.step(Intent::Stand).unwrap();
            watch.tick(battle);
            let found = (battle.counts.drops, watch.found(FALLS));
            assert_eq!(found, (falls + 1, f64::from(falls)));
            let state = battle.climber().state();
            let moved = battle.surface().world_from_model().translation - before;
            assert_eq!(state.velocity, moved / TICK);
            let speed = state.velocity.length();
            assert!((1.0..10.0).contains(&speed), "{speed} m/s");
            assert!(watch.first_fault(FALLS).is_some());
        }
    });
}

/// A climb against the giant with this brain file.
fn climb(brain: Option<&str>) -> BattleOptions {
    BattleOptions {
        brain: brain.map(Into::into),
        rocks: 0,
        ..BattleOptions::default()
    }
}

/// Writes a brain file for the giant that has only these states, and begins with `start`.
fn brain_file(name: &str, states: &str) -> String {
    let text = std::fs::read_to_string(giant::brain_path()).unwrap();
    let mut file: serde_json::Value = serde_json::from_str(&text).unwrap();
    file["start"] = "start".into();
    file["states"] = serde_json::from_str(states).unwrap();
    let path = std::env::temp_dir().join(format!("clamber-{}-{name}.json", std::process::id()));
    std::fs::write(&path, file.to_string()).unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn a_climber_that_dies_or_is_lost_begins_again() {
    let giant = giant::giant().unwrap();
    let mut battle = Battle::new(&giant, &climb(None)).unwrap();
    let start = *battle.climber().state();
    let dead = ClimberState {
        hit_points: 0.0,
        ..start
    };
    let lost = ClimberState {
        position: DVec3::new(valley::SIZE, 0.0, 0.0),
        ..start
    };
    for (deaths, state) in [(1, dead), (2, lost)] {
        for _ in 0..240 {
            battle.step(Intent::Stand).unwrap();
        }
        assert!(battle.climber().state().position.distance(start.position) > 5.0);
        let mut snapshot = battle.snapshot();
        snapshot.arena.as_mut().unwrap().fighters[0].state.climber = state;
        battle.restore(&snapshot, state).unwrap();
        // It lies for a while first, or falls.
        let begins_again = (0..600).any(|_| {
            battle.step(Intent::Stand).unwrap();
            battle.counts.deaths == deaths
        });
        assert!(begins_again, "{deaths}");
        assert_eq!(*battle.climber().state(), start);
    }
}

#[test]
fn the_brain_of_a_file_decides_what_the_giant_does() {
    let giant = giant::giant().unwrap();
    let asleep = brain_file("asleep", r#"{ "start": { "act": "sleep" } }"#);
    let options = climb(Some(&asleep));
    let mut battle = Battle::new(&giant, &options).unwrap();
    std::fs::remove_file(asleep).unwrap();
    let mut highest = f64::NEG_INFINITY;
    for _ in 0..60 * 40 {
        battle.step(Intent::Stand).unwrap();
        let life = battle.life().unwrap();
        assert_eq!(life.kind().brain().path(life.state().current()), "start");
        highest = highest.max(battle.climber().state().position.y);
    }
    // Nothing shakes it off.
    assert!(highest > 15.0, "{highest}");
    let counts = &battle.counts;
    assert_eq!((counts.blows, counts.deaths), (0, 0));
}

#[test]
fn brains_that_cannot_be_used_say_why() {
    let giant = giant::giant().unwrap();
    let said = |options: &BattleOptions| Battle::new(&giant, options).err().unwrap().to_string();
    let missing = said(&climb(Some("/nowhere/brain.json")));
    assert!(missing.contains("/nowhere/brain.json"), "{missing}");
    let path = brain_file(
        "broken",
        r#"{ "start": { "act": { "once": "no such clip" } } }"#,
    );
    let broken = said(&climb(Some(&path)));
    assert!(broken.contains("no such clip"), "{broken}");
    let rides = BattleOptions {
        story: Some(Story::Ride),
        ..climb(Some(&path))
    };
    assert!(said(&rides).contains("--story climb"));
    std::fs::write(&path, "{ \"states\": ").unwrap();
    let cut = said(&climb(Some(&path)));
    std::fs::remove_file(&path).unwrap();
    assert!(cut.contains("line 1") && cut.contains(&path), "{cut}");
}
