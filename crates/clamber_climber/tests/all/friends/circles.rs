//! Climbers that hold each other in a circle.

use clamber_climber::{ContactQuery, ContactRule};
use glam::DVec3;

use crate::cases::triples;
use crate::events::is_moved_twice;
use crate::friends::crowd::{Crowd, RATES, SIZES};
use crate::input::HOLD;
use crate::numbers::in_world_of_size;
use crate::stage::tireless;

fn holds_friends(query: &ContactQuery<'_>) -> ContactRule {
    if query.is_character() {
        query.usual().with_grip(true)
    } else {
        query.usual()
    }
}

/// The climbers fall as fast as any body, in either order, and lie on the ground in the end.
#[test]
fn climbers_that_hold_each_other_fall_together() {
    let third = |index: f64| {
        let angle = index * std::f64::consts::TAU / 3.0;
        DVec3::new(libm::cos(angle), 0.0, libm::sin(angle)) * 0.55
    };
    let circles = [
        vec![DVec3::X * 0.45, DVec3::X * -0.45],
        vec![DVec3::X * 0.5, DVec3::X * -0.5],
        vec![third(0.0), third(1.0), third(2.0)],
    ];
    for (size, rate, (index, places)) in triples(SIZES, RATES, circles.iter().enumerate()) {
        let config = tireless();
        let high = DVec3::Y * 20.0;
        let places: Vec<_> = places.iter().map(|at| (*at + high) * size).collect();
        let mut crowd = Crowd::new(in_world_of_size(config, size), &places, rate);
        crowd.rule = Some(holds_friends);
        if index == 1 {
            crowd.order.reverse();
        }
        let told = format!("size {size}, {rate} Hz, circle {index}");
        for tick in 1..=(4.0 * rate) as u32 {
            let reports = crowd.step(DVec3::ZERO, |_| HOLD);
            let time = f64::from(tick) / rate;
            let fell = 20.0 - 0.5 * 9.81 * time * time;
            for (who, report) in reports.iter().enumerate() {
                let state = crowd.state(who);
                let at = state.position.y / size;
                let told = format!("{told}, {who} at {time} s: {at} m, {state:?}");
                assert!(at > 0.35, "{told}");
                let aside = DVec3::new(state.position.x, 0.0, state.position.z).length();
                assert!(aside < 2.0 * size, "{told}: {aside} m aside");
                let jumped = report.events.iter().any(is_moved_twice);
                assert!(fell < 3.0 || !jumped, "{told}");
                // Hands draw the climbers together, or legs swing, by up to an arm's length.
                assert!(
                    fell < 3.0 || (at - fell).abs() < 1.5,
                    "{told}: not at {fell}"
                );
                assert!(fell > -20.0 || at < 3.0, "{told}");
            }
        }
        let mut climbers = crowd.climbers.iter();
        let holds = climbers.any(|climber| climber.state().support.is_some());
        assert!(holds, "{told}");
    }
}
