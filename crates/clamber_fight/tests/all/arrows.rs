//! Arrows in an arena: plates break, the oldest arrows fall, and numbers are the same after a restore. Scenes B32, B36
//! and B57.

use crate::support;

use crate::support::{GIANT, HERO, PLATE, Slab, land, low_ground, moves, pressing, step};
use clamber_climber::ClimberInput;
use clamber_colossus::{CreatureConfig, CreatureEvent, Sense};
use clamber_fight::actions::{BOW, CUT, THROW};
use clamber_fight::{
    Arena, ArenaConfig, ArenaEvent, BowConfig, FighterConfig, ProjectileMotion, Weapon,
    creature_obstacle,
};
use glam::{DVec3, Vec3};

/// Direction in which archers shoot at the skin before their feet; not a unit vector.
const DOWN: DVec3 = DVec3::new(0.0, -1.0, 0.3);

/// A hero whose bow is fully drawn after one tick, without straying.
fn archer() -> FighterConfig {
    let bow = BowConfig {
        draw: 1.0 / 60.0,
        stray: 0.0,
        damage: 3.0,
        ..BowConfig::default()
    };
    FighterConfig {
        bow: Some(bow),
        ..FighterConfig::hero()
    }
}

/// Draws the bow, and shoots.
fn shoot(arena: &mut Arena, aim: DVec3) -> Vec<ArenaEvent> {
    let mut events = Vec::new();
    for actions in [BOW, BOW, 0] {
        events.extend(step(
            arena,
            &ClimberInput {
                actions,
                aim,
                ..ClimberInput::IDLE
            },
        ));
    }
    events
}

fn wait(arena: &mut Arena, ticks: u32) -> Vec<ArenaEvent> {
    (0..ticks)
        .flat_map(|_| step(arena, &ClimberInput::IDLE))
        .collect()
}

/// A slab with a plate that moves at a constant velocity for ten minutes.
fn moving() -> Slab {
    let way = Vec3::new(3.0, 0.5, -1.0);
    Slab {
        keys: moves(way, 600.0),
        plate: true,
        ..Slab::default()
    }
}

#[test]
fn an_arrow_that_breaks_its_plate_sticks_first_and_falls_as_fast_as_the_plate() {
    let on_plate = DVec3::new(3.0, PLATE + 1.0, 3.0);
    let mut arena = moving().arena(archer(), &[on_plate]);
    land(&mut arena);
    let mut events = shoot(&mut arena, DOWN);
    events.extend(wait(&mut arena, 3));
    // In the first tick, the arrow gets stuck and its hit breaks the plate. In the next tick, it comes loose, and the
    // creature reports that the plate staggered.
    let first = |is: fn(&ArenaEvent) -> bool| events.iter().position(is).unwrap();
    let stuck = first(|one| matches!(one, ArenaEvent::Stuck { .. }));
    let hit = first(|one| matches!(one, ArenaEvent::Hit { .. }));
    let loose = first(|one| matches!(one, ArenaEvent::CameLoose { .. }));
    assert!(stuck < hit && hit < loose, "{events:?}");
    assert_eq!(struck(&events), [(None, Some(0))]);
    let broke = ArenaEvent::Creature {
        creature: GIANT,
        event: CreatureEvent::Staggered {
            plate: 0,
            breaks: true,
        },
    };
    assert!(events.contains(&broke), "{events:?}");

    // The same shot again, to measure the arrow's velocity when it comes loose.
    let mut arena = moving().arena(archer(), &[on_plate]);
    land(&mut arena);
    shoot(&mut arena, DOWN);
    let falling = (0..10).find_map(|_| {
        wait(&mut arena, 1);
        match arena.projectiles().first()?.motion {
            ProjectileMotion::Falling { velocity, .. } => Some(velocity),
            _ => None,
        }
    });
    let (fell, plate) = (falling.unwrap(), DVec3::new(3.0, 0.5, -1.0));
    assert!((fell - plate).length() < 0.01 * plate.length(), "{fell}");
}

/// A cut and an arrow that hit a plate in the same tick do their damage in the order of their times.
#[test]
fn a_cut_and_an_arrow_in_one_tick_are_taken_by_their_times() {
    let on_plate = DVec3::new(3.0, PLATE + 1.0, 3.0);
    let mut orders = [0, 0];
    for wait_for in 0..20 {
        let mut config = archer();
        config.hit_stop = 0.0;
        let sword = config.sword.as_mut().unwrap();
        // The cut passes through the plate, and would break it alone.
        (sword.shoulder.y, sword.cut_damage) = (0.0, 3.0);
        let arena = moving();
        let mut arena = arena.arena(config, &[on_plate, on_plate + DVec3::new(1.0, 0.0, 0.0)]);
        land(&mut arena);
        wait(&mut arena, 30);
        let terrain = low_ground();
        let mut events = Vec::new();
        for tick in 0..40 {
            // One fighter shoots. The other one begins a cut earlier or later.
            let aim = DVec3::new(0.3, -1.0, 0.3);
            let actions = if (17..=18).contains(&tick) { BOW } else { 0 };
            let archer = ClimberInput {
                actions,
                aim,
                ..ClimberInput::IDLE
            };
            let fencer = pressing(if tick == wait_for { CUT } else { 0 });
            events.push(arena.step(&[archer, fencer], &terrain).unwrap().to_vec());
        }
        for tick in &events {
            let hits: Vec<(Weapon, f64)> = tick
                .iter()
                .filter_map(|event| match event {
                    ArenaEvent::Hit { weapon, time, .. } => Some((*weapon, *time)),
                    _ => None,
                })
                .collect();
            assert!(hits.is_sorted_by(|a, b| a.1 <= b.1), "{hits:?}");
            if let [first, _, ..] = hits[..] {
                orders[usize::from(first.0 == Weapon::Arrow)] += 1;
            }
        }
        let broke = events.iter().flatten().filter(|event| {
            matches!(
                event,
                ArenaEvent::Creature {
                    event: CreatureEvent::Staggered { .. },
                    ..
                }
            )
        });
        assert_eq!(broke.count(), 1, "the plate breaks once");
        assert!(
            arena
                .projectiles()
                .iter()
                .all(|arrow| !arrow.is_stuck() || {
                    let surface = arena.creature(GIANT).unwrap().surface();
                    let ProjectileMotion::Stuck { at, .. } = arrow.motion else {
                        return true;
                    };
                    at.obstacle != creature_obstacle(GIANT)
                        || surface.is_enabled(at.material.triangle().unwrap())
                })
        );
    }
    assert!(
        orders.iter().sum::<u32>() > 0,
        "no tick had both: {orders:?}"
    );
}

