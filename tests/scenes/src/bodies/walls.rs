//! Walls and ledges to hold, falls, blows and ceilings.

use clamber_climber::{ClimberInput, ClimberMode, Knockback};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::SurfaceKind;
use glam::DVec3;

use super::stage::{Moment, Scene, Thing, floor, holding, still, walking, when};
use crate::SceneError;
use crate::controllers::{Solid, shifted};

type Made<T> = Result<T, SceneError>;

/// Start of a climber that is in the air before a wall.
const BEFORE: DVec3 = DVec3::new(0.0, 2.0, -0.41);

/// Start of a climber that stands on the ground.
const STANDING: DVec3 = DVec3::new(0.0, 0.42, 0.0);

fn stone(low: [f64; 3], high: [f64; 3]) -> Made<Thing> {
    Thing::solid(&Solid::block(low, high), SurfaceKind::Stone, still)
}

/// A wall of fur with its face at z = 0; the climber is at z < 0.
fn fur(low: f64, motion: impl Fn(f64) -> Similarity + 'static) -> Made<Thing> {
    let wall = Solid::block([-50.0, low, 0.0], [50.0, 60.0, 8.0]);
    Thing::solid(&wall, SurfaceKind::Fur, motion)
}

/// Climbs a wall of fur: `way` is in world space, its length the share of 1.5 m/s; +Y is up, -X to the right.
pub fn wall(way: DVec3) -> Made<Scene> {
    let name = format!("wall at {:.2} m/s", 1.5 * way.length());
    let things = vec![fur(-40.0, still)?];
    Ok(Scene::new(name, 6.0, BEFORE, things, move |moment| {
        let walk = when(moment.time < 0.2, DVec3::Z);
        holding(walk, when(moment.time > 1.0, way))
    }))
}

/// Hangs from fur that shakes sideways with this frequency, hertz, and amplitude, metres.
pub fn hang(hertz: f64, size: f64) -> Made<Scene> {
    let motion = move |time: f64| {
        let time = (time - 1.0).max(0.0);
        // Not at once.
        let grown = (time / 0.5).min(1.0);
        let angle = core::f64::consts::TAU * hertz * time;
        shifted(DVec3::X * (size * grown * grown * libm::sin(angle)))
    };
    let name = format!("hang at {hertz} Hz");
    let things = vec![fur(-40.0, motion)?];
    Ok(Scene::new(name, 8.0, BEFORE, things, |_| {
        holding(DVec3::ZERO, DVec3::ZERO)
    }))
}

/// Towards the ledge, until it is caught.
fn towards(moment: &Moment<'_>) -> DVec3 {
    when(moment.state.mode == ClimberMode::Falling, DVec3::Z)
}

