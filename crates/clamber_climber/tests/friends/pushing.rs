//! Climbers that push each other by their masses, or pass.

use clamber_climber::{ClimberInput, Others};
use glam::DVec3;

use crate::crowd::{Crowd, IDLE, RATES, SIZES, walker};

/// Two in a row along x, of some masses.
fn pair(others: Others, masses: [f64; 2], size: f64, rate: f64) -> Crowd {
    let places = [0.0, 1.0].map(|x| DVec3::new(x, 0.4, 0.0) * size);
    let mut crowd = Crowd::new(walker(size), &places, rate);
    for (climber, mass) in crowd.climbers.iter_mut().zip(masses) {
        let mut config = walker(size);
        config.body.mass = mass;
        config.body.others = others;
        climber.set_config(config).unwrap();
    }
    crowd.rest(0.2);
    crowd
}

fn walk(share: f64) -> ClimberInput {
    ClimberInput {
        walk: DVec3::X * share,
        ..IDLE
    }
}

/// Mean velocities along x over the second half of a second, in sizes.
fn speeds(crowd: &mut Crowd, size: f64, inputs: [f64; 2]) -> [f64; 2] {
    let half = (0.5 / crowd.dt).round() as u32;
    let mut from = [DVec3::ZERO; 2];
    for tick in 0..2 * half {
        if tick == half {
            from = [0, 1].map(|index| crowd.position(index));
        }
        crowd.step(DVec3::ZERO, |index| walk(inputs[index]));
        for index in 0..2 {
            assert!(!crowd.state(index).crushed);
        }
    }
    let time = f64::from(half) * crowd.dt;
    [0, 1].map(|index| (crowd.position(index) - from[index]).x / time / size)
}

#[test]
fn who_pushes_goes_on_at_the_common_velocity_of_both_masses() {
    for size in SIZES {
        for rate in RATES {
            for masses in [[80.0, 80.0], [80.0, 40.0], [40.0, 80.0], [80.0, 300.0]] {
                for inputs in [[1.0, 0.0], [0.5, -1.0], [1.0, -1.0]] {
                    let mut crowd = pair(Others::Push, masses, size, rate);
                    let full = crowd.climbers[0].config().ground.walk_speed / size;
                    let [a, b] = speeds(&mut crowd, size, inputs);
                    let momentum = masses[0] * inputs[0] + masses[1] * inputs[1];
                    let common = full * momentum / (masses[0] + masses[1]);
                    let told = format!(
                        "size {size}, {rate} Hz, {masses:?} kg, sticks {inputs:?}: {a} and {b}, not {common}"
                    );
                    assert!((a - common).abs() < 0.05 * full, "{told}");
                    assert!((b - common).abs() < 0.05 * full, "{told}");
                    let gap = (crowd.position(1).x - crowd.position(0).x) / size;
                    assert!(gap > 0.49, "{told}: {gap} apart");
                }
            }
        }
    }
}

#[test]
fn who_blocks_stands() {
    for rate in RATES {
        let mut crowd = pair(Others::Block, [300.0, 10.0], 1.0, rate);
        let [a, b] = speeds(&mut crowd, 1.0, [1.0, 0.0]);
        assert!(a.abs().max(b.abs()) < 0.01, "{rate} Hz: {a} and {b}");
    }
}

#[test]
fn nobody_is_pushed_through_a_wall() {
    for rate in RATES {
        for others in [Others::Push, Others::Pass] {
            let mut crowd = pair(others, [300.0, 40.0], 1.0, rate);
            crowd.add_box(DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.1, 4.0, 4.0));
            for tick in 0..(3.0 * rate) as u32 {
                crowd.step(DVec3::ZERO, |index| {
                    walk(if index == 0 { 1.0 } else { 0.0 })
                });
                let told = format!("{rate} Hz, {others:?}, tick {tick}");
                for index in 0..2 {
                    assert!(crowd.position(index).x < 1.9 - 0.38, "{told}");
                    assert!(!crowd.state(index).crushed, "{told}");
                }
            }
        }
    }
}

#[test]
fn who_passes_goes_through_and_on() {
    for rate in RATES {
        let mut crowd = pair(Others::Pass, [80.0, 80.0], 1.0, rate);
        crowd.boxes.clear();
        crowd.add_box(DVec3::NEG_Y, DVec3::new(40.0, 1.0, 4.0));
        for _ in 0..(1.5 * rate) as u32 {
            crowd.step(DVec3::ZERO, |index| {
                walk(if index == 0 { 1.0 } else { 0.0 })
            });
        }
        let [a, b] = [crowd.position(0), crowd.position(1)];
        let told = format!("{rate} Hz: {a}, {b}");
        assert!(a.x > b.x + 2.0, "{told}");
        assert!(b.distance(DVec3::new(1.0, 0.4, 0.0)) < 0.6, "{told}");
        assert!(
            (a.y - 0.4).abs() < 0.02 && (b.y - 0.4).abs() < 0.02,
            "{told}"
        );
    }
}
