use clamber_colossus::CreatureEvent;
use clamber_fight::{Arena, ArenaEvent, Weapon};
use serde::{Deserialize, Serialize};

/// What happened in a fight so far, in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tally {
    /// How often the creature struck the climber.
    pub blows: u32,
    /// Arrows that were shot.
    pub arrows: u32,
    /// Arrows that struck the creature.
    pub arrow_hits: u32,
    /// Stabs that struck the creature.
    pub stabs: u32,
    /// Cuts that struck it.
    pub cuts: u32,
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

impl Tally {
    /// Takes in a tick of a fight.
    pub(super) fn tick(&mut self, arena: Option<&Arena>) {
        let Some(arena) = arena else {
            return;
        };
        for event in arena.events() {
            match event {
                ArenaEvent::Struck { .. } => self.blows += 1,
                ArenaEvent::Shot { .. } => self.arrows += 1,
                ArenaEvent::BrokenOff { .. } => self.broken_off += 1,
                ArenaEvent::Killed { .. } => self.killed = arena.tick(),
                ArenaEvent::Hit { weapon, damage, .. } => {
                    self.damage += damage;
                    match weapon {
                        Weapon::Arrow => self.arrow_hits += 1,
                        Weapon::Stab => self.stabs += 1,
                        Weapon::Cut => self.cuts += 1,
                        Weapon::Stone => {}
                    }
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
}
