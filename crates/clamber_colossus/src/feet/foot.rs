use glam::DVec3;
use serde::{Deserialize, Serialize};

use clamber_animation::Spring;

use super::arrive::{arrive, pull, unhurried};
use super::{Carried, FootGoal, Footing, SWING_SHARES, Sole};
use crate::angle::nearest_turn;

/// Whether a foot stands, or how it moves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Hold {
    /// The foot stands at `at`, on ground that was at the height `below` under the ball, or `NO_GROUND`.
    Planted {
        at: Footing,
        heading: f64,
        below: f64,
    },
    /// The foot follows its clip with an offset, which changes to the offset of the landing place.
    Swings,
    /// The foot comes down in `left` seconds where its clip stands. It was in the air when the clip already stood, or
    /// its ground has moved away.
    Lands {
        ball: Spring<DVec3>,
        to: Footing,
        left: f64,
    },
    /// The foot takes a step that is not in its clip.
    Steps(Step),
}

/// A step that is not in a clip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Step {
    from: DVec3,
    to: Footing,
    /// Height of the step, metres.
    lift: f64,
    passed: f64,
    lasts: f64,
}

/// The target of the vertical offset of a swinging foot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Path {
    /// Vertical offset to reach, metres.
    offset: f64,
    /// Seconds until then.
    left: f64,
    /// Height of the ground below the foot.
    floor: f64,
}

/// A foot of a creature, in world space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Foot {
    hold: Hold,
    /// Position of the ball in the clip in the last tick.
    clip: DVec3,
    /// Vector from the ball in the clip to the ball of the foot.
    offset: Spring<DVec3>,
    /// Yaw of the foot relative to its clip, radians.
    yaw: Spring<f64>,
    /// How flat the foot is on the ground: from 0, as in its clip, to 1.
    flat: Spring<f64>,
    /// How firmly the foot stands: from 0, in flight, to 1.
    firm: Spring<f64>,
    /// Normal of the ground to which the foot leans.
    normal: DVec3,
    /// Offset of a planted ball from its exact place.
    settling: Spring<DVec3>,
    /// The target of the vertical offset.
    path: Path,
    /// The last predicted landing place.
    landing: Option<Footing>,
    /// True if the foot stands too far from its place in the clip, or turned too far against the clip, and waits for
    /// its turn to step. False in a gait.
    wants_step: bool,
    /// True if the leg was stretched in the last tick.
    is_stretched: bool,
}

/// Distance from its place in the clip beyond which a standing foot takes a step, as a share of the leg's length.
const STEP_DISTANCE: f64 = 0.12;

/// Yaw relative to the clip beyond which a standing foot takes a step, radians.
const STEP_ANGLE: f64 = 0.45;

/// Distance to its place in the clip up to which a foot takes no step although its leg is stretched, as a share of the
/// leg's length. The hips come down instead.
const NO_STEP_DISTANCE: f64 = 0.02;

/// Least height of a step that is not in a clip, as a share of the leg's length.
const STEP_HEIGHT: f64 = 0.04;

/// Largest vertical acceleration of an offset, metres a second squared. The vector sum with `MOST_ASIDE_ACCELERATION`
/// is 5.6, below the limit of 6 for skin below the knee in a swing.
pub(crate) const MOST_UP_ACCELERATION: f64 = 4.4;

/// Largest horizontal acceleration of an offset, metres a second squared.
pub(crate) const MOST_ASIDE_ACCELERATION: f64 = 3.4;

/// Largest angular acceleration of a foot's yaw, radians a second squared.
const MOST_TURN_ACCELERATION: f64 = 3.0;

/// Shortest time in which an offset reaches its target, seconds.
const SHORTEST_WAY_TIME: f64 = 0.15;

/// Time constant with which a foot leans to the ground, seconds.
const LEAN_TIME: f64 = 0.1;

