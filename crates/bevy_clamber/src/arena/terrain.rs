use bevy_ecs::entity::Entity;
use bevy_ecs::system::SystemParam;
use clamber_world::{Obstacle, ObstacleId};

use crate::climber::Touchable;

/// The terrain that an arena's fighters, creatures and arrows can touch: the worlds of physics engines, and
/// [`CustomObstacle`](crate::CustomObstacle)s. For a game that steps its arena itself, such as in a rollback session.
///
/// ```
/// # use bevy_ecs::prelude::*;
/// use bevy_clamber::clamber_climber::ClimberInput;
/// use bevy_clamber::prelude::*;
///
/// fn step(mut fight: ResMut<FightArena>, terrain: ArenaTerrain) -> Result<(), BevyError> {
///     let inputs = vec![ClimberInput::IDLE; fight.fighters().len()];
///     terrain.with(|terrain| fight.arena_mut().step(&inputs, terrain).map(drop))?;
///     Ok(())
/// }
/// # let _ = step;
/// ```
#[derive(SystemParam)]
pub struct ArenaTerrain<'w, 's> {
    touchable: Touchable<'w, 's>,
}

impl ArenaTerrain<'_, '_> {
    /// Calls `step` with the terrain, by ascending id. A [`CustomObstacle`](crate::CustomObstacle) has the id of its
    /// [`TerrainId`](crate::TerrainId); without one, an id above all of these, in the order of spawning.
    pub fn with<T>(&self, step: impl FnOnce(&[(ObstacleId, &dyn Obstacle)]) -> T) -> T {
        self.touchable.terrain_by_id(step)
    }

    /// The entity of the [`CustomObstacle`](crate::CustomObstacle) with an id, as the arena's states and events have
    /// it; `None` for everything else.
    pub fn entity(&self, id: ObstacleId) -> Option<Entity> {
        self.touchable.numbered(id)
    }
}
