//! Climbers that push each other by their masses, or pass.

use clamber_climber::{ClimberConfig, ClimberMode, Others};
use glam::DVec3;

use crate::cases::{pairs, triples};
use crate::friends::crowd::{Crowd, RATES, SIZES, walker};
use crate::input::{IDLE, walk};

/// Two climbers in a row along x, with masses.
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

/// Mean velocities along x over the second half of a second, in sizes.
fn speeds(crowd: &mut Crowd, size: f64, inputs: [f64; 2]) -> [f64; 2] {
    let half = (0.5 / crowd.dt).round() as u32;
    let mut from = [DVec3::ZERO; 2];
    for tick in 0..2 * half {
        if tick == half {
            from = [0, 1].map(|index| crowd.position(index));
        }
        crowd.step(DVec3::ZERO, |index| walk(DVec3::X * inputs[index]));
        for index in 0..2 {
            assert!(!crowd.state(index).crushed);
        }
    }
    let time = f64::from(half) * crowd.dt;
    [0, 1].map(|index| (crowd.position(index) - from[index]).x / time / size)
}

#[test]
fn who_pushes_goes_on_at_the_common_velocity_of_both_masses() {
    let loads = [[80.0, 80.0], [80.0, 40.0], [40.0, 80.0], [80.0, 300.0]];
    let sticks = [[1.0, 0.0], [0.5, -1.0], [1.0, -1.0]];
    for (size, rate) in pairs(SIZES, RATES) {
        for (masses, inputs) in pairs(loads, sticks) {
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
    for (rate, others) in pairs(RATES, [Others::Push, Others::Pass]) {
        let mut crowd = pair(others, [300.0, 40.0], 1.0, rate);
        crowd.add_box(DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.1, 4.0, 4.0));
        for tick in 0..(3.0 * rate) as u32 {
            crowd.step_first(walk(DVec3::X));
            let told = format!("{rate} Hz, {others:?}, tick {tick}");
            for index in 0..2 {
                assert!(crowd.position(index).x < 1.9 - 0.38, "{told}");
                assert!(!crowd.state(index).crushed, "{told}");
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
            crowd.step_first(walk(DVec3::X));
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

/// A pushed climber keeps standing, however it is pushed.
#[test]
fn who_is_pushed_keeps_its_footing() {
    let pushers = [[80.0, 1.0], [240.0, 1.0], [80.0, 0.3]];
    for (size, rate, [mass, stick]) in triples(SIZES, RATES, pushers) {
        let mut crowd = pair(Others::Push, [mass, 80.0], size, rate);
        for tick in 0..(2.0 * rate) as u32 {
            let told = format!("size {size}, {rate} Hz, {mass} kg, {stick}, tick {tick}");
            let reports = crowd.step_first(walk(DVec3::X * stick));
            for report in &reports {
                assert!(report.events.is_empty(), "{told}: {:?}", report.events);
            }
            assert_eq!(crowd.state(1).mode, ClimberMode::Standing, "{told}");
        }
        assert!(crowd.position(1).x / size > 1.3);
    }
}

#[test]
fn who_passes_drags_nobody_along_at_any_speed() {
    for (size, rate) in pairs(SIZES, RATES) {
        for (stick, aside) in pairs([0.05, 0.1, 0.3, 0.5, 1.0], [0.0, 0.05, 0.4]) {
            let mut crowd = pair(Others::Pass, [80.0, 80.0], size, rate);
            crowd.boxes.clear();
            let ground = DVec3::new(40.0, 1.0, 4.0) * size;
            crowd.add_box(DVec3::NEG_Y * size, ground);
            crowd.put(1, DVec3::new(1.0, 0.4, aside) * size);
            crowd.rest(0.2);
            let full = crowd.climbers[0].config().ground.walk_speed / size;
            let from = crowd.position(1);
            for _ in 0..(2.5 / full / stick * rate) as u32 {
                crowd.step_first(walk(DVec3::X * stick));
            }
            let told = format!("size {size}, {rate} Hz, {stick}, {aside} aside");
            let moved = crowd.position(1).distance(from) / size;
            assert!(moved < 0.01, "{told}: {moved}");
            let past = (crowd.position(0).x - crowd.position(1).x) / size;
            assert!(past > 1.0, "{told}: {past}");
        }
    }
}

#[test]
fn who_stands_in_another_one_parts_softly() {
    for rate in RATES {
        let mut crowd = pair(Others::Pass, [80.0, 80.0], 1.0, rate);
        crowd.put(1, DVec3::new(0.2, 0.4, 0.0));
        let mut was = [0, 1].map(|index| crowd.position(index));
        for _ in 0..(2.0 * rate) as u32 {
            crowd.step(DVec3::ZERO, |_| IDLE);
            for (index, was) in was.iter_mut().enumerate() {
                let way = crowd.position(index).distance(*was);
                assert!(way * rate < 0.6, "{rate} Hz: {} m/s", way * rate);
                *was = crowd.position(index);
            }
        }
        let apart = was[0].distance(was[1]);
        assert!((0.77..0.82).contains(&apart), "{rate} Hz: {apart}");
    }
}

/// If either of two climbers passes, they pass; otherwise, if either blocks, they block.
#[test]
fn the_softer_way_of_two_counts() {
    use Others::{Block, Pass, Push};
    let mixed = [
        ([Push, Block], Block),
        ([Block, Push], Block),
        ([Push, Pass], Pass),
        ([Pass, Push], Pass),
        ([Block, Pass], Pass),
        ([Pass, Block], Pass),
    ];
    for ((others, counts), rate) in pairs(mixed, RATES) {
        let ends = |others: [Others; 2]| {
            let mut crowd = pair(others[0], [80.0, 80.0], 1.0, rate);
            for (climber, others) in crowd.climbers.iter_mut().zip(others) {
                let mut config = *climber.config();
                config.body.others = others;
                climber.set_config(config).unwrap();
            }
            for _ in 0..rate as u32 {
                crowd.step_first(walk(DVec3::X));
            }
            [0, 1].map(|index| crowd.position(index))
        };
        let (mixed, alike) = (ends(others), ends([counts; 2]));
        for (a, b) in mixed.iter().zip(&alike) {
            assert!(a.distance(*b) < 1e-9, "{others:?}, {rate} Hz: {a} {b}");
        }
    }
}

/// The larger climber pushes the smaller one as any other, and does not walk over it.
#[test]
fn sizes_do_not_change_who_pushes_whom() {
    let kinds = [Others::Push, Others::Block, Others::Pass];
    for (ratio, others, rate) in triples([0.1, 0.3, 1.0, 3.0, 10.0], kinds, RATES) {
        let sizes = [ratio, 1.0];
        let gap = 0.4 * (ratio + 1.0) + 0.3;
        let places = [DVec3::Y * 0.4 * ratio, DVec3::new(gap, 0.4, 0.0)];
        // In a tick, the climber pushes by at most three quarters of the smaller radius.
        let speed = 3.0 * f64::min(ratio, 1.0).sqrt();
        // Ticks in which the climber walks by half the smaller radius are too long for that.
        if speed / rate > 0.5 * 0.4 * f64::min(ratio, 1.0) {
            continue;
        }
        let mut crowd = Crowd::new(walker(1.0), &places, rate);
        crowd.boxes.clear();
        crowd.add_box(DVec3::NEG_Y, DVec3::new(60.0, 1.0, 60.0));
        for (climber, size) in crowd.climbers.iter_mut().zip(sizes) {
            let mut config = ClimberConfig::walker().scaled(size);
            config.ground.walk_speed = speed;
            config.body.others = others;
            climber.set_config(config).unwrap();
        }
        crowd.rest(0.5);
        let from = crowd.position(1).x;
        for tick in 0..(9.0 / speed * rate) as u32 {
            crowd.step_first(walk(DVec3::X));
            let told = format!("ratio {ratio}, {others:?}, {rate} Hz, tick {tick}");
            for (index, size) in sizes.iter().enumerate() {
                let height = crowd.position(index).y - 0.4 * size;
                assert!(height.abs() < 0.02 * size, "{told}: {index} at {height}");
                assert_eq!(crowd.state(index).mode, ClimberMode::Standing, "{told}");
            }
        }
        let moved = crowd.position(1).x - from;
        let past = crowd.position(0).x - crowd.position(1).x;
        let told = format!("ratio {ratio}, {others:?}, {rate} Hz: {moved}, {past}");
        match others {
            Others::Push => assert!(moved > 3.0 && past < 0.0, "{told}"),
            Others::Block => assert!(moved.abs() < 0.01 && past < 0.0, "{told}"),
            Others::Pass => assert!(moved.abs() < 0.01 && past > 3.0, "{told}"),
        }
    }
}
