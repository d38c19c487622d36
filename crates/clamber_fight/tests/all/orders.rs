//! Orders: what a game does to an arena, who joins and who leaves.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test's helpers may fail like the test"
)]

use crate::support;

use std::sync::Arc;

use crate::support::{GIANT, GROUND, HERO, Slab, giant, land, mode, step, step_with, weak_point};
use clamber_climber::{Blow, ClimberEvent, ClimberInput, ClimberMode, StepRules};
use clamber_colossus::{CreatureConfig, CreatureEvent, Noise};
use clamber_fight::actions::{BOW, STAB};
use clamber_fight::{
    Act, Arena, ArenaConfig, ArenaError, ArenaEvent, CreatureId, FighterConfig, FighterId, KindId,
    Order, ProjectileId, ProjectileMotion, fighter_obstacle,
};
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use glam::{DVec3, Vec3};

const IDLE: ClimberInput = ClimberInput::IDLE;
const OTHER: FighterId = FighterId(1);

fn state(arena: &Arena, fighter: FighterId) -> clamber_climber::ClimberState {
    *arena.fighter(fighter).unwrap().climber().state()
}

fn idle(arena: &mut Arena, orders: &[Order]) -> Vec<ArenaEvent> {
    let inputs = vec![IDLE; arena.fighters().len()];
    step_with(arena, &inputs, orders)
}

/// Two who stand on a slab that lies still.
fn pair() -> Arena {
    let places = [DVec3::Y * 1.5, DVec3::new(3.0, 1.5, 0.0)];
    let mut arena = Slab::default().arena(FighterConfig::hero(), &places);
    land(&mut arena);
    arena
}

#[test]
fn hit_points_are_taken_given_and_end() {
    let mut arena = pair();
    let hurt = |damage| Order::Hurt {
        fighter: HERO,
        damage,
    };
    let before = state(&arena, OTHER);
    idle(&mut arena, &[hurt(0.25), hurt(0.125)]);
    assert_eq!(state(&arena, HERO).hit_points, 0.625);
    // One after the other: what heals after a wound heals that one.
    let full = Order::Heal {
        fighter: HERO,
        hit_points: 1.0,
        stamina: 0.0,
    };
    idle(&mut arena, &[hurt(0.5), full, hurt(0.375)]);
    assert_eq!(state(&arena, HERO).hit_points, 0.625);
    let heal = Order::Heal {
        fighter: HERO,
        hit_points: 0.25,
        stamina: 0.0,
    };
    idle(&mut arena, std::slice::from_ref(&heal));
    assert_eq!(state(&arena, HERO).hit_points, 0.875);
    idle(&mut arena, std::slice::from_ref(&heal));
    assert_eq!(state(&arena, HERO).hit_points, 1.0, "more than full");
    let events = idle(&mut arena, &[hurt(1.0)]);
    assert!(events.contains(&ArenaEvent::Died { fighter: HERO }));
    // The dead are not healed, and rise where their checkpoint is.
    let place = DVec3::new(-4.0, 1.2, 2.0);
    let checkpoint = Order::Checkpoint {
        fighter: HERO,
        position: place,
    };
    idle(&mut arena, &[heal, checkpoint]);
    assert!(arena.fighter(HERO).unwrap().is_dead());
    let events = idle(&mut arena, &[Order::Rise { fighter: HERO }]);
    assert!(events.contains(&ArenaEvent::Rose { fighter: HERO }));
    let risen = state(&arena, HERO);
    assert_eq!(risen.hit_points, 1.0);
    assert!(risen.position.distance(place) < 0.05, "{}", risen.position);
    // Who lives does not rise, and the other one has noticed nothing.
    let events = idle(&mut arena, &[Order::Rise { fighter: HERO }]);
    assert!(!events.contains(&ArenaEvent::Rose { fighter: HERO }));
    let after = state(&arena, OTHER);
    assert_eq!(
        (before.hit_points, before.mode),
        (after.hit_points, after.mode)
    );
}

