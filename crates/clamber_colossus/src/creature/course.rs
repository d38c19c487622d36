//! The motion of a creature along its way: its speed and turning, and how they change.

use core::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use super::check_way::{CHECK_INTERVAL, FREE_WAY_FACTOR};
use super::clips::Playing;
use super::legs::at_once;
use super::way::Way;
use super::{Creature, CreatureState};
use crate::angle::nearest_turn;
use crate::feet::{GRAVITY, STEP_TIME};
use crate::kind::Gait;

/// Acceleration, metres a second squared.
const WALK_ACCELERATION: f64 = 1.2;

/// Deceleration, metres a second squared.
const WALK_DECELERATION: f64 = 2.0;

/// Deceleration of an abrupt stop, metres a second squared.
const ABRUPT_DECELERATION: f64 = 6.0;

/// Angular acceleration of a creature of `GIANT_HEIGHT`, radians a second squared. Its limbs may begin to move with 0.5
/// g at most, since riders stand on them. Smaller creatures turn sharper, in inverse proportion to their height.
const TURN_ACCELERATION: f64 = 0.12;

/// Steering rate of a creature of `GIANT_HEIGHT` while it walks, radians a second for each radian between heading and
/// goal.
const STEERING_GAIN: f64 = 0.8;

/// Smallest angle within which a turn can end, radians.
const LEAST_WITHIN: f64 = 0.003;

/// How far the body turns away from a standing foot before that foot steps, as a share of the leg's length. It applies
/// to turns on the spot without a turn clip.
const TURN_BY_STEP: f64 = 0.4;

/// Slowest walk, as a share of the walking speed.
const SLOWEST_WALK_SHARE: f64 = 0.35;

/// Angle to the goal above which a walking creature turns on the spot first, radians.
const TURN_FIRST_ANGLE: f64 = 1.2;

/// Angle to the goal up to which a creature that turns on the spot walks on, radians. If the goal is a corner of the
/// way, this angle replaces `TURN_FIRST_ANGLE`, and `STRAIGHT_AHEAD_ANGLE` replaces this angle.
const WALK_ON_ANGLE: f64 = 0.5;

/// Angle up to which a goal is straight ahead, radians.
const STRAIGHT_AHEAD_ANGLE: f64 = 0.15;

/// Place and motion of a creature.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub(super) position: DVec3,
    pub(super) yaw: f64,
    /// Speed along the heading, metres a second.
    pub(super) speed: f64,
    /// Radians a second, positive to the left.
    pub(super) yaw_rate: f64,
    /// Free distance ahead, metres.
    pub(super) ahead: f64,
    /// Free angle to turn, radians; its sign is the side, positive to the left. `None` if the turn is not limited.
    pub(super) turn: Option<f64>,
    /// How far the creature still walks backwards, metres.
    pub(super) back: f64,
    /// True while the creature turns on the spot.
    turning: bool,
    /// True while the creature stops abruptly.
    pub(super) halts: bool,
}

impl Course {
    pub(super) fn of(state: &CreatureState) -> Self {
        Self {
            position: state.position(),
            yaw: state.yaw(),
            speed: state.speed(),
            yaw_rate: state.motion.yaw_rate(),
            ahead: state.walked.free.ahead(),
            turn: Some(state.walked.free.turn()),
            back: state.walked.retreats.left(),
            turning: matches!(state.clips.playing(), Playing::Turn(_)),
            halts: state.acting.halts(),
        }
    }
}

/// The speed and turn that a creature wants, and where its next goal is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Wanted {
    speed: f64,
    pub(super) turn: f64,
    /// Angle from the heading to the next goal, radians, in the direction in which the creature turns.
    pub(super) aside: f64,
    /// Horizontal distance to the next goal, metres.
    pub(super) distance: f64,
    pub(super) arrived: bool,
    pub(super) turns_on_spot: bool,
    /// True if the goal is ahead, so that the creature walks to it if it can.
    pub(super) faces: bool,
    pub(super) walks: bool,
    /// True if the creature has to stop before an obstacle ahead.
    pub(super) is_stopped: bool,
}

/// The next corner of a way or its goal, seen from a course.
struct NextGoal {
    /// Horizontal distance, metres.
    distance: f64,
    /// Angle from the heading, radians, in the direction in which the creature turns.
    aside: f64,
    /// Distance from the goal within which the creature has arrived; 0 for a corner.
    within: f64,
    is_corner: bool,
    /// True if the creature is at the way's goal, so that it walks no farther.
    is_near: bool,
}

/// Walking speeds, metres a second.
struct Pace {
    /// Speed of a walk on the ground ahead.
    careful: f64,
    /// Slowest walk.
    slowest: f64,
    /// Highest speed at which the creature does not circle around its goal.
    round: f64,
}

impl Creature {
    /// Walking speed, metres a second.
    pub(super) fn full_speed(&self, gait: &Gait) -> f64 {
        gait.speed * self.size.scale * self.size.rate
    }

