use glam::DVec3;
use serde::{Deserialize, Serialize};

use clamber_animation::Spring;

/// How a foot is held.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Hold {
    /// It stands: its ball is here, on the ground.
    Planted { ball: DVec3 },
    /// It is where its clip has it, but for an offset that goes to where it lands.
    Swings,
    /// It takes a step that is not in its clip.
    Steps {
        from: DVec3,
        passed: f64,
        lasts: f64,
    },
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
}

/// What a foot should do in a tick, in world space.
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
        }
    }

    /// True if it stands.
    pub(crate) fn is_planted(&self) -> bool {
        matches!(self.hold, Hold::Planted { .. })
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

    /// Lets a tick of `dt` seconds pass. `under` tells the height of the ground that carries the foot at a place, and its
    /// normal. Returns true if the foot has just come down.
    pub(crate) fn step(
        &mut self,
        goal: &FootGoal,
        under: impl Fn(DVec3) -> Option<(f64, DVec3)>,
        dt: f64,
    ) -> bool {
        let was_up = !self.is_planted();
        let on_ground = |place: DVec3| {
            let height = under(place).map_or(place.y - goal.ball_height, |(height, _)| height);
            DVec3::new(place.x, height + goal.ball_height, place.z)
        };
        match self.hold {
            Hold::Planted { ball } if goal.stands => {
                let gap = goal.clip - ball;
                let level = DVec3::new(gap.x, 0.0, gap.z).length();
                let is_off = level > STEPS_BEYOND * goal.leg || self.yaw.value.abs() > STEPS_TURNED;
                if goal.may_step && is_off {
                    let from = goal.clip + self.offset.value;
                    let least = STEP_TIME * (goal.leg / GRAVITY).sqrt();
                    // The peak of a quintic from rest to rest is 5.77 d / T^2.
                    let lasts = (5.77 * level / STEP_ACCELERATION).sqrt().max(least);
                    self.hold = Hold::Steps {
                        from,
                        passed: 0.0,
                        lasts,
                    };
                } else {
                    self.settling.step(DVec3::ZERO, SETTLES, dt);
                    self.set(ball + self.settling.value - goal.clip, dt);
                    self.yaw.value -= goal.turned;
                }
            }
            Hold::Planted { .. } => self.hold = Hold::Swings,
            Hold::Swings if goal.stands => {
                let ball = goal.clip + self.offset.value;
                let place = on_ground(ball);
                self.settling = Spring {
                    value: ball - place,
                    velocity: DVec3::new(0.0, self.offset.velocity.y.min(0.0), 0.0),
                };
                self.hold = Hold::Planted { ball: place };
            }
            Hold::Swings | Hold::Steps { .. } => {}
        }
        match self.hold {
            Hold::Planted { .. } => {}
            Hold::Swings => {
                let lands = on_ground(goal.lands_at);
                let wanted = DVec3::new(0.0, lands.y - goal.lands_at.y, 0.0);
                let left = goal.lands_in.max(LEAST);
                arrive(&mut self.offset, wanted, left, dt);
                arrive(&mut self.yaw, 0.0, left, dt);
                // Never through the ground on its way.
                let ball = goal.clip + self.offset.value;
                let least = on_ground(ball);
                if ball.y < least.y {
                    self.set(self.offset.value + DVec3::Y * (least.y - ball.y), dt);
                }
            }
            Hold::Steps {
                from,
                passed,
                lasts,
            } => {
                let passed = passed + dt;
                let s = (passed / lasts).min(1.0);
                let share = s * s * s * (10.0 + s * (6.0 * s - 15.0));
                let to = on_ground(goal.clip);
                let lift = STEP_HEIGHT * goal.leg * 16.0 * s * s * (1.0 - s) * (1.0 - s);
                let ball = from.lerp(to, share) + DVec3::Y * lift;
                self.set(ball - goal.clip, dt);
                arrive(&mut self.yaw, 0.0, (lasts - passed).max(LEAST), dt);
                self.hold = Hold::Steps {
                    from,
                    passed,
                    lasts,
                };
                if s >= 1.0 {
                    self.settling = Spring::default();
                    self.hold = Hold::Planted { ball: to };
                }
            }
        }
        let wanted = if self.is_planted() {
            let ball = goal.clip + self.offset.value;
            under(ball).map_or(DVec3::Y, |(_, normal)| normal)
        } else {
            DVec3::Y
        };
        self.normal = (self.normal + (wanted - self.normal) * (1.0 - libm::exp(-dt / 0.15)))
            .normalize_or(DVec3::Y);
        was_up && self.is_planted()
    }

    fn set(&mut self, offset: DVec3, dt: f64) {
        self.offset.velocity = (offset - self.offset.value) / dt;
        self.offset.value = offset;
    }
}

/// Moves a value so that it is at its goal, at rest, in `left` seconds, by a cubic in time.
fn arrive<T: clamber_animation::Springy>(spring: &mut Spring<T>, goal: T, left: f64, dt: f64) {
    let away = goal - spring.value;
    let acceleration = away * (6.0 / (left * left)) - spring.velocity * (4.0 / left);
    let dt = dt.min(left);
    spring.value = spring.value + spring.velocity * dt + acceleration * (0.5 * dt * dt);
    spring.velocity = spring.velocity + acceleration * dt;
}
