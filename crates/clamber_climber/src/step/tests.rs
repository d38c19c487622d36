use std::sync::Arc;

use clamber_surface::geometry::{Affine, Similarity, rotation_from_axis_angle};
use clamber_surface::mesh::{BuildOptions, ColliderMesh, Influence, MeshSource, TriangleId};
use clamber_surface::rig::{JointId, Palette};
use clamber_surface::surface::SkinnedSurface;
use glam::{DAffine3, Vec3};

use super::*;
use crate::{ClimberConfig, ClimberState};

const DT: f64 = 1.0 / 60.0;
const IDLE: ClimberInput = ClimberInput {
    walk: DVec3::ZERO,
    jump: false,
};

/// A surface from corners in the XZ plane and heights, on one joint, facing up.
fn patch(corners: &[(f32, f32, f32)], triangles: &[[u32; 3]]) -> SkinnedSurface {
    let positions: Vec<Vec3> = corners
        .iter()
        .map(|&(x, y, z)| Vec3::new(x, y, z))
        .collect();
    let influence = Influence {
        joint: JointId(0),
        weight: 1.0,
    };
    let source = MeshSource {
        positions: &positions,
        triangles,
        influences: &vec![influence; positions.len()],
        joint_count: 1,
        ..MeshSource::default()
    };
    let (mesh, _) = ColliderMesh::build(&source, &BuildOptions::default()).unwrap();
    SkinnedSurface::new(Arc::new(mesh))
}

/// A square of 40 m at height 0.
fn level() -> SkinnedSurface {
    patch(
        &[
            (-20., 0., -20.),
            (-20., 0., 20.),
            (20., 0., 20.),
            (20., 0., -20.),
        ],
        &[[0, 1, 2], [0, 2, 3]],
    )
}

/// A valley along Z: two planes rising to both sides by so many degrees.
fn trough(degrees: f64) -> SkinnedSurface {
    let rise = (20.0 * libm::tan(degrees.to_radians())) as f32;
    patch(
        &[
            (-20., rise, -20.),
            (-20., rise, 20.),
            (0., 0., 20.),
            (0., 0., -20.),
            (20., rise, 20.),
            (20., rise, -20.),
        ],
        &[[0, 1, 2], [0, 2, 3], [3, 2, 4], [3, 4, 5]],
    )
}

/// Poses the one joint of a patch.
fn pose(surface: &mut SkinnedSurface, map: &DAffine3) {
    let palette = Palette::from_matrices([Affine::from_f64(map)]);
    surface.advance(&palette, Similarity::IDENTITY).unwrap();
}

fn climber_at(x: f64, y: f64, z: f64) -> Climber {
    Climber::new(ClimberConfig::default(), DVec3::new(x, y, z)).unwrap()
}

fn step_on(climber: &mut Climber, surface: &SkinnedSurface, input: &ClimberInput) -> StepReport {
    let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), surface)];
    climber.step(input, &obstacles, DT).unwrap()
}

/// A climber that has come to stand on the surface.
fn landed(x: f64, y: f64, z: f64, surface: &SkinnedSurface) -> Climber {
    let mut climber = climber_at(x, y, z);
    for _ in 0..300 {
        step_on(&mut climber, surface, &IDLE);
        if climber.state().mode == ClimberMode::Standing {
            return climber;
        }
    }
    panic!("never landed: {:?}", climber.state());
}

#[test]
fn falls_by_semi_implicit_euler_and_lands_where_it_touches() {
    let ground = level();
    let mut climber = climber_at(1.0, 3.4, 2.0);
    let mut expected = 3.4;
    for tick in 1..=30 {
        let report = step_on(&mut climber, &ground, &IDLE);
        expected -= 9.81 * DT * DT * f64::from(tick);
        assert!(report.events.is_empty());
        assert!(
            (climber.state().position.y - expected).abs() < 1e-9,
            "tick {tick}"
        );
    }
    let mut landings = 0;
    for _ in 0..60 {
        for event in step_on(&mut climber, &ground, &IDLE).events {
            // From 3 m: the square root of 2 g h.
            assert!(
                matches!(event, ClimberEvent::Landed { speed, .. } if (speed - 7.67).abs() < 0.2)
            );
            landings += 1;
        }
    }
    assert_eq!(landings, 1);
    let at = climber.state().position;
    assert!((at - DVec3::new(1.0, 0.4, 2.0)).length() < 1e-6, "{at}");
    assert_eq!(climber.state().velocity, DVec3::ZERO);
}

