//! Slopes do not change the direction of a walk.

use clamber_climber::ClimberConfig;
use glam::DVec3;

use crate::defects::common::v;
use crate::stage::{Played, Run, Shape, Stage, radians, walk};

#[test]
fn walks_on_slopes_where_the_input_points() {
    for slope in [0.0, 20.0, 45.0] {
        for step in 0..16 {
            let asked = radians(22.5 * f64::from(step));
            for speed in [1.0, 3.0, 6.0] {
                let angle = radians(slope);
                let shape = Shape::floor(50.0).turned(DVec3::X, -angle);
                let stage = Stage::new(Played::Root).with_still(&shape);
                let mut config = ClimberConfig::walker();
                config.ground.walk_speed = speed;
                let feet = 0.4 / libm::cos(angle) - 0.4 + 0.02;
                let mut run = Run::new(stage, config, v(0.0, feet, 0.0)).settle();
                let from = run.position();
                let toward = v(libm::sin(asked), 0.0, libm::cos(asked));
                run.steps(60, &walk(toward));
                let way = run.position() - from;
                let told = format!(
                    "slope of {slope} degrees, {} degrees from the way up, {speed} m/s: {way}",
                    asked.to_degrees()
                );
                let level = v(way.x, 0.0, way.z).normalize();
                let off = libm::asin(level.cross(toward).length()).to_degrees();
                assert!(
                    off < 0.1 && level.dot(toward) > 0.0,
                    "{told}: {off} degrees off"
                );
                assert!(
                    (way.length() / speed - 1.0).abs() < 0.005,
                    "{told}: {}",
                    way.length()
                );
            }
        }
    }
}