#[test]
fn who_dies_rises_at_its_last_checkpoint_by_itself() {
    let mut config = FighterConfig::hero();
    config.respawn = Some(0.5);
    let mut arena = Slab::default().arena(config, &[DVec3::Y * 1.5]);
    land(&mut arena);
    let place = DVec3::new(5.0, 1.2, -5.0);
    let orders = [
        Order::Checkpoint {
            fighter: HERO,
            position: place,
        },
        Order::Hurt {
            fighter: HERO,
            damage: 1.0,
        },
    ];
    idle(&mut arena, &orders);
    let rose = (0..60).any(|_| idle(&mut arena, &[]).contains(&ArenaEvent::Rose { fighter: HERO }));
    assert!(rose);
    assert!(state(&arena, HERO).position.distance(place) < 0.1);
}

#[test]
fn blows_throw_and_add_up() {
    let mut arena = pair();
    let blow = |x: f64, damage| Order::Strike {
        fighter: HERO,
        blow: Blow {
            velocity: DVec3::new(x, 5.0, 0.0),
            damage,
            by: None,
        },
    };
    idle(&mut arena, &[blow(-2.0, 0.25), blow(6.0, 0.25)]);
    let thrown = state(&arena, HERO);
    assert_eq!(thrown.hit_points, 0.5);
    assert!(
        thrown.velocity.x > 4.0 && thrown.velocity.y > 3.0,
        "{}",
        thrown.velocity
    );
    assert_ne!(mode(&arena), ClimberMode::Standing);
}

#[test]
fn who_is_put_somewhere_keeps_its_body_and_finds_room() {
    let mut arena = pair();
    let hurt = Order::Hurt {
        fighter: HERO,
        damage: 0.5,
    };
    idle(&mut arena, &[hurt]);
    step(&mut arena, &support::pressing(STAB));
    assert!(!matches!(arena.fighter(HERO).unwrap().act(), Act::Ready));
    let place = DVec3::new(-5.0, 2.0, 4.0);
    let put = |position| Order::PlaceFighter {
        fighter: HERO,
        position,
    };
    idle(&mut arena, &[put(place)]);
    let there = state(&arena, HERO);
    assert!(there.position.distance(place) < 0.01);
    assert_eq!(
        (there.hit_points, mode(&arena)),
        (0.5, ClimberMode::Falling)
    );
    assert!(matches!(arena.fighter(HERO).unwrap().act(), Act::Ready));
    // Onto somebody: it goes aside.
    let taken = state(&arena, OTHER).position;
    idle(&mut arena, &[put(taken)]);
    let radius = FighterConfig::hero().climber.body.radius;
    let apart = state(&arena, HERO).position.distance(taken);
    assert!((radius..8.0 * radius).contains(&apart), "{apart}");
    assert!(state(&arena, OTHER).position.distance(taken) < 0.02);
    for _ in 0..60 {
        idle(&mut arena, &[]);
    }
    assert_eq!(mode(&arena), ClimberMode::Standing);
    assert_eq!(state(&arena, HERO).hit_points, 0.5);
}

