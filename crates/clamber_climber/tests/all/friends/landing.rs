//! Climbers that come down on each other, in frames that move and in the air.

use clamber_climber::{Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode};
use clamber_world::ObstacleId;
use glam::DVec3;

use crate::cases::pairs;
use crate::events::{is_crushed, is_tumbled};
use crate::friends::crowd::{Crowd, RATES};
use crate::input::IDLE;

#[test]
fn two_that_fall_together_meet_at_the_speed_between_them() {
    for (rate, speed) in pairs(RATES, [0.0, 20.0, 30.0, 55.0]) {
        let places = [DVec3::new(0.0, 500.0, 0.0), DVec3::new(0.05, 501.0, 0.0)];
        let mut crowd = Crowd::new(ClimberConfig::colossus_climber(), &places, rate);
        crowd.throw(0, DVec3::NEG_Y * speed, DVec3::ZERO);
        crowd.throw(1, DVec3::NEG_Y * (speed + 0.5), DVec3::ZERO);
        for _ in 0..(2.0 * rate) as u32 {
            let reports = crowd.step(DVec3::ZERO, |_| IDLE);
            for event in reports.iter().flat_map(|report| &report.events) {
                let told = format!("{rate} Hz, {speed} m/s: {event:?}");
                assert!(!is_crushed(event), "{told}");
                if let ClimberEvent::Landed { speed, .. } = event {
                    assert!(*speed < 1.0, "{told}");
                }
                assert!(!is_tumbled(event), "{told}");
            }
        }
        for index in 0..2 {
            let state = crowd.state(index);
            assert_eq!(state.hit_points, 1.0, "{rate} Hz, {speed} m/s: {state:?}");
        }
        let apart = crowd.position(0).distance(crowd.position(1));
        let told = format!("{rate} Hz, {speed} m/s: {apart}");
        assert!((0.77..1.4).contains(&apart), "{told}");
    }
}

#[test]
fn who_flies_behind_another_keeps_its_speed_in_any_frame() {
    for (rate, speed) in pairs(RATES, [0.0, 20.0, 300.0]) {
        let places = [DVec3::new(1.0, 500.0, 0.0), DVec3::new(0.0, 500.0, 0.0)];
        let mut crowd = Crowd::new(ClimberConfig::walker(), &places, rate);
        let base = DVec3::X * speed;
        crowd.throw(0, base, base);
        crowd.throw(1, base + DVec3::X, base);
        crowd.rest(0.6);
        let own = crowd.state(1).velocity.x - speed;
        assert!(own.abs() < 1e-9, "{rate} Hz, {speed} m/s: {own}");
        let gap = crowd.position(0).x - crowd.position(1).x;
        assert!((0.78..0.85).contains(&gap), "{rate} Hz, {speed} m/s: {gap}");
    }
}

#[test]
fn a_drop_onto_a_head_on_a_platform_is_one_at_rest() {
    for (rate, speed) in pairs(RATES, [0.0, 5.0, 12.0, 30.0]) {
        let places = [DVec3::new(0.0, 0.4, 0.0), DVec3::new(0.1, 1.5, 0.0)];
        let mut crowd = Crowd::new(ClimberConfig::colossus_climber(), &places, rate);
        crowd.climbers[0].step(&IDLE, &[], 1e-6).unwrap();
        crowd.throw(0, DVec3::X * speed, DVec3::X * speed);
        crowd.throw(1, DVec3::X * speed, DVec3::X * speed);
        let mut landed = None;
        for tick in 1..=(2.0 * rate) as u32 {
            let deck = DVec3::X * (speed * f64::from(tick) / rate);
            let reports = crowd.step(deck, |_| IDLE);
            for event in &reports[1].events {
                let told = format!("{rate} Hz, {speed} m/s, tick {tick}: {event:?}");
                match event {
                    ClimberEvent::Landed { speed, .. } => landed = Some(*speed),
                    ClimberEvent::Tumbled { .. } | ClimberEvent::SkippedTicks { .. } => {
                        panic!("{told}")
                    }
                    _ => {}
                }
            }
            assert!(!reports[0].events.iter().any(is_crushed));
        }
        let told = format!("{rate} Hz, {speed} m/s: landed at {landed:?}");
        assert!(
            landed.is_some_and(|fall| (2.0..2.9).contains(&fall)),
            "{told}"
        );
        let state = crowd.state(1);
        assert_eq!(state.mode, ClimberMode::Standing, "{told}: {state:?}");
        let own = (state.velocity - DVec3::X * speed).length();
        assert!(own < 1e-6, "{told}: {own}");
    }
}

