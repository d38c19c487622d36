//! Ledges that are approached obliquely, or caught from anywhere in reach, and friends on top of them.

use clamber_climber::{Climber, ClimberConfig, ClimberMode, ClimberObstacle};
use clamber_surface::geometry::rotation_from_axis_angle;
use glam::{DVec3, Vec3};

use crate::cases::{pairs, triples};
use crate::defects::common::v;
use crate::events::is_caught;
use crate::input::{HOLD, grip_climb, grip_walk};
use crate::scene::{DT, STONE, climber, cuboid, tick_among};

/// The climber approaches at 0 to 70 degrees from straight at the wall, to either side.
#[test]
fn oblique_ledges_are_caught_faced_and_followed() {
    let block = cuboid(Vec3::new(8.0, 3.0, 3.0), STONE);
    for step in -14..=14 {
        let degrees = 5.0 * f64::from(step);
        let angle = degrees.to_radians();
        let toward = v(libm::sin(angle), 0.0, -libm::cos(angle));
        let mut climber = climber(v(0.3, 2.75, 3.5));
        let input = grip_walk(toward * 0.1);
        let caught = (0..20).any(|_| {
            let events = tick_among(&mut climber, &[&block], &input).events;
            events.iter().any(is_caught)
        });
        assert!(caught, "at {degrees} degrees: {:?}", climber.state());
        for _ in 0..60 {
            tick_among(&mut climber, &[&block], &HOLD);
        }
        let heading = climber.state().heading;
        let off = libm::acos(heading.dot(-DVec3::Z).clamp(-1.0, 1.0)).to_degrees();
        assert!(off < 0.5, "at {degrees} degrees: heading {off} degrees off");
        for input in [
            grip_walk(DVec3::X),
            grip_walk(-DVec3::X),
            grip_climb(DVec3::X),
            grip_climb(-DVec3::X),
        ] {
            let way = input.walk + input.climb;
            let mut other = climber.clone();
            let from = other.state().position;
            for _ in 0..60 {
                tick_among(&mut other, &[&block], &input);
            }
            let told = format!("at {degrees} degrees along {way}: {:?}", other.state());
            assert_eq!(other.state().mode, ClimberMode::LedgeHanging, "{told}");
            let made = other.state().position - from;
            assert!((made.dot(way) - 1.0).abs() <= 0.01, "made {made} {told}");
            assert!(
                (made - way * made.dot(way)).length() < 0.01,
                "made {made} {told}"
            );
        }
    }
}

/// The climber starts at every place around the edge from which it can catch it.
#[test]
fn catching_a_ledge_moves_no_faster_than_arms_do() {
    let block = cuboid(Vec3::new(4.0, 3.0, 3.0), STONE);
    let config = ClimberConfig::colossus_climber();
    let most = 3.0 * config.grip.map_or(0.0, |grip| grip.climb_speed) * DT;
    let (mut caught, mut starts) = (0, 0);
    for (i, j, degrees) in triples(0..10, 0..14, [-60.0f64, 0.0, 45.0]) {
        let start = v(0.3, 2.0 + 0.1 * f64::from(j), 3.41 + 0.04 * f64::from(i));
        let angle = degrees.to_radians();
        let input = grip_walk(v(libm::sin(angle), 0.0, -libm::cos(angle)) * 0.1);
        starts += 1;
        let mut climber = Climber::new(config, start).unwrap();
        let mut is_on = false;
        for k in 0..40 {
            let before = *climber.state();
            let events = tick_among(&mut climber, &[&block], &input).events;
            let state = climber.state();
            let way = state.position.distance(before.position);
            let is_new = events.iter().any(is_caught);
            caught += u32::from(is_new);
            // In the tick of the catch, the climber may also fall.
            let falling = if is_new {
                before.velocity.length() * DT + 9.81 * DT * DT
            } else {
                0.0
            };
            is_on |= is_new;
            if is_on && state.mode == ClimberMode::LedgeHanging {
                assert!(
                    way <= most.max(falling) + 1e-6,
                    "from {start} at {degrees} degrees, tick {k}: {way} m, most {most}; \
                     {before:?} {state:?} {events:?}"
                );
            }
        }
    }
    assert!(caught * 3 > starts, "{caught} of {starts}");
}

/// A friend stands behind the edge of each side of a tower. The climber goes back to hanging, and pulls itself up once
/// the friend has gone.
#[test]
fn a_friend_at_the_edge_is_waited_for_from_below() {
    let tower = cuboid(Vec3::splat(3.0), STONE);
    for (side, behind) in pairs(0..4, [0.2, 0.3, 0.35]) {
        let turn =
            rotation_from_axis_angle(DVec3::Y, f64::from(side) * core::f64::consts::FRAC_PI_2);
        let told = format!("side {side}, friend {behind} m behind the edge");
        let up = grip_walk(turn * -DVec3::Z);
        let toward = grip_walk(up.walk * 0.1);
        let mut climber = climber(turn * v(0.3, 2.75, 3.5));
        let at = |z: f64| Climber::new(ClimberConfig::walker(), turn * v(0.3, 3.4, z)).unwrap();
        let friend = ClimberObstacle::new(&at(2.6 - behind), &[], DT);
        for _ in 0..60 {
            let is_caught = climber.state().mode == ClimberMode::LedgeHanging;
            let input = if is_caught { HOLD } else { toward };
            tick_among(&mut climber, &[&tower, &friend], &input);
        }
        let hung = climber.state().position;
        for _ in 0..120 {
            tick_among(&mut climber, &[&tower, &friend], &up);
        }
        let state = climber.state();
        assert_eq!(state.mode, ClimberMode::LedgeHanging, "{told}: {state:?}");
        let off = state.position.distance(hung);
        assert!(off < 5e-3, "{told}: {off} m from {hung}: {state:?}");
        let friend = ClimberObstacle::new(&at(0.0), &[], DT);
        for input in [HOLD, up] {
            for _ in 0..60 {
                tick_among(&mut climber, &[&tower, &friend], &input);
            }
        }
        let state = climber.state();
        assert_eq!(state.mode, ClimberMode::Standing, "{told}: {state:?}");
    }
}
