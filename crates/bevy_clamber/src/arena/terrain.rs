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
    /// Calls `step` with the terrain, by ascending id. The id of a `CustomObstacle` is the bits of its entity.
    pub fn with<T>(&self, step: impl FnOnce(&[(ObstacleId, &dyn Obstacle)]) -> T) -> T {
        self.touchable.terrain_by_id(step)
    }
}