/// A foot higher than this above the ground comes down before it is planted, as a share of the leg's length.
const HIGH_FOOT: f64 = 0.03;

/// Height by which the ground below a foot may change and still carry it, as a share of the leg's length.
const GROUND_GONE_HEIGHT: f64 = 0.003;

/// Distance from its place in the clip beyond which a standing foot lifts in a walk or a turn although its clip stands,
/// as a share of the leg's length.
const LEFT_BEHIND_DISTANCE: f64 = 0.3;

/// Distance from its place in the clip beyond which a foot is left behind, as a share of the leg's length.
const LATE_FOOT_DISTANCE: f64 = 0.06;

/// Distance from its landing place within which a foot has come down, as a share of the leg's length.
const ARRIVED_DISTANCE: f64 = 0.01;

/// Height that stands for no ground below, because JSON has no infinity.
const NO_GROUND: f64 = f64::MIN;

/// Distance by which a landing place may move before the ground is looked for again, as a share of the leg's length.
const SAME_LANDING_DISTANCE: f64 = 0.03;

/// Half time in which a foot that has come down reaches its exact place, seconds.
const SETTLE_HALF_TIME: f64 = 0.08;

/// Half time in which a lifted foot loses its hold, as a share of the duration of a step.
const RELEASE_HALF_TIME_SHARE: f64 = 0.25;

impl Foot {
    /// A foot at its place in the clip.
    pub(crate) fn new() -> Self {
        Self {
            hold: Hold::Swings,
            clip: DVec3::ZERO,
            offset: Spring::default(),
            yaw: Spring::default(),
            flat: Spring::default(),
            firm: Spring::default(),
            normal: DVec3::Y,
            settling: Spring::default(),
            path: Path::default(),
            landing: None,
            wants_step: false,
            is_stretched: false,
        }
    }

    /// True if no number of the foot is larger than `most`, and none is NaN.
    pub(crate) fn is_within(&self, most: f64) -> bool {
        let spring = |spring: &Spring<f64>| spring.value.abs() + spring.velocity.abs();
        let moving = |spring: &Spring<DVec3>| spring.value.length() + spring.velocity.length();
        let footing = |at: &Footing| at.ball.length() + at.normal.length();
        let held = match &self.hold {
            Hold::Planted { at, heading, below } => {
                let below = if *below == NO_GROUND { 0.0 } else { *below };
                footing(at) + heading.abs() + below.abs()
            }
            Hold::Swings => 0.0,
            Hold::Lands { ball, to, left } => moving(ball) + footing(to) + left.abs(),
            Hold::Steps(step) => {
                let times = step.lift.abs() + step.passed.abs() + step.lasts.abs();
                step.from.length() + footing(&step.to) + times
            }
        };
        // A clip may never land, and there may be no ground below.
        let is_path = self.path.offset.abs() <= most && self.path.left > -most;
        let is_floor = self.path.floor == NO_GROUND || self.path.floor.abs() <= most;
        let all = [
            held,
            self.clip.length(),
            moving(&self.offset),
            spring(&self.yaw),
            spring(&self.flat),
            spring(&self.firm),
            self.normal.length(),
            moving(&self.settling),
            self.landing.as_ref().map_or(0.0, footing),
        ];
        // Comparisons with NaN are false.
        is_path && is_floor && all.iter().all(|size| *size <= most)
    }

    /// True if the foot stands.
    pub(crate) fn is_planted(&self) -> bool {
        matches!(self.hold, Hold::Planted { .. })
    }

    /// True if the foot stands too far from its place in the clip, or turned too far against the clip, and waits for
    /// its turn to step.
    pub(crate) fn wants_step(&self) -> bool {
        self.wants_step
    }

    /// Sets whether the leg is stretched.
    pub(crate) fn set_stretched(&mut self, is_stretched: bool) {
        self.is_stretched = is_stretched;
    }

    /// Vector from the ball in the clip to the ball of the foot, metres.
    pub(crate) fn offset(&self) -> DVec3 {
        self.offset.value
    }

