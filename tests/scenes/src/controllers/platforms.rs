//! Moving ground.

use core::f64::consts::{PI, TAU};

use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use glam::DVec3;

use super::play::Scene;
use super::set::{IDLE, Input, Set, TICK, shifted, turned};
use super::solid::Solid;

/// An idle ride on a platform: number, name, largest error in metres, ticks, half the length of the platform's sides,
/// start on the platform in its own space, and motion.
type Ride = (
    u32,
    &'static str,
    f64,
    u32,
    f64,
    [f64; 3],
    fn(f64) -> Similarity,
);

#[rustfmt::skip]
const RIDES: &[Ride] = &[
    (7, "lift, 5 m/s up, still, down", 1e-2, 180, 5.0, [1.0, 0.0, 0.5], |time| lift(5.0, time)),
    (7, "lift, 20 m/s up, still, down", 1e-2, 180, 5.0, [1.0, 0.0, 0.5], |time| lift(20.0, time)),
    (25, "lift, sine of 2 m, 6 m/s", 1e-3, 600, 3.0, [1.0, 0.0, 0.0],
        |time| shifted(DVec3::Y * (2.0 * libm::sin(3.0 * time)))),
    (31, "lift, from 2.4 to -2.4 m/s in a tick", 1e-3, 150, 5.0, [1.0, 0.0, 0.0],
        |time| shifted(DVec3::Y * (2.4 * (time.min(1.0) - (time - 1.0).max(0.0))))),
    (32, "lift of 10 m/s, 0.1 m beyond its edge", 1e-3, 120, 5.0, [5.1, 0.0, 0.3],
        |time| shifted(DVec3::Y * (10.0 * time))),
    (33, "sideways, from 0 to 4 m/s in a tick", 1e-3, 120, 5.0, [0.0; 3],
        |time| shifted(DVec3::X * (4.0 * (time - 0.5).max(0.0)))),
    (29, "down and sideways, 3 and 3 m/s", 1e-3, 300, 5.0, [0.0; 3],
        |time| shifted(DVec3::new(0.0, -3.0, -3.0) * time)),
    (6, "a turn a second, 9 m out", 1e-3, 60, 10.0, [9.0, 0.0, 0.0], |time| turned(DVec3::Y, TAU * time)),
    (26, "a minute: turns to and fro", 1e-3, 3600, 5.0, [2.0, 0.0, 1.0],
        |time| turned(DVec3::Y, PI * libm::sin(time))),
    (26, "a minute: in a circle, turning", 1e-3, 3600, 5.0, [2.0, 0.0, 1.0], circle),
    (26, "a minute: up and down", 1e-3, 3600, 5.0, [2.0, 0.0, 1.0],
        |time| shifted(DVec3::Y * (1.75 * libm::sin(time)))),
    (26, "a minute: reverses at 3 m/s", 1e-3, 3600, 5.0, [2.0, 0.0, 1.0], reverse),
    (48, "tilts by 20 degrees to and fro", 1e-3, 600, 8.0, [3.0, 0.0, 1.0],
        |time| turned(DVec3::Z, 0.35 * libm::sin(2.0 * time))),
    (48, "storm, in six degrees of freedom", 1e-3, 600, 12.0, [2.0, 0.0, 1.0], storm),
];

/// A lift: up for a second, still for half a second, down for a second.
fn lift(speed: f64, time: f64) -> Similarity {
    let (up, down) = (time.min(1.0), (time - 1.5).clamp(0.0, 1.0));
    shifted(DVec3::Y * (speed * (up - down)))
}

fn circle(time: f64) -> Similarity {
    let angle = PI * time;
    Similarity {
        translation: DVec3::new(libm::cos(angle), 0.0, libm::sin(angle)) * 5.0,
        ..turned(DVec3::Y, angle)
    }
}

fn reverse(time: f64) -> Similarity {
    let phase = (3.0 * time).rem_euclid(10.0);
    shifted(DVec3::X * phase.min(10.0 - phase))
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

/// Error: the largest distance of the character from the place to which the platform's motion takes its start.
fn ride((number, name, asked, ticks, half, feet, motion): Ride) -> Scene {
    let feet = motion(0.0).transform_point(DVec3::from_array(feet));
    let set = Set::new(feet).with(Solid::floor(half), motion);
    let scene = Scene::new(number, name, ticks, set, move |seen| {
        let local = motion(0.0).inverse_transform_point(seen.start);
        seen.most(|time, p| motion(time).transform_point(local).distance(p))
    });
    scene.within(asked)
}

/// Ticks before a jump.
const AFTER: u32 = 30;

/// A scene with one jump, after half a second.
fn with_jump(mut scene: Scene) -> Scene {
    scene.input = Box::new(|tick| Input {
        jump: tick == AFTER + 1,
        ..IDLE
    });
    scene.in_the_air()
}

/// A jump on a platform that moves sideways. Error: distance from the start, on the platform, at the end.
fn jump_on_a_platform() -> Scene {
    let motion = |time: f64| shifted(DVec3::X * (5.0 * time));
    let mut set = Set::new(DVec3::X).with(Solid::floor(5.0), motion);
    set.jump = 5.0;
    let name = "a jump on a platform moving sideways, 5 m/s";
    with_jump(Scene::new(49, name, AFTER + 90, set, move |seen| {
        let time = seen.dt * seen.positions.len() as f64;
        seen.end()
            .distance(motion(time).transform_point(seen.start))
    }))
}

/// A jump off a lift that goes down. Error: the difference of its height above the lift from that of a thrown ball
/// above a lift at rest. Allowed is one tick at that speed.
fn jump_off_a_lift() -> Scene {
    let motion = |time| shifted(DVec3::Y * (-3.0 * time));
    let mut set = Set::new(DVec3::ZERO).with(Solid::floor(5.0), motion);
    set.jump = 3.0;
    let name = "a jump of 3 m/s off a lift going down at 3 m/s";
    let scene = Scene::new(30, name, AFTER + 60, set, |seen| {
        let (mut speed, mut height) = (3.0 - 9.81 * TICK, 0.0);
        while speed > 0.0 {
            height += speed * TICK;
            speed -= 9.81 * TICK;
        }
        let highest = seen.most(|time, p| p.y - seen.start.y + 3.0 * time);
        (highest - height).abs()
    });
    with_jump(scene).within(3.0 * TICK)
}

/// A walk up 3 m of stairs that move up, back and to a side, in one and a half times the time that 4 m/s take on the
/// level.
fn stairs_that_move() -> Scene {
    let velocity = DVec3::new(1.0, 0.5, -1.5);
    let stairs = Solid::stairs(0.0, 10, 0.3, 5.0);
    let set = Set::new(-DVec3::Z).with(stairs, move |time| shifted(velocity * time));
    let name = "stairs that move, 1.9 m/s, walked up";
    let scene = Scene::new(49, name, 85, set, move |seen| {
        let time = seen.dt * seen.positions.len() as f64;
        let way = seen.end() - seen.start - velocity * time;
        (3.0 - way.y).abs().max(way.x.abs())
    });
    scene.walking(DVec3::Z * 4.0)
}

pub(super) fn scenes() -> Vec<Scene> {
    let rides = RIDES.iter().copied().map(ride);
    rides
        .chain([jump_on_a_platform(), jump_off_a_lift(), stairs_that_move()])
        .collect()
}
