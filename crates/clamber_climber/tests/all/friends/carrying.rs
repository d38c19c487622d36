//! Climbers with others on their heads. The others do not hold them down.

use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberMode, ClimberObstacle, Others};
use clamber_world::HalfSpace;
use glam::DVec3;

use crate::cases::{pairs, triples};
use crate::friends::crowd::{Crowd, RATES};
use crate::input::{IDLE, JUMP, walk};
use crate::scene::list;

/// A climber of some height with another one on its head, of another size and mass.
fn tower(height: f64, (size, mass): (f64, f64), others: Others, rate: f64) -> Crowd {
    let mut below = ClimberConfig::walker();
    (below.body.height, below.body.others) = (height, others);
    let mut above = below.scaled(size);
    above.body.mass = mass;
    let top = 0.8 + height + 0.4 * size;
    let mut crowd = Crowd::new(below, &[DVec3::Y * 0.4, DVec3::Y * top], rate);
    crowd.climbers[1] = Climber::new(above, DVec3::Y * top).unwrap();
    crowd.rest(0.5);
    crowd
}

/// Height of the upper climber above the lower one's highest point, metres.
fn gap(crowd: &Crowd) -> f64 {
    let [below, above] = [0, 1].map(|index| crowd.climbers[index].body());
    let top = below.ends[0].y.max(below.ends[1].y) + below.radius;
    above.ends[0].y - above.radius - top
}

/// Sizes and masses of the climbers on the head of a climber of 80 kg.
const LIGHT: [(f64, f64); 4] = [(0.1, 0.02), (0.5, 10.0), (1.0, 1.0), (1.0, 80.0)];

/// All ways in which climbers behave towards others.
const KINDS: [Others; 3] = [Others::Block, Others::Push, Others::Pass];

#[test]
fn a_climber_jumps_with_a_friend_that_is_no_heavier_on_its_head() {
    for (rate, others, rider) in triples(RATES, KINDS, LIGHT) {
        let mut crowd = tower(0.0, rider, others, rate);
        let mut top = 0.0f64;
        for tick in 0..(1.5 * rate) as u32 {
            crowd.step_first(if tick == 0 { JUMP } else { IDLE });
            top = top.max(crowd.position(0).y - 0.4);
        }
        let told = format!("{rate} Hz, {others}, {rider:?}: {top}");
        assert!((1.15..1.3).contains(&top), "{told}");
        for index in [0, 1] {
            assert_eq!(crowd.state(index).mode, ClimberMode::Standing, "{told}");
        }
        assert!(gap(&crowd).abs() < 0.05, "{told}: {}", gap(&crowd));
    }
}

/// A heavier climber is a ceiling.
#[test]
fn a_heavier_friend_on_the_head_holds_a_climber_down() {
    for rate in RATES {
        let mut crowd = tower(0.0, (1.0, 200.0), Others::Block, rate);
        for tick in 0..rate as u32 {
            crowd.step_first(if tick == 0 { JUMP } else { IDLE });
            let rises = crowd.position(0).y - 0.4;
            assert!(rises < 0.02, "{rate} Hz: {rises}");
        }
    }
}

#[test]
fn a_friend_on_the_head_goes_along_when_the_lower_one_crouches_and_stands_up() {
    for (rate, others, rider) in triples(RATES, KINDS, LIGHT) {
        let mut crowd = tower(1.0, rider, others, rate);
        for crouch in [true, false, true, false] {
            for _ in 0..(0.5 * rate) as u32 {
                crowd.step_first(ClimberInput { crouch, ..IDLE });
            }
            let told = format!("{rate} Hz, {others}, {rider:?}, crouch {crouch}");
            assert_eq!(crowd.state(0).crouched, crouch, "{told}");
            assert_eq!(crowd.state(1).mode, ClimberMode::Standing, "{told}");
            assert!(gap(&crowd).abs() < 0.05, "{told}: {}", gap(&crowd));
        }
    }
}

#[test]
fn a_friend_on_the_head_goes_along_when_the_lower_one_shrinks() {
    for (rate, (height, share)) in pairs(RATES, [(0.0, 0.5), (1.0, 0.5), (1.0, 0.9)]) {
        let mut crowd = tower(height, (1.0, 1.0), Others::Block, rate);
        let config = crowd.climbers[0].config().scaled(share);
        crowd.climbers[0].try_resize(config, &[]).unwrap();
        crowd.rest(1.0);
        let told = format!("{rate} Hz, {height} m to {share}");
        assert_eq!(crowd.state(1).mode, ClimberMode::Standing, "{told}");
        assert!(gap(&crowd).abs() < 0.05, "{told}: {}", gap(&crowd));
    }
}

#[test]
fn a_climber_walks_up_stairs_with_a_friend_that_is_no_heavier_on_its_head() {
    for (rate, rider) in pairs(RATES, LIGHT) {
        let mut crowd = tower(0.0, rider, Others::Block, rate);
        for step in 0..8 {
            let (x, y) = (0.8 + 0.5 * f64::from(step), 0.2 * f64::from(step + 1));
            crowd.add_box(DVec3::new(x + 2.0, y - 1.0, 0.0), DVec3::new(2.0, 1.0, 3.0));
        }
        for _ in 0..(2.0 * rate) as u32 {
            crowd.step_first(walk(DVec3::X * 0.4));
        }
        let rises = crowd.position(0).y - 0.4;
        assert!(rises > 0.9, "{rate} Hz, {rider:?}: {rises}");
    }
}

/// Friends that pass do not take room from each other, nor do friends that overlap already take room from one that
/// grows.
#[test]
fn friends_that_pass_or_overlap_leave_room_to_grow() {
    for size in [0.05, 1.0, 20.0] {
        for (others, apart) in [
            (Others::Pass, 0.1),
            (Others::Pass, 0.3),
            (Others::Pass, 0.7),
            (Others::Push, 0.7),
        ] {
            let mut config = ClimberConfig::walker();
            config.body.others = others;
            let config = config.scaled(size);
            let places = [0.0, apart].map(|x| DVec3::new(x, 0.4, 0.0) * size);
            let [mut grows, other] = places.map(|place| Climber::new(config, place).unwrap());
            let other = ClimberObstacle::new(&other, &[], 1.0 / 60.0);
            let floor = HalfSpace::below(0.0);
            let grown = grows.try_resize(config.scaled(1.2), &list(&[&floor, &other]));
            assert!(grown.is_ok(), "{size}, {others}, {apart}: {grown:?}");
        }
    }
}
