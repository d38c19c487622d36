//! Moves the hips of the pose: down until all feet reach the ground, towards the standing foot before the other one
//! steps, and in a tremor after impacts.

use clamber_animation::joint_in_model;
use clamber_animation::rig::JointId;
use clamber_surface::geometry::Similarity;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::Creature;
use super::clips::Playing;
use super::legs::PutLeg;
use crate::feet::Carried;

/// Largest vertical acceleration of the hips, metres a second squared. Riders feel it in addition to the acceleration
/// from following the ground.
const MAX_DROP_ACCELERATION: f64 = 0.4;

/// Largest horizontal acceleration of the hips along each axis, metres a second squared. Riders feel it, too.
const MAX_SHIFT_ACCELERATION: f64 = 0.4;

/// Largest distance from hip to ankle, as a share of the leg's length.
const MAX_LEG_STRETCH: f64 = 0.985;

/// Largest drop of the hips, as a share of the leg's length.
const MOST_DROP: f64 = 0.35;

/// Drop of the hips on a slope even if the legs do not need it yet, as a share of the leg's length times the slope's
/// tangent.
const SLOPE_DROP: f64 = 0.32;

/// Half time in which the hips rise again once they need not be low, seconds for a creature of `GIANT_HEIGHT`. It is
/// longer than a step.
const RISE_HALF_TIME: f64 = 3.0;

/// How far the hips shift towards the standing foot before the other foot steps, as a share of the horizontal vector
/// from that leg's hip to the ball of its foot.
const SHIFT_SHARE: f64 = 0.35;

/// Share of this shift after which the other foot may step.
const SHIFTED_ENOUGH_SHARE: f64 = 0.7;

/// Angular frequency of the tremor after an impact for a leg of 1 m, radians a second. It falls with the square root of
/// the leg's length.
const TREMOR_RATE: f64 = 50.0;

/// Damping ratio of the tremor.
const TREMOR_DAMPING: f64 = 0.25;

/// Tremor of a step, as a share of the tremor of an impact.
const STEP_TREMOR: f64 = 0.15;

/// Offset of the hips from their place in the clips, in world space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Hips {
    offset: DVec3,
    velocity: DVec3,
    /// How far the hips recently had to drop, metres.
    drop: f64,
    /// Vertical position and velocity of a damped oscillation: metres, metres a second.
    tremor: [f64; 2],
    /// True while a foot has to wait with its step until the hips have shifted.
    waits: bool,
}

impl Hips {
    /// True if all numbers are at most `most` in magnitude.
    pub(super) fn is_within(&self, most: f64) -> bool {
        let vectors = [self.offset, self.velocity];
        let numbers = vectors.iter().flat_map(|vector| vector.to_array());
        let numbers = numbers.chain(self.tremor).chain([self.drop]);
        numbers.into_iter().all(|number| number.abs() <= most)
    }

    /// Turns the offset and its velocity with ground that has moved.
    pub(super) fn turn(&mut self, carried: &Carried) {
        self.offset = carried.vector(self.offset);
        self.velocity = carried.vector(self.velocity);
    }

    /// True if a foot may step.
    pub(super) fn has_shifted(&self) -> bool {
        !self.waits
    }

    /// Advances the tremor by a tick, with the exact solution of a damped oscillator.
    fn ring(&mut self, rate: f64, dt: f64) {
        let [x, v] = self.tremor;
        let decay = TREMOR_DAMPING * rate;
        let ringing = rate * (1.0 - TREMOR_DAMPING * TREMOR_DAMPING).sqrt();
        let (sin, cos) = libm::sincos(ringing * dt);
        let fade = libm::exp(-decay * dt);
        let b = (v + decay * x) / ringing;
        self.tremor = [
            fade * (x * cos + b * sin),
            fade * (v * cos - (decay * b + ringing * x) * sin),
        ];
        if self.tremor.iter().all(|number| number.abs() < 1e-6) {
            self.tremor = [0.0; 2];
        }
    }

    /// Moves towards a place with at most the acceleration `most` along each axis.
    fn go(&mut self, to: DVec3, most: DVec3, dt: f64) {
        for axis in 0..3 {
            let (value, velocity) = approach(
                [self.offset[axis], self.velocity[axis]],
                to[axis],
                [most[axis], APPROACH_RATE],
                dt,
            );
            (self.offset[axis], self.velocity[axis]) = (value, velocity);
        }
    }
}

/// Largest speed near a goal, as a share of the remaining distance in a second.
pub(super) const APPROACH_RATE: f64 = 2.0;