    /// Yaw of the foot relative to its clip, radians.
    pub(crate) fn yaw(&self) -> f64 {
        self.yaw.value
    }

    /// How flat the foot is on the ground: from 0, as in its clip, to 1.
    pub(crate) fn flat(&self) -> f64 {
        self.flat.value.clamp(0.0, 1.0)
    }

    /// How firmly the foot stands: from 0, in flight, to 1. A foot loses its hold more slowly than it gains it.
    pub(crate) fn firm(&self) -> f64 {
        self.firm.value.clamp(0.0, 1.0)
    }

    /// Normal of the ground to which the foot leans.
    pub(crate) fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Puts the foot on the ground at its place in the clip, at once.
    pub(crate) fn place(&mut self, goal: &FootGoal, sole: &Sole<'_>) {
        self.plant(goal, sole);
        self.settling = Spring::default();
        (self.flat, self.firm) = (Spring::at(1.0), Spring::at(1.0));
        if let Hold::Planted { at, .. } = self.hold {
            self.normal = at.normal;
            self.offset = Spring::at(at.ball - goal.clip);
        }
    }

    /// Moves the foot with ground that has moved.
    pub(crate) fn be_carried(&mut self, carried: &Carried) {
        let footing = |at: &mut Footing| {
            at.ball = carried.place(at.ball);
            at.normal = carried.turn * at.normal;
        };
        let spring = |spring: &mut Spring<DVec3>| {
            spring.value = carried.vector(spring.value);
            spring.velocity = carried.vector(spring.velocity);
        };
        let rise =
            carried.place(self.clip + self.offset.value).y - (self.clip + self.offset.value).y;
        match &mut self.hold {
            Hold::Planted { at, heading, below } => {
                let before = at.ball.y;
                footing(at);
                *heading = nearest_turn(*heading + carried.yaw);
                if *below != NO_GROUND {
                    *below += at.ball.y - before;
                }
            }
            Hold::Swings => {}
            Hold::Lands { ball, to, .. } => {
                ball.value = carried.place(ball.value);
                ball.velocity = carried.vector(ball.velocity);
                footing(to);
            }
            Hold::Steps(step) => {
                step.from = carried.place(step.from);
                footing(&mut step.to);
            }
        }
        self.clip = carried.place(self.clip);
        self.normal = carried.turn * self.normal;
        spring(&mut self.offset);
        spring(&mut self.settling);
        if self.path.floor != NO_GROUND {
            self.path.floor += rise;
        }
        if let Some(landing) = &mut self.landing {
            footing(landing);
        }
    }

    /// Advances the foot by a tick of `dt` seconds. Returns true if the foot has just come down.
    pub(crate) fn step(&mut self, goal: &FootGoal, sole: &Sole<'_>, dt: f64) -> bool {
        let was_up = !self.is_planted();
        self.decide(goal, sole, dt);
        match self.hold {
            Hold::Planted { at, heading, .. } => self.stand(goal, &at, heading, dt),
            Hold::Swings if goal.stands => self.catch_up(goal, sole, dt),
            Hold::Swings => self.swing(goal, sole, goal.lands_in.max(SHORTEST_WAY_TIME), dt),
            Hold::Lands { ball, to, left } => self.land(goal, sole, (ball, to, left), dt),
            Hold::Steps(step) => self.take_step(goal, sole, step, dt),
        }
        let flat = f64::from(u8::from(self.is_planted()));
        self.flat.step(flat, SETTLE_HALF_TIME, dt);
        let time = if self.is_planted() {
            SETTLE_HALF_TIME
        } else {
            RELEASE_HALF_TIME_SHARE * goal.step_time()
        };
        self.firm.step(flat, time, dt);
        self.clip = goal.clip;
        was_up && self.is_planted()
    }