    /// How far ahead the creature has to look, metres: its braking distance from the walking speed, and the distance
    /// that it walks until it looks again.
    pub(super) fn sight(&self, gait: &Gait) -> f64 {
        let speed = self.full_speed(gait);
        let looks = ((FREE_WAY_FACTOR + 1) * CHECK_INTERVAL) as f64 * self.kind.brain().tick();
        speed * speed / (2.0 * 0.7 * WALK_DECELERATION) + speed * looks
    }

    /// Free angle that the creature needs to turn at its full rate, radians: the angle in which it can stop, and the
    /// angle until it looks again. `walks` selects the rate of steering, otherwise the rate on the spot counts.
    pub(super) fn turning_room(&self, gait: &Gait, walks: bool) -> f64 {
        let rate = if walks {
            gait.steer_rate * self.size.rate
        } else {
            self.most_turn(gait)
        };
        let looks = CHECK_INTERVAL as f64 * self.kind.brain().tick();
        rate * rate / (2.0 * 0.7 * self.turns()) + rate * looks
    }

    /// Highest turning rate from which the creature can stop within an angle, radians a second.
    fn stoppable(&self, angle: f64) -> f64 {
        (2.0 * 0.7 * self.turns() * angle.max(0.0)).sqrt()
    }

    /// Angular acceleration, radians a second squared.
    pub(super) fn turns(&self) -> f64 {
        TURN_ACCELERATION / (self.size.pace * self.size.pace).max(1e-6)
    }

    /// The speed and turn that the creature wants, as far as it knows its way.
    pub(super) fn wanted(&self, gait: &Gait, way: Option<&Way>, course: &Course) -> Wanted {
        let mut wanted = Wanted::default();
        let Some(way) = way else { return wanted };
        let next = self.next_goal(way, course);
        (wanted.aside, wanted.distance) = (next.aside, next.distance);
        if course.back > 0.0 {
            let most = self.backs(gait);
            wanted.speed = -braked(course.back).clamp(0.1 * most, most);
            return wanted;
        }
        let pace = self.pace(gait, &next);
        self.choose_motion(&mut wanted, (way, &next), &pace, course);
        if wanted.walks {
            self.want_walk(&mut wanted, gait, &next, &pace, course);
        }
        // A blocked creature gets no farther.
        wanted.arrived |= self.state.walked.progress.is_blocked();
        if wanted.turns_on_spot {
            self.want_turn(&mut wanted, gait, way, course);
        }
        // After a retreat, stop first.
        if course.speed < 0.0 {
            (wanted.speed, wanted.turn) = (0.0, 0.0);
        }
        wanted
    }

    /// The next corner of a way or its goal, seen from a course.
    fn next_goal(&self, way: &Way, course: &Course) -> NextGoal {
        let walked = &self.state.walked;
        let is_near = !way.walks || level(way.goal - course.position).0 <= way.within;
        let corner = walked.corners.next().filter(|_| !is_near);
        let (goal, within) = corner.map_or((way.goal, way.within), |corner| (corner, 0.0));
        let (distance, direction) = level(goal - course.position);
        let ahead = nearest_turn(direction - course.yaw);
        let bearing = way.bearing.filter(|_| is_near).unwrap_or(0.0);
        let aside = nearest_turn(ahead - bearing);
        // Turn the long way round if the short one is blocked.
        let round = f64::from(walked.retreats.round());
        let is_round = round * aside < 0.0;
        NextGoal {
            distance,
            aside: if is_round { aside + TAU * round } else { aside },
            within,
            is_corner: corner.is_some(),
            is_near,
        }
    }

    /// The walking speeds towards a goal.
    fn pace(&self, gait: &Gait, next: &NextGoal) -> Pace {
        let stride = self.stride();
        // On steep ground, steps are shorter and take longer.
        let careful = self.full_speed(gait) * stride * stride;
        // The slowest walk must be able to stop within the creature's height. Otherwise the creature would never begin
        // to walk where it cannot see far.
        let slowest = (SLOWEST_WALK_SHARE * careful).min(braked(self.size.height));
        // The circle that starts along the heading and passes through the goal has the radius distance / (2 sin(angle
        // to the goal)). If the creature walked faster than the steering rate times this radius, it would circle around
        // its goal.
        let missed =
            (next.aside.abs() - next.within / next.distance.max(1e-9)).clamp(0.0, FRAC_PI_2);
        let steered = gait.steer_rate * self.size.rate;
        let round = steered * next.distance / (2.0 * libm::sin(missed)).max(1e-9);
        Pace {
            careful,
            slowest,
            round,
        }
    }

    /// Decides whether the creature walks, turns on the spot or has arrived.
    fn choose_motion(
        &self,
        wanted: &mut Wanted,
        (way, next): (&Way, &NextGoal),
        pace: &Pace,
        course: &Course,
    ) {
        if next.is_near {
            let is_turned = way.bearing.is_none() || next.aside.abs() <= turned_within(way);
            wanted.arrived = is_turned;
            wanted.turns_on_spot = !is_turned;
            return;
        }
        let is_before = course.ahead < next.distance - next.within;
        let is_slow = braked(course.ahead) < pace.slowest;
        wanted.is_stopped = self.state.walked.free.is_known() && is_before && is_slow;
        let most = match (next.is_corner, course.turning) {
            (true, true) => STRAIGHT_AHEAD_ANGLE,
            (true, false) | (false, true) => WALK_ON_ANGLE,
            (false, false) => TURN_FIRST_ANGLE,
        };
        let stops = wanted.is_stopped && next.aside.abs() > STRAIGHT_AHEAD_ANGLE;
        wanted.faces = next.aside.abs() <= most;
        wanted.turns_on_spot = !wanted.faces || stops || pace.round < pace.slowest;
        wanted.walks = !wanted.turns_on_spot;
    }