#[test]
fn nobody_is_crushed_or_loses_its_footing_by_who_lands_on_its_head() {
    for (rate, fall) in pairs(RATES, [1.0, 5.0, 10.0, 40.0]) {
        for (aside, phase) in pairs([0.0, 0.1, 0.3, 0.6], 0..5) {
            let height = 1.2 + fall + 0.013 * f64::from(phase);
            let places = [DVec3::new(0.0, 0.4, 0.0), DVec3::new(aside, height, 0.0)];
            let mut crowd = Crowd::new(ClimberConfig::colossus_climber(), &places, rate);
            let told = format!("{rate} Hz, from {fall} m, {aside} m aside");
            for tick in 0..(4.0 * rate) as u32 {
                let reports = crowd.step(DVec3::ZERO, |_| IDLE);
                let mut events = reports[0].events.iter();
                assert!(!events.any(is_crushed), "{told}, tick {tick}");
                if f64::from(tick) > 0.2 * rate {
                    let state = crowd.state(0);
                    assert_eq!(state.mode, ClimberMode::Standing, "{told}, tick {tick}");
                }
            }
            let off = crowd.position(0) - DVec3::new(0.0, 0.4, 0.0);
            assert!(off.length() < 0.05, "{told}: {off}");
        }
    }
}

/// The upper climber jumps some ticks after the lower one has jumped aside.
#[test]
fn a_jump_off_a_friend_who_jumps_is_a_jump() {
    for (rate, lag) in pairs(RATES, 0..4) {
        let aside = 0.3;
        let height = 0.4 + f64::sqrt(0.64 - aside * aside);
        let places = [DVec3::new(0.0, 0.4, 0.0), DVec3::new(aside, height, 0.0)];
        let mut crowd = Crowd::new(ClimberConfig::colossus_climber(), &places, rate);
        crowd.rest(0.3);
        let from = crowd.position(1).y;
        let mut top = 0.0f64;
        for tick in 0..(1.5 * rate) as u32 {
            crowd.step(DVec3::ZERO, |index| ClimberInput {
                jump: tick == if index == 0 { 5 } else { 5 + lag },
                walk: DVec3::NEG_X * f64::from(index == 0 && tick >= 5),
                ..IDLE
            });
            top = top.max(crowd.position(1).y - from);
        }
        // For these ticks, the friend lifts the climber.
        let lifted = 5.0 * f64::from(lag) / rate;
        assert!(
            (1.1..1.45 + lifted).contains(&top),
            "{rate} Hz, {lag} ticks later: {top}"
        );
    }
}

/// A friend that comes up from below takes along a climber that rises more slowly, and hardly overlaps it.
#[test]
fn who_comes_up_fast_below_another_one_takes_it_along() {
    let frames = [DVec3::ZERO, DVec3::new(30.0, 0.0, -10.0), DVec3::Y * 10.0];
    for rate in RATES {
        for (aside, rises) in pairs([0.0, 0.2, 0.4], [-2.0, 0.0, 1.0, 3.0, 4.0]) {
            for (comes, frame) in pairs([5.0, 8.0, 12.0], frames) {
                let places = [DVec3::new(0.0, 50.0, 0.0), DVec3::new(aside, 51.2, 0.0)];
                let mut crowd = Crowd::new(ClimberConfig::walker(), &places, rate);
                crowd.throw(0, DVec3::Y * comes + frame, frame);
                crowd.throw(1, DVec3::Y * rises + frame, frame);
                let mut deepest = 0.0f64;
                for _ in 0..rate as u32 {
                    crowd.step(DVec3::ZERO, |_| IDLE);
                    deepest = deepest.max(0.8 - crowd.position(0).distance(crowd.position(1)));
                }
                let told = format!(
                    "{rate} Hz, frame {frame}, {aside} m aside, {comes} to {rises} m/s: {deepest}"
                );
                // The upper climber sees the lower one's place a tick ago.
                assert!(deepest < 0.05 + 1.5 * comes / rate, "{told}");
            }
        }
    }
}

