//! Orders, except those that add and remove fighters and creatures, which are tested in `joining`.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test's helpers may fail like the test"
)]

use crate::support;

use crate::support::{GIANT, GROUND, HERO, Slab, giant, land, mode, step, step_with};
use clamber_climber::{Blow, ClimberInput, ClimberMode, StepRules};
use clamber_colossus::{CreatureConfig, CreatureEvent, Noise};
use clamber_fight::actions::STAB;
use clamber_fight::{
    Arena, ArenaConfig, ArenaError, ArenaEvent, CreatureId, FighterConfig, FighterId, KindId,
    Order, ProjectileId, WeaponAction,
};
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use glam::DVec3;

/// An input without buttons or directions.
pub(crate) const IDLE: ClimberInput = ClimberInput::IDLE;
/// The second fighter of [`pair`].
pub(crate) const OTHER: FighterId = FighterId(1);

pub(crate) fn state(arena: &Arena, fighter: FighterId) -> clamber_climber::ClimberState {
    *arena.fighter(fighter).unwrap().climber().state()
}

pub(crate) fn idle(arena: &mut Arena, orders: &[Order]) -> Vec<ArenaEvent> {
    let inputs = vec![IDLE; arena.fighters().len()];
    step_with(arena, &inputs, orders)
}

/// An arena with two fighters on a slab at rest.
pub(crate) fn pair() -> Arena {
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
    // Orders are followed one after another: healing restores the hit points that were lost earlier in the list.
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
    // A dead fighter is not healed, and is revived at its checkpoint.
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
    // A living fighter is not revived, and the other fighter has not changed.
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
    assert!(!matches!(
        arena.fighter(HERO).unwrap().act(),
        WeaponAction::Ready
    ));
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
    assert!(matches!(
        arena.fighter(HERO).unwrap().act(),
        WeaponAction::Ready
    ));
    // Moved onto the other fighter, it is put beside that fighter.
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

/// A blow that still waits for its tick is dropped when the fighter is moved.
#[test]
fn who_is_put_somewhere_is_not_struck_there() {
    let mut arena = pair();
    let strike = Order::Strike {
        fighter: HERO,
        blow: Blow {
            velocity: DVec3::new(6.0, 5.0, 0.0),
            damage: 0.25,
            by: None,
        },
    };
    let put = Order::PlaceFighter {
        fighter: HERO,
        position: DVec3::new(-5.0, 2.0, 4.0),
    };
    idle(&mut arena, &[strike, put]);
    let there = state(&arena, HERO);
    assert!(there.velocity.length() < 1.0, "{}", there.velocity);
    assert_eq!(there.hit_points, 1.0);
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
    // The creature hears the noise in the same step.
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
    // An order uses up each of its weak points. The creature is killed, and the event names no fighter.
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

/// Orders to fighters, creatures and projectiles that are not there, or have left earlier in the same list, change
/// nothing and are reported.
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
        // The refused order follows two that could be followed.
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

/// A creature at the farthest allowed place goes on, and can be saved and restored.
#[test]
fn what_is_put_far_away_can_be_restored() {
    let mut arena = pair();
    let far = DVec3::new(1e12, 0.0, -1e12);
    let put = Order::PlaceCreature {
        creature: GIANT,
        position: far,
        yaw: 0.7,
    };
    idle(&mut arena, &[put]);
    for _ in 0..30 {
        idle(&mut arena, &[]);
    }
    let bytes = arena.to_bytes().unwrap();
    pair().restore_bytes(&bytes).unwrap();
}
