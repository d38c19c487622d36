//! Climbers on a deck that shakes, side by side and on each other's heads.

use clamber_climber::ClimberMode;
use glam::DVec3;

use crate::cases::triples;
use crate::events::{count, is_crushed, is_moved_twice};
use crate::friends::crowd::{Crowd, RATES, SIZES, walker};
use crate::input::IDLE;

/// The deck's displacement at a time: 0.2 m to either side, twice a second.
fn shakes(time: f64, axis: DVec3) -> DVec3 {
    axis * (0.2 * libm::sin(std::f64::consts::TAU * 2.0 * time))
}

/// Rides for 10 s on the places where the climbers have come to rest. Checks the largest distance of each climber from
/// its place on the deck.
fn ride(places: &[DVec3], axis: DVec3, size: f64, rate: f64, reverse: bool) {
    let mut config = walker(size);
    config.ground.throw_acceleration = f64::INFINITY;
    let places: Vec<DVec3> = places.iter().map(|place| *place * size).collect();
    let mut crowd = Crowd::new(config, &places, rate);
    if reverse {
        crowd.order.reverse();
    }
    crowd.rest(1.0);
    let rest: Vec<_> = (0..places.len())
        .map(|index| crowd.position(index))
        .collect();
    for tick in 1..=(10.0 * rate) as u32 {
        let deck = shakes(f64::from(tick) / rate, axis) * size;
        let reports = crowd.step(deck, |_| IDLE);
        for (index, report) in reports.iter().enumerate() {
            let off = (crowd.position(index) - rest[index] - deck).length() / size;
            let told = format!("size {size}, {rate} Hz along {axis}, {index} at tick {tick}");
            assert!(off < 0.01, "{told}: {off} m off, {:?}", crowd.state(index));
            assert_eq!(crowd.state(index).mode, ClimberMode::Standing, "{told}");
            let jolts = count(&report.events, |event| {
                is_moved_twice(event) || is_crushed(event)
            });
            assert_eq!(jolts, 0, "{told}: {:?}", report.events);
        }
    }
}

#[test]
fn two_side_by_side_stay_on_their_points_of_a_deck_that_shakes() {
    let places = [DVec3::new(0.0, 0.4, 0.0), DVec3::new(0.8, 0.4, 0.0)];
    let axes = [DVec3::X, DVec3::Z, DVec3::new(0.6, 0.0, 0.8)];
    for (size, (index, rate), axis) in triples(SIZES, RATES.into_iter().enumerate(), axes) {
        ride(&places, axis, size, rate, index % 2 == 0);
    }
}

#[test]
fn a_stack_of_three_stays_on_a_deck_that_shakes() {
    let places = [0.4, 1.2, 2.0].map(|height| DVec3::Y * height);
    for (size, rate, reverse) in triples(SIZES, RATES, [false, true]) {
        // Up and down, the deck is never faster than the climbers fall.
        for axis in [DVec3::X, DVec3::Y * 0.25, DVec3::new(0.6, 0.2, 0.0)] {
            ride(&places, axis, size, rate, reverse);
        }
    }
}
