//! Fighters in an arena: hit-stop, death, respawn, the sword's light, and refused inputs. Scenes B34 and B35.

use crate::support;

use crate::support::{
    GIANT, GROUND, HERO, Slab, land, low_ground, mode, pressing, rest, step, step_with, weak_point,
};
use clamber_climber::{ClimberError, ClimberInput, ClimberMode, Knockback, StepRules};
use clamber_colossus::CreatureConfig;
use clamber_fight::actions::STAB;
use clamber_fight::{
    Arena, ArenaConfig, ArenaError, ArenaEvent, ArenaState, FighterConfig, FighterId, Order,
    WeaponAction,
};
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use glam::{DVec3, Vec3};

fn swaying() -> Slab {
    let keys = (0..=60)
        .map(|k| {
            let t = k as f32 * 0.25;
            let x = libm::sin(f64::from(t)) as f32;
            (t, Vec3::new(x, 0.2 * x, 0.0), Vec3::ONE)
        })
        .collect();
    Slab {
        keys,
        weak_points: vec![
            weak_point("heart", Vec3::ZERO, 9.0, 0),
            weak_point("brain", Vec3::X * 5.0, 1.0, 1),
        ],
        ..Slab::default()
    }
}

/// Two fighters stand on the slab, and the first one stabs. Returns all states, and the number of ticks with a
/// hit-stop.
fn stabbing(hit_stop: f64) -> (Vec<ArenaState>, u32) {
    let config = FighterConfig {
        hit_stop,
        ..FighterConfig::hero()
    };
    let mut arena = swaying().arena(
        config,
        &[DVec3::new(-2.0, 1.0, 0.0), DVec3::new(4.0, 1.0, 2.0)],
    );
    let terrain = low_ground();
    let (mut states, mut held) = (Vec::new(), 0);
    for tick in 0..240 {
        let ours = pressing(if tick == 60 || tick == 120 { STAB } else { 0 });
        let other = ClimberInput {
            walk: DVec3::Z * 0.1,
            ..ClimberInput::IDLE
        };
        arena.step(&[ours, other], &terrain).unwrap();
        let state = arena.save();
        held += u32::from(state.fighters[0].state.hit_stop > 0.0);
        states.push(state);
    }
    (states, held)
}

#[test]
fn an_impact_holds_whoever_struck_and_nobody_else() {
    let ((with, held), (without, free)) = (stabbing(0.1), stabbing(0.0));
    assert_eq!((held, free), (6, 0));
    let mut differs = 0;
    for (a, b) in with.iter().zip(&without) {
        assert!(
            a.creatures == b.creatures,
            "the creature feels it at {}",
            a.tick
        );
        assert!(
            a.fighters[1].state == b.fighters[1].state,
            "another fighter feels it at {}",
            a.tick
        );
        differs += u32::from(a.fighters[0].state != b.fighters[0].state);
    }
    assert!(differs >= 6, "the blade is held: {differs}");
}

#[test]
fn whoever_dies_falls_and_stands_up_where_it_began() {
    let mut config = FighterConfig::hero();
    config.respawn = Some(1.0);
    let mut arena = Slab::default().arena(config, &[DVec3::new(0.0, 60.0, 0.0)]);
    let mut events = Vec::new();
    while !events.contains(&ArenaEvent::Died { fighter: HERO }) {
        events = step(&mut arena, &ClimberInput::IDLE);
        assert!(arena.tick() < 1000);
    }
    assert!(arena.fighter(HERO).unwrap().is_dead());
    let at = arena.tick();
    while !events.contains(&ArenaEvent::Rose { fighter: HERO }) {
        // A dead fighter neither walks nor strikes.
        events = step(
            &mut arena,
            &ClimberInput {
                walk: DVec3::X,
                actions: STAB,
                ..ClimberInput::IDLE
            },
        );
        assert_eq!(arena.fighter(HERO).unwrap().act(), &WeaponAction::Ready);
        let lies = mode(&arena) == ClimberMode::Tumbling;
        assert!(lies || events.contains(&ArenaEvent::Rose { fighter: HERO }));
    }
    assert!(
        (arena.tick() - at).abs_diff(60) <= 1,
        "{}",
        arena.tick() - at
    );
    let state = *arena.fighter(HERO).unwrap().climber().state();
    assert_eq!((state.position, state.hit_points), (DVec3::Y * 60.0, 1.0));

    // A fighter that falls below the world's floor dies as well.
    let config = FighterConfig {
        respawn: None,
        ..FighterConfig::hero()
    };
    let mut arena = Arena::new(ArenaConfig {
        floor: -20.0,
        ..ArenaConfig::default()
    })
    .unwrap();
    arena.add_fighter(config, DVec3::ZERO).unwrap();
    let died = (0..600).any(|_| {
        let input = [ClimberInput::IDLE; 1];
        arena
            .step(&input, &[])
            .unwrap()
            .contains(&ArenaEvent::Died { fighter: HERO })
    });
    assert!(died && arena.fighter(HERO).unwrap().is_dead());
    rest(&mut arena, &[], 1000);
    assert!(arena.fighter(HERO).unwrap().is_dead(), "forever");
}

