//! Climbers that lie on a light body which another object moves.

use clamber_climber::{Climber, ClimberConfig, ClimberMode, StepRules};
use clamber_world::HalfSpace;
use glam::DVec3;

use crate::cases::WORLDS;
use crate::held::Held;
use crate::input::{IDLE, blow};
use crate::moving::MovingHalfSpace;
use crate::numbers::in_world_of_size;
use crate::scene::list;

#[test]
fn who_lies_on_a_plank_in_a_lift_that_speeds_up_goes_with_it() {
    for (size, rate) in WORLDS {
        for speeds_up in [0.0, 1.0, -1.0, 4.0] {
            let config = ClimberConfig {
                tumble: ClimberConfig::colossus_climber().tumble,
                ..ClimberConfig::walker()
            };
            let config = in_world_of_size(config, size);
            let mut climber = Climber::new(config, DVec3::Y * (0.4 * size)).unwrap();
            let (dt, mut lay, mut most) = (1.0 / rate, 0.0, 0.0f64);
            let height = |tick: u32| {
                let time = f64::from(tick) * dt;
                DVec3::Y * (0.5 * speeds_up * time * time * size)
            };
            for tick in 0..(3.0 * rate) as u32 {
                let lift = MovingHalfSpace {
                    at_rest: HalfSpace::below(0.0),
                    shifts: [height(tick), height(tick + 1)],
                };
                let plank = Held(lift, 5.0);
                let mut rules = StepRules::default();
                if tick == 5 {
                    rules.knockback = blow(DVec3::X * (5.0 * size));
                }
                let step = climber.step_with(&IDLE, &list(&[&plank]), &rules, dt);
                step.unwrap();
                let state = climber.state();
                if state.mode == ClimberMode::Tumbling {
                    lay += dt;
                    let rises = (height(tick + 1) - height(tick)) / dt;
                    most = most.max((state.velocity - rises).y.abs() / size);
                }
            }
            let told = format!("size {size}, {rate} Hz, {speeds_up} m/s²: {most} m/s off");
            assert_eq!(climber.state().mode, ClimberMode::Standing, "{told}");
            assert!(lay > 0.3 && most < 1.2, "{told} in {lay} s");
        }
    }
}
