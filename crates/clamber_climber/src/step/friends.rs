//! Climbers that overlap. Both give way, and no other climber is moved by it.

use clamber_mover::{IntoOthers, is_beside};
use clamber_world::{CharacterBody, Obstacle, ObstacleId};
use glam::DVec3;

use super::Tick;
use crate::ClimberConfig;
use crate::config::Others;
use crate::obstacle::{SAME_PLACE, between};

/// Maximum speed at which climbers part, radii a second: 2 m/s for a radius of 0.4 m.
const MAX_PARTING_SPEED: f64 = 5.0;

/// Maximum speed at which climbers that push each other part, as a multiple of the walking speed.
const PUSH_PARTING_FACTOR: f64 = 2.0;

/// Maximum speed at which climbers that pass each other part, radii a second.
const PASS_PARTING_SPEED: f64 = 1.25;

/// Share of the speed [`PASS_PARTING_SPEED`] up to which a climber stands still.
const STILL_SPEED_SHARE: f64 = 0.1;

/// Smallest level part of the unit direction between two bodies at which they part levelly.
const LEAST_LEVEL_PART: f64 = 0.1;

/// A climber as a character among others.
pub(crate) fn among_others(config: &ClimberConfig) -> IntoOthers {
    IntoOthers {
        up: config.up(),
        others: config.body.others,
        mass: config.body.mass,
    }
}

impl Tick<'_> {
    /// The displacement in this tick by which the climber parts from the climbers that it overlaps: from each by the
    /// other's share of their total mass. Walls stop it like any other movement.
    pub(super) fn parting(&self) -> DVec3 {
        if !self.mover.has_characters() {
            return DVec3::ZERO;
        }
        let (mut way, mut most) = (DVec3::ZERO, 0.0_f64);
        for (id, other) in self.others() {
            let others = self.config.body.others.between(other.others);
            let from = self.parting_from(id, &other, others);
            if from != DVec3::ZERO {
                way += from;
                most = most.max(self.parting_at_most(others));
            }
        }
        way.clamp_length_max(most)
    }

    /// Maximum displacement in a tick by which the climber parts from others, metres.
    fn parting_at_most(&self, others: Others) -> f64 {
        let slow = MAX_PARTING_SPEED * self.config.body.radius;
        let speed = match others {
            Others::Block => slow,
            // As fast as two climbers can walk against each other.
            Others::Push => slow.max(PUSH_PARTING_FACTOR * self.config.ground.walk_speed),
            Others::Pass => PASS_PARTING_SPEED * self.config.body.radius,
        };
        speed * self.dt()
    }

    /// True if this climber or the other one moves on its own.
    fn is_passing(&self, other: &CharacterBody) -> bool {
        let slow = PASS_PARTING_SPEED * STILL_SPEED_SHARE * self.config.body.radius;
        let own = self.before.velocity - self.before.base_velocity;
        self.input.walk != DVec3::ZERO || own.length().max(other.own_velocity.length()) > slow
    }

    fn others(&self) -> impl Iterator<Item = (ObstacleId, CharacterBody)> {
        let all = self.obstacles.iter();
        let all = all.filter_map(|(id, obstacle)| Some((*id, *obstacle, obstacle.character()?)));
        let solid = all.filter(|(id, obstacle, _)| self.is_stopped_by(*id, *obstacle));
        solid.map(|(id, _, other)| (id, other))
    }

    /// False for another climber that the rule for contacts lets pass.
    fn is_stopped_by(&self, id: ObstacleId, other: &dyn Obstacle) -> bool {
        if self.judge.rules.contact.is_none() {
            return true;
        }
        // The other is where it will be at the end of the tick, and so is this climber.
        let contact = other.closest_point(self.expected, f64::INFINITY);
        contact.is_none_or(|contact| self.judge.rule(id, other, &contact).solid)
    }

    fn parting_from(&self, id: ObstacleId, other: &CharacterBody, softness: Others) -> DVec3 {
        if softness == Others::Pass && self.is_passing(other) {
            return DVec3::ZERO;
        }
        let body = self.body();
        // A climber on the head of one that stands up is placed there.
        let placed = self.carried.as_ref().filter(|carried| !carried.swept);
        let capsule = body.at(placed.map_or(self.before.position, |carried| carried.position));
        let apart = between(&other.capsule, &capsule);
        let up = self.config.up();
        let least = other.capsule.radius.min(capsule.radius);
        let is_beside = is_beside(&capsule, &other.capsule, up);
        // A climber that stands on another one is pressed onto it by less than the margin. Climbers beside each other
        // both give way at the same depth.
        let slack = if is_beside {
            body.margin * (least / capsule.radius)
        } else {
            body.margin
        };
        let depth = other.capsule.radius + capsule.radius - apart.distance - slack;
        let all = other.mass + self.config.body.mass;
        if depth.is_nan() || depth <= 0.0 || all <= 0.0 {
            return DVec3::ZERO;
        }
        let away = if is_beside || apart.distance < least {
            let level = apart.away - up * apart.away.dot(up);
            let is_apart = apart.distance > SAME_PLACE * capsule.radius;
            if is_apart && level.length() > LEAST_LEVEL_PART {
                level.normalize_or_zero()
            } else {
                let otherwise = if is_apart { apart.away } else { DVec3::ZERO };
                self.side_of(id).unwrap_or(otherwise)
            }
        } else {
            apart.away
        };
        // The lighter climber gives way more, and no faster than the maximum.
        let [own, others] = [other.mass, self.config.body.mass].map(|mass| mass / all);
        away * (own * depth.min(self.parting_at_most(softness) / own.max(others)))
    }

    /// The side to which the climber parts from another one at the same place: opposite for the two. `None` without an
    /// id of its own, since both would then go to the same side in every tick.
    fn side_of(&self, id: ObstacleId) -> Option<DVec3> {
        let own = self.judge.rules.id.filter(|own| *own != id)?;
        let side = self.config.up().any_orthonormal_vector();
        Some(if own < id { -side } else { side })
    }
}
