//! Stabs: where they go, and when the blade is there.

use clamber_surface::geometry::WorldCapsule;
use clamber_surface::surface::{CastOptions, TargetMotion};
use clamber_world::{Attachment, Obstacle, SweepContact};
use glam::DVec3;

use super::{Around, Blade, BodyFrame, Fighter, SwordConfig, Target};
use crate::arena::{CreatureId, creature_obstacle, creature_of};

/// Where a stab begins to look for skin, from the centre of the climber's ball, as shares of the ball's radius: how far
/// ahead along the skin, and how far above it.
const ALONG: f64 = 0.9;
const ABOVE: f64 = 1.0;

impl SwordConfig {
    /// The blade with its tip where the stab goes.
    pub(super) fn struck(&self, frame: &BodyFrame, target: &Target) -> Blade {
        let below = self.below(frame);
        match target {
            Target::Skin(at) => {
                let into = at.offset_in_world().normalize_or(DVec3::NEG_Y);
                below.in_skin(at.point, into)
            }
            Target::Open | Target::Air => below,
        }
    }
}

impl Fighter {
    /// The point of the skin before it into which a stab would go: below where it stands, ahead of it, or before its
    /// hands. None behind terrain or another creature. The attachment's offset is a unit vector into the skin.
    pub(crate) fn stab_target(&self, around: &Around<'_>) -> Target {
        let Some(sword) = &self.config.sword else {
            return Target::Air;
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
            return Target::Air;
        };
        if around.hides(&[origin, from, hit.point], Some(creature)) {
            return Target::Air;
        }
        let obstacle = creature_obstacle(creature);
        let at = Attachment::new(obstacle, skin, &hit, hit.point);
        // The offset is where the blade goes from there.
        Target::Skin(at.moved_to(at.point + into))
    }

    /// Where a stab goes when it lands: to the skin for which it was meant, or, if that is too far away or behind
    /// something by now, to what is before it instead.
    pub(super) fn still_reached(&self, target: Target, around: &Around<'_>) -> Target {
        let (Some(sword), Target::Skin(at)) = (&self.config.sword, &target) else {
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

    /// Where a stab begins: at the body's middle; where it begins to look for skin, and in which direction.
    fn stab_way(&self) -> (DVec3, DVec3, DVec3) {
        let frame = BodyFrame::of(&self.climber);
        let holds = self.climber.state().mode.is_holding();
        let (along, into) = if holds {
            (DVec3::Y, DVec3::Z)
        } else {
            (DVec3::Z, DVec3::NEG_Y)
        };
        let radius = self.config.climber.body.radius;
        let from = frame.at((along * ALONG - into * ABOVE) * radius);
        (frame.origin, from, frame.direction(into))
    }

    /// The first skin that the blade below a falling body meets between two places of the body. `None` if terrain or
    /// another creature is in between.
    pub(super) fn plunge_contact(
        &self,
        frames: [BodyFrame; 2],
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
        let first = contacts.min_by(|a, b| a.1.time.total_cmp(&b.1.time).then(a.0.cmp(&b.0)));
        first.filter(|(creature, hit)| {
            // At the end of the tick, where what comes between is.
            let contact = &hit.contact;
            let place = around.now(*creature, &contact.material, contact.point, dt);
            !around.hides(&[frames[1].origin, place], Some(*creature))
        })
    }
}
