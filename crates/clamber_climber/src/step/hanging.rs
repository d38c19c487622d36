//! Hanging by the hands from a grip: a pendulum that can only hold on.

use clamber_mover::{Arm, MovePlane, Moved, Path};
use glam::DVec3;

use super::carrying::Carried;
use super::holding::GRIP_COOLDOWN;
use super::moving::Intent;
use super::{NextMode, Tick};
use crate::config::GripConfig;
use crate::pendulum::{Pendulum, PendulumTick};
use crate::{ClimberEvent, ClimberMode};

/// Speed at which the climber pulls itself in once its hold is calm, as a multiple of the climbing speed.
const PULL_IN_SPEED: f64 = 4.0 / 3.0;

/// Share of the shake that makes the climber hang, up to which its hold counts as calm.
const CALM_SHAKE_SHARE: f64 = 0.7;

/// Speed at which stretched arms shorten again, in arm lengths a second: 4.5 m/s for arms of 0.9 m. The speed is at
/// least the speed of [`PULL_IN_SPEED`], or short arms would pull more slowly than they climb.
const ARM_SHORTENING_SPEED: f64 = 5.0;

/// Multiple of their length to which arms can be stretched before they let go.
const MAX_ARM_STRETCH: f64 = 1.5;

/// Distance from its hands at which the climber climbs again, in radii. Not 1.25: the arms of the default configuration
/// get exactly that short in a whole number of ticks, and rounding would decide.
const CLIMB_AGAIN_DISTANCE: f64 = 1.27;

/// Memory of a climber that hangs by its hands from a grip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct HangingMemory {
    /// Length of the arms, metres. Shorter than at full stretch while the climber pulls itself in.
    pub arm: f64,
    /// Time for which the hold has been calm enough to climb on, seconds.
    pub calm: f64,
    /// End of the legs after the last tick, relative to the climber's position, in world space, metres. Zero while the
    /// legs are drawn in.
    pub legs: DVec3,
}

