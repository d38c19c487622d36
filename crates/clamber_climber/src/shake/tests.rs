use super::*;
use core::f64::consts::TAU;

/// Time constant of the filter, seconds.
const TIME_CONSTANT: f64 = 0.1;

/// Time until the integral of the excess above the threshold reaches the budget, seconds, and the largest filtered
/// acceleration until then.
fn held(velocity: impl Fn(f64) -> DVec3, threshold: f64, budget: f64, hz: f64) -> (f64, f64) {
    let (mut shake, mut spent, mut peak) = (Shake::default(), 0.0, 0.0_f64);
    for tick in 0..(60.0 * hz) as usize {
        let at = |tick: usize| velocity(tick as f64 / hz);
        let before = shake;
        shake.step(at(tick + 1) - at(tick), TIME_CONSTANT, 1.0 / hz);
        let more = shake.excess(&before, threshold, 1.0 / hz);
        peak = peak.max(shake.acceleration.length());
        if spent + more >= budget {
            return ((tick as f64 + (budget - spent) / more) / hz, peak);
        }
        spent += more;
    }
    (f64::INFINITY, peak)
}

/// Velocity of a point that swings by 0.25 m to either side, three times a second.
fn sway(t: f64) -> DVec3 {
    DVec3::X * (0.25 * 3.0 * TAU * libm::cos(3.0 * TAU * t))
}

#[test]
fn a_shake_uses_up_a_budget_in_the_same_time_at_any_tick_rate() {
    let at = |hz: f64| held(sway, 30.0, 20.0, hz);
    let (exact, peak) = at(240.0);
    assert!(
        exact.is_finite() && (exact - 5.0).abs() < 1.0,
        "{exact}, peak {peak}"
    );
    for hz in [30.0, 60.0, 120.0, 240.0] {
        let (time, peak) = at(hz);
        // At 30 Hz ten ticks per swing, otherwise more.
        let share = if hz < 60.0 { 0.05 } else { 0.03 };
        assert!(
            (time / exact - 1.0).abs() < share,
            "{hz} Hz: {time} s, not {exact}, peak {peak}"
        );
    }
}

#[test]
fn a_jolt_is_judged_by_its_velocity_change_alone() {
    let threshold = 20.0;
    for hz in [15.0, 30.0, 60.0, 120.0, 240.0, 1000.0] {
        let jolt = |share: f64| {
            // The filter's response decays within the tick already; its limit for short ticks is V / tau.
            let forgets = -libm::expm1(-1.0 / (hz * TIME_CONSTANT)) * hz * TIME_CONSTANT;
            let change = DVec3::Y * threshold * TIME_CONSTANT * share / forgets;
            held(
                |t| if t > 0.0 { change } else { DVec3::ZERO },
                threshold,
                1e-9,
                hz,
            )
            .0
        };
        assert_eq!(jolt(0.98), f64::INFINITY, "{hz} Hz");
        assert!(jolt(1.02) < 1.01 / hz, "{hz} Hz: {}", jolt(1.02));
    }
    // At 240 Hz and more, this decay is within 2 %.
    for (share, expected) in [(0.96, false), (1.04, true)] {
        let change = DVec3::Y * threshold * TIME_CONSTANT * share;
        let step = |t| if t > 0.0 { change } else { DVec3::ZERO };
        assert_eq!(
            held(step, threshold, 1e-9, 240.0).0.is_finite(),
            expected,
            "{share}"
        );
    }
}

