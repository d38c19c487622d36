//! Walls and ledges to hold, and what else happens to a climber.

use std::error::Error;

use clamber_climber::{Blow, ClimberConfig, ClimberInput, ClimberMode};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::SurfaceKind;
use glam::DVec3;

use super::stage::{Moment, Scene, Thing};
use crate::controllers::{Solid, shifted};

fn still(_: f64) -> Similarity {
    Similarity::IDENTITY
}

fn climber() -> ClimberConfig {
    let mut config = ClimberConfig::colossus_climber();
    config.stamina = None;
    config.body.height = 0.9;
    config
}

/// A wall with its face at z = 0, which the climber is in front of at z < 0.
fn block(low: DVec3, high: DVec3) -> Solid {
    Solid::Block { low, high }
}

fn floor() -> Result<Thing, Box<dyn Error>> {
    Thing::solid(&Solid::floor(60.0), SurfaceKind::Stone, still)
}

fn furred() -> Result<Thing, Box<dyn Error>> {
    let wall = block(DVec3::new(-50.0, -40.0, 0.0), DVec3::new(50.0, 60.0, 8.0));
    Thing::solid(&wall, SurfaceKind::Fur, still)
}

/// Climbs a wall of fur: `way` is in world space, its length the share of 1.5 m/s; +Y is up, -X to the right.
///
/// # Errors
/// None.
pub fn wall(way: DVec3) -> Result<Scene, Box<dyn Error>> {
    Ok(Scene {
        name: format!("wall at {:.2} m/s", 1.5 * way.length()),
        seconds: 6.0,
        config: climber(),
        start: DVec3::new(0.0, 2.0, -0.41),
        things: vec![furred()?],
        grips_all: false,
        input: Box::new(move |moment| ClimberInput {
            grip: true,
            walk: if moment.time < 0.2 {
                DVec3::Z
            } else {
                DVec3::ZERO
            },
            climb: if moment.time > 1.0 { way } else { DVec3::ZERO },
            ..ClimberInput::IDLE
        }),
    })
}

/// Hangs from fur that shakes sideways with so many hertz and metres.
///
/// # Errors
/// None.
pub fn hang(hertz: f64, size: f64) -> Result<Scene, Box<dyn Error>> {
    let wall = block(DVec3::new(-50.0, -40.0, 0.0), DVec3::new(50.0, 60.0, 8.0));
    let motion = move |time: f64| {
        let time = (time - 1.0).max(0.0);
        // Not at once.
        let grown = (time / 0.5).min(1.0);
        let angle = core::f64::consts::TAU * hertz * time;
        shifted(DVec3::X * (size * grown * grown * libm::sin(angle)))
    };
    Ok(Scene {
        name: format!("hang at {hertz} Hz"),
        seconds: 8.0,
        config: climber(),
        start: DVec3::new(0.0, 2.0, -0.41),
        things: vec![Thing::solid(&wall, SurfaceKind::Fur, motion)?],
        grips_all: false,
        input: Box::new(|_| ClimberInput {
            grip: true,
            ..ClimberInput::IDLE
        }),
    })
}

/// Towards the ledge, until it is caught.
fn towards(moment: &Moment<'_>) -> DVec3 {
    if moment.state.mode == ClimberMode::Falling {
        DVec3::Z
    } else {
        DVec3::ZERO
    }
}

fn cliff() -> Result<Thing, Box<dyn Error>> {
    let cliff = block(DVec3::new(-50.0, -2.0, 0.0), DVec3::new(50.0, 3.0, 8.0));
    Thing::solid(&cliff, SurfaceKind::Stone, still)
}

/// Jumps at a ledge 3 m above the ground, hangs, and moves along it to the right after a second and a half.
///
/// # Errors
/// None.
pub fn ledge() -> Result<Scene, Box<dyn Error>> {
    Ok(Scene {
        name: "ledge".into(),
        seconds: 5.0,
        config: climber(),
        start: DVec3::new(0.0, 2.2, -0.42),
        things: vec![floor()?, cliff()?],
        grips_all: false,
        input: Box::new(|moment| ClimberInput {
            grip: true,
            walk: towards(moment),
            climb: if moment.time > 1.5 {
                DVec3::NEG_X
            } else {
                DVec3::ZERO
            },
            ..ClimberInput::IDLE
        }),
    })
}

/// Hangs from a ledge, and pulls itself up.
///
/// # Errors
/// None.
pub fn mantle() -> Result<Scene, Box<dyn Error>> {
    let mut scene = ledge()?;
    scene.name = "mantle".into();
    scene.input = Box::new(|moment| ClimberInput {
        grip: true,
        walk: if moment.time > 1.5 && moment.state.mode == ClimberMode::LedgeHanging {
            DVec3::Z
        } else {
            towards(moment)
        },
        ..ClimberInput::IDLE
    });
    Ok(scene)
}

/// Stands, jumps after half a second, and falls from another 3 m.
///
/// # Errors
/// None.
pub fn fall() -> Result<Scene, Box<dyn Error>> {
    let top = block(DVec3::new(-3.0, 2.0, -3.0), DVec3::new(3.0, 3.0, 1.0));
    Ok(Scene {
        name: "jump and fall".into(),
        seconds: 3.5,
        config: climber(),
        start: DVec3::new(0.0, 3.42, 0.0),
        things: vec![floor()?, Thing::solid(&top, SurfaceKind::Stone, still)?],
        grips_all: false,
        input: Box::new(|moment| ClimberInput {
            walk: if moment.time > 0.4 && moment.time < 1.4 {
                DVec3::Z
            } else {
                DVec3::ZERO
            },
            jump: (0.5..0.52).contains(&moment.time),
            ..ClimberInput::IDLE
        }),
    })
}

