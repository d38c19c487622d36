//! One tick of the projectiles.

use clamber_colossus::Noise;
use clamber_surface::geometry::WorldCapsule;
use clamber_surface::surface::TargetMotion;
use clamber_world::{Obstacle, ObstacleId, SweepContact};
use glam::DVec3;

use super::stuck::{place_on, stick};
use super::{
    Ballistics, Projectile, ProjectileBody, ProjectileKind, ProjectileMotion, ProjectilePlace,
};
use crate::arena::{ArenaEvent, Hit, Outcome, Skins, Weapon, creature_obstacle, creature_of};

/// Seconds after which a projectile in flight is removed.
const LONGEST_FLIGHT: f64 = 20.0;
/// Seconds after which a falling arrow is removed.
const LONGEST_FALL: f64 = 10.0;

/// Slack of [`Attachment::follow`](clamber_world::Attachment::follow) for arrows in terrain, metres: the distance by
/// which terrain may be displaced, beside its motion, without losing the arrow.
const FOLLOW_SLACK: f64 = 0.01;

/// The obstacles and forces that projectiles meet in a tick.
#[derive(Clone, Copy)]
pub(crate) struct Air<'a> {
    pub(crate) skins: Skins<'a>,
    pub(crate) terrain: &'a [(ObstacleId, &'a dyn Obstacle)],
    pub(crate) gravity: DVec3,
    pub(crate) dt: f64,
}

/// Whether a projectile still exists after a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flown {
    There,
    Gone,
}

impl<'a> Air<'a> {
    /// The obstacle with an id.
    pub(crate) fn obstacle(&self, id: ObstacleId) -> Option<&'a dyn Obstacle> {
        if let Some(creature) = creature_of(id) {
            let skin: &'a dyn Obstacle = self.skins.get(creature)?;
            return Some(skin);
        }
        let found = self.terrain.iter().find(|(known, _)| *known == id);
        found.map(|(_, obstacle)| *obstacle)
    }

    /// The first contact of a ball over the tick with moving terrain and skins. At equal times the smaller id wins.
    fn first_contact(
        &self,
        from: DVec3,
        way: DVec3,
        radius: f64,
    ) -> Option<(ObstacleId, &'a dyn Obstacle, SweepContact)> {
        let ball = WorldCapsule::ball(from, radius);
        let creatures = self.skins.iter().map(|(creature, skin)| {
            let obstacle: &'a dyn Obstacle = skin;
            (creature_obstacle(creature), obstacle)
        });
        let all = self.terrain.iter().copied().chain(creatures);
        let hits = all.filter_map(|(id, obstacle)| {
            let is_near = obstacle.bounds().is_none_or(|(center, size)| {
                let middle = from + way * 0.5;
                middle.distance(center)
                    <= size + radius + 0.5 * way.length() + ball.sweep_tolerance()
            });
            if !is_near {
                return None;
            }
            let hit = obstacle.cast_capsule(&ball, [way; 2], TargetMotion::Moving)?;
            Some((id, obstacle, hit))
        });
        hits.min_by(|a, b| a.2.fraction.total_cmp(&b.2.fraction).then(a.0.cmp(&b.0)))
    }
}

impl Projectile {
    /// Advances the projectile by one tick.
    pub(crate) fn step(&mut self, air: &Air<'_>, out: &mut Outcome) -> Flown {
        self.seconds += air.dt;
        match self.motion {
            ProjectileMotion::Flying { position, velocity } => {
                self.fly([position, velocity], air, out)
            }
            ProjectileMotion::Stuck { .. } => {
                self.stay(air, out);
                Flown::There
            }
            ProjectileMotion::Falling {
                position,
                velocity,
                direction,
            } => {
                let flight = Ballistics {
                    gravity: air.gravity,
                    drag: 0.0,
                };
                let (to, velocity) = flight.step(position, velocity, air.dt);
                let radius = self.body.radius;
                let meets = air.first_contact(position, to - position, radius);
                // For half a second, it may still touch the obstacle from which it has just come loose.
                let ends = meets.is_some_and(|(.., hit)| !hit.started_inside || self.seconds > 0.5);
                if ends || self.seconds > LONGEST_FALL || !to.is_finite() {
                    return Flown::Gone;
                }
                self.motion = ProjectileMotion::Falling {
                    position: to,
                    velocity,
                    direction,
                };
                Flown::There
            }
        }
    }

