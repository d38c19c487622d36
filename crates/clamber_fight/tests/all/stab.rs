//! Stabs: charge, damage, interruptions, and targets. Scenes B26 to B28.

use crate::behind::block;
use crate::orders::state;
use crate::support::{
    GIANT, GROUND, HERO, Slab, hits, land, mode, pressing, step, step_with, weak_point,
};
use clamber_climber::{ClimberInput, ClimberMode};
use clamber_fight::actions::STAB;
use clamber_fight::{
    Arena, ArenaEvent, FighterConfig, Order, StabTarget, SwordConfig, WeaponAction,
};
use clamber_world::{Obstacle, ObstacleId};
use glam::{DVec3, Vec3};

/// Tick rates of the tests, ticks a second.
const RATES: [f64; 4] = [30.0, 60.0, 120.0, 240.0];

/// An input that only grips.
const GRIPS: ClimberInput = ClimberInput {
    grip: true,
    ..ClimberInput::IDLE
};

fn hero() -> FighterConfig {
    FighterConfig {
        hit_stop: 0.0,
        ..FighterConfig::hero()
    }
}

fn act(arena: &Arena) -> WeaponAction {
    arena.fighter(HERO).unwrap().act().clone()
}

fn charge(arena: &Arena) -> f64 {
    arena.fighter(HERO).unwrap().charge()
}

/// A step in which the stab button is pressed.
fn press(arena: &mut Arena, hold: &ClimberInput) -> Vec<ArenaEvent> {
    let pressed = ClimberInput {
        actions: STAB,
        ..*hold
    };
    step(arena, &pressed)
}

/// Presses the stab button, and waits until the sword is raised.
fn raise(arena: &mut Arena, hold: &ClimberInput) {
    press(arena, hold);
    for _ in 0..600 {
        if matches!(act(arena), WeaponAction::Charge { .. }) {
            return;
        }
        step(arena, hold);
    }
    panic!("{:?}", act(arena));
}

/// Strikes, and returns the damages of the hits.
fn strike(arena: &mut Arena, hold: &ClimberInput) -> Vec<f64> {
    let mut all = hits(&press(arena, hold));
    for _ in 0..600 {
        if act(arena) == WeaponAction::Ready {
            return all;
        }
        all.append(&mut hits(&step(arena, hold)));
    }
    panic!("{:?}", act(arena));
}

fn with_weak_point(rate: f64, hit_points: f64) -> Slab {
    Slab {
        rate,
        ..Slab::with_heart(hit_points)
    }
}

#[test]
fn a_stab_is_fully_charged_after_two_seconds_and_sooner_while_pressed() {
    for rate in RATES {
        for (held, seconds) in [(0, 2.0), (STAB, 1.6)] {
            let mut arena = with_weak_point(rate, 9.0).arena(hero(), &[DVec3::Y]);
            land(&mut arena);
            let hold = pressing(held);
            raise(&mut arena, &hold);
            let mut ticks = 0;
            while charge(&arena) < 1.0 {
                step(&mut arena, &hold);
                ticks += 1;
            }
            let expected = seconds * rate;
            assert!(
                (f64::from(ticks) - expected).abs() <= 1.0,
                "{rate} Hz: {ticks} for {expected}"
            );
        }
    }
}

#[test]
fn damage_is_proportional_to_the_charge() {
    for rate in RATES {
        for share in [0.25, 0.5, 0.75, 1.0] {
            let mut arena = with_weak_point(rate, 9.0).arena(hero(), &[DVec3::Y]);
            land(&mut arena);
            raise(&mut arena, &ClimberInput::IDLE);
            while charge(&arena) < share - 1e-9 {
                step(&mut arena, &ClimberInput::IDLE);
            }
            let charged = charge(&arena);
            let done = strike(&mut arena, &ClimberInput::IDLE);
            assert_eq!(done.len(), 1, "{done:?}");
            assert!(
                (done[0] - charged).abs() < 0.01 * charged,
                "{rate} Hz: {done:?} of {charged}"
            );
        }
    }
}

