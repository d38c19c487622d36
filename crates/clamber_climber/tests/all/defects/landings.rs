//! Landings happen only on ground that holds the climber up, and keep the speed along the ground.

use clamber_climber::{ClimberConfig, ClimberMode};
use clamber_world::Obstacle;
use glam::{DVec3, Vec3};

use crate::cases::{pairs, triples};
use crate::defects::common::v;
use crate::events::{count, is_landed};
use crate::input::IDLE;
use crate::scene::{DT, STONE, climber, cuboid, cuboid_at, moved, placed, put, tick_among};
use crate::stage::{Played, Run, Shape, Stage};

/// The climber falls onto the edge of a block while a wall sweeps it off.
#[test]
fn lands_only_where_it_is_held_up() {
    let block = cuboid_at(Vec3::new(2.0, 1.0, 3.0), STONE, v(-2.0, -1.0, 0.0));
    let mut wall = cuboid(Vec3::new(0.5, 2.0, 3.0), STONE);
    let (mut runs, mut landings, mut wrong) = (0, 0, Vec::new());
    let speeds = [0.0, 2.0, 5.0, 10.0, 20.0, 30.0, 45.0, 60.0];
    for (fall, speed) in pairs([5.0, 12.0, 20.0], speeds) {
        for (i, j, gap) in triples(0..12, 0..12, [0.02, 0.05, 0.1, 0.2]) {
            let start = v(0.02 + 0.03 * f64::from(i), 0.34 + 0.03 * f64::from(j), 0.0);
            let near = block.closest_point(start, 2.0);
            if near.is_some_and(|contact| contact.distance < 0.4) {
                continue;
            }
            let from = v(start.x - 0.9 - gap, 2.05, 0.0);
            placed(&mut wall, from);
            moved(&mut wall, from + DVec3::X * (speed * DT));
            let mut climber = climber(start);
            put(&mut climber, start, v(0.0, -fall, 0.0));
            let report = tick_among(&mut climber, &[&block, &wall], &IDLE);
            runs += 1;
            if count(&report.events, is_landed) == 0 {
                continue;
            }
            landings += 1;
            let place = climber.state().position;
            let near = block.closest_point(place, 5.0);
            let off = near.map_or(f64::INFINITY, |contact| contact.distance) - 0.4;
            if off > 0.01 {
                let told = format!(
                    "from {start} at {fall} m/s, wall at {speed} m/s and {gap} m: {off} m \
                     clear, {:?}",
                    report.events
                );
                wrong.push(told);
            }
        }
    }
    assert!(landings > 1000, "{landings} of {runs}");
    assert!(
        wrong.is_empty(),
        "{} of {landings}: {}",
        wrong.len(),
        wrong[0]
    );
}

#[test]
fn a_fast_landing_slides_or_tumbles_on() {
    for (name, config) in [
        ("walker", ClimberConfig::walker()),
        ("colossus climber", ClimberConfig::colossus_climber()),
    ] {
        for (speed, down) in pairs([20.0, 40.0], [0.0, 0.5, 2.0, 5.0]) {
            let stage = Stage::new(Played::Root).with_still(&Shape::floor(100.0));
            let from = v(-60.0, 0.05, 0.0);
            let mut run = Run::new(stage, config, from).thrown(v(speed, -down, 0.0));
            let told = format!("{name} lands at {speed} m/s along and {down} m/s down");
            let mut landed = None;
            for _ in 0..60 {
                let was = run.position().x;
                let report = run.step(&IDLE);
                let way = run.position().x - was;
                // No tick loses more than half of the speed.
                assert!(way > 0.5 * speed / 60.0 * 0.9, "{told}: {way} m in a tick");
                if count(&report.events, is_landed) > 0 {
                    landed = Some(was);
                    break;
                }
            }
            let landed = landed.unwrap_or_else(|| panic!("{told}: {:?}", run.mode()));
            if config.tumble.is_some() {
                assert_eq!(run.mode(), ClimberMode::Tumbling, "{told}");
                continue;
            }
            for _ in 0..400 {
                run.step(&IDLE);
            }
            assert_eq!(run.mode(), ClimberMode::Standing, "{told}");
            let slid = run.position().x - landed;
            // From 40 m/s, the final braking by the feet is less than a percent of the distance.
            let feet = if speed < 40.0 {
                1.05 * config.ground.walk_speed
            } else {
                0.0
            };
            let expected = (speed * speed - feet * feet) / (2.0 * config.ground.friction);
            let off = slid / expected - 1.0;
            assert!(off.abs() <= 0.02, "{told}: {slid} of {expected} m");
        }
    }
}
