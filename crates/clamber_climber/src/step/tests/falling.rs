//! Falling, landing, jumping and sliding.

use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_surface::surface::SkinnedSurface;
use glam::{DAffine3, DVec3};

use super::*;
use crate::{ClimberState, Knockback, StepRules};

#[test]
fn falls_along_the_parabola_and_lands_where_it_touches() {
    let ground = level();
    let mut climber = climber_at(1.0, 3.4, 2.0);
    for tick in 1..=30 {
        let report = step_on(&mut climber, &ground, &IDLE);
        let time = DT * f64::from(tick);
        let expected = 3.4 - 9.81 * time * time * 0.5;
        assert!(report.events.is_empty());
        assert!(
            (climber.state().position.y - expected).abs() < 1e-9,
            "tick {tick}"
        );
    }
    let mut events = Vec::new();
    for _ in 0..60 {
        events.extend(step_on(&mut climber, &ground, &IDLE).events);
    }
    // After a fall of 3 m, the speed is the square root of 2 g h.
    let [ClimberEvent::Landed { speed, .. }, change] = events[..] else {
        panic!("{events:?}");
    };
    assert!((speed - 7.67).abs() < 0.2, "{speed}");
    assert_eq!(change, changed(ClimberMode::Falling, ClimberMode::Standing));
    let at = climber.state().position;
    assert!((at - DVec3::new(1.0, 0.4, 2.0)).length() < 1e-6, "{at}");
    assert_eq!(climber.state().velocity, DVec3::ZERO);
}

#[test]
fn lands_on_level_ground_at_any_height_and_on_any_scale() {
    // Skin is posed in f32, so contacts have its rounding error, which grows with the coordinates.
    for height in [0.3, 7.7, 40.3, 99.9, 300.1, 1000.7] {
        for shift in 0..20 {
            let mut ground = level();
            let floor = height + f64::from(shift) * 0.137;
            pose(&mut ground, &DAffine3::from_translation(DVec3::Y * floor));
            let climber = landed(1.0, floor + 1.0, 2.0, &ground);
            let off = climber.state().position.y - floor - 0.4;
            assert!(off.abs() < 1e-4, "at {floor}: {off}");
        }
    }
}

#[test]
fn lands_on_the_point_that_is_underfoot_not_on_the_one_that_it_met_first() {
    let mut ground = level();
    let mut climber = climber_at(0.0, 1.0, 0.0);
    let state = ClimberState {
        velocity: DVec3::new(6.0, -3.0, -2.0),
        ..*climber.state()
    };
    climber.restore(state).unwrap();
    for tick in 1..30 {
        let along = DVec3::new(-4.0, 1.0, 3.0) * (f64::from(tick) * DT);
        pose(&mut ground, &DAffine3::from_translation(along));
        step_on(&mut climber, &ground, &IDLE);
        let state = climber.state();
        if let Some(support) = state.support {
            let off = support.attachment.point - (state.position - DVec3::Y * 0.4);
            assert!(off.length() < 1e-5, "tick {tick}: {off}");
            return;
        }
    }
    panic!("never landed: {:?}", climber.state());
}

#[test]
fn lands_on_ground_that_turns_and_touches_it() {
    for (x, turning) in [(3.0, 1.6), (3.0, -1.0), (-6.0, 0.5), (8.0, -0.4)] {
        let mut ground = level();
        let mut climber = climber_at(x, 4.0, 0.3);
        for tick in 0..120 {
            // The ground is about level when the climber lands.
            let angle = turning * (f64::from(tick) * DT - 0.8);
            let turn = rotation_from_axis_angle(DVec3::Z, angle);
            pose(&mut ground, &DAffine3::from_quat(turn));
            if tick > 0 {
                step_on(&mut climber, &ground, &IDLE);
            }
            let state = climber.state();
            if let Some(support) = state.support {
                let off = support.attachment.point.distance(state.position) - 0.4;
                assert!(off.abs() < 2e-5, "{x}, {turning}, tick {tick}: {off}");
                break;
            }
        }
        assert_eq!(
            climber.state().mode,
            ClimberMode::Standing,
            "{x}, {turning}"
        );
    }
}

#[test]
fn a_jump_keeps_the_velocity_of_what_it_leaves_and_reaches_its_height() {
    let mut raft = level();
    let mut climber = landed(0.0, 0.5, 0.0, &raft);
    let mut x = 0.0;
    let mut drift = |raft: &mut SkinnedSurface| {
        x += 2.0 * DT;
        pose(raft, &DAffine3::from_translation(DVec3::X * x));
    };
    for _ in 0..5 {
        drift(&mut raft);
        step_on(&mut climber, &raft, &IDLE);
    }
    drift(&mut raft);
    let jump = ClimberInput { jump: true, ..IDLE };
    let report = step_on(&mut climber, &raft, &jump);
    let change = changed(ClimberMode::Standing, ClimberMode::Falling);
    assert_eq!(report.events, [ClimberEvent::Jumped, change]);
    let mut highest = 0.0f64;
    for _ in 0..30 {
        drift(&mut raft);
        step_on(&mut climber, &raft, &IDLE);
        highest = highest.max(climber.state().position.y - 0.4);
        assert!((climber.state().velocity.x - 2.0).abs() < 1e-3);
    }
    // v^2 / 2 g; the highest tick is at most half a tick from the apex.
    let apex = 25.0 / 19.62;
    assert!(highest <= apex && highest >= apex * 0.999, "{highest}");
}

