//! Results that must not depend on the tick's length, on how fine a rig is, or on data outside the saved state.

use crate::support;

use std::sync::Arc;

use crate::support::{GROUND, Slab, kill, level_ground, pressing, rest, rises, weak_point};
use clamber_climber::{ClimberInput, ClimberMode};
use clamber_colossus::{CreatureConfig, CreatureKind};
use clamber_fight::actions::{CUT, STAB, THROW};
use clamber_fight::{
    Arena, ArenaConfig, ArenaEvent, BowConfig, CreatureId, FighterConfig, FighterId, Projectile,
    ProjectileId, ProjectileKind, ProjectileMotion, WeaponAction,
};
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use glam::{DVec3, Vec3};

fn arena(tick: f64) -> Arena {
    Arena::new(ArenaConfig {
        tick,
        ..ArenaConfig::default()
    })
    .unwrap()
}

/// An arena with one fighter on the ground that respawns one second after its death.
fn alone() -> Arena {
    let mut arena = arena(1.0 / 60.0);
    let mut config = FighterConfig::hero();
    config.respawn = Some(1.0);
    arena.add_fighter(config, DVec3::Y).unwrap();
    arena
}

/// A fighter that presses the throw button in the tick in which it dies throws no stone, neither then nor later. A
/// fresh arena that restores the state continues alike.
#[test]
fn a_throw_in_the_tick_of_death_is_lost() {
    let terrain = level_ground();
    let mut ours = alone();
    rest(&mut ours, &terrain, 30);
    // The fighter dies in the next step, in which it also presses the throw button.
    kill(&mut ours);
    ours.step(&[pressing(THROW)], &terrain).unwrap();
    assert!(ours.fighter(FighterId(0)).unwrap().is_dead());
    let mut fresh = alone();
    fresh.restore(&ours.save()).unwrap();
    let mut rose = false;
    for tick in 0..200 {
        for arena in [&mut ours, &mut fresh] {
            let events = arena.step(&[ClimberInput::IDLE], &terrain).unwrap();
            rose |= rises(events);
            let is_shot = |event: &ArenaEvent| matches!(event, ArenaEvent::Shot { .. });
            let shot = events.iter().any(is_shot);
            assert!(!shot && arena.projectiles().is_empty(), "tick {tick}");
        }
        assert_eq!(ours.fingerprint(), fresh.fingerprint(), "tick {tick}");
    }
    assert!(rose);
}

/// A slab that moves along X at `speed`, with a weak point in its middle.
fn moving(speed: f64, rate: f64) -> Arc<CreatureKind> {
    let mut heart = weak_point("heart", Vec3::ZERO, 1e6, 0);
    heart.radius = 0.4;
    let slab = Slab {
        rate,
        weak_points: vec![heart],
        keys: vec![
            (0.0, Vec3::ZERO, Vec3::ONE),
            (60.0, Vec3::X * (60.0 * speed) as f32, Vec3::ONE),
        ],
        ..Slab::default()
    };
    slab.kind()
}

