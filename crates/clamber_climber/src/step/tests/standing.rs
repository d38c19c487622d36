//! Standing on one material point while the skin moves.

use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_surface::mesh::TriangleId;
use clamber_world::{Obstacle, ObstacleId};
use glam::{DAffine3, DVec3};

use super::*;

#[test]
fn standing_is_carried_to_the_material_point_without_lag() {
    let mut ground = level();
    let mut climber = landed(3.0, 0.5, 1.0, &ground);
    let support = climber.state().support.unwrap();
    for tick in 1..=600 {
        let t = f64::from(tick) * DT;
        let map = DAffine3::from_rotation_translation(
            rotation_from_axis_angle(DVec3::Y, 3.0 * t),
            DVec3::new(libm::sin(2.0 * t), 0.5 * libm::sin(5.0 * t), t),
        );
        pose(&mut ground, &map);
        step_on(&mut climber, &ground, &IDLE);
        let expected = map.transform_point3(DVec3::new(3.0, 0.4, 1.0));
        let off = climber.state().position.distance(expected);
        // f32 rounding of positions of about 10 m, scaled by the arm of 3 m.
        assert!(off < 1e-5, "tick {tick}: {off}");
        let now = climber.state().support.unwrap();
        assert_eq!(
            now.attachment.material, support.attachment.material,
            "new material point at tick {tick}"
        );
    }
    let turned = climber.state().heading;
    let start = climber_at(0.0, 0.0, 0.0).state().heading;
    let expected = rotation_from_axis_angle(DVec3::Y, 30.0) * start;
    assert!((turned - expected).length() < 1e-4, "{turned} {expected}");
}

#[test]
fn pushes_move_the_ball_but_keep_its_material_point() {
    // A trough that folds up from 5 to 12 degrees around a climber that stands beside its middle.
    let flat = trough(5.0);
    let mut climber = landed(0.06, 1.0, 0.0, &flat);
    let support = climber.state().support.unwrap();
    let (mut pushed, mut contacts) = (0.0f64, Vec::new());
    for tick in 0..140 {
        let folded = trough(5.0 + 0.05 * f64::from(tick));
        let report = step_on(&mut climber, &folded, &IDLE);
        pushed += report.pushed_out.length();
        let state = climber.state();
        assert_eq!(
            state.support.unwrap().attachment.material,
            support.attachment.material
        );
        // The climber slides along one side, and neither leaves it nor enters the other.
        contacts.clear();
        folded.overlap_sphere(state.position, 0.5, &mut contacts);
        let distances = contacts.iter().map(|contact| contact.distance);
        let nearest = distances.fold(f64::INFINITY, f64::min);
        assert!((nearest - 0.4).abs() < 2e-5, "tick {tick}: {nearest}");
    }
    assert!(pushed > 1e-3 && pushed < 0.01, "{pushed}");
}

#[test]
fn an_idle_climber_pushed_by_a_wall_stays_on_its_ground_and_falls_off_the_edge() {
    let ground = level();
    let corners = [(0., -5., -5.), (0., 5., -5.), (0., 5., 5.), (0., -5., 5.)];
    let mut wall = patch(&corners, &[[0, 1, 2], [0, 2, 3]]);
    let mut climber = landed(15.0, 0.5, 0.0, &ground);
    // A walking pace: two centimetres a tick.
    let front = |tick: u32| 14.4 + 1.2 * DT * f64::from(tick);
    pose(&mut wall, &DAffine3::from_translation(DVec3::X * front(0)));
    let mut events = Vec::new();
    for tick in 1..340 {
        let at = DAffine3::from_translation(DVec3::X * front(tick));
        pose(&mut wall, &at);
        let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
            [(ObstacleId(0), &ground), (ObstacleId(1), &wall)];
        let report = climber.step(&IDLE, &obstacles, DT).unwrap();
        assert!(report.is_clear && report.penetration == 0.0, "{report:?}");
        events.extend(report.events);
        let state = climber.state();
        assert!(
            state.position.x > front(tick) + 0.39,
            "tick {tick}: {state:?}"
        );
        if let Some(support) = state.support {
            let off = (state.position - support.attachment.point) * DVec3::new(1.0, 0.0, 1.0);
            // Around the edge, the climber leans by up to the steepest slope, plus the push before it looks for new
            // ground.
            let most = if state.position.x < 20.0 { 0.06 } else { 0.36 };
            assert!(off.length() < most, "tick {tick}: {state:?}");
        }
    }
    assert!(climber.state().position.y < -1.0, "{:?}", climber.state());
    let change = changed(ClimberMode::Standing, ClimberMode::Falling);
    assert!(
        matches!(events[..], [.., ClimberEvent::LostFooting { .. }, last] if last == change),
        "{events:?}"
    );
}

#[test]
fn a_slope_that_tips_beyond_the_limit_is_slipped_off_once() {
    let mut ground = level();
    let mut climber = landed(0.5, 0.5, 0.0, &ground);
    let mut slips = 0;
    for tick in 0..90 {
        let degrees = f64::from(tick);
        let turn = rotation_from_axis_angle(DVec3::Z, degrees.to_radians());
        pose(&mut ground, &DAffine3::from_quat(turn));
        let events = step_on(&mut climber, &ground, &IDLE).events;
        for event in events {
            if event == ClimberEvent::Slipped {
                slips += 1;
                assert!((50.0..=54.0).contains(&degrees), "slipped at {degrees}");
            }
        }
        if degrees <= 50.0 {
            assert_eq!(climber.state().mode, ClimberMode::Standing, "at {degrees}");
        }
    }
    assert_eq!(slips, 1);
}

#[test]
fn a_collapsed_triangle_keeps_its_last_frame() {
    let mut ground = level();
    let mut climber = landed(1.0, 0.5, 2.0, &ground);
    let turn = rotation_from_axis_angle(DVec3::new(0.0, 0.8, 0.6), 0.9);
    pose(&mut ground, &DAffine3::from_quat(turn));
    step_on(&mut climber, &ground, &IDLE);
    let support = climber.state().support.unwrap();
    let flat = DAffine3::from_scale(DVec3::ZERO);
    for tick in 0..3 {
        pose(&mut ground, &flat);
        step_on(&mut climber, &ground, &IDLE);
        let now = climber.state().support.unwrap();
        assert_eq!(
            now.attachment.frame, support.attachment.frame,
            "tick {tick}"
        );
        let expected = support.attachment.frame * support.attachment.offset;
        assert!(
            (climber.state().position - expected).length() < 1e-9,
            "tick {tick}"
        );
    }
}

#[test]
fn ground_with_disabled_triangles_is_left() {
    let mut ground = level();
    let mut climber = landed(1.0, 0.5, 2.0, &ground);
    for triangle in 0..2 {
        ground.disable_triangle(TriangleId(triangle)).unwrap();
    }
    let from = climber.state().support.unwrap().attachment;
    let events = step_on(&mut climber, &ground, &IDLE).events;
    let change = changed(ClimberMode::Standing, ClimberMode::Falling);
    assert_eq!(events, [ClimberEvent::LostFooting { from }, change]);
}
