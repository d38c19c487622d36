//! Fighters and creatures that join and leave by orders.

use std::sync::Arc;

use crate::orders::{IDLE, OTHER, idle, pair, state};
use crate::support::{
    GIANT, GROUND, HERO, Slab, arena_with, giant, level_ground, mode, moves, rest, step, step_with,
};
use clamber_climber::{ClimberEvent, ClimberInput, ClimberMode, StepRules};
use clamber_colossus::CreatureConfig;
use clamber_fight::actions::BOW;
use clamber_fight::{
    Arena, ArenaConfig, ArenaError, ArenaEvent, CreatureId, FighterConfig, FighterId, Order,
    ProjectileMotion, fighter_obstacle,
};
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use glam::{DVec3, Vec3};

/// When a creature is removed, its riders fall, and its arrows come loose at their current position rather than where
/// they struck.
#[test]
fn riders_and_arrows_of_who_leaves_are_let_go() {
    for speed in [0.0f32, 4.0] {
        let moves = Slab {
            keys: moves(Vec3::X * speed, 600.0),
            ..Slab::default()
        };
        let places = [DVec3::Y * 1.5, DVec3::new(3.0, 1.5, 0.0)];
        let mut arena = moves.arena(FighterConfig::hero(), &places);
        for _ in 0..60 {
            idle(&mut arena, &[]);
        }
        let shoots = |down: bool| ClimberInput {
            actions: if down { BOW } else { 0 },
            aim: DVec3::new(0.3, -1.0, 0.0),
            ..IDLE
        };
        for tick in 0..120 {
            step(&mut arena, &shoots(tick < 80));
        }
        let arrow = arena.projectiles()[0];
        assert!(arrow.is_stuck());
        let place = arena.place(&arrow, &[]).unwrap().tip;
        let events = idle(&mut arena, &[Order::RemoveCreature { creature: GIANT }]);
        assert_eq!(events[0], ArenaEvent::CreatureLeft { creature: GIANT });
        let loose = ArenaEvent::CameLoose {
            projectile: arrow.id,
        };
        assert!(events.contains(&loose), "{events:?}");
        assert!(arena.creature(GIANT).is_none());
        assert_eq!(mode(&arena), ClimberMode::Falling);
        let ProjectileMotion::Falling {
            position, velocity, ..
        } = arena.projectile(arrow.id).unwrap().motion
        else {
            panic!("it does not fall");
        };
        let way = f64::from(speed) / 60.0;
        assert!(position.distance(place) < 0.01 + way, "{position} {place}");
        // The arrow falls from rest: the skin's motion is not saved, and an arena that was just restored does not know
        // it.
        assert!(velocity.x.abs() < 1e-9, "{velocity}");
        // The creature's number is not given again, and the fighters go on.
        let kind = arena.kinds().next().unwrap().0;
        let joins = Order::AddCreature {
            kind,
            config: CreatureConfig::default(),
        };
        let events = idle(&mut arena, &[joins]);
        let creature = CreatureId(1);
        assert_eq!(events[0], ArenaEvent::CreatureJoined { creature });
        assert!(arena.creature(creature).is_some() && arena.creature(GIANT).is_none());
    }
}

/// Fighters join and leave in the middle of a fight. Inputs belong to the fighters that were there before the orders,
/// and numbers are not given twice.
#[test]
fn fighters_join_and_leave() {
    let mut arena = pair();
    let position = DVec3::new(-3.0, 1.5, 0.0);
    let joins = Order::AddFighter {
        config: Box::new(FighterConfig::hero()),
        position,
    };
    let walks = ClimberInput {
        walk: DVec3::NEG_Z,
        ..IDLE
    };
    assert_eq!(arena.next_fighter(), FighterId(2));
    let events = step_with(
        &mut arena,
        &[walks, IDLE],
        &[joins.clone(), Order::RemoveFighter { fighter: HERO }, joins],
    );
    let joined = |number| ArenaEvent::FighterJoined {
        fighter: FighterId(number),
    };
    let left = ArenaEvent::FighterLeft { fighter: HERO };
    assert_eq!(events[..3], [joined(2), left, joined(3)]);
    let ids: Vec<u32> = arena.fighters().iter().map(|one| one.id().0).collect();
    assert_eq!(ids, [1, 2, 3]);
    // The two fighters began at the same place, so the second one was moved aside.
    let [a, b] = [2, 3].map(|number| state(&arena, FighterId(number)).position);
    assert!(a.distance(b) > 0.3, "{a} {b}");
    // Inputs belong to the present fighters, by ascending number.
    for _ in 0..60 {
        step_with(&mut arena, &[IDLE, walks, IDLE], &[]);
    }
    let moved = a.z - state(&arena, FighterId(2)).position.z;
    assert!(moved > 1.0, "{moved}");
    assert!(state(&arena, OTHER).position.z.abs() < 0.1);
    let wrong = arena.step(&[IDLE; 2], &[]).unwrap_err();
    assert!(matches!(
        wrong,
        ArenaError::Inputs {
            fighters: 3,
            found: 2
        }
    ));
    let rest = [1, 2, 3].map(|number| Order::RemoveFighter {
        fighter: FighterId(number),
    });
    step_with(&mut arena, &[IDLE; 3], &rest);
    assert!(arena.fighters().is_empty());
    arena.step(&[], &[]).unwrap();
    assert_eq!(arena.next_fighter(), FighterId(4));
}