    /// Decides whether the foot goes on as it does, lifts, lands or steps.
    fn decide(&mut self, goal: &FootGoal, sole: &Sole<'_>, dt: f64) {
        self.wants_step = false;
        match self.hold {
            Hold::Planted { at, below, .. } if goal.stands => {
                let gap = goal.settled - at.ball;
                let level = DVec3::new(gap.x, 0.0, gap.z).length();
                let is_off = level > STEP_DISTANCE * goal.leg || self.yaw.value.abs() > STEP_ANGLE;
                self.wants_step = is_off && !goal.is_gait && !goal.is_lifted;
                let is_gone = goal.looks
                    && match sole.below(at.ball) {
                        Some(now) => (now - below).abs() > GROUND_GONE_HEIGHT * goal.leg,
                        None => below != NO_GROUND,
                    };
                if is_gone && sole.has_ground() {
                    self.hold = Hold::Lands {
                        ball: Spring::at(at.ball),
                        to: sole.at(goal.settled),
                        left: goal.step_time(),
                    };
                } else if goal.is_gait
                    && (self.is_stretched || level > LEFT_BEHIND_DISTANCE * goal.leg)
                {
                    self.hold = Hold::Swings;
                    self.path.left = 0.0;
                } else if self.wants_step && goal.may_step
                    || self.is_stretched && level > NO_STEP_DISTANCE * goal.leg
                {
                    self.hold =
                        Hold::Steps(self.step_from(at.ball + self.settling.value, goal, sole));
                }
            }
            Hold::Planted { .. } | Hold::Lands { .. } if !goal.stands => {
                self.hold = Hold::Swings;
                self.path.left = 0.0;
            }
            Hold::Swings if goal.stands && !self.is_late(goal) && !goal.is_lifted_soon() => {
                let ball = self.clip + self.offset.value;
                if ball.y - sole.at(ball).ball.y > HIGH_FOOT * goal.leg {
                    let velocity = (goal.clip - self.clip) / dt + self.offset.velocity;
                    let to = sole.at(goal.settled);
                    // The end of a kick stops the clip's foot at once. The remaining speed must not carry this foot
                    // past its landing place.
                    let most = (MOST_UP_ACCELERATION * ball.distance(to.ball)).sqrt();
                    self.hold = Hold::Lands {
                        ball: Spring {
                            value: ball,
                            velocity: velocity.clamp_length_max(most),
                        },
                        to,
                        left: goal.step_time(),
                    };
                } else {
                    self.plant(goal, sole);
                }
            }
            _ => {}
        }
    }

    /// A step from a place to the foot's place in the clip, over the ground between them.
    fn step_from(&mut self, from: DVec3, goal: &FootGoal, sole: &Sole<'_>) -> Step {
        let to = sole.at(goal.settled);
        let level = (to.ball - from).with_y(0.0).length();
        let over = SWING_SHARES.into_iter().filter_map(|share| {
            let place = from.lerp(to.ball, share);
            // At this share of its way, the foot is raised by the step's lift times the cube of `hump`.
            let hump = 4.0 * share * (1.0 - share);
            let rise = sole.highest(place, to.normal)? + goal.ball_height - place.y;
            Some(rise / (hump * hump * hump))
        });
        let lift = over
            .fold(STEP_HEIGHT * goal.leg, f64::max)
            .min(0.5 * goal.leg);
        // The peak accelerations of a quintic from rest to rest, and of the hump: 5.77 d / T^2, 24 h / T^2.
        let lasts = (5.77 * level / MOST_ASIDE_ACCELERATION)
            .max(24.0 * lift / MOST_UP_ACCELERATION)
            .sqrt();
        Step {
            from,
            to,
            lift,
            passed: 0.0,
            lasts: lasts.max(goal.step_time()),
        }
    }

    /// True if the foot was left behind in a walk or a turn: it is too far from its place in the clip.
    fn is_late(&self, goal: &FootGoal) -> bool {
        goal.is_gait && self.offset.value.with_y(0.0).length() > LATE_FOOT_DISTANCE * goal.leg
    }

