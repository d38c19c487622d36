//! The posture in which a body is measured, and from which clips are carried over.

use clamber_surface::geometry::Affine;
use clamber_surface::rig::{JointId, Skeleton};
use glam::{DAffine3, DVec3};

/// How upright a bind pose must be, as the cosine of its angle to Y, and how much larger or smaller than the rest pose
/// it may be: 45°, and a factor of 2.
const UPRIGHT: f64 = 0.7;
const SIZE: f64 = 2.0;

/// All joints in model space in the bind pose, in which the artist has laid the skeleton into the mesh: usually a T or
/// an A. Nodes at rest may be in any pose of a clip.
///
/// A joint that skins nothing has no bind pose; it hangs from its parent as at rest. Meshes may have other units and
/// axes than the model: those of a node above the hips, such as an armature that is rotated and scaled. If no such node
/// makes the bind pose stand upright at the size of the rest pose, it is the rest pose.
///
/// The mesh may also stand elsewhere than the skeleton: the posture is moved so that it has its hips above or below
/// those of the rest pose, and its lower foot as high as the lower foot there.
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
        let fits = is.y >= UPRIGHT * is.length() && (1.0 / SIZE..=SIZE).contains(&ratio);
        let place = |models: &[DAffine3]| {
            let hips = models[hips.index()].translation;
            let sole = feet.map(|foot| models[foot.index()].translation.y);
            DVec3::new(hips.x, sole[0].min(sole[1]), hips.z)
        };
        let shift = place(&rest) - place(&bound);
        for (joint, model) in bound.iter_mut().enumerate() {
            // What stands above all skinned joints is the armature, at rest.
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

/// Finds a joint in the bind pose, and before it its parents. A loop, since files may have chains of any length.
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
