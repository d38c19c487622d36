use glam::DVec3;
use serde::{Deserialize, Serialize};

use clamber_animation::Spring;

use super::{Footing, Sole};

/// How a foot is held.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Hold {
    /// It stands here, on ground that was at this height below its ball.
    Planted { at: Footing, below: f64 },
    /// It is where its clip has it, but for an offset that goes to where it lands.
    Swings,
    /// It comes down where its clip stands, although it was in the air when that clip began; seconds until then.
    Lands { left: f64 },
    /// It takes a step that is not in its clip.
    Steps(Step),
}

/// A step that is not in a clip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Step {
    from: DVec3,
    passed: f64,
    lasts: f64,
}

/// A foot of a creature, in world space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Foot {
    hold: Hold,
    /// From where the clip has the ball to where it is.
    offset: Spring<DVec3>,
    /// How far the foot is turned against its clip about up, radians.
    yaw: Spring<f64>,
    /// Normal of the ground that it leans to.
    normal: DVec3,
    /// How far a planted ball still is from its place.
    settling: Spring<DVec3>,
    /// True if it stands where it should not.
    wants_step: bool,
}

/// What a foot should do in a tick, in world space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FootGoal {
    /// Where the clip has the ball.
    pub(crate) clip: DVec3,
    /// Whether the clip stands on it, and seconds until it does next.
    pub(crate) stands: bool,
    pub(crate) lands_in: f64,
    /// Where the clip's ball will be then.
    pub(crate) lands_at: DVec3,
    /// How far the creature turned in this tick, radians.
    pub(crate) turned: f64,
    /// Height of a ball above the ground, and the leg's length, metres.
    pub(crate) ball_height: f64,
    pub(crate) leg: f64,
    /// True if the foot may take a step of its own.
    pub(crate) may_step: bool,
    /// True if the clip walks or turns: it brings steps of its own.
    pub(crate) is_gait: bool,
}

/// A foot that stands further from where its clip does takes a step: a share of the leg's length, and radians.
const STEPS_BEYOND: f64 = 0.12;
const STEPS_TURNED: f64 = 0.45;

/// The most acceleration of a step, metres a second squared, its least time, as a share of `sqrt(leg / g)`, and how high
/// it goes, as a share of the leg's length.
const STEP_ACCELERATION: f64 = 4.5;
const STEP_TIME: f64 = 0.9;
const STEP_HEIGHT: f64 = 0.07;

/// The least time in which an offset goes to where it should, seconds.
const LEAST: f64 = 0.15;

/// Time constant with which a foot leans to the ground, seconds.
const LEANS: f64 = 0.15;

/// A foot that is higher than this above the ground when its clip stands comes down first, and ground that moves by more
/// than that carries it no longer, as shares of the leg's length.
const HIGH: f64 = 0.03;
const GONE: f64 = 0.003;

/// Half time in which a foot that has come down reaches its exact place, seconds.
const SETTLES: f64 = 0.08;

const GRAVITY: f64 = 9.81;

impl Foot {
    /// A foot that is where its clip has it.
    pub(crate) fn new() -> Self {
        Self {
            hold: Hold::Swings,
            offset: Spring::default(),
            yaw: Spring::default(),
            normal: DVec3::Y,
            settling: Spring::default(),
            wants_step: false,
        }
    }

    /// True if it stands.
    pub(crate) fn is_planted(&self) -> bool {
        matches!(self.hold, Hold::Planted { .. })
    }

    /// True if it stands where it should not, and waits for its turn to step.
    pub(crate) fn wants_step(&self) -> bool {
        self.wants_step
    }

    /// From where the clip has the ball to where it is, metres.
    pub(crate) fn offset(&self) -> DVec3 {
        self.offset.value
    }

    /// How far it is turned against its clip about up, radians.
    pub(crate) fn yaw(&self) -> f64 {
        self.yaw.value
    }

    /// Normal of the ground that it leans to.
    pub(crate) fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Lets a tick of `dt` seconds pass. Returns true if the foot has just come down.
    pub(crate) fn step(&mut self, goal: &FootGoal, sole: &Sole<'_>, dt: f64) -> bool {
        let was_up = !self.is_planted();
        self.decide(goal, sole);
        match self.hold {
            Hold::Planted { at, .. } => self.stand(goal, &at, dt),
            Hold::Swings => self.swing(goal, sole, goal.lands_in.max(LEAST), dt),
            Hold::Lands { left } => self.land(goal, sole, left, dt),
            Hold::Steps(step) => self.take_step(goal, sole, step, dt),
        }
        was_up && self.is_planted()
    }

    /// Goes from one way of being held to another one.
    fn decide(&mut self, goal: &FootGoal, sole: &Sole<'_>) {
        self.wants_step = false;
        match self.hold {
            Hold::Planted { at, below } if goal.stands => {
                let gap = goal.clip - at.ball;
                let level = DVec3::new(gap.x, 0.0, gap.z).length();
                let is_off = level > STEPS_BEYOND * goal.leg || self.yaw.value.abs() > STEPS_TURNED;
                self.wants_step = is_off && !goal.is_gait;
                let is_gone = sole
                    .below(at.ball)
                    .is_none_or(|now| (now - below).abs() > GONE * goal.leg);
                if is_gone && sole.has_ground() {
                    self.hold = Hold::Lands {
                        left: goal.step_time(),
                    };
                } else if self.wants_step && goal.may_step {
                    // The peak of a quintic from rest to rest is 5.77 d / T^2.
                    let lasts = (5.77 * level / STEP_ACCELERATION)
                        .sqrt()
                        .max(goal.step_time());
                    let from = goal.clip + self.offset.value;
                    self.hold = Hold::Steps(Step {
                        from,
                        passed: 0.0,
                        lasts,
                    });
                }
            }
            Hold::Planted { .. } | Hold::Lands { .. } if !goal.stands => self.hold = Hold::Swings,
            Hold::Swings if goal.stands => {
                let ball = goal.clip + self.offset.value;
                if ball.y - sole.at(ball, goal).ball.y > HIGH * goal.leg {
                    self.hold = Hold::Lands {
                        left: goal.step_time(),
                    };
                } else {
                    self.plant(goal, sole);
                }
            }
            _ => {}
        }
    }

