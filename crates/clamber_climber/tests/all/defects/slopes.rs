//! Slopes do not change the direction of a walk.

use clamber_climber::ClimberConfig;
use glam::DVec3;

use crate::cases::pairs;
use crate::defects::common::v;
use crate::input::walk;
use crate::stage::{Played, Run, Shape, Stage, radians};

#[test]
fn walks_on_slopes_where_the_input_points() {
    for (slope, step) in pairs([0.0, 20.0, 45.0], 0..16) {
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
            let aside = asked.to_degrees();
            let told =
                format!("{slope} degrees, {aside} degrees from the way up, {speed} m/s: {way}");
            let level = v(way.x, 0.0, way.z).normalize();
            let off = libm::asin(level.cross(toward).length()).to_degrees();
            assert!(
                off < 0.1 && level.dot(toward) > 0.0,
                "{told}: {off} degrees off"
            );
            let length = way.length();
            assert!((length / speed - 1.0).abs() < 0.005, "{told}: {length}");
        }
    }
}
