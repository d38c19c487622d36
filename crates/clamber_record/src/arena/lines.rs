//! Events and orders of an arena as log lines.

use clamber_colossus::Creature;
use clamber_fight::{
    Arena, ArenaEvent as Event, CreatureId, FighterId, Order, Weapon, creature_obstacle,
};
use clamber_world::{MaterialPoint, ObstacleId};
use foxglove::messages::Log;
use foxglove::messages::log::Level;

use super::ArenaInfo;
use crate::names::{ObstacleNames, name_of, part_name};
use crate::views::{creature_line, line, log};

/// The data from which log lines are made.
pub(super) struct Words<'a> {
    pub(super) arena: &'a Arena,
    /// Orders of the last step.
    pub(super) orders: &'a [Order],
    pub(super) info: &'a ArenaInfo,
    /// Names of creatures, fighters, and the terrain that the caller has named.
    pub(super) names: &'a ObstacleNames,
}

impl Words<'_> {
    /// The log lines of the last step.
    pub(super) fn lines(&self) -> Vec<Log> {
        let events = self.arena.events().iter();
        let events = events.filter_map(|event| self.line(event));
        let orders = self.orders.iter().filter_map(|order| match order {
            // A creature or fighter that joins has an event of its own.
            Order::AddFighter { .. } | Order::AddCreature { .. } => None,
            order => Some(log(Level::Debug, "order", format!("{order:?}"))),
        });
        orders.chain(events).collect()
    }

    fn line(&self, event: &Event) -> Option<Log> {
        if let Event::Climber { fighter, event } = event {
            let named = |obstacle| self.obstacle(*fighter, obstacle);
            return Some(line(&self.fighter(*fighter), event, named));
        }
        Some(log(level(event), &self.who(event), self.what(event)?))
    }

    /// The name of the creature or fighter that an event is about.
    fn who(&self, event: &Event) -> String {
        match event {
            Event::Creature { creature, .. }
            | Event::Struck { creature, .. }
            | Event::Killed { creature, .. }
            | Event::CreatureJoined { creature }
            | Event::CreatureLeft { creature } => self.creature(*creature),
            Event::Hit { by: fighter, .. }
            | Event::Shot { by: fighter, .. }
            | Event::BrokenOff { fighter }
            | Event::Died { fighter }
            | Event::Rose { fighter }
            | Event::FighterJoined { fighter }
            | Event::FighterLeft { fighter } => self.fighter(*fighter),
            _ => "arena".to_owned(),
        }
    }

    /// The text of an event that is not a climber's own; `None` for a creature's frequent events.
    fn what(&self, event: &Event) -> Option<String> {
        Some(match event {
            Event::Creature { creature, event } => {
                creature_line(self.arena.creature(*creature)?, event)?
            }
            Event::Hit {
                weapon,
                creature,
                at,
                damage,
                ..
            } => {
                let weapon = match weapon {
                    Weapon::Cut => "a cut",
                    Weapon::Stab => "a stab",
                    Weapon::Arrow => "an arrow",
                    Weapon::Stone => "a stone",
                };
                let joint = self.arena.creature(*creature);
                let joint = joint.and_then(|creature| joint_name(creature, at));
                let part = part_name(&self.creature(*creature), joint);
                format!("hit {part} with {weapon}: damage {damage:.3}")
            }
            Event::Struck {
                fighter,
                velocity,
                damage,
                ..
            } => {
                let (whom, speed) = (self.fighter(*fighter), velocity.length());
                format!("struck {whom}: {speed:.1} m/s, damage {damage:.3}")
            }
            Event::Shot { projectile, .. } => format!("shot projectile {}", projectile.0),
            Event::Stuck {
                projectile,
                obstacle,
                ..
            } => {
                let (id, name) = (projectile.0, name_of(self.names, *obstacle));
                format!("projectile {id} sticks in {name}")
            }
            Event::CameLoose { projectile } => format!("projectile {} came loose", projectile.0),
            Event::BrokenOff { .. } => "broke off its attack".to_owned(),
            Event::Died { .. } => "died".to_owned(),
            Event::Rose { .. } => "lives again".to_owned(),
            Event::Killed { by, .. } => {
                let by = by.map(|by| format!(" by {}", self.fighter(by)));
                format!("was killed{}", by.unwrap_or_default())
            }
            Event::CreatureJoined { .. } | Event::FighterJoined { .. } => "joined".to_owned(),
            Event::CreatureLeft { .. } | Event::FighterLeft { .. } => "left".to_owned(),
            Event::Unheard { order } => {
                format!("order {order} was for somebody who is not there")
            }
            // An event that is newer than this list.
            other => format!("{other:?}"),
        })
    }

    fn creature(&self, creature: CreatureId) -> String {
        self.info.creature(creature.0 as usize)
    }

    fn fighter(&self, fighter: FighterId) -> String {
        self.info.fighter(fighter.0 as usize)
    }

    /// The name of an obstacle. If it is a creature and the fighter is on it, the name includes the part of the
    /// creature.
    fn obstacle(&self, fighter: FighterId, obstacle: ObstacleId) -> String {
        let name = name_of(self.names, obstacle);
        let mut creatures = self.arena.creatures();
        let creature = creatures.find(|(id, _)| creature_obstacle(*id) == obstacle);
        let fighter = self.arena.fighter(fighter);
        let support = fighter.and_then(|fighter| fighter.climber().state().support);
        match (creature, support) {
            (Some((_, creature)), Some(support)) if support.attachment.obstacle == obstacle => {
                let joint = joint_name(creature, &support.attachment.material);
                part_name(&name, joint.filter(|name| !name.is_empty()))
            }
            _ => name,
        }
    }
}

/// The name of the joint that moves a point of a creature's skin; `None` if the skin there is gone.
fn joint_name<'a>(creature: &'a Creature, point: &MaterialPoint) -> Option<&'a str> {
    let joint = creature.surface().mesh().joint_of(point.triangle()?)?;
    let joint = creature.kind().skeleton().joints().get(joint.index())?;
    Some(joint.name.as_str())
}

fn level(event: &Event) -> Level {
    match event {
        Event::Died { .. } | Event::Killed { .. } => Level::Error,
        Event::Struck { .. } | Event::BrokenOff { .. } | Event::Unheard { .. } => Level::Warning,
        Event::Shot { .. } | Event::Stuck { .. } | Event::CameLoose { .. } => Level::Debug,
        _ => Level::Info,
    }
}
