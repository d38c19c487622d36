//! Events of this crate: messages for readers, and triggers for observers.

use bevy_ecs::prelude::*;

/// Writes an event as a message, and triggers it on its entity, when commands are applied. If the entity is gone by
/// then, the event is not triggered: an observer of an earlier event of the same tick may have despawned it.
pub(crate) fn tell<E>(commands: &mut Commands<'_, '_>, event: E)
where
    E: Message + Clone + for<'a> EntityEvent<Trigger<'a>: Default>,
{
    commands.queue(move |world: &mut World| {
        world.write_message(event.clone());
        if world.get_entity(event.event_target()).is_ok() {
            world.trigger(event);
        }
    });
}