#[test]
fn a_sword_shows_the_way_in_the_sun() {
    let mut arena = swaying().arena(FighterConfig::hero(), &[DVec3::new(-2.0, 1.0, 0.0)]);
    land(&mut arena);
    let terrain = low_ground();
    for _ in 0..50 {
        step(&mut arena, &ClimberInput::IDLE);
        let creature = arena.creature(GIANT).unwrap();
        let origin = arena.fighter(HERO).unwrap().blade().unwrap().tip;
        let to = (creature.weak_point(0).unwrap() - origin).normalize();
        let aside = to.any_orthonormal_vector();
        let mut before = f64::INFINITY;
        // As the sword turns from the opposite direction to the weak point, the rays gather.
        for degrees in (0..=180).rev() {
            let (sin, cos) = libm::sincos(f64::from(degrees).to_radians());
            let light = arena
                .sword_light(HERO, to * cos + aside * sin, &terrain)
                .unwrap();
            assert_eq!((light.creature, light.weak_point), (GIANT, 0));
            assert!((light.off.to_degrees() - f64::from(degrees)).abs() < 1e-6);
            assert!(light.spread < before, "{degrees}");
            before = light.spread;
            if degrees == 0 {
                for ray in light.rays {
                    let off = libm::acos(ray.dot(to).clamp(-1.0, 1.0)).to_degrees();
                    assert!(off < 0.5, "{off} degrees off");
                }
            }
        }
    }
    // No light in the shade of terrain, and of another creature.
    let roof = HalfSpace::behind(DVec3::Y * 50.0, DVec3::NEG_Y).unwrap();
    assert_eq!(arena.sword_light(HERO, DVec3::X, &[(GROUND, &roof)]), None);
    let config = CreatureConfig {
        position: DVec3::new(-2.0, 10.0, 8.0),
        ..CreatureConfig::default()
    };
    let kind = arena.add_kind(Slab::default().kind()).unwrap();
    let joins = [Order::AddCreature { kind, config }];
    step_with(&mut arena, &[ClimberInput::IDLE], &joins);
    assert!(arena.fighter(HERO).unwrap().blade().is_some());
    assert_eq!(arena.sword_light(HERO, DVec3::X, &terrain), None);
}

/// When a weak point is used up, the light leads to the next one in the same tick. (There is no light while the blade
/// is in the skin, which shades it.)
#[test]
fn the_light_leads_to_the_next_weak_point_at_once() {
    let mut slab = swaying();
    slab.weak_points[0].hit_points = 0.5;
    let mut arena = slab.arena(FighterConfig::hero(), &[DVec3::Y]);
    land(&mut arena);
    let aimed = |arena: &Arena| {
        let light = arena
            .sword_light(HERO, DVec3::X, &[])
            .map(|light| light.weak_point);
        let next = arena
            .next_weak_point(DVec3::Y)
            .map(|(_, weak_point, _)| weak_point);
        assert!(light.is_none() || light == next);
        next
    };
    assert_eq!(aimed(&arena), Some(0));
    step(&mut arena, &pressing(STAB));
    for _ in 0..100 {
        step(&mut arena, &ClimberInput::IDLE);
    }
    let mut events = step(&mut arena, &pressing(STAB));
    while support::hits(&events).is_empty() {
        assert_eq!(aimed(&arena), Some(0));
        events = step(&mut arena, &ClimberInput::IDLE);
    }
    assert_eq!(aimed(&arena), Some(1));
}

