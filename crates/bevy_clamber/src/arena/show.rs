use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::components::Transform;
use glam::DVec3;

use super::component::{ArenaCreature, ArenaFighter, ArenaProjectile, placed};
use super::resource::FightArena;
use super::terrain::ArenaTerrain;
use crate::creature::transform;
use crate::{RigJoints, WorldOrigin};

/// Writes the transforms of creatures.
pub(super) fn creatures(
    fight: Option<Res<FightArena>>,
    origin: Res<WorldOrigin>,
    roots: Query<(Entity, &ArenaCreature, &RigJoints)>,
    mut transforms: Query<&mut Transform>,
) {
    let Some(fight) = fight else { return };
    for (entity, shown, joints) in &roots {
        let Some(creature) = fight.creature(shown.0) else {
            continue;
        };
        let place = creature.surface().world_from_model();
        if let Ok(mut root) = transforms.get_mut(entity) {
            root.set_if_neq(Transform {
                translation: (place.translation - origin.0).as_vec3(),
                rotation: place.rotation.as_quat(),
                scale: Vec3::splat(place.scale as f32),
            });
        }
        let locals = &creature.pose().transforms;
        for (joint, local) in joints.joints().iter().zip(locals) {
            // A joint that the app has despawned needs no pose.
            if let Ok(mut found) = transforms.get_mut(*joint) {
                found.set_if_neq(transform(local));
            }
        }
    }
}

/// Writes the transforms of fighters.
pub(super) fn fighters(
    fight: Option<Res<FightArena>>,
    origin: Res<WorldOrigin>,
    mut shown: Query<(&ArenaFighter, &mut Transform)>,
) {
    let Some(fight) = fight else { return };
    for (shown, mut found) in &mut shown {
        if let Some(fighter) = fight.fighter(shown.0) {
            let (state, up) = (fighter.climber().state(), fighter.climber().config().up());
            found.set_if_neq(placed(state.position, state.heading, up, &origin));
        }
    }
}

/// Spawns, moves and despawns entities for arrows and stones.
pub(super) fn projectiles(
    fight: Option<Res<FightArena>>,
    origin: Res<WorldOrigin>,
    terrain: ArenaTerrain<'_, '_>,
    mut shown: Query<(Entity, &ArenaProjectile, &mut Transform)>,
    mut commands: Commands,
) {
    let all = fight.as_ref().map_or(&[][..], |fight| fight.projectiles());
    // The arena's projectiles are in ascending order of their ids, but entities are in no order.
    let mut is_shown = vec![false; all.len()];
    for (entity, projectile, mut found) in &mut shown {
        let index = all.binary_search_by_key(&projectile.0, |one| one.id).ok();
        let place = index.zip(fight.as_ref()).and_then(|(index, fight)| {
            is_shown[index] = true;
            terrain.with(|terrain| fight.place(&all[index], terrain))
        });
        match (index, place) {
            (_, Some(place)) => {
                let there = placed(place.tip, place.direction, DVec3::Y, &origin);
                found.set_if_neq(there);
            }
            // The entity stays where it was until its arena drops the projectile.
            (Some(_), None) => {}
            (None, _) => commands.entity(entity).try_despawn(),
        }
    }
    let Some(fight) = &fight else { return };
    for (projectile, _) in all.iter().zip(&is_shown).filter(|(_, shown)| !**shown) {
        if let Some(place) = terrain.with(|terrain| fight.place(projectile, terrain)) {
            commands.spawn((
                ArenaProjectile(projectile.id),
                placed(place.tip, place.direction, DVec3::Y, &origin),
            ));
        }
    }
}