/// A creature that is placed leaves its rider behind; one that leaves lets riders fall and arrows come loose where they
/// are, not where they struck.
#[test]
fn riders_and_arrows_of_who_leaves_are_let_go() {
    for speed in [0.0f32, 4.0] {
        let moves = Slab {
            keys: vec![
                (0.0, Vec3::ZERO, Vec3::ONE),
                (600.0, Vec3::X * speed * 600.0, Vec3::ONE),
            ],
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
        // From rest: the skin's motion is no part of what is saved, and a peer that has just restored has none.
        assert!(velocity.x.abs() < 1e-9, "{velocity}");
        // Its number is not given again, and its fighters go on.
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

#[test]
fn who_is_on_a_creature_that_is_put_elsewhere_is_left_behind() {
    let mut arena = pair();
    assert_eq!(mode(&arena), ClimberMode::Standing);
    let before = state(&arena, HERO).position;
    let put = Order::PlaceCreature {
        creature: GIANT,
        position: DVec3::new(400.0, 50.0, 0.0),
        yaw: 1.0,
    };
    idle(&mut arena, &[put]);
    let creature = arena.creature(GIANT).unwrap();
    assert_eq!(creature.state().position().x, 400.0);
    assert_eq!(mode(&arena), ClimberMode::Falling);
    let after = state(&arena, HERO);
    assert!(after.position.distance(before) < 0.05, "{}", after.position);
    assert!(after.velocity.length() < 1.0, "{}", after.velocity);
}

/// Fighters join and leave in the middle of a fight: inputs are of those who were there before, numbers are not given
/// twice, and whom a creature hunts may leave.
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
    // Both began at one place: the second one went aside.
    let [a, b] = [2, 3].map(|number| state(&arena, FighterId(number)).position);
    assert!(a.distance(b) > 0.3, "{a} {b}");
    // Inputs belong to those that are there, in the order of their numbers.
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

/// An arrow goes on when who shot it has left, and does its damage.
#[test]
fn arrows_outlive_who_shot_them() {
    let slab = Slab {
        weak_points: vec![weak_point("heart", Vec3::ZERO, 9.0, 0)],
        ..Slab::default()
    };
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
    // It comes down where there is no ledge any more.
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

#[test]
fn creatures_are_sent_told_and_hurt() {
    let mut arena = Arena::new(ArenaConfig::default()).unwrap();
    let config = CreatureConfig::default();
    arena.add_creature(giant(), config).unwrap();
    let ground = HalfSpace::below(0.0);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ground)];
    let rules = StepRules::default();
    let mut give = |orders: &[Order], ticks: u32, wanted: &dyn Fn(&ArenaEvent) -> bool| {
        let mut found = false;
        for tick in 0..ticks {
            let orders = if tick == 0 { orders } else { &[] };
            let events = arena.step_with(&[], orders, &terrain, &rules).unwrap();
            found |= events.iter().any(wanted);
        }
        (found, arena.creature(GIANT).unwrap().clone())
    };
    // Heard in the same step.
    let place = DVec3::new(0.0, 0.0, 30.0);
    let noise = Order::Noise(Noise {
        place,
        loudness: 1.0,
    });
    let (_, creature) = give(&[noise], 1, &|_| true);
    let noise = creature
        .state()
        .senses()
        .get(clamber_colossus::Sense::Noise);
    assert!(noise > 0.0);
    let to = Some(DVec3::new(40.0, 0.0, 40.0));
    let creature = GIANT;
    let arrives = |event: &ArenaEvent| {
        matches!(
            event,
            ArenaEvent::Creature { event: CreatureEvent::Arrived { place }, .. } if Some(*place) == to
        )
    };
    let (arrived, _) = give(&[Order::Send { creature, to }], 60 * 60, &arrives);
    assert!(arrived);
    let enters = |event: &ArenaEvent| {
        matches!(
            event,
            ArenaEvent::Creature {
                event: CreatureEvent::Entered { .. },
                ..
            }
        )
    };
    let state = "roar".to_owned();
    let (entered, after) = give(&[Order::Enter { creature, state }], 1, &enters);
    assert!(entered);
    let path = after
        .kind()
        .brain()
        .path(after.state().current())
        .to_owned();
    assert!(path.ends_with("roar"), "{path}");
    // All of its weak points one after the other: it is killed, by nobody.
    let points = after.kind().weak_points().iter().enumerate();
    let orders: Vec<Order> = points
        .map(|(weak_point, point)| Order::Harm {
            creature,
            weak_point,
            damage: point.hit_points,
        })
        .collect();
    let killed = ArenaEvent::Killed { creature, by: None };
    let (killed, after) = give(&orders, 1, &|event| *event == killed);
    assert!(killed && after.health() == 0.0);
}

/// Orders to those who are not there, or no more, change nothing and are told; also within one list.
#[test]
fn orders_to_nobody_are_told() {
    let mut arena = pair();
    let gone = FighterId(7);
    let orders = [
        Order::Hurt {
            fighter: gone,
            damage: 1.0,
        },
        Order::RemoveProjectile {
            projectile: ProjectileId(3),
        },
        Order::RemoveFighter { fighter: OTHER },
        Order::RemoveFighter { fighter: OTHER },
        Order::Send {
            creature: CreatureId(9),
            to: None,
        },
        Order::Enter {
            creature: CreatureId(9),
            state: "nothing".to_owned(),
        },
    ];
    let events = step_with(&mut arena, &[IDLE; 2], &orders);
    let unheard = |event: &ArenaEvent| match event {
        ArenaEvent::Unheard { order } => Some(*order),
        _ => None,
    };
    let unheard: Vec<usize> = events.iter().filter_map(unheard).collect();
    assert_eq!(unheard, [0, 1, 3, 4, 5]);
}

#[test]
fn orders_that_cannot_be_followed_are_refused_and_nothing_is_changed() {
    let mut arena = pair();
    let (fighter, creature) = (HERO, GIANT);
    let hero = || Box::new(FighterConfig::hero());
    let mut broken = hero();
    broken.climber.body.radius = f64::NAN;
    let nowhere = DVec3::new(0.0, f64::NAN, 0.0);
    let far = DVec3::X * 1e13;
    let hurt = |damage| Order::Hurt { fighter, damage };
    let blow = |velocity, damage| Order::Strike {
        fighter,
        blow: Blow {
            velocity,
            damage,
            by: None,
        },
    };
    let noise = |place, loudness| Order::Noise(Noise { place, loudness });
    let kind = arena.kinds().next().unwrap().0;
    let wrong = [
        (hurt(f64::NAN), "damage"),
        (hurt(-0.1), "damage"),
        (hurt(1.5), "damage"),
        (
            Order::Heal {
                fighter,
                hit_points: 0.0,
                stamina: 2.0,
            },
            "stamina",
        ),
        (blow(nowhere, 0.1), "velocity"),
        (blow(DVec3::X, f64::INFINITY), "damage"),
        (noise(nowhere, 1.0), "place"),
        (noise(DVec3::X, -1.0), "loudness"),
        (
            Order::PlaceFighter {
                fighter,
                position: nowhere,
            },
            "place",
        ),
        (
            Order::Checkpoint {
                fighter,
                position: far,
            },
            "place",
        ),
        (
            Order::AddFighter {
                config: broken,
                position: DVec3::Y,
            },
            "radius",
        ),
        (
            Order::AddFighter {
                config: hero(),
                position: nowhere,
            },
            "position",
        ),
        (
            Order::AddCreature {
                kind: KindId(kind.0 ^ 1),
                config: CreatureConfig::default(),
            },
            "add_kind",
        ),
        (
            Order::AddCreature {
                kind,
                config: CreatureConfig {
                    scale: 0.0,
                    ..CreatureConfig::default()
                },
            },
            "scale",
        ),
        (
            Order::AddCreature {
                kind,
                config: CreatureConfig {
                    position: far,
                    ..CreatureConfig::default()
                },
            },
            "position",
        ),
        (
            Order::Sense {
                creature,
                name: "hunger".to_owned(),
                value: 1.0,
            },
            "hunger",
        ),
        (
            Order::Send {
                creature,
                to: Some(DVec3::Z),
            },
            "walk",
        ),
        (
            Order::Enter {
                creature,
                state: "flies".to_owned(),
            },
            "lies",
        ),
        (
            Order::PlaceCreature {
                creature,
                position: DVec3::ZERO,
                yaw: f64::NAN,
            },
            "heading",
        ),
        (
            Order::Harm {
                creature,
                weak_point: 0,
                damage: 1.0,
            },
            "weak point",
        ),
    ];
    let before = arena.fingerprint();
    let rules = StepRules::default();
    for (order, words) in wrong {
        // After some that can be followed.
        let orders = [hurt(0.1), noise(DVec3::X, 1.0), order];
        let refused = arena
            .step_with(&[IDLE; 2], &orders, &[], &rules)
            .unwrap_err();
        assert!(
            matches!(refused, ArenaError::Order { index: 2, .. }),
            "{refused}"
        );
        assert!(refused.to_string().contains(words), "{refused}");
        assert_eq!(arena.fingerprint(), before, "{refused}");
    }
}

#[test]
fn orders_come_back_from_their_bytes() {
    let orders = vec![
        Order::AddFighter {
            config: Box::new(FighterConfig::hero()),
            position: DVec3::new(-0.0, f64::MIN_POSITIVE, 1.0 / 3.0),
        },
        Order::Rise { fighter: HERO },
        Order::AddCreature {
            kind: KindId(u64::MAX),
            config: CreatureConfig {
                arena: f64::INFINITY,
                ..CreatureConfig::default()
            },
        },
    ];
    let bytes = Order::to_bytes(&orders).unwrap();
    assert_eq!(Order::from_bytes(&bytes).unwrap(), orders);
    let longer = [&bytes[..], &[0]].concat();
    for wrong in [&bytes[..bytes.len() - 1], &longer, &[255; 40]] {
        let refused = Order::from_bytes(wrong).unwrap_err();
        assert!(matches!(refused, ArenaError::Damaged(_)), "{refused}");
    }
}

/// Somebody who is held by another one, and whom a creature hunts, leaves: the others go on, and are let go.
#[test]
fn who_is_held_and_hunted_may_leave() {
    let mut arena = Arena::new(ArenaConfig::default()).unwrap();
    arena
        .add_creature(giant(), CreatureConfig::default())
        .unwrap();
    let low = DVec3::new(0.0, 1.0, 25.0);
    for place in [low, low + DVec3::Y * 2.0] {
        arena.add_fighter(FighterConfig::hero(), place).unwrap();
    }
    let ground = HalfSpace::below(0.0);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ground)];
    for _ in 0..60 * 5 {
        arena.step(&[IDLE; 2], &terrain).unwrap();
    }
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
    for _ in 0..60 * 10 {
        arena.step(&[IDLE], &terrain).unwrap();
    }
    let alone = state(&arena, OTHER);
    assert!(alone.position.y < 1.0, "{}", alone.position);
}

