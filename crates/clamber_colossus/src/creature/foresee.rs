//! How a creature will stand, as far as its clips tell.

use clamber_animation::rig::{Palette, Pose};
use clamber_animation::{AnimationEvent, Animator, PoseBuffers};
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use glam::DVec3;

use super::Creature;
use crate::error::ColossusError;

/// Memory that [`Creature::foresee`] reuses.
#[derive(Clone, Debug, Default)]
pub struct Foresight {
    animator: Option<Animator>,
    pose: Pose,
    buffers: PoseBuffers,
    events: Vec<AnimationEvent>,
}

impl Creature {
    /// How the creature will stand after some seconds, not negative, if its brain does not decide on anything else
    /// until then: its clips and fades go on, and so does its way at the speed that it has. Fills in the palette, and
    /// gives its place in the world.
    ///
    /// Feet are not put on the ground and the head is not turned: what rides on those is carried elsewhere by as much
    /// as they are corrected now.
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
            .get_or_insert_with(|| state.animator.clone());
        animator.clone_from(&state.animator);
        memory.events.clear();
        let moved = animator.advance(kind.clips(), seconds, &mut memory.events)?;
        animator.pose_into(kind.clips(), &mut memory.pose, &mut memory.buffers)?;
        kind.skeleton().palette_into(&memory.pose, palette)?;
        let scale = self.size.scale;
        let now = state.world_from_model(scale);
        let translation = now.translation
            + now.rotation * moved.translation * scale
            + state.heading() * (state.speed() * seconds);
        let turn = rotation_from_axis_angle(DVec3::Y, moved.yaw);
        Ok(Similarity {
            translation,
            rotation: turn * now.rotation,
            ..now
        })
    }
}