/// A scene before a ledge 3 m above the ground.
fn at_a_ledge(name: &str, input: impl Fn(&Moment<'_>) -> ClimberInput + 'static) -> Made<Scene> {
    let wall = stone([-50.0, -2.0, 0.0], [50.0, 3.0, 8.0])?;
    let things = vec![floor(still)?, wall];
    let start = DVec3::new(0.0, 2.2, -0.42);
    Ok(Scene::new(name, 5.0, start, things, input))
}

/// Jumps at a ledge 3 m above the ground, hangs, and moves along it to the right after a second and a half.
pub fn ledge() -> Made<Scene> {
    at_a_ledge("ledge", |moment| {
        holding(towards(moment), when(moment.time > 1.5, DVec3::NEG_X))
    })
}

/// Hangs from a ledge, and pulls itself up.
pub fn mantle() -> Made<Scene> {
    at_a_ledge("mantle", |moment| {
        let hangs = moment.state.mode == ClimberMode::LedgeHanging;
        let pulls = when(moment.time > 1.5 && hangs, DVec3::Z);
        holding(towards(moment) + pulls, DVec3::ZERO)
    })
}

/// Hangs from a ledge, lets go, falls and lands.
pub fn drop_off() -> Made<Scene> {
    at_a_ledge("drops off a ledge", |moment| ClimberInput {
        grip: moment.time < 1.5,
        ..walking(when(moment.time < 1.5, towards(moment)))
    })
}

/// Stands, jumps after half a second, and falls from another 3 m.
pub fn fall() -> Made<Scene> {
    let things = vec![floor(still)?, stone([-3.0, 2.0, -3.0], [3.0, 3.0, 1.0])?];
    let start = DVec3::new(0.0, 3.42, 0.0);
    Ok(Scene::new("jump and fall", 3.5, start, things, |moment| {
        ClimberInput {
            jump: (0.5..0.52).contains(&moment.time),
            ..walking(when(moment.time > 0.4 && moment.time < 1.4, DVec3::Z))
        }
    }))
}

/// Steps off a wall of half a metre.
pub fn step_off() -> Made<Scene> {
    let wall = stone([-3.0, -1.0, -3.0], [3.0, 0.45, 0.6])?;
    let things = vec![floor(still)?, wall];
    let start = DVec3::new(0.0, 0.86, 0.0);
    Ok(Scene::new("steps off", 3.0, start, things, |moment| {
        let walks = moment.time > 0.4 && moment.time < 1.4;
        walking(when(walks, DVec3::Z * 0.5))
    }))
}

/// Stands before a wall of fur, grips it, climbs, shakes, holds again, lets go and lands.
pub fn all_holds() -> Made<Scene> {
    let motion = |time: f64| {
        let shakes = ((time - 3.0) / 0.4).clamp(0.0, 1.0) * ((5.0 - time) / 0.4).clamp(0.0, 1.0);
        shifted(DVec3::X * (0.2 * shakes * libm::sin(12.0 * (time - 3.0))))
    };
    let things = vec![floor(still)?, fur(-4.0, motion)?];
    let start = STANDING - DVec3::Z * 0.5;
    Ok(Scene::new("all holds", 9.0, start, things, |moment| {
        let walk = when(moment.time < 1.0 && moment.time > 0.6, DVec3::Z);
        let climb = match moment.time {
            1.0..1.6 => DVec3::Y,
            6.2..6.6 => DVec3::NEG_Y,
            _ => DVec3::ZERO,
        };
        ClimberInput {
            grip: moment.time > 0.8 && moment.time < 7.5,
            ..holding(walk, climb)
        }
    }))
}

/// Stands, and is knocked over; tumbles, lies and gets up.
pub fn knock() -> Made<Scene> {
    let things = vec![floor(still)?];
    let mut scene = Scene::new("knocked over", 5.0, STANDING, things, |_| {
        ClimberInput::IDLE
    });
    scene.knockback = Some(Knockback {
        velocity: DVec3::new(1.0, 3.0, -5.0),
        damage: 0.1,
        by: None,
    });
    Ok(scene)
}

/// A ceiling that comes down to this height of its middle on a climber that stands, metres.
fn below_a_ceiling(name: &str, low: f64) -> Made<Scene> {
    let motion =
        move |time: f64| shifted(DVec3::Y * (low + (1.6 - 0.8 * time).max(0.0)) - DVec3::Z * 6.0);
    let ceiling = Solid::block([-3.0, -3.0, 0.0], [3.0, 3.0, 12.0]);
    let ceiling = Thing::solid(&ceiling, SurfaceKind::Stone, motion)?;
    let things = vec![floor(still)?, ceiling];
    Ok(Scene::new(name, 4.0, STANDING, things, |_| {
        ClimberInput::IDLE
    }))
}

/// Crouches under a ceiling of 1.2 m, which comes down.
pub fn crouch() -> Made<Scene> {
    below_a_ceiling("crouched under a ceiling", 4.2)
}

/// Is pressed to the ground.
pub fn squeeze() -> Made<Scene> {
    below_a_ceiling("crushed", 3.6)
}
