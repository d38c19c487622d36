//! A creature's shots and waves strike fighters of the arena, and are part of the saved state.

use std::sync::Arc;

use crate::orders::state;
use crate::support::{Slab, arena_with, giant_with, level_ground};
use clamber_climber::ClimberInput;
use clamber_colossus::{CreatureConfig, CreatureEvent, CreatureKind};
use clamber_fight::{Arena, ArenaConfig, ArenaEvent, CreatureId, FighterConfig, FighterId};
use glam::{DVec2, DVec3, Vec3};
use serde_json::json;

/// A giant that throws a stone, which bursts and sends out a wave, and then stomps.
fn thrower() -> Arc<CreatureKind> {
    giant_with(|file| {
        let wave = json!({ "radius": 4.0, "speed": 10.0, "damage": 0.2, "throw": 5.0 });
        let stone =
            json!({ "speed": 22.0, "radius": 0.7, "damage": 0.3, "throw": 8.0, "wave": wave });
        file["start"] = "waits".into();
        file["states"] = json!({
            "waits": { "transitions": [{ "to": "throws", "after": 1 }] },
            "throws": {
                "act": { "attack": { "clip": "swipe", "limb": ["hand.R"], "shot": stone, "follows": 1.0 } },
                "transitions": [{ "to": "stomps" }]
            },
            "stomps": {
                "act": { "attack": { "clip": "stomp", "limb": ["foot.R", "toe.R"],
                    "wave": { "radius": 40.0, "speed": 20.0, "damage": 0.1, "throw": 2.0 } } },
                "transitions": [{ "to": "waits" }]
            }
        });
    })
}

/// An arena with the throwing giant and three fighters in front of it.
fn arena() -> Arena {
    let mut arena = arena_with(thrower());
    add_fighters(&mut arena);
    arena
}

fn add_fighters(arena: &mut Arena) {
    for at in [
        DVec2::new(1.0, 24.0),
        DVec2::new(2.5, 25.0),
        DVec2::new(-30.0, 12.0),
    ] {
        let place = DVec3::new(at.x, 1.0, at.y);
        arena.add_fighter(FighterConfig::hero(), place).unwrap();
    }
}

#[test]
fn stones_and_waves_of_a_creature_strike_fighters() {
    let terrain = level_ground();
    let inputs = [ClimberInput::IDLE; 3];
    let mut ours = arena();
    let (mut struck, mut told, mut in_the_air) = (Vec::new(), Vec::new(), 0);
    let mut saved = Vec::new();
    for tick in 0..620 {
        for event in ours.step(&inputs, &terrain).unwrap() {
            match event {
                ArenaEvent::Struck {
                    fighter, damage, ..
                } => struck.push((*fighter, *damage)),
                ArenaEvent::Creature { event, .. } => told.push(event.clone()),
                _ => {}
            }
        }
        let giant = ours.creature(CreatureId(0)).unwrap();
        let flies = giant.shots().count() + giant.waves().count();
        in_the_air += usize::from(flies > 0);
        if flies > 0 && tick % 7 == 0 {
            saved.push((tick, ours.to_bytes().unwrap()));
        }
    }
    let of = |number| {
        let ours = struck.iter().filter(|(fighter, _)| fighter.0 == number);
        ours.map(|(_, damage)| *damage).collect::<Vec<f64>>()
    };
    // The first fighter takes the stone's own damage, and the second one the smaller damage of its burst. The stomp's
    // wave strikes all three.
    assert_eq!(of(0)[0], 0.3);
    assert!(of(1)[0] > 0.02 && of(1)[0] < 0.2, "{:?}", of(1));
    assert_eq!([of(0).len(), of(1).len(), of(2).len()], [2, 2, 1]);
    for number in 0..3 {
        let left = state(&ours, FighterId(number)).hit_points;
        assert!(left < 1.0, "{number}: {left}");
    }
    let count = |is: fn(&CreatureEvent) -> bool| told.iter().filter(|event| is(event)).count();
    let thrown = count(|event| matches!(event, CreatureEvent::Threw { .. }));
    let bursts = count(|event| matches!(event, CreatureEvent::Burst { .. }));
    let waves = count(|event| matches!(event, CreatureEvent::Wave { .. }));
    assert_eq!([thrown, bursts, waves], [1, 1, 2]);
    assert!(in_the_air > 60, "{in_the_air}");
    // A fresh arena that is restored from any of the saved states ends in the same state.
    for (tick, bytes) in saved {
        let mut fresh = arena();
        fresh.restore_bytes(&bytes).unwrap();
        for _ in tick + 1..620 {
            fresh.step(&inputs, &terrain).unwrap();
        }
        assert_eq!(fresh.fingerprint(), ours.fingerprint(), "from tick {tick}");
    }
}

/// A stone that meets another, moving creature meets it at its current position. The result is the same after a
/// restore, and whichever of the two creatures has the lower number.
#[test]
fn stones_meet_creatures_that_move_as_a_fresh_arena_has_it() {
    let terrain = level_ground();
    let inputs = [ClimberInput::IDLE; 3];
    let shield = || {
        // The shield moves up and down at 12 m/s.
        let keys = (0..9).map(|index| {
            let up = if index % 2 == 0 { 2.0 } else { 8.0 };
            (0.5 * index as f32, Vec3::Y * up, Vec3::ONE)
        });
        let slab = Slab {
            keys: keys.collect(),
            ..Slab::default()
        };
        let config = CreatureConfig {
            position: DVec3::Z * 16.0,
            ..CreatureConfig::default()
        };
        (slab.kind(), config)
    };
    let mut places = Vec::new();
    for shield_first in [false, true] {
        let begin = || {
            let mut arena = Arena::new(ArenaConfig::default()).unwrap();
            let (slab, lies) = shield();
            if shield_first {
                arena.add_creature(slab.clone(), lies).unwrap();
            }
            arena
                .add_creature(thrower(), CreatureConfig::default())
                .unwrap();
            if !shield_first {
                arena.add_creature(slab, lies).unwrap();
            }
            add_fighters(&mut arena);
            arena
        };
        let mut ours = begin();
        let (mut saved, mut sums, mut burst) = (Vec::new(), Vec::new(), None);
        for tick in 0..330 {
            for event in ours.step(&inputs, &terrain).unwrap() {
                if let ArenaEvent::Creature {
                    event: CreatureEvent::Burst { place, .. },
                    ..
                } = event
                {
                    burst = Some(*place);
                }
            }
            sums.push(ours.fingerprint());
            let giant = CreatureId(u32::from(shield_first));
            if ours.creature(giant).unwrap().shots().count() > 0 {
                saved.push((tick, ours.to_bytes().unwrap()));
            }
        }
        let burst = burst.unwrap();
        assert!(burst.y > 1.0, "it met the shield: {burst}");
        places.push(burst);
        assert!(saved.len() > 10);
        for (tick, bytes) in saved {
            let mut fresh = begin();
            fresh.restore_bytes(&bytes).unwrap();
            for (then, sum) in sums.iter().enumerate().skip(tick + 1) {
                fresh.step(&inputs, &terrain).unwrap();
                assert_eq!(fresh.fingerprint(), *sum, "from tick {tick} to {then}");
            }
        }
    }
    assert!(places[0].distance(places[1]) < 1e-6, "{places:?}");
}
