//! Ground to stand and walk on.

use clamber_climber::{ClimberConfig, ClimberInput};
use clamber_surface::mesh::SurfaceKind;
use glam::DVec3;

use super::stage::{Scene, Thing, floor, still, walking, when};
use crate::SceneError;
use crate::controllers::{Mesh, Solid, shifted, turned};

type Made = Result<Scene, SceneError>;

/// A walk along +Z, after half a second, over things that start below the feet.
fn scene(name: String, speed: f64, things: Vec<Thing>, feet: DVec3) -> Scene {
    let mut config = ClimberConfig::colossus_climber();
    config.body.radius = 0.3;
    config.body.height = 1.15;
    config.ground.walk_speed = speed.max(0.1);
    config.ground.acceleration = 20.0;
    let start = feet + DVec3::Y * (config.body.radius + 0.02);
    let scene = Scene::new(name, 5.0, start, things, move |moment| {
        walking(when(moment.time > 0.5 && speed > 0.0, DVec3::Z))
    });
    Scene { config, ..scene }
}

/// Level ground, walked on at a speed; 0 stands.
pub fn flat(speed: f64) -> Made {
    let name = format!("flat at {speed} m/s");
    Ok(scene(name, speed, vec![floor(still)?], DVec3::ZERO))
}

/// A platform that goes up at 5 m/s.
pub fn lift(speed: f64) -> Made {
    let things = vec![floor(|time| shifted(DVec3::Y * (5.0 * time)))?];
    let name = format!("lift at {speed} m/s");
    Ok(scene(name, speed, things, DVec3::ZERO))
}

/// A platform that turns by 0.5 rad a second, walked on 6 m from its axis.
pub fn turntable(speed: f64) -> Made {
    let things = vec![floor(|time| turned(DVec3::Y, 0.5 * time))?];
    let name = format!("turntable at {speed} m/s");
    Ok(scene(name, speed, things, DVec3::X * 6.0))
}

/// A ramp along +Z, up or, with a negative angle, down, radians.
pub fn ramp(angle: f64, speed: f64) -> Made {
    let things = vec![floor(move |_| turned(DVec3::X, -angle))?];
    let name = format!("ramp of {:.0} degrees at {speed} m/s", angle.to_degrees());
    let mut scene = scene(name, speed, things, DVec3::ZERO);
    scene.start += DVec3::Y * (scene.config.body.radius * (1.0 / libm::cos(angle) - 1.0));
    Ok(scene)
}

/// Stairs of 0.2 by 0.3 m along +Z, up or down.
pub fn stairs(up: bool, speed: f64) -> Made {
    let stairs = Solid::stairs(1.0, 60, if up { 0.2 } else { -0.2 }, 6.0);
    let stairs = Thing::solid(&stairs, SurfaceKind::Stone, still)?;
    let name = format!("stairs {} at {speed} m/s", if up { "up" } else { "down" });
    let scene = scene(name, speed, vec![stairs], DVec3::ZERO);
    Ok(Scene {
        seconds: 12.0,
        ..scene
    })
}

/// Stands with the left foot on a block of 0.4 m whose top is tilted by 30 degrees, and with the right one on the
/// ground.
pub fn block() -> Made {
    // The top rises to +X, which is the figure's left: it faces +Z.
    let (near, tilt) = (0.03, libm::tan(core::f64::consts::FRAC_PI_6));
    let mut mesh = Mesh::block(DVec3::new(near, -0.5, -1.0), DVec3::new(2.0, 0.4, 1.0));
    for top in mesh.positions.iter_mut().filter(|p| p.y > 0.0) {
        top.y += (top.x - near) * tilt;
    }
    let block = Thing::solid(&Solid::Mesh(mesh), SurfaceKind::Stone, still)?;
    let (name, feet) = ("one foot on a block".into(), DVec3::Y * 0.4);
    let mut scene = scene(name, 0.0, vec![floor(still)?, block], feet);
    scene.input = Box::new(|_| ClimberInput::IDLE);
    Ok(scene)
}