/// An arrow goes on and does its damage after its archer has left.
#[test]
fn arrows_outlive_who_shot_them() {
    let slab = Slab::with_heart(9.0);
    let mut arena = slab.arena(FighterConfig::hero(), &[DVec3::new(0.0, 9.0, 0.0)]);
    let ledge = HalfSpace::below(8.0);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ledge)];
    let input = |tick: u32| ClimberInput {
        actions: if tick < 70 { BOW } else { 0 },
        aim: DVec3::Y,
        ..IDLE
    };
    for tick in 0..72 {
        arena.step(&[input(tick)], &terrain).unwrap();
    }
    let arrow = arena.projectiles()[0];
    assert!(arrow.is_flying());
    // The arrow comes down where there is no ledge any more.
    let leaves = [Order::RemoveFighter { fighter: HERO }];
    let events = idle(&mut arena, &leaves);
    assert!(events.contains(&ArenaEvent::FighterLeft { fighter: HERO }));
    let mut hit = None;
    for _ in 0..60 * 20 {
        for event in arena.step(&[], &[]).unwrap() {
            if let ArenaEvent::Hit {
                by,
                damage,
                weak_point,
                ..
            } = event
            {
                hit = Some((*by, *damage, *weak_point));
            }
        }
    }
    let (by, damage, weak_point) = hit.unwrap();
    assert_eq!((by, weak_point), (HERO, Some(0)));
    assert!(damage > 0.0);
    let gone = Order::RemoveProjectile {
        projectile: arrow.id,
    };
    idle(&mut arena, &[gone]);
    assert!(arena.projectiles().is_empty());
}

/// A fighter leaves while another one stands on it and a creature hunts it. The other fighter falls, and the arena goes
/// on.
#[test]
fn who_is_held_and_hunted_may_leave() {
    let mut arena = arena_with(giant());
    let low = DVec3::new(0.0, 1.0, 25.0);
    for place in [low, low + DVec3::Y * 2.0] {
        arena.add_fighter(FighterConfig::hero(), place).unwrap();
    }
    let terrain = level_ground();
    rest(&mut arena, &terrain, 60 * 5);
    let on = state(&arena, OTHER).support.unwrap().attachment.obstacle;
    assert_eq!(
        on,
        fighter_obstacle(HERO),
        "it does not stand on the other one"
    );
    let rules = StepRules::default();
    let leaves = [Order::RemoveFighter { fighter: HERO }];
    let events = arena
        .step_with(&[IDLE; 2], &leaves, &terrain, &rules)
        .unwrap();
    let lost = events.iter().any(|event| {
        matches!(event, ArenaEvent::Climber { fighter: OTHER, event } if !matches!(event, ClimberEvent::Landed { .. }))
    });
    assert!(lost, "{events:?}");
    // An error names a fighter by its number, not by its place among those that are left.
    let wild = ClimberInput {
        aim: DVec3::NAN,
        ..IDLE
    };
    let error = arena.step(&[wild], &terrain).unwrap_err();
    let FighterId(other) = OTHER;
    let named =
        matches!(error, ArenaError::InputNotFinite { fighter } if fighter == other as usize);
    assert!(named, "{error}");
    rest(&mut arena, &terrain, 60 * 10);
    let alone = state(&arena, OTHER);
    assert!(alone.position.y < 1.0, "{}", alone.position);
}

