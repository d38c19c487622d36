//! Catches in flight, and jumps off the caught hold.

use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberMode};
use clamber_world::HalfSpace;
use glam::DVec3;

use crate::cases::{pairs, triples};
use crate::input::HOLD;
use crate::moving::MovingHalfSpace;
use crate::numbers::in_world_of_size;
use crate::scene::{FUR, list, throw};

/// A climber beside fur that moves with its frame.
struct Flight {
    climber: Climber,
    fur: HalfSpace,
    frame: DVec3,
    dt: f64,
    tick: u32,
}

impl Flight {
    fn new(config: ClimberConfig, position: DVec3, velocity: DVec3, frame: DVec3) -> Self {
        let mut climber = Climber::new(config, position).unwrap();
        throw(&mut climber, frame + velocity, frame);
        Self {
            climber,
            fur: HalfSpace::below(0.0),
            frame,
            dt: 1.0 / 60.0,
            tick: 0,
        }
    }

    fn step(&mut self, input: &ClimberInput) {
        let shift = |tick: u32| self.frame * (f64::from(tick) * self.dt);
        let fur = MovingHalfSpace {
            at_rest: self.fur.with_tag(FUR),
            shifts: [shift(self.tick), shift(self.tick + 1)],
        };
        self.climber.step(input, &list(&[&fur]), self.dt).unwrap();
        self.tick += 1;
    }
}

#[test]
fn hands_slip_beyond_their_catch_speed_wherever_the_tick_ends() {
    let usual = ClimberConfig::colossus_climber();
    let fastest = usual.grip.unwrap().catch_speed;
    for (size, rate, share) in [
        (1.0, 30.0, 1.05),
        (1.0, 60.0, 2.0),
        (1.0, 120.0, 3.5),
        (1.0, 240.0, 1.05),
        (0.02, 60.0, 2.0),
        (100.0, 60.0, 2.0),
    ] {
        for (frame, drop) in pairs([0.0, 30.0, 300.0], 0..20) {
            let (dt, speed) = (1.0 / rate, share * fastest * size);
            let height = 3.0 * size + f64::from(drop) * speed * dt / 20.0;
            let config = in_world_of_size(usual, size);
            let frame = DVec3::X * (frame * size);
            let mut flight = Flight {
                dt,
                ..Flight::new(config, DVec3::Y * height, -DVec3::Y * speed, frame)
            };
            while flight.climber.state().mode == ClimberMode::Falling {
                flight.step(&HOLD);
            }
            let told = format!("size {size}, {rate} Hz, {speed} m/s, {frame}, drop {drop}");
            let state = flight.climber.state();
            assert_eq!(state.mode, ClimberMode::Tumbling, "{told}");
        }
    }
}

#[test]
fn a_catch_that_ends_in_a_contact_costs_stamina_by_its_speed() {
    let config = ClimberConfig::colossus_climber();
    let cost = config.stamina.unwrap().catch_cost;
    let speed = 11.0;
    for drop in 0..20 {
        let height = 3.0 + f64::from(drop) * speed / 60.0 / 20.0;
        let mut flight = Flight::new(config, DVec3::Y * height, -DVec3::Y * speed, DVec3::ZERO);
        while flight.climber.state().mode == ClimberMode::Falling {
            flight.step(&HOLD);
        }
        let state = flight.climber.state();
        let told = format!("drop {drop}: {state:?}");
        assert_eq!(state.mode, ClimberMode::Holding, "{told}");
        let least = cost * (speed - config.ground.walk_speed);
        assert!(state.stamina <= 1.0 - least, "{told}");
    }
}

#[test]
fn a_jump_off_a_level_ceiling_goes_straight_down() {
    let usual = ClimberConfig::colossus_climber();
    let sizes = [0.02, 1.0, 100.0];
    for (size, rate, frame) in triples(sizes, [30.0, 60.0, 240.0], [0.0, 30.0, 300.0]) {
        // Rounding of f32, and the tilt of a bump of skin.
        let tilts = [0.0, 1e-16, 1e-7, 1e-3, 0.05];
        for (tilt, aside) in pairs(tilts, [DVec3::X, DVec3::NEG_Z]) {
            let config = in_world_of_size(usual, size);
            let frame = DVec3::Z * (frame * size);
            let below = DVec3::new(0.0, -0.45 * size, 0.0);
            let normal = (DVec3::NEG_Y + aside * tilt).normalize();
            let mut flight = Flight {
                fur: HalfSpace::behind(DVec3::ZERO, normal).unwrap(),
                dt: 1.0 / rate,
                ..Flight::new(config, below, DVec3::ZERO, frame)
            };
            let told = format!("{size} {rate} Hz {frame} tilt {tilt} to {aside}");
            for _ in 0..20 {
                flight.step(&HOLD);
            }
            let state = flight.climber.state();
            assert_eq!(state.mode, ClimberMode::Holding, "{told}");
            flight.step(&ClimberInput { jump: true, ..HOLD });
            let own = (flight.climber.state().velocity - frame) / size;
            let aside = DVec3::new(own.x, 0.0, own.z).length();
            assert!(aside < 0.06 * own.length(), "{told}: {own}");
            assert!(own.y < -1.0, "{told}: {own}");
        }
    }
}
