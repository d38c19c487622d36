//! Saved arenas: runs continue with the same bits, missing fields are noticed, and damaged bytes are refused. Scene
//! B54.

use std::collections::BTreeMap;

use crate::support::{GIANT, Melee, Slab, arena_with, giant, level_ground, step_with, weak_point};
use clamber_climber::ClimberInput;
use clamber_fight::{
    Arena, ArenaConfig, ArenaError, ArenaPart, ArenaState, FighterConfig, FighterId, Order,
};
use clamber_surface::Fingerprint;
use glam::{DVec3, Vec3};
use serde_json::Value;

/// Number of ticks that are played again from each saved state.
const AGAIN: u64 = 7;

#[test]
fn much_happens_in_the_melee() {
    let mut melee = Melee::new(&giant());
    let mut counts: BTreeMap<String, u32> = BTreeMap::new();
    let mut modes: BTreeMap<String, u32> = BTreeMap::new();
    for _ in 0..60 * 100 {
        for event in melee.step() {
            let text = format!("{event:?}");
            let name = text.split([' ', '{']).next().unwrap().to_owned();
            *counts.entry(name).or_default() += 1;
        }
        for fighter in melee.arena.fighters() {
            *modes
                .entry(format!("{:?}", fighter.climber().state().mode))
                .or_default() += 1;
        }
    }
    println!("{counts:?}\n{modes:?}");
    for name in [
        "Creature",
        "Climber",
        "Hit",
        "Struck",
        "Shot",
        "Stuck",
        "CameLoose",
        "BrokenOff",
    ] {
        assert!(counts.contains_key(name), "no {name}: {counts:?}");
    }
    assert!(
        modes.contains_key("Holding") && modes.contains_key("Hanging"),
        "{modes:?}"
    );
}

/// Repeats every third tick of the fight from the state seven ticks before.
#[test]
fn a_restored_arena_goes_on_with_the_same_bits() {
    let mut melee = Melee::new(&giant());
    let mut states: Vec<ArenaState> = vec![melee.arena.save()];
    let mut sums = vec![melee.arena.fingerprint()];
    for tick in 1..=60 * 20u64 {
        melee.step();
        states.push(melee.arena.save());
        sums.push(melee.arena.fingerprint());
        assert_eq!(states[tick as usize].fingerprint(), sums[tick as usize]);
        if tick >= AGAIN && tick % 3 == 0 {
            let from = tick - AGAIN;
            melee.arena.restore(&states[from as usize]).unwrap();
            assert_eq!(melee.arena.fingerprint(), sums[from as usize]);
            for again in from + 1..=tick {
                melee.step();
                assert_eq!(
                    melee.arena.fingerprint(),
                    sums[again as usize],
                    "tick {again} from {from}"
                );
            }
            assert!(melee.arena.save() == states[tick as usize], "tick {tick}");
        }
    }
}

/// Plays a fight for `ticks` ticks. From each of its states, a fresh arena continues with the same bits for [`AGAIN`]
/// ticks; every `far`-th state is continued for 600 ticks.
fn fresh_arenas_go_on_alike(number: u64, ticks: u64, far: u64) {
    let kind = giant();
    let mut melee = Melee::another(&kind, number);
    let mut states = vec![melee.arena.save()];
    for _ in 0..ticks + 600 {
        melee.step();
        states.push(melee.arena.save());
    }
    let sums: Vec<u64> = states.iter().map(ArenaState::fingerprint).collect();
    for from in 0..ticks {
        let mut fresh = Melee::another(&kind, number);
        fresh.arena.restore(&states[from as usize]).unwrap();
        let last = if from % far == 0 { 600 } else { AGAIN };
        for tick in from + 1..=from + last {
            fresh.step();
            let sum = fresh.arena.fingerprint();
            assert_eq!(
                sum, sums[tick as usize],
                "{number}: tick {tick} from {from}"
            );
        }
        assert!(
            fresh.arena.save() == states[(from + last) as usize],
            "{from}"
        );
    }
}

