use std::sync::Arc;

use bevy_asset::{AssetEvent, Assets};
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::Time;
use bevy_transform::components::Transform;
use clamber_colossus::{
    Brain, ColossusError, Creature, CreatureConfig, CreatureKind, Noise, Surroundings,
};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::Rig;
use glam::DVec3;

use super::ColossusBrain;
use super::component::{Colossus, ColossusBody};
use super::events::{tell_all, tell_struck};
use super::senses::{ColossusNoise, people};
use crate::climber::Touchable;
use crate::creature::transform;
use crate::{
    Climber, ClimberBlow, ClimberBody, ClimberInput, ClimberState, PosedSurface, RigJoints,
    WorldOrigin,
};

/// Gives new creatures their bodies, and takes over what the app or a file has changed.
pub(super) fn renew(
    (time, origin): (Res<Time>, Res<WorldOrigin>),
    brains: Res<Assets<ColossusBrain>>,
    mut loaded: MessageReader<AssetEvent<ColossusBrain>>,
    mut creatures: Query<(Entity, Ref<Colossus>, &RigJoints, Option<&mut ColossusBody>)>,
    transforms: Query<&Transform>,
    mut last_tick: Local<f64>,
    mut commands: Commands,
) {
    let tick = time.delta_secs_f64();
    if tick <= 0.0 {
        return;
    }
    // A brain counts in ticks.
    let has_other_ticks = std::mem::replace(&mut *last_tick, tick) != tick;
    let loaded: Vec<_> = loaded
        .read()
        .filter_map(|event| match event {
            AssetEvent::Added { id } | AssetEvent::Modified { id } => Some(*id),
            _ => None,
        })
        .collect();
    for (entity, colossus, joints, body) in &mut creatures {
        let Some(brain) = brains.get(&colossus.brain) else {
            continue;
        };
        if !(colossus.is_changed() || loaded.contains(&colossus.brain.id()) || has_other_ticks) {
            continue;
        }
        let Ok(root) = transforms.get(entity) else {
            tracing::error!("no creature for {entity}: it has no Transform");
            continue;
        };
        let before = body.as_ref().map(|body| &body.creature);
        let made = brain
            .for_ticks(tick)
            .map_err(ColossusError::from)
            .and_then(|brain| make(joints.rig(), brain, &colossus, root, origin.0, before));
        match (made, body) {
            (Ok(creature), Some(mut body)) => body.creature = creature,
            (Ok(creature), None) => {
                commands
                    .entity(entity)
                    .try_insert(ColossusBody { creature });
            }
            (Err(error), Some(_)) => {
                tracing::error!("creature {entity} keeps its brain: {error}");
            }
            (Err(error), None) => tracing::error!("no creature for {entity}: {error}"),
        }
    }
}

/// A creature where its root is, or where and as it was `before`.
fn make(
    rig: &Rig,
    brain: Brain,
    colossus: &Colossus,
    root: &Transform,
    origin: DVec3,
    before: Option<&Creature>,
) -> Result<Creature, ColossusError> {
    let kind = Arc::new(CreatureKind::new(rig, brain)?);
    let ahead = (root.rotation * Vec3::Z).as_dvec3();
    let config = CreatureConfig {
        position: origin + root.translation.as_dvec3(),
        yaw: libm::atan2(ahead.x, ahead.z),
        scale: f64::from(root.scale.x),
        seed: colossus.seed,
        arena: colossus.arena,
        most_slope: colossus.most_slope,
        sight: colossus.sight,
        ..CreatureConfig::default()
    };
    let Some(before) = before else {
        return Creature::new(kind, config);
    };
    let config = CreatureConfig {
        position: before.state().position(),
        yaw: before.state().yaw(),
        ..config
    };
    let mut creature = Creature::new(Arc::clone(&kind), config)?;
    if let Some(carried) = before.state().carry_over(before.kind(), &kind) {
        // If it is of another kind after all, it begins anew where it stands.
        let _ = creature.restore(carried);
    }
    Ok(creature)
}

/// The climbers that creatures sense and strike.
type Climbers<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        &'static ClimberBody,
        &'static ClimberState,
        &'static mut ClimberInput,
    ),
    With<Climber>,
>;

/// Lets a tick pass for every creature, in the order of their entities.
#[expect(clippy::too_many_arguments, reason = "a system's parameters")]
pub(super) fn step(
    origin: Res<WorldOrigin>,
    mut creatures: Query<(Entity, &RigJoints, &mut ColossusBody), With<Colossus>>,
    touchable: Touchable<'_, '_>,
    mut climbers: Climbers<'_, '_>,
    (surfaces, parents): (Query<(), With<PosedSurface>>, Query<&ChildOf>),
    mut noises: MessageReader<ColossusNoise>,
    mut transforms: Query<&mut Transform>,
    mut commands: Commands,
) {
    let noises: Vec<Noise> = noises.read().map(|noise| noise.heard(origin.0)).collect();
    let mut all: Vec<Entity> = creatures.iter().map(|(entity, ..)| entity).collect();
    all.sort_unstable();
    for entity in all {
        let Ok((_, joints, mut body)) = creatures.get_mut(entity) else {
            continue;
        };
        let seen = climbers
            .iter()
            .map(|(entity, body, state, _)| (entity, body, state));
        let people = people(seen, entity, &body.creature, &surfaces, &parents);
        let creature = &mut body.creature;
        let stepped = touchable.terrain(|terrain| {
            let around = Surroundings {
                terrain,
                creatures: &[],
                people: &people,
                noises: &noises,
            };
            creature.step(&around).map(|_| ())
        });
        if let Err(error) = stepped {
            tracing::warn!("creature {entity} stood still for a tick: {error}");
            continue;
        }
        tell_all(entity, creature, origin.0, &mut commands);
        for blow in &creature.report().blows {
            let Some(climber) = Entity::try_from_bits(blow.person) else {
                continue;
            };
            if let Ok((.., mut input)) = climbers.get_mut(climber) {
                input.strike(ClimberBlow {
                    velocity: blow.velocity.as_vec3(),
                    damage: blow.damage.clamp(0.0, 1.0) as f32,
                    by: Some(entity),
                });
            }
            tell_struck((entity, climber), creature, blow, origin.0, &mut commands);
        }
        if let Ok(mut root) = transforms.get_mut(entity) {
            root.set_if_neq(placed(creature.surface().world_from_model(), origin.0));
        }
        let locals = &body.creature.pose().transforms;
        for (joint, local) in joints.joints().iter().zip(locals) {
            // A joint that the app has despawned needs no pose.
            if let Ok(mut found) = transforms.get_mut(*joint) {
                found.set_if_neq(transform(local));
            }
        }
    }
}

fn placed(world_from_model: &Similarity, origin: DVec3) -> Transform {
    Transform {
        translation: (world_from_model.translation - origin).as_vec3(),
        rotation: world_from_model.rotation.as_quat(),
        scale: Vec3::splat(world_from_model.scale as f32),
    }
}
