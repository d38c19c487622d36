//! Events and orders of an arena as log lines.

use clamber_fight::{Arena, ArenaEvent, CreatureId, FighterId, Order, Weapon, creature_obstacle};
use clamber_surface::mesh::TriangleId;
use clamber_world::ObstacleId;
use foxglove::messages::Log;
use foxglove::messages::log::Level::{Debug, Error, Info, Warning};

use super::ArenaInfo;
use crate::names::{ObstacleNames, Part, name_of};
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
        let orders = self.orders.iter().filter_map(|order| {
            let what = match order {
                // A creature or fighter that joins has an event of its own.
                Order::AddFighter { .. } | Order::AddCreature { .. } => return None,
                order => format!("{order:?}"),
            };
            Some(log(Debug, "order", what))
        });
        orders.chain(events).collect()
    }

    fn line(&self, event: &ArenaEvent) -> Option<Log> {
        let (level, who, what) = match event {
            ArenaEvent::Creature { creature, event } => {
                let what = creature_line(self.arena.creature(*creature)?, event)?;
                (Info, self.creature(*creature), what)
            }
            ArenaEvent::Climber { fighter, event } => {
                let named = |obstacle| self.obstacle(*fighter, obstacle);
                return Some(line(&self.fighter(*fighter), event, named));
            }
            ArenaEvent::Hit {
                by,
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
                let part = self.part(*creature, at.key);
                let what = format!("hit {part} with {weapon}: damage {damage:.3}");
                (Info, self.fighter(*by), what)
            }
            ArenaEvent::Struck {
                creature,
                fighter,
                velocity,
                damage,
                ..
            } => {
                let whom = self.fighter(*fighter);
                let speed = velocity.length();
                let what = format!("struck {whom}: {speed:.1} m/s, damage {damage:.3}");
                (Warning, self.creature(*creature), what)
            }
            ArenaEvent::Shot { by, projectile } => {
                let what = format!("shot projectile {}", projectile.0);
                (Debug, self.fighter(*by), what)
            }
            ArenaEvent::Stuck {
                projectile,
                obstacle,
                ..
            } => {
                let (id, name) = (projectile.0, name_of(self.names, *obstacle));
                let what = format!("projectile {id} sticks in {name}");
                (Debug, "arena".to_owned(), what)
            }
            ArenaEvent::CameLoose { projectile } => {
                let what = format!("projectile {} came loose", projectile.0);
                (Debug, "arena".to_owned(), what)
            }
            ArenaEvent::BrokenOff { fighter } => {
                let what = "broke off its attack".to_owned();
                (Warning, self.fighter(*fighter), what)
            }
            ArenaEvent::Died { fighter } => (Error, self.fighter(*fighter), "died".to_owned()),
            ArenaEvent::Rose { fighter } => {
                (Info, self.fighter(*fighter), "lives again".to_owned())
            }
            ArenaEvent::Killed { creature, by } => {
                let by = by.map(|by| format!(" by {}", self.fighter(by)));
                let what = format!("was killed{}", by.unwrap_or_default());
                (Error, self.creature(*creature), what)
            }
            ArenaEvent::CreatureJoined { creature } => {
                (Info, self.creature(*creature), "joined".to_owned())
            }
            ArenaEvent::CreatureLeft { creature } => {
                (Info, self.creature(*creature), "left".to_owned())
            }
            ArenaEvent::FighterJoined { fighter } => {
                (Info, self.fighter(*fighter), "joined".to_owned())
            }
            ArenaEvent::FighterLeft { fighter } => {
                (Info, self.fighter(*fighter), "left".to_owned())
            }
            ArenaEvent::Unheard { order } => {
                let what = format!("order {order} was for somebody who is not there");
                (Warning, "arena".to_owned(), what)
            }
            // An event that is newer than this list.
            other => (Info, "arena".to_owned(), format!("{other:?}")),
        };
        Some(log(level, &who, what))
    }

    fn creature(&self, creature: CreatureId) -> String {
        self.info.creature(creature.0 as usize)
    }

    fn fighter(&self, fighter: FighterId) -> String {
        self.info.fighter(fighter.0 as usize)
    }

    /// The name of a creature, with the joint that moves a triangle of its skin.
    fn part(&self, creature: CreatureId, triangle: u64) -> String {
        let name = self.creature(creature);
        let joint = || {
            let one = self.arena.creature(creature)?;
            let triangle = TriangleId(u32::try_from(triangle).ok()?);
            let joint = one.surface().mesh().joint_of(triangle)?;
            one.kind().skeleton().joints().get(joint.index())
        };
        match joint() {
            Some(joint) => format!("{name} ({})", joint.name),
            None => name,
        }
    }

    /// The name of an obstacle. If it is a creature and the fighter is on it, the name includes the part of the
    /// creature.
    fn obstacle(&self, fighter: FighterId, obstacle: ObstacleId) -> String {
        let name = name_of(self.names, obstacle);
        let on = || {
            let mut creatures = self.arena.creatures();
            let (_, creature) = creatures.find(|(id, _)| creature_obstacle(*id) == obstacle)?;
            let state = self.arena.fighter(fighter)?.climber().state();
            let part = Part::of(state, creature.surface().mesh())?;
            part.is_on(obstacle).then(|| {
                let joints = creature.kind().skeleton().joints();
                part.name(&name, |joint| {
                    Some(joints.get(joint.index())?.name.as_str())
                })
            })
        };
        on().unwrap_or(name)
    }
}
