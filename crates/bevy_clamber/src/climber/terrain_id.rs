//! The numbers by which a fight's state names terrain: not by entities, which are others in each session.

use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::*;
use bevy_ecs::world::DeferredWorld;
use bevy_reflect::prelude::*;
use clamber_world::ObstacleId;

/// The number by which a fight's state refers to this [`CustomObstacle`](crate::CustomObstacle), such as where a
/// fighter stands or an arrow sticks. Each must be the only one with its number.
///
/// Without it, an obstacle has the number of its spawning: the first one has the first number. That is enough for a
/// state that stays in its session. A state that is saved, and a peer, need the same number for the same obstacle: give
/// it here where obstacles do not always come in the same order, for example if they are loaded.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Reflect)]
#[reflect(Component, Clone, Debug, PartialEq, Hash)]
pub struct TerrainId(pub u32);

impl TerrainId {
    /// The id of the terrain with this number, in states and events of a fight.
    pub const fn obstacle(self) -> ObstacleId {
        ObstacleId(self.0 as u64)
    }
}

/// The number of an obstacle's spawning.
#[derive(Component, Clone, Copy, Debug)]
pub(crate) struct SpawnNumber(u32);

/// Smallest id of terrain without a [`TerrainId`]: above all of these.
const FIRST_SPAWNED: u64 = 1 << 32;

/// The number that the next obstacle gets.
#[derive(Resource, Default)]
struct NextSpawned(u32);

/// Numbers an obstacle when it is spawned.
pub(super) fn number(mut world: DeferredWorld<'_>, context: HookContext) {
    world.commands().queue(move |world: &mut World| {
        let mut next = world.get_resource_or_init::<NextSpawned>();
        let number = next.0;
        next.0 = number.saturating_add(1);
        if let Ok(mut entity) = world.get_entity_mut(context.entity) {
            entity.insert(SpawnNumber(number));
        }
    });
}

/// The id of terrain in a fight; `None` for terrain that has not got its number yet.
pub(crate) fn terrain_obstacle(
    given: Option<&TerrainId>,
    spawned: Option<&SpawnNumber>,
) -> Option<ObstacleId> {
    let by_order = |spawned: &SpawnNumber| ObstacleId(FIRST_SPAWNED + u64::from(spawned.0));
    given
        .copied()
        .map(TerrainId::obstacle)
        .or_else(|| spawned.map(by_order))
}
