use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::two_bone::check_pose;
use super::{IkError, arc};
use crate::space::{model_from_joint, model_from_parent, turn_in_model};
use crate::spring::rotation_from_vector;
use clamber_surface::geometry::slerp;

/// Limits of a gaze: its largest angles from straight ahead, radians, and its angular acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LookLimits {
    /// Largest angle to either side.
    pub yaw: f64,
    /// Largest angle up and down.
    pub pitch: f64,
    /// The largest angular acceleration about either axis, radians per second squared: above 0; infinite follows the
    /// target without delay. A gaze with a finite limit lags behind fast targets, and takes time to pass from one
    /// shoulder to the other.
    pub acceleration: f64,
}

impl Default for LookLimits {
    /// 80° to either side, 60° up and down, infinite acceleration.
    fn default() -> Self {
        Self {
            yaw: 80f64.to_radians(),
            pitch: 60f64.to_radians(),
            acceleration: f64::INFINITY,
        }
    }
}

/// Turns a chain of joints, from the head down to the neck or the spine, so that the eye looks at a target.
///
/// The head turns first. Each joint takes its share of the turn that remains, and the last one takes the whole rest, so
/// the gaze arrives without iteration (Guillaume Blanc, ozz-animation, sample "look at").
#[derive(Clone, Debug, PartialEq)]
pub struct LookAt {
    /// The joints from the chain's last joint up to the head, each with its share; `None` for joints between the
    /// chain's joints.
    path: Vec<(JointId, Option<f64>)>,
    /// The eye's position, in the head's own space.
    eye: DVec3,
    /// The direction in which the eye looks, a unit vector in the head's own space.
    forward: DVec3,
    limits: LookLimits,
    /// The direction ahead at rest, in the space of the last joint's parent.
    ahead: DVec3,
    /// The creature's up at rest, in the space of the last joint's parent.
    up: DVec3,
}

/// State of a gaze between calls, so that it does not jump from one shoulder to the other when a target passes behind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LookMemory {
    /// The side to which the gaze looks: 1 is left, -1 right, 0 not known yet.
    side: f64,
    /// Seconds since the side changed.
    since: f64,
    /// Yaw and pitch of the gaze, radians, and their speeds, if the gaze has a limit of acceleration; `None` before the
    /// first call.
    turned: Option<[Follow; 2]>,
}

/// An angle that follows a goal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Follow {
    angle: f64,
    speed: f64,
}

impl Follow {
    /// Turns towards a goal within the acceleration `most`: as fast as half of `most` can still stop at the goal.
    fn step(&mut self, goal: f64, most: f64, dt: f64) {
        if dt <= 0.0 || dt.is_nan() {
            return;
        }
        let left = goal - self.angle;
        let fastest = (most * left.abs()).sqrt().min(left.abs() / dt);
        let change = fastest.copysign(left) - self.speed;
        self.speed += change.clamp(-most * dt, most * dt);
        self.angle += self.speed * dt;
    }
}

/// The most joints from a chain's last joint up to its head. Joints are turned by recursion, so this bounds its depth.
const MOST_JOINTS: usize = 256;

/// A target behind must be at least this far past straight behind, radians, for the gaze to change the side.
const BEHIND: f64 = 0.35;
/// The gaze keeps its side for at least this time while a target is behind, seconds.
const STAYS: f64 = 1.0;

impl LookAt {
    /// A gaze by the joints of `chain`, from the head down, each with the share that it takes of the remaining turn, 0
    /// to 1; the last one takes the whole rest. `eye` and `forward` are in the head's own space, `up` is the creature's
    /// up in model space at rest.
    ///
    /// # Errors
    /// [`IkError::BadSetUp`] if the chain is empty or spans more than 256 joints, a share is not from 0 to 1, `eye`,
    /// `forward` or `up` is not finite, or `forward` and `up` have no length or are parallel at rest;
    /// [`IkError::NoJoint`]; [`IkError::NotAChain`] if a joint is not above the joint before it;
    /// [`IkError::NotInvertible`].
    pub fn new(
        skeleton: &Skeleton,
        chain: &[(JointId, f64)],
        eye: DVec3,
        forward: DVec3,
        up: DVec3,
    ) -> Result<Self, IkError> {
        let joints = skeleton.joints().len();
        let (Some(&(head, _)), Some(&(last, _))) = (chain.first(), chain.last()) else {
            return Err(IkError::BadSetUp("a look-at chain has no joints"));
        };
        for &(joint, share) in chain {
            if joint.index() >= joints {
                return Err(IkError::NoJoint { joint, joints });
            }
            if !(0.0..=1.0).contains(&share) {
                return Err(IkError::BadSetUp("a joint's share is not from 0 to 1"));
            }
        }
        for pair in chain.windows(2) {
            let (joint, ancestor) = (pair[0].0, pair[1].0);
            if joint == ancestor || !skeleton.is_descendant_or_self(joint, ancestor) {
                return Err(IkError::NotAChain { joint, ancestor });
            }
        }
        let rest = skeleton.rest_pose();
        let parent = model_from_parent(skeleton, &rest, last).matrix3;
        let inverse = crate::space::invertible(&parent, last)?;
        let ahead_in_model = model_from_joint(skeleton, &rest, head).matrix3 * forward;
        let ahead = (inverse * ahead_in_model).try_normalize();
        let up = (inverse * up).try_normalize();
        let (Some(ahead), Some(up), true) = (ahead, up, eye.is_finite()) else {
            return Err(IkError::BadSetUp(
                "the eye, forward or up is not finite or has no length",
            ));
        };
        let level = (ahead - up * ahead.dot(up)).try_normalize();
        if level.is_none() {
            return Err(IkError::BadSetUp("forward and up are parallel"));
        }
        let share = |joint| chain.iter().find(|(one, _)| *one == joint);
        let parent = |joint: &JointId| skeleton.joints()[joint.index()].parent;
        let up_to_last =
            core::iter::successors(Some(head), |joint| parent(joint).filter(|_| *joint != last));
        let mut path: Vec<_> = up_to_last
            .map(|joint| (joint, share(joint).map(|(_, share)| *share)))
            .take(MOST_JOINTS + 1)
            .collect();
        if path.len() > MOST_JOINTS {
            return Err(IkError::BadSetUp(
                "a look-at chain spans more than 256 joints",
            ));
        }
        path.reverse();
        Ok(Self {
            path,
            eye,
            forward: forward.normalize(),
            limits: LookLimits::default(),
            ahead,
            up,
        })
    }

