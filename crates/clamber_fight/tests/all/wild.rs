//! A thousand runs of random inputs, some of them invalid: they end in typed errors or finite states, without a panic,
//! and repeat with the same bits. Also the same fight with creatures of other sizes, and far from the origin.

use crate::support::{GROUND, Slab, weak_point};
use clamber_climber::ClimberInput;
use clamber_colossus::CreatureConfig;
use clamber_fight::{
    Arena, ArenaConfig, ArenaError, FighterConfig, ProjectileMotion, WeaponAction,
};
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use fastrand::Rng;
use glam::{DVec3, Vec3};

/// A number of any magnitude, and sometimes NaN or infinite.
fn wild(rng: &mut Rng) -> f64 {
    let sign = if rng.bool() { 1.0 } else { -1.0 };
    match rng.u8(0..40) {
        0 => f64::NAN,
        1 => f64::INFINITY * sign,
        2 => sign * f64::MAX,
        3 => sign * f64::MIN_POSITIVE,
        4 => 0.0 * sign,
        5..10 => sign * 1e6 * rng.f64(),
        _ => sign * rng.f64(),
    }
}

fn vector(rng: &mut Rng) -> DVec3 {
    DVec3::new(wild(rng), wild(rng), wild(rng))
}

fn input(rng: &mut Rng) -> ClimberInput {
    let zero = |rng: &mut Rng, v: DVec3| if rng.bool() { v } else { DVec3::ZERO };
    let (walk, climb, aim) = (vector(rng), vector(rng), vector(rng));
    ClimberInput {
        walk: zero(rng, walk),
        climb: zero(rng, climb),
        aim: zero(rng, aim),
        jump: rng.u8(0..8) == 0,
        jump_held: rng.bool(),
        grip: rng.u8(0..4) > 0,
        crouch: rng.u8(0..8) == 0,
        actions: if rng.bool() {
            1 << rng.u32(0..6)
        } else {
            rng.u32(..)
        },
    }
}

fn is_sound(input: &ClimberInput) -> bool {
    let vectors = [input.walk, input.climb, input.aim];
    vectors.iter().all(|v| v.is_finite())
}

fn melee(rng: &mut Rng) -> Arena {
    let lot = |rng: &mut Rng, size: f32| size * (2.0 * rng.f32() - 1.0);
    let keys = (0..20)
        .map(|k| {
            let v = Vec3::new(lot(rng, 2.0), lot(rng, 1.0), lot(rng, 2.0));
            let stretch = Vec3::ONE + Vec3::new(lot(rng, 0.4), lot(rng, 0.4), lot(rng, 0.4));
            (k as f32 * 0.4, v, stretch)
        })
        .collect();
    let slab = Slab {
        keys,
        weak_points: vec![weak_point("heart", Vec3::ZERO, 3.0, 0)],
        plate: true,
        ..Slab::default()
    };
    let mut config = FighterConfig::hero();
    if let Some(sword) = &mut config.sword {
        sword.charge = 0.1 + rng.f64();
    }
    let places = [DVec3::new(3.0, 1.5, 3.0), DVec3::new(-3.0, 1.5, 0.0)];
    slab.arena(config, &places)
}