impl Tick<'_> {
    pub(super) fn hang(&mut self) -> NextMode {
        let (Some(grip), Some(carried)) = (self.config.grip, self.carried) else {
            return self.leave(ClimberMode::Falling);
        };
        if let Some(next) = self.be_refused_by_hold(self.on.grip) {
            return next;
        }
        if !self.input.grip {
            self.event(ClimberEvent::Released);
            self.state.grip_cooldown = GRIP_COOLDOWN;
            self.state.velocity = self.before.velocity;
            return self.leave(ClimberMode::Falling);
        }
        let now = carried.velocity();
        // A climber that has just begun to hang is at rest below its hands, apart from a blow.
        let (pivot_was, relative) = match carried.velocity_before {
            Some(before) if !self.has_entered => {
                // The climber's own pull has changed the velocity of its hands. Along the arms, it does not feel this
                // change as an acceleration, since the arms pulled between two bodies. Across the arms, an object that
                // holds the hold may have prevented the change.
                let changed = before + self.change_by_load() - self.before.base_velocity;
                let arm = carried.start - carried.motion.previous_position;
                let along = changed.project_onto_normalized(arm.normalize_or(self.config.up()));
                (
                    self.before.base_velocity + along,
                    self.before.velocity - self.before.base_velocity,
                )
            }
            _ => (now, self.struck),
        };
        self.reach_or_pull(&carried, &grip);
        self.swing(&carried, pivot_was, relative)
    }

    /// Stretches the arms, or pulls the climber in once the hold has been calm for long enough.
    fn reach_or_pull(&mut self, carried: &Carried, grip: &GripConfig) {
        let leans_over = self.config.slope(carried.normal()) > grip.max_overhang;
        let shakes = self.state.shake.length() > CALM_SHAKE_SHARE * grip.hang_acceleration;
        let dt = self.dt();
        let is_calm = !shakes && !leans_over && !self.has_entered;
        self.state.hanging.calm = if is_calm {
            self.state.hanging.calm + dt
        } else {
            0.0
        };
        if is_calm && self.state.hanging.calm >= grip.calm_time {
            let reach = self
                .before
                .position
                .distance(carried.motion.previous_position);
            let pulled = PULL_IN_SPEED * grip.climb_speed * dt;
            self.state.hanging.arm = (self.state.hanging.arm.min(reach) - pulled).max(0.0);
        }
        if self.state.hanging.calm == 0.0 {
            self.state.hanging.arm = self.config.hang.arm_length;
        }
    }

    /// Swings below the hands. `pivot_was` is the velocity of the hands in the last tick, and `relative` the body's
    /// velocity relative to that.
    fn swing(&mut self, carried: &Carried, pivot_was: DVec3, relative: DVec3) -> NextMode {
        let hang = &self.config.hang;
        let pivot = carried.motion.position;
        let radius = self.config.body.radius;
        let arm = carried.start - carried.motion.previous_position;
        let climb_speed = self.config.grip.map_or(0.0, |grip| grip.climb_speed);
        let pulled =
            (ARM_SHORTENING_SPEED * hang.arm_length).max(PULL_IN_SPEED * climb_speed) * self.dt();
        let length = self.state.hanging.arm.max(radius);
        let length = length.max(arm.length() - pulled);
        let mut pendulum = Pendulum {
            arm,
            velocity: relative,
        };
        let pivot_change = carried.velocity() - pivot_was;
        pendulum.step(&PendulumTick {
            length,
            gravity: self.config.gravity,
            pivot_change,
            damping: hang.damping,
            dt: self.dt(),
        });
        let free = relative - pivot_change + self.config.gravity * self.dt();
        let stopped = if self.has_entered {
            self.own_velocity()
        } else {
            DVec3::ZERO
        };
        self.pull = Some((pendulum.velocity - free - stopped) * self.config.body.mass);
        let path = Path {
            arm: Some(Arm { pivot, length }),
            ..self.path(pivot + pendulum.arm)
        };
        let legs = pendulum.arm.normalize_or(-self.config.up()) * hang.leg_length;
        let moved = self.slide_with_legs(&path, legs);
        let velocity = carried.velocity() + pendulum.velocity;
        self.keep_support(carried, moved.position);
        self.state.velocity = if moved.position == path.target {
            velocity
        } else {
            let clipped = self.clipped_by_arm(velocity, carried, moved.position - pivot);
            velocity + self.shared_with_hold(clipped - velocity)
        };
        // After a blow, the climber swings although the hold is calm: the swing ends only after `calm_time`.
        let calm_time = self.config.grip.map_or(0.0, |grip| grip.calm_time);
        let longest = hang.arm_length.max(radius) * MAX_ARM_STRETCH;
        let reach = moved.position.distance(pivot);
        if reach > longest {
            // An obstacle in the way has torn the climber off.
            self.state.grip_cooldown = GRIP_COOLDOWN;
            return self.lose_footing();
        }
        if self.state.hanging.calm >= calm_time && reach <= CLIMB_AGAIN_DISTANCE * radius {
            return NextMode::Change(ClimberMode::Holding);
        }
        NextMode::Stay
    }

    /// Moves the body with its legs, which end at `legs` relative to its position. Obstacles stop legs as they stop the
    /// body. Legs without room are drawn in, and let down again in a later tick in which there is room.
    fn slide_with_legs(&mut self, path: &Path, legs: DVec3) -> Moved {
        let were = self.state.hanging.legs;
        if were != DVec3::ZERO {
            let mut with_legs = Path {
                start_axis: [DVec3::ZERO, were],
                ..*path
            };
            with_legs.body.axis = [DVec3::ZERO, legs];
            if let Some(moved) = self.slide_if_there_is_room(&with_legs) {
                self.state.hanging.legs = legs;
                return moved;
            }
        }
        let moved = self.slide(path, Intent::Go);
        let ball = path.body.core_at(moved.position);
        let is_free = were == DVec3::ZERO && self.mover.is_free(&ball, legs);
        self.state.hanging.legs = if is_free { legs } else { DVec3::ZERO };
        moved
    }

    /// The climber's share of a change of velocity by contacts. If it touches nothing else, its hold takes the rest: a
    /// light hold that swings against the climber is stopped by it.
    fn shared_with_hold(&mut self, change: DVec3) -> DVec3 {
        let touched = self.mover.touched();
        let Some(attachment) = self.attachment() else {
            return change;
        };
        if self.state.crushed || !touched.iter().all(|touch| self.is_on(touch)) {
            return change;
        }
        let mass = self.config.body.mass;
        if let Some(pull) = &mut self.pull {
            *pull += change * mass;
        }
        change / (1.0 + mass * self.response_of(&attachment, change))
    }

    /// Clips a velocity by the contacts and by the arms, if they are taut.
    fn clipped_by_arm(&self, velocity: DVec3, carried: &Carried, arm: DVec3) -> DVec3 {
        if self.state.crushed {
            return self.state.base_velocity;
        }
        let inward = -arm.normalize_or(DVec3::Y);
        let is_taut = arm.length() >= self.state.hanging.arm * (1.0 - 1e-6);
        let taut = is_taut.then(|| MovePlane {
            normal: inward,
            offset: inward.dot(carried.velocity()),
        });
        self.mover
            .clip_velocity(velocity, self.state.base_velocity, taut)
    }
}