#[test]
fn lands_on_level_ground_at_any_height_and_on_any_scale() {
    // Skin is posed in f32: what touches is off by its rounding, which grows with its coordinates.
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
fn walking_keeps_the_footing_that_standing_keeps() {
    // One degree beyond the limit, within the hysteresis: stood on, walked on, not landed on.
    let mut ground = trough(45.0);
    let mut climber = landed(8.0, 8.6, 0.0, &ground);
    let tilt = |degrees: f64| {
        DAffine3::from_quat(rotation_from_axis_angle(DVec3::Z, degrees.to_radians()))
    };
    let walk = ClimberInput {
        walk: DVec3::Z * 0.1,
        jump: false,
    };
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
        [ClimberEvent::Slipped]
    );
}

#[test]
fn ground_that_queries_no_longer_see_is_left() {
    let mut ground = level();
    let mut climber = landed(1.0, 0.5, 2.0, &ground);
    for triangle in 0..2 {
        ground.disable_triangle(TriangleId(triangle)).unwrap();
    }
    let events = step_on(&mut climber, &ground, &IDLE).events;
    assert_eq!(events, [ClimberEvent::LostFooting]);
}

#[test]
fn skin_that_collapses_keeps_its_last_direction() {
    let mut ground = level();
    let mut climber = landed(1.0, 0.5, 2.0, &ground);
    let turn = rotation_from_axis_angle(DVec3::new(0.0, 0.8, 0.6), 0.9);
    pose(&mut ground, &DAffine3::from_quat(turn));
    step_on(&mut climber, &ground, &IDLE);
    let footing = climber.state().footing.unwrap();
    let flat = DAffine3::from_scale(DVec3::ZERO);
    for tick in 0..3 {
        pose(&mut ground, &flat);
        step_on(&mut climber, &ground, &IDLE);
        let now = climber.state().footing.unwrap();
        assert_eq!(now.frame, footing.frame, "tick {tick}");
        let expected = footing.frame * footing.offset;
        assert!(
            (climber.state().position - expected).length() < 1e-9,
            "tick {tick}"
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
    assert_eq!(report.events, [ClimberEvent::Jumped]);
    let mut highest = 0.0f64;
    for _ in 0..30 {
        drift(&mut raft);
        step_on(&mut climber, &raft, &IDLE);
        highest = highest.max(climber.state().position.y - 0.4);
        assert!((climber.state().velocity.x - 2.0).abs() < 1e-3);
    }
    // v^2 / 2 g, less what semi-implicit Euler gives away in half a tick.
    assert!((highest - 25.0 / 19.62).abs() < 5.0 * DT, "{highest}");
}

#[test]
fn walks_at_its_speed_along_the_surface() {
    for degrees in [0.0, 30.0] {
        let slope = trough(degrees);
        let start = 10.0 * libm::tan(f64::to_radians(degrees)) + 0.6;
        let mut climber = landed(10.0, start, 0.0, &slope);
        let from = climber.state().position;
        let walk = ClimberInput {
            walk: DVec3::new(0.5, 7.0, 0.0),
            jump: false,
        };
        for _ in 0..60 {
            let report = step_on(&mut climber, &slope, &walk);
            assert!(report.events.is_empty(), "{degrees}: {report:?}");
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
fn too_steep_slopes_are_slid_down_and_supported_in_the_middle_are_not_stood_on() {
    let steep = trough(60.0);
    let mut climber = climber_at(5.0, 9.6, 0.0);
    for _ in 0..120 {
        step_on(&mut climber, &steep, &IDLE);
        assert_eq!(climber.state().mode, ClimberMode::Falling);
    }
    let at = climber.state().position;
    assert!(at.y < 3.0 && at.y > 0.0, "slid to {at}");
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
fn standing_is_carried_to_the_material_point_without_lag() {
    let mut ground = level();
    let mut climber = landed(3.0, 0.5, 1.0, &ground);
    let footing = climber.state().footing.unwrap();
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
        // Positions of some 10 m in f32, scaled by the arm of 3 m.
        assert!(off < 1e-5, "tick {tick}: {off}");
        let now = climber.state().footing.unwrap();
        assert_eq!(now.point, footing.point, "anchored anew at tick {tick}");
    }
    let turned = climber.state().heading;
    let start = climber_at(0.0, 0.0, 0.0).state().heading;
    let expected = rotation_from_axis_angle(DVec3::Y, 30.0) * start;
    assert!((turned - expected).length() < 1e-4, "{turned} {expected}");
}

#[test]
fn pushes_roll_the_sphere_but_leave_its_contact() {
    // A trough that folds up from 5 to 12 degrees around a climber that stands beside its middle.
    let flat = trough(5.0);
    let mut climber = landed(0.06, 1.0, 0.0, &flat);
    let footing = climber.state().footing.unwrap();
    let mut pushed = 0.0f64;
    for tick in 0..140 {
        let folded = trough(5.0 + 0.05 * f64::from(tick));
        let report = step_on(&mut climber, &folded, &IDLE);
        pushed = pushed.max(report.push_out.displacement.length());
        let now = climber.state().footing.unwrap();
        assert_eq!(now.point, footing.point);
        let reach = climber.state().position.distance(now.contact);
        assert!((reach - 0.4).abs() < 1e-9, "tick {tick}: {reach}");
    }
    assert!(pushed > 1e-4 && pushed < 0.01, "{pushed}");
    // Once it has settled it touches both sides to a millimetre.
    let folded = trough(5.0 + 0.05 * 139.0);
    for _ in 0..120 {
        step_on(&mut climber, &folded, &IDLE);
    }
    let mut contacts = Vec::new();
    Obstacle::overlap_sphere(&folded, climber.state().position, 0.4, &mut contacts);
    for contact in contacts {
        assert!(contact.distance > 0.4 - 1e-3, "{contact:?}");
    }
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
fn ground_that_ends_or_is_removed_is_left() {
    let mut ground = level();
    let mut climber = landed(19.0, 0.5, 0.0, &ground);
    let walk = ClimberInput {
        walk: DVec3::X,
        jump: false,
    };
    let mut events = Vec::new();
    for _ in 0..60 {
        events.extend(step_on(&mut climber, &ground, &walk).events);
    }
    assert_eq!(events, [ClimberEvent::LostFooting]);
    // It went round the edge, down to the steepest slope, before it left.
    let speed = climber.state().velocity.x;
    assert!((1.9..=3.0).contains(&speed), "keeps its speed: {speed}");

    let mut climber = landed(1.0, 0.5, 0.0, &ground);
    for triangle in [0, 1].map(TriangleId) {
        ground.edit(|edit| edit.remove_triangle(triangle)).unwrap();
    }
    let events = step_on(&mut climber, &ground, &IDLE).events;
    assert_eq!(events, [ClimberEvent::LostFooting]);
    // And without any obstacle at all.
    assert!(climber.step(&IDLE, &[], DT).unwrap().events.is_empty());
}

#[test]
fn order_of_obstacles_and_a_restored_state_change_no_bit() {
    // Two troughs across each other: in the pit where they meet the climber touches both.
    let (mut one, mut other) = (trough(20.0), trough(25.0));
    let across = rotation_from_axis_angle(DVec3::Y, core::f64::consts::FRAC_PI_2);
    let mut forward = climber_at(0.5, 3.0, 0.2);
    let mut backward = forward.clone();
    let mut stood_on = std::collections::BTreeSet::new();
    for tick in 0..600 {
        let t = f64::from(tick) * DT;
        let lift = DVec3::Y * (0.3 * libm::sin(3.0 * t));
        pose(&mut one, &DAffine3::from_rotation_translation(across, lift));
        pose(
            &mut other,
            &DAffine3::from_translation(DVec3::Y * (0.3 * libm::cos(2.0 * t))),
        );
        let input = ClimberInput {
            walk: DVec3::new(libm::sin(t), 0.0, libm::cos(1.7 * t)),
            jump: tick % 70 == 69,
        };
        let ids = (ObstacleId(4), ObstacleId(9));
        let in_order: [(_, &dyn Obstacle); 2] = [(ids.0, &one), (ids.1, &other)];
        let reversed: [(_, &dyn Obstacle); 2] = [(ids.1, &other), (ids.0, &one)];
        if tick == 100 {
            let state = *backward.state();
            backward = climber_at(-5.0, 50.0, 3.0);
            backward.restore(state).unwrap();
        }
        let a = forward.step(&input, &in_order, DT).unwrap();
        let b = backward.step(&input, &reversed, DT).unwrap();
        assert_eq!(a, b, "tick {tick}");
        let (a, b) = (forward.state(), backward.state());
        assert_eq!(a.fingerprint(), b.fingerprint(), "tick {tick}: {a:?} {b:?}");
        stood_on.extend(a.footing.map(|footing| footing.obstacle));
    }
    assert_eq!(stood_on.len(), 2, "only ever stood on {stood_on:?}");
}

#[test]
fn bad_input_is_refused_and_changes_nothing() {
    let ground = level();
    let mut climber = landed(0.0, 0.5, 0.0, &ground);
    let before = *climber.state();
    let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &ground)];
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(climber.step(&IDLE, &obstacles, dt).is_err(), "{dt}");
    }
    let walk = DVec3::new(f64::NAN, 0.0, 0.0);
    assert!(
        climber
            .step(&ClimberInput { walk, jump: false }, &obstacles, DT)
            .is_err()
    );
    let broken = ClimberState {
        velocity: DVec3::NAN,
        ..before
    };
    assert!(climber.restore(broken).is_err());
    let footing = before.footing.map(|footing| Footing {
        offset: DVec3::NAN,
        ..footing
    });
    assert!(climber.restore(ClimberState { footing, ..before }).is_err());
    let mode = ClimberMode::Falling;
    assert_eq!(
        climber.restore(ClimberState { mode, ..before }),
        Err(ClimberError::Footing)
    );
    assert_eq!(*climber.state(), before);
    let config = ClimberConfig::default();
    assert!(Climber::new(config, DVec3::NAN).is_err());
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Climber::new(ClimberConfig { radius, ..config }, DVec3::ZERO).is_err());
    }
    let max_slope = 1.6;
    assert!(
        Climber::new(
            ClimberConfig {
                max_slope,
                ..config
            },
            DVec3::ZERO
        )
        .is_err()
    );
}

/// An obstacle that answers nonsense.
struct Broken;

impl Obstacle for Broken {
    fn cast_ray(&self, _: DVec3, _: DVec3, _: f64) -> Option<Contact> {
        Some(self.nonsense())
    }

    fn closest_point(&self, _: DVec3, _: f64) -> Option<Contact> {
        Some(self.nonsense())
    }

    fn overlap_sphere(&self, _: DVec3, _: f64, contacts: &mut Vec<Contact>) {
        contacts.push(self.nonsense());
    }

    fn motion(&self, _: &MaterialPoint, _: f64) -> Option<PointMotion> {
        None
    }
}

impl Broken {
    fn nonsense(&self) -> Contact {
        Contact {
            point: DVec3::NAN,
            normal: DVec3::splat(f64::INFINITY),
            distance: f64::NAN,
            material: MaterialPoint {
                key: 0,
                coordinates: [f64::NAN; 3],
            },
            tag: Default::default(),
        }
    }
}

#[test]
fn an_obstacle_that_answers_nonsense_does_not_spread_it() {
    let ground = level();
    let mut climber = climber_at(0.0, 1.0, 0.0);
    let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
        [(ObstacleId(0), &Broken), (ObstacleId(1), &ground)];
    for _ in 0..60 {
        climber.step(&IDLE, &obstacles, DT).unwrap();
        assert!(climber.state().is_finite(), "{:?}", climber.state());
    }
    assert!(
        (climber.state().position.y - 0.4).abs() < 1e-6,
        "{:?}",
        climber.state()
    );
}

/// An obstacle that must not be asked, since its bounds say that it is elsewhere.
struct Elsewhere(DVec3);

impl Obstacle for Elsewhere {
    fn bounds(&self) -> Option<(DVec3, f64)> {
        Some((self.0, 20.0))
    }

    fn cast_ray(&self, _: DVec3, _: DVec3, _: f64) -> Option<Contact> {
        panic!("asked for a ray at {}", self.0)
    }

    fn closest_point(&self, _: DVec3, _: f64) -> Option<Contact> {
        panic!("asked for the nearest point at {}", self.0)
    }

    fn overlap_sphere(&self, _: DVec3, _: f64, _: &mut Vec<Contact>) {
        panic!("asked for contacts at {}", self.0)
    }

    fn motion(&self, _: &MaterialPoint, _: f64) -> Option<PointMotion> {
        panic!("asked for motion at {}", self.0)
    }
}

#[test]
fn what_is_out_of_reach_is_not_asked_and_changes_no_bit() {
    let ground = level();
    let far: Vec<Elsewhere> = (0..40)
        .map(|k| Elsewhere(DVec3::new(60.0 + 50.0 * f64::from(k), 0.0, 0.0)))
        .collect();
    let mut crowd: Vec<(ObstacleId, &dyn Obstacle)> = vec![(ObstacleId(20), &ground)];
    for (k, one) in far.iter().enumerate() {
        let id = if k < 20 { 39 - k } else { k + 1 };
        crowd.push((ObstacleId(id as u32), one as &dyn Obstacle));
    }
    // Of two with one id the first counts, wherever they are: here the ground, there what is far away.
    crowd.push((ObstacleId(20), &far[0]));
    crowd.push((ObstacleId(30), &ground));
    let (mut alone, mut among) = (climber_at(0.0, 1.0, 0.0), climber_at(0.0, 1.0, 0.0));
    for tick in 0..240 {
        let input = ClimberInput {
            walk: DVec3::new(1.0, 0.0, 0.3),
            jump: tick % 50 == 49,
        };
        alone
            .step(&input, &[(ObstacleId(20), &ground)], DT)
            .unwrap();
        among.step(&input, &crowd, DT).unwrap();
        assert_eq!(alone.state(), among.state(), "tick {tick}");
    }
    assert!(alone.state().position.x > 5.0, "{:?}", alone.state());
}
