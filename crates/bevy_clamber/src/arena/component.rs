use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;
use clamber_fight::{CreatureId, FighterId, ProjectileId};

use crate::climber::LatchedInput;
use crate::{ClimberInput, WorldOrigin};

/// Shows a creature of the [`FightArena`](super::FightArena): insert it on the root of a rig that
/// [`RigAssets::spawn`](crate::RigAssets::spawn) spawned from the creature's file, beside its
/// [`RigJoints`](crate::RigJoints). In each tick the plugin writes the `Transform`s of root and joints.
///
/// The arena has its own skin to be touched: the entity needs no [`SkinnedCollider`](crate::SkinnedCollider), unless
/// something beside the fight is to touch it.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArenaCreature(pub CreatureId);

/// Shows a fighter of the [`FightArena`](super::FightArena), and takes its input. In each tick the plugin writes its
/// `Transform`: the centre of the climber's ball, with -Z along its heading.
///
/// Fill its [`ClimberInput`], or let [`ClimberControls`](crate::ClimberControls) do it. `actions` has the bits of
/// [`clamber_fight::actions`]. A blow in it is ignored, so [`ClimberInput::strike`] does nothing: give the arena an
/// [`Order::Strike`](clamber_fight::Order::Strike) by [`FightArena::order`](super::FightArena::order).
/// [`ClimberRule`](crate::ClimberRule), [`ClimberModes`](crate::ClimberModes) and [`AirVelocity`](crate::AirVelocity)
/// have no effect on it. With a [`ClimberFigure`](crate::ClimberFigure), it is drawn as a humanoid.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[require(Transform, ClimberInput, LatchedInput)]
pub struct ArenaFighter(pub FighterId);

/// Shows an arrow or a stone of the [`FightArena`](super::FightArena). The plugin spawns an entity for each projectile,
/// and despawns it with the projectile. In each tick it writes the entity's `Transform`: the tip, with -Z along the
/// direction. To give it a mesh, observe `Add<ArenaProjectile>`.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[require(Transform)]
pub struct ArenaProjectile(pub ProjectileId);

/// A place in Bevy's world, with -Z along a direction.
pub(super) fn placed(
    place: glam::DVec3,
    ahead: glam::DVec3,
    up: glam::DVec3,
    origin: &WorldOrigin,
) -> Transform {
    Transform::from_translation((place - origin.0).as_vec3())
        .looking_to(ahead.as_vec3(), up.as_vec3())
}
