//! Where a stab would go.

use clamber_world::{MaterialPoint, Obstacle, ObstacleId};
use glam::DVec3;

use super::member::skins_of;
use super::{Arena, CreatureId, Skins, creature_of};
use crate::fighter::{Around, FighterId, Target};

/// A point of a creature's skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aimed {
    /// The creature.
    pub creature: CreatureId,
    /// The point of its skin.
    pub at: MaterialPoint,
    /// Where that is, in world space.
    pub place: DVec3,
    /// The open weak point that a hit there would hurt, by its index.
    pub weak_point: Option<usize>,
    /// The whole plate that would take the hit instead, by its index.
    pub plate: Option<usize>,
}

impl Arena {
    /// Where a fighter's stab would go if it struck now, among the terrain of the last step: for a mark on the screen,
    /// and for bots. `None` without a sword, and if no skin is in reach.
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
        let Target::Skin(at) = fighter.stab_target(&around) else {
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
