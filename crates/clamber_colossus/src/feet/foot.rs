use glam::DVec3;
use serde::{Deserialize, Serialize};

use clamber_animation::Spring;

use super::arrive::{arrive, pull, unhurried};
use super::{Carried, Footing, Sole};
use crate::angle::nearest_turn;

/// How a foot is held.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Hold {
    /// It stands here, on ground that was at this height below its ball, if there was any.
    Planted {
        at: Footing,
        heading: f64,
        below: f64,
    },
    /// It is where its clip has it, but for an offset that goes to where it lands.
    Swings,
    /// It comes down where its clip stands, although it was in the air when that clip began; seconds until then.
    Lands {
        ball: Spring<DVec3>,
        to: Footing,
        left: f64,
    },
    /// It takes a step that is not in its clip.
    Steps(Step),
}

/// A step that is not in a clip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Step {
    from: DVec3,
    to: Footing,
    /// How high it goes, metres.
    lift: f64,
    passed: f64,
    lasts: f64,
}

/// What the offset of a swinging foot goes to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Path {
    /// Up, metres.
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
    /// Where its clip had the ball in the last tick.
    clip: DVec3,
    /// From where the clip has the ball to where it is.
    offset: Spring<DVec3>,
    /// How far the foot is turned against its clip about up, radians.
    yaw: Spring<f64>,
    /// How flat it is on the ground: from 0, as its clip has it, to 1.
    flat: Spring<f64>,
    /// How firmly it stands: from 0, in flight, to 1.
    firm: Spring<f64>,
    /// Normal of the ground that it leans to.
    normal: DVec3,
    /// How far a planted ball still is from its place.
    settling: Spring<DVec3>,
    /// What its offset goes to.
    path: Path,
    /// Where it comes down, as looked for last.
    landing: Option<Footing>,
    /// True if it stands where it should not.
    wants_step: bool,
    /// True if its leg did not reach it in the last tick.
    is_stretched: bool,
}

/// What a foot should do in a tick, in world space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FootGoal {
    /// Where the clip has the ball.
    pub(crate) clip: DVec3,
    /// Where it will have it once it has faded in.
    pub(crate) settled: DVec3,
    /// Whether the clip stands on it, for how many seconds yet, and seconds until it does next.
    pub(crate) stands: bool,
    pub(crate) stands_for: f64,
    pub(crate) lands_in: f64,
    /// Where the clip's ball will be then.
    pub(crate) lands_at: DVec3,
    /// From there to where it is to land, level; and with how much acceleration it may go there, metres a second
    /// squared.
    pub(crate) aside: DVec3,
    pub(crate) most_aside: f64,
    /// With how much it may go up and down in a swing.
    pub(crate) most_up: f64,
    /// Height of the clip's ball at [`SHARES`] of the time until then.
    pub(crate) ahead: [f64; 3],
    /// Where the clip's foot points to, radians about up.
    pub(crate) heading: f64,
    /// Height of a ball above the ground, and the leg's length, metres.
    pub(crate) ball_height: f64,
    pub(crate) leg: f64,
    /// True if the foot may take a step of its own.
    pub(crate) may_step: bool,
    /// True if it looks whether what it stands on is still there.
    pub(crate) looks: bool,
    /// True if the clip walks or turns: it brings steps of its own.
    pub(crate) is_gait: bool,
    /// True if the clip lifts the foot by itself before it ends.
    pub(crate) is_lifted: bool,
}

/// A foot that stands further from where its clip does takes a step: a share of the leg's length, and radians.
const STEPS_BEYOND: f64 = 0.12;
const STEPS_TURNED: f64 = 0.45;

/// A leg that is too short for its foot takes no step if that would bring it less far than this share of its length: its
/// hips come down instead.
const NO_STEP: f64 = 0.02;

/// The least time of a step of its own, as a share of `sqrt(leg / g)`, and how high it goes at least, as a share of the
/// leg's length.
pub(crate) const STEP_TIME: f64 = 1.5;
const STEP_HEIGHT: f64 = 0.04;

