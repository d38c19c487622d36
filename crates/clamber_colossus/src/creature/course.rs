//! How a creature moves along its way: its speed and its turning, and how they change.

use core::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use super::legs::at_once;
use super::move_on::{LOOKS, SELDOM};
use super::state::Playing;
use super::way::Way;
use super::{Creature, CreatureState};
use crate::angle::nearest_turn;
use crate::feet::{GRAVITY, STEP_TIME};
use crate::kind::Gait;

/// How fast its speed changes, metres a second squared, and a giant's turning, radians a second squared: 0.5 g is the
/// most that its limbs may start with, and riders stand on them. Smaller ones turn sharper, by their height.
const SPEEDS_UP: f64 = 1.2;
const SLOWS_DOWN: f64 = 2.0;
const HALTS: f64 = 6.0;
const TURNS: f64 = 0.12;

/// How fast a giant steers towards a goal, radians a second for each radian that it is aside.
const STEERS: f64 = 0.8;

/// It turns to within this angle at best, radians.
const LEAST_WITHIN: f64 = 0.003;

/// How far the body turns away from a foot before that steps, as a share of the leg's length, when it turns on the spot
/// by steps alone.
const TURNS_BY_STEP: f64 = 0.4;

/// The slowest walk, as a share of its speed.
const SLOWEST: f64 = 0.35;

/// It turns on the spot first if its goal is further aside than this, radians; and walks on if it is nearer. At the
/// corners of a way it turns sooner, and until it looks straight ahead.
const TURN_FIRST: f64 = 1.2;
const WALK_ON: f64 = 0.5;

/// A goal that is no further aside than this is straight ahead, radians.
const STRAIGHT: f64 = 0.15;

/// Where a creature is, and how it moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub(super) position: DVec3,
    pub(super) yaw: f64,
    /// Along its heading, metres a second, and radians a second to the left.
    pub(super) speed: f64,
    pub(super) yaw_rate: f64,
    /// How far its way is free, metres; and how far it may turn, radians, to the side that the sign tells. `None` if it
    /// may turn as far as it wants.
    pub(super) ahead: f64,
    pub(super) turn: Option<f64>,
    /// How far it goes back, metres.
    pub(super) back: f64,
    /// True while it turns on the spot, and while it stops abruptly.
    turning: bool,
    pub(super) halts: bool,
}

impl Course {
    pub(super) fn of(state: &CreatureState) -> Self {
        Self {
            position: state.position,
            yaw: state.yaw,
            speed: state.speed,
            yaw_rate: state.yaw_rate,
            ahead: state.walked.ahead,
            turn: Some(state.walked.turn),
            back: state.walked.back,
            turning: matches!(state.playing, Playing::Turn(_)),
            halts: state.halts,
        }
    }
}

/// What a creature wants of its course.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Wanted {
    speed: f64,
    pub(super) turn: f64,
    /// How far its next goal is aside of its heading, radians, the way round on which it turns; and how far away,
    /// metres.
    pub(super) aside: f64,
    pub(super) distance: f64,
    pub(super) arrived: bool,
    pub(super) turns_on_spot: bool,
    /// True if its goal is ahead, so that it walks there if it can.
    pub(super) faces: bool,
    pub(super) walks: bool,
    /// True if it stands before something.
    pub(super) is_stopped: bool,
}

impl Creature {
    /// Its walking speed, metres a second.
    pub(super) fn full_speed(&self, gait: &Gait) -> f64 {
        gait.speed * self.size.scale * self.size.rate
    }

    /// How far it has to see: as far as it takes to come to a stand, at its walking speed, and some ticks longer.
    pub(super) fn sight(&self, gait: &Gait) -> f64 {
        let speed = self.full_speed(gait);
        let looks = ((SELDOM + 1) * LOOKS) as f64 * self.kind.brain().tick();
        speed * speed / (2.0 * 0.7 * SLOWS_DOWN) + speed * looks
    }