#[test]
fn too_steep_slopes_are_slid_down() {
    let steep = trough(60.0);
    let mut climber = climber_at(8.0, 14.8, 0.0);
    let mut before = *climber.state();
    let mut slid = 0;
    for tick in 0..60 {
        step_on(&mut climber, &steep, &IDLE);
        let state = climber.state();
        if before.mode == ClimberMode::Sliding {
            assert_eq!(state.mode, ClimberMode::Sliding, "tick {tick}: {state:?}");
            // The climber accelerates down the slope, without friction.
            let gained = (state.velocity - before.velocity).length() / DT;
            let expected = 9.81 * libm::sin(60f64.to_radians());
            assert!((gained - expected).abs() < 0.01, "tick {tick}: {gained}");
            slid += 1;
        }
        before = *state;
    }
    assert!(slid > 40, "slid for {slid} ticks");
    let at = climber.state().position;
    assert!(at.x > 1.0 && at.x < 7.0, "slid to {at}");
}

#[test]
fn a_blow_knocks_down_a_sliding_climber() {
    let steep = trough(60.0);
    let config = ClimberConfig::colossus_climber();
    let mut climber = Climber::new(config, DVec3::new(8.0, 14.8, 0.0)).unwrap();
    while climber.state().mode != ClimberMode::Sliding {
        step_on(&mut climber, &steep, &IDLE);
    }
    let knockback = Knockback {
        velocity: DVec3::Y * 4.0,
        damage: 0.25,
        by: None,
    };
    let rules = StepRules {
        knockback: Some(knockback),
        ..StepRules::default()
    };
    let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &steep)];
    let report = climber.step_with(&IDLE, &obstacles, &rules, DT).unwrap();
    let tumbled = changed(ClimberMode::Sliding, ClimberMode::Tumbling);
    assert!(report.events.contains(&tumbled), "{report:?}");
    assert_eq!(climber.state().hit_points, 0.75);
}

#[test]
fn a_v_of_steep_slopes_supports_in_its_middle() {
    let steep = trough(60.0);
    let mut climber = climber_at(2.0, 4.5, 0.0);
    let mut events = Vec::new();
    for _ in 0..180 {
        events.extend(step_on(&mut climber, &steep, &IDLE).events);
    }
    let state = climber.state();
    assert_eq!(state.mode, ClimberMode::Standing, "{events:?} {state:?}");
    // The climber touches both sides.
    let middle = DVec3::Y * (0.4 / libm::cos(60f64.to_radians()));
    assert!((state.position - middle).length() < 2e-3, "{state:?}");
    assert_eq!(state.velocity, DVec3::ZERO);
    let report = step_on(&mut climber, &steep, &IDLE);
    assert!(report.pushed_out.length() < 1e-4, "{report:?}");
    let landed = |event: &&ClimberEvent| matches!(event, ClimberEvent::Landed { .. });
    assert_eq!(events.iter().filter(landed).count(), 1, "{events:?}");
    let slid = changed(ClimberMode::Falling, ClimberMode::Sliding);
    assert!(events.contains(&slid), "{events:?}");
}

#[test]
fn a_fast_fall_does_not_pass_through() {
    let ground = level();
    let mut climber = climber_at(0.2, 100.0, 0.3);
    climber
        .restore(ClimberState {
            velocity: DVec3::new(0.0, -300.0, 0.0),
            ..*climber.state()
        })
        .unwrap();
    for _ in 0..60 {
        step_on(&mut climber, &ground, &IDLE);
        assert!(climber.state().position.y > 0.0);
    }
    assert_eq!(climber.state().mode, ClimberMode::Standing);
}

#[test]
fn nearly_opposite_walls_crush_but_do_not_fling_the_climber() {
    // The walls overlap the ball by a quarter of a metre. The nearest place with enough room is 27 m farther up.
    let wall = |x: f32, lean: f32| {
        let corners = [
            (x, -40., -40.),
            (x, -40., 40.),
            (x + lean, 40., 40.),
            (x + lean, 40., -40.),
        ];
        let quad = if x < 0.0 {
            [[0, 3, 2], [0, 2, 1]]
        } else {
            [[0, 1, 2], [0, 2, 3]]
        };
        patch(&corners, &quad)
    };
    let walls = [wall(0.15, 0.3), wall(-0.15, -0.3)];
    let mut climber = climber_at(0.0, 0.0, 0.0);
    let mut is_crushed = false;
    for tick in 0..30 {
        let before = climber.state().position;
        let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
            [(ObstacleId(0), &walls[0]), (ObstacleId(1), &walls[1])];
        let report = climber.step(&IDLE, &obstacles, DT).unwrap();
        let way = climber.state().position.distance(before);
        assert!(way < 1.1, "tick {tick}: {way} m, {:?}", climber.state());
        let crushed = |event: &ClimberEvent| matches!(event, ClimberEvent::Crushed { .. });
        is_crushed |= report.events.iter().any(crushed);
    }
    assert!(is_crushed);
}