/// The most acceleration of an offset up and down, and to the sides, metres a second squared, and of a foot's turn,
/// radians a second squared. Together the first two are 5.6: below 6, which skin below the knee may have in a swing.
pub(crate) const MOST_UP: f64 = 4.4;
pub(crate) const MOST_ASIDE: f64 = 3.4;
const MOST_TURN: f64 = 3.0;

/// Shares of a swing at which the ground on its way is looked at.
pub(crate) const SHARES: [f64; 3] = [0.25, 0.5, 0.75];

/// The least time in which an offset goes to where it should, seconds.
const LEAST: f64 = 0.15;

/// Time constant with which a foot leans to the ground, seconds.
const LEANS: f64 = 0.1;

/// A foot that is higher than this above the ground when its clip stands comes down first, and ground that moves by
/// more than that carries it no longer, as shares of the leg's length.
const HIGH: f64 = 0.03;
const GONE: f64 = 0.003;

/// A foot that its clip does not lift is lifted while it walks or turns if it is further than this from where its clip
/// stands, as a share of the leg's length.
const LEFT_BEHIND: f64 = 0.3;

/// A foot was left behind if it is further than this from where its clip stands, as a share of the leg's length.
const LATE: f64 = 0.06;

/// A foot that was left behind does not come down for less than this, as a share of the time of a step.
const TOO_SHORT: f64 = 0.2;

/// A foot has come down when it is as near as this to where it should, as a share of the leg's length.
const ARRIVED: f64 = 0.01;

/// Stands for no ground below: JSON has no infinity.
const NO_GROUND: f64 = f64::MIN;

/// A place to land on is looked for anew when it has moved by this share of the leg's length.
const SAME: f64 = 0.03;

/// Half time in which a foot that has come down reaches its exact place, seconds.
const SETTLES: f64 = 0.08;

/// Half time in which a foot that was lifted loses its hold, as a share of the time of a step.
const LETS_GO: f64 = 0.25;

pub(crate) const GRAVITY: f64 = 9.81;

impl Foot {
    /// A foot that is where its clip has it.
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

