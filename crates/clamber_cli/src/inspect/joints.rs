//! Prints the joints of a creature as a tree, with the numbers that the author of a brain's file needs.

use std::fmt::Write as _;

use clamber_gltf::Model;
use clamber_surface::mesh::VertexId;
use clamber_surface::rig::JointId;
use clamber_surface::skin::skin;

/// The joints as a tree, with their places at rest, in heights of the creature, and the number of vertices that each
/// joint moves, as the sum of their weights. Empty if the skeleton cannot be posed at rest.
pub(super) fn tree(model: &Model) -> String {
    let skeleton = &model.rig.skeleton;
    let joints = skeleton.joints();
    let mut text = String::new();
    let Ok(palette) = skeleton.palette(&skeleton.rest_pose()) else {
        return text;
    };
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    if let Ok(positions) = skin(&model.rig.collider, palette.matrices()) {
        for corner in model.rig.collider.triangles().iter().flatten() {
            let y = f64::from(positions[corner.index()].y);
            (low, high) = (low.min(y), high.max(y));
        }
    }
    let height = (high - low).max(f64::MIN_POSITIVE);
    let mut moved = vec![0.0f64; joints.len()];
    for vertex in 0..model.rig.collider.positions().len() as u32 {
        for (joint, weight) in model.rig.collider.influences(VertexId(vertex)) {
            moved[joint.index()] += f64::from(weight);
        }
    }
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); joints.len()];
    let mut open: Vec<(usize, usize)> = Vec::new();
    for (index, joint) in joints.iter().enumerate().rev() {
        match joint.parent {
            Some(parent) => children[parent.index()].push(index),
            None => open.push((index, 0)),
        }
    }
    // Writing to a string does not fail.
    let _ = writeln!(text, "  {height:.3} units tall, posed at rest");
    let _ = writeln!(
        text,
        "  places at rest in heights: to its left, up, ahead; then vertices that follow it"
    );
    while let Some((index, depth)) = open.pop() {
        let place = palette.model_from_joint(JointId(index as u32));
        let [x, y, z] = place.map_or([f64::NAN; 3], |frame| {
            (frame.translation / height).to_array()
        });
        let name = format!("{}{}", "  ".repeat(depth.min(20)), joints[index].name);
        let _ = writeln!(
            text,
            "  {name:<40} {x:>7.3} {y:>7.3} {z:>7.3}  {:>6.0}",
            moved[index]
        );
        open.extend(children[index].iter().map(|child| (*child, depth + 1)));
    }
    text
}
