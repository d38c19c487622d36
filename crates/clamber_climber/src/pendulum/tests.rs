use super::*;
use core::f64::consts::{PI, TAU};
use fastrand::Rng;

/// Gravity, metres a second squared.
const G: f64 = 9.81;

/// Length of the arm, metres.
const LENGTH: f64 = 1.5;

fn tick(hz: f64) -> PendulumTick {
    PendulumTick {
        length: LENGTH,
        gravity: DVec3::new(0.0, -G, 0.0),
        pivot_change: DVec3::ZERO,
        damping: 0.0,
        dt: 1.0 / hz,
    }
}

fn at_angle(angle: f64) -> Pendulum {
    Pendulum {
        arm: DVec3::new(libm::sin(angle), -libm::cos(angle), 0.0) * LENGTH,
        velocity: DVec3::ZERO,
    }
}

fn angle(pendulum: &Pendulum) -> f64 {
    libm::atan2(pendulum.arm.x, -pendulum.arm.y)
}

fn energy(pendulum: &Pendulum) -> f64 {
    0.5 * pendulum.velocity.length_squared() + G * (pendulum.arm.y + LENGTH)
}

/// Mean period over many swings, seconds. The arm is rigid, so that it does not go slack at large angles.
fn period(degrees: f64, hz: f64) -> f64 {
    let (mut pendulum, tick) = (at_angle(degrees.to_radians()), tick(hz));
    let mut crossings = Vec::new();
    for k in 0..(60.0 * hz) as usize {
        let before = angle(&pendulum);
        pendulum.swing(&tick, tick.dt, 0.0, true);
        let after = angle(&pendulum);
        if before < 0.0 && after >= 0.0 && after - before < 1.0 {
            crossings.push((k as f64 + before / (before - after)) / hz);
        }
    }
    (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64
}

#[test]
fn the_period_matches_the_elliptic_integral() {
    for degrees in [3.0, 60.0, 120.0_f64] {
        let (mut a, mut b) = (1.0, libm::cos(0.5 * degrees.to_radians()));
        for _ in 0..6 {
            (a, b) = (0.5 * (a + b), libm::sqrt(a * b));
        }
        let exact = TAU * libm::sqrt(LENGTH / G) / a;
        for hz in [30.0, 60.0, 120.0] {
            let share = period(degrees, hz) / exact - 1.0;
            assert!(
                hz < 60.0 || share.abs() < 1e-3,
                "{degrees} degrees, {hz} Hz: {share}"
            );
        }
    }
}

#[test]
fn an_undamped_swing_conserves_energy() {
    for degrees in [3.0, 60.0, 85.0_f64] {
        let (mut pendulum, tick) = (at_angle(degrees.to_radians()), tick(60.0));
        let first = energy(&pendulum);
        let mut ripple = 0.0_f64;
        for _ in 0..3600 {
            pendulum.step(&tick);
            ripple = ripple.max((energy(&pendulum) / first - 1.0).abs());
        }
        assert!(ripple < 1e-3, "{degrees} degrees: {ripple}");
    }
}

#[test]
fn a_conical_pendulum_keeps_its_period_and_angular_momentum() {
    let slant = 0.5;
    let mut pendulum = at_angle(slant);
    let rate = libm::sqrt(G / (LENGTH * libm::cos(slant)));
    pendulum.velocity = DVec3::Z * (rate * LENGTH * libm::sin(slant));
    let tick = tick(60.0);
    let around = |p: &Pendulum| p.arm.cross(p.velocity).y;
    let first = around(&pendulum);
    let (mut turned, mut drift) = (0.0, 0.0_f64);
    for _ in 0..3600 {
        let before = pendulum.arm;
        pendulum.step(&tick);
        let now = pendulum.arm;
        turned += libm::atan2(
            before.x * now.z - before.z * now.x,
            before.x * now.x + before.z * now.z,
        );
        drift = drift.max((around(&pendulum) / first - 1.0).abs());
    }
    let share = rate * 60.0 / turned - 1.0;
    assert!(share.abs() < 1e-3, "{share}");
    assert!(drift < 1e-11, "{drift}");
}

#[test]
fn a_pivot_impulse_swings_to_the_height_of_its_energy() {
    let speed = 3.0;
    let expected = libm::acos(1.0 - speed * speed / (2.0 * G * LENGTH));
    for (hz, allowed) in [(30.0, 2e-3), (60.0, 1e-3), (120.0, 1e-3), (240.0, 1e-3)] {
        let (mut pendulum, mut tick) = (at_angle(0.0), tick(hz));
        tick.pivot_change = DVec3::X * speed;
        let mut most = 0.0_f64;
        for _ in 0..(4.0 * hz) as usize {
            pendulum.step(&tick);
            tick.pivot_change = DVec3::ZERO;
            most = most.max(angle(&pendulum).abs());
        }
        let share = most / expected - 1.0;
        assert!(share.abs() < allowed, "{hz} Hz: {share}");
    }
}

#[test]
fn an_accelerating_pivot_tilts_the_rest_position() {
    for a in [
        DVec3::X * 4.0,
        DVec3::new(-3.0, 5.0, 0.0),
        DVec3::new(2.0, -5.0, 0.0),
    ] {
        let (mut pendulum, mut tick) = (at_angle(0.3), tick(60.0));
        tick.damping = 2.0;
        tick.pivot_change = a * tick.dt;
        let mut report = PendulumReport::default();
        for _ in 0..3000 {
            report = pendulum.step(&tick);
        }
        let expected = libm::atan2(-a.x, G + a.y);
        let (found, pull) = (angle(&pendulum), (tick.gravity - a).length());
        assert!(
            (found - expected).abs() < 1e-3 && report.arm == ArmTension::Taut,
            "{a}: {found} {report:?}"
        );
        assert!(
            (report.tension / pull - 1.0).abs() < 5e-3,
            "{a}: {report:?}, not {pull}"
        );
    }
}

#[test]
fn a_freely_falling_pivot_gives_uniform_rotation() {
    let (mut pendulum, mut tick) = (at_angle(0.0), tick(60.0));
    tick.pivot_change = tick.gravity * tick.dt;
    pendulum.velocity = DVec3::X * 3.0;
    let mut turned = 0.0;
    for k in 0..600 {
        let before = angle(&pendulum);
        let report = pendulum.step(&tick);
        let step = (angle(&pendulum) - before + 3.0 * PI).rem_euclid(TAU) - PI;
        turned += step;
        assert!(
            (step * 60.0 - 2.0).abs() < 0.02,
            "tick {k}: {step} {report:?} {pendulum:?}"
        );
    }
    assert!((turned / 20.0 - 1.0).abs() < 2e-3, "{turned}");
}

#[test]
fn catching_a_slack_arm_adds_no_energy() {
    let mut rng = Rng::with_seed(1);
    let mut vector = move || DVec3::new(rng.f64(), rng.f64(), rng.f64()) * 2.0 - 1.0;
    let mut catches = 0;
    for scene in 0..400 {
        let mut pendulum = Pendulum {
            arm: vector() * LENGTH / 1.8,
            velocity: vector() * 8.0,
        };
        let tick = tick([30.0, 60.0, 144.0][scene % 3]);
        let mut least = energy(&pendulum);
        for k in 0..600 {
            let before = pendulum;
            let report = pendulum.step(&tick);
            let now = energy(&pendulum);
            let ripple = 2e-3 * (least + G * LENGTH);
            assert!(
                now < least + ripple,
                "scene {scene} tick {k}: {before:?} {pendulum:?} {report:?}"
            );
            if report.caught > 0.0 {
                catches += 1;
                let lost = energy(&before) - now;
                let speed = report.caught;
                assert!(
                    (lost - 0.5 * speed * speed).abs() < ripple + 0.5 * lost,
                    "{lost} {report:?}"
                );
            }
            least = least.min(now);
            let length = pendulum.arm.length();
            assert!(
                length <= LENGTH * (1.0 + 1e-9),
                "scene {scene} tick {k}: {length}"
            );
        }
    }
    assert!(catches > 400, "{catches}");
}

#[test]
fn a_pivot_jerked_down_makes_the_arm_slack_then_taut() {
    let (mut pendulum, mut tick) = (at_angle(0.0), tick(60.0));
    tick.pivot_change = DVec3::Y * -3.0;
    let first = pendulum.step(&tick);
    assert_eq!(first.arm, ArmTension::Slack, "{pendulum:?}");
    tick.pivot_change = DVec3::ZERO;
    // The body moves up at 3 m/s relative to the pivot, and is at the arm's full length again after 2 V / g.
    let mut time = tick.dt;
    let caught = loop {
        let report = pendulum.step(&tick);
        time += tick.dt;
        if report.arm == ArmTension::Taut {
            break report.caught;
        }
        assert!(time < 2.0, "{pendulum:?}");
    };
    assert!((time - 6.0 / G).abs() <= tick.dt, "{time}");
    assert!((caught - 3.0).abs() < 1e-6, "{caught}");
    assert!(pendulum.velocity.length() < 1e-9, "{pendulum:?}");
}

#[test]
fn looping_needs_the_speed_that_keeps_the_arm_taut() {
    // A speed of sqrt(5 g L) at the bottom makes a full circle. Between sqrt(2 g L) and that, the arm goes slack.
    for (share, round) in [(1.01, true), (0.99, false), (0.7, false)] {
        let (mut pendulum, tick) = (at_angle(0.0), tick(60.0));
        pendulum.velocity = DVec3::X * (share * libm::sqrt(5.0 * G * LENGTH));
        let mut slack = None;
        for _ in 0..120 {
            let report = pendulum.step(&tick);
            if report.arm == ArmTension::Slack && slack.is_none() {
                slack = Some(pendulum.arm.y / LENGTH);
            }
        }
        assert_eq!(slack.is_none(), round, "{share}: {slack:?}");
        // The arm goes slack where its sine above the horizontal is (V^2 - 2 g L) / (3 g L).
        let expected = (5.0 * share * share - 2.0) / 3.0;
        assert!(
            slack.is_none_or(|height| (height - expected).abs() < 0.06),
            "{slack:?} {expected}"
        );
    }
}

#[test]
fn damping_does_not_depend_on_the_tick_rate() {
    let left = |hz: f64| {
        let (mut pendulum, mut tick) = (at_angle(0.8), tick(hz));
        tick.damping = 0.5;
        for _ in 0..(8.0 * hz) as usize {
            pendulum.step(&tick);
        }
        libm::acos(1.0 - energy(&pendulum) / (G * LENGTH))
    };
    let exact = left(2000.0);
    for hz in [30.0, 60.0, 120.0, 240.0] {
        let share = left(hz) / exact - 1.0;
        assert!(share.abs() < 1e-2, "{hz} Hz: {share}");
    }
}

#[test]
fn extremes_stay_finite_and_within_the_arm() {
    let mut rng = Rng::with_seed(2);
    let lengths = [0.0, 1e-12, 1e-6, 0.01, 0.3, 1.5, 40.0];
    for case in 0..3000 {
        let mut vector =
            |size: f64| (DVec3::new(rng.f64(), rng.f64(), rng.f64()) * 2.0 - 1.0) * size;
        let mut pendulum = Pendulum {
            arm: vector([0.0, 0.1, 1.0, 100.0][case % 4]),
            velocity: vector([0.0, 1.0, 300.0][case % 3]),
        };
        let start = pendulum;
        let mut tick = PendulumTick {
            gravity: vector([0.0, 9.81, 1000.0][case / 3 % 3]),
            pivot_change: vector([0.0, 0.1, 300.0][case / 9 % 3]),
            ..tick([4.0, 60.0, 10_000.0][case / 27 % 3])
        };
        tick.length = lengths[case % lengths.len()];
        tick.damping = [0.0, 3.0][case / 7 % 2];
        for k in 0..20 {
            let report = pendulum.step(&tick);
            let context = format!("{start:?} {tick:?} after {k}: {pendulum:?} {report:?}");
            assert!(
                pendulum.arm.is_finite() && pendulum.velocity.is_finite(),
                "{context}"
            );
            assert!(
                pendulum.arm.length() <= tick.length * (1.0 + 1e-9),
                "{context}"
            );
            assert!(report.tension >= 0.0 && report.caught >= 0.0, "{context}");
        }
    }
}

#[test]
fn invalid_arguments_change_nothing() {
    let mut pendulum = at_angle(0.5);
    let before = pendulum;
    for (length, dt) in [
        (f64::NAN, 0.1),
        (1.5, 0.0),
        (1.5, -0.1),
        (1.5, f64::NAN),
        (f64::INFINITY, 0.1),
    ] {
        let report = pendulum.step(&PendulumTick {
            length,
            dt,
            ..tick(60.0)
        });
        assert_eq!(
            (pendulum, report),
            (before, PendulumReport::default()),
            "{length} {dt}"
        );
    }
    pendulum.step(&PendulumTick {
        gravity: DVec3::NAN,
        ..tick(60.0)
    });
    assert_eq!(pendulum, before);
}
