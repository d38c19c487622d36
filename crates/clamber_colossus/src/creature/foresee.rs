//! Predicts the pose and the place of a creature from its clips and its course.

use clamber_animation::rig::{Palette, Pose};
use clamber_animation::{AnimationEvent, Animator, PoseBuffers, RootDelta};
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use glam::DVec3;

use super::Creature;
use super::clips::Playing;
use super::course::Course;
use crate::error::ColossusError;

/// Time step of a prediction, seconds for a creature of `GIANT_HEIGHT`. Steps are longer if a prediction would need
/// more than `MOST_STEPS`.
const PREDICTION_STEP: f64 = 0.1;

/// Most steps of a prediction.
const MOST_STEPS: f64 = 100.0;

/// Working memory of [`Creature::foresee`], so that it does not allocate each time. It holds no result, and may serve
/// any creature.
#[derive(Clone, Debug, Default)]
pub struct Foresight {
    animator: Option<Animator>,
    pose: Pose,
    buffers: PoseBuffers,
    events: Vec<AnimationEvent>,
}

impl Creature {
    /// Predicts how the creature will stand after some seconds, if its brain decides nothing new until then. Fills in
    /// `palette` with the skinning matrices, and returns the transform from model space to world space, metres.
    /// `seconds` must not be negative.
    ///
    /// Clips and fades go on, and so does the creature along its way: it walks, turns, and slows down at its goal.
    /// Moving ground carries it on as in the last tick, in a circle if the ground turns. The prediction neither puts
    /// feet on the ground nor turns the head, so skin that moves with these is off by as much as they are corrected
    /// now.
    ///
    /// # Errors
    /// [`ColossusError::Animation`] if `seconds` is negative or not finite.
    pub fn foresee(
        &self,
        seconds: f64,
        memory: &mut Foresight,
        palette: &mut Palette,
    ) -> Result<Similarity, ColossusError> {
        let (kind, state) = (&self.kind, &self.state);
        let animator = memory
            .animator
            .get_or_insert_with(|| state.animator().clone());
        animator.clone_from(state.animator());
        memory.events.clear();
        let mut course = Course::of(state);
        // The creature looks again before it has used up the free turn, so this is a limit only if the creature is
        // blocked. The free distance is a limit only if it was measured, which needs the goal ahead.
        if !state.walked.progress.is_blocked() {
            course.turn = None;
        }
        if !state.walked.free.faces() {
            course.ahead = f64::INFINITY;
        }
        let way = self.current_way();
        let mut moved = RootDelta::default();
        if !(0.0..=f64::MAX).contains(&seconds) {
            // Returns the error.
            animator.advance(kind.clips(), seconds, &mut memory.events)?;
        }
        let step = PREDICTION_STEP * self.size.pace.max(1e-3);
        let steps = (seconds / step).ceil().clamp(1.0, MOST_STEPS);
        let dt = seconds / steps;
        for _ in 0..steps as u32 {
            if let Some(gait) = kind.gait() {
                let wanted = self.wanted(gait, way.as_ref(), &course);
                let next = self.moved(gait, &wanted, course, dt);
                // The mean of the speeds at the beginning and the end of the step.
                let [speed, turn] = [
                    0.5 * (course.speed + next.speed),
                    0.5 * (course.yaw_rate + next.yaw_rate),
                ];
                let (sin, cos) = libm::sincos(course.yaw + 0.5 * turn * dt);
                let position = course.position + DVec3::new(sin, 0.0, cos) * (speed * dt);
                let yaw = course.yaw + turn * dt;
                course = next;
                (course.position, course.yaw) = (position, yaw);
                course.ahead -= speed * dt;
                course.back = (course.back + speed.min(0.0) * dt).max(0.0);
                let sleeps = self.is_put_to_sleep() && state.clips.playing() == Playing::Idle;
                let plays = !matches!(state.clips.playing(), Playing::Act(_)) && !sleeps;
                if let Some(layer) = animator.layers_mut().first_mut().filter(|_| plays) {
                    layer.speed = self.clip_speed(gait, state.clips.playing(), &course);
                }
            }
            let step = animator.advance(kind.clips(), dt, &mut memory.events)?;
            moved = moved.then(&step);
        }
        animator.pose_into(kind.clips(), &mut memory.pose, &mut memory.buffers)?;
        kind.skeleton().palette_into(&memory.pose, palette)?;
        let scale = self.size.scale;
        let now = state.world_from_model(scale);
        let by_clips = (now.rotation * moved.translation) * scale;
        let translation = course.position + by_clips;
        let turn = rotation_from_axis_angle(DVec3::Y, course.yaw + moved.yaw);
        Ok(state.moving_ground.carry(
            Similarity {
                translation,
                rotation: turn,
                ..now
            },
            state.position(),
            seconds,
        ))
    }
}