/// Of two arenas, one of which has just restored what the other one is, an arrow falls alike out of who leaves; and whoever
/// joins in a step may be told something in it.
#[test]
fn a_restored_arena_follows_orders_alike() {
    let moves = Slab {
        keys: vec![
            (0.0, Vec3::ZERO, Vec3::ONE),
            (600.0, Vec3::X * 4.0 * 600.0, Vec3::ONE),
        ],
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
    // A typo in an order to who joins is refused as one to who is there.
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
    // More than is sensible.
    let many = vec![joins; 300];
    let refused = arena.step_with(&inputs, &many, &[], &rules);
    assert!(matches!(refused, Err(ArenaError::Order { index: 256, .. })));
    assert_eq!(arena.fingerprint(), twin.fingerprint());
}

/// A fresh arena that knows nothing but the kinds goes on alike from any tick, whoever has joined and left before.
#[test]
fn a_fresh_arena_takes_whoever_has_joined() {
    let kind = giant();
    let mut arena = Arena::new(ArenaConfig::default()).unwrap();
    let id = arena.add_kind(Arc::clone(&kind)).unwrap();
    let slab = arena.add_kind(Slab::default().kind()).unwrap();
    let ground = HalfSpace::below(0.0);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ground)];
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
    // Back to before anybody was there, in an arena that has some.
    let mut empty = Arena::new(ArenaConfig::default()).unwrap();
    arena.restore(&empty.save()).unwrap();
    assert_eq!(arena.fingerprint(), empty.fingerprint());
    assert!(arena.creatures().len() == 0 && arena.fighters().is_empty());
    arena.step(&[], &terrain).unwrap();
    empty.step(&[], &terrain).unwrap();
    assert_eq!(arena.fingerprint(), empty.fingerprint());
}
