use clamber_climber::{ClimberEvent, ClimberInput, ClimberMode};
use glam::{DVec3, Vec3};

use crate::events::{count, is_turned_corner};
use crate::input::{HOLD, IDLE, grip_climb, grip_walk};
use crate::scene::{
    DT, FUR, STONE, assert_mode, climber, cuboid, cuboid_at, cuboid_with, run, step,
};

#[test]
fn grips_a_wall_of_fur_in_flight_and_stays_on_it() {
    let wall = cuboid(Vec3::new(5.0, 10.0, 1.0), FUR);
    let mut climber = climber(DVec3::new(0.3, 2.0, 1.6));
    let events = run(&mut climber, &[&wall], &HOLD, 1);
    assert!(
        matches!(events[0], ClimberEvent::Grabbed { .. }),
        "{events:?}"
    );
    let events = run(&mut climber, &[&wall], &HOLD, 60);
    assert!(events.is_empty(), "{events:?}");
    assert_mode(&climber, ClimberMode::Holding);
    // The climber fell for one tick, and grips from there.
    let fallen = 9.81 * DT * DT * 0.5;
    let off = climber.state().position - DVec3::new(0.3, 2.0 - fallen, 1.4);
    assert!(off.length() < 1e-4, "{:?}", climber.state().position);
}

#[test]
fn stone_is_not_gripped() {
    let wall = cuboid(Vec3::new(5.0, 10.0, 1.0), STONE);
    let mut climber = climber(DVec3::new(0.3, 2.0, 1.45));
    let events = run(&mut climber, &[&wall], &HOLD, 30);
    assert!(events.is_empty(), "{events:?}");
    assert_mode(&climber, ClimberMode::Falling);
}

#[test]
fn climbs_in_any_direction_at_its_speed() {
    let wall = cuboid(Vec3::new(20.0, 20.0, 1.0), FUR);
    for direction in [
        DVec3::X,
        -DVec3::X,
        DVec3::Y,
        -DVec3::Y,
        DVec3::new(0.6, 0.8, 0.0),
    ] {
        let mut climber = climber(DVec3::new(0.3, 2.0, 1.4));
        run(&mut climber, &[&wall], &HOLD, 10);
        let from = climber.state().position;
        run(&mut climber, &[&wall], &grip_climb(direction), 60);
        let made = climber.state().position - from;
        assert!(
            (made - direction * 1.5).length() < 1e-3,
            "{direction} {made}"
        );
    }
}

#[test]
fn pushing_at_a_wall_climbs_it_and_pulling_away_climbs_down() {
    let wall = cuboid(Vec3::new(20.0, 20.0, 1.0), FUR);
    for (walk, rise) in [(-DVec3::Z, 1.5), (DVec3::Z, -1.5), (DVec3::X, 0.0)] {
        let mut climber = climber(DVec3::new(0.3, 2.0, 1.4));
        run(&mut climber, &[&wall], &HOLD, 10);
        let from = climber.state().position;
        run(&mut climber, &[&wall], &ClimberInput { walk, ..HOLD }, 60);
        let made = climber.state().position - from;
        assert!((made.y - rise).abs() < 1e-3, "{walk} {made}");
    }
}

#[test]
fn climbs_around_convex_corners_all_around_a_block() {
    let block = cuboid(Vec3::new(1.0, 8.0, 1.0), FUR);
    let mut climber = climber(DVec3::new(0.0, 0.0, 1.4));
    run(&mut climber, &[&block], &HOLD, 5);
    let mut corners = 0;
    let mut turned = 0.0;
    let mut angle = 0.0f64;
    for _ in 0..900 {
        let p = climber.state().position;
        let normal = climber.state().support.unwrap().normal_in_world();
        let aside = DVec3::Y.cross(normal);
        let report = step(&mut climber, &[&block], &grip_climb(aside));
        assert_mode(&climber, ClimberMode::Holding);
        corners += count(&report.events, is_turned_corner);
        let q = climber.state().position;
        turned += libm::atan2(p.z * q.x - p.x * q.z, p.x * q.x + p.z * q.z);
        angle = angle.max((q - p).length());
    }
    // The climber climbs 22.5 m around the block: one round is 8 m of faces and a full circle of radius 0.4 m at the
    // corners.
    assert!(turned > 12.0, "{turned}");
    assert_eq!(
        corners,
        // The climber lies flat on the next face shortly after its centre has passed the edge.
        (turned / std::f64::consts::FRAC_PI_2 + 0.5 - 0.12) as usize,
        "{turned}"
    );
    assert!(angle < 1.5 * DT * 1.01, "{angle}");
}

#[test]
fn climbs_from_the_floor_up_a_concave_corner_and_over_the_top() {
    let floor = cuboid(Vec3::new(10.0, 1.0, 10.0), FUR);
    let wall = cuboid_at(Vec3::new(5.0, 3.0, 1.0), FUR, DVec3::new(0.0, 3.0, -3.0));
    let surfaces = [&floor, &wall];
    let mut climber = climber(DVec3::new(0.0, 1.4, 0.0));
    run(&mut climber, &surfaces, &HOLD, 5);
    assert_mode(&climber, ClimberMode::Holding);
    let forward = grip_walk(-DVec3::Z);
    let events = run(&mut climber, &surfaces, &forward, 330);
    let state = climber.state();
    // On level fur, the climber faces as it did on the wall.
    assert!(state.heading.dot(-DVec3::Z) > 0.999, "{state:?}");
    assert!(state.position.y > 6.0, "{state:?} {events:?}");
    assert_eq!(count(&events, is_turned_corner), 2, "{events:?}");
}

#[test]
fn climbs_from_one_part_onto_another_and_from_one_creature_onto_another() {
    let lower = cuboid(Vec3::new(3.0, 2.0, 1.0), FUR);
    let upper = cuboid_at(Vec3::new(3.0, 2.0, 1.0), FUR, DVec3::new(0.0, 4.2, 0.1));
    let mut climber = climber(DVec3::new(0.0, 0.0, 1.4));
    let surfaces = [&lower, &upper];
    run(&mut climber, &surfaces, &HOLD, 5);
    run(&mut climber, &surfaces, &grip_climb(DVec3::Y), 160);
    let support = climber.state().support.unwrap();
    assert_eq!(support.attachment.obstacle.0, 1, "{:?}", climber.state());
    assert_mode(&climber, ClimberMode::Holding);
}

#[test]
fn climbing_stops_where_fur_ends_at_stone() {
    let tag = |p: Vec3| if p.y > 2.0 { STONE } else { FUR };
    let wall = cuboid_with(Vec3::new(5.0, 10.0, 1.0), tag);
    let mut climber = climber(DVec3::new(0.3, 0.0, 1.4));
    run(&mut climber, &[&wall], &grip_climb(DVec3::Y), 240);
    assert_mode(&climber, ClimberMode::Holding);
    let height = climber.state().position.y;
    assert!((2.0..2.5).contains(&height), "{height}");
}

#[test]
fn climbs_from_fur_onto_stone_that_can_be_stood_on() {
    let tag = |p: Vec3| if p.y > 2.99 { STONE } else { FUR };
    let block = cuboid_with(Vec3::new(5.0, 3.0, 5.0), tag);
    let mut climber = climber(DVec3::new(0.3, 1.0, 5.4));
    let forward = grip_walk(-DVec3::Z);
    let events = run(&mut climber, &[&block], &forward, 240);
    let state = climber.state();
    assert!(state.position.y > 3.3, "{state:?} {events:?}");
    run(&mut climber, &[&block], &IDLE, 30);
    assert_mode(&climber, ClimberMode::Standing);
}
