use clamber_surface::geometry::WorldCapsule;
use glam::DVec3;

use crate::{ProxyBody, ProxyMeeting};

fn climber() -> ProxyBody {
    ProxyBody {
        capsule: WorldCapsule::ball(DVec3::ZERO, 0.4),
        margin: 0.01,
        mass: 80.0,
        velocity: DVec3::ZERO,
        drift: DVec3::ZERO,
        frame_velocity: DVec3::ZERO,
        up: DVec3::Y,
        support_normal: None,
        gentle: 0.01,
        support: None,
    }
}

/// A random number of a random magnitude from `least` on.
fn spread(least: f64, magnitudes: u32) -> f64 {
    let ten = (0..fastrand::u32(0..magnitudes)).fold(1.0, |ten, _| ten * 10.0);
    least * ten * (1.0 + 9.0 * fastrand::f64())
}

fn vector() -> DVec3 {
    let entry = || fastrand::f64() * 2.0 - 1.0;
    DVec3::new(entry(), entry(), entry())
}

/// A ball that an engine without friction stopped at an immovable climber, in the climber's frame.
fn stopped(climber: &ProxyBody, normal: DVec3, speed: f64) -> ProxyMeeting {
    let before = climber.drift - normal * speed + vector().reject_from_normalized(normal);
    ProxyMeeting {
        normal,
        before,
        free: before,
        after: before + normal * speed,
        shifted: DVec3::ZERO,
        friction: 0.5,
    }
}

#[test]
fn floating_climbers_and_bodies_keep_their_momentum_and_go_on_together() {
    fastrand::seed(1);
    let mut felt = 0;
    for _ in 0..20_000 {
        let frame = vector() * spread(0.1, 4);
        let mut climber = climber();
        climber.mass = spread(0.1, 6);
        (climber.velocity, climber.drift, climber.frame_velocity) = (frame, frame, frame);
        let mass = spread(1e-3, 8);
        let normal = vector().normalize();
        if climber.is_below(normal) {
            continue;
        }
        let speed = spread(0.1, 4);
        let meeting = stopped(&climber, normal, speed);
        let share = climber.share(&meeting, |impulse| impulse / mass).unwrap();
        let after = meeting.after + share.body / mass;
        let own = frame + share.climber.unwrap() / climber.mass;
        let slack = 1e-9 * (speed + frame.length());
        let momentum = (after - meeting.before) * mass + (own - frame) * climber.mass;
        assert!(
            momentum.length() < slack * mass.max(climber.mass),
            "{momentum}"
        );
        assert!((after - own).dot(normal).abs() < slack, "{after} {own}");
        assert_eq!(share.shift, DVec3::ZERO);
        felt += 1;
    }
    assert!(felt > 10_000);
}

#[test]
fn the_ground_takes_what_presses_a_climber_into_it() {
    let mut climber = climber();
    climber.support_normal = Some(DVec3::Y);
    for (normal, mobility) in [
        (DVec3::Y, 0.0),
        (DVec3::X, 1.0),
        (DVec3::new(0.6, 0.8, 0.0), 0.36),
    ] {
        let meeting = stopped(&climber, normal, 4.0);
        let share = climber.share(&meeting, |impulse| impulse / 20.0).unwrap();
        let impulse = 4.0 / (1.0 / 20.0 + mobility / 80.0);
        assert!((share.climber.unwrap() + normal * impulse).length() < 1e-9);
        // A very heavy body changes the climber's velocity by no more than the approach, like a fall of the climber
        // onto it.
        let share = climber.share(&meeting, |impulse| impulse / 1e5).unwrap();
        assert!(share.climber.unwrap().length() <= 80.0 * 4.0 + 1e-9);
        let after = meeting.after + share.body / 1e5;
        let left = 4.0 - 4.0 / (1.0 + mobility * 1e5 / 80.0);
        assert!((after.dot(-normal) - left).abs() < 1e-9, "{after} {left}");
    }
}

/// Friction is shared like the impact, so that it does not change the momentum of both.
#[test]
fn friction_keeps_the_momentum_of_both() {
    fastrand::seed(2);
    for _ in 0..10_000 {
        let climber = ProxyBody {
            mass: spread(0.1, 6),
            ..climber()
        };
        let normal = vector().normalize();
        if climber.is_below(normal) {
            continue;
        }
        let (mass, speed) = (spread(1e-3, 8), spread(0.1, 4));
        let mut meeting = stopped(&climber, normal, speed);
        let sliding = meeting.after;
        meeting.after -= sliding.clamp_length_max(speed * meeting.friction);
        let share = climber.share(&meeting, |impulse| impulse / mass).unwrap();
        let change = meeting.after + share.body / mass - meeting.before;
        let momentum = change * mass + share.climber.unwrap();
        assert!(
            momentum.length() < 1e-9 * speed * mass.max(climber.mass),
            "{momentum}"
        );
    }
}