/// Shoots 60 arrows down around the weak point. Counts those that miss it and those that hurt it, by the place of the
/// hit at its time: within 0.38 m of the weak point's middle, and beyond 0.42 m. Also returns the damages that are not
/// zero. `along` is the arrows' own speed along X.
fn arrows(speed: f64, along: f64, rate: f64) -> ([[usize; 2]; 2], Vec<f64>) {
    let dt = 1.0 / rate;
    let kind = moving(speed, rate);
    let ground = HalfSpace::below(-50.0);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ground)];
    let (mut found, mut damages) = ([[0; 2]; 2], Vec::new());
    for shot in 0..60u64 {
        let mut arena = arena(dt);
        arena
            .add_creature(Arc::clone(&kind), CreatureConfig::default())
            .unwrap();
        arena
            .add_fighter(FighterConfig::hero(), DVec3::new(0.0, -40.0, 30.0))
            .unwrap();
        rest(&mut arena, &terrain, 10);
        let aside = (shot % 12) as f64 * 0.07;
        let angle = shot as f64 * 2.4;
        let off = DVec3::new(libm::cos(angle), 0.0, libm::sin(angle)) * aside;
        // Each arrow falls at least 2 m in about 0.05 s, and arrives at another time within a tick.
        let height = 2.0 + 0.011 * shot as f64;
        let time = height / 40.0;
        let giant = arena.creature(CreatureId(0)).unwrap();
        let heart = giant.weak_point(0).unwrap();
        let position = heart + off + DVec3::new((speed - along) * time, height, 0.0);
        let mut state = arena.save();
        state.projectiles.push(Projectile {
            id: ProjectileId(0),
            kind: ProjectileKind::Arrow,
            by: FighterId(0),
            body: BowConfig::default().arrow(),
            seconds: 0.0,
            motion: ProjectileMotion::Flying {
                position,
                velocity: DVec3::new(along, -40.0, 0.0),
            },
        });
        state.next_projectile = 1;
        arena.restore(&state).unwrap();
        for _ in 0..(0.3 * rate) as u32 {
            let events = arena
                .step(&[ClimberInput::IDLE], &terrain)
                .unwrap()
                .to_vec();
            for event in events {
                let ArenaEvent::Hit {
                    weak_point,
                    time,
                    place,
                    damage,
                    ..
                } = event
                else {
                    continue;
                };
                let giant = arena.creature(CreatureId(0)).unwrap();
                let middle = giant.weak_point(0).unwrap();
                let then = middle - DVec3::X * (speed * dt * (1.0 - time));
                let off = (place - then).with_y(0.0).length();
                damages.extend((damage > 0.0).then_some(damage));
                let row = usize::from(off > 0.4);
                if (off - 0.4).abs() > 0.02 {
                    found[row][usize::from(weak_point.is_some())] += 1;
                }
            }
        }
    }
    (found, damages)
}

/// Arrows hurt a moving weak point where it is at the time of the hit, at every tick rate and speed.
#[test]
fn weak_points_that_move_are_hit_where_they_are() {
    for rate in [30.0, 60.0, 120.0] {
        for speed in [0.0, 10.0, 30.0, 60.0] {
            let ([within, beyond], _) = arrows(speed, 0.0, rate);
            println!("{rate} Hz, {speed} m/s: within {within:?}, beyond {beyond:?}");
            assert_eq!((within[0], beyond[1]), (0, 0), "{rate} Hz, {speed} m/s");
            assert!(within[1] > 20 && beyond[0] > 15);
        }
    }
}

/// A sword that is raised in a fall has its full strength only while the fall lasts.
#[test]
fn a_charge_is_not_kept_across_a_hop() {
    let terrain = level_ground();
    let mut arena = arena(1.0 / 60.0);
    arena.add_fighter(FighterConfig::hero(), DVec3::Y).unwrap();
    let mut fell = 0.0f64;
    let mut landed = false;
    for tick in 0..120u32 {
        let input = ClimberInput {
            jump: tick == 30,
            ..pressing(if tick == 32 { STAB } else { 0 })
        };
        arena.step(&[input], &terrain).unwrap();
        let fighter = arena.fighter(FighterId(0)).unwrap();
        match fighter.act() {
            WeaponAction::Charge { falls: true, .. } => fell = fell.max(fighter.charge()),
            WeaponAction::Charge {
                charge,
                falls: false,
            } if !landed => {
                landed = true;
                assert!(*charge < 0.1, "it lands with a charge of {charge}");
            }
            _ => {}
        }
    }
    assert_eq!(fell, 1.0);
    assert!(landed);
}

/// An arrow's damage follows from its speed relative to the skin, at every tick rate. It is the same on a slab that
/// moves along with the arrow as on a slab at rest.
#[test]
fn arrows_hurt_by_their_relative_speed() {
    let still = arrows(0.0, 0.0, 60.0).1[0];
    for rate in [30.0, 60.0, 120.0] {
        for speed in [10.0, 60.0] {
            // Slab and arrow move; only the slab moves; only the arrow moves.
            let square = |along: f64| (40.0 * 40.0 + along * along) / (40.0 * 40.0);
            for (slab, arrow, share) in [
                (speed, speed, 1.0),
                (speed, 0.0, square(speed)),
                (0.0, speed, square(speed)),
            ] {
                let damages = arrows(slab, arrow, rate).1;
                assert!(damages.len() > 20);
                for damage in damages {
                    let off = damage / (still * share) - 1.0;
                    assert!(off.abs() < 0.02, "{rate} Hz, {slab} and {arrow} m/s: {off}");
                }
            }
        }
    }
}