#[test]
fn uniform_motion_does_not_shake_and_rotation_shakes_centripetally() {
    assert_eq!(
        held(|_| DVec3::X * 300.0, 0.0, 1e-12, 60.0).0,
        f64::INFINITY
    );
    // A radius of 2 m at 2 rad/s gives 8 m/s^2. The filter passes a share of 1 / sqrt(1 + (2 * 0.1)^2).
    let turn = |t: f64| DVec3::new(-libm::sin(2.0 * t), 0.0, libm::cos(2.0 * t)) * 4.0;
    for hz in [30.0, 60.0, 240.0] {
        let (_, peak) = held(turn, 100.0, 1.0, hz);
        let expected = 8.0 / 1.04_f64.sqrt();
        assert!(
            (peak / expected - 1.0).abs() < 2e-3,
            "{hz} Hz: {peak}, not {expected}"
        );
    }
}

#[test]
fn noise_of_a_millimetre_stays_small() {
    let mut rng = fastrand::Rng::with_seed(7);
    for hz in [60.0, 120.0] {
        let mut shake = Shake::default();
        let mut positions = [DVec3::ZERO; 3];
        let mut peak = 0.0_f64;
        for _ in 0..60_000 {
            let side = |on: bool| if on { 1e-3 } else { 0.0 };
            let next = DVec3::new(side(rng.bool()), side(rng.bool()), side(rng.bool()));
            positions = [positions[1], positions[2], next];
            let change = (positions[2] - positions[1] * 2.0 + positions[0]) * hz;
            shake.step(change, TIME_CONSTANT, 1.0 / hz);
            peak = peak.max(shake.acceleration.length());
        }
        // Below half of gravity at 60 Hz, where no threshold lies.
        assert!(peak < 4.0 * hz / 60.0, "{hz} Hz: {peak}");
    }
}

#[test]
fn half_the_frequency_gives_a_quarter_of_the_unfiltered_shake() {
    let slow = |t: f64| sway(0.5 * t) * 0.5;
    let filtered = |w: f64| 0.25 * w * w / libm::sqrt(1.0 + w * w * TIME_CONSTANT * TIME_CONSTANT);
    for (velocity, w) in [
        (&sway as &dyn Fn(f64) -> DVec3, 3.0 * TAU),
        (&slow, 1.5 * TAU),
    ] {
        let steady = filtered(w);
        let (mut shake, mut peak) = (Shake::default(), 0.0_f64);
        for tick in 0..960 {
            let at = |tick: i32| velocity(f64::from(tick) / 240.0);
            shake.step(at(tick + 1) - at(tick), TIME_CONSTANT, 1.0 / 240.0);
            if tick > 480 {
                peak = peak.max(shake.acceleration.length());
            }
        }
        assert!((peak / steady - 1.0).abs() < 5e-3, "{peak}, not {steady}");
    }
}

#[test]
fn the_excess_is_the_mean_over_both_ends_of_the_tick() {
    let [low, high] = [5.0, 9.0].map(|size| Shake {
        acceleration: DVec3::new(0.0, 0.6, -0.8) * size,
    });
    let cases = [
        (4.0, 0.5 * 3.0),
        (7.0, 0.5 * 1.0),
        (9.0, 0.0),
        (-1.0, 0.5 * 7.0),
    ];
    for (threshold, expected) in cases {
        for found in [
            high.excess(&low, threshold, 0.5),
            low.excess(&high, threshold, 0.5),
        ] {
            assert!(
                (found - expected).abs() < 1e-15,
                "{threshold}: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn invalid_arguments_change_nothing() {
    let mut shake = Shake {
        acceleration: DVec3::X,
    };
    let before = shake;
    for (change, dt) in [
        (DVec3::NAN, 0.1),
        (DVec3::X, 0.0),
        (DVec3::X, -1.0),
        (DVec3::X, f64::NAN),
    ] {
        shake.step(change, TIME_CONSTANT, dt);
        assert_eq!(shake, before, "{change} {dt}");
    }
    shake.step(DVec3::X, 0.0, 0.5);
    assert_eq!(shake.acceleration, DVec3::X * 2.0);
    assert_eq!(shake.excess(&before, f64::NAN, 0.1), 0.0);
    assert_eq!(shake.excess(&before, 0.0, f64::NAN), 0.0);
}
