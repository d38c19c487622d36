//! Carries clips from one body to another.
//!
//! For each bone, the target copies how far the source's bone has turned, in model space, from a reference posture that
//! both bodies share. The source's reference is its bind pose. The target's reference is its bind pose with each bone
//! turned to point where the source's bone points. So a body with a T-pose and one with an A-pose move alike. Turns of
//! whole bones in model space do not depend on how either skeleton orients the axes of its joints (as in Hecker et al.
//! 2008, "Real-time Motion Retargeting to Highly Varied User-Created Morphologies", whose bodies are far more varied).
//! The hips' displacement is scaled by the ratio of the leg lengths. A target whose feet are far from a height of 0 in
//! model space is moved to stand there.

use clamber_surface::rig::{
    Channel, Clip, Interpolation, JointId, Keyframes, Playback, Pose, RigError, Skeleton,
};
use glam::{DAffine3, DMat3, DQuat, DVec3, Quat, Vec3};

use crate::BodyError;
use crate::figure::sole_height;
use crate::humanoid::{depth, reference};
use crate::{Humanoid, Limb, LimbEnd};

/// Keys of a carried clip, per second.
const KEY_RATE: f64 = 30.0;

/// Most key intervals of a carried clip, one hour at [`KEY_RATE`]. It bounds memory: a file may claim any length for a
/// clip.
const MOST_KEYS: f64 = 108_000.0;

/// Carries clips from one body to another.
#[derive(Clone, Debug)]
pub struct Retarget<'a> {
    from: &'a Skeleton,
    to: &'a Skeleton,
    bones: Vec<Bone>,
    /// The target's rest pose with the rotations of its bind pose.
    start: Pose,
    /// The target's joints whose rotation in `start` differs from the rest pose.
    turned: Vec<JointId>,
    /// The hips of the source and of the target.
    hips: [JointId; 2],
    /// Rotation from the source's facing to the target's.
    turn: DQuat,
    /// Length of the target's legs, divided by the source's.
    scale: f64,
    /// How far the target is raised to stand at a height of 0, model units.
    lift: f64,
    /// The joints of the source, and of the target, in model space in their bind poses.
    bound: [Vec<DAffine3>; 2],
    /// The target's feet that do not hang from their shins ([`LimbEnd::Beside`]).
    beside: Vec<Beside>,
}

/// A joint of the target that copies the turn of one joint of the source, or a mix of two.
#[derive(Clone, Copy, Debug)]
struct Bone {
    /// The source's joints.
    from: [JointId; 2],
    /// Weight of the second joint of `from`, 0 to 1.
    share: f64,
    to: JointId,
    /// The joint's rotation in model space in the reference posture.
    reference: DQuat,
}

/// A foot of the target that has to be moved to where its shin ends.
#[derive(Clone, Copy, Debug)]
struct Beside {
    lower: JointId,
    point: DVec3,
    foot: JointId,
}

