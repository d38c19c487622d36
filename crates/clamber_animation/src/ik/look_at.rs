use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::two_bone::check_pose;
use super::{IkError, arc};
use crate::space::{model_from_joint, model_from_parent, turn_in_model};
use crate::spring::rotation_from_vector;
use clamber_surface::geometry::slerp;

/// How far a gaze turns from straight ahead, radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LookLimits {
    /// To either side.
    pub yaw: f64,
    /// Up and down.
    pub pitch: f64,
    /// How fast its turning may change about either axis, radians a second squared: above 0, and infinite to follow a
    /// target wherever it goes. A gaze with a limit lags behind fast targets, and passes from one shoulder to the other
    /// in a while.
    pub acceleration: f64,
}

impl Default for LookLimits {
    /// 80° to either side, 60° up and down, as fast as its target.
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
/// Each joint takes its share of the turn that is left after the joints above it, and the last one takes all of the
/// rest, so that the gaze arrives; no iteration is needed (Guillaume Blanc, ozz-animation, sample "look at").
#[derive(Clone, Debug, PartialEq)]
pub struct LookAt {
    /// From the chain's last joint up to the head, with shares; joints between those of the chain have none.
    path: Vec<(JointId, Option<f64>)>,
    /// In the head's own space: where the eye is, and where it looks.
    eye: DVec3,
    forward: DVec3,
    limits: LookLimits,
    /// At rest, in the space of the last joint's parent: ahead and up.
    ahead: DVec3,
    up: DVec3,
}

/// What a gaze remembers, so that it does not jump from one shoulder to the other when a target passes behind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LookMemory {
    /// The side to which it looks: 1 is left, -1 right, 0 not known yet.
    side: f64,
    /// Seconds since it changed.
    since: f64,
    /// Where it looks, yaw and pitch in radians, and how fast these change, in a gaze with a limit; `None` before the
    /// first time.
    turned: Option<[Follow; 2]>,
}

/// An angle that follows another one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Follow {
    angle: f64,
    speed: f64,
}

impl Follow {
    /// Turns towards a goal, as fast as it can still brake before it with half of `most`, its greatest acceleration.
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

/// The most joints from a chain's last one up to its head: they are turned by recursion.
const MOST_JOINTS: usize = 256;

/// How far beyond straight behind a target must be to change the side, and how long the side stays, radians and
/// seconds.
const BEHIND: f64 = 0.35;
const STAYS: f64 = 1.0;

impl LookAt {
    /// A gaze by the joints of `chain`, from the head down, each with the share that it takes of the turn that is left,
    /// 0 to 1; the last one takes all of it. `eye` and `forward` are in the head's own space, `up` is the creature's up
    /// in model space at rest.
    ///
    /// # Errors
    /// [`IkError::BadSetUp`] if the chain is empty or spans more than 256 joints, a share is not from 0 to 1, or `forward` or `up` have no length or are
    /// parallel at rest; [`IkError::NoJoint`]; [`IkError::NotAChain`] if a joint is not above the joint before it;
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
    /// [`IkError::BadSetUp`] if the yaw is not from 0 to pi or the pitch not from 0 to a quarter turn.
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
    /// within the limits. `dt` is the time since the last call with this memory, seconds. Returns the angle between the
    /// gaze and the target that is left, radians.
    ///
    /// # Errors
    /// [`IkError::NotFinite`] for target, weight or pose, [`IkError::NoJoint`], [`IkError::NotInvertible`], and
    /// [`IkError::Sheared`] if a joint's parents scale unevenly. The pose is unchanged then.
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
        // Everything that can fail, before anything is changed.
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

    /// The direction nearest to one towards the target that the limits allow.
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
            // In front the gaze passes from side to side by itself.
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
        // Left is a positive turn about up, and up a negative one about left.
        about(up, yaw) * (about(left, -pitch) * level)
    }
}

/// One call of [`LookAt::solve`].
struct Gaze<'a> {
    look: &'a LookAt,
    /// The last joint's parent in model space.
    base: &'a DAffine3,
    target: DVec3,
    weight: f64,
    memory: &'a mut LookMemory,
    dt: f64,
}

impl Gaze<'_> {
    /// Turns the joints from one of the path on to the head, the head first. A joint's parents are turned after it, so
    /// their frames, which are composed on the way up to the head, are those of the pose that was given. Returns the
    /// sight after that, and the point to look at; `None` if the eye is at the target.
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
            // The last one takes all that is left.
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

    /// The sight of the pose that was given, and the point to look at.
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
        // As a point as far away as the target: the eye moves when the head turns.
        let point = eye + wanted * way.length();
        Ok(Some((Sight { eye, gaze }, point)))
    }
}

/// An eye and where it looks, in model space.
#[derive(Clone, Copy)]
struct Sight {
    eye: DVec3,
    gaze: DVec3,
}

impl Sight {
    /// The turn about an origin that makes the eye look at a point. `None` for points that are nearer to the origin
    /// than the line of sight passes.
    fn turn_to(&self, point: DVec3, origin: DVec3) -> Option<DQuat> {
        let (eye, target) = (self.eye - origin, point - origin);
        // The point of the line of sight that is as far from the origin as the target is turned onto the target.
        let along = eye.dot(self.gaze);
        let room = along * along - (eye.length_squared() - target.length_squared());
        if room < 0.0 {
            return None;
        }
        let seen = eye + self.gaze * (room.sqrt() - along);
        Some(arc(seen.try_normalize()?, target.try_normalize()?))
    }
}
