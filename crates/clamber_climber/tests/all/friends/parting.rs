//! Climbers that overlap part to both sides, slowly, and walls win.

use clamber_climber::ContactRule;
use glam::DVec3;

use crate::cases::{pairs, triples};
use crate::friends::crowd::{Crowd, RATES, SIZES, walker};
use crate::input::{IDLE, walk};

/// Maximum speed at which climbers part, radii a second.
const PARTS: f64 = 5.0;

fn twins(height: f64, apart: DVec3, size: f64, rate: f64) -> Crowd {
    let mut config = walker(size);
    config.body.height = height * size;
    let place = DVec3::new(0.0, 0.4, 0.0) * size;
    Crowd::new(config, &[place, place + apart * size], rate)
}

#[test]
fn two_at_one_place_part_to_both_sides_by_half() {
    for (size, rate, height) in triples(SIZES, RATES, [0.0, 1.0]) {
        for (apart, order) in pairs([0.0, 1e-9, 1e-3, 0.1, 0.5], [[0, 1], [1, 0]]) {
            let apart = DVec3::new(apart, 0.0, 0.3 * apart);
            let mut crowd = twins(height, apart, size, rate);
            crowd.order = order.to_vec();
            let told =
                format!("size {size}, {rate} Hz, height {height}, apart {apart}, order {order:?}");
            let middle = (crowd.position(0) + crowd.position(1)) * 0.5;
            for _ in 0..(1.5 * rate) as u32 {
                let before = [crowd.position(0), crowd.position(1)];
                crowd.step(DVec3::ZERO, |_| IDLE);
                for (index, before) in before.into_iter().enumerate() {
                    let way = crowd.position(index) - before;
                    // The body falls onto the ground by a margin.
                    let most = (PARTS * 0.4 * size / rate).max(0.02 * size);
                    assert!(way.length() < most * 1.001, "{told}: {way}");
                    let state = crowd.state(index);
                    assert!(!state.crushed, "{told}: {state:?}");
                }
            }
            let [a, b] = [crowd.position(0), crowd.position(1)];
            let gap = a.distance(b) / size;
            assert!((0.78..0.85).contains(&gap), "{told}: {gap} apart");
            let off = ((a + b) * 0.5 - middle) / size;
            assert!(off.length() < 0.01, "{told}: both went {off}");
        }
    }
}

#[test]
fn the_lighter_one_gives_way_more() {
    for (rate, (light, share)) in pairs(RATES, [(80.0, 0.5), (20.0, 0.8), (1.0, 80.0 / 81.0)]) {
        let mut crowd = twins(0.0, DVec3::new(0.2, 0.0, 0.0), 1.0, rate);
        let mut config = walker(1.0);
        config.body.mass = light;
        crowd.climbers[1].set_config(config).unwrap();
        let before = [crowd.position(0), crowd.position(1)];
        crowd.rest(1.5);
        let ways = [0, 1].map(|index| crowd.position(index).distance(before[index]));
        let made = ways[1] / (ways[0] + ways[1]);
        assert!((made - share).abs() < 0.03, "{rate} Hz, {light} kg: {made}");
    }
}

#[test]
fn walls_stop_those_who_part() {
    // A room of 6 m, or one that is too narrow for both.
    for ((inside, fits), rate, height) in triples([(3.0, true), (0.6, false)], RATES, [0.0, 1.0]) {
        let mut crowd = twins(height, DVec3::ZERO, 1.0, rate);
        for (axis, side) in pairs([DVec3::X, DVec3::Z], [-1.0, 1.0]) {
            let half = DVec3::new(4.0, 4.0, 4.0) - axis * 3.5;
            crowd.add_box(axis * (side * (inside + 0.5)), half);
        }
        for tick in 0..(3.0 * rate) as u32 {
            crowd.step(DVec3::ZERO, |_| IDLE);
            for index in 0..2 {
                let p = crowd.position(index);
                let told = format!("{inside} m, {rate} Hz, tick {tick}: {p}");
                assert!(p.x.abs().max(p.z.abs()) < inside - 0.38, "{told}");
                assert!(p.y > 0.38 && p.y < 1.3, "{told}");
                assert!(!crowd.state(index).crushed, "{told}");
            }
        }
        let gap = crowd.position(0).distance(crowd.position(1));
        assert!(!fits || gap > 0.78, "{rate} Hz: {gap}");
    }
}