    /// How far it has to be able to turn, radians, before it begins to do so as fast as it can: on the spot, or walking.
    pub(super) fn turning_room(&self, gait: &Gait, walks: bool) -> f64 {
        let rate = if walks {
            gait.steer_rate * self.size.rate
        } else {
            self.most_turn(gait)
        };
        let looks = LOOKS as f64 * self.kind.brain().tick();
        rate * rate / (2.0 * 0.7 * self.turns()) + rate * looks
    }

    /// How fast it may turn if it has to come to a stand within an angle, radians a second.
    fn stoppable(&self, angle: f64) -> f64 {
        (2.0 * 0.7 * self.turns() * angle.max(0.0)).sqrt()
    }

    /// How fast its turning changes, radians a second squared.
    pub(super) fn turns(&self) -> f64 {
        TURNS / (self.size.pace * self.size.pace).max(1e-6)
    }

    /// How fast it wants to walk and turn, as far as it knows its way.
    pub(super) fn wanted(&self, gait: &Gait, way: Option<&Way>, course: &Course) -> Wanted {
        let mut wanted = Wanted::default();
        let Some(way) = way else { return wanted };
        let rate = self.size.rate;
        let full = self.full_speed(gait);
        let stride = self.stride();
        // Steps are shorter, and take longer.
        let careful = full * stride * stride;
        // Clips and their rates are slower in a larger creature already.
        let steers = STEERS / (self.size.pace * rate).max(1e-3);
        let walked = &self.state.walked;
        let is_near = !way.walks || level(way.goal - course.position).0 <= way.within;
        let corner = walked.corners.first().filter(|_| !is_near);
        let (goal, goal_within) = corner.map_or((way.goal, way.within), |corner| (*corner, 0.0));
        let (distance, direction) = level(goal - course.position);
        let ahead = nearest_turn(direction - course.yaw);
        let bearing = way.bearing.filter(|_| is_near).unwrap_or(0.0);
        let aside = nearest_turn(ahead - bearing);
        // The other way round if this one is blocked.
        let is_round = f64::from(walked.round) * aside < 0.0;
        let aside = if is_round {
            aside + TAU * f64::from(walked.round)
        } else {
            aside
        };
        (wanted.aside, wanted.distance) = (aside, distance);
        let within = way.within_angle.max(LEAST_WITHIN);
        let is_turned = way.bearing.is_none() || aside.abs() <= within;
        let braked = |distance: f64| (2.0 * 0.7 * SLOWS_DOWN * distance.max(0.0)).sqrt();
        // Nor faster than it can stop within its height: it would never begin to walk where it does not see far.
        let slowest = (SLOWEST * careful).min(braked(self.size.height));
        let may_turn = |aside: f64| {
            let room = course.turn.map(|turn| turn * aside.signum());
            room.map_or(f64::INFINITY, |room| self.stoppable(room))
        };
        if course.back > 0.0 {
            let most = self.backs(gait);
            wanted.speed = -braked(course.back).clamp(0.1 * most, most);
            return wanted;
        }
        let free = braked(course.ahead);
        // On the circle to its goal that its heading touches it turns by twice the angle that the goal is aside, on a way
        // of the distance over the sine of that; faster than this it would go round and round its goal.
        let missed = (aside.abs() - goal_within / distance.max(1e-9)).clamp(0.0, FRAC_PI_2);
        let steered = gait.steer_rate * rate;
        let round = steered * distance / (2.0 * libm::sin(missed)).max(1e-9);
        let is_before = course.ahead < distance - goal_within;
        wanted.is_stopped = !is_near && walked.is_known && is_before && free < slowest;
        if is_near {
            wanted.arrived = is_turned;
            wanted.turns_on_spot = !is_turned;
        } else {
            let most = match (corner.is_some(), course.turning) {
                (true, true) => STRAIGHT,
                (true, false) | (false, true) => WALK_ON,
                (false, false) => TURN_FIRST,
            };
            let stops = wanted.is_stopped && aside.abs() > STRAIGHT;
            wanted.faces = aside.abs() <= most;
            wanted.turns_on_spot = !wanted.faces || stops || round < slowest;
            wanted.walks = !wanted.turns_on_spot;
        }
        if wanted.walks {
            let speed = careful.min(braked(distance - goal_within)).min(round);
            let speed = speed.max(slowest);
            wanted.speed = if wanted.is_stopped {
                0.0
            } else {
                speed.min(free)
            };
            let turn = (aside * steers).abs().min(gait.steer_rate) * rate;
            let free = may_turn(aside);
            wanted.turn = aside.signum() * turn.min(free);
            if wanted.is_stopped {
                wanted.turn = 0.0;
            }
        }
        // It has got as far as it gets.
        wanted.arrived |= walked.is_blocked;
        if wanted.turns_on_spot {
            let stoppable = |angle: f64| self.stoppable(angle);
            // It gets there in the end, and no faster than it can stop there.
            let braked = stoppable(aside.abs() - 0.5 * within).max(0.5 * stoppable(0.5 * within));
            let free = may_turn(aside);
            wanted.turn = aside.signum() * braked.min(self.most_turn(gait)).min(free);
            // Not before it stands.
            if course.speed > SLOWEST * full {
                wanted.turn = 0.0;
            }
        }
        // Not before it stands, after it went back.
        if course.speed < 0.0 {
            (wanted.speed, wanted.turn) = (0.0, 0.0);
        }
        wanted
    }