    fn fly(&mut self, [position, velocity]: [DVec3; 2], air: &Air<'_>, out: &mut Outcome) -> Flown {
        let ProjectileBody {
            radius,
            drag,
            depth,
            ..
        } = self.body;
        let flight = Ballistics {
            gravity: air.gravity,
            drag,
        };
        let (to, faster) = flight.step(position, velocity, air.dt);
        let Some((id, obstacle, hit)) = air.first_contact(position, to - position, radius) else {
            if self.seconds > LONGEST_FLIGHT || !to.is_finite() {
                return Flown::Gone;
            }
            self.motion = ProjectileMotion::Flying {
                position: to,
                velocity: faster,
            };
            return Flown::There;
        };
        let at_contact = velocity + (faster - velocity) * hit.fraction;
        let motion = obstacle.motion(&hit.contact.material, air.dt);
        let relative = at_contact - motion.map_or(DVec3::ZERO, |motion| motion.velocity);
        self.hit(id, &hit, relative, out);
        if self.kind == ProjectileKind::Stone {
            return Flown::Gone;
        }
        let direction = at_contact.normalize_or(DVec3::NEG_Y);
        let Some(motion) = stick(id, obstacle, &hit, direction, depth, air.dt) else {
            return Flown::Gone;
        };
        self.motion = motion;
        self.seconds = 0.0;
        out.events.push(ArenaEvent::Stuck {
            projectile: self.id,
            obstacle: id,
            place: hit.contact.point,
        });
        Flown::There
    }

    /// Records the hit on a creature, and the noise of the impact. `velocity` is relative to the material that was hit.
    fn hit(&self, id: ObstacleId, hit: &SweepContact, velocity: DVec3, out: &mut Outcome) {
        let weapon = match self.kind {
            ProjectileKind::Arrow => Weapon::Arrow,
            ProjectileKind::Stone => Weapon::Stone,
        };
        let ProjectileBody {
            damage,
            speed: full,
            loudness,
            ..
        } = self.body;
        let damage = damage * (velocity.length_squared() / (full * full).max(f64::MIN_POSITIVE));
        if loudness > 0.0 {
            let place = hit.contact.point;
            out.noises.push(Noise { place, loudness });
        }
        if let Some(creature) = creature_of(id) {
            out.hits.push(Hit {
                by: self.by,
                weapon,
                projectile: Some(self.id),
                creature,
                at: hit.contact.material,
                place: hit.contact.point,
                time: hit.fraction,
                damage,
            });
        }
    }

    /// Keeps a stuck arrow in its material, or lets it fall if the material is gone.
    fn stay(&mut self, air: &Air<'_>, out: &mut Outcome) {
        let ProjectileMotion::Stuck { at, direction } = &mut self.motion else {
            return;
        };
        let is_there = match creature_of(at.obstacle) {
            Some(creature) => air.skins.get(creature).is_some_and(|skin| {
                let triangle = at.material.triangle();
                triangle.is_some_and(|triangle| skin.is_enabled(triangle))
            }),
            // Terrain does not tell whether its material is there. It is gone if the attachment cannot follow it.
            None => air
                .obstacle(at.obstacle)
                .is_some_and(|obstacle| at.follow(obstacle, air.dt, FOLLOW_SLACK).is_some()),
        };
        if !is_there {
            let _ = direction;
            self.fall(air, out);
        }
    }

    /// Comes loose from skin that is removed in this step. It falls from rest: the skin's motion is not saved, so the
    /// result must not depend on it here.
    pub(crate) fn drop_from(&mut self, skin: &dyn Obstacle, out: &mut Outcome) {
        let ProjectileMotion::Stuck { at, direction } = self.motion else {
            return;
        };
        let place = place_on(&at, direction, skin).unwrap_or(ProjectilePlace {
            tip: at.position(),
            direction: at.frame * direction,
        });
        self.motion = ProjectileMotion::Falling {
            position: place.tip,
            velocity: DVec3::ZERO,
            direction: place.direction,
        };
        self.seconds = 0.0;
        out.events.push(ArenaEvent::CameLoose {
            projectile: self.id,
        });
    }

    /// Comes loose, with the velocity of the material that it stuck in.
    pub(crate) fn fall(&mut self, air: &Air<'_>, out: &mut Outcome) {
        let ProjectileMotion::Stuck { at, direction } = self.motion else {
            return;
        };
        let loose =
            |position: DVec3, velocity: DVec3, frame: glam::DQuat| ProjectileMotion::Falling {
                position,
                velocity,
                direction: frame * direction,
            };
        let still = loose(at.position(), DVec3::ZERO, at.frame);
        let skin = creature_of(at.obstacle).and_then(|creature| air.skins.get(creature));
        self.motion = match skin {
            // Disabled triangles, as of a broken plate, have a motion as well.
            Some(skin) => {
                let anchor = at.material.anchor_on(skin);
                let motion = anchor.and_then(|anchor| skin.in_world().motion(&anchor, air.dt).ok());
                motion.map_or(still, |motion| {
                    // The tip turns about the point of the skin.
                    let arm = motion.frame * at.offset;
                    let velocity = motion.velocity + motion.angular_velocity.cross(arm);
                    loose(motion.position + arm, velocity, motion.frame)
                })
            }
            None => {
                let motion = air
                    .obstacle(at.obstacle)
                    .and_then(|o| o.motion(&at.material, air.dt));
                motion.map_or(still, |motion| {
                    loose(at.position(), motion.velocity, at.frame)
                })
            }
        };
        self.seconds = 0.0;
        out.events.push(ArenaEvent::CameLoose {
            projectile: self.id,
        });
    }
}

#[cfg(test)]
mod tests;