/// An arena and another one that was just restored from it follow the same orders with the same result: an arrow falls
/// from a creature that leaves, and orders reach a fighter and a creature that join earlier in the same list.
#[test]
fn a_restored_arena_follows_orders_alike() {
    let moves = Slab {
        keys: moves(Vec3::X * 4.0, 600.0),
        ..Slab::default()
    };
    let mut arena = moves.arena(FighterConfig::hero(), &[DVec3::Y * 1.5]);
    for tick in 0..180 {
        let shoots = ClimberInput {
            actions: if (60..140).contains(&tick) { BOW } else { 0 },
            aim: DVec3::new(0.3, -1.0, 0.0),
            ..IDLE
        };
        step(&mut arena, &shoots);
    }
    assert!(arena.projectiles()[0].is_stuck());
    let kind = arena.kinds().next().unwrap().0;
    let (fighter, creature) = (arena.next_fighter(), arena.next_creature());
    let orders = [
        Order::RemoveCreature { creature: GIANT },
        Order::AddFighter {
            config: Box::new(FighterConfig::hero()),
            position: DVec3::new(9.0, 3.0, 9.0),
        },
        Order::Hurt {
            fighter,
            damage: 0.25,
        },
        Order::AddCreature {
            kind,
            config: CreatureConfig::default(),
        },
        Order::Enter {
            creature,
            state: "lies".to_owned(),
        },
    ];
    let mut twin = Arena::new(*arena.config()).unwrap();
    twin.add_kind(Arc::clone(arena.kinds().next().unwrap().1))
        .unwrap();
    twin.restore_bytes(&arena.to_bytes().unwrap()).unwrap();
    for one in [&mut arena, &mut twin] {
        let events = idle(one, &orders);
        let unheard = events
            .iter()
            .any(|event| matches!(event, ArenaEvent::Unheard { .. }));
        assert!(!unheard, "{events:?}");
        assert_eq!(state(one, fighter).hit_points, 0.75);
    }
    assert_eq!(arena.fingerprint(), twin.fingerprint());
    // An order with a misspelt state is refused also for a creature that joins in the same step.
    let joins = Order::AddCreature {
        kind,
        config: CreatureConfig::default(),
    };
    let creature = arena.next_creature();
    let typo = Order::Enter {
        creature,
        state: "lise".to_owned(),
    };
    let rules = StepRules::default();
    let inputs = [IDLE; 2];
    let refused = arena.step_with(&inputs, &[joins.clone(), typo], &[], &rules);
    assert!(matches!(refused, Err(ArenaError::Order { index: 1, .. })));
    // More than 256 creatures in one step are refused.
    let many = vec![joins; 300];
    let refused = arena.step_with(&inputs, &many, &[], &rules);
    assert!(matches!(refused, Err(ArenaError::Order { index: 256, .. })));
    assert_eq!(arena.fingerprint(), twin.fingerprint());
}

/// A fresh arena that knows only the kinds of creatures can be restored at any tick and continues alike, although
/// creatures and fighters have joined and left.
#[test]
fn a_fresh_arena_takes_whoever_has_joined() {
    let kind = giant();
    let mut arena = Arena::new(ArenaConfig::default()).unwrap();
    let id = arena.add_kind(Arc::clone(&kind)).unwrap();
    let slab = arena.add_kind(Slab::default().kind()).unwrap();
    let terrain = level_ground();
    let rules = StepRules::default();
    let at = |x: f64| CreatureConfig {
        position: DVec3::X * x,
        ..CreatureConfig::default()
    };
    let orders = |tick: u32| match tick {
        3 => vec![
            Order::AddCreature {
                kind: id,
                config: at(0.0),
            },
            Order::AddFighter {
                config: Box::new(FighterConfig::hero()),
                position: DVec3::new(0.0, 36.0, -1.0),
            },
        ],
        60 => vec![Order::AddCreature {
            kind: slab,
            config: at(90.0),
        }],
        90 => vec![
            Order::AddFighter {
                config: Box::new(FighterConfig::hero()),
                position: DVec3::new(5.0, 1.0, 20.0),
            },
            Order::Send {
                creature: CreatureId(0),
                to: Some(DVec3::Z * 50.0),
            },
        ],
        150 => vec![Order::RemoveCreature {
            creature: CreatureId(1),
        }],
        170 => vec![Order::RemoveFighter { fighter: HERO }],
        _ => Vec::new(),
    };
    let grips = ClimberInput { grip: true, ..IDLE };
    let mut twin: Option<Arena> = None;
    for tick in 0..240 {
        let orders = orders(tick);
        let inputs = vec![grips; arena.fighters().len()];
        arena.step_with(&inputs, &orders, &terrain, &rules).unwrap();
        if let Some(twin) = &mut twin {
            twin.step_with(&inputs, &orders, &terrain, &rules).unwrap();
            assert_eq!(twin.fingerprint(), arena.fingerprint(), "tick {tick}");
        }
        if tick % 10 == 0 {
            let mut fresh = Arena::new(ArenaConfig::default()).unwrap();
            for (_, kind) in arena.kinds() {
                fresh.add_kind(Arc::clone(kind)).unwrap();
            }
            fresh.restore_bytes(&arena.to_bytes().unwrap()).unwrap();
            assert_eq!(fresh.save().fingerprint(), arena.fingerprint());
            twin = Some(fresh);
        }
    }
    // Restores the state of an empty arena in an arena with creatures and fighters.
    let mut empty = Arena::new(ArenaConfig::default()).unwrap();
    arena.restore(&empty.save()).unwrap();
    assert_eq!(arena.fingerprint(), empty.fingerprint());
    assert!(arena.creatures().len() == 0 && arena.fighters().is_empty());
    arena.step(&[], &terrain).unwrap();
    empty.step(&[], &terrain).unwrap();
    assert_eq!(arena.fingerprint(), empty.fingerprint());
}