    /// Moves the foot quickly towards its place in the clip, above the ground.
    fn catch_up(&mut self, goal: &FootGoal, sole: &Sole<'_>, dt: f64) {
        let up = DVec3::Y * (STEP_HEIGHT * goal.leg);
        let goal = FootGoal {
            lands_at: goal.clip + up,
            ahead: [goal.clip.y; 3],
            aside: DVec3::ZERO,
            ..*goal
        };
        self.swing(&goal, sole, goal.step_time(), dt);
    }

    /// Puts the foot down where it is.
    fn plant(&mut self, goal: &FootGoal, sole: &Sole<'_>) {
        let ball = goal.clip + self.offset.value;
        let at = sole.at_exactly(ball);
        self.settling = Spring {
            value: ball - at.ball,
            velocity: DVec3::new(0.0, self.offset.velocity.y.min(0.0), 0.0),
        };
        self.landing = None;
        let below = sole.below(at.ball).unwrap_or(NO_GROUND);
        let heading = goal.heading + self.yaw.value;
        self.hold = Hold::Planted { at, heading, below };
    }

    fn stand(&mut self, goal: &FootGoal, at: &Footing, heading: f64, dt: f64) {
        self.settling.step(DVec3::ZERO, SETTLE_HALF_TIME, dt);
        self.set(at.ball + self.settling.value - goal.clip, dt);
        let yaw = nearest_turn(heading - goal.heading);
        self.yaw = Spring {
            value: yaw,
            velocity: (yaw - self.yaw.value) / dt,
        };
        self.lean(at.normal, LEAN_TIME, dt);
    }

    /// Swings with the clip and an offset, which reaches the landing place in `left` seconds and clears the ground on
    /// the way.
    fn swing(&mut self, goal: &FootGoal, sole: &Sole<'_>, left: f64, dt: f64) {
        let lands = self.landing(goal.lands_at + goal.aside, goal, sole);
        if goal.looks || self.path.left <= 0.0 {
            self.path = self.path_over(goal, sole, &lands, left);
        }
        self.path.left -= dt;
        let most = self.offset.velocity.y + goal.most_up * dt;
        let mut up = Spring {
            value: self.offset.value.y,
            velocity: self.offset.velocity.y,
        };
        arrive(
            &mut up,
            self.path.offset,
            (self.path.left + dt).max(SHORTEST_WAY_TIME),
            goal.most_up,
            dt,
        );
        let mut level = Spring {
            value: self.offset.value.with_y(0.0),
            velocity: self.offset.velocity.with_y(0.0),
        };
        arrive(&mut level, goal.aside, left, goal.most_aside, dt);
        self.offset = Spring {
            value: level.value.with_y(up.value),
            velocity: level.velocity.with_y(up.velocity),
        };
        arrive(&mut self.yaw, 0.0, left, MOST_TURN_ACCELERATION, dt);
        self.lean(lands.normal, LEAN_TIME.min(0.3 * left), dt);
        // A foot in the ground moves up, as fast as the limit of the acceleration allows.
        let ball = goal.clip.y + self.offset.value.y;
        let least = self.path.floor + goal.ball_height;
        if ball < least {
            let out = (2.0 * goal.most_up * (least - ball)).sqrt();
            let velocity = out.min(most).max(self.offset.velocity.y);
            self.offset.value.y += 0.5 * (velocity - self.offset.velocity.y) * dt;
            self.offset.velocity.y = velocity;
        }
    }