#[test]
fn bad_inputs_change_nothing() {
    let mut arena = swaying().arena(
        FighterConfig::hero(),
        &[DVec3::Y, DVec3::new(3.0, 1.0, 0.0)],
    );
    land(&mut arena);
    let before = arena.fingerprint();
    let refused = |arena: &mut Arena, inputs: &[ClimberInput]| arena.step(inputs, &[]).unwrap_err();
    let few = refused(&mut arena, &[ClimberInput::IDLE]);
    assert!(
        matches!(
            few,
            ArenaError::Inputs {
                fighters: 2,
                found: 1
            }
        ),
        "{few}"
    );
    let wild = ClimberInput {
        walk: DVec3::NAN,
        ..ClimberInput::IDLE
    };
    let wild = refused(&mut arena, &[ClimberInput::IDLE, wild]);
    assert!(
        matches!(wild, ArenaError::InputNotFinite { fighter: 1 }),
        "{wild}"
    );
    let rules = StepRules {
        air_velocity: DVec3::X * f64::INFINITY,
        ..StepRules::default()
    };
    let wind = arena.step_with(&[ClimberInput::IDLE; 2], &[], &[], &rules);
    let wind = wind.unwrap_err();
    let is_wind = matches!(
        wind,
        ArenaError::Climber(ClimberError::NotFinite("air_velocity"))
    );
    assert!(is_wind, "{wind}");
    let ground = HalfSpace::below(0.0);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(u64::MAX), &ground)];
    let id = arena.step(&[ClimberInput::IDLE; 2], &terrain).unwrap_err();
    assert!(matches!(id, ArenaError::TerrainId { .. }), "{id}");
    let twice: [(ObstacleId, &dyn Obstacle); 2] =
        [(ObstacleId(7), &ground), (ObstacleId(7), &ground)];
    let twice = arena.step(&[ClimberInput::IDLE; 2], &twice).unwrap_err();
    assert!(
        matches!(twice, ArenaError::TerrainTwice { found: 7 }),
        "{twice}"
    );
    assert_eq!(arena.fingerprint(), before);
    assert_eq!(mode(&arena), ClimberMode::Standing);

    // After the first step, fighters and creatures can join only by orders.
    let begun = arena.add_fighter(FighterConfig::hero(), DVec3::Y);
    assert!(matches!(begun, Err(ArenaError::Begun)));
    let kind = Slab::default().kind();
    let begun = arena.add_creature(kind, CreatureConfig::default());
    assert!(matches!(begun, Err(ArenaError::Begun)));
    assert_eq!(arena.fingerprint(), before);

    // Configurations outside their ranges are refused.
    let mut arena = Slab::default().arena(FighterConfig::hero(), &[DVec3::Y, DVec3::X]);
    let before = arena.fingerprint();
    let mut config = FighterConfig::hero();
    config.sword.as_mut().unwrap().charge = 0.0;
    assert!(matches!(
        arena.add_fighter(config, DVec3::Y),
        Err(ArenaError::OutOfRange {
            name: "sword.charge",
            ..
        })
    ));
    assert!(
        arena
            .add_fighter(FighterConfig::hero(), DVec3::NAN)
            .is_err()
    );
    let other = Slab {
        rate: 30.0,
        ..Slab::default()
    };
    let other = arena
        .add_creature(other.kind(), CreatureConfig::default())
        .unwrap_err();
    assert!(matches!(other, ArenaError::Tick { .. }), "{other}");
    assert_eq!(arena.fingerprint(), before);
    assert_eq!(arena.fighters().len(), 2);
    assert_eq!(arena.fighter(FighterId(2)).map(|one| one.id()), None);
}

/// The arena deals the blows itself: a knockback in the game's rules strikes nobody, and a bad one is no error.
#[test]
fn a_knockback_in_the_rules_strikes_nobody() {
    for velocity in [DVec3::new(9.0, 9.0, 0.0), DVec3::NAN] {
        let places = [DVec3::new(3.0, 1.5, 3.0), DVec3::new(-3.0, 1.5, 0.0)];
        let arena = || swaying().arena(FighterConfig::hero(), &places);
        let (mut one, mut other) = (arena(), arena());
        let knockback = Knockback {
            velocity,
            damage: 0.5,
            by: None,
        };
        let rules = StepRules {
            knockback: Some(knockback),
            ..StepRules::default()
        };
        for tick in 0..30 {
            let idle = [ClimberInput::IDLE; 2];
            one.step(&idle, &[]).unwrap();
            other.step_with(&idle, &[], &[], &rules).unwrap();
            let bits = [&one, &other].map(Arena::fingerprint);
            assert_eq!(bits[0], bits[1], "tick {tick}, {velocity}");
        }
    }
}
