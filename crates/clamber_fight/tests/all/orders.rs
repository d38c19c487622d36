//! Orders, except those that add and remove fighters and creatures, which are tested in `joining`.

use crate::support;

use crate::support::{GIANT, HERO, Slab, giant, land, level_ground, mode, step, step_with};
use clamber_climber::{ClimberInput, ClimberMode, Knockback, StepRules};
use clamber_colossus::{CreatureConfig, CreatureEvent, Noise};
use clamber_fight::actions::STAB;
use clamber_fight::{
    Arena, ArenaConfig, ArenaError, ArenaEvent, CreatureId, FighterConfig, FighterId, KindId,
    Order, ProjectileId, WeaponAction,
};
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

fn hurt(damage: f64) -> Order {
    let fighter = HERO;
    Order::Hurt { fighter, damage }
}

fn put(position: DVec3) -> Order {
    let fighter = HERO;
    Order::PlaceFighter { fighter, position }
}

fn checkpoint(position: DVec3) -> Order {
    let fighter = HERO;
    Order::Checkpoint { fighter, position }
}

fn heal(hit_points: f64, stamina: f64) -> Order {
    Order::Heal {
        fighter: HERO,
        hit_points,
        stamina,
    }
}

fn strike(velocity: DVec3, damage: f64) -> Order {
    Order::Strike {
        fighter: HERO,
        knockback: Knockback {
            velocity,
            damage,
            by: None,
        },
    }
}

fn put_creature(position: DVec3, yaw: f64) -> Order {
    Order::PlaceCreature {
        creature: GIANT,
        position,
        yaw,
    }
}

#[test]
fn hit_points_are_taken_given_and_end() {
    let mut arena = pair();
    let before = state(&arena, OTHER);
    idle(&mut arena, &[hurt(0.25), hurt(0.125)]);
    assert_eq!(state(&arena, HERO).hit_points, 0.625);
    // Orders are followed one after another: healing restores the hit points that were lost earlier in the list.
    idle(&mut arena, &[hurt(0.5), heal(1.0, 0.0), hurt(0.375)]);
    assert_eq!(state(&arena, HERO).hit_points, 0.625);
    idle(&mut arena, &[heal(0.25, 0.0)]);
    assert_eq!(state(&arena, HERO).hit_points, 0.875);
    idle(&mut arena, &[heal(0.25, 0.0)]);
    assert_eq!(state(&arena, HERO).hit_points, 1.0, "more than full");
    let events = idle(&mut arena, &[hurt(1.0)]);
    assert!(events.contains(&ArenaEvent::Died { fighter: HERO }));
    // A dead fighter is not healed, and is revived at its checkpoint.
    let place = DVec3::new(-4.0, 1.2, 2.0);
    idle(&mut arena, &[heal(0.25, 0.0), checkpoint(place)]);
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
    idle(&mut arena, &[checkpoint(place), hurt(1.0)]);
    let rose = (0..60).any(|_| idle(&mut arena, &[]).contains(&ArenaEvent::Rose { fighter: HERO }));
    assert!(rose);
    assert!(state(&arena, HERO).position.distance(place) < 0.1);
}

