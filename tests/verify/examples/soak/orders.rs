//! Random orders to an arena. Some of them name a fighter or creature that does not exist.

use clamber_climber::Knockback;
use clamber_colossus::{CreatureConfig, Noise};
use clamber_fight::{Arena, CreatureId, FighterConfig, FighterId, Order, ProjectileId};
use fastrand::Rng;
use glam::DVec3;

/// No order adds a creature to an arena with this many creatures.
const MOST_CREATURES: usize = 3;

/// No order adds a fighter to an arena with this many fighters.
const MOST_FIGHTERS: usize = 6;

/// The orders of a tick. At most one tick in twenty has any.
pub(super) fn orders(rng: &mut Rng, arena: &Arena, origin: DVec3) -> Vec<Order> {
    let count = if rng.u8(0..20) == 0 { rng.u8(1..4) } else { 0 };
    (0..count)
        .filter_map(|_| order(rng, arena, origin))
        .collect()
}

fn order(rng: &mut Rng, arena: &Arena, origin: DVec3) -> Option<Order> {
    let lot = |rng: &mut Rng| 2.0 * rng.f64() - 1.0;
    let vector = |rng: &mut Rng| DVec3::new(lot(rng), lot(rng), lot(rng));
    let fighter = FighterId(rng.u32(0..arena.next_fighter().0 + 1));
    let creature = CreatureId(rng.u32(0..arena.next_creature().0 + 1));
    let near = vector(rng) * 40.0;
    let position = origin + near.with_y(near.y.abs() + 1.0);
    let level = origin + near.with_y(0.0);
    let (kind, of_kind) = arena.kinds().next()?;
    let brain = of_kind.brain();
    Some(match rng.u8(0..19) {
        0 if arena.fighters().len() < MOST_FIGHTERS => Order::AddFighter {
            config: Box::new(FighterConfig::hero()),
            position,
        },
        1 if arena.fighters().len() > 1 => Order::RemoveFighter { fighter },
        2 if arena.creatures().len() < MOST_CREATURES => Order::AddCreature {
            kind,
            config: CreatureConfig {
                position: level,
                yaw: lot(rng) * 3.0,
                scale: 0.2 + rng.f64(),
                seed: rng.u64(..),
                ..CreatureConfig::default()
            },
        },
        3 if arena.creatures().len() > 1 => Order::RemoveCreature { creature },
        4 => Order::RemoveProjectile {
            projectile: ProjectileId(rng.u64(0..4)),
        },
        5 => Order::Hurt {
            fighter,
            damage: rng.f64(),
        },
        6 => Order::Heal {
            fighter,
            hit_points: rng.f64(),
            stamina: rng.f64(),
        },
        7 => Order::Strike {
            fighter,
            knockback: Knockback {
                velocity: vector(rng) * 20.0,
                damage: 0.3 * rng.f64(),
                by: None,
            },
        },
        8 => Order::PlaceFighter { fighter, position },
        9 => Order::Checkpoint { fighter, position },
        10 => Order::Rise { fighter },
        11 => Order::AddArrows {
            fighter,
            arrows: rng.u32(0..9),
        },
        12 => Order::Noise(Noise {
            place: position,
            loudness: rng.f64(),
        }),
        13 => Order::Send {
            creature,
            to: rng.bool().then_some(level),
        },
        14 => {
            let states: Vec<&str> = brain.states().map(|state| brain.path(state)).collect();
            let path = states.get(rng.usize(0..states.len()))?;
            Order::Enter {
                creature,
                state: path.rsplit('/').next()?.to_owned(),
            }
        }
        15 => Order::PlaceCreature {
            creature,
            position: level,
            yaw: lot(rng) * 4.0,
        },
        16 => Order::Harm {
            creature,
            weak_point: rng.usize(0..of_kind.weak_points().len().max(1)),
            damage: 0.1 * rng.f64(),
        },
        17 => Order::Sense {
            creature,
            name: brain.own_senses().first()?.clone(),
            value: rng.f64(),
        },
        _ => return None,
    })
}