    /// Comes down where it is.
    fn plant(&mut self, goal: &FootGoal, sole: &Sole<'_>) {
        let ball = goal.clip + self.offset.value;
        let at = sole.at(ball, goal);
        self.settling = Spring {
            value: ball - at.ball,
            velocity: DVec3::new(0.0, self.offset.velocity.y.min(0.0), 0.0),
        };
        let below = sole.below(at.ball).unwrap_or(at.ball.y);
        self.hold = Hold::Planted { at, below };
    }

    fn stand(&mut self, goal: &FootGoal, at: &Footing, dt: f64) {
        self.settling.step(DVec3::ZERO, SETTLES, dt);
        self.set(at.ball + self.settling.value - goal.clip, dt);
        self.yaw.value -= goal.turned;
        self.lean(at.normal, LEANS, dt);
    }

    /// Flies as its clip does, but for an offset that goes to where it comes down in `left` seconds, over what lies between.
    fn swing(&mut self, goal: &FootGoal, sole: &Sole<'_>, left: f64, dt: f64) {
        let lands = sole.at(goal.lands_at, goal);
        let mut wanted = DVec3::new(0.0, lands.ball.y - goal.lands_at.y, 0.0);
        let ball = goal.clip + self.offset.value;
        let way = goal.lands_at - ball;
        // What lies between has to be passed in a share of the time: it wins if it takes more acceleration.
        let (mut hardest, mut within) = (
            pull(self.offset.value.y, self.offset.velocity.y, wanted.y, left),
            left,
        );
        for share in [0.25, 0.5, 0.75] {
            let Some(height) = sole.below(ball + way * share) else {
                continue;
            };
            let clip = goal.clip.y + (goal.lands_at.y - goal.clip.y) * share;
            let (offset, time) = (height + goal.ball_height - clip, (left * share).max(LEAST));
            let pull = pull(self.offset.value.y, self.offset.velocity.y, offset, time);
            if offset > self.offset.value.y && pull > hardest {
                (hardest, within, wanted.y) = (pull, time, offset);
            }
        }
        let mut up = Spring {
            value: self.offset.value.y,
            velocity: self.offset.velocity.y,
        };
        arrive(&mut up, wanted.y, within, dt);
        let mut level = Spring {
            value: self.offset.value.with_y(0.0),
            velocity: self.offset.velocity.with_y(0.0),
        };
        arrive(&mut level, DVec3::ZERO, left, dt);
        self.offset = Spring {
            value: level.value.with_y(up.value),
            velocity: level.velocity.with_y(up.velocity),
        };
        arrive(&mut self.yaw, 0.0, left, dt);
        self.lean(lands.normal, LEANS.min(0.3 * left), dt);
        // Never through the ground on its way.
        let ball = goal.clip + self.offset.value;
        let least = sole.at(ball, goal).ball;
        if ball.y < least.y {
            self.set(self.offset.value + DVec3::Y * (least.y - ball.y), dt);
        }
    }

    /// Comes down where its clip stands.
    fn land(&mut self, goal: &FootGoal, sole: &Sole<'_>, left: f64, dt: f64) {
        let goal = FootGoal {
            lands_at: goal.clip,
            ..*goal
        };
        self.swing(&goal, sole, left.max(dt), dt);
        self.hold = Hold::Lands { left: left - dt };
        if left <= dt {
            self.plant(&goal, sole);
        }
    }

    fn take_step(&mut self, goal: &FootGoal, sole: &Sole<'_>, step: Step, dt: f64) {
        let step = Step {
            passed: step.passed + dt,
            ..step
        };
        let s = (step.passed / step.lasts).min(1.0);
        let share = s * s * s * (10.0 + s * (6.0 * s - 15.0));
        let to = sole.at(goal.clip, goal);
        let lift = STEP_HEIGHT * goal.leg * 16.0 * s * s * (1.0 - s) * (1.0 - s);
        let ball = step.from.lerp(to.ball, share) + DVec3::Y * lift;
        self.set(ball - goal.clip, dt);
        let left = (step.lasts - step.passed).max(LEAST);
        arrive(&mut self.yaw, 0.0, left, dt);
        self.lean(to.normal, LEANS, dt);
        self.hold = Hold::Steps(step);
        if s >= 1.0 {
            self.plant(goal, sole);
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
    /// How long a step of its own lasts at least, seconds.
    fn step_time(&self) -> f64 {
        STEP_TIME * (self.leg / GRAVITY).sqrt()
    }
}

/// The acceleration with which [`arrive`] begins.
fn pull(value: f64, velocity: f64, goal: f64, left: f64) -> f64 {
    (goal - value) * (6.0 / (left * left)) - velocity * (4.0 / left)
}

/// Moves a value so that it is at its goal, at rest, in `left` seconds, by a cubic in time.
fn arrive<T: clamber_animation::Springy>(spring: &mut Spring<T>, goal: T, left: f64, dt: f64) {
    let away = goal - spring.value;
    let acceleration = away * (6.0 / (left * left)) - spring.velocity * (4.0 / left);
    let dt = dt.min(left);
    spring.value = spring.value + spring.velocity * dt + acceleration * (0.5 * dt * dt);
    spring.velocity = spring.velocity + acceleration * dt;
}