    /// The same gaze with other limits.
    ///
    /// # Errors
    /// [`IkError::BadSetUp`] if the yaw is not from 0 to pi, the pitch is not from 0 to a quarter turn, or the
    /// acceleration is not above 0.
    pub fn with_limits(self, limits: LookLimits) -> Result<Self, IkError> {
        use core::f64::consts::{FRAC_PI_2, PI};
        let in_range =
            (0.0..=PI).contains(&limits.yaw) && (0.0..=FRAC_PI_2).contains(&limits.pitch);
        if in_range && limits.acceleration > 0.0 {
            Ok(Self { limits, ..self })
        } else {
            Err(IkError::BadSetUp(
                "a look-at limit is out of range: yaw is from 0 to 3.1416 (180 degrees) and pitch from 0 to 1.5708 (90 degrees), in radians, and the acceleration is positive",
            ))
        }
    }

    /// Turns the gaze of a pose towards a target in model space: by `weight`, 0 (not at all) to 1 (all the way), and
    /// within the limits. `dt` is the time since the last call with this memory, seconds. Returns the remaining angle
    /// between the gaze and the target, radians.
    ///
    /// # Errors
    /// [`IkError::NotFinite`] for target, weight or pose, [`IkError::NoJoint`], [`IkError::NotInvertible`], and
    /// [`IkError::Sheared`] if a joint's parents scale unevenly. The pose is then unchanged.
    pub fn solve(
        &self,
        skeleton: &Skeleton,
        pose: &mut Pose,
        target: DVec3,
        weight: f64,
        memory: &mut LookMemory,
        dt: f64,
    ) -> Result<f64, IkError> {
        check_pose(skeleton, pose, self.path.iter().map(|(joint, _)| *joint))?;
        if !target.is_finite() || !weight.is_finite() {
            return Err(IkError::NotFinite("a target or a weight"));
        }
        let last = self.path[0].0;
        let base = model_from_parent(skeleton, pose, last);
        if !base.is_finite() {
            return Err(IkError::NotFinite("the pose"));
        }
        crate::space::uniform_scale(&base.matrix3, last)?;
        // Check all scales before anything is changed, so that an error leaves the pose unchanged.
        for (joint, _) in &self.path[..self.path.len() - 1] {
            let scale = pose.transforms[joint.index()].scale.as_dvec3();
            if scale.abs() != DVec3::ONE {
                crate::space::uniform_scale(&DMat3::from_diagonal(scale), *joint)?;
            }
        }
        let mut gaze = Gaze {
            look: self,
            base: &base,
            target,
            weight: weight.clamp(0.0, 1.0),
            memory,
            dt,
        };
        let Some((sight, _)) = gaze.turn(pose, 0, &base)? else {
            return Ok(0.0);
        };
        let left = (target - sight.eye).normalize_or(sight.gaze);
        Ok(libm::atan2(
            sight.gaze.cross(left).length(),
            sight.gaze.dot(left),
        ))
    }