/// Skin that starts to move with a constant acceleration while a stab is charged. Above a shake of 15 m/s^2, a climber
/// only hangs.
fn jerking(rate: f64, acceleration: f32) -> Slab {
    // The skin is at rest for five seconds, accelerates for one second, and then keeps its velocity.
    let mut keys = vec![(0.0, Vec3::ZERO, Vec3::ONE), (5.0, Vec3::ZERO, Vec3::ONE)];
    for k in 1..=240 {
        let t = k as f32 / 240.0;
        keys.push((5.0 + t, Vec3::X * (0.5 * acceleration * t * t), Vec3::ONE));
    }
    keys.push((
        20.0,
        Vec3::X * (0.5 * acceleration + acceleration * 14.0),
        Vec3::ONE,
    ));
    Slab {
        keys,
        ..with_weak_point(rate, 9.0)
    }
}

#[test]
fn a_shake_beyond_the_hang_threshold_breaks_a_stab_off_within_a_tick() {
    for rate in RATES {
        for (acceleration, breaks) in [(10.0, false), (25.0, true)] {
            let mut config = hero();
            // The feet stay on the skin and the hold is kept, so that the shake alone decides.
            config.climber.ground.throw_acceleration = f64::INFINITY;
            config.climber.stamina = None;
            let mut arena = jerking(rate, acceleration).arena(config, &[DVec3::Y]);
            land(&mut arena);
            let hold = GRIPS;
            for _ in 0..5 {
                step(&mut arena, &hold);
            }
            assert_eq!(mode(&arena), ClimberMode::Holding);
            raise(&mut arena, &hold);
            let most = config.climber.grip.unwrap().hang_acceleration;
            let (mut broke, mut shaken) = (None, None);
            for tick in 0..(7.0 * rate) as u32 {
                let events = step(&mut arena, &hold);
                let shake = state(&arena, HERO).shake.length();
                if shake > most && shaken.is_none() {
                    shaken = Some(tick);
                }
                if events.contains(&ArenaEvent::BrokenOff { fighter: HERO }) {
                    broke = Some(tick);
                    break;
                }
            }
            assert_eq!(shaken.is_some(), breaks, "{rate} Hz, {acceleration} m/s^2");
            assert_eq!(broke, shaken, "{rate} Hz");
        }
    }
}

/// A strike that begins in the tick in which the shake breaks off the stab does not hit, at any tick rate.
#[test]
fn a_strike_in_the_tick_of_the_shake_is_broken_off_at_every_rate() {
    for rate in RATES {
        let mut config = hero();
        config.climber.ground.throw_acceleration = f64::INFINITY;
        config.climber.stamina = None;
        let hold = GRIPS;
        let mut arena = jerking(rate, 25.0).arena(config, &[DVec3::Y]);
        land(&mut arena);
        for _ in 0..5 {
            step(&mut arena, &hold);
        }
        raise(&mut arena, &hold);
        let before = loop {
            let before = arena.save();
            if step(&mut arena, &hold).contains(&ArenaEvent::BrokenOff { fighter: HERO }) {
                break before;
            }
        };
        arena.restore(&before).unwrap();
        let events = press(&mut arena, &hold);
        assert!(
            events.contains(&ArenaEvent::BrokenOff { fighter: HERO }),
            "{rate} Hz"
        );
        let mut done = Vec::new();
        for _ in 0..60 {
            done.append(&mut hits(&step(&mut arena, &hold)));
        }
        assert!(done.is_empty(), "{rate} Hz: {done:?}");
    }
}

/// Makes two full stabs, and one with the charge `share`, at a weak point of 2.5 hit points.
fn stabs(share: f64) -> (Arena, Vec<f64>) {
    let slab = Slab {
        weak_points: vec![
            weak_point("first", Vec3::ZERO, 2.5, 0),
            weak_point("second", Vec3::ZERO, 5.0, 1),
        ],
        ..Slab::default()
    };
    // The charge grows by 1/120 a tick, so 0.5 and 1 are reached exactly, but for rounding.
    let mut arena = slab.arena(hero(), &[DVec3::Y]);
    land(&mut arena);
    let mut done = Vec::new();
    for wanted in [1.0, 1.0, share] {
        raise(&mut arena, &ClimberInput::IDLE);
        while charge(&arena) < wanted - 1e-9 {
            step(&mut arena, &ClimberInput::IDLE);
        }
        done.append(&mut strike(&mut arena, &ClimberInput::IDLE));
    }
    (arena, done)
}