#[test]
fn a_thousand_runs_of_wild_inputs_neither_panic_nor_lose_a_bit() {
    let mut rng = Rng::with_seed(77);
    let (mut refused, mut stepped, mut shot, mut acts) = (0, 0, 0, 0);
    let ground = HalfSpace::below(-20.0);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ground)];
    for run in 0..1000 {
        let mut arena = melee(&mut rng);
        let mut played: Vec<[ClimberInput; 2]> = Vec::new();
        let (from, mut held) = (arena.save(), [ClimberInput::IDLE; 2]);
        for _ in 0..40 {
            for held in &mut held {
                // Each input is held for a while.
                if rng.u8(0..4) == 0 {
                    *held = input(&mut rng);
                }
            }
            let before = arena.fingerprint();
            match arena.step(&held, &terrain) {
                Ok(_) => {
                    assert!(held.iter().all(is_sound), "{held:?}");
                    stepped += 1;
                    played.push(held);
                }
                Err(error) => {
                    let known = matches!(error, ArenaError::InputNotFinite { .. });
                    assert!(known && !held.iter().all(is_sound), "{error}: {held:?}");
                    assert_eq!(arena.fingerprint(), before, "changed by what was refused");
                    refused += 1;
                }
            }
            for fighter in arena.fighters() {
                let state = fighter.climber().state();
                assert!(
                    state.position.is_finite() && state.velocity.is_finite(),
                    "{state:?}"
                );
                acts += u32::from(*fighter.act() != WeaponAction::Ready);
                assert!(fighter.blade().unwrap().tip.is_finite());
            }
            for one in arena.projectiles() {
                let place = arena.place(one, &terrain);
                assert!(place.is_none_or(|place| place.tip.is_finite()), "{one:?}");
                shot += u32::from(matches!(one.motion, ProjectileMotion::Flying { .. }));
            }
        }
        let sum = arena.fingerprint();
        arena.restore(&from).unwrap();
        for inputs in &played {
            arena.step(inputs, &terrain).unwrap();
        }
        assert_eq!(arena.fingerprint(), sum, "run {run}");
    }
    println!("{stepped} steps, {refused} refused, {acts} acts, {shot} arrows and stones in flight");
    assert!(stepped > 5_000 && refused > 5_000 && acts > 2_000 && shot > 500);
}

/// The ticks and damages of the hits of a fighter that stabs, cuts and shoots.
fn fought(scale: f64, origin: DVec3) -> Vec<(u64, f64)> {
    let slab = Slab {
        weak_points: vec![weak_point("heart", Vec3::ZERO, 50.0, 0)],
        keys: vec![
            (0.0, Vec3::ZERO, Vec3::ONE),
            // The speed of a creature's clips follows from its height. This flat skin has none, so the clip itself is
            // slowed here.
            (60.0 * scale.sqrt() as f32, Vec3::X * 60.0, Vec3::ONE),
        ],
        ..Slab::default()
    };
    let mut arena = Arena::new(ArenaConfig::default()).unwrap();
    let kind = slab.kind();
    let config = CreatureConfig {
        position: origin,
        scale,
        ..CreatureConfig::default()
    };
    arena.add_creature(kind, config).unwrap();
    arena
        .add_fighter(FighterConfig::hero(), origin + DVec3::Y)
        .unwrap();
    let ground = HalfSpace::below(origin.y - 100.0);
    let mut hits = Vec::new();
    for tick in 0..600u64 {
        let actions = match tick {
            100 | 300 => clamber_fight::actions::STAB,
            400 => clamber_fight::actions::CUT,
            500..570 => clamber_fight::actions::BOW,
            _ => 0,
        };
        let aim = DVec3::new(0.2, -1.0, 0.1);
        let input = ClimberInput {
            actions,
            aim,
            ..ClimberInput::IDLE
        };
        for event in arena.step(&[input], &[(GROUND, &ground)]).unwrap() {
            if let clamber_fight::ArenaEvent::Hit { damage, .. } = event {
                hits.push((tick, *damage));
            }
        }
    }
    hits
}

/// Blades and arrows hit alike 140 km and 3,600 km from the origin, and on creatures of other sizes.
#[test]
fn weapons_hit_far_from_the_origin_and_on_other_sizes_alike() {
    let here = fought(1.0, DVec3::ZERO);
    assert_eq!(here.len(), 2, "a stab and an arrow: {here:?}");
    for origin in [DVec3::new(1e5, 300.0, -1e5), DVec3::new(-3e6, 0.0, 2e6)] {
        let there = fought(1.0, origin);
        assert_eq!(there.len(), here.len(), "{there:?}");
        for (a, b) in here.iter().zip(&there) {
            assert!(a.0 == b.0 && (a.1 - b.1).abs() < 1e-3, "{here:?} {there:?}");
        }
    }
    for scale in [0.5, 3.0, 20.0] {
        let there = fought(scale, DVec3::ZERO);
        let ticks = |hits: &[(u64, f64)]| hits.iter().map(|hit| hit.0).collect::<Vec<_>>();
        assert_eq!(ticks(&there), ticks(&here), "{scale}");
    }
}
