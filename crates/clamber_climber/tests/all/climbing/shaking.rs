use std::f64::consts::TAU;

use clamber_climber::{Climber, ClimberConfig, ClimberEvent, ClimberMode};
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};

use crate::input::{HOLD, IDLE};
use crate::scene::{FUR, climber, cuboid, list, moved, placed, run, step};

/// Seconds until a shake of 0.25 m at 3 Hz opens the grip.
fn release_time(rate: f64) -> f64 {
    let mut wall = cuboid(Vec3::new(5.0, 10.0, 1.0), FUR);
    let mut climber = climber(DVec3::new(0.0, 0.0, 1.4));
    let mut time = 0.0;
    while time < 60.0 {
        time += 1.0 / rate;
        let y = 0.25 * libm::sin(time * 3.0 * TAU);
        moved(&mut wall, DVec3::new(0.0, y, 0.0));
        let step = climber.step(&HOLD, &list(&[&wall]), 1.0 / rate);
        let report = step.unwrap();
        let opens = |event: &ClimberEvent| matches!(event, ClimberEvent::ShakenOff { .. });
        if report.events.iter().any(opens) {
            return time;
        }
    }
    time
}

#[test]
fn the_same_shake_opens_the_grip_at_the_same_time_at_any_rate() {
    let times = [60.0, 120.0, 240.0].map(release_time);
    println!("{times:?}");
    let longest = times.into_iter().fold(0.0, f64::max);
    let shortest = times.into_iter().fold(f64::INFINITY, f64::min);
    let allowed = (1.0 / 60.0f64).max(0.03 * longest);
    assert!(longest < 30.0 && longest - shortest <= allowed, "{times:?}");
}

fn held(wall: &SkinnedSurface) -> Climber {
    let mut climber = climber(DVec3::new(0.0, 0.0, 1.4));
    run(&mut climber, &[wall], &HOLD, 5);
    climber
}

#[test]
fn a_jolt_of_the_hold_makes_it_hang_only_above_the_threshold() {
    for (share, mode) in [(0.98, ClimberMode::Holding), (1.02, ClimberMode::Hanging)] {
        let mut wall = cuboid(Vec3::new(50.0, 50.0, 1.0), FUR);
        let mut climber = held(&wall);
        let config = *climber.config();
        // The velocity change for which the filter's output reaches the threshold in one tick.
        let tick = crate::scene::DT;
        let gain = -libm::expm1(-tick / config.shake_time) / tick;
        let speed = share * config.grip.unwrap().hang_acceleration / gain;
        moved(&mut wall, DVec3::X * speed * tick);
        step(&mut climber, &[&wall], &HOLD);
        assert_eq!(climber.state().mode, mode, "{share}: {:?}", climber.state());
    }
}

#[test]
fn noise_of_a_millimetre_never_shakes_off() {
    let mut wall = cuboid(Vec3::new(5.0, 10.0, 1.0), FUR);
    let mut config = ClimberConfig::colossus_climber();
    config.stamina.as_mut().unwrap().hold_drain = 0.0;
    let mut climber = Climber::new(config, DVec3::new(0.0, 0.0, 1.4)).unwrap();
    let mut rng = fastrand::Rng::with_seed(7);
    for _ in 0..3600 {
        let mut one = || (rng.f64() * 2.0 - 1.0) * 1e-3;
        let at = DVec3::new(one(), one(), one());
        moved(&mut wall, at);
        step(&mut climber, &[&wall], &HOLD);
        assert_eq!(climber.state().mode, ClimberMode::Holding);
    }
    assert_eq!(climber.state().stamina, 1.0);
}

#[test]
fn a_teleport_does_not_count_as_shake() {
    let mut wall = cuboid(Vec3::new(5.0, 10.0, 1.0), FUR);
    let mut climber = held(&wall);
    let held_at = climber.state().position;
    let mut at = DVec3::ZERO;
    for tick in 0..240 {
        // The wall accelerates gently to 3 m/s.
        at.z += 0.05 * (f64::from(tick) / 60.0).min(1.0);
        if tick == 180 {
            at += DVec3::new(100.0, 30.0, -20.0);
            placed(&mut wall, at);
        } else {
            moved(&mut wall, at);
        }
        step(&mut climber, &[&wall], &HOLD);
        assert_eq!(climber.state().mode, ClimberMode::Holding, "{tick}");
        let off = climber.state().position - at - held_at;
        assert!(off.length() < 1e-3, "{tick} {off}");
    }
    let state = climber.state();
    assert!(state.shake.length() < 1e-3, "{state:?}");
}

#[test]
fn stamina_comes_back_on_firm_ground() {
    let ground = cuboid(Vec3::new(5.0, 1.0, 5.0), FUR);
    let mut climber = climber(DVec3::new(0.0, 1.4, 0.0));
    run(&mut climber, &[&ground], &HOLD, 600);
    let spent = climber.state().stamina;
    assert!((spent - 0.75).abs() < 0.01, "{spent}");
    run(&mut climber, &[&ground], &IDLE, 120);
    assert!(climber.state().stamina == 1.0, "{:?}", climber.state());
}