#[test]
fn the_oldest_arrows_fall_when_there_are_too_many() {
    let mut arena = Arena::new(ArenaConfig {
        stuck_arrows: 5,
        ..ArenaConfig::default()
    })
    .unwrap();
    arena
        .add_creature(Slab::default().kind(), CreatureConfig::default())
        .unwrap();
    arena.add_fighter(archer(), DVec3::Y).unwrap();
    land(&mut arena);
    for shot in 0..12 {
        shoot(&mut arena, DVec3::new(0.1 * shot as f64, -1.0, 0.3));
        wait(&mut arena, 10);
        let stuck: Vec<u64> = arena
            .projectiles()
            .iter()
            .filter(|one| one.is_stuck())
            .map(|one| one.id.0)
            .collect();
        let first = (shot + 1u64).saturating_sub(5);
        assert_eq!(stuck, (first..=shot).collect::<Vec<_>>());
    }
    // Fallen arrows are gone after a while.
    wait(&mut arena, 700);
    assert_eq!(arena.projectiles().len(), 5);
}

#[test]
fn arrows_come_back_with_their_numbers_a_thousand_times() {
    let slab = moving();
    let mut arena = slab.arena(archer(), &[DVec3::new(-3.0, 1.0, -3.0)]);
    land(&mut arena);
    let mut rng = fastrand::Rng::with_seed(57);
    for round in 0..1000 {
        // Draws, shoots, and lets the arrow fly and get stuck, within eight ticks.
        let aim = DVec3::new(rng.f64() - 0.5, -1.0, rng.f64() - 0.5);
        let before = arena.save();
        let play = |arena: &mut Arena| {
            let events = [shoot(arena, aim), wait(arena, 5)].concat();
            let numbers: Vec<u64> = arena.projectiles().iter().map(|one| one.id.0).collect();
            (events, numbers, arena.fingerprint(), arena.save())
        };
        let first = play(&mut arena);
        arena.restore(&before).unwrap();
        assert_eq!(arena.fingerprint(), before.fingerprint());
        let again = play(&mut arena);
        assert!(first == again, "round {round}");
        assert_eq!(first.2, first.3.fingerprint());
    }
    assert_eq!(arena.save().next_projectile, 1000);
}

/// The weak point and the plate of each hit.
fn struck(events: &[ArenaEvent]) -> Vec<(Option<usize>, Option<usize>)> {
    let hits = events.iter().filter_map(|event| match event {
        ArenaEvent::Hit {
            weak_point, plate, ..
        } => Some((*weak_point, *plate)),
        _ => None,
    });
    hits.collect()
}

#[test]
fn a_stone_is_heard_and_an_arrow_hurts_what_it_hits() {
    let slab = Slab::with_heart(9.0);
    let mut arena = slab.arena(archer(), &[DVec3::Y]);
    land(&mut arena);
    let aim = DVec3::new(0.0, -0.3, 1.0);
    let mut heard = 0.0f64;
    let mut events = Vec::new();
    for tick in 0..60 {
        let actions = if tick == 0 { THROW } else { 0 };
        events.extend(step(
            &mut arena,
            &ClimberInput {
                actions,
                aim,
                ..ClimberInput::IDLE
            },
        ));
        heard = heard.max(
            arena
                .creature(GIANT)
                .unwrap()
                .state()
                .senses()
                .get(Sense::Noise),
        );
    }
    assert_eq!(heard, 2.0);
    let thrown = |weapon: Weapon| {
        let hit = move |one: &&ArenaEvent| matches!(one, ArenaEvent::Hit { weapon: with, .. } if *with == weapon);
        events.iter().filter(hit).count()
    };
    assert_eq!((thrown(Weapon::Stone), thrown(Weapon::Arrow)), (1, 0));
    assert!(arena.projectiles().is_empty());
    events = shoot(&mut arena, DOWN);
    events.extend(wait(&mut arena, 10));
    let done = support::hits(&events);
    // The bow was fully drawn, so the damage is 3, but for the energy that the arrow gains by its fall.
    assert!(done.len() == 1 && (done[0] - 3.0).abs() < 0.1, "{done:?}");
    assert_eq!(struck(&events), [(Some(0), None)]);
    let by = events
        .iter()
        .any(|event| matches!(event, ArenaEvent::Shot { by: HERO, .. }));
    assert!(by, "{events:?}");
}

#[test]
fn a_quiver_gets_empty() {
    let mut config = archer();
    config.bow.as_mut().unwrap().arrows = Some(2);
    let mut arena = Slab::default().arena(config, &[DVec3::Y]);
    land(&mut arena);
    for left in [2, 1, 0, 0] {
        assert_eq!(arena.fighter(HERO).unwrap().arrows(), Some(left));
        shoot(&mut arena, DOWN);
        wait(&mut arena, 5);
    }
    assert_eq!(arena.projectiles().len(), 2);
}