/// One cut does its damage once, however many joints move the skin that it passes.
#[test]
fn a_cut_hurts_once() {
    let mut parts = Vec::new();
    // A narrow cut ends inside the wall. Without a recovery time, it also hits in its last tick.
    for (recover, degrees) in [(0.25, 200f64), (0.25, 90.0), (0.0, 90.0), (0.0, 120.0)] {
        for joints in [1, 2, 4, 8, 16] {
            let mut hero = FighterConfig::hero();
            let sword = hero.sword.as_mut().unwrap();
            (sword.recover, sword.angle) = (recover, degrees.to_radians());
            let wanted = 2.0 * sword.cut_damage;
            let [hits, damage, _] = two_cuts(hero, &support::Wall::of(joints));
            parts.push(hits);
            assert!(
                (damage - wanted).abs() < 1e-9,
                "{joints} joints, {recover} s, {degrees}°: {damage} in {hits}"
            );
        }
    }
    println!("parts struck: {parts:?}");
    assert!(parts[0] == 2.0 && parts[4] > 8.0, "{parts:?}");
}

/// A cut that breaks a plate does not damage the weak point below, however fine the rig is. Only the next cut does.
#[test]
fn a_cut_that_breaks_a_plate_does_not_hurt_what_is_below() {
    for joints in [1, 2, 4, 8, 16] {
        for plate in [0.01, 0.05, 0.1, 0.15, 0.2] {
            let mut hero = FighterConfig::hero();
            let damage = hero.sword.as_mut().unwrap().cut_damage;
            let wall = support::Wall {
                plate: Some(plate),
                ..support::Wall::of(joints)
            };
            let [.., lost] = two_cuts(hero, &wall);
            let wanted = if plate <= damage { damage } else { 0.0 };
            assert!(
                (lost - wanted).abs() < 1e-9,
                "{joints} joints, a plate of {plate}: {lost}"
            );
        }
    }
}

/// Makes two cuts at a wall, one after the other. Returns the number of hits, their damage, and the hit points that the
/// weak point has lost.
fn two_cuts(hero: FighterConfig, wall: &support::Wall) -> [f64; 3] {
    let mut arena = arena(1.0 / 60.0);
    arena
        .add_creature(wall.kind(), CreatureConfig::default())
        .unwrap();
    let place = DVec3::new(0.0, -0.2, 3.0);
    arena.add_fighter(hero, place).unwrap();
    let ground = HalfSpace::below(-1.0);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ground)];
    let (mut hits, mut damage) = (0.0, 0.0);
    for tick in 0..420u32 {
        let walk = if tick < 180 {
            DVec3::NEG_Z
        } else {
            DVec3::ZERO
        };
        let actions = if tick == 200 || tick == 300 { CUT } else { 0 };
        let input = ClimberInput {
            walk,
            ..pressing(actions)
        };
        for event in arena.step(&[input], &terrain).unwrap() {
            if let ArenaEvent::Hit { damage: done, .. } = event {
                hits += 1.0;
                damage += done;
            }
        }
    }
    let left = arena.creature(CreatureId(0)).unwrap().state().hit_points()[0];
    [hits, damage, 100.0 - left]
}

/// A fighter that hops off fur, raises the sword in the air, and grips the fur again loses the full charge of the fall,
/// at whichever tick it grips.
#[test]
fn a_charge_is_not_kept_by_gripping_again() {
    let (mut held, mut fell) = (0, 0);
    for grips_at in 34..64u32 {
        let ground = HalfSpace::below(-20.0);
        let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ground)];
        let mut arena = Slab::default().arena(FighterConfig::hero(), &[DVec3::Y]);
        let mut after = None;
        for tick in 0..140u32 {
            let input = ClimberInput {
                jump: tick == 30,
                grip: tick >= grips_at,
                ..pressing(if tick == 32 { STAB } else { 0 })
            };
            arena.step(&[input], &terrain).unwrap();
            let fighter = arena.fighter(FighterId(0)).unwrap();
            match fighter.act() {
                WeaponAction::Charge { falls: true, .. } => fell += 1,
                WeaponAction::Charge {
                    charge,
                    falls: false,
                } if after.is_none() => after = Some((*charge, fighter.climber().state().mode)),
                _ => {}
            }
        }
        let (charge, mode) = after.unwrap();
        assert!(charge < 0.1, "{grips_at}: {charge} in {mode:?}");
        held += u32::from(mode == ClimberMode::Holding);
    }
    println!("held again in {held} of 30, charged in {fell} ticks of falls");
    assert!(held > 20 && fell > 20);
}
