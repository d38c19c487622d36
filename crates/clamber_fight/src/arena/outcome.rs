use clamber_colossus::Noise;
use clamber_world::MaterialPoint;
use glam::DVec3;

use super::{ArenaEvent, CreatureId, Weapon};
use crate::fighter::FighterId;
use crate::projectile::{Projectile, ProjectileId};

/// Results of weapons and projectiles in a tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outcome {
    pub(crate) hits: Vec<Hit>,
    pub(crate) events: Vec<ArenaEvent>,
    pub(crate) noises: Vec<Noise>,
    pub(crate) shot: Vec<Projectile>,
    /// The number that the next projectile gets.
    pub(crate) next: u64,
}

/// A hit whose damage is not yet done.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    pub(crate) by: FighterId,
    pub(crate) weapon: Weapon,
    pub(crate) projectile: Option<ProjectileId>,
    pub(crate) creature: CreatureId,
    pub(crate) at: MaterialPoint,
    pub(crate) place: DVec3,
    pub(crate) time: f64,
    pub(crate) damage: f64,
}

impl Outcome {
    /// The number that the next projectile will get.
    pub(crate) fn next_projectile(&self) -> ProjectileId {
        ProjectileId(self.next)
    }

    pub(crate) fn shoot(&mut self, projectile: Projectile) {
        self.next = self.next.wrapping_add(1);
        self.events.push(ArenaEvent::Shot {
            by: projectile.by,
            projectile: projectile.id,
        });
        self.shot.push(projectile);
    }

    pub(crate) fn clear(&mut self, next: u64) {
        self.hits.clear();
        self.events.clear();
        self.noises.clear();
        self.shot.clear();
        self.next = next;
    }
}