    /// The direction within the limits that is nearest to the direction to the target.
    fn limited(&self, base: &DMat3, to_target: DVec3, memory: &mut LookMemory, dt: f64) -> DVec3 {
        use core::f64::consts::{PI, TAU};
        let up = (*base * self.up).normalize_or(DVec3::Y);
        let ahead = *base * self.ahead;
        let level = (ahead - up * ahead.dot(up)).normalize_or(up.any_orthonormal_vector());
        let left = up.cross(level);
        let (x, y, z) = (to_target.dot(level), to_target.dot(left), to_target.dot(up));
        let level_length = (x * x + y * y).sqrt();
        let mut yaw = libm::atan2(y, x);
        let pitch = libm::atan2(z, level_length);
        memory.since += dt.max(0.0);
        let side = if yaw < 0.0 { -1.0 } else { 1.0 };
        let is_behind = yaw.abs() > self.limits.yaw;
        if memory.side == 0.0 || !is_behind {
            // While the target is in front, the gaze may change the side at any time.
            if memory.side != side {
                memory.since = if is_behind { 0.0 } else { STAYS };
            }
            memory.side = side;
        } else if side != memory.side {
            let is_clear = yaw.abs() < PI - BEHIND;
            if is_clear && memory.since >= STAYS {
                (memory.side, memory.since) = (side, 0.0);
            } else {
                yaw += TAU * memory.side;
            }
        }
        let most = self.limits.acceleration;
        if yaw.abs() <= self.limits.yaw && pitch.abs() <= self.limits.pitch && most.is_infinite() {
            return to_target;
        }
        let mut yaw = yaw.clamp(-self.limits.yaw, self.limits.yaw);
        let mut pitch = pitch.clamp(-self.limits.pitch, self.limits.pitch);
        if most.is_finite() {
            let start = [yaw, pitch].map(|angle| Follow { angle, speed: 0.0 });
            let [around, up] = memory.turned.get_or_insert(start);
            around.step(yaw, most, dt);
            up.step(pitch, most, dt);
            (yaw, pitch) = (around.angle, up.angle);
        }
        let about = |axis: DVec3, angle: f64| -> DQuat { rotation_from_vector(axis * angle) };
        // Turning left is a positive rotation about up, turning up a negative one about left.
        about(up, yaw) * (about(left, -pitch) * level)
    }
}

/// The state of one call of [`LookAt::solve`].
struct Gaze<'a> {
    look: &'a LookAt,
    /// The transform of the last joint's parent in model space.
    base: &'a DAffine3,
    target: DVec3,
    weight: f64,
    memory: &'a mut LookMemory,
    dt: f64,
}

impl Gaze<'_> {
    /// Turns the joints of the path from `index` up to the head, the head first. The frames of a joint's parents are
    /// composed on the way up to the head, before any of them is turned, so they belong to the given pose. Returns the
    /// eye's sight afterwards and the point to look at; `None` if the eye is at the target.
    fn turn(
        &mut self,
        pose: &mut Pose,
        index: usize,
        model_from_parent: &DAffine3,
    ) -> Result<Option<(Sight, DVec3)>, IkError> {
        let Some(&(joint, share)) = self.look.path.get(index) else {
            return self.begin(model_from_parent);
        };
        let model = *model_from_parent * pose.transforms[joint.index()].to_affine();
        let Some((mut sight, point)) = self.turn(pose, index + 1, &model)? else {
            return Ok(None);
        };
        let Some(share) = share else {
            return Ok(Some((sight, point)));
        };
        let origin = model.translation;
        if let Some(turn) = sight.turn_to(point, origin) {
            // The last joint takes the whole remaining turn.
            let turn = if index == 0 {
                turn
            } else {
                slerp(DQuat::IDENTITY, turn, share)
            };
            turn_in_model(pose, joint, model_from_parent, turn)?;
            sight.eye = origin + turn * (sight.eye - origin);
            sight.gaze = turn * sight.gaze;
        }
        Ok(Some((sight, point)))
    }

    /// The sight in the given pose, and the point to look at.
    fn begin(&mut self, model_from_head: &DAffine3) -> Result<Option<(Sight, DVec3)>, IkError> {
        let look = self.look;
        let eye = model_from_head.transform_point3(look.eye);
        if !eye.is_finite() {
            return Err(IkError::NotFinite("the pose"));
        }
        let gaze = model_from_head.transform_vector3(look.forward);
        let gaze = gaze
            .try_normalize()
            .ok_or(IkError::NotInvertible(look.path[look.path.len() - 1].0))?;
        let way = self.target - eye;
        let Some(to_target) = way.try_normalize() else {
            return Ok(None);
        };
        let allowed = look.limited(&self.base.matrix3, to_target, self.memory, self.dt);
        let wanted = slerp(DQuat::IDENTITY, arc(gaze, allowed), self.weight) * gaze;
        // A point at the target's distance rather than a direction, because the eye moves when the head turns.
        let point = eye + wanted * way.length();
        Ok(Some((Sight { eye, gaze }, point)))
    }
}

/// An eye's position and its viewing direction, in model space.
#[derive(Clone, Copy)]
struct Sight {
    eye: DVec3,
    gaze: DVec3,
}

impl Sight {
    /// The rotation about `origin` that makes the eye look at a point. `None` if the point is nearer to `origin` than
    /// the line of sight is.
    fn turn_to(&self, point: DVec3, origin: DVec3) -> Option<DQuat> {
        let (eye, target) = (self.eye - origin, point - origin);
        // The point of the line of sight that is as far from `origin` as the target is rotated onto the target.
        let along = eye.dot(self.gaze);
        let room = along * along - (eye.length_squared() - target.length_squared());
        if room < 0.0 {
            return None;
        }
        let seen = eye + self.gaze * (room.sqrt() - along);
        Some(arc(seen.try_normalize()?, target.try_normalize()?))
    }
}
