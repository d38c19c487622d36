//! Creatures of 20 m to hold on to.

use clamber_climber::ClimberConfig;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::Obstacle;
use glam::DVec3;

use super::stage::{Scene, Thing, holding};
use crate::{Creature, SceneError};

/// Height of the creatures, metres.
const HEIGHT: f64 = 20.0;

/// A creature with a place on it to start from.
pub struct Mount {
    /// Clip that it plays.
    pub clip: &'static str,
    /// Height of the start, as a share of the creature's.
    pub height: f64,
    /// Direction from which the start is looked for.
    pub from: DVec3,
}

/// The creature 20 m high, playing a clip whose name contains the mount's; and where a climber starts:
/// a ball of radius `radius` that touches it.
///
/// # Errors
/// If the clip is missing, or nothing is found at the height.
pub fn mount(
    creature: &Creature,
    mount: &Mount,
    radius: f64,
) -> Result<(Thing, DVec3), SceneError> {
    let clip = creature.clip_like(&[mount.clip]);
    let clip = clip.ok_or("the creature has no such clip")?;
    let (mut place, ground) = creature.standing(HEIGHT)?;
    place.translation -= DVec3::Y * ground;
    // Clips are made for creatures of 2 m; by Froude's law larger ones are slower.
    let rate = 1.0 / (HEIGHT / 2.0).sqrt();
    let thing = Thing {
        mesh: creature.rig.collider.clone(),
        motion: Box::new(move |_| place),
        animation: Some((creature.rig.skeleton.clone(), clip.clone(), rate)),
    };
    let mut surface = SkinnedSurface::new(thing.mesh.clone());
    surface.teleport(&thing.palette(0.0)?, place)?;
    // Towards the nearest skin at that height.
    let eye = DVec3::Y * (mount.height * HEIGHT) + mount.from * (2.0 * HEIGHT);
    let mut found: Option<(f64, DVec3)> = None;
    for aside in 0..9 {
        let shift = mount.from.cross(DVec3::Y) * (f64::from(aside - 4) * 0.1 * HEIGHT);
        let hit = surface.cast_ray(eye + shift, -mount.from, 4.0 * HEIGHT);
        if let Some(hit) = hit
            && found.is_none_or(|(distance, _)| hit.distance < distance)
        {
            found = Some((hit.distance, hit.point + hit.normal * radius));
        }
    }
    let (_, start) = found.ok_or("nothing to hold at this height")?;
    Ok((thing, start))
}

/// Holds on to a creature and climbs: up for a second, still for a second, aside, down, and so on.
pub fn climb(creature: &Creature, at: &Mount, speed: f64) -> Result<Scene, SceneError> {
    let mut config = ClimberConfig::colossus_climber();
    config.stamina = None;
    if let Some(grip) = &mut config.grip {
        grip.climb_speed = speed;
        grip.hang_acceleration = 60.0;
    }
    let (thing, start) = mount(creature, at, config.body.radius)?;
    let aside = at.from.cross(DVec3::Y);
    let name = format!("{} at {speed} m/s", creature.name);
    let scene = Scene::new(name, 60.0, start, vec![thing], move |moment| {
        let climb = match (moment.time / 1.5) as u64 % 8 {
            0 | 4 => DVec3::Y,
            2 => aside,
            6 => -aside,
            3 => DVec3::NEG_Y,
            _ => DVec3::ZERO,
        };
        holding(DVec3::ZERO, climb)
    });
    Ok(Scene {
        config,
        grips_all: true,
        ..scene
    })
}
