//! Where a creature can be wounded.

use clamber_surface::rig::JointId;
use glam::{DAffine3, Vec3};

use crate::GltfErrorKind;
use crate::contents::Contents;
use crate::members::Members;
use crate::skeleton::{Joints, transform};

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
    let mut weak_points = Vec::new();
    for &node in &members.weak_points {
        let name = contents.tree.name(node);
        let Some(says) = &contents.extras[node].weak_point else {
            continue;
        };
        let Some((joint, position)) = place(contents, joints, node, warnings) else {
            warnings.push(format!(
                "node {name:?} is a weak point, but hangs under no joint; passed over"
            ));
            continue;
        };
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

/// The nearest joint at or above a node, and where the node is in its space.
fn place(
    contents: &Contents<'_>,
    joints: &Joints,
    node: usize,
    warnings: &mut Vec<String>,
) -> Option<(JointId, Vec3)> {
    let tree = &contents.tree;
    let mut joint_from_node = DAffine3::IDENTITY;
    let mut at = node;
    loop {
        if let Some(joint) = joints.of_node.get(&at).and_then(|joints| joints.first()) {
            return Some((*joint, joint_from_node.translation.as_vec3()));
        }
        let local = transform(&tree.nodes[at], warnings).to_affine();
        joint_from_node = local * joint_from_node;
        at = tree.parent_of[at]?;
    }
}