/// Only the saved state influences a tick: memory that an arena keeps beside it makes no difference.
#[test]
fn a_fresh_arena_goes_on_with_the_same_bits() {
    fresh_arenas_go_on_alike(1, 240, 60);
}

#[test]
#[ignore = "takes many minutes: ten fights of 40 s, from each of their ticks"]
fn fresh_arenas_go_on_with_the_same_bits_in_ten_fights() {
    for number in 0..10 {
        fresh_arenas_go_on_alike(number, 2400, 20);
    }
}

/// The value at a path in a saved state: names of fields, and indices.
fn at<'a>(value: &'a mut Value, path: &str) -> &'a mut Value {
    value.pointer_mut(path).unwrap()
}

fn text_hash(text: &str) -> u64 {
    let mut hash = Fingerprint::default();
    hash.text(text);
    hash.value()
}

/// A field that is missing in a saved state is noticed: a run that continues from it has other bits, within 60 ticks
/// from the point where the field first matters.
#[test]
fn each_field_that_is_left_out_is_noticed_within_a_second() {
    /// Fields that are left out in turn: a name for messages, and the path in the saved state.
    const FIELDS: [(&str, &str); 31] = [
        ("tick", "/tick"),
        ("pendulum", "/fighters/0/state/climber/hanging"),
        ("filter of the shake", "/fighters/0/state/climber/shake"),
        ("stamina", "/fighters/0/state/climber/stamina"),
        ("hit points", "/fighters/1/state/climber/hit_points"),
        ("support", "/fighters/0/state/climber/support"),
        (
            "support's velocity",
            "/fighters/0/state/climber/support_velocity",
        ),
        ("heading", "/fighters/1/state/climber/heading"),
        ("hit-stop", "/fighters/2/state/hit_stop"),
        ("charge and other acts", "/fighters/0/state/act"),
        ("buttons", "/fighters/0/state/actions"),
        ("knockback", "/fighters/1/state/knockback"),
        ("random stream", "/fighters/1/state/random"),
        ("arrows", "/projectiles"),
        ("number of the next arrow", "/next_projectile"),
        ("noises", "/noises"),
        ("plates", "/creatures/1/state/damage/plates"),
        (
            "hit points of weak points",
            "/creatures/1/state/damage/hit_points",
        ),
        ("brain", "/creatures/0/state/brain"),
        ("clips", "/creatures/0/state/clips/animator"),
        ("feet", "/creatures/0/state/feet"),
        ("rides", "/creatures/0/state/perceived/rides"),
        ("pose", "/creatures/0/state/pose"),
        ("way", "/creatures/0/state/walked"),
        ("wounds", "/creatures/0/state/damage/wounds"),
        ("gaze", "/creatures/0/state/head/target"),
        ("prey", "/creatures/0/state/perceived/prey"),
        ("whom it struck", "/creatures/0/state/striking/struck"),
        ("place", "/creatures/0/state/on_ground/position"),
        ("speed", "/creatures/0/state/motion/speed"),
        ("hips", "/creatures/0/state/hips"),
    ];
    let mut melee = Melee::new(&giant());
    let (mut states, mut sums, mut fields) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..60 * 100 {
        let state = melee.arena.save();
        let mut value = serde_json::to_value(&state).unwrap();
        fields.push(FIELDS.map(|(_, path)| text_hash(&at(&mut value, path).to_string())));
        states.push(state);
        sums.push(melee.arena.fingerprint());
        melee.step();
    }
    let value = |tick: usize| serde_json::to_value(&states[tick]).unwrap();
    for (index, (name, path)) in FIELDS.into_iter().enumerate() {
        let last = states.len() - 60 - 2 * AGAIN as usize;
        // Prey in view is sensed anew in each tick. The remembered prey matters only while it is out of view.
        let is_remembered = |from: &usize| {
            let mut state = value(*from);
            let unseen = "/creatures/0/state/perceived/unseen";
            let hides = at(&mut state, unseen).as_u64() > Some(0);
            name != "prey" || hides && !at(&mut state, path).is_null()
        };
        let first = (0..last)
            .filter(|from| fields[*from][index] != fields[*from + AGAIN as usize][index])
            .find(is_remembered)
            .unwrap_or_else(|| panic!("{name} never changes"));
        let caught = (first..first + 60).find(|from| {
            let mut live = value(from + AGAIN as usize);
            let mut loaded = value(*from);
            *at(&mut loaded, path) = at(&mut live, path).clone();
            let Ok(state) = serde_json::from_value::<ArenaState>(loaded) else {
                return true;
            };
            // A state that the arena refuses is noticed as well.
            if melee.arena.restore(&state).is_err() {
                return true;
            }
            (from + 1..=from + AGAIN as usize).any(|tick| {
                // Inputs depend on the tick's number, so the number of the original run is set.
                let mut loaded = melee.arena.save();
                loaded.tick = tick as u64 - 1;
                if name != "tick" {
                    melee.arena.restore(&loaded).unwrap();
                }
                melee.step();
                melee.arena.fingerprint() != sums[tick]
            })
        });
        assert!(
            caught.is_some(),
            "{name} can be left out from tick {first} on"
        );
    }
    // States without a missing field continue with the same bits.
    for from in (0..600).step_by(50) {
        melee.arena.restore(&states[from]).unwrap();
        for sum in sums.iter().skip(from + 1).take(AGAIN as usize) {
            melee.step();
            assert_eq!(melee.arena.fingerprint(), *sum);
        }
    }
}