#[test]
fn walkers_who_meet_stop() {
    for (rate, speed) in pairs(RATES, [0.3, 1.0]) {
        let mut crowd = twins(0.0, DVec3::new(3.0, 0.0, 0.0), 1.0, rate);
        let mut deepest = 0.0f64;
        for _ in 0..(4.0 * rate) as u32 {
            crowd.step(DVec3::ZERO, |index| walk(DVec3::X * [speed, -speed][index]));
            let gap = crowd.position(0).distance(crowd.position(1));
            deepest = deepest.max(0.8 - gap);
        }
        let [a, b] = [crowd.position(0), crowd.position(1)];
        let told = format!("{rate} Hz, speed {speed}: {a}, {b}, deepest {deepest}");
        assert!(
            (a + b - DVec3::new(3.0, 0.8, 0.0)).length() < 0.02,
            "{told}"
        );
        assert!((a.distance(b) - 0.8).abs() < 0.02, "{told}");
        // Each may make a whole step towards the other before the overlap shows.
        let step = crowd.climbers[0].config().ground.walk_speed * speed / rate;
        assert!(deepest < 2.0 * step + 0.01, "{told}");
    }
}

#[test]
fn who_follows_keeps_pace() {
    for rate in RATES {
        let mut crowd = twins(0.0, DVec3::new(0.9, 0.0, 0.0), 1.0, rate);
        crowd.boxes.clear();
        crowd.add_box(DVec3::NEG_Y, DVec3::new(60.0, 1.0, 4.0));
        let speed = crowd.climbers[0].config().ground.walk_speed;
        for tick in 0..(4.0 * rate) as u32 {
            let before = [crowd.position(0), crowd.position(1)];
            crowd.step(DVec3::ZERO, |_| walk(DVec3::X));
            if tick > rate as u32 {
                for (index, before) in before.into_iter().enumerate() {
                    let made = (crowd.position(index).x - before.x) * rate;
                    let told = format!("{rate} Hz, tick {tick}, climber {index}: {made} m/s");
                    assert!((made - speed).abs() < 0.02 * speed, "{told}");
                }
            }
        }
    }
}

#[test]
fn two_at_one_place_that_know_no_ids_do_not_drift() {
    for (rate, height) in pairs(RATES, [0.0, 1.0]) {
        let mut crowd = twins(height, DVec3::ZERO, 1.0, rate);
        crowd.know_ids = false;
        let place = crowd.position(0);
        crowd.rest(2.0);
        for index in 0..2 {
            let off = crowd.position(index).distance(place);
            assert!(off < 0.02, "{rate} Hz, height {height}, {index}: {off}");
        }
        // As soon as one of them moves, they part.
        for _ in 0..(rate * 0.05) as u32 {
            crowd.step_first(walk(DVec3::X));
        }
        crowd.rest(1.5);
        let gap = crowd.position(0).distance(crowd.position(1));
        assert!(gap > 0.78, "{rate} Hz, height {height}: {gap} apart");
    }
}

/// A rule sees the actual contact with another climber, not the contact that there would be if the ground had not
/// moved.
#[test]
fn a_rule_for_friends_sees_the_same_contact_in_every_frame() {
    for rate in RATES {
        let apart = |speed: f64| {
            let places = [-0.2, 0.2].map(|x| DVec3::new(x, 0.4, 0.0));
            let mut crowd = Crowd::new(walker(1.0), &places, rate);
            crowd.rule = Some(|query| {
                if query.is_character() && query.contact.normal.z.abs() > 0.5 {
                    ContactRule::PASS
                } else {
                    query.usual()
                }
            });
            for index in 0..2 {
                crowd.throw(index, DVec3::Z * speed, DVec3::Z * speed);
            }
            for tick in 1..=rate as u32 {
                crowd.step(DVec3::Z * speed * (f64::from(tick) / rate), |_| IDLE);
            }
            crowd.position(0).distance(crowd.position(1))
        };
        let rest = apart(0.0);
        assert!((0.78..0.81).contains(&rest), "{rate} Hz: {rest}");
        for speed in [30.0, 300.0] {
            let moving = apart(speed);
            assert!(
                (moving - rest).abs() < 1e-3,
                "{rate} Hz, {speed} m/s: {moving} {rest}"
            );
        }
    }
}
