//! Eight climbers in a narrow room, with sticks and jumps at random.

use clamber_climber::{ClimberConfig, Others};
use glam::DVec3;

use crate::cases::pairs;
use crate::friends::crowd::Crowd;
use crate::input::IDLE;

/// Half of the room's length, metres.
const HALF: f64 = 1.5;

/// Largest displacement in a tick beside the motion of the support, metres, that is not the climber's own speed.
/// Climbers that push each other may part as fast as two climbers walk against each other.
fn farthest(others: Others) -> f64 {
    match others {
        Others::Block | Others::Pass => 0.1,
        Others::Push => 0.15,
    }
}

/// Distance that a climber moved on its own, metres. Motion that only undoes the carrying, because a wall stops it,
/// does not count.
fn beside_carrying(moved: DVec3, own: DVec3) -> f64 {
    let carried = moved - own;
    let left = [0, 1, 2].map(|axis| {
        let undone = (-own[axis] * carried[axis].signum()).clamp(0.0, carried[axis].abs());
        own[axis] + undone * carried[axis].signum()
    });
    DVec3::from_array(left).length()
}

fn play(others: Others, height: f64, minutes: f64, seed: u64) {
    let rate = 60.0;
    let mut config = ClimberConfig::walker();
    config.body.others = others;
    config.body.height = height;
    let places: Vec<DVec3> = (0..8)
        .map(|index| {
            let turn = std::f64::consts::TAU * f64::from(index) / 8.0;
            DVec3::new(libm::cos(turn), 0.4, libm::sin(turn))
        })
        .collect();
    let mut crowd = Crowd::new(config, &places, rate);
    for (axis, side) in pairs([DVec3::X, DVec3::Z], [-1.0, 1.0]) {
        let half = DVec3::new(2.0, 8.0, 2.0) - axis * 1.5;
        crowd.add_box(axis * (side * (HALF + 0.5)), half);
    }
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut inputs = [IDLE; 8];
    for tick in 0..(minutes * 60.0 * rate) as u32 {
        for input in &mut inputs {
            input.jump = rng.u32(0..90) == 0;
            if rng.u32(0..40) == 0 {
                let turn = std::f64::consts::TAU * rng.f64();
                let share = if rng.bool() { rng.f64() } else { 0.0 };
                input.walk = DVec3::new(libm::cos(turn), 0.0, libm::sin(turn)) * share;
            }
        }
        let states = (0..8).map(|index| *crowd.state(index));
        let before: Vec<_> = states.collect();
        crowd.step(DVec3::ZERO, |index| inputs[index]);
        for (index, was) in before.iter().enumerate() {
            let p = crowd.position(index);
            let told =
                format!("{others:?}, height {height}, seed {seed}, tick {tick}, {index} at {p}");
            assert!(p.x.abs().max(p.z.abs()) < HALF - 0.38, "{told}: outside");
            assert!(p.y > 0.38, "{told}: below");
            let own_way = beside_carrying(p - was.position, crowd.state(index).own_way);
            let way = p.distance(was.position).min(own_way);
            let states = [*was, *crowd.state(index)];
            let [was, is] = states.map(|state| state.velocity.length());
            let own = was.max(is) / rate;
            assert!(
                way < farthest(others).max(own + 0.06),
                "{told}: {way}, own {own}"
            );
        }
    }
}

#[test]
fn eight_stay_in_their_room() {
    let kinds = [(Others::Block, 0), (Others::Push, 1), (Others::Pass, 2)];
    for ((others, seed), height) in pairs(kinds, [0.0, 1.0]) {
        play(others, height, 0.5, seed);
    }
}

#[test]
#[ignore = "takes minutes"]
fn eight_stay_in_their_room_for_an_hour() {
    play(Others::Block, 0.0, 60.0, 7);
}
