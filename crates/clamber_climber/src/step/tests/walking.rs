//! Walking on slopes, over steps, and off edges.

use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_surface::mesh::TriangleId;
use glam::{DAffine3, DVec3};

use super::*;

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
            // No obstacle is in the way.
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
fn walking_has_the_slope_hysteresis_of_standing() {
    // The slope is one degree beyond the limit, within the hysteresis: the climber can stand and walk there, but not
    // land.
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
    let left = changed(ClimberMode::Standing, ClimberMode::Falling);
    assert!(
        matches!(events[..], [ClimberEvent::LostFooting { .. }, last] if last == left),
        "{events:?}"
    );
    // The climber rolled around the edge, down to the steepest slope that it stands on, before it left the ground.
    let speed = climber.state().velocity.x;
    let least = 3.0 * libm::cos(ClimberConfig::walker().ground.release_slope());
    assert!((least..=3.0).contains(&speed), "keeps its speed: {speed}");

    let mut climber = landed(1.0, 0.5, 0.0, &ground);
    for triangle in [0, 1].map(TriangleId) {
        ground.edit(|edit| edit.remove_triangle(triangle)).unwrap();
    }
    let events = step_on(&mut climber, &ground, &IDLE).events;
    assert!(
        matches!(events[..], [ClimberEvent::LostFooting { .. }, last] if last == left),
        "{events:?}"
    );
    // A step without any obstacle reports no event.
    assert!(climber.step(&IDLE, &[], DT).unwrap().events.is_empty());
}

/// A step at x = 1 below a ceiling, whose height is `height` there and falls by `fall` per metre along X.
fn step_below_ceiling(step: f32, height: f32, fall: f32) -> SkinnedSurface {
    let ceiling = |x: f32| height - fall * (x - 1.0);
    let mut corners = Vec::new();
    for (x, y) in [
        (-2., 0.),
        (1., 0.),
        (1., step),
        (4., step),
        (4., ceiling(4.)),
        (-2., ceiling(-2.)),
    ] {
        corners.extend([(x, y, -5.), (x, y, 5.)]);
    }
    let triangles = [0, 2, 4, 8].map(|a| [[a, a + 1, a + 3], [a, a + 3, a + 2]]);
    patch(&corners, &triangles.concat())
}

#[test]
fn a_step_is_climbed_where_there_is_room_above_it() {
    // The step leaves 3 cm of room above the climber's head; the climber may step up by 30 cm.
    let cave = step_below_ceiling(0.2, 1.03, 0.0);
    let mut climber = landed(0.0, 0.45, 0.0, &cave);
    for _ in 0..60 {
        step_on(&mut climber, &cave, &walking(DVec3::X));
    }
    let state = climber.state();
    assert!(state.position.x > 2.0, "{state:?}");
    assert!((state.position.y - 0.6).abs() < 1e-4, "{state:?}");
}

#[test]
fn no_step_leads_into_a_ceiling() {
    let mut least = f64::INFINITY;
    for millimetres in 0..60 {
        let (height, fall) = (0.8 + 0.001 * millimetres as f32, 0.1);
        let cave = step_below_ceiling(0.03, height, fall);
        let mut climber = landed(0.0, 0.45, 0.0, &cave);
        let core = climber.config().body.radius - climber.config().body.margin;
        let slope = f64::from(fall);
        for tick in 0..40 {
            step_on(&mut climber, &cave, &walking(DVec3::X));
            let p = climber.state().position;
            let above = f64::from(height) - slope * (p.x - 1.0) - p.y;
            let room = above / libm::sqrt(1.0 + slope * slope) - core;
            least = least.min(room);
            assert!(
                room >= -1e-4,
                "{millimetres} mm, tick {tick}: {room} m of room at {p}"
            );
        }
    }
    assert!(least < 0.011, "none came near it: {least} m of room");
}
