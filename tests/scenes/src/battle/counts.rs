use clamber_colossus::CreatureEvent;
use clamber_fight::{ArenaEvent, Weapon};
use serde::{Deserialize, Serialize};

/// What happened in a battle so far, in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    /// Number of ticks.
    pub tick: u64,
    /// Consecutive ticks for which a rider has been on the ground.
    pub grounded: u32,
    /// How often a rider was dropped on the creature; 0 in a climb.
    pub drops: u32,
    /// How often the climber landed, on anything.
    pub landings: u32,
    /// How often a climber died or left the valley, and began again; 0 in a ride.
    pub deaths: u32,
    /// How often the creature struck the climber.
    pub blows: u32,
    /// Arrows that were shot.
    pub arrows: u32,
    /// Arrows that hit the creature.
    pub arrow_hits: u32,
    /// Stabs that hit the creature.
    pub stabs: u32,
    /// Stabs and other acts that were broken off.
    pub broken_off: u32,
    /// Damage done to weak points.
    pub damage: f64,
    /// Weak points that were used up.
    pub weak_points: u32,
    /// Plates that broke.
    pub plates: u32,
    /// Ticks until the creature was killed; 0 if it was not.
    pub killed: u64,
}

impl Counts {
    /// Adds an event of the arena's current tick.
    pub(super) fn add(&mut self, event: &ArenaEvent) {
        match event {
            ArenaEvent::Struck { .. } => self.blows += 1,
            ArenaEvent::Shot { .. } => self.arrows += 1,
            ArenaEvent::BrokenOff { .. } => self.broken_off += 1,
            ArenaEvent::Killed { .. } => self.killed = self.tick,
            ArenaEvent::Rose { .. } => self.deaths += 1,
            ArenaEvent::Hit { weapon, damage, .. } => {
                self.damage += damage;
                self.arrow_hits += u32::from(*weapon == Weapon::Arrow);
                self.stabs += u32::from(*weapon == Weapon::Stab);
            }
            ArenaEvent::Creature { event, .. } => match event {
                CreatureEvent::Hurt { used_up: true, .. } => self.weak_points += 1,
                CreatureEvent::Staggered { breaks: true, .. } => self.plates += 1,
                _ => {}
            },
            _ => {}
        }
    }
}
