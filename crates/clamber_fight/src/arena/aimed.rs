//! The point that a stab would hit.

use clamber_world::{MaterialPoint, Obstacle, ObstacleId};
use glam::DVec3;

use super::member::skins_of;
use super::{Arena, CreatureId, Skins, creature_of};
use crate::fighter::{Around, FighterId, StabTarget};

/// A point of a creature's skin at which a stab aims.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aimed {
    /// The creature whose skin the stab would hit.
    pub creature: CreatureId,
    /// The point of the creature's skin that the stab would hit: a place on the skin, which moves with it.
    pub at: MaterialPoint,
    /// The point's position after the last step, in world space, metres.
    pub place: DVec3,
    /// Index in [`CreatureKind::weak_points`](clamber_colossus::CreatureKind::weak_points) of the open weak point that
    /// a hit there would hurt; `None` without one.
    pub weak_point: Option<usize>,
    /// Index in [`CreatureKind::plates`](clamber_colossus::CreatureKind::plates) of the unbroken plate that would take
    /// the hit instead; `None` without one.
    pub plate: Option<usize>,
}

impl Arena {
    /// The point that a fighter's stab would hit if it struck now: for a mark on the screen, and for bots. Give it the
    /// terrain of the last step. `None` without a sword, if no skin is in reach, or if terrain or another creature is
    /// in between.
    pub fn stab_aim(
        &self,
        fighter: FighterId,
        terrain: &[(ObstacleId, &dyn Obstacle)],
    ) -> Option<Aimed> {
        let fighter = self.fighter(fighter)?;
        let skins = skins_of(&self.creatures);
        let around = Around {
            skins: Skins(&skins),
            terrain,
        };
        let StabTarget::Skin(at) = fighter.stab_target(&around) else {
            return None;
        };
        let id = creature_of(at.obstacle)?;
        let (weak_point, plate) = self.creature(id)?.struck_at(&at.material, at.point);
        Some(Aimed {
            creature: id,
            at: at.material,
            place: at.point,
            weak_point,
            plate,
        })
    }
}
