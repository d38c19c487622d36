//! Over slopes, and off their ends.

use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_surface::mesh::TriangleId;
use glam::{DAffine3, DVec3};

use super::*;
use crate::step::SLOPE_HYSTERESIS;

#[test]
fn walks_at_its_speed_along_the_surface() {
    for degrees in [0.0, 30.0] {
        let slope = trough(degrees);
        let start = 10.0 * libm::tan(f64::to_radians(degrees)) + 0.6;
        let mut climber = landed(10.0, start, 0.0, &slope);
        let from = climber.state().position;
        let walk = walking(DVec3::new(0.5, 7.0, 0.0));
        for _ in 0..60 {
            let report = step_on(&mut climber, &slope, &walk);
            assert!(report.events.is_empty(), "{degrees}: {report:?}");
            // Nothing is in the way.
            assert!(report.pushed_out.length() < 2e-5, "{degrees}: {report:?}");
        }
        let way = climber.state().position - from;
        assert!((way.length() - 1.5).abs() < 1e-3, "{degrees}: {way}");
        let climbed = libm::atan2(way.y, way.x).to_degrees();
        assert!((climbed - degrees).abs() < 0.05, "{degrees}: {climbed}");
        assert!((climber.state().velocity.length() - 1.5).abs() < 1e-2);
        assert!((climber.state().heading - DVec3::X).length() < 1e-6);
    }
}

#[test]
fn walking_keeps_the_footing_that_standing_keeps() {
    // One degree beyond the limit, within the hysteresis: stood on, walked on, not landed on.
    let mut ground = trough(45.0);
    let mut climber = landed(8.0, 8.6, 0.0, &ground);
    let tilt = |degrees: f64| {
        DAffine3::from_quat(rotation_from_axis_angle(DVec3::Z, degrees.to_radians()))
    };
    let walk = walking(DVec3::Z * 0.1);
    for tick in 0..60 {
        pose(&mut ground, &tilt(f64::from(tick) * 0.1));
        let input = if tick % 2 == 0 { IDLE } else { walk };
        assert!(
            step_on(&mut climber, &ground, &input).events.is_empty(),
            "tick {tick}"
        );
    }
    pose(&mut ground, &tilt(12.0));
    assert_eq!(
        step_on(&mut climber, &ground, &walk).events,
        [
            ClimberEvent::Slipped,
            changed(ClimberMode::Standing, ClimberMode::Sliding)
        ]
    );
}

#[test]
fn ground_that_ends_or_is_removed_is_left() {
    let mut ground = level();
    let mut climber = landed(19.0, 0.5, 0.0, &ground);
    let walk = walking(DVec3::X);
    let mut events = Vec::new();
    for _ in 0..60 {
        events.extend(step_on(&mut climber, &ground, &walk).events);
    }
    let left = [
        ClimberEvent::LostFooting,
        changed(ClimberMode::Standing, ClimberMode::Falling),
    ];
    assert_eq!(events, left);
    // It went round the edge, down to the steepest slope that it stands on, before it left.
    let speed = climber.state().velocity.x;
    let least = 3.0 * libm::cos(ClimberConfig::walker().ground.max_slope + SLOPE_HYSTERESIS);
    assert!((least..=3.0).contains(&speed), "keeps its speed: {speed}");

    let mut climber = landed(1.0, 0.5, 0.0, &ground);
    for triangle in [0, 1].map(TriangleId) {
        ground.edit(|edit| edit.remove_triangle(triangle)).unwrap();
    }
    let events = step_on(&mut climber, &ground, &IDLE).events;
    assert_eq!(events, left);
    // And without any obstacle at all.
    assert!(climber.step(&IDLE, &[], DT).unwrap().events.is_empty());
}
