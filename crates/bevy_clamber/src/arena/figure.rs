use bevy_ecs::prelude::*;
use bevy_time::Time;
use bevy_transform::components::Transform;
use clamber_body::BodyInput;
use clamber_fight::creature_obstacle;
use clamber_world::{Obstacle, ObstacleId};

use super::component::ArenaFighter;
use super::resource::FightArena;
use super::terrain::ArenaTerrain;
use crate::{ClimberFigure, WorldOrigin};

/// Poses the figures of fighters where the last tick left them, on creatures as that tick left them: both are drawn so.
pub(super) fn pose(
    (time, origin): (Res<Time>, Res<WorldOrigin>),
    fight: Option<Res<FightArena>>,
    terrain: ArenaTerrain<'_, '_>,
    mut figures: Query<(Entity, &ArenaFighter, &mut ClimberFigure)>,
    mut transforms: Query<&mut Transform>,
    mut told: Local<bool>,
    mut commands: Commands,
) {
    let Some(fight) = fight else { return };
    for (entity, shown, mut figure) in &mut figures {
        let Some(fighter) = fight.fighter(shown.0) else {
            continue;
        };
        let figure = figure.bypass_change_detection();
        let look_at = figure.look_at.map(|at| at.as_dvec3() + origin.0);
        let posed = terrain.with(|terrain| {
            let creatures = fight
                .creatures()
                .map(|(id, creature)| (creature_obstacle(id), creature.surface() as &dyn Obstacle));
            let all: Vec<(ObstacleId, &dyn Obstacle)> =
                terrain.iter().copied().chain(creatures).collect();
            figure.update(
                &BodyInput {
                    state: fighter.climber().state(),
                    config: fighter.climber().config(),
                    obstacles: &all,
                    look_at,
                },
                time.delta_secs_f64(),
            )
        });
        match posed {
            Ok(()) => figure.write(entity, &origin, &mut transforms, &mut commands),
            Err(error) if !std::mem::replace(&mut *told, true) => {
                tracing::warn!("the figure of {entity} cannot be posed: {error}");
            }
            Err(_) => {}
        }
    }
}