/// Moves a number towards a goal with an acceleration of at most `most`. The speed is at most the speed from which it
/// can still stop at the goal, and at most `nears` times the remaining distance a second. Returns the number and its
/// velocity.
pub(super) fn approach(
    [value, velocity]: [f64; 2],
    goal: f64,
    [most, nears]: [f64; 2],
    dt: f64,
) -> (f64, f64) {
    let away = goal - value;
    let fast = (2.0 * 0.6 * most * away.abs())
        .sqrt()
        .min(nears * away.abs());
    let change = (away.signum() * fast - velocity).clamp(-most * dt, most * dt);
    let velocity = velocity + change;
    (value + velocity * dt, velocity)
}

impl Creature {
    /// Moves the hips of the pose so that the legs reach their feet. Returns the offset, in model space.
    pub(super) fn shift_hips(&mut self, world: &Similarity, legs: &[PutLeg], dt: f64) -> DVec3 {
        let Some(joint) = self.kind.hips() else {
            return DVec3::ZERO;
        };
        let scale = world.scale;
        let length = legs.iter().map(|leg| leg.reach).fold(0.0, f64::max) * scale;
        let before = self.state.hips.drop;
        let steep = SLOPE_DROP * self.state.motion.steepness() * length;
        let needed = (legs.iter().map(drop_of).fold(0.0, f64::max) * scale).max(steep);
        // The hips rise slowly, so that they do not bob with each step. They do not rise at all unless the creature
        // walks or turns: a clip that made the legs too short once does so again in each round.
        let moves = matches!(self.state.clips.playing(), Playing::Walk | Playing::Turn(_));
        let rises = if moves {
            RISE_HALF_TIME * self.size.pace.max(1e-3)
        } else {
            f64::INFINITY
        };
        let risen = before * libm::exp2(-dt / rises);
        self.state.hips.drop = needed.max(risen).min(MOST_DROP * length);
        // With more than two legs, the hips are already between the standing feet when another foot steps.
        let wants_step = legs.len() == 2 && legs.iter().any(|leg| leg.wants_step);
        let mut to = DVec3::NEG_Y * self.state.hips.drop;
        let mut shift = DVec3::ZERO;
        let mut waits = false;
        if wants_step {
            let planted = || legs.iter().filter(|leg| leg.is_planted);
            // If both feet want to step, the first one does.
            let stander = planted().find(|leg| !leg.wants_step);
            if let Some(leg) = stander.or_else(|| planted().next_back()) {
                waits = true;
                let level = world.transform_vector(leg.ball - leg.hip);
                // Only a share of the way, since the hips are between the two legs.
                shift = DVec3::new(level.x, 0.0, level.z) * SHIFT_SHARE;
            }
        }
        to += shift;
        if self.state.clock.is_first() {
            // The creature was just placed.
            self.state.hips.offset = to;
        }
        self.state.hips.go(
            to,
            DVec3::new(
                MAX_SHIFT_ACCELERATION,
                MAX_DROP_ACCELERATION,
                MAX_SHIFT_ACCELERATION,
            ),
            dt,
        );
        let at = self.state.hips.offset;
        let left = DVec3::new(at.x - shift.x, 0.0, at.z - shift.z).length();
        self.state.hips.waits = waits && left > (1.0 - SHIFTED_ENOUGH_SHARE) * shift.length();
        let rate = TREMOR_RATE / length.max(1e-3).sqrt();
        self.tremble(rate);
        self.state.hips.ring(rate, dt);
        let offset = at + DVec3::Y * self.state.hips.tremor[0];
        let offset = world.inverse_transform_vector(offset);
        self.offset_joint(joint, offset);
        offset
    }

    /// Begins the tremors of the impacts and steps in this tick.
    fn tremble(&mut self, rate: f64) {
        let most = self.kind.tremor();
        for event in &self.report.events {
            let share = match event {
                super::CreatureEvent::Marker { name } if name == "impact" => 1.0,
                super::CreatureEvent::Plant { .. } => STEP_TREMOR,
                _ => continue,
            };
            self.state.hips.tremor[1] -= share * most / rate;
        }
    }

    /// Moves a joint of the pose, and all joints below it, by an offset in model space.
    fn offset_joint(&mut self, joint: JointId, offset: DVec3) {
        let skeleton = self.kind.skeleton();
        let parent = skeleton.joints()[joint.index()].parent;
        let frame = parent.and_then(|parent| joint_in_model(skeleton, &self.state.pose, parent));
        let local = frame.map_or(offset, |frame| frame.matrix3.inverse() * offset);
        if local.is_finite() {
            self.state.pose.transforms[joint.index()].translation += local.as_vec3();
        }
    }
}

/// How far a leg's hip has to drop so that the leg reaches its ankle, in the model's units.
fn drop_of(leg: &PutLeg) -> f64 {
    let way = leg.hip - leg.ankle;
    let reach = MAX_LEG_STRETCH * leg.reach;
    let level = (way.x * way.x + way.z * way.z).min(reach * reach);
    way.y - (reach * reach - level).sqrt()
}
