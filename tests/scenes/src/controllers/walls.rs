//! Walls in the way of a walk, and walls that push.

use glam::DVec3;

use super::scene::Scene;
use super::set::{IDLE, Input, PADDING, RADIUS, Set, shifted};
use super::solid::Solid;

/// A wall pushes an idle character. Error: its depth in the wall beyond the padding, or its distance off the floor or
/// to a side.
fn pushed(name: &'static str, speed: f64, ticks: u32) -> Scene {
    let wall = Solid::Block {
        low: DVec3::new(-3.0, -0.5, -5.0),
        high: DVec3::new(-1.0, 4.0, 5.0),
    };
    let set = Set::new(DVec3::ZERO)
        .with_still(Solid::floor(80.0))
        .with(wall, move |time| shifted(DVec3::X * (speed * time)));
    Scene {
        number: 21,
        name,
        asked: 5e-2,
        ticks,
        always_stands: true,
        set,
        input: Box::new(|_| IDLE),
        error: Box::new(move |seen| {
            seen.most(|time, p| {
                let depth = RADIUS - PADDING - (p.x + 1.0 - speed * time);
                let off = DVec3::new(0.0, p.y - seen.start.y, p.z);
                depth.max(off.length())
            })
        }),
    }
}

/// A wall pushes an idle character to and fro. Error: as [`pushed`], or how far the character goes beyond the wall's
/// reach.
fn shoved() -> Scene {
    let wall = Solid::Block {
        low: DVec3::new(-2.0, 0.0, -3.0),
        high: DVec3::new(-1.0, 3.0, 3.0),
    };
    let way = |time: f64| 3.0 * libm::sin(time);
    let set = Set::new(DVec3::ZERO)
        .with_still(Solid::floor(20.0))
        .with(wall, move |time| shifted(DVec3::X * way(time)));
    Scene {
        number: 26,
        name: "a minute: a wall that comes and goes",
        asked: 1e-3,
        ticks: 3600,
        always_stands: true,
        set,
        input: Box::new(|_| IDLE),
        error: Box::new(move |seen| {
            seen.most(|time, p| {
                let depth = RADIUS - PADDING - (p.x + 1.0 - way(time));
                let flung = p.x - (2.0 + RADIUS);
                let off = DVec3::new(0.0, p.y - seen.start.y, p.z);
                depth.max(flung).max(off.length())
            })
        }),
    }
}

/// A walk into a wall at an angle. Error: distance from a walk along the wall at the same speed.
fn alongside(name: &'static str, number: u32, asked: f64, wall: Vec<Solid>, walk: DVec3) -> Scene {
    let seconds = 1.0;
    let mut set = Set::new(DVec3::ZERO).with_still(Solid::floor(20.0));
    for solid in wall {
        set = set.with_still(solid);
    }
    set.speed = walk.length();
    Scene {
        number,
        name,
        asked,
        ticks: 60,
        always_stands: true,
        set,
        input: Box::new(move |_| Input { walk, ..IDLE }),
        error: Box::new(move |seen| {
            let level = DVec3::X * (walk.x * seconds);
            (seen.end() - seen.start).distance(level)
        }),
    }
}

pub(super) fn scenes() -> Vec<Scene> {
    let smooth = Solid::Block {
        low: DVec3::new(-20.0, -1.0, -1.0 - RADIUS),
        high: DVec3::new(20.0, 3.0, -RADIUS),
    };
    let pillars = (0..30u32).map(|k| {
        let x = -1.0 + 0.2 * f64::from(k);
        Solid::Block {
            low: DVec3::new(x, -0.5, -0.2 - RADIUS),
            high: DVec3::new(x + 0.2, 2.0, -RADIUS),
        }
    });
    vec![
        pushed("a wall pushes at 2 m/s", 2.0, 240),
        pushed("a wall pushes at 30 m/s", 30.0, 120),
        shoved(),
        alongside(
            "a walk along a wall, into it",
            5,
            1e-2,
            vec![smooth],
            DVec3::new(5.0, 0.0, -1.0),
        ),
        alongside(
            "a walk along 30 pillars, into them",
            28,
            1e-3,
            pillars.collect(),
            DVec3::new(2.0, 0.0, -1.0),
        ),
    ]
}
