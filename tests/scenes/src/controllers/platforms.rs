//! Moving ground.

use core::f64::consts::{PI, TAU};

use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use glam::DVec3;

use super::scene::{Scene, Seen};
use super::set::{IDLE, Input, Set, TICK, shifted, turned};
use super::solid::Solid;

/// An idle ride on a platform. Error: see [`drift`].
struct Ride {
    number: u32,
    name: &'static str,
    asked: f64,
    ticks: u32,
    half: f64,
    /// Start on the floor, in the floor's own space.
    feet: DVec3,
    motion: fn(f64) -> Similarity,
}

const RIDES: &[Ride] = &[
    Ride {
        number: 7,
        name: "lift, 5 m/s up, still, down",
        asked: 1e-2,
        ticks: 180,
        half: 5.0,
        feet: DVec3::new(1.0, 0.0, 0.5),
        motion: |time| lift(5.0, time),
    },
    Ride {
        number: 7,
        name: "lift, 20 m/s up, still, down",
        asked: 1e-2,
        ticks: 180,
        half: 5.0,
        feet: DVec3::new(1.0, 0.0, 0.5),
        motion: |time| lift(20.0, time),
    },
    Ride {
        number: 25,
        name: "lift, sine of 2 m, 6 m/s",
        asked: 1e-3,
        ticks: 600,
        half: 3.0,
        feet: DVec3::X,
        motion: |time| shifted(DVec3::Y * (2.0 * libm::sin(3.0 * time))),
    },
    Ride {
        number: 31,
        name: "lift, from 2.4 to -2.4 m/s in a tick",
        asked: 1e-3,
        ticks: 150,
        half: 5.0,
        feet: DVec3::X,
        motion: |time| shifted(DVec3::Y * (2.4 * (time.min(1.0) - (time - 1.0).max(0.0)))),
    },
    Ride {
        number: 32,
        name: "lift of 10 m/s, 0.1 m beyond its edge",
        asked: 1e-3,
        ticks: 120,
        half: 5.0,
        feet: DVec3::new(5.1, 0.0, 0.3),
        motion: |time| shifted(DVec3::Y * (10.0 * time)),
    },
    Ride {
        number: 33,
        name: "sideways, from 0 to 4 m/s in a tick",
        asked: 1e-3,
        ticks: 120,
        half: 5.0,
        feet: DVec3::ZERO,
        motion: |time| shifted(DVec3::X * (4.0 * (time - 0.5).max(0.0))),
    },
    Ride {
        number: 29,
        name: "down and sideways, 3 and 3 m/s",
        asked: 1e-3,
        ticks: 300,
        half: 5.0,
        feet: DVec3::ZERO,
        motion: |time| shifted(DVec3::new(0.0, -3.0, -3.0) * time),
    },
    Ride {
        number: 6,
        name: "a turn a second, 9 m out",
        asked: 1e-3,
        ticks: 60,
        half: 10.0,
        feet: DVec3::new(9.0, 0.0, 0.0),
        motion: |time| turned(DVec3::Y, TAU * time),
    },
    Ride {
        number: 26,
        name: "a minute: turns to and fro",
        asked: 1e-3,
        ticks: 3600,
        half: 5.0,
        feet: DVec3::new(2.0, 0.0, 1.0),
        motion: |time| turned(DVec3::Y, PI * libm::sin(time)),
    },
    Ride {
        number: 26,
        name: "a minute: in a circle, turning",
        asked: 1e-3,
        ticks: 3600,
        half: 5.0,
        feet: DVec3::new(2.0, 0.0, 1.0),
        motion: |time| {
            let mut pose = turned(DVec3::Y, PI * time);
            let angle = PI * time;
            pose.translation = DVec3::new(libm::cos(angle), 0.0, libm::sin(angle)) * 5.0;
            pose
        },
    },
    Ride {
        number: 26,
        name: "a minute: up and down",
        asked: 1e-3,
        ticks: 3600,
        half: 5.0,
        feet: DVec3::new(2.0, 0.0, 1.0),
        motion: |time| shifted(DVec3::Y * (1.75 * libm::sin(time))),
    },
    Ride {
        number: 26,
        name: "a minute: reverses at 3 m/s",
        asked: 1e-3,
        ticks: 3600,
        half: 5.0,
        feet: DVec3::new(2.0, 0.0, 1.0),
        motion: |time| {
            let phase = (3.0 * time).rem_euclid(10.0);
            shifted(DVec3::X * phase.min(10.0 - phase))
        },
    },
    Ride {
        number: 48,
        name: "tilts by 20 degrees to and fro",
        asked: 1e-3,
        ticks: 600,
        half: 8.0,
        feet: DVec3::new(3.0, 0.0, 1.0),
        motion: |time| turned(DVec3::Z, 0.35 * libm::sin(2.0 * time)),
    },
    Ride {
        number: 48,
        name: "storm, in six degrees of freedom",
        asked: 1e-3,
        ticks: 600,
        half: 12.0,
        feet: DVec3::new(2.0, 0.0, 1.0),
        motion: storm,
    },
];

