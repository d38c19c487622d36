//! Whole arenas: creatures of any size at any place, fighters, random inputs, random orders, and rollbacks.

#[path = "orders.rs"]
mod orders;

use std::sync::Arc;

use clamber_climber::{ClimberInput, StepRules};
use clamber_colossus::{Brain, CreatureConfig, CreatureKind};
use clamber_fight::{Arena, ArenaConfig, FighterConfig, Order};
use clamber_scenes::Creature;
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use fastrand::Rng;
use glam::DVec3;

/// Number of ticks of an arena.
const TICKS: usize = 300;

/// Number of ticks that a rollback takes back and repeats.
const AGAIN: usize = 8;

/// Runs an arena; returns the number of checks. Panics if a number is not finite, if repeated ticks give other bits, or
/// if a step ends with an error.
pub(crate) fn arena(giant: &Creature, seed: u64) -> usize {
    let mut rng = Rng::with_seed(seed);
    let (mut arena, origin) = make(giant, &mut rng);
    let ground = HalfSpace::below(origin.y);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &ground)];
    let mut held: Vec<ClimberInput> = Vec::new();
    let mut checks = 0;
    let mut saved = arena.save();
    let mut played: Vec<(Vec<ClimberInput>, Vec<Order>)> = Vec::new();
    for tick in 0..TICKS {
        for held in &mut held {
            if rng.u8(0..8) == 0 {
                *held = input(&mut rng);
            }
        }
        held.resize(arena.fighters().len(), ClimberInput::IDLE);
        let orders = orders::orders(&mut rng, &arena, origin);
        step(&mut arena, (&held, &orders), &terrain, tick);
        played.push((held.clone(), orders));
        for fighter in arena.fighters() {
            let state = fighter.climber().state();
            let finite = state.position.is_finite() && state.velocity.is_finite();
            assert!(finite, "tick {tick}: {state:?}");
            checks += 1;
        }
        for one in arena.projectiles() {
            let place = arena.place(one, &terrain);
            assert!(
                place.is_none_or(|place| place.tip.is_finite()),
                "tick {tick}: {one:?}"
            );
            checks += 1;
        }
        if played.len() == AGAIN {
            let sum = arena.fingerprint();
            // At random, this arena or a new one repeats the ticks. The new one has only the creature kinds in common.
            if rng.bool() {
                arena = fresh(&arena);
            }
            if let Err(error) = arena.restore(&saved) {
                panic!("tick {tick}: {error}");
            }
            for (inputs, orders) in played.drain(..) {
                step(&mut arena, (&inputs, &orders), &terrain, tick);
            }
            assert!(
                arena.fingerprint() == sum,
                "tick {tick}: other bits when played again"
            );
            saved = arena.save();
            checks += 1;
        }
    }
    checks
}

fn step(
    arena: &mut Arena,
    (inputs, orders): (&[ClimberInput], &[Order]),
    terrain: &[(ObstacleId, &dyn Obstacle)],
    tick: usize,
) {
    if let Err(error) = arena.step_with(inputs, orders, terrain, &StepRules::default()) {
        panic!("tick {tick}: {error}");
    }
}

/// An empty arena with the same creature kinds.
fn fresh(arena: &Arena) -> Arena {
    let mut fresh = match Arena::new(*arena.config()) {
        Ok(fresh) => fresh,
        Err(error) => panic!("{error}"),
    };
    for (_, kind) in arena.kinds() {
        if let Err(error) = fresh.add_kind(Arc::clone(kind)) {
            panic!("{error}");
        }
    }
    fresh
}

fn make(giant: &Creature, rng: &mut Rng) -> (Arena, DVec3) {
    let far = if rng.bool() { 0.0 } else { 1e5 };
    let origin = DVec3::new(lot(rng) * far, lot(rng) * 100.0, lot(rng) * far);
    let mut made = || -> Result<Arena, Box<dyn std::error::Error>> {
        let brain = std::fs::read_to_string(clamber_scenes::giant::brain_path())?;
        let kind = Arc::new(CreatureKind::new(
            &giant.rig,
            Brain::from_json(&brain, 1.0 / 60.0)?,
        )?);
        let mut arena = Arena::new(ArenaConfig {
            seed: rng.u64(..),
            stuck_arrows: rng.u32(0..8),
            ..ArenaConfig::default()
        })?;
        for _ in 0..rng.u32(1..3) {
            let scale = 0.2 + 1.5 * rng.f64();
            let config = CreatureConfig {
                position: origin + DVec3::new(lot(rng), 0.0, lot(rng)) * 20.0,
                yaw: lot(rng) * 3.0,
                scale,
                seed: rng.u64(..),
                ..CreatureConfig::default()
            };
            arena.add_creature(Arc::clone(&kind), config)?;
        }
        for _ in 0..rng.u32(1..5) {
            let number = rng.usize(0..arena.creatures().len());
            let creature = arena.creatures().nth(number);
            let (_, creature) = creature.ok_or("no creature")?;
            let (size, at) = (creature.scale(), creature.config().position);
            let place = if rng.bool() {
                at + DVec3::new(lot(rng) * 3.0, 36.0, lot(rng) * 3.0) * size
            } else {
                at + DVec3::new(lot(rng), 0.05, lot(rng)) * (30.0 * size) + DVec3::Y
            };
            arena.add_fighter(FighterConfig::hero(), place)?;
        }
        Ok(arena)
    };
    match made() {
        Ok(arena) => (arena, origin),
        Err(error) => panic!("the arena cannot be made: {error}"),
    }
}

fn input(rng: &mut Rng) -> ClimberInput {
    let vector = |rng: &mut Rng| DVec3::new(lot(rng), lot(rng), lot(rng));
    let (walk, climb, aim) = (vector(rng), vector(rng), vector(rng));
    ClimberInput {
        walk,
        climb: if rng.bool() { climb } else { DVec3::ZERO },
        aim,
        jump: rng.u8(0..6) == 0,
        jump_held: rng.bool(),
        crouch: rng.u8(0..8) == 0,
        grip: rng.u8(0..5) > 0,
        actions: if rng.bool() { 1 << rng.u32(0..4) } else { 0 },
    }
}

fn lot(rng: &mut Rng) -> f64 {
    2.0 * rng.f64() - 1.0
}
