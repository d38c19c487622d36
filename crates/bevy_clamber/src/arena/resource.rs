use std::ops::Deref;

use bevy_ecs::prelude::*;
use clamber_fight::{Arena, ArenaEvent, Order};

/// The fight: an [`Arena`] that [`ArenaPlugin`](super::ArenaPlugin) steps once a tick. Make the arena with its
/// creatures and fighters, and insert it as a resource.
///
/// ```
/// # use std::sync::Arc;
/// use bevy_clamber::clamber_colossus::{Brain, CreatureConfig, CreatureKind};
/// use bevy_clamber::clamber_fight::{Arena, ArenaConfig, FighterConfig};
/// use bevy_clamber::prelude::*;
/// # use bevy_clamber::glam::DVec3;
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::components::Transform;
///
/// #[derive(Resource)]
/// struct Giant(RigAssets);
///
/// fn spawn(mut commands: Commands, giant: Res<Giant>) -> Result<(), BevyError> {
///     let rig = giant.0.rig();
///     let brain = Brain::from_json(&std::fs::read_to_string("assets/colossus.brain.json")?, 1.0 / 60.0)?;
///     let kind = Arc::new(CreatureKind::new(rig, brain)?);
///
///     let mut arena = Arena::new(ArenaConfig::default())?;
///     let creature = arena.add_creature(kind, CreatureConfig::default())?;
///     let fighter = arena.add_fighter(FighterConfig::hero(), DVec3::new(0.0, 1.0, 30.0))?;
///     commands.insert_resource(FightArena::new(arena));
///
///     let spawned = giant.0.spawn(&mut commands, Transform::IDENTITY);
///     commands.entity(spawned.root).insert(ArenaCreature(creature));
///     commands.spawn(ArenaFighter(fighter));
///     Ok(())
/// }
/// # let _ = spawn;
/// ```
///
/// The game changes the fight by [`FightArena::order`]. To save, load and roll back, use the arena itself:
/// [`FightArena::arena_mut`]. Do it before [`ClamberSystems::Climb`](crate::ClamberSystems::Climb): entities show it in
/// the same tick then, otherwise in the next.
#[derive(Resource, Clone, Debug)]
pub struct FightArena {
    arena: Arena,
    orders: Vec<Order>,
}

impl FightArena {
    /// A fight in this arena.
    pub fn new(arena: Arena) -> Self {
        Self {
            arena,
            orders: Vec::new(),
        }
    }

    /// Gives an order: it is followed at the beginning of the next tick, after those that were given before it. If one
    /// of a tick's orders cannot be followed, the arena stands still for that tick, and a warning tells why.
    pub fn order(&mut self, order: Order) {
        self.orders.push(order);
    }

    pub(super) fn take(&mut self) -> (&mut Arena, Vec<Order>) {
        (&mut self.arena, std::mem::take(&mut self.orders))
    }

    /// The arena, to restore a state or to step it otherwise than by the plugin.
    pub fn arena_mut(&mut self) -> &mut Arena {
        &mut self.arena
    }
}

impl Deref for FightArena {
    type Target = Arena;

    fn deref(&self) -> &Arena {
        &self.arena
    }
}

/// An event in the [`FightArena`]: written as a message, and triggered for observers, in the tick in which it happened.
/// Its places are in clamber's world space: Bevy's world space plus [`WorldOrigin`](crate::WorldOrigin).
#[derive(Event, Message, Clone, Debug, PartialEq)]
pub struct FightEvent(pub ArenaEvent);