    /// The target of the vertical offset: the landing place, or ground on the way that needs more acceleration to
    /// clear.
    fn path_over(&self, goal: &FootGoal, sole: &Sole<'_>, lands: &Footing, left: f64) -> Path {
        let ball = goal.clip + self.offset.value;
        let way = goal.lands_at + goal.aside - ball;
        let now = [self.offset.value.y, self.offset.velocity.y];
        let mut path = Path {
            offset: lands.ball.y - goal.lands_at.y,
            left,
            floor: sole.below(ball).unwrap_or(NO_GROUND),
        };
        let mut hardest = pull(now, path.offset, left);
        for (share, clip) in SWING_SHARES.into_iter().zip(goal.ahead) {
            let Some(height) = sole.highest(ball + way * share, lands.normal) else {
                continue;
            };
            let (offset, time) = (
                height + goal.ball_height - clip,
                (left * share).max(SHORTEST_WAY_TIME),
            );
            let pull = pull(now, offset, time);
            if offset > now[0] && pull > hardest {
                (hardest, path.left, path.offset) = (pull, time, offset);
            }
        }
        path
    }

    /// Comes down where the clip stands.
    fn land(
        &mut self,
        goal: &FootGoal,
        sole: &Sole<'_>,
        (mut ball, to, left): (Spring<DVec3>, Footing, f64),
        dt: f64,
    ) {
        // A foot that is too fast takes longer than planned.
        let left = unhurried(
            &ball,
            to.ball,
            left.max(SHORTEST_WAY_TIME),
            MOST_UP_ACCELERATION,
        );
        arrive(&mut ball, to.ball, left, MOST_UP_ACCELERATION, dt);
        self.set(ball.value - goal.clip, dt);
        arrive(&mut self.yaw, 0.0, left, MOST_TURN_ACCELERATION, dt);
        self.lean(to.normal, LEAN_TIME, dt);
        self.hold = Hold::Lands {
            ball,
            to,
            left: left - dt,
        };
        if left <= SHORTEST_WAY_TIME
            && (ball.value - to.ball).length() < ARRIVED_DISTANCE * goal.leg
        {
            self.plant(goal, sole);
        }
    }

    fn take_step(&mut self, goal: &FootGoal, sole: &Sole<'_>, step: Step, dt: f64) {
        let step = Step {
            passed: step.passed + dt,
            ..step
        };
        let s = (step.passed / step.lasts).min(1.0);
        let share = s * s * s * (10.0 + s * (6.0 * s - 15.0));
        let to = step.to;
        let hump = 4.0 * s * (1.0 - s);
        let lift = step.lift * hump * hump * hump;
        let ball = step.from.lerp(to.ball, share) + DVec3::Y * lift;
        self.set(ball - goal.clip, dt);
        let left = (step.lasts - step.passed).max(SHORTEST_WAY_TIME);
        arrive(&mut self.yaw, 0.0, left, MOST_TURN_ACCELERATION, dt);
        self.lean(to.normal, LEAN_TIME, dt);
        self.hold = Hold::Steps(step);
        if s >= 1.0 {
            self.plant(goal, sole);
        }
    }

    /// How the foot would stand at a place. The ground is looked for again only when the place has moved.
    fn landing(&mut self, place: DVec3, goal: &FootGoal, sole: &Sole<'_>) -> Footing {
        let is_near = |known: &Footing| {
            let way = place - known.ball;
            way.with_y(0.0).length() < SAME_LANDING_DISTANCE * goal.leg
        };
        let known = self
            .landing
            .filter(is_near)
            .unwrap_or_else(|| sole.at(place));
        self.landing = Some(known);
        Footing {
            ball: place.with_y(known.ball.y),
            ..known
        }
    }

    fn set(&mut self, offset: DVec3, dt: f64) {
        self.offset.velocity = (offset - self.offset.value) / dt;
        self.offset.value = offset;
    }

    /// Leans to a normal, with the time constant `time`, seconds.
    fn lean(&mut self, normal: DVec3, time: f64, dt: f64) {
        let share = 1.0 - libm::exp(-dt / time.max(1e-3));
        self.normal = (self.normal + (normal - self.normal) * share).normalize_or(DVec3::Y);
    }
}

#[cfg(test)]
mod tests;
