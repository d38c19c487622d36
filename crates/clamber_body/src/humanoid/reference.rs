//! The bind pose in model space: bodies are measured in it, and clips are carried over relative to it.

use clamber_surface::geometry::Affine;
use clamber_surface::rig::{JointId, Skeleton};
use glam::{DAffine3, DVec3};

/// Least cosine of the angle between the trunk (hips to head) and Y in an upright bind pose: about 45°.
const UPRIGHT_COSINE: f64 = 0.7;

/// Largest ratio of the trunk's lengths in the bind pose and at rest, either way. A larger ratio means other units.
const MAX_SIZE_RATIO: f64 = 2.0;

/// All joints in model space in the bind pose: the pose in which the artist has fitted the skeleton to the mesh,
/// usually a T-pose or an A-pose. The nodes at rest may be in any pose of a clip.
///
/// A joint that skins nothing has no bind pose; it hangs from its parent as at rest. The mesh may have other units and
/// axes than the model, namely the space of a node above the hips that skins nothing, such as a rotated and scaled
/// armature. If none of these nodes makes the bind pose upright and about as large as the rest pose, the function
/// returns the rest pose.
///
/// The mesh may also stand elsewhere than the skeleton. So the bind pose is shifted: its hips get the X and Z, and its
/// lower foot the height, that they have at rest.
pub(crate) fn reference(
    skeleton: &Skeleton,
    hips: JointId,
    head: JointId,
    feet: [JointId; 2],
) -> Vec<DAffine3> {
    // A skeleton's own rest pose always has a palette.
    let palette = skeleton.palette(&skeleton.rest_pose()).unwrap_or_default();
    let joints = 0..skeleton.joints().len() as u32;
    let at_rest = |joint| palette.model_from_joint(JointId(joint)).copied();
    let rest: Vec<DAffine3> = joints.filter_map(at_rest).collect();
    let parent = |joint: &JointId| skeleton.joints()[joint.index()].parent;
    let above = core::iter::successors(Some(hips), parent);
    let above = above.filter(|joint| !is_skinned(skeleton, *joint));
    let spaces = core::iter::once(DAffine3::IDENTITY).chain(above.map(|joint| rest[joint.index()]));
    let trunk = |models: &[DAffine3]| -> DVec3 {
        models[head.index()].translation - models[hips.index()].translation
    };
    let mut candidates = spaces.filter_map(|model_from_mesh| {
        let mut bound: Vec<Option<DAffine3>> = vec![None; rest.len()];
        for index in 0..rest.len() {
            bind(
                skeleton,
                JointId(index as u32),
                &model_from_mesh,
                &mut bound,
            );
        }
        let mut bound: Vec<DAffine3> = bound.into_iter().collect::<Option<_>>()?;
        let (is, was) = (trunk(&bound), trunk(&rest).length());
        let ratio = is.length() / was;
        let fits = is.y >= UPRIGHT_COSINE * is.length()
            && (1.0 / MAX_SIZE_RATIO..=MAX_SIZE_RATIO).contains(&ratio);
        let place = |models: &[DAffine3]| {
            let hips = models[hips.index()].translation;
            let sole = feet.map(|foot| models[foot.index()].translation.y);
            DVec3::new(hips.x, sole[0].min(sole[1]), hips.z)
        };
        let shift = place(&rest) - place(&bound);
        for (joint, model) in bound.iter_mut().enumerate() {
            // A joint without a skinned joint at or above it belongs to the armature, and stays as at rest.
            let mut up = core::iter::successors(Some(JointId(joint as u32)), parent);
            if up.any(|joint| is_skinned(skeleton, joint)) {
                model.translation += shift;
            }
        }
        fits.then_some(bound)
    });
    candidates.next().unwrap_or(rest)
}

fn is_skinned(skeleton: &Skeleton, joint: JointId) -> bool {
    skeleton.joints()[joint.index()].inverse_bind != Affine::IDENTITY
}

/// Finds the bind pose of a joint, and of its ancestors before it. It is a loop, since a file may have a chain of any
/// length.
fn bind(
    skeleton: &Skeleton,
    joint: JointId,
    model_from_mesh: &DAffine3,
    bound: &mut [Option<DAffine3>],
) {
    let parent = |joint: &JointId| skeleton.joints()[joint.index()].parent;
    let unknown: Vec<JointId> = core::iter::successors(Some(joint), parent)
        .take_while(|joint| bound[joint.index()].is_none())
        .collect();
    for joint in unknown.into_iter().rev() {
        let this = &skeleton.joints()[joint.index()];
        let above = this
            .parent
            .map_or(Some(DAffine3::IDENTITY), |parent| bound[parent.index()]);
        let found = if is_skinned(skeleton, joint) {
            Some(*model_from_mesh * this.inverse_bind.to_f64().inverse())
        } else {
            above.map(|above| above * this.rest.to_affine())
        };
        bound[joint.index()] = found.filter(DAffine3::is_finite);
    }
}
