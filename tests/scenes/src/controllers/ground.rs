//! Fixed ground: slopes, inner edges, stairs, bumps.

use glam::DVec3;

use super::play::Scene;
use super::set::{IDLE, Input, RADIUS, Set, radians, turned};
use super::solid::Solid;

/// A character stands idle on a slope for ten seconds. Error: distance from its start.
fn slope() -> Scene {
    let up = turned(DVec3::Z, radians(45.0));
    let feet = (up.rotation * DVec3::Y - DVec3::Y) * RADIUS;
    let set = Set::new(feet).with_placed(Solid::floor(40.0), up);
    Scene::new(2, "stands on 45 degrees", 600, set, |seen| {
        seen.most(|_, p| p.distance(seen.start))
    })
}

/// A walk up a slope of 0.6 rad, with a limit just above it. Error: how much is missing to 6 m along and 3 m up.
fn climb() -> Scene {
    let mut set = Set::new(DVec3::ZERO).with_still(Solid::ramp(0.6));
    set.max_slope = 0.601;
    let name = "climbs a slope just below the limit";
    let scene = Scene::new(18, name, 200, set, |seen| {
        (6.0 - seen.end().x).max(3.0 - seen.end().y).max(0.0)
    });
    scene.walking(DVec3::X * 6.0).in_the_air()
}

/// A walk into a slope of 0.6 rad, with a limit 3 degrees below it: a standing climber may exceed its limit by 2
/// degrees. Error: how far the character gets beyond 4.5 m along or 2 m up.
fn too_steep() -> Scene {
    let mut set = Set::new(DVec3::ZERO).with_still(Solid::ramp(0.6));
    set.max_slope = 0.6 - radians(3.0);
    let name = "climbs no slope beyond the limit";
    let scene = Scene::new(18, name, 200, set, |seen| {
        seen.most(|_, p| (p.x - 4.5).max(p.y - 2.0))
    });
    scene.walking(DVec3::X * 6.0).in_the_air()
}

/// A walk in three directions on a level floor. Error: the largest change of height in a tick.
fn flat() -> Scene {
    let mut set = Set::new(DVec3::new(-7.0, 0.0, -7.0)).with_still(Solid::floor(15.0));
    (set.dt, set.gravity, set.speed) = (1.0 / 30.0, 30.0, 9.0);
    let name = "a walk on the level at 30 Hz, 9 m/s";
    let mut scene = Scene::new(24, name, 90, set, |seen| {
        let before = std::iter::once(&seen.start).chain(&seen.positions);
        let steps = before.zip(&seen.positions);
        steps.map(|(a, b)| (b.y - a.y).abs()).fold(0.0, f64::max)
    });
    scene.input = Box::new(|tick| {
        let angle = 0.7 + f64::from((tick - 1) / 30) * 2.2;
        let walk = DVec3::new(libm::cos(angle), 0.0, libm::sin(angle)) * 9.0;
        Input { walk, ..IDLE }
    });
    scene
}

/// A walk over inner edges and the seam between two meshes. Error: the largest distance from its first height, or how
/// much is missing to x = 12 m.
fn seam() -> Scene {
    let set = Set::new(-DVec3::X * 3.0)
        .with_still(Solid::field(-16.0, 16))
        .with_still(Solid::field(0.0, 16));
    let name = "a walk over edges and a seam of meshes";
    let scene = Scene::new(23, name, 450, set, |seen| {
        let sunk = seen.most(|_, p| (p.y - seen.start.y).abs());
        sunk.max(12.0 - seen.end().x)
    });
    scene.walking(DVec3::X * 2.0).within(5e-2)
}

/// A walk up 3 m of stairs, in one and a half times the time that 4 m/s take on the level.
fn stairs() -> Scene {
    let set = Set::new(-DVec3::Z).with_still(Solid::stairs(0.0, 10, 0.3, 5.0));
    let scene = Scene::new(4, "stairs walked up", 85, set, |seen| {
        let way = seen.end() - seen.start;
        (3.0 - way.y).abs().max(way.x.abs())
    });
    scene.walking(DVec3::Z * 4.0)
}

/// A walk over bumps at 3 m/s for four seconds. Error: how much is missing to x = 11 m, a metre less than on level
/// ground.
fn bumps(name: &'static str, [width, height]: [f64; 2], every: f64, count: u32) -> Scene {
    let mut set = Set::new(DVec3::ZERO).with_still(Solid::floor(30.0));
    for k in 0..count {
        let x = 1.0 + every * f64::from(k);
        set = set.with_still(Solid::block([x, -0.5, -2.0], [x + width, height, 2.0]));
    }
    let scene = Scene::new(28, name, 240, set, |seen| {
        (11.0 - seen.end().x).max(seen.end().z.abs())
    });
    scene.walking(DVec3::X * 3.0)
}

pub(super) fn scenes() -> Vec<Scene> {
    vec![
        slope(),
        climb(),
        too_steep(),
        flat(),
        seam(),
        stairs(),
        bumps("bumps of 5 x 1 cm", [0.05, 0.01], 0.5, 20),
        bumps("bumps of 30 x 10 cm", [0.3, 0.1], 2.0, 5),
    ]
}