#[test]
fn a_point_of_two_and_a_half_stabs_takes_as_many_and_passes_nothing_on() {
    let (arena, done) = stabs(0.5);
    assert_eq!(done.len(), 3, "{done:?}");
    let points = arena.creature(GIANT).unwrap().state().hit_points().to_vec();
    assert!(points[0] <= 1e-9, "{points:?}, {done:?}");
    // Less damage leaves the first point open.
    let (arena, _) = stabs(0.49 - 1.0 / 120.0);
    let points = arena.creature(GIANT).unwrap().state().hit_points().to_vec();
    assert!(points[0] > 0.0 && points[1] == 5.0, "{points:?}");
    // Damage beyond the first point's hit points is not passed on to the next one.
    let (arena, done) = stabs(1.0);
    let points = arena.creature(GIANT).unwrap().state().hit_points().to_vec();
    assert_eq!(points, [0.0, 5.0], "{done:?}");
    assert!((done[2] - 0.5).abs() < 1e-9, "{done:?}");
    assert!(
        arena.creature(GIANT).unwrap().is_open(1),
        "the next one opens"
    );
}

/// On skin that is stretched by up to a half and moves at 5 m/s, the tip goes to the point at which it aimed, and hits
/// in each of 20 poses.
#[test]
fn the_tip_goes_to_its_material_point_on_stretched_and_moving_skin() {
    for pose in 0..20 {
        let stretch = Vec3::new(
            1.0 + pose as f32 / 38.0,
            1.0,
            1.0 + (19 - pose) as f32 / 38.0,
        );
        let way = Vec3::new(5.0, 0.0, 0.0);
        // The skin moves and stretches from the beginning. Its clip lasts 60 s, so that it does not repeat within the
        // test.
        let keys = vec![
            (0.0, Vec3::ZERO, stretch),
            (60.0, way * 60.0, stretch * Vec3::new(1.5, 1.0, 1.5)),
        ];
        let mut arena = Slab {
            keys,
            ..with_weak_point(60.0, 100.0)
        }
        .arena(hero(), &[DVec3::Y]);
        land(&mut arena);
        let hold = ClimberInput {
            grip: pose % 2 == 0,
            ..ClimberInput::IDLE
        };
        for _ in 0..5 {
            step(&mut arena, &hold);
        }
        raise(&mut arena, &hold);
        let mut events = press(&mut arena, &hold);
        let WeaponAction::Strike {
            target: StabTarget::Skin(aimed),
            ..
        } = act(&arena)
        else {
            panic!("{:?}", act(&arena));
        };
        let place = loop {
            let hit = events.iter().find_map(|event| match event {
                ArenaEvent::Hit { place, .. } => Some(*place),
                _ => None,
            });
            if let Some(place) = hit {
                break place;
            }
            assert!(
                matches!(act(&arena), WeaponAction::Strike { .. }),
                "pose {pose} missed"
            );
            events = step(&mut arena, &hold);
        };
        // The current position of the aimed point, computed independently from its anchor on the skin.
        let surface = arena.creature(GIANT).unwrap().surface();
        let anchor = aimed.material.anchor_on(surface).unwrap();
        let motion = surface.in_world().motion(&anchor, 1.0 / 60.0).unwrap();
        assert!(
            motion.velocity.length() > 4.9,
            "pose {pose}: {}",
            motion.velocity
        );
        assert!(place.distance(motion.position) < 0.005, "pose {pose}");
        // The blade is at this point, and as deep in the skin as configured.
        let blade = arena.fighter(HERO).unwrap().blade().unwrap();
        let depth = (motion.position - blade.tip).dot(motion.normal);
        assert!(
            (depth - SwordConfig::default().depth).abs() < 0.01,
            "pose {pose}: {depth}"
        );
    }
}

