use bevy_ecs::prelude::*;
use bevy_time::Time;
use clamber_climber::{ClimberInput as Input, StepRules};
use clamber_fight::Fighter;

use super::component::ArenaFighter;
use super::resource::{FightArena, FightEvent};
use super::terrain::ArenaTerrain;
use crate::ClimberInput;
use crate::climber::LatchedInput;

/// Share by which the schedule's tick may differ from the arena's: a `Duration` rounds to nanoseconds.
const ROUNDING: f64 = 1e-4;

/// Steps the arena with the inputs of its fighters and the orders that were given, and tells what happened.
pub(super) fn step(
    time: Res<Time>,
    fight: Option<ResMut<FightArena>>,
    terrain: ArenaTerrain<'_, '_>,
    mut fighters: Query<(&ArenaFighter, &mut ClimberInput, &mut LatchedInput)>,
    mut warned: Local<bool>,
    mut commands: Commands,
) {
    let Some(mut fight) = fight else { return };
    let (tick, passed) = (fight.config().tick, time.delta_secs_f64());
    if (tick - passed).abs() > ROUNDING * tick && !std::mem::replace(&mut *warned, true) {
        tracing::warn!(
            "the arena's tick is {tick} s, and its schedule's is {passed} s: it runs too fast or too slowly. Insert \
             Time::<Fixed>::from_seconds with the arena's tick"
        );
    }
    let mut inputs = vec![Input::IDLE; fight.fighters().len()];
    for (fighter, mut input, mut latched) in &mut fighters {
        // The arena deals the blows itself.
        let (taken, _) = latched.take(input.bypass_change_detection());
        let all = fight.fighters();
        if let Ok(index) = all.binary_search_by_key(&fighter.0, Fighter::id) {
            inputs[index] = taken;
        }
    }
    let (arena, orders) = fight.take();
    let stepped = terrain.with(|terrain| {
        let events = arena.step_with(&inputs, &orders, terrain, &StepRules::default())?;
        Ok::<_, clamber_fight::ArenaError>(events.to_vec())
    });
    match stepped {
        Ok(events) => {
            for event in events.into_iter().map(FightEvent) {
                commands.queue(move |world: &mut World| {
                    world.write_message(event.clone());
                    world.trigger(event);
                });
            }
        }
        Err(error) => tracing::warn!("the arena stood still for a tick: {error}"),
    }
}