impl<'a> Retarget<'a> {
    /// A retarget from one body to another, each with its skeleton.
    ///
    /// # Errors
    /// [`BodyError::NoLegs`], and [`BodyError::Rig`] if a body has joints that its skeleton lacks.
    pub fn new(
        (from, source): (&'a Skeleton, &Humanoid),
        (to, target): (&'a Skeleton, &Humanoid),
    ) -> Result<Self, BodyError> {
        check(source, from)?;
        check(target, to)?;
        let bound = [
            reference(from, source.hips, source.head, feet(source)),
            reference(to, target.hips, target.head, feet(target)),
        ];
        let length = |body: &Humanoid| body.legs.iter().map(Limb::length).sum::<f64>();
        let scale = length(target) / length(source);
        if !(scale.is_finite() && scale > 0.0) {
            return Err(BodyError::NoLegs);
        }
        let turn = about_y(source.facing, target.facing);
        let (start, turned) = start(to, &bound[1]);
        let mut retarget = Self {
            from,
            to,
            bones: Vec::new(),
            start,
            turned,
            hips: [source.hips, target.hips],
            turn,
            scale,
            lift: lift(target, &bound[1]),
            bound,
            beside: Vec::new(),
        };
        retarget.add_trunk(source, target);
        let limbs = target.arms.iter().chain(&target.legs);
        for (from, to) in source.arms.iter().chain(&source.legs).zip(limbs) {
            retarget.add_limb(from, to, [source.facing, target.facing]);
        }
        // Parents before children, so that a joint's parent is known when the joint is turned.
        let bones = &mut retarget.bones;
        bones.sort_by_key(|bone| (depth(to, bone.to), bone.to));
        Ok(retarget)
    }

    /// Converts a clip of the source into one for the target, with the same length, name and markers. The result has 30
    /// keys a second. A clip longer than an hour has 108,001 keys, farther apart.
    ///
    /// # Errors
    /// [`BodyError::Rig`] if the clip does not fit the source's skeleton.
    pub fn clip(&self, clip: &Clip) -> Result<Clip, BodyError> {
        let duration = clip.duration();
        let keys = (duration * KEY_RATE).ceil().clamp(1.0, MOST_KEYS) as usize + 1;
        let times: Vec<f32> = (0..keys)
            .map(|key| (duration * key as f64 / (keys - 1) as f64) as f32)
            .collect();
        let rest = self.from.rest_pose();
        let mut moved: Vec<JointId> = self.bones.iter().map(|bone| bone.to).collect();
        moved.extend(self.beside.iter().map(|beside| beside.foot));
        moved.extend(&self.turned);
        moved.sort_unstable();
        moved.dedup();
        let mut rotations: Vec<Vec<Quat>> = vec![Vec::with_capacity(keys); moved.len()];
        let mut translations: Vec<Vec<Vec3>> = rotations.iter().map(|_| Vec::new()).collect();
        for time in &times {
            let source = clip.sample(&rest, f64::from(*time), Playback::Clamp)?;
            let pose = self.pose(&source)?;
            for (index, joint) in moved.iter().enumerate() {
                let transform = &pose.transforms[joint.index()];
                rotations[index].push(transform.rotation);
                translations[index].push(transform.translation);
            }
        }
        let mut channels = Vec::new();
        let mut add = |joint: JointId, values: Keyframes| -> Result<(), RigError> {
            let linear = Interpolation::Linear;
            channels.push(Channel::new(joint, linear, times.clone(), values)?);
            Ok(())
        };
        let travels = |joint: &JointId| {
            *joint == self.hips[1] || self.beside.iter().any(|beside| beside.foot == *joint)
        };
        for ((joint, turns), places) in moved.iter().zip(rotations).zip(translations) {
            add(*joint, Keyframes::Rotation(turns))?;
            if travels(joint) {
                add(*joint, Keyframes::Translation(places))?;
            }
        }
        let speed = clip.ground_speed().map(|speed| speed * self.scale);
        let carried = Clip::new(clip.name.clone(), channels);
        // Keys are rounded to `f32`, so the last key may come before a marker at the clip's end.
        let length = carried.duration();
        let markers = clip.markers().iter().cloned().map(|mut marker| {
            marker.time = marker.time.min(length);
            marker
        });
        Ok(carried
            .with_markers(markers.collect())?
            .with_ground_speed(speed)?)
    }

    /// Converts a pose of the source into one of the target. Trunk, head and limbs follow the source. All other joints,
    /// fingers among them, keep the rotations of the bind pose relative to their parents. So do collar bones, hands and
    /// toes if the source has no such joints.
    ///
    /// # Errors
    /// [`BodyError::Rig`] if the pose does not fit the source's skeleton.
    pub fn pose(&self, source: &Pose) -> Result<Pose, BodyError> {
        let moved = models(self.from, source)?;
        let turned = |joint: JointId| {
            let [now, rest] =
                [&moved, &self.bound[0]].map(|models| rotation(&models[joint.index()]));
            now * rest.conjugate()
        };
        let mut pose = self.start.clone();
        let way = moved[self.hips[0].index()].translation
            - self.bound[0][self.hips[0].index()].translation;
        let hips = self.bound[1][self.hips[1].index()].translation + DVec3::Y * self.lift;
        let hips = hips + self.turn * way * self.scale;
        for bone in &self.bones {
            let [first, second] = bone.from.map(turned);
            let turn = clamber_surface::geometry::slerp(first, second, bone.share);
            let wanted = self.turn * turn * self.turn.conjugate() * bone.reference;
            let parent = self.model_from_parent(&pose, bone.to);
            let local = &mut pose.transforms[bone.to.index()];
            local.rotation = (rotation(&parent).conjugate() * wanted)
                .normalize()
                .as_quat();
            if bone.to == self.hips[1] {
                local.translation = parent.inverse().transform_point3(hips).as_vec3();
            }
        }
        for beside in &self.beside {
            let lower = self.model_from_parent(&pose, beside.lower)
                * pose.transforms[beside.lower.index()].to_affine();
            let place = lower.transform_point3(beside.point);
            let parent = self.model_from_parent(&pose, beside.foot);
            let local = &mut pose.transforms[beside.foot.index()];
            local.translation = parent.inverse().transform_point3(place).as_vec3();
        }
        Ok(pose)
    }

    fn model_from_parent(&self, pose: &Pose, joint: JointId) -> DAffine3 {
        let mut model = DAffine3::IDENTITY;
        let mut next = self.to.joints()[joint.index()].parent;
        while let Some(parent) = next {
            model = pose.transforms[parent.index()].to_affine() * model;
            next = self.to.joints()[parent.index()].parent;
        }
        model
    }

    /// Adds hips, spine, neck and head.
    fn add_trunk(&mut self, source: &Humanoid, target: &Humanoid) {
        let facing = [source.facing, target.facing];
        // The hips' direction is towards the middle between the shoulders.
        let shoulders = |rest: &[DAffine3], body: &Humanoid| {
            let places = body
                .arms
                .iter()
                .map(|arm| rest[arm.upper.index()].translation);
            places.sum::<DVec3>() * 0.5
        };
        let up = |rest: &[DAffine3], body: &Humanoid| {
            shoulders(rest, body) - rest[body.hips.index()].translation
        };
        let trunk = [up(&self.bound[0], source), up(&self.bound[1], target)];
        self.add([source.hips; 2], 0.0, target.hips, trunk, facing);
        self.add_column(&source.spine, &target.spine, source.hips, trunk, facing);
        let chest = [source.chest(), target.chest()];
        let above = |rest: &[DAffine3], body: &Humanoid, chest: JointId| {
            rest[body.head.index()].translation - rest[chest.index()].translation
        };
        let neck = [
            above(&self.bound[0], source, chest[0]),
            above(&self.bound[1], target, chest[1]),
        ];
        self.add_column(&source.neck, &target.neck, chest[0], neck, facing);
        // The neck's direction stands for the head's: skeletons do not share a direction of the head itself.
        self.add([source.head; 2], 0.0, target.head, neck, facing);
    }

    /// Adds a column of joints, such as the spine. Each joint of the target copies the source's turn at the same share
    /// of the column's length.
    fn add_column(
        &mut self,
        from: &[JointId],
        to: &[JointId],
        below: JointId,
        directions: [DVec3; 2],
        facing: [DVec3; 2],
    ) {
        for (index, joint) in to.iter().enumerate() {
            // `at` counts joints of the source: 0 is the joint below the column, `from.len()` its last joint.
            let at = (index + 1) as f64 / to.len() as f64 * from.len() as f64;
            let joint_at = |index: usize| match index.checked_sub(1) {
                None => below,
                Some(index) => from[index.min(from.len() - 1)],
            };
            let first = (at.ceil() as usize).saturating_sub(1);
            let share = at - first as f64;
            let (pair, share) = if from.is_empty() {
                ([below; 2], 0.0)
            } else {
                ([joint_at(first), joint_at(first + 1)], share)
            };
            self.add(pair, share, *joint, directions, facing);
        }
    }

    fn add_limb(&mut self, from: &Limb, to: &Limb, facing: [DVec3; 2]) {
        let place = |rest: &[DAffine3], joint: JointId| rest[joint.index()].translation;
        let bones = |rest: &[DAffine3], limb: &Limb| {
            let [shoulder, elbow] = [limb.upper, limb.lower].map(|joint| place(rest, joint));
            let collar = limb
                .shoulder
                .map_or(DVec3::ZERO, |joint| shoulder - place(rest, joint));
            let tip = limb.end.place(limb.lower, rest);
            [collar, elbow - shoulder, tip - elbow]
        };
        let (source, target) = (bones(&self.bound[0], from), bones(&self.bound[1], to));
        if let (Some(a), Some(b)) = (from.shoulder, to.shoulder) {
            self.add([a; 2], 0.0, b, [source[0], target[0]], facing);
        }
        let bones = [(from.upper, to.upper, 1), (from.lower, to.lower, 2)];
        for (from, to, bone) in bones {
            self.add([from; 2], 0.0, to, [source[bone], target[bone]], facing);
        }
        if let LimbEnd::Beside(foot, point) = to.end {
            let lower = to.lower;
            self.beside.push(Beside { lower, point, foot });
        }
        let (Some(a), Some(b)) = (from.end.joint(), to.end.joint()) else {
            return;
        };
        let toes = |rest: &[DAffine3], limb: &Limb, end: JointId| {
            // Only the level part: soles are flat, although the toes' height below the ankle differs between skeletons.
            let toes = limb.toes.map(|toes| place(rest, toes) - place(rest, end));
            let level = toes.map(|way| DVec3::new(way.x, 0.0, way.z));
            level.filter(|way| way.length() > 1e-6)
        };
        let ends = [toes(&self.bound[0], from, a), toes(&self.bound[1], to, b)];
        match ends {
            // Feet are aligned along their soles, hands along their forearms.
            [Some(first), Some(second)] => {
                self.add([a; 2], 0.0, b, [first, second], [DVec3::Y; 2]);
            }
            _ if from.toes.is_some() || to.toes.is_some() => {
                self.add([a; 2], 0.0, b, facing, [DVec3::Y; 2]);
            }
            _ => self.add([a; 2], 0.0, b, [source[2], target[2]], facing),
        }
        if let (Some(a), Some(b), [Some(first), Some(second)]) = (from.toes, to.toes, ends) {
            self.add([a; 2], 0.0, b, [first, second], [DVec3::Y; 2]);
        }
    }

    /// Adds a bone that points along `directions` in the bind poses, of the source and the target. `others` are the
    /// directions that its second axis is nearest to.
    fn add(
        &mut self,
        from: [JointId; 2],
        share: f64,
        to: JointId,
        directions: [DVec3; 2],
        others: [DVec3; 2],
    ) {
        let wanted = frame(self.turn * directions[0], self.turn * others[0]);
        let found = frame(directions[1], others[1]);
        let correction = wanted * found.conjugate();
        let reference = correction * rotation(&self.bound[1][to.index()]);
        self.bones.push(Bone {
            from,
            share,
            to,
            reference,
        });
    }
}

/// An ankle within this share of the leg from a height of 0 counts as standing there. A model with farther ankles is
/// moved.
const STANDING_ANKLE_HEIGHT: f64 = 0.5;

/// How far the lower sole is below a height of 0 in the bind pose, model units. 0 if the lower ankle is near that
/// height.
fn lift(body: &Humanoid, bound: &[DAffine3]) -> f64 {
    let ankles = body.legs.iter().map(|leg| match leg.end {
        LimbEnd::Joint(foot) => bound[foot.index()].translation.y,
        LimbEnd::Point(point) | LimbEnd::Beside(_, point) => {
            bound[leg.lower.index()].transform_point3(point).y
        }
    });
    let ankle = ankles.fold(f64::INFINITY, f64::min);
    let leg = body.legs[0].length();
    if ankle.abs() < STANDING_ANKLE_HEIGHT * leg {
        0.0
    } else {
        sole_height(ankle, leg) - ankle
    }
}

/// Fails if the body has joints that the skeleton lacks.
pub(crate) fn check(body: &Humanoid, skeleton: &Skeleton) -> Result<(), RigError> {
    let joints = skeleton.joints().len();
    let named = body.joints().into_iter().map(|(_, joint)| joint);
    let inner = body.spine.iter().chain(&body.neck).copied();
    match named.chain(inner).find(|joint| joint.index() >= joints) {
        Some(joint) => Err(RigError::JointOutOfRange { joint, joints }),
        None => Ok(()),
    }
}

/// The joints at which the legs end.
pub(crate) fn feet(body: &Humanoid) -> [JointId; 2] {
    let legs = [&body.legs[0], &body.legs[1]];
    legs.map(|leg| leg.end.joint().unwrap_or(leg.lower))
}

/// The rest pose with the rotations of the bind pose, and the joints whose rotation differs between the two.
fn start(skeleton: &Skeleton, bound: &[DAffine3]) -> (Pose, Vec<JointId>) {
    let mut pose = skeleton.rest_pose();
    let mut turned = Vec::new();
    for (index, joint) in skeleton.joints().iter().enumerate() {
        let parent = joint
            .parent
            .map_or(DQuat::IDENTITY, |parent| rotation(&bound[parent.index()]));
        let local = parent.conjugate() * rotation(&bound[index]);
        let transform = &mut pose.transforms[index];
        if local.dot(transform.rotation.as_dquat().normalize()).abs() < SAME_ROTATION_COSINE {
            transform.rotation = local.normalize().as_quat();
            turned.push(JointId(index as u32));
        }
    }
    (pose, turned)
}

/// Cosine of half the angle below which two rotations count as equal: 0.01°, the rounding of inverse bind matrices.
const SAME_ROTATION_COSINE: f64 = 1.0 - 4e-9;

/// The rotation that takes X to `direction`, and Y as near to `other` as possible.
fn frame(direction: DVec3, other: DVec3) -> DQuat {
    let x = direction.normalize_or(DVec3::Y);
    let y = (other - x * x.dot(other)).normalize_or(x.any_orthonormal_vector());
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y)))
}

/// The rotation about Y from one level unit vector to another.
fn about_y(from: DVec3, to: DVec3) -> DQuat {
    let half = DVec3::new(0.0, from.cross(to).y, 0.0);
    let turn = DQuat::from_xyzw(0.0, half.y, 0.0, 1.0 + from.dot(to));
    if turn.length_squared() > 1e-12 {
        turn.normalize()
    } else {
        DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0)
    }
}

/// The rotation of a transform that may scale and mirror.
fn rotation(model: &DAffine3) -> DQuat {
    model.to_scale_rotation_translation().1
}

/// All joints of a pose in model space.
fn models(skeleton: &Skeleton, pose: &Pose) -> Result<Vec<DAffine3>, RigError> {
    let palette = skeleton.palette(pose)?;
    let joints = 0..skeleton.joints().len() as u32;
    let model = |joint| palette.model_from_joint(JointId(joint)).copied();
    Ok(joints.filter_map(model).collect())
}
