//! Moving ground carries a creature: a ship that turns, a lift that rises.

use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use clamber_world::{MaterialPoint, PointMotion};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

use super::check_way::{CHECK_INTERVAL, FREE_WAY_FACTOR};
use super::state::{is_far, is_fast};
use super::{Creature, Surroundings};
use crate::angle::nearest_turn;
use crate::feet::Carried;

/// Ground carries the creature if it is within this distance above or below the creature's origin, as a share of the
/// creature's height.
const CARRYING_DISTANCE: f64 = 0.15;

/// Distance ahead of the origin, and behind and to both sides of it, at which the motion of the ground is compared with
/// that below the origin, as a share of the creature's height.
const COMPARED_DISTANCE: f64 = 0.12;

/// Largest difference between these motions for ground that moves as one, as a share of the distance that the ground
/// moved.
const ALIKE_MOTION_SHARE: f64 = 0.1;

/// How near the previous position of the remembered ground point must be to the place where it was, as a share of the
/// creature's height. Farther away, it is another point.
const SAME_POINT_DISTANCE: f64 = 1e-6;

/// The point of the ground that carries a creature, and its motion in the last tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct MovingGround {
    /// The remembered point of the ground, whose motion carries the creature.
    point: Option<GroundPoint>,
    /// How the ground carried the creature in the last tick.
    drift: Drift,
}

/// A point of the ground.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct GroundPoint {
    /// Index of the obstacle in the terrain of the last step.
    obstacle: u32,
    /// Number of obstacles in that terrain.
    among: u32,
    material: MaterialPoint,
    /// Position of the point at the end of the last step, in world space.
    at: DVec3,
}

/// Velocity with which moving ground carries a creature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Drift {
    /// Metres a second, in world space.
    velocity: DVec3,
    /// Radians a second, positive to the left.
    yaw_rate: f64,
}

impl MovingGround {
    /// Where a place is after some seconds if the ground goes on as in the last tick; the creature is at `origin`.
    pub(super) fn carry(&self, place: Similarity, origin: DVec3, seconds: f64) -> Similarity {
        self.drift.carry(place, origin, seconds)
    }

    /// True if the point and its motion are numbers that a creature reaches.
    pub(super) fn is_within_range(&self) -> bool {
        let drift = &self.drift;
        !self.point.is_some_and(|point| is_far(point.at))
            && !is_fast(drift.yaw_rate)
            && !is_fast(drift.velocity.length())
    }
}

impl Drift {
    /// Where a place is after some seconds if it moves with ground that drifts like this at `origin`: on a circle, if
    /// the ground turns.
    fn carry(&self, place: Similarity, origin: DVec3, seconds: f64) -> Similarity {
        if *self == Self::default() {
            return place;
        }
        let angle = self.yaw_rate * seconds;
        let half = 0.5 * angle;
        // Length of an arc's chord relative to the arc.
        let chord = if half == 0.0 {
            1.0
        } else {
            libm::sin(half) / half
        };
        let way = rotation_from_axis_angle(DVec3::Y, half) * self.velocity.with_y(0.0) * chord;
        let way = way.with_y(self.velocity.y) * seconds;
        let turn = rotation_from_axis_angle(DVec3::Y, angle);
        Similarity {
            rotation: turn * place.rotation,
            translation: origin + way + turn * (place.translation - origin),
            ..place
        }
    }
}

impl Creature {
    /// Moves the creature with the ground, by the ground's motion in this tick: position and heading, feet, and the
    /// places that the creature knows. Returns true if the ground carried it.
    pub(super) fn be_carried(&mut self, around: &Surroundings<'_>, dt: f64) -> bool {
        let went = std::mem::take(&mut self.state.moving_ground.drift)
            .velocity
            .length()
            * dt;
        let Some(motion) = self.ground_motion(around, dt, went) else {
            return false;
        };
        let carried = Carried {
            from: motion.previous_position,
            to: motion.position,
            turn: motion.turn,
            // The twist about Y.
            yaw: nearest_turn(2.0 * libm::atan2(motion.turn.y, motion.turn.w)),
        };
        if !self.is_broad(&carried, around, dt) {
            return false;
        }
        let state = &mut self.state;
        let before = state.position();
        // The stored ground heights rise with the ground.
        let rise = motion.position.y - motion.previous_position.y;
        state.on_ground.be_carried(&carried, rise);
        state.moving_ground.drift = Drift {
            velocity: (state.position() - before) / dt,
            yaw_rate: carried.yaw / dt,
        };
        state.motion.turn_by(carried.yaw);
        state.territory.be_carried(&carried);
        state.perceived.be_carried(&carried);
        state.walked.be_carried(&carried);
        state.head.be_carried(&carried);
        state.striking.be_carried(&carried);
        state.ranged.be_carried(&carried);
        state.hips.turn(&carried);
        for foot in &mut state.feet {
            foot.be_carried(&carried);
        }
        true
    }

