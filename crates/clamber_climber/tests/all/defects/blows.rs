//! Blows on a climber that stands or holds on, without tumbling.

use clamber_climber::{
    Climber, ClimberConfig, ClimberError, ClimberEvent, ClimberMode, Knockback, StepRules,
};
use glam::{DVec3, Vec3};

use crate::cases::pairs;
use crate::defects::common::v;
use crate::events::{count, is_hurt};
use crate::input::{HOLD, IDLE, grip_walk};
use crate::scene::{DT, FUR, STONE, climber, cuboid, list, tick_among};
use crate::stage::{Played, Run, Shape, Stage};

/// Rules with a blow that does damage.
fn hurt(velocity: DVec3) -> StepRules<'static> {
    let knockback = Knockback {
        velocity,
        damage: 0.1,
        by: None,
    };
    StepRules {
        knockback: Some(knockback),
        ..StepRules::default()
    }
}

fn without_tumble() -> ClimberConfig {
    ClimberConfig {
        tumble: None,
        ..ClimberConfig::colossus_climber()
    }
}

#[test]
fn a_blow_moves_a_climber_on_its_feet() {
    let mut last = 0.0;
    let speeds = [0.5, 1.0, 2.0, 2.9, 3.1, 3.2, 10.0, 50.0];
    for (hz, speed) in pairs([30.0, 60.0, 240.0], speeds) {
        let stage = Stage::at_rate(Played::Root, hz).with_still(&Shape::floor(100.0));
        let mut run = Run::new(stage, without_tumble(), DVec3::ZERO).settle();
        run.knockback = hurt(v(speed, 0.0, 0.0)).knockback;
        let report = run.step(&IDLE);
        let told = format!("{speed} m/s at {hz} Hz: {:?}", report.events);
        assert_eq!(count(&report.events, is_hurt), 1, "{told}");
        run.steps((5.0 * hz) as u32, &IDLE);
        let moved = run.position().x;
        // Friction alone brakes the climber to rest: feet do not stop a climber that slides.
        let expected = speed * speed / (2.0 * run.config().ground.friction);
        let slack = 0.02 * expected + speed / hz;
        assert!(
            (moved - expected).abs() <= slack,
            "{told}: {moved} m of {expected} m"
        );
        assert_eq!(run.mode(), ClimberMode::Standing, "{told}");
        if speed == 50.0 {
            last = moved;
        }
    }
    assert!(last > 50.0, "{last}");
}

#[test]
fn a_blow_moves_a_climber_on_its_hold() {
    let fur = cuboid(Vec3::new(4.0, 3.0, 3.0), FUR);
    let stone = cuboid(Vec3::new(4.0, 3.0, 3.0), STONE);
    for speed in [2.9, 3.1, 50.0] {
        for (direction, aside) in [(DVec3::X, true), (DVec3::Z, false)] {
            let mut climber = Climber::new(without_tumble(), v(0.0, 1.0, 3.5)).unwrap();
            for _ in 0..30 {
                tick_among(&mut climber, &[&fur], &HOLD);
            }
            assert_eq!(climber.state().mode, ClimberMode::Holding);
            let from = climber.state().position;
            let mut farthest = 0.0f64;
            let mut events = Vec::new();
            for k in 0..30 {
                let blow = if k == 0 {
                    hurt(direction * speed)
                } else {
                    StepRules::default()
                };
                let step = climber.step_with(&HOLD, &list(&[&fur]), &blow, DT);
                events.extend(step.unwrap().events);
                farthest = farthest.max((climber.state().position - from).dot(direction));
            }
            let told = format!("{speed} m/s along {direction}: {farthest} m, {events:?}");
            assert!(farthest > if aside { 0.1 } else { 0.05 }, "{told}");
            let knocked = |event: &ClimberEvent| matches!(event, ClimberEvent::KnockedOff { .. });
            // A blow faster than a jump off a hold takes the climber off its hold.
            assert_eq!(events.iter().any(knocked), speed > 4.0, "{told}");
        }
        // Only the fast blow takes the climber off a ledge.
        let mut climber = Climber::new(without_tumble(), v(0.3, 2.75, 3.5)).unwrap();
        let toward = grip_walk(-DVec3::Z * 0.1);
        for _ in 0..60 {
            tick_among(&mut climber, &[&stone], &toward);
        }
        assert_eq!(climber.state().mode, ClimberMode::LedgeHanging);
        let blow = hurt(DVec3::Z * speed);
        let step = climber.step_with(&HOLD, &list(&[&stone]), &blow, DT);
        let report = step.unwrap();
        let hangs = climber.state().mode == ClimberMode::LedgeHanging;
        assert_eq!(hangs, speed < 4.0, "{speed}: {:?}", report.events);
    }
}

#[test]
fn damage_outside_0_to_1_is_refused() {
    for damage in [7.0, -1.0, 1.0 + 1e-9, -f64::MIN_POSITIVE] {
        let mut climber = climber(DVec3::ZERO);
        let before = *climber.state();
        let mut rules = hurt(DVec3::X);
        rules.knockback.as_mut().unwrap().damage = damage;
        let expected = ClimberError::OutOfRange {
            name: "knockback.damage",
            range: "from 0 to 1",
            found: damage,
        };
        let stepped = climber.step_with(&IDLE, &[], &rules, 0.1);
        assert_eq!(stepped, Err(expected), "{damage}");
        assert_eq!(climber.state(), &before, "{damage}");
    }
}