#[test]
fn bytes_come_back_and_others_are_refused() {
    let kind = giant();
    let mut melee = Melee::new(&kind);
    for _ in 0..200 {
        melee.step();
    }
    let bytes = melee.arena.to_bytes().unwrap();
    let (saved, sum) = (melee.arena.save(), melee.arena.fingerprint());
    for _ in 0..50 {
        melee.step();
    }
    melee.arena.restore_bytes(&bytes).unwrap();
    assert!(melee.arena.save() == saved);
    // Another arena with the same creatures and fighters continues from there as well.
    let mut other = Melee::new(&kind);
    other.arena.restore_bytes(&bytes).unwrap();
    melee.step();
    other.step();
    assert_eq!(melee.arena.fingerprint(), other.arena.fingerprint());
    assert_ne!(melee.arena.fingerprint(), sum);

    let before = melee.arena.fingerprint();
    let mut rng = fastrand::Rng::with_seed(1);
    for round in 0..1000 {
        let mut wrong = bytes.clone();
        if round % 2 == 0 {
            wrong.truncate(rng.usize(0..wrong.len()));
        } else {
            let at = rng.usize(0..wrong.len());
            wrong[at] ^= 1 << rng.u32(0..8);
        }
        let error = melee.arena.restore_bytes(&wrong).unwrap_err();
        let known = matches!(
            error,
            ArenaError::Damaged(_) | ArenaError::Version { .. } | ArenaError::Config { .. }
        );
        assert!(known, "{error}");
    }
    let mut longer = bytes.clone();
    longer.push(0);
    assert!(melee.arena.restore_bytes(&longer).is_err());
    assert_eq!(melee.arena.fingerprint(), before);

    // Another configuration is refused, and so is a kind of creature that the arena does not know.
    let config = ArenaConfig {
        stuck_arrows: 3,
        ..*melee.arena.config()
    };
    let mut arena = Arena::new(config).unwrap();
    let error = arena.restore_bytes(&bytes).unwrap_err();
    assert!(matches!(error, ArenaError::Config { .. }), "{error}");
    let mut arena = Arena::new(*melee.arena.config()).unwrap();
    let error = arena.restore_bytes(&bytes).unwrap_err();
    assert!(matches!(error, ArenaError::Kind { .. }), "{error}");
    // The empty arena takes the state once it knows the kinds.
    for (_, kind) in melee.arena.kinds() {
        arena.add_kind(kind.clone()).unwrap();
    }
    arena.restore_bytes(&bytes).unwrap();
    assert!(arena.save() == saved);
    assert_eq!(arena.fingerprint(), sum);
}