/// A lift: up for a second, still for half a second, down for a second.
fn lift(speed: f64, time: f64) -> Similarity {
    let (up, down) = (time.min(1.0), (time - 1.5).clamp(0.0, 1.0));
    shifted(DVec3::Y * (speed * (up - down)))
}

fn storm(time: f64) -> Similarity {
    let pitch = rotation_from_axis_angle(DVec3::X, 0.2 * libm::sin(2.0 * time));
    let roll = rotation_from_axis_angle(DVec3::Z, 0.25 * libm::sin(1.7 * time));
    let yaw = rotation_from_axis_angle(DVec3::Y, 0.8 * time);
    Similarity {
        rotation: (yaw * pitch * roll).normalize(),
        scale: 1.0,
        translation: DVec3::new(
            3.0 * libm::sin(time),
            1.5 * libm::sin(2.3 * time),
            2.0 * libm::cos(0.7 * time),
        ),
    }
}

/// The largest distance of the character from the place to which the platform's motion takes its start.
fn drift(seen: &Seen, motion: impl Fn(f64) -> Similarity) -> f64 {
    let local = motion(0.0).inverse_transform_point(seen.start);
    seen.most(|time, p| motion(time).transform_point(local).distance(p))
}

fn ride(ride: &Ride) -> Scene {
    let motion = ride.motion;
    Scene {
        number: ride.number,
        name: ride.name,
        asked: ride.asked,
        ticks: ride.ticks,
        always_stands: true,
        set: Set::new(motion(0.0).transform_point(ride.feet)).with(Solid::floor(ride.half), motion),
        input: Box::new(|_| IDLE),
        error: Box::new(move |seen| drift(seen, motion)),
    }
}

/// Ticks before a jump.
const AFTER: u32 = 30;

/// One jump, after half a second.
fn jump(tick: u32) -> Input {
    Input {
        jump: tick == AFTER + 1,
        ..IDLE
    }
}

/// A jump on a platform that moves sideways. Error: distance from the start, on the platform, at the end.
fn jump_on_a_platform() -> Scene {
    let motion = |time: f64| shifted(DVec3::X * (5.0 * time));
    let mut set = Set::new(DVec3::X).with(Solid::floor(5.0), motion);
    set.jump = 5.0;
    Scene {
        number: 49,
        name: "a jump on a platform moving sideways, 5 m/s",
        asked: 1e-3,
        ticks: AFTER + 90,
        always_stands: false,
        set,
        input: Box::new(jump),
        error: Box::new(move |seen| {
            let time = seen.dt * seen.positions.len() as f64;
            seen.end()
                .distance(motion(time).transform_point(seen.start))
        }),
    }
}

/// A jump off a lift that goes down. Error: the difference of its height above the lift from that of a thrown ball
/// above a lift at rest. Allowed is one tick at that speed.
fn jump_off_a_lift() -> Scene {
    let mut set =
        Set::new(DVec3::ZERO).with(Solid::floor(5.0), |time| shifted(DVec3::Y * (-3.0 * time)));
    set.jump = 3.0;
    Scene {
        number: 30,
        name: "a jump of 3 m/s off a lift going down at 3 m/s",
        asked: 3.0 * TICK,
        ticks: AFTER + 60,
        always_stands: false,
        set,
        input: Box::new(jump),
        error: Box::new(|seen| {
            let (mut speed, mut height) = (3.0 - 9.81 * TICK, 0.0);
            while speed > 0.0 {
                height += speed * TICK;
                speed -= 9.81 * TICK;
            }
            let highest = seen.most(|time, p| p.y - seen.start.y + 3.0 * time);
            (highest - height).abs()
        }),
    }
}

/// A walk up 3 m of stairs that move up, back and to a side, in one and a half times the time that 4 m/s take on the
/// level.
fn stairs_that_move() -> Scene {
    let velocity = DVec3::new(1.0, 0.5, -1.5);
    let motion = move |time: f64| shifted(velocity * time);
    let mut set = Set::new(-DVec3::Z).with(Solid::stairs(10), motion);
    set.speed = 4.0;
    Scene {
        number: 49,
        name: "stairs that move, 1.9 m/s, walked up",
        asked: 1e-3,
        ticks: 85,
        always_stands: true,
        set,
        input: Box::new(|_| Input {
            walk: DVec3::Z * 4.0,
            ..IDLE
        }),
        error: Box::new(move |seen| {
            let time = seen.dt * seen.positions.len() as f64;
            let way = seen.end() - seen.start - velocity * time;
            (3.0 - way.y).abs().max(way.x.abs())
        }),
    }
}

pub(super) fn scenes() -> Vec<Scene> {
    let rides = RIDES.iter().map(ride);
    rides
        .chain([jump_on_a_platform(), jump_off_a_lift(), stairs_that_move()])
        .collect()
}