    /// Sets the speed and the steering of a walk.
    fn want_walk(
        &self,
        wanted: &mut Wanted,
        gait: &Gait,
        next: &NextGoal,
        pace: &Pace,
        course: &Course,
    ) {
        if wanted.is_stopped {
            return;
        }
        let rate = self.size.rate;
        // The turn is multiplied by `rate` below.
        let steers = STEERING_GAIN / (self.size.pace * rate).max(1e-3);
        let speed = pace
            .careful
            .min(braked(next.distance - next.within))
            .min(pace.round);
        let speed = speed.max(pace.slowest);
        wanted.speed = speed.min(braked(course.ahead));
        let turn = (next.aside * steers).abs().min(gait.steer_rate) * rate;
        wanted.turn = next.aside.signum() * turn.min(self.free_turn_rate(course, next.aside));
    }

    /// Sets the rate of a turn on the spot.
    fn want_turn(&self, wanted: &mut Wanted, gait: &Gait, way: &Way, course: &Course) {
        let (aside, within) = (wanted.aside, turned_within(way));
        let stoppable = |angle: f64| self.stoppable(angle);
        // Slow enough to stop at the goal, but not so slow that the creature never gets there.
        let braked = stoppable(aside.abs() - 0.5 * within).max(0.5 * stoppable(0.5 * within));
        let free = self.free_turn_rate(course, aside);
        wanted.turn = aside.signum() * braked.min(self.most_turn(gait)).min(free);
        // No turn on the spot before the walk is slow.
        if course.speed > SLOWEST_WALK_SHARE * self.full_speed(gait) {
            wanted.turn = 0.0;
        }
    }

    /// Highest rate of a turn to the side of `aside` from which the creature can stop within its free angle.
    fn free_turn_rate(&self, course: &Course, aside: f64) -> f64 {
        let room = course.turn.map(|turn| turn * aside.signum());
        room.map_or(f64::INFINITY, |room| self.stoppable(room))
    }

    /// The course after `dt` seconds if the creature pursues `wanted`. The speeds change; the place does not.
    pub(super) fn moved(&self, gait: &Gait, wanted: &Wanted, course: Course, dt: f64) -> Course {
        let mut moved = course;
        let change = wanted.speed - course.speed;
        let slows_down = if course.halts {
            ABRUPT_DECELERATION
        } else {
            WALK_DECELERATION
        };
        // Largest acceleration forwards, and backwards.
        let mut most = [WALK_ACCELERATION; 2];
        if course.speed > 0.0 {
            most[1] = slows_down;
        } else if course.speed < 0.0 {
            most[0] = slows_down;
        }
        moved.speed += change.clamp(-most[1] * dt, most[0] * dt);
        moved.halts &= moved.speed != 0.0;
        if wanted.speed > 0.0 {
            // A walk begins at some speed, because feet that hardly move are no walk.
            moved.speed = moved.speed.max(0.02 * self.full_speed(gait));
        }
        let change = wanted.turn - course.yaw_rate;
        moved.yaw_rate += change.clamp(-self.turns() * dt, self.turns() * dt);
        moved
    }

    /// Playback speed of a clip of the gait at a course.
    pub(super) fn clip_speed(&self, gait: &Gait, playing: Playing, course: &Course) -> f64 {
        match playing {
            Playing::Walk => course.speed.max(0.0) / (self.full_speed(gait) * self.stride()),
            Playing::Turn(_) => {
                (course.yaw_rate.abs() / (gait.turn_rate * self.size.rate)).min(1.0)
            }
            Playing::Idle | Playing::Act(_) => 1.0,
        }
    }

    /// Turning rate on the spot, radians a second, as the file gives it. Without a turn clip it is at most the rate at
    /// which the feet can follow by steps of their own.
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
            TURN_BY_STEP * leg.length / (radius * rounds * time)
        });
        by_steps.fold(most, f64::min)
    }
}

/// Length of the horizontal part of a vector, and its direction, radians from +Z to the left.
fn level(way: DVec3) -> (f64, f64) {
    (way.with_y(0.0).length(), libm::atan2(way.x, way.z))
}

/// Highest speed from which a walk can stop within a distance, metres a second.
fn braked(distance: f64) -> f64 {
    (2.0 * 0.7 * WALK_DECELERATION * distance.max(0.0)).sqrt()
}

/// Angle to the bearing of a way within which a turn has arrived, radians.
fn turned_within(way: &Way) -> f64 {
    way.within_angle.max(LEAST_WITHIN)
}