/// States with changed numbers are refused, or are played without a panic.
#[test]
fn states_that_were_changed_are_refused_or_played() {
    let mut melee = Melee::new(&giant());
    for _ in 0..400 {
        melee.step();
    }
    let good = melee.arena.save();
    let whole = serde_json::to_value(&good).unwrap();
    let mut rng = fastrand::Rng::with_seed(2);
    let (mut refused, mut played) = (0, 0);
    for round in 0..1000 {
        let mut value = whole.clone();
        // Most numbers are in the creatures, fighters and projectiles, so these are changed in three of four rounds.
        let part = ["creatures", "fighters", "projectiles"].get(round % 4);
        match part.and_then(|part| value.get_mut(part)) {
            Some(part) => spoil(part, &mut rng),
            None => spoil(&mut value, &mut rng),
        }
        let Ok(state) = serde_json::from_value::<ArenaState>(value) else {
            refused += 1;
            continue;
        };
        if melee.arena.restore(&state).is_err() {
            refused += 1;
            assert_eq!(melee.arena.save().fighters.len(), 3);
            continue;
        }
        played += 1;
        for _ in 0..3 {
            // A state that is accepted can be played.
            melee.step();
        }
        // The resulting state can be saved and restored again.
        let bytes = melee.arena.to_bytes().unwrap();
        let again = melee.arena.restore_bytes(&bytes);
        assert!(again.is_ok(), "round {round}: {again:?}");
        melee.arena.restore(&good).unwrap();
    }
    println!("{refused} refused, {played} played");
    assert!(refused > 50 && played > 200);
}

/// Replaces one value at random.
fn spoil(value: &mut Value, rng: &mut fastrand::Rng) {
    match value {
        Value::Array(all) if !all.is_empty() => {
            let index = rng.usize(0..all.len());
            spoil(&mut all[index], rng);
        }
        Value::Object(all) if !all.is_empty() => {
            let index = rng.usize(0..all.len());
            spoil(all.values_mut().nth(index).unwrap(), rng);
        }
        Value::Number(number) => {
            let wild: [Value; 8] = [
                0.into(),
                (-1).into(),
                1e300.into(),
                (-1e300).into(),
                u64::MAX.into(),
                3.into(),
                0.5.into(),
                1e-300.into(),
            ];
            let other = wild[rng.usize(0..wild.len())].clone();
            *number = other.as_number().unwrap().clone();
        }
        Value::Bool(flag) => *flag = !*flag,
        other => *other = Value::Null,
    }
}

#[test]
fn a_restore_that_fails_changes_nothing() {
    let mut melee = Melee::new(&giant());
    for _ in 0..100 {
        melee.step();
    }
    let before = melee.arena.fingerprint();
    let good = melee.arena.save();
    let mut wrong: Vec<ArenaState> = Vec::new();
    let mut spoil = |change: &dyn Fn(&mut ArenaState)| {
        let mut state = good.clone();
        change(&mut state);
        wrong.push(state);
    };
    // The second creature's state is refused after the first one's was accepted.
    spoil(&|state| state.creatures[1].state = state.creatures[0].state.clone());
    spoil(&|state| state.creatures.swap(0, 1));
    spoil(&|state| state.creatures[1].id = state.creatures[0].id);
    spoil(&|state| state.next_creature = 1);
    spoil(&|state| state.next_creature = u32::MAX);
    spoil(&|state| state.next_projectile = u64::MAX);
    spoil(&|state| state.tick = u64::MAX);
    spoil(&|state| state.next_fighter -= 1);
    spoil(&|state| state.fighters[1].id.0 = 900);
    spoil(&|state| state.creatures[1].kind.0 ^= 1);
    spoil(&|state| state.creatures[0].config.scale = f64::NAN);
    spoil(&|state| state.creatures[0].config.scale = 0.0);
    spoil(&|state| state.fighters[1].config.climber.body.radius = -1.0);
    spoil(&|state| state.fighters[1].state.spawn.x = f64::INFINITY);
    spoil(&|state| {
        state.fighters.remove(0);
        state.fighters[1].state.climber.hit_points = 2.0;
    });
    spoil(&|state| state.fighters[2].state.climber.stamina = 7.0);
    spoil(&|state| state.fighters[0].state.hit_stop = f64::NAN);
    for state in wrong {
        assert!(melee.arena.restore(&state).is_err());
        assert_eq!(melee.arena.fingerprint(), before);
    }
    melee.step();
    let mut again = Melee::new(&giant());
    again.arena.restore(&good).unwrap();
    again.step();
    assert_eq!(melee.arena.fingerprint(), again.arena.fingerprint());
}