#[test]
fn a_stab_out_of_a_fall_is_full_and_slow_to_pull_out() {
    let mut arena = with_weak_point(60.0, 9.0).arena(hero(), &[DVec3::Y * 12.0]);
    let idle = ClimberInput::IDLE;
    step(&mut arena, &pressing(STAB));
    let mut done = Vec::new();
    let mut pulling = 0;
    for tick in 0..240 {
        // The sword is raised after 0.3 s.
        let input = if tick == 30 { pressing(STAB) } else { idle };
        done.append(&mut hits(&step(&mut arena, &input)));
        pulling += u32::from(matches!(act(&arena), WeaponAction::PullOut { .. }));
    }
    assert_eq!(done, [1.0]);
    assert!((90..100).contains(&pulling), "{pulling} ticks");
    // The loss of its ground breaks off a stab instead.
    let mut arena = with_weak_point(60.0, 9.0).arena(hero(), &[DVec3::new(5.8, 1.0, 0.0)]);
    land(&mut arena);
    raise(&mut arena, &idle);
    let gone = [Order::RemoveCreature { creature: GIANT }];
    let events = step_with(&mut arena, &[idle], &gone);
    assert!(events.contains(&ArenaEvent::CreatureLeft { creature: GIANT }));
    let broken = events.contains(&ArenaEvent::BrokenOff { fighter: HERO });
    assert!(broken, "{:?}", mode(&arena));
}

/// The blade moves with the skin that it is in, also while the hit-stop holds the fighter.
#[test]
fn the_blade_stays_in_moving_skin_at_every_rate() {
    for rate in RATES {
        let keys = vec![
            (0.0, Vec3::ZERO, Vec3::ONE),
            (60.0, Vec3::X * 300.0, Vec3::ONE),
        ];
        let slab = Slab {
            keys,
            ..with_weak_point(rate, 9.0)
        };
        let hero = FighterConfig::hero();
        assert!(hero.hit_stop > 0.05);
        let mut arena = slab.arena(hero, &[DVec3::Y]);
        land(&mut arena);
        raise(&mut arena, &ClimberInput::IDLE);
        step(&mut arena, &pressing(STAB));
        let mut held = 0;
        while act(&arena) != WeaponAction::Ready {
            if let WeaponAction::PullOut { target, .. } = act(&arena) {
                let StabTarget::Skin(at) = target else {
                    panic!("{rate} Hz: {target:?}");
                };
                let surface = arena.creature(GIANT).unwrap().surface();
                let anchor = at.material.anchor_on(surface).unwrap();
                let motion = surface.in_world().motion(&anchor, 1.0 / rate).unwrap();
                let off = at.point.distance(motion.position);
                assert!(off < 0.01, "{rate} Hz: {off} m");
                held += 1;
            }
            step(&mut arena, &ClimberInput::IDLE);
        }
        assert!(f64::from(held) > 0.6 * rate, "{rate} Hz: {held}");
    }
}

/// A stab at a plate that another fighter breaks before it lands hits the skin below the plate.
#[test]
fn a_stab_goes_on_when_its_plate_breaks() {
    let slab = Slab {
        weak_points: vec![weak_point("heart", Vec3::new(3.0, 0.0, 5.0), 9.0, 0)],
        plate: true,
        ..Slab::default()
    };
    let mut config = hero();
    config.sword.as_mut().unwrap().stab_damage = 3.0;
    // The other fighter stands on terrain beside the plate, so that it keeps its footing.
    let edge = block(Vec3::new(-9.0, -9.0, 6.0), Vec3::new(9.0, 0.8, 15.0));
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &edge)];
    for later in 0..8 {
        let places = [DVec3::new(3.0, 1.5, 4.0), DVec3::new(3.0, 1.5, 6.12)];
        let mut arena = slab.arena(config, &places);
        let mut struck = Vec::new();
        for tick in 0..400 {
            let presses = |at: &[i32]| pressing(if at.contains(&tick) { STAB } else { 0 });
            let inputs = [presses(&[60, 220]), presses(&[60, 220 + later])];
            for event in arena.step(&inputs, &terrain).unwrap() {
                if let ArenaEvent::Hit {
                    by,
                    weak_point,
                    plate,
                    ..
                } = event
                {
                    struck.push((*by, *weak_point, *plate));
                }
            }
        }
        assert_eq!(struck.len(), 2, "{later} ticks later: {struck:?}");
        assert_eq!((struck[0].0, struck[0].2), (HERO, Some(0)));
        assert_eq!(struck[1].2, None, "{later} ticks later");
        assert_eq!(struck[1].1, Some(0), "{later} ticks later");
        let left = arena.creature(GIANT).unwrap().state().hit_points()[0];
        assert_eq!(left, 6.0, "{later} ticks later");
    }
}
