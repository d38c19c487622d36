//! Stabs: their target, and the blade's contact.

use clamber_surface::geometry::WorldCapsule;
use clamber_surface::surface::{CastOptions, TargetMotion};
use clamber_world::{Attachment, Obstacle, SweepContact};
use glam::DVec3;

use super::{Around, Blade, Fighter, FighterFrame, StabTarget, SwordConfig};
use crate::arena::{CreatureId, creature_obstacle, creature_of};

/// Distance from the centre of the climber's ball along the surface at which a stab looks for skin, in radii of the
/// ball: ahead of a standing climber, above one on a hold.
const SKIN_SEARCH_DISTANCE: f64 = 0.9;
/// Distance from the ball's centre away from the surface at which the ray for skin begins, in radii of the ball.
const RAY_START_HEIGHT: f64 = 1.0;

impl SwordConfig {
    /// The blade with its tip at the stab's target.
    pub(super) fn struck(&self, frame: &FighterFrame, target: &StabTarget) -> Blade {
        let below = self.below(frame);
        match target {
            StabTarget::Skin(at) => {
                let into = at.offset_in_world().normalize_or(DVec3::NEG_Y);
                below.in_skin(at.point, into)
            }
            StabTarget::Open | StabTarget::Air => below,
        }
    }
}

impl Fighter {
    /// The point of skin that a stab would hit: ahead of the feet, or in front of the hands on a hold.
    /// [`StabTarget::Air`] without a sword, if no skin is in reach, or if terrain or another creature is in between.
    /// The attachment's offset is a unit vector into the skin.
    pub(crate) fn stab_target(&self, around: &Around<'_>) -> StabTarget {
        let Some(sword) = &self.config.sword else {
            return StabTarget::Air;
        };
        let (origin, from, into) = self.stab_way();
        let hits = around.skins.iter().filter_map(|(creature, skin)| {
            let hit = Obstacle::cast_ray(skin, from, into, sword.reach)?;
            Some((hit, creature, skin))
        });
        let first = hits.min_by(|a, b| {
            let by_distance = a.0.distance.total_cmp(&b.0.distance);
            by_distance.then(a.1.cmp(&b.1))
        });
        let Some((hit, creature, skin)) = first else {
            return StabTarget::Air;
        };
        if around.hides(&[origin, from, hit.point], Some(creature)) {
            return StabTarget::Air;
        }
        let obstacle = creature_obstacle(creature);
        let at = Attachment::new(obstacle, skin, &hit, hit.point);
        // The offset is the direction of the blade from the point.
        StabTarget::Skin(at.moved_to(at.point + into))
    }

    /// The target of a stab when it lands. If the chosen point of skin is too far away by now, or hidden by an
    /// obstacle, the stab gets a new target.
    pub(super) fn still_reached(&self, target: StabTarget, around: &Around<'_>) -> StabTarget {
        let (Some(sword), StabTarget::Skin(at)) = (&self.config.sword, &target) else {
            return target;
        };
        let (origin, from, _) = self.stab_way();
        let far = sword.reach + from.distance(origin);
        let is_near = at.point.distance(origin) <= far;
        if is_near && !around.hides(&[origin, from, at.point], creature_of(at.obstacle)) {
            return target;
        }
        self.stab_target(around)
    }

    /// The centre of the climber's ball, the origin of the ray for skin, and the ray's direction.
    fn stab_way(&self) -> (DVec3, DVec3, DVec3) {
        let frame = FighterFrame::of(&self.climber);
        let holds = self.climber.state().mode.is_holding();
        let (along, into) = if holds {
            (DVec3::Y, DVec3::Z)
        } else {
            (DVec3::Z, DVec3::NEG_Y)
        };
        let radius = self.config.climber.body.radius;
        let from = frame.at((along * SKIN_SEARCH_DISTANCE - into * RAY_START_HEIGHT) * radius);
        (frame.origin, from, frame.direction(into))
    }

    /// The first skin that the blade below a falling body touches while the body goes from one frame to the other.
    /// `None` if terrain or another creature is in between.
    pub(super) fn plunge_contact(
        &self,
        frames: [FighterFrame; 2],
        around: &Around<'_>,
        dt: f64,
    ) -> Option<(CreatureId, SweepContact)> {
        let sword = self.config.sword.as_ref()?;
        let [from, to] = frames.map(|frame| sword.below(&frame));
        let capsule = WorldCapsule {
            ends: [from.hilt, from.tip],
            radius: sword.radius,
        };
        let ways = [to.hilt - from.hilt, to.tip - from.tip];
        let options =
            CastOptions::from(TargetMotion::Moving).with_tolerance(capsule.sweep_tolerance());
        let contacts = around.skins.iter().filter_map(|(creature, skin)| {
            let hit = skin.in_world().cast_capsule(&capsule, ways, &options)?;
            Some((creature, SweepContact::from(hit)))
        });
        let first =
            contacts.min_by(|a, b| a.1.fraction.total_cmp(&b.1.fraction).then(a.0.cmp(&b.0)));
        first.filter(|(creature, hit)| {
            // The point is taken at the end of the tick, where the rays see obstacles.
            let contact = &hit.contact;
            let place = around.now(*creature, &contact.material, contact.point, dt);
            !around.hides(&[frames[1].origin, place], Some(*creature))
        })
    }
}