#[test]
fn a_snapshot_of_a_giant_and_eight_climbers_is_small() {
    let mut arena = arena_with(giant());
    for index in 0..8 {
        let place = DVec3::new(f64::from(index) - 4.0, 1.0, 20.0);
        arena.add_fighter(FighterConfig::hero(), place).unwrap();
    }
    let mut most = 0;
    for tick in 0..300u64 {
        let inputs = [Melee::inputs(tick)[1]; 8];
        arena.step(&inputs, &level_ground()).unwrap();
        most = most.max(arena.to_bytes().unwrap().len());
    }
    println!("{most} bytes");
    assert!(most <= 64 * 1024, "{most} bytes");
}

/// What is done to one creature or fighter changes the hash of that part, and of no other.
#[test]
fn fingerprints_of_parts_tell_which_part_differs() {
    let parts = |orders: &[Order]| {
        let places = [DVec3::Y, DVec3::new(3.0, 1.0, 0.0)];
        let mut arena = Slab::with_heart(100.0).arena(FighterConfig::hero(), &places);
        step_with(&mut arena, &[ClimberInput::IDLE; 2], orders);
        arena.part_fingerprints()
    };
    let before = parts(&[]);
    let (creature, fighter) = (GIANT, FighterId(1));
    let harm = Order::Harm {
        creature,
        weak_point: 0,
        damage: 1.0,
    };
    let damage = 0.25;
    for (order, changed) in [
        (harm, ArenaPart::Creature(creature)),
        (Order::Hurt { fighter, damage }, ArenaPart::Fighter(fighter)),
    ] {
        let after = parts(&[order]);
        let both = before.iter().zip(&after);
        let differ = both.filter_map(|(one, other)| (one != other).then_some(one.0));
        assert_eq!(differ.collect::<Vec<_>>(), [changed]);
    }
}

#[test]
fn fingerprints_tell_arenas_apart_before_their_first_step() {
    let make = |slab: &Slab, place: DVec3| {
        let arena = slab.arena(FighterConfig::hero(), &[place]);
        arena.fingerprint()
    };
    let slab = Slab::default();
    assert_eq!(make(&slab, DVec3::Y), make(&slab, DVec3::Y));
    assert_ne!(make(&slab, DVec3::Y), make(&slab, DVec3::X));
    let wounded = Slab {
        weak_points: vec![weak_point("heart", Vec3::ZERO, 1.0, 0)],
        ..slab.clone()
    };
    assert_ne!(make(&slab, DVec3::Y), make(&wounded, DVec3::Y));
    let faster = Slab {
        rate: 61.0,
        ..slab.clone()
    };
    assert_ne!(make(&slab, DVec3::Y), make(&faster, DVec3::Y));

    // A state brings its own fighters: this archer has another bow.
    let mut arena = slab.arena(FighterConfig::hero(), &[DVec3::Y]);
    let mut weaker = FighterConfig::hero();
    weaker.bow.as_mut().unwrap().speed *= 0.5;
    let other = slab.arena(weaker, &[DVec3::Y]);
    assert_ne!(arena.fingerprint(), other.fingerprint());
    arena.restore(&other.save()).unwrap();
    assert_eq!(arena.fingerprint(), other.fingerprint());
    assert_eq!(*arena.fighters()[0].config(), weaker);
}
