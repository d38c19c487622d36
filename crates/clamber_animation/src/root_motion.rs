use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_surface::rig::{Clip, JointId, Playback, Pose, RigError, Skeleton, Transform};
use glam::{DAffine3, DQuat, DVec3};

use crate::pose::{rotation_of, store_rotation};
use crate::space::model_from_joint;

/// How far a creature moves along the ground and turns, in model space. It is the motion of the whole model: its next
/// transform is `world_from_model * translation * rotation about Y by yaw`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RootDelta {
    /// In model units, horizontal: its Y is 0.
    pub translation: DVec3,
    /// Radians about Y, counter-clockwise as seen from above.
    pub yaw: f64,
}

impl RootDelta {
    /// The motion of `self` followed by the motion of `next`.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self {
            translation: self.translation + turn(self.yaw) * next.translation,
            yaw: self.yaw + next.yaw,
        }
    }

    /// The inverse motion.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self {
            translation: turn(-self.yaw) * -self.translation,
            yaw: -self.yaw,
        }
    }

    /// Interpolates linearly from `self` (`share` 0) to `other` (`share` 1).
    pub(crate) fn mix(&self, other: &Self, share: f64) -> Self {
        Self {
            translation: self.translation.lerp(other.translation, share),
            yaw: self.yaw + (other.yaw - self.yaw) * share,
        }
    }
}

/// The joint whose motion moves the creature.
#[derive(Clone, Debug)]
pub(crate) struct RootMotion {
    pub(crate) joint: JointId,
    rest: Transform,
    model_from_parent: DAffine3,
    /// The rotation of `model_from_parent`.
    turn: DQuat,
}

/// Position and heading of the joint on the ground, relative to the clip's start.
#[derive(Clone, Copy)]
struct Placed {
    translation: DVec3,
    yaw: f64,
}

impl RootMotion {
    pub(crate) fn new(skeleton: &Skeleton, joint: JointId) -> Self {
        let parent = skeleton.joints()[joint.index()].parent;
        let rest = skeleton.rest_pose();
        let model_from_parent = parent.map_or(DAffine3::IDENTITY, |parent| {
            model_from_joint(skeleton, &rest, parent)
        });
        Self {
            joint,
            rest: skeleton.joints()[joint.index()].rest,
            model_from_parent,
            turn: model_from_parent.to_scale_rotation_translation().1,
        }
    }

    /// The joint's motion from one time of the clip to another, with `loops` whole loops of the clip between them;
    /// negative loops run backwards.
    pub(crate) fn between(
        &self,
        clip: &Clip,
        [from, to]: [f64; 2],
        loops: i32,
    ) -> Result<RootDelta, RigError> {
        let start = self.joint_at(clip, 0.0)?;
        let [from, to, end] = [from, to, clip.duration()]
            .map(|time| Ok(self.placed(&self.joint_at(clip, time)?, &start)));
        let (from, to, end) = (delta(from?), delta(to?), delta(end?));
        let whole = if loops < 0 { end.inverse() } else { end };
        let mut motion = from.inverse();
        for _ in 0..loops.unsigned_abs() {
            motion = motion.then(&whole);
        }
        let motion = motion.then(&to);
        // The motion so far turns about the joint. It has to turn about the model's origin.
        let mut pivot = self.model_from_parent.transform_point3(translation(&start));
        pivot.y = 0.0;
        Ok(RootDelta {
            translation: motion.translation + pivot - turn(motion.yaw) * pivot,
            yaw: motion.yaw,
        })
    }

    /// Removes the joint's motion since the clip's start from a pose.
    pub(crate) fn remove(&self, clip: &Clip, pose: &mut Pose) -> Result<(), RigError> {
        let start = self.joint_at(clip, 0.0)?;
        let Some(joint) = pose.transforms.get_mut(self.joint.index()) else {
            return Ok(());
        };
        let placed = self.placed(joint, &start);
        let back = turn(-placed.yaw);
        let parent_from_model = self.model_from_parent.inverse();
        let at = self.model_from_parent.transform_point3(translation(joint));
        let origin = self.model_from_parent.transform_point3(translation(&start));
        let level = DVec3::new(origin.x, 0.0, origin.z);
        let moved = level + back * (at - level - placed.translation);
        joint.translation = parent_from_model.transform_point3(moved).as_vec3();
        let rotation = self.turn.conjugate() * back * self.turn * rotation_of(joint);
        store_rotation(joint, rotation);
        Ok(())
    }

    fn joint_at(&self, clip: &Clip, time: f64) -> Result<Transform, RigError> {
        clip.sample_joint(self.joint, self.rest, time, Playback::Clamp)
    }

    fn placed(&self, joint: &Transform, start: &Transform) -> Placed {
        let model = |joint| self.model_from_parent.transform_point3(translation(joint));
        let way = model(joint) - model(start);
        let turned = self.turn * rotation_of(joint) * rotation_of(start).conjugate();
        let turned = turned * self.turn.conjugate();
        // The twist of the rotation about Y. `q` and `-q` are the same rotation.
        let yaw = 2.0 * libm::atan2(turned.y, turned.w);
        Placed {
            translation: DVec3::new(way.x, 0.0, way.z),
            yaw: nearest_turn(yaw),
        }
    }
}

fn delta(placed: Placed) -> RootDelta {
    RootDelta {
        translation: placed.translation,
        yaw: placed.yaw,
    }
}

fn translation(joint: &Transform) -> DVec3 {
    joint.translation.as_dvec3()
}

/// The same angle in the range from -pi to pi.
fn nearest_turn(angle: f64) -> f64 {
    use core::f64::consts::TAU;
    angle - TAU * (angle / TAU).round()
}

fn turn(yaw: f64) -> DQuat {
    rotation_from_axis_angle(DVec3::Y, yaw)
}
