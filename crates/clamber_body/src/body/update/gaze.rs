//! Turns the head and the neck to the point that the climber looks at.

use clamber_animation::Spring;
use clamber_animation::ik::LookMemory;
use clamber_surface::rig::Pose;
use glam::DVec3;

use super::Update;
use crate::BodyError;
use crate::body::root::Root;

/// Half time of a change of the gaze's weight, seconds.
const GAZE_HALF_TIME: f64 = 0.15;

/// Where the head looks.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Gaze {
    memory: LookMemory,
    /// Share of the turn, from 0 to 1.
    weight: Spring<f64>,
    /// The point that the climber looks at, or looked at last, in world space.
    at: DVec3,
}

impl Update<'_> {
    /// Turns the head and the neck to the point that the climber looks at.
    pub(super) fn look(&self, pose: &mut Pose, root: &Root) -> Result<Gaze, BodyError> {
        let goal = f64::from(self.frame.look_at.is_some());
        let mut gaze = self.memory.map_or_else(Gaze::default, |memory| memory.gaze);
        let look_at = self.frame.look_at;
        gaze.at = look_at.unwrap_or_else(|| self.carry.point(gaze.at));
        if self.memory.is_none() {
            gaze.weight = Spring::at(goal);
        } else {
            gaze.weight.step(goal, GAZE_HALF_TIME, self.dt);
        }
        let weight = gaze.weight.value.clamp(0.0, 1.0);
        if weight > 1e-3 {
            let target = root.inverse_point(gaze.at) / self.figure.scale();
            let skeleton = self.figure.skeleton();
            self.figure
                .look()
                .solve(skeleton, pose, target, weight, &mut gaze.memory, self.dt)?;
        }
        Ok(gaze)
    }
}
