//! Ground to stand and walk on.

use std::error::Error;

use clamber_climber::{ClimberConfig, ClimberInput};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::SurfaceKind;
use glam::DVec3;

use super::stage::{Moment, Scene, Thing};
use crate::controllers::{Mesh, Solid, shifted, turned};

const STONE: SurfaceKind = SurfaceKind::Stone;

fn walker(speed: f64) -> ClimberConfig {
    let mut config = ClimberConfig::colossus_climber();
    config.body.radius = 0.3;
    config.body.height = 1.15;
    config.ground.walk_speed = speed.max(0.1);
    config.ground.acceleration = 20.0;
    config
}

/// Walks along +Z after half a second.
fn walks(speed: f64) -> Box<dyn Fn(&Moment<'_>) -> ClimberInput> {
    Box::new(move |moment| ClimberInput {
        walk: if moment.time > 0.5 && speed > 0.0 {
            DVec3::Z
        } else {
            DVec3::ZERO
        },
        ..ClimberInput::IDLE
    })
}

fn scene(name: String, speed: f64, things: Vec<Thing>, feet: DVec3) -> Scene {
    let config = walker(speed);
    Scene {
        name,
        seconds: 5.0,
        config,
        start: feet + DVec3::Y * (config.body.radius + 0.02),
        things,
        grips_all: false,
        input: walks(speed),
    }
}

fn still(_: f64) -> Similarity {
    Similarity::IDENTITY
}

/// Level ground, walked on at a speed; 0 stands.
///
/// # Errors
/// None.
pub fn flat(speed: f64) -> Result<Scene, Box<dyn Error>> {
    let ground = Thing::solid(&Solid::floor(60.0), STONE, still)?;
    Ok(scene(
        format!("flat at {speed} m/s"),
        speed,
        vec![ground],
        DVec3::ZERO,
    ))
}

/// A platform that goes up at 5 m/s.
///
/// # Errors
/// None.
pub fn lift(speed: f64) -> Result<Scene, Box<dyn Error>> {
    let motion = |time: f64| shifted(DVec3::Y * (5.0 * time));
    let ground = Thing::solid(&Solid::floor(60.0), STONE, motion)?;
    Ok(scene(
        format!("lift at {speed} m/s"),
        speed,
        vec![ground],
        DVec3::ZERO,
    ))
}

/// A platform that turns by 0.5 rad a second, walked on 6 m from its axis.
///
/// # Errors
/// None.
pub fn turntable(speed: f64) -> Result<Scene, Box<dyn Error>> {
    let motion = |time: f64| turned(DVec3::Y, 0.5 * time);
    let ground = Thing::solid(&Solid::floor(60.0), STONE, motion)?;
    Ok(scene(
        format!("turntable at {speed} m/s"),
        speed,
        vec![ground],
        DVec3::X * 6.0,
    ))
}

/// A ramp along +Z, up or, with a negative angle, down, radians.
///
/// # Errors
/// None.
pub fn ramp(angle: f64, speed: f64) -> Result<Scene, Box<dyn Error>> {
    let motion = move |_| turned(DVec3::X, -angle);
    let ground = Thing::solid(&Solid::floor(60.0), STONE, motion)?;
    let mut scene = scene(
        format!("ramp of {:.0} degrees at {speed} m/s", angle.to_degrees()),
        speed,
        vec![ground],
        DVec3::ZERO,
    );
    scene.start += DVec3::Y * (scene.config.body.radius * (1.0 / libm::cos(angle) - 1.0));
    Ok(scene)
}

/// Stairs of 0.2 by 0.3 m along +Z, up or down.
///
/// # Errors
/// None.
pub fn stairs(up: bool, speed: f64) -> Result<Scene, Box<dyn Error>> {
    let (rise, tread, count) = (0.2, 0.3, 60);
    let mut mesh = Mesh::default();
    let mut quad = |corners: [DVec3; 4]| {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(corners);
        mesh.triangles
            .extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|v: u32| v + first)));
    };
    let side = DVec3::X * 2.0;
    let mut strip = |from: DVec3, to: DVec3| quad([from - side, to - side, to + side, from + side]);
    strip(DVec3::new(0.0, 0.0, -5.0), DVec3::Z);
    let mut at = DVec3::Z;
    for step in 0..count {
        let riser = if up {
            DVec3::Y * rise
        } else {
            DVec3::Y * -rise
        };
        strip(at, at + riser);
        at += riser;
        let depth = if step + 1 == count { 6.0 } else { tread };
        strip(at, at + DVec3::Z * depth);
        at += DVec3::Z * depth;
    }
    let ground = Thing::solid(&Solid::Mesh(mesh), STONE, still)?;
    let way = if up { "up" } else { "down" };
    let mut scene = scene(
        format!("stairs {way} at {speed} m/s"),
        speed,
        vec![ground],
        DVec3::ZERO,
    );
    scene.seconds = 12.0;
    Ok(scene)
}

/// Stands with the left foot on a block of 0.4 m whose top is tilted by 30 degrees, and with the right one on the
/// ground.
///
/// # Errors
/// None.
pub fn block() -> Result<Scene, Box<dyn Error>> {
    let ground = Thing::solid(&Solid::floor(60.0), STONE, still)?;
    // Up to the right of it; the figure faces +Z, so its left is +X.
    let (near, far, tilt) = (0.03, 2.0, libm::tan(core::f64::consts::FRAC_PI_6));
    let top = |x: f64, z: f64| DVec3::new(x, 0.4 + (x - near) * tilt, z);
    let corner = |x: f64, z: f64| DVec3::new(x, -0.5, z);
    let positions = vec![
        top(near, -1.0),
        top(near, 1.0),
        top(far, 1.0),
        top(far, -1.0),
        corner(near, -1.0),
        corner(near, 1.0),
        corner(far, 1.0),
        corner(far, -1.0),
    ];
    let faces: [[u32; 4]; 5] = [
        [0, 1, 2, 3],
        [4, 5, 1, 0],
        [5, 6, 2, 1],
        [6, 7, 3, 2],
        [7, 4, 0, 3],
    ];
    let triangles = faces
        .iter()
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    let mesh = Mesh {
        positions,
        triangles: triangles.collect(),
    };
    let block = Thing::solid(&Solid::Mesh(mesh), STONE, still)?;
    let mut scene = scene(
        "one foot on a block".into(),
        0.0,
        vec![ground, block],
        DVec3::new(0.0, 0.4, 0.0),
    );
    scene.input = Box::new(|_| ClimberInput::IDLE);
    Ok(scene)
}
