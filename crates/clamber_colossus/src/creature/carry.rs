//! Moving ground carries a creature: a ship that turns, a lift that rises.

use clamber_world::PointMotion;
use glam::{DQuat, DVec3};

use super::move_on::{LOOKS, SELDOM};
use super::state::{Drift, GroundPoint, NO_GROUND};
use super::{Creature, Surroundings};
use crate::angle::nearest_turn;
use crate::feet::Carried;

/// Ground carries the creature if it is within this distance above or below the creature's origin, as a share of the
/// creature's height.
const NEAR: f64 = 0.15;

/// Distance ahead of the origin, and behind and to both sides of it, at which the motion of the ground is compared with
/// that below the origin, as a share of the creature's height.
const BROAD: f64 = 0.12;

/// Largest difference between these motions for ground that moves as one, as a share of the distance that the ground
/// moved.
const ALIKE: f64 = 0.1;

/// How near the previous position of the remembered ground point must be to the place where it was, as a share of the
/// creature's height. Farther away, it is another point.
const SAME: f64 = 1e-6;

impl Creature {
    /// Moves the creature with the ground, by the ground's motion in this tick: position and heading, feet, and the
    /// places that the creature knows. Returns true if the ground carried it.
    pub(super) fn be_carried(&mut self, around: &Surroundings<'_>, dt: f64) -> bool {
        let went = std::mem::take(&mut self.state.carried).velocity.length() * dt;
        let Some(motion) = self.ground_motion(around, dt, went) else {
            return false;
        };
        let carried = Carried {
            from: motion.previous_position,
            to: motion.position,
            turn: motion.turn,
            yaw: yaw_of(motion.turn),
        };
        if !self.is_broad(&carried, around, dt) {
            return false;
        }
        let state = &mut self.state;
        let before = state.position;
        state.position = carried.place(before);
        state.carried = Drift {
            velocity: (state.position - before) / dt,
            yaw_rate: carried.yaw / dt,
        };
        // These places may be far away: the ground's yaw turns them, but not its pitch and roll.
        let known = [&mut state.home, &mut state.patrol, &mut state.noise];
        let prey = state.prey.iter_mut().map(|(_, place)| place);
        let known = known.into_iter().chain(prey);
        let walked = &mut state.walked;
        let way = walked.corners.iter_mut().chain([&mut walked.stuck_at]);
        for place in known.chain(way) {
            *place = carried.level_place(*place);
        }
        state.gaze.value = carried.place(state.gaze.value);
        state.gaze.velocity = carried.vector(state.gaze.velocity);
        state.aim = carried.vector(state.aim);
        let lean = &mut state.lean.spring;
        (lean.value, lean.velocity) = (carried.vector(lean.value), carried.vector(lean.velocity));
        state.ranged.be_carried(&carried);
        state.yaw = nearest_turn(state.yaw + carried.yaw);
        state.hips.turn(&carried);
        for foot in &mut state.feet {
            foot.be_carried(&carried);
        }
        // The stored ground heights rise with the ground.
        let rise = motion.position.y - motion.previous_position.y;
        for level in &mut state.ground {
            if *level < NO_GROUND {
                *level += rise;
            }
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
        let often = if self.state.speed != 0.0 { 1 } else { SELDOM };
        let looks = self.state.ticks.is_multiple_of(often * LOOKS);
        let among = around.terrain.len() as u32;
        let known = self.state.stands_on.take();
        // When the ray found the point, the ground had already moved in that tick, but the creature had not.
        let reach = 2.0 * NEAR * self.size.height + went;
        let is_near = |point: &GroundPoint| point.at.distance(self.state.position) <= reach;
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
            self.state.stands_on = Some(point);
            return None;
        }
        let mut motion = point_motion(around, &point, dt);
        let is_it = motion.as_ref().is_some_and(|motion| {
            motion.previous_position.distance(point.at) <= SAME * self.size.height
        });
        if known.is_some() && !is_it {
            // The index now belongs to another obstacle.
            point = self.ground_point(around)?;
            motion = point_motion(around, &point, dt);
        }
        let motion = motion.filter(PointMotion::is_finite)?;
        let at = motion.position;
        self.state.stands_on = Some(GroundPoint { at, ..point });
        let moves = at != motion.previous_position || motion.turn != DQuat::IDENTITY;
        (moves && !motion.placed).then_some(motion)
    }

    /// The point of the ground below the creature.
    fn ground_point(&self, around: &Surroundings<'_>) -> Option<GroundPoint> {
        self.ground_point_at(around, self.state.position)
    }

    /// True if the ground moves the same way ahead of the creature and behind it on both sides, wherever there is
    /// ground. This tells a ship from a rock that rolls between the feet.
    fn is_broad(&self, carried: &Carried, around: &Surroundings<'_>, dt: f64) -> bool {
        let ahead = self.state.heading() * (BROAD * self.size.height);
        let left = DVec3::new(ahead.z, 0.0, -ahead.x);
        [ahead, left - ahead, -left - ahead]
            .into_iter()
            .all(|aside| {
                let place = self.state.position + aside;
                let Some(point) = self.ground_point_at(around, place) else {
                    return true;
                };
                let motion = point_motion(around, &point, dt);
                motion.is_some_and(|motion| {
                    let alike = carried.place(motion.previous_position);
                    let moved = carried.to.distance(carried.from);
                    alike.distance(motion.position) <= ALIKE * (moved + self.size.height * 1e-3)
                })
            })
    }

    fn ground_point_at(&self, around: &Surroundings<'_>, place: DVec3) -> Option<GroundPoint> {
        let reach = NEAR * self.size.height;
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

/// Yaw of a rotation, radians: its twist about Y.
fn yaw_of(turn: DQuat) -> f64 {
    nearest_turn(2.0 * libm::atan2(turn.y, turn.w))
}