#[test]
fn what_the_climber_runs_or_lands_on_is_as_without_it() {
    let mut climber = climber();
    climber.velocity = DVec3::new(3.0, 4.0, 0.0);
    climber.drift = climber.velocity;
    // The engine drags a crate along, sideways by the impulse and up by friction.
    let free = DVec3::new(0.0, -0.1, 0.0);
    let running = ProxyMeeting {
        normal: DVec3::X,
        before: DVec3::ZERO,
        free,
        after: DVec3::new(3.0, 1.2, 0.0),
        shifted: DVec3::new(0.05, 0.02, 0.0),
        friction: 0.5,
    };
    climber.support_normal = None;
    let landing = ProxyMeeting {
        normal: DVec3::NEG_Y,
        after: DVec3::new(0.5, -5.0, 0.0),
        shifted: DVec3::new(0.01, -0.08, 0.0),
        ..running
    };
    for meeting in [running, landing] {
        if meeting == landing {
            climber.velocity.y = -5.0;
            climber.drift = climber.velocity;
        }
        let share = climber.share(&meeting, |impulse| impulse / 20.0).unwrap();
        let after = meeting.after + share.body / 20.0;
        assert!((after - free).length() < 1e-9, "{meeting:?}: {after}");
        assert!((share.shift + meeting.shifted).length() < 1e-12);
        assert_eq!(share.climber, None);
    }
}

#[test]
fn numbers_that_are_not_finite_and_bodies_that_cannot_move_are_no_meetings() {
    let climber = climber();
    let meeting = stopped(&climber, DVec3::X, 1.0);
    assert_eq!(climber.share(&meeting, |_| DVec3::ZERO), None);
    for friction in [f64::NAN, f64::NEG_INFINITY, -1.0, f64::INFINITY] {
        let odd = ProxyMeeting {
            friction,
            after: DVec3::Y * 0.1,
            ..meeting
        };
        let share = climber.share(&odd, |impulse| impulse);
        assert_eq!(share.is_none(), friction.is_nan(), "{friction}");
    }
    for bad in [f64::NAN, f64::INFINITY] {
        let mut broken = meeting;
        broken.after.x = bad;
        assert_eq!(climber.share(&broken, |impulse| impulse), None);
        let mut broken = meeting;
        broken.free.y = bad;
        broken.after.x = 2.0;
        let share = climber.share(&broken, |impulse| impulse);
        assert!(share.is_none_or(|share| share.body.is_finite()));
    }
}

/// The response of a body's point to an impulse there: the body turns, too.
fn turning(mass: f64) -> impl Fn(DVec3) -> DVec3 {
    let arm = vector();
    // The inverse moments of inertia of a box about its axes.
    let sides = DVec3::new(fastrand::f64(), fastrand::f64(), fastrand::f64()) + 0.05;
    let squares = sides * sides;
    let moments = DVec3::splat(squares.element_sum()) - squares;
    let inverse = DVec3::splat(12.0 / mass) / moments;
    move |impulse| impulse / mass + (inverse * arm.cross(impulse)).cross(arm)
}

/// For bodies that turn, with friction, and for climbers on supports, the approach bounds a blow, and the impact makes
/// no energy.
#[test]
fn no_blow_is_harder_than_the_approach_and_makes_energy() {
    fastrand::seed(3);
    let (mut felt, mut hardest) = (0, 0.0f64);
    for round in 0..50_000 {
        let frame = vector() * spread(0.1, 4) * f64::from(fastrand::u8(0..2));
        let mut climber = climber();
        climber.mass = spread(0.1, 6);
        (climber.velocity, climber.drift, climber.frame_velocity) = (frame, frame, frame);
        climber.support_normal = fastrand::bool().then(|| vector().normalize());
        let normal = vector().normalize();
        let (mass, speed) = (spread(1e-3, 8), spread(0.1, 4));
        let respond = turning(mass);
        let mut meeting = stopped(&climber, normal, speed);
        meeting.friction = fastrand::f64();
        // The impulse of an engine that stops the point along the normal, and slows it along the surface.
        let slips = |velocity: DVec3| (velocity - frame).reject_from_normalized(normal);
        let along = slips(meeting.before).normalize();
        let mut drag = meeting.friction * fastrand::f64();
        let engine = loop {
            let unit = normal - along * drag;
            let stiffness = respond(unit).dot(normal);
            let engine = unit * (speed / stiffness);
            meeting.after = meeting.before + respond(engine);
            if stiffness > 0.0 && slips(meeting.after).dot(along) >= 0.0 || drag == 0.0 {
                break engine;
            }
            drag = if drag > 1e-3 { drag * 0.5 } else { 0.0 };
        };
        let Some(share) = climber.share(&meeting, &respond) else {
            panic!("round {round}: {meeting:?}");
        };
        // All velocities are in the climber's frame.
        let [before, after] =
            [meeting.before, meeting.after + respond(share.body)].map(|v| v - frame);
        let gains = (engine + share.body).dot(before + after) * 0.5;
        let slack = 1e-9 * mass * (speed + frame.length()) * (speed + frame.length());
        let Some(blow) = share.climber else {
            assert!(gains <= slack, "round {round}: {gains}");
            continue;
        };
        felt += 1;
        let change = blow.length() / climber.mass;
        let approach = speed * libm::hypot(1.0, meeting.friction);
        hardest = hardest.max(change / approach);
        assert!(
            change <= approach * (1.0 + 1e-9),
            "round {round}: {change} of {approach}"
        );
        if climber.support_normal.is_none() {
            let own = blow.length_squared() / climber.mass * 0.5;
            assert!(gains + own <= slack, "round {round}: {gains} and {own}");
        } else {
            assert!(gains <= slack, "round {round}: {gains}");
        }
    }
    assert!(felt > 10_000 && hardest > 0.9, "{felt}, {hardest}");
}
