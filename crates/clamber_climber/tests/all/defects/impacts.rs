//! An impact hurts by its speed along the contact's normal: on ground, slopes, walls and ceilings alike.

use clamber_climber::{Climber, ClimberConfig, ClimberEvent};
use clamber_world::HalfSpace;
use glam::DVec3;

use crate::cases::pairs;
use crate::defects::common::v;
use crate::events::is_hurt;
use crate::input::IDLE;
use crate::scene::{list, put};
use crate::stage::radians;

/// Flies at a velocity against a half-space. Returns the sum of the damage, and the reported speed of a landing.
fn hit(normal: DVec3, velocity: DVec3, rate: f64) -> (f64, Option<f64>) {
    let wall = HalfSpace::behind(DVec3::ZERO, normal).unwrap();
    let mut config = ClimberConfig::colossus_climber();
    config.gravity = v(0.0, -1e-3, 0.0);
    let mut climber = Climber::new(config, normal * 3.0 - velocity * 0.02).unwrap();
    let position = climber.state().position;
    put(&mut climber, position, velocity);
    let (mut damage, mut landed) = (0.0, None);
    for _ in 0..(rate as u32) {
        let report = climber.step(&IDLE, &list(&[&wall]), 1.0 / rate).unwrap();
        for event in report.events {
            match event {
                ClimberEvent::Hurt { damage: d } => damage += d,
                ClimberEvent::Landed { speed, .. } => landed = Some(speed),
                _ => {}
            }
        }
    }
    (damage, landed)
}

#[test]
fn an_impact_hurts_by_its_normal_speed_on_whatever_it_hits() {
    let slopes = [0.0, 30.0, 49.0, 53.0, 70.0, 90.0, 120.0, 180.0];
    for (rate, degrees) in pairs([30.0, 60.0, 240.0], slopes) {
        let angle = radians(degrees);
        let normal = v(-libm::sin(angle), libm::cos(angle), 0.0);
        let along = v(libm::cos(angle), libm::sin(angle), 0.0);
        for (speed, slide) in pairs([9.0, 14.0, 20.0], [0.0, 8.0]) {
            let velocity = -normal * speed + along * slide;
            let (damage, landed) = hit(normal, velocity, rate);
            let told = format!("{degrees} degrees at {speed} and {slide} m/s, {rate} Hz");
            // A twentieth of the hit points for each metre a second beyond 10.
            let due = (speed - 10.0).max(0.0) * 0.05;
            assert!((damage - due).abs() < 2e-3, "{told}: {damage}, due {due}");
            let lands = degrees <= 50.0;
            assert_eq!(landed.is_some(), lands, "{told}: {landed:?}");
        }
    }
}

/// Resting and sliding contacts are no impacts, even where every speed hurts.
#[test]
fn sliding_down_a_slope_does_not_hurt() {
    let mut config = ClimberConfig::colossus_climber();
    config.health.as_mut().unwrap().safe_speed = 0.0;
    for (rate, degrees) in pairs([30.0, 60.0, 240.0], [52.5, 60.0, 75.0]) {
        let angle = radians(degrees);
        let normal = v(-libm::sin(angle), libm::cos(angle), 0.0);
        let slope = HalfSpace::behind(DVec3::ZERO, normal).unwrap();
        let mut climber = Climber::new(config, normal * 0.4).unwrap();
        for _ in 0..(3.0 * rate) as u32 {
            let report = climber.step(&IDLE, &list(&[&slope]), 1.0 / rate);
            let events = report.unwrap().events;
            assert!(
                !events.iter().any(is_hurt),
                "{degrees} degrees at {rate} Hz: {events:?}"
            );
        }
    }
}