    /// True if no number of it is larger than this, or none at all.
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
        // A clip may never land, and below it may be no ground.
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
        // No comparison with what is no number is true.
        is_path && is_floor && all.iter().all(|size| *size <= most)
    }

    /// True if it stands.
    pub(crate) fn is_planted(&self) -> bool {
        matches!(self.hold, Hold::Planted { .. })
    }

    /// True if it stands where it should not, and waits for its turn to step.
    pub(crate) fn wants_step(&self) -> bool {
        self.wants_step
    }

    /// Says whether its leg reaches it.
    pub(crate) fn set_stretched(&mut self, is_stretched: bool) {
        self.is_stretched = is_stretched;
    }

    /// From where the clip has the ball to where it is, metres.
    pub(crate) fn offset(&self) -> DVec3 {
        self.offset.value
    }

    /// How far it is turned against its clip about up, radians.
    pub(crate) fn yaw(&self) -> f64 {
        self.yaw.value
    }

    /// How flat it is on the ground: from 0, as its clip has it, to 1.
    pub(crate) fn flat(&self) -> f64 {
        self.flat.value.clamp(0.0, 1.0)
    }

    /// How firmly it stands: from 0, in flight, to 1. It lets go less fast than it gets a hold.
    pub(crate) fn firm(&self) -> f64 {
        self.firm.value.clamp(0.0, 1.0)
    }

    /// Normal of the ground that it leans to.
    pub(crate) fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Stands on the ground where its clip has it, at once.
    pub(crate) fn place(&mut self, goal: &FootGoal, sole: &Sole<'_>) {
        self.plant(goal, sole);
        self.settling = Spring::default();
        (self.flat, self.firm) = (Spring::at(1.0), Spring::at(1.0));
        if let Hold::Planted { at, .. } = self.hold {
            self.normal = at.normal;
            self.offset = Spring::at(at.ball - goal.clip);
        }
    }

    /// Goes with ground that has moved.
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

    /// Lets a tick of `dt` seconds pass. Returns true if the foot has just come down.
    pub(crate) fn step(&mut self, goal: &FootGoal, sole: &Sole<'_>, dt: f64) -> bool {
        let was_up = !self.is_planted();
        self.decide(goal, sole, dt);
        match self.hold {
            Hold::Planted { at, heading, .. } => self.stand(goal, &at, heading, dt),
            Hold::Swings if goal.stands => self.catch_up(goal, sole, dt),
            Hold::Swings => self.swing(goal, sole, goal.lands_in.max(LEAST), dt),
            Hold::Lands { ball, to, left } => self.land(goal, sole, (ball, to, left), dt),
            Hold::Steps(step) => self.take_step(goal, sole, step, dt),
        }
        let flat = f64::from(u8::from(self.is_planted()));
        self.flat.step(flat, SETTLES, dt);
        let time = if self.is_planted() {
            SETTLES
        } else {
            LETS_GO * goal.step_time()
        };
        self.firm.step(flat, time, dt);
        self.clip = goal.clip;
        was_up && self.is_planted()
    }

    /// Goes from one way of being held to another one.
    fn decide(&mut self, goal: &FootGoal, sole: &Sole<'_>, dt: f64) {
        self.wants_step = false;
        match self.hold {
            Hold::Planted { at, below, .. } if goal.stands => {
                let gap = goal.settled - at.ball;
                let level = DVec3::new(gap.x, 0.0, gap.z).length();
                let is_off = level > STEPS_BEYOND * goal.leg || self.yaw.value.abs() > STEPS_TURNED;
                self.wants_step = is_off && !goal.is_gait && !goal.is_lifted;
                let is_gone = goal.looks
                    && match sole.below(at.ball) {
                        Some(now) => (now - below).abs() > GONE * goal.leg,
                        None => below != NO_GROUND,
                    };
                if is_gone && sole.has_ground() {
                    self.hold = Hold::Lands {
                        ball: Spring::at(at.ball),
                        to: sole.at(goal.settled),
                        left: goal.step_time(),
                    };
                } else if goal.is_gait && (self.is_stretched || level > LEFT_BEHIND * goal.leg) {
                    self.hold = Hold::Swings;
                    self.path.left = 0.0;
                } else if self.wants_step && goal.may_step
                    || self.is_stretched && level > NO_STEP * goal.leg
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
                if ball.y - sole.at(ball).ball.y > HIGH * goal.leg {
                    let velocity = (goal.clip - self.clip) / dt + self.offset.velocity;
                    let to = sole.at(goal.settled);
                    // The end of a kick stops the clip's foot at once. The speed that is left must not carry this foot
                    // past where it lands.
                    let most = (MOST_UP * ball.distance(to.ball)).sqrt();
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

    /// A step from a place to where its clip has it, over what lies between.
    fn step_from(&mut self, from: DVec3, goal: &FootGoal, sole: &Sole<'_>) -> Step {
        let to = sole.at(goal.settled);
        let level = (to.ball - from).with_y(0.0).length();
        let over = SHARES.into_iter().filter_map(|share| {
            let place = from.lerp(to.ball, share);
            // The hump of a step is that high at a share of its way.
            let hump = 4.0 * share * (1.0 - share);
            let rise = sole.highest(place, to.normal)? + goal.ball_height - place.y;
            Some(rise / (hump * hump * hump))
        });
        let lift = over
            .fold(STEP_HEIGHT * goal.leg, f64::max)
            .min(0.5 * goal.leg);
        // The peaks of a quintic from rest to rest, and of the hump: 5.77 d / T^2, 24 h / T^2.
        let lasts = (5.77 * level / MOST_ASIDE)
            .max(24.0 * lift / MOST_UP)
            .sqrt();
        Step {
            from,
            to,
            lift,
            passed: 0.0,
            lasts: lasts.max(goal.step_time()),
        }
    }

    /// True for a foot that was left behind: its clip walks on and stands, but not there.
    fn is_late(&self, goal: &FootGoal) -> bool {
        goal.is_gait && self.offset.value.with_y(0.0).length() > LATE * goal.leg
    }

    /// Hurries after its clip, above the ground.
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

    /// Comes down where it is.
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
        self.settling.step(DVec3::ZERO, SETTLES, dt);
        self.set(at.ball + self.settling.value - goal.clip, dt);
        let yaw = nearest_turn(heading - goal.heading);
        self.yaw = Spring {
            value: yaw,
            velocity: (yaw - self.yaw.value) / dt,
        };
        self.lean(at.normal, LEANS, dt);
    }

    /// Flies as its clip does, but for an offset that goes to where it comes down in `left` seconds, over what lies
    /// between.
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
            (self.path.left + dt).max(LEAST),
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
        arrive(&mut self.yaw, 0.0, left, MOST_TURN, dt);
        self.lean(lands.normal, LEANS.min(0.3 * left), dt);
        // Out of the ground, as fast as may be felt.
        let ball = goal.clip.y + self.offset.value.y;
        let least = self.path.floor + goal.ball_height;
        if ball < least {
            let out = (2.0 * goal.most_up * (least - ball)).sqrt();
            let velocity = out.min(most).max(self.offset.velocity.y);
            self.offset.value.y += 0.5 * (velocity - self.offset.velocity.y) * dt;
            self.offset.velocity.y = velocity;
        }
    }

    /// Where an offset has to be, and when: where the foot lands, or over what lies between, if that takes more
    /// acceleration.
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
        for (share, clip) in SHARES.into_iter().zip(goal.ahead) {
            let Some(height) = sole.highest(ball + way * share, lands.normal) else {
                continue;
            };
            let (offset, time) = (height + goal.ball_height - clip, (left * share).max(LEAST));
            let pull = pull(now, offset, time);
            if offset > now[0] && pull > hardest {
                (hardest, path.left, path.offset) = (pull, time, offset);
            }
        }
        path
    }

    /// Comes down where its clip stands.
    fn land(
        &mut self,
        goal: &FootGoal,
        sole: &Sole<'_>,
        (mut ball, to, left): (Spring<DVec3>, Footing, f64),
        dt: f64,
    ) {
        // It takes longer than planned if it is too fast for that.
        let left = unhurried(&ball, to.ball, left.max(LEAST), MOST_UP);
        arrive(&mut ball, to.ball, left, MOST_UP, dt);
        self.set(ball.value - goal.clip, dt);
        arrive(&mut self.yaw, 0.0, left, MOST_TURN, dt);
        self.lean(to.normal, LEANS, dt);
        self.hold = Hold::Lands {
            ball,
            to,
            left: left - dt,
        };
        if left <= LEAST && (ball.value - to.ball).length() < ARRIVED * goal.leg {
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
        let left = (step.lasts - step.passed).max(LEAST);
        arrive(&mut self.yaw, 0.0, left, MOST_TURN, dt);
        self.lean(to.normal, LEANS, dt);
        self.hold = Hold::Steps(step);
        if s >= 1.0 {
            self.plant(goal, sole);
        }
    }

    /// Where it would stand at a place, looked for anew only when that has moved on.
    fn landing(&mut self, place: DVec3, goal: &FootGoal, sole: &Sole<'_>) -> Footing {
        let is_near = |known: &Footing| {
            let way = place - known.ball;
            way.with_y(0.0).length() < SAME * goal.leg
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

    /// Leans to a normal, with a time constant.
    fn lean(&mut self, normal: DVec3, time: f64, dt: f64) {
        let share = 1.0 - libm::exp(-dt / time.max(1e-3));
        self.normal = (self.normal + (normal - self.normal) * share).normalize_or(DVec3::Y);
    }
}

impl FootGoal {
    /// True if the clip lifts the foot so soon that it need not come down before.
    fn is_lifted_soon(&self) -> bool {
        self.is_gait && self.stands_for < TOO_SHORT * self.step_time()
    }

    /// How long a step of its own lasts at least, seconds.
    fn step_time(&self) -> f64 {
        STEP_TIME * (self.leg / GRAVITY).sqrt()
    }
}

#[cfg(test)]
mod tests;
