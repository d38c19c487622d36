//! The hips of the pose: low enough for all feet to reach the ground, over the feet that stand while another one steps,
//! and shaken by what comes down.

use clamber_animation::joint_in_model;
use clamber_animation::rig::JointId;
use clamber_surface::geometry::Similarity;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::Creature;
use super::legs::PutLeg;
use super::state::Playing;
use crate::feet::Carried;

/// The most acceleration of the hips, up and down and to the sides, metres a second squared. Riders feel it, together
/// with that of following the ground.
const DROPS: f64 = 0.4;
const SHIFTS: f64 = 0.4;

/// How far a leg is stretched at most, as a share of its length.
const STRETCH: f64 = 0.985;

/// How far hips drop at most, as a share of the leg's length.
const MOST_DROP: f64 = 0.35;

/// How low hips are on a slope before legs need it, as a share of the leg's length and the slope's tangent.
const SLOPE_DROP: f64 = 0.32;

/// Half time in which a giant's hips rise again when they need not be low any more, seconds: longer than a step.
const RISES: f64 = 3.0;

/// How far hips go towards the feet that stand before another one steps, and from which share of that on it does.
const SHIFT: f64 = 0.35;
const SHIFTED: f64 = 0.7;

/// Of the tremor of an impact: its circular frequency at 1 m of leg, radians a second; damping; and what a step gives
/// of it.
const TREMOR_RATE: f64 = 50.0;
const TREMOR_DAMPING: f64 = 0.25;
const STEP_TREMOR: f64 = 0.15;

/// How far the hips are from where clips have them, in world space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Hips {
    offset: DVec3,
    velocity: DVec3,
    /// How low they have to be lately, metres.
    drop: f64,
    /// A damped oscillation up and down: metres, metres a second.
    tremor: [f64; 2],
    /// True while a foot wants to step and the hips are not over the others yet.
    waits: bool,
}

impl Hips {
    /// True if none of its numbers is further from 0.
    pub(super) fn is_within(&self, most: f64) -> bool {
        let vectors = [self.offset, self.velocity];
        let numbers = vectors.iter().flat_map(|vector| vector.to_array());
        let numbers = numbers.chain(self.tremor).chain([self.drop]);
        numbers.into_iter().all(|number| number.abs() <= most)
    }

    /// Turns with ground that has moved.
    pub(super) fn turn(&mut self, carried: &Carried) {
        self.offset = carried.vector(self.offset);
        self.velocity = carried.vector(self.velocity);
    }

    /// True if a foot may step.
    pub(super) fn has_shifted(&self) -> bool {
        !self.waits
    }

    /// Something heavy came down: the hips tremble with at most this acceleration, metres a second squared.
    fn strike(&mut self, acceleration: f64, rate: f64) {
        self.tremor[1] -= acceleration / rate;
    }

    /// Lets the tremor ring on: exact for a damped oscillator, by its solution over the tick.
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

    /// Goes to a place with at most these accelerations.
    fn go(&mut self, to: DVec3, most: DVec3, dt: f64) {
        for axis in 0..3 {
            let (value, velocity) = approach(
                [self.offset[axis], self.velocity[axis]],
                to[axis],
                [most[axis], NEARS],
                dt,
            );
            (self.offset[axis], self.velocity[axis]) = (value, velocity);
        }
    }
}

/// Near a goal it is approached at this share of what is left, in a second.
pub(super) const NEARS: f64 = 2.0;

/// Moves a number towards a goal with at most an acceleration: as fast as it can still be stopped, and gently near it, by a
/// share of what is left in a second.
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
    /// Moves the hips of the pose for legs that are put somewhere. Returns by how much, in model space.
    pub(super) fn shift_hips(&mut self, world: &Similarity, legs: &[PutLeg], dt: f64) -> DVec3 {
        let Some(joint) = self.kind.hips() else {
            return DVec3::ZERO;
        };
        let scale = world.scale;
        let length = legs.iter().map(|leg| leg.reach).fold(0.0, f64::max) * scale;
        let before = self.state.hips.drop;
        let steep = SLOPE_DROP * self.state.steepness * length;
        let needed = (legs.iter().map(drop_of).fold(0.0, f64::max) * scale).max(steep);
        // It rises slowly, so that it does not bob with each step; and not while it stands, since a clip that made its
        // legs too short once does so again in each round.
        let moves = matches!(self.state.playing, Playing::Walk | Playing::Turn(_));
        let rises = if moves {
            RISES * self.size.pace.max(1e-3)
        } else {
            f64::INFINITY
        };
        let risen = before * libm::exp2(-dt / rises);
        self.state.hips.drop = needed.max(risen).min(MOST_DROP * length);
        // On more than two legs it stands between the others when one steps.
        let wants_step = legs.len() == 2 && legs.iter().any(|leg| leg.wants_step);
        let mut to = DVec3::NEG_Y * self.state.hips.drop;
        let mut shift = DVec3::ZERO;
        let mut waits = false;
        if wants_step {
            let planted = || legs.iter().filter(|leg| leg.is_planted);
            // Where both feet want to step, the first of them does.
            let stander = planted().find(|leg| !leg.wants_step);
            if let Some(leg) = stander.or_else(|| planted().next_back()) {
                waits = true;
                let level = world.transform_vector(leg.ball - leg.hip);
                // Hips stand between the legs: half of the way is over one of two feet.
                shift = DVec3::new(level.x, 0.0, level.z) * SHIFT;
            }
        }
        to += shift;
        if self.state.ticks <= 1 {
            // It has just been put there.
            self.state.hips.offset = to;
        }
        self.state
            .hips
            .go(to, DVec3::new(SHIFTS, DROPS, SHIFTS), dt);
        let at = self.state.hips.offset;
        let left = DVec3::new(at.x - shift.x, 0.0, at.z - shift.z).length();
        self.state.hips.waits = waits && left > (1.0 - SHIFTED) * shift.length();
        let rate = TREMOR_RATE / length.max(1e-3).sqrt();
        self.tremble(rate);
        self.state.hips.ring(rate, dt);
        let offset = at + DVec3::Y * self.state.hips.tremor[0];
        let offset = world.inverse_transform_vector(offset);
        self.offset_joint(joint, offset);
        offset
    }

    /// Impacts and steps of this tick begin to tremble.
    fn tremble(&mut self, rate: f64) {
        let most = self.kind.tremor();
        for event in &self.report.events {
            let share = match event {
                super::CreatureEvent::Marker { name } if name == "impact" => 1.0,
                super::CreatureEvent::Plant { .. } => STEP_TREMOR,
                _ => continue,
            };
            self.state.hips.strike(share * most, rate);
        }
    }

    /// Moves a joint of the pose, and all below it, by an offset in model space.
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

/// How far down a leg's hip has to go for its foot to be reached.
fn drop_of(leg: &PutLeg) -> f64 {
    let way = leg.hip - leg.ankle;
    let reach = STRETCH * leg.reach;
    let level = (way.x * way.x + way.z * way.z).min(reach * reach);
    way.y - (reach * reach - level).sqrt()
}
