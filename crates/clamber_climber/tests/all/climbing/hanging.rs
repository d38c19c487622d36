use clamber_climber::{Climber, ClimberConfig, ClimberEvent, ClimberMode, GripConfig};
use glam::{DQuat, DVec3, Vec3};

use crate::input::{HOLD, IDLE};
use crate::scene::{FUR, assert_mode, climber, cuboid, moved, placed_turned, run, step};

/// A climber that can only hang where a surface leans over by more than an angle: 90 degrees is a wall, 180 a ceiling.
fn hanger(degrees: f64, position: DVec3) -> Climber {
    let mut config = ClimberConfig::colossus_climber();
    config.grip = Some(GripConfig {
        max_overhang: degrees.to_radians(),
        ..config.grip.unwrap()
    });
    Climber::new(config, position).unwrap()
}

#[test]
fn hangs_below_a_ceiling_swings_and_comes_to_rest() {
    let ceiling = cuboid(Vec3::new(5.0, 1.0, 5.0), FUR);
    let mut climber = hanger(120.0, DVec3::new(0.0, -1.4, 0.0));
    let events = run(&mut climber, &[&ceiling], &HOLD, 600);
    assert_mode(&climber, ClimberMode::Hanging);
    let below = climber.state().position.y + 1.0;
    let arm = climber.config().hang.arm_length;
    assert!((below + arm).abs() < 1e-3, "{below} {events:?}");
    let state = climber.state();
    assert!(state.velocity.length() < 0.05, "{state:?}");
}

#[test]
fn hangs_while_its_hold_shakes_and_climbs_again_when_it_is_calm() {
    let mut wall = cuboid(Vec3::new(5.0, 10.0, 1.0), FUR);
    let mut climber = climber(DVec3::new(0.0, 0.0, 1.4));
    run(&mut climber, &[&wall], &HOLD, 5);
    let mut hung = false;
    let mut time: f64 = 0.0;
    for _ in 0..60 {
        time += crate::scene::DT;
        let y = 0.25 * libm::sin(time * 3.0 * std::f64::consts::TAU);
        moved(&mut wall, DVec3::new(0.0, y, 0.0));
        step(&mut climber, &[&wall], &HOLD);
        hung |= climber.state().mode == ClimberMode::Hanging;
    }
    assert!(hung);
    moved(&mut wall, DVec3::ZERO);
    for _ in 0..180 {
        moved(&mut wall, DVec3::ZERO);
        step(&mut climber, &[&wall], &HOLD);
    }
    assert_mode(&climber, ClimberMode::Holding);
}

#[test]
fn legs_lie_against_a_convex_belly() {
    // The climber hangs from the upper edge of a block that leans out below. The body lies on the block and stays
    // there.
    let mut block = cuboid(Vec3::new(4.0, 4.0, 1.0), FUR);
    let lean = DQuat::from_xyzw(0.1305, 0.0, 0.0, 0.9914).normalize();
    placed_turned(&mut block, DVec3::ZERO, lean);
    let mut climber = hanger(0.0, lean * DVec3::new(0.0, 1.0, 1.4));
    run(&mut climber, &[&block], &HOLD, 300);
    assert_mode(&climber, ClimberMode::Hanging);
    let state = climber.state();
    assert!(state.velocity.length() < 1e-2, "{state:?}");
}

#[test]
fn lets_go_when_asked() {
    let ceiling = cuboid(Vec3::new(5.0, 1.0, 5.0), FUR);
    let mut climber = hanger(120.0, DVec3::new(0.0, -1.4, 0.0));
    run(&mut climber, &[&ceiling], &HOLD, 60);
    let events = run(&mut climber, &[&ceiling], &IDLE, 1);
    assert!(events.contains(&ClimberEvent::Released), "{events:?}");
    assert_mode(&climber, ClimberMode::Falling);
}