    /// Motion of the ground below the creature in this tick; `None` if the ground did not move, or if there is no
    /// ground.
    ///
    /// The creature remembers a point of the ground, since asking for its motion costs less than a ray. At intervals, a
    /// ray looks for a new point. `went` is how far the ground carried the creature in the last tick, metres.
    fn ground_motion(
        &mut self,
        around: &Surroundings<'_>,
        dt: f64,
        went: f64,
    ) -> Option<PointMotion> {
        let often = if self.state.speed() != 0.0 {
            1
        } else {
            FREE_WAY_FACTOR
        };
        let looks = self.state.ticks().is_multiple_of(often * CHECK_INTERVAL);
        let among = around.terrain.len() as u32;
        let known = self.state.moving_ground.point.take();
        // When the ray found the point, the ground had already moved in that tick, but the creature had not.
        let reach = 2.0 * CARRYING_DISTANCE * self.size.height + went;
        let is_near = |point: &GroundPoint| point.at.distance(self.state.position()) <= reach;
        let known = known.filter(|point| point.among == among && is_near(point));
        let found = if looks || known.is_none() {
            self.ground_point(around)
        } else {
            None
        };
        // Without a new point the known one stays: a lift may have moved out of the ray's reach.
        let known = known.filter(|_| found.is_none());
        let mut point = known.or(found)?;
        let rests = |point: &GroundPoint| {
            let obstacle = around.terrain.get(point.obstacle as usize);
            obstacle.is_some_and(|obstacle| obstacle.rests(&point.material))
        };
        if rests(&point) {
            self.state.moving_ground.point = Some(point);
            return None;
        }
        let mut motion = point_motion(around, &point, dt);
        let is_it = motion.as_ref().is_some_and(|motion| {
            motion.previous_position.distance(point.at) <= SAME_POINT_DISTANCE * self.size.height
        });
        if known.is_some() && !is_it {
            // The index now belongs to another obstacle.
            point = self.ground_point(around)?;
            motion = point_motion(around, &point, dt);
        }
        let motion = motion.filter(PointMotion::is_finite)?;
        let at = motion.position;
        self.state.moving_ground.point = Some(GroundPoint { at, ..point });
        let moves = at != motion.previous_position || motion.turn != DQuat::IDENTITY;
        (moves && !motion.was_teleported).then_some(motion)
    }

    /// The point of the ground below the creature.
    fn ground_point(&self, around: &Surroundings<'_>) -> Option<GroundPoint> {
        self.ground_point_at(around, self.state.position())
    }

    /// True if the ground moves the same way ahead of the creature and behind it on both sides, wherever there is
    /// ground. This tells a ship from a rock that rolls between the feet.
    fn is_broad(&self, carried: &Carried, around: &Surroundings<'_>, dt: f64) -> bool {
        let ahead = self.state.heading() * (COMPARED_DISTANCE * self.size.height);
        let left = DVec3::new(ahead.z, 0.0, -ahead.x);
        [ahead, left - ahead, -left - ahead]
            .into_iter()
            .all(|aside| {
                let place = self.state.position() + aside;
                let Some(point) = self.ground_point_at(around, place) else {
                    return true;
                };
                let motion = point_motion(around, &point, dt);
                motion.is_some_and(|motion| {
                    let alike = carried.place(motion.previous_position);
                    let moved = carried.to.distance(carried.from);
                    alike.distance(motion.position)
                        <= ALIKE_MOTION_SHARE * (moved + self.size.height * 1e-3)
                })
            })
    }

    fn ground_point_at(&self, around: &Surroundings<'_>, place: DVec3) -> Option<GroundPoint> {
        let reach = CARRYING_DISTANCE * self.size.height;
        let from = place + DVec3::Y * reach;
        let among = around.terrain.len() as u32;
        let hits = (0..).zip(around.terrain).filter_map(|(obstacle, terrain)| {
            let hit = terrain.cast_ray(from, DVec3::NEG_Y, 2.0 * reach)?;
            Some(GroundPoint {
                obstacle,
                among,
                material: hit.material,
                at: hit.point,
            })
        });
        hits.max_by(|a, b| a.at.y.total_cmp(&b.at.y))
    }
}

fn point_motion(around: &Surroundings<'_>, point: &GroundPoint, dt: f64) -> Option<PointMotion> {
    let obstacle = around.terrain.get(point.obstacle as usize)?;
    obstacle.motion(&point.material, dt)
}