/// Steps off a wall of half a metre.
///
/// # Errors
/// None.
pub fn step_off() -> Result<Scene, Box<dyn Error>> {
    let top = block(DVec3::new(-3.0, -1.0, -3.0), DVec3::new(3.0, 0.45, 0.6));
    Ok(Scene {
        name: "steps off".into(),
        seconds: 3.0,
        config: climber(),
        start: DVec3::new(0.0, 0.86, 0.0),
        things: vec![floor()?, Thing::solid(&top, SurfaceKind::Stone, still)?],
        grips_all: false,
        input: Box::new(|moment| ClimberInput {
            walk: if moment.time > 0.4 && moment.time < 1.4 {
                DVec3::Z * 0.5
            } else {
                DVec3::ZERO
            },
            ..ClimberInput::IDLE
        }),
    })
}

/// Stands before a wall of fur, grips it, climbs, shakes, holds again, lets go and lands.
///
/// # Errors
/// None.
pub fn all_holds() -> Result<Scene, Box<dyn Error>> {
    let wall = block(DVec3::new(-50.0, -4.0, 0.0), DVec3::new(50.0, 60.0, 8.0));
    let motion = |time: f64| {
        let shakes = ((time - 3.0) / 0.4).clamp(0.0, 1.0) * ((5.0 - time) / 0.4).clamp(0.0, 1.0);
        shifted(DVec3::X * (0.2 * shakes * libm::sin(12.0 * (time - 3.0))))
    };
    Ok(Scene {
        name: "all holds".into(),
        seconds: 9.0,
        config: climber(),
        start: DVec3::new(0.0, 0.42, -0.5),
        things: vec![floor()?, Thing::solid(&wall, SurfaceKind::Fur, motion)?],
        grips_all: false,
        input: Box::new(|moment| ClimberInput {
            grip: moment.time > 0.8 && moment.time < 7.5,
            walk: if moment.time < 1.0 && moment.time > 0.6 {
                DVec3::Z
            } else {
                DVec3::ZERO
            },
            climb: match moment.time {
                1.0..1.6 => DVec3::Y,
                6.2..6.6 => DVec3::NEG_Y,
                _ => DVec3::ZERO,
            },
            ..ClimberInput::IDLE
        }),
    })
}

/// Hangs from a ledge, lets go, falls and lands.
///
/// # Errors
/// None.
pub fn drop_off() -> Result<Scene, Box<dyn Error>> {
    let mut scene = ledge()?;
    scene.name = "drops off a ledge".into();
    scene.input = Box::new(|moment| ClimberInput {
        grip: moment.time < 1.5,
        walk: if moment.time < 1.5 {
            towards(moment)
        } else {
            DVec3::ZERO
        },
        ..ClimberInput::IDLE
    });
    Ok(scene)
}

/// Stands, and is knocked over; tumbles, lies and gets up.
///
/// # Errors
/// None.
pub fn knock() -> Result<Scene, Box<dyn Error>> {
    Ok(Scene {
        name: "knocked over".into(),
        seconds: 5.0,
        config: climber(),
        start: DVec3::new(0.0, 0.42, 0.0),
        things: vec![floor()?],
        grips_all: false,
        input: Box::new(|moment| ClimberInput {
            blow: (0.499..0.512).contains(&moment.time).then_some(Blow {
                velocity: DVec3::new(1.0, 3.0, -5.0),
                damage: 0.1,
                by: None,
            }),
            ..ClimberInput::IDLE
        }),
    })
}

/// Walks under a ceiling of 1.2 m.
///
/// # Errors
/// None.
pub fn crouch() -> Result<Scene, Box<dyn Error>> {
    let ceiling = block(DVec3::new(-3.0, -3.0, 0.0), DVec3::new(3.0, 3.0, 12.0));
    // Comes down on whoever stands below it.
    let motion =
        |time: f64| shifted(DVec3::Y * (4.2 + (1.6 - 0.8 * time).max(0.0)) - DVec3::Z * 6.0);
    Ok(Scene {
        name: "crouched under a ceiling".into(),
        seconds: 4.0,
        config: climber(),
        start: DVec3::new(0.0, 0.42, 0.0),
        things: vec![
            floor()?,
            Thing::solid(&ceiling, SurfaceKind::Stone, motion)?,
        ],
        grips_all: false,
        input: Box::new(|_| ClimberInput::IDLE),
    })
}

/// Is pressed to the ground.
///
/// # Errors
/// None.
pub fn squeeze() -> Result<Scene, Box<dyn Error>> {
    let ceiling = block(DVec3::new(-3.0, -3.0, 0.0), DVec3::new(3.0, 3.0, 12.0));
    let motion =
        |time: f64| shifted(DVec3::Y * (3.6 + (1.6 - 0.8 * time).max(0.0)) - DVec3::Z * 6.0);
    Ok(Scene {
        name: "crushed".into(),
        seconds: 4.0,
        config: climber(),
        start: DVec3::new(0.0, 0.42, 0.0),
        things: vec![
            floor()?,
            Thing::solid(&ceiling, SurfaceKind::Stone, motion)?,
        ],
        grips_all: false,
        input: Box::new(|_| ClimberInput::IDLE),
    })
}