/// A friend, lifted by another one's jump, is pressed from below into a climber that stands on a shelf and jumps.
#[test]
fn a_jump_is_not_over_where_a_friend_comes_up_from_below() {
    for rate in RATES {
        let mut pressed = 0;
        for (aside, lag) in pairs([0.1, 0.3, 0.5, 0.65], 0..(0.3 * rate) as u32) {
            let place = |height: f64| DVec3::new(-aside, height, 0.0);
            let above = DVec3::new(0.0, 2.0, 0.0);
            let mut crowd = Crowd::new(
                ClimberConfig::walker(),
                &[place(0.4), place(1.2), above],
                rate,
            );
            // The climber stands on the edge of a shelf.
            crowd.add_box(DVec3::new(0.5, 1.55, 0.0), DVec3::new(0.5, 0.05, 1.0));
            crowd.rest(0.2);
            let told = format!("{rate} Hz, {aside} m aside, {lag} ticks later");
            let standing = crowd.state(2).mode == ClimberMode::Standing;
            assert!(standing, "{told}: {:?}", crowd.state(2));
            let (from, mut top) = (crowd.position(2).y, 0.0_f64);
            for tick in 0..(1.2 * rate) as u32 {
                let reports = crowd.step(DVec3::ZERO, |index| ClimberInput {
                    jump: index == 0 && tick == 0 || index == 2 && tick == lag,
                    ..IDLE
                });
                let has_jumped = reports[2].events.contains(&ClimberEvent::Jumped);
                assert_eq!(has_jumped, tick == lag, "{told}, tick {tick}");
                let mut contacts = crowd.climbers[2].contacts().iter();
                pressed += u32::from(
                    has_jumped && contacts.any(|contact| contact.obstacle == ObstacleId(101)),
                );
                top = top.max(crowd.position(2).y - from);
            }
            assert!((1.2..1.4).contains(&top), "{told}: {top}");
        }
        assert!(pressed > 3, "{rate} Hz: {pressed}");
    }
}

#[test]
fn who_stands_on_a_friend_that_is_gone_or_put_elsewhere_falls_or_goes_along() {
    for rate in RATES {
        let places = [DVec3::new(0.0, 0.4, 0.0), DVec3::new(0.0, 1.2, 0.0)];
        let mut crowd = Crowd::new(ClimberConfig::walker(), &places, rate);
        crowd.rest(0.3);
        assert_eq!(crowd.state(1).mode, ClimberMode::Standing, "{rate} Hz");
        // The climber is put elsewhere, as by a game's teleport.
        let there = DVec3::new(3.0, 0.4, 0.0);
        crowd.climbers[0] = Climber::new(ClimberConfig::walker(), there).unwrap();
        crowd.rest(0.5);
        for index in 0..2 {
            let state = crowd.state(index);
            assert_eq!(state.mode, ClimberMode::Standing, "{rate} Hz: {state:?}");
        }
        // The climber is gone from the list.
        let upper = crowd.climbers.remove(1);
        let mut alone = Crowd::new(ClimberConfig::walker(), &[DVec3::ZERO], rate);
        alone.climbers[0] = upper;
        alone.rest(1.0);
        let state = alone.state(0);
        assert_eq!(state.mode, ClimberMode::Standing, "{rate} Hz: {state:?}");
        assert!(
            (state.position.y - 0.4).abs() < 0.02,
            "{rate} Hz: {state:?}"
        );
    }
}
