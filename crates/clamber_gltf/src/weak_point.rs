//! Loads the weak points of a creature.

use clamber_surface::rig::{JointId, WeakPoint};
use glam::DAffine3;

use crate::contents::Contents;
use crate::members::Members;
use crate::skeleton::Joints;
use crate::{GltfErrorKind, ImportWarning};

/// Loads the weak points of a creature, each on the nearest joint at or above its node.
pub(crate) fn load(
    contents: &Contents<'_>,
    members: &Members,
    joints: &Joints,
    warnings: &mut Vec<ImportWarning>,
) -> Result<Vec<WeakPoint>, GltfErrorKind> {
    if members.weak_points.is_empty() {
        return Ok(Vec::new());
    }
    let places = places(contents, joints);
    let mut weak_points = Vec::new();
    for &node in &members.weak_points {
        let name = contents.tree.name(node);
        let Some(says) = &contents.extras[node].weak_point else {
            continue;
        };
        let Place {
            joint: Some((joint, joint_from_node)),
            model_from_node,
        } = &places[node]
        else {
            warnings.push(ImportWarning::WeakPointWithoutJoint { node: name });
            continue;
        };
        let position = joint_from_node.translation.as_vec3();
        let radius = says.radius.unwrap_or_else(|| radius_of(model_from_node));
        if !position.is_finite() || !radius.is_finite() {
            let reason = "is a weak point whose position or radius is not finite";
            return Err(GltfErrorKind::invalid(format!("node {name:?}"), reason));
        }
        let mut weak_point = WeakPoint::new(name, *joint, position);
        weak_point.radius = radius;
        weak_point.hit_points = says.hit_points;
        weak_point.major = says.major.0;
        weak_point.order = says.order.unwrap_or(u32::from(says.major.0));
        weak_points.push(weak_point);
    }
    Ok(weak_points)
}

/// A node's scale at rest: the cube root of its change of volume, so that the ball of this radius has the volume of the
/// transformed unit ball.
fn radius_of(model_from_node: &DAffine3) -> f32 {
    libm::cbrt(model_from_node.matrix3.determinant().abs()) as f32
}

/// The place of a node at rest.
struct Place {
    /// The nearest joint at or above the node, and `joint_from_node`; `None` without such a joint.
    joint: Option<(JointId, DAffine3)>,
    model_from_node: DAffine3,
}

/// The place of every node.
fn places(contents: &Contents<'_>, joints: &Joints) -> Vec<Place> {
    let tree = &contents.tree;
    let nowhere = || Place {
        joint: None,
        model_from_node: DAffine3::IDENTITY,
    };
    let mut places: Vec<Place> = tree.nodes.iter().map(|_| nowhere()).collect();
    for &node in &tree.order {
        let own = joints.of_node.get(&node).and_then(|joints| joints.first());
        let parent_from_node = contents.transforms[node].to_affine();
        let parent = tree.parent_of[node].map(|parent| &places[parent]);
        let inherited = parent.and_then(|parent| parent.joint);
        let model_from_parent = parent.map_or(DAffine3::IDENTITY, |parent| parent.model_from_node);
        places[node] = Place {
            joint: match own {
                Some(joint) => Some((*joint, DAffine3::IDENTITY)),
                None => inherited.map(|(joint, joint_from_parent)| {
                    (joint, joint_from_parent * parent_from_node)
                }),
            },
            model_from_node: model_from_parent * parent_from_node,
        };
    }
    places
}
