//! Where a creature can be wounded.

use clamber_surface::rig::JointId;
use glam::{DAffine3, Vec3};

use crate::GltfErrorKind;
use crate::contents::Contents;
use crate::members::Members;
use crate::skeleton::Joints;

/// A place where a creature can be wounded, as a node of the file marks it.
#[derive(Clone, Debug, PartialEq)]
pub struct WeakPoint {
    /// Of the node.
    pub name: String,
    /// The joint that it hangs under.
    pub joint: JointId,
    /// Where it is, in the joint's space.
    pub position: Vec3,
    /// What it takes before it is used up, greater than 0.
    pub hit_points: f64,
    /// True if the creature dies of it.
    pub major: bool,
}

/// The weak points of a creature, each on the nearest joint at or above its node.
pub(crate) fn load(
    contents: &Contents<'_>,
    members: &Members,
    joints: &Joints,
    warnings: &mut Vec<String>,
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
        let Some((joint, joint_from_node)) = places[node] else {
            warnings.push(format!(
                "node {name:?} is a weak point, but hangs under no joint; passed over"
            ));
            continue;
        };
        let position = joint_from_node.translation.as_vec3();
        if !position.is_finite() {
            let reason = "is a weak point at a position that is not finite";
            return Err(GltfErrorKind::invalid(format!("node {name:?}"), reason));
        }
        weak_points.push(WeakPoint {
            name,
            joint,
            position,
            hit_points: says.hit_points,
            major: says.major.0,
        });
    }
    Ok(weak_points)
}

/// For every node, the nearest joint at or above it, and the way to its space, at rest.
fn places(contents: &Contents<'_>, joints: &Joints) -> Vec<Option<(JointId, DAffine3)>> {
    let tree = &contents.tree;
    let mut places = vec![None; tree.nodes.len()];
    for &node in &tree.order {
        let own = joints.of_node.get(&node).and_then(|joints| joints.first());
        places[node] = match (own, tree.parent_of[node]) {
            (Some(joint), _) => Some((*joint, DAffine3::IDENTITY)),
            (None, Some(parent)) => places[parent].map(|(joint, joint_from_parent)| {
                (
                    joint,
                    joint_from_parent * contents.transforms[node].to_affine(),
                )
            }),
            (None, None) => None,
        };
    }
    places
}