#[test]
fn blows_throw_and_add_up() {
    let mut arena = pair();
    let blow = |x: f64, damage| strike(DVec3::new(x, 5.0, 0.0), damage);
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
    idle(&mut arena, &[hurt(0.5)]);
    step(&mut arena, &support::pressing(STAB));
    assert!(!matches!(
        arena.fighter(HERO).unwrap().act(),
        WeaponAction::Ready
    ));
    let place = DVec3::new(-5.0, 2.0, 4.0);
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

#[test]
fn arrows_are_added_where_they_are_counted() {
    let order = |arrows| Order::AddArrows {
        fighter: HERO,
        arrows,
    };
    let mut config = FighterConfig::hero();
    config.bow.as_mut().unwrap().arrows = Some(2);
    let mut arena = Slab::default().arena(config, &[DVec3::Y * 1.5]);
    idle(&mut arena, &[order(3)]);
    assert_eq!(arena.fighter(HERO).unwrap().arrows(), Some(5));
    idle(&mut arena, &[order(u32::MAX)]);
    assert_eq!(arena.fighter(HERO).unwrap().arrows(), Some(u32::MAX));
    // Nothing changes where they are not counted.
    let [mut with, mut without] = [pair(), pair()];
    let events = idle(&mut with, &[order(3)]);
    assert_eq!(events, idle(&mut without, &[]));
    assert_eq!(with.fighter(HERO).unwrap().arrows(), None);
    assert_eq!(with.fingerprint(), without.fingerprint());
}

/// A blow that still waits for its tick is dropped when the fighter is moved.
#[test]
fn who_is_put_somewhere_is_not_struck_there() {
    let mut arena = pair();
    let blow = strike(DVec3::new(6.0, 5.0, 0.0), 0.25);
    idle(&mut arena, &[blow, put(DVec3::new(-5.0, 2.0, 4.0))]);
    let there = state(&arena, HERO);
    assert!(there.velocity.length() < 1.0, "{}", there.velocity);
    assert_eq!(there.hit_points, 1.0);
}

#[test]
fn who_is_on_a_creature_that_is_put_elsewhere_is_left_behind() {
    let mut arena = pair();
    assert_eq!(mode(&arena), ClimberMode::Standing);
    let before = state(&arena, HERO).position;
    let elsewhere = DVec3::new(400.0, 50.0, 0.0);
    idle(&mut arena, &[put_creature(elsewhere, 1.0)]);
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
    let terrain = level_ground();
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
    let creature = GIANT;
    let hero = || Box::new(FighterConfig::hero());
    let mut broken = hero();
    broken.climber.body.radius = f64::NAN;
    let nowhere = DVec3::new(0.0, f64::NAN, 0.0);
    let far = DVec3::X * 1e13;
    let noise = |place, loudness| Order::Noise(Noise { place, loudness });
    let join = |config, position| Order::AddFighter { config, position };
    let known = arena.kinds().next().unwrap().0;
    let add = |kind, config| Order::AddCreature { kind, config };
    let usual = CreatureConfig::default();
    let flat = CreatureConfig {
        scale: 0.0,
        ..usual
    };
    let away = CreatureConfig {
        position: far,
        ..usual
    };
    let sense = Order::Sense {
        creature,
        name: "hunger".to_owned(),
        value: 1.0,
    };
    let (to, state) = (Some(DVec3::Z), "flies".to_owned());
    let harm = Order::Harm {
        creature,
        weak_point: 0,
        damage: 1.0,
    };
    let wrong = [
        (hurt(f64::NAN), "damage"),
        (hurt(-0.1), "damage"),
        (hurt(1.5), "damage"),
        (heal(0.0, 2.0), "stamina"),
        (strike(nowhere, 0.1), "velocity"),
        (strike(DVec3::X, f64::INFINITY), "damage"),
        (noise(nowhere, 1.0), "place"),
        (noise(DVec3::X, -1.0), "loudness"),
        (put(nowhere), "place"),
        (checkpoint(far), "place"),
        (join(broken, DVec3::Y), "radius"),
        (join(hero(), nowhere), "position"),
        (add(KindId(known.0 ^ 1), usual), "add_kind"),
        (add(known, flat), "scale"),
        (add(known, away), "position"),
        (sense, "hunger"),
        (Order::Send { creature, to }, "walk"),
        (Order::Enter { creature, state }, "lies"),
        (put_creature(DVec3::ZERO, f64::NAN), "heading"),
        (harm, "weak point"),
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
    idle(&mut arena, &[put_creature(far, 0.7)]);
    for _ in 0..30 {
        idle(&mut arena, &[]);
    }
    let bytes = arena.to_bytes().unwrap();
    pair().restore_bytes(&bytes).unwrap();
}
