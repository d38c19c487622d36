//! Walls in the way of a walk, and walls that push.

use glam::DVec3;

use super::play::Scene;
use super::set::{PADDING, RADIUS, Set, shifted};
use super::solid::Solid;

/// A wall pushes an idle character. Error: its depth in the wall beyond the padding, or its distance off the floor or
/// to a side.
fn pushed(name: &'static str, speed: f64, ticks: u32) -> Scene {
    let wall = Solid::block([-3.0, -0.5, -5.0], [-1.0, 4.0, 5.0]);
    let set = Set::new(DVec3::ZERO)
        .with_still(Solid::floor(80.0))
        .with(wall, move |time| shifted(DVec3::X * (speed * time)));
    let scene = Scene::new(21, name, ticks, set, move |seen| {
        seen.most(|time, p| {
            let depth = RADIUS - PADDING - (p.x + 1.0 - speed * time);
            let off = DVec3::new(0.0, p.y - seen.start.y, p.z);
            depth.max(off.length())
        })
    });
    scene.within(5e-2)
}

/// A wall pushes an idle character to and fro. Error: as [`pushed`], or how far the character goes beyond the wall's
/// reach.
fn shoved() -> Scene {
    let wall = Solid::block([-2.0, 0.0, -3.0], [-1.0, 3.0, 3.0]);
    let way = |time: f64| 3.0 * libm::sin(time);
    let set = Set::new(DVec3::ZERO)
        .with_still(Solid::floor(20.0))
        .with(wall, move |time| shifted(DVec3::X * way(time)));
    let name = "a minute: a wall that comes and goes";
    Scene::new(26, name, 3600, set, move |seen| {
        seen.most(|time, p| {
            let depth = RADIUS - PADDING - (p.x + 1.0 - way(time));
            let flung = p.x - (2.0 + RADIUS);
            let off = DVec3::new(0.0, p.y - seen.start.y, p.z);
            depth.max(flung).max(off.length())
        })
    })
}

/// A walk of a second into a wall at an angle. Error: distance from a walk along the wall at the same speed.
fn alongside(number: u32, name: &'static str, wall: Vec<Solid>, walk: DVec3) -> Scene {
    let set = Set::new(DVec3::ZERO).with_still(Solid::floor(20.0));
    let set = wall.into_iter().fold(set, Set::with_still);
    let scene = Scene::new(number, name, 60, set, move |seen| {
        (seen.end() - seen.start).distance(DVec3::X * walk.x)
    });
    scene.walking(walk)
}

pub(super) fn scenes() -> Vec<Scene> {
    let smooth = Solid::block([-20.0, -1.0, -1.0 - RADIUS], [20.0, 3.0, -RADIUS]);
    let pillars = (0..30u32).map(|k| {
        let x = -1.0 + 0.2 * f64::from(k);
        Solid::block([x, -0.5, -0.2 - RADIUS], [x + 0.2, 2.0, -RADIUS])
    });
    let walk = |speed: f64| DVec3::new(speed, 0.0, -1.0);
    let along = alongside(5, "a walk along a wall, into it", vec![smooth], walk(5.0));
    let name = "a walk along 30 pillars, into them";
    vec![
        pushed("a wall pushes at 2 m/s", 2.0, 240),
        pushed("a wall pushes at 30 m/s", 30.0, 120),
        shoved(),
        along.within(1e-2),
        alongside(28, name, pillars.collect(), walk(2.0)),
    ]
}