    /// Its course `dt` seconds later, if it tries to do what is wanted. Speeds change; its place does not.
    pub(super) fn moved(&self, gait: &Gait, wanted: &Wanted, course: Course, dt: f64) -> Course {
        let mut moved = course;
        let change = wanted.speed - course.speed;
        let slows_down = if course.halts { HALTS } else { SLOWS_DOWN };
        // Ahead, and back.
        let mut most = [SPEEDS_UP; 2];
        if course.speed > 0.0 {
            most[1] = slows_down;
        } else if course.speed < 0.0 {
            most[0] = slows_down;
        }
        moved.speed += change.clamp(-most[1] * dt, most[0] * dt);
        moved.halts &= moved.speed != 0.0;
        if wanted.speed > 0.0 {
            // A foot that hardly moves is no walk: the first step already has some speed.
            moved.speed = moved.speed.max(0.02 * self.full_speed(gait));
        }
        let change = wanted.turn - course.yaw_rate;
        moved.yaw_rate += change.clamp(-self.turns() * dt, self.turns() * dt);
        moved
    }

    /// How fast a clip of its gait is played at a course.
    pub(super) fn clip_speed(&self, gait: &Gait, playing: Playing, course: &Course) -> f64 {
        match playing {
            Playing::Walk => course.speed.max(0.0) / (self.full_speed(gait) * self.stride()),
            Playing::Turn(_) => {
                (course.yaw_rate.abs() / (gait.turn_rate * self.size.rate)).min(1.0)
            }
            Playing::Idle | Playing::Act(_) => 1.0,
        }
    }

    /// How fast it turns on the spot, radians a second: as its file says, but without a clip for it no faster than its
    /// feet can follow by steps of their own.
    fn most_turn(&self, gait: &Gait) -> f64 {
        let most = gait.turn_rate * self.size.rate;
        let legs = self.kind.legs();
        if gait.turn.is_some() || legs.is_empty() {
            return most;
        }
        let rounds = legs.len().div_ceil(at_once(legs.len())) as f64;
        let by_steps = legs.iter().map(|leg| {
            let radius = leg.stands_at.with_y(0.0).length().max(0.1 * leg.length);
            let time = STEP_TIME * (leg.length * self.size.scale / GRAVITY).sqrt();
            TURNS_BY_STEP * leg.length / (radius * rounds * time)
        });
        by_steps.fold(most, f64::min)
    }
}

/// Length of the level part of a vector, and its direction, radians from +Z to the left.
fn level(way: DVec3) -> (f64, f64) {
    (way.with_y(0.0).length(), libm::atan2(way.x, way.z))
}
