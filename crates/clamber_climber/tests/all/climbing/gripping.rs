//! The tick in which a climber takes hold of a moving obstacle.

use clamber_climber::{Climber, ClimberConfig, ClimberMode};
use glam::{DVec3, Vec3};

use crate::cases::pairs;
use crate::input::{HOLD, IDLE};
use crate::scene::{DT, FUR, STONE, assert_mode, climber, cuboid, moved, placed, tick_among};

/// In flight, the climber grips a wall that moves as fast as a striking limb.
#[test]
fn gripping_an_approaching_wall_keeps_the_climber_in_front_of_it() {
    for (tag, start) in pairs([FUR, STONE], 0..20) {
        let mut wall = cuboid(Vec3::new(4.0, 3.0, 0.3), tag);
        let z = -1.0 - 0.07 * f64::from(start);
        let speed = 60.0;
        let at = |tick: u32| DVec3::new(0.0, 0.0, z + speed * DT * f64::from(tick));
        placed(&mut wall, at(0));
        let mut climber = climber(DVec3::new(0.3, 2.3, 0.5));
        for tick in 1..=6 {
            moved(&mut wall, at(tick));
            tick_among(&mut climber, &[&wall], &HOLD);
            let front = at(tick).z + 0.3;
            let gap = climber.state().position.z - front;
            let over = climber.state().position.y > 3.3;
            assert!(
                gap > 0.38 || over,
                "{tag:?} {start} {tick}: {gap} {:?}",
                climber.state()
            );
        }
    }
}

/// The hold swings the climber against a wall at rest: the arm gives way, not the wall.
#[test]
fn a_climber_dragged_against_a_wall_is_torn_off_not_dragged_through() {
    let wall = cuboid(Vec3::new(0.5, 6.0, 6.0), STONE);
    let mut beam = cuboid(Vec3::new(1.0, 0.3, 1.0), FUR);
    let mut config = ClimberConfig::colossus_climber();
    config.grip.as_mut().unwrap().max_overhang = 2.0;
    let at = |tick: u32| DVec3::new(4.0 - 0.2 * f64::from(tick), 7.0, 0.0);
    placed(&mut beam, at(0));
    let mut climber = Climber::new(config, DVec3::new(4.0, 6.2, 0.0)).unwrap();
    for _ in 0..60 {
        moved(&mut beam, at(0));
        tick_among(&mut climber, &[&wall, &beam], &HOLD);
    }
    assert_mode(&climber, ClimberMode::Hanging);
    for tick in 1..=40 {
        // The beam goes over the wall's top and down on its other side.
        moved(&mut beam, at(tick) - DVec3::Y * 0.04 * f64::from(tick));
        tick_among(&mut climber, &[&wall, &beam], &HOLD);
        let p = climber.state().position;
        let inside = (DVec3::new(0.5, 6.0, 6.0) - p.abs()).min_element();
        assert!(inside < -0.35, "{tick}: {inside} {:?}", climber.state());
    }
}

/// In the tick in which it grips the ground, the climber is carried as in any other tick, at any speed.
#[test]
fn gripping_the_ground_underfoot_keeps_the_climber_on_its_point() {
    for velocity in [DVec3::X * 20.0, DVec3::Y * 9.0, DVec3::Y * -25.0] {
        let mut ground = cuboid(Vec3::new(4.0, 1.0, 4.0), FUR);
        let mut config = ClimberConfig::colossus_climber();
        // The ground starts with a jerk.
        config.ground.throw_acceleration = f64::INFINITY;
        config.tumble = None;
        config.grip.as_mut().unwrap().hang_acceleration = f64::INFINITY;
        let mut climber = Climber::new(config, DVec3::new(0.0, 1.4, 0.0)).unwrap();
        let mut off = DVec3::ZERO;
        for tick in 0..40 {
            let at = velocity * (f64::from(tick) * DT);
            if tick < 10 {
                placed(&mut ground, DVec3::ZERO);
            } else {
                moved(&mut ground, at);
            }
            let input = if tick < 20 { IDLE } else { HOLD };
            tick_among(&mut climber, &[&ground], &input);
            if tick == 19 {
                assert_mode(&climber, ClimberMode::Standing);
                off = climber.state().position - at;
            } else if tick > 19 {
                assert_mode(&climber, ClimberMode::Holding);
                let slipped = climber.state().position - at - off;
                assert!(slipped.length() < 0.01, "{velocity} {tick}: {slipped}");
            }
        }
    }
}
