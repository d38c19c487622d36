use super::NodeBounds;
use super::eight::inflation;
use crate::geometry::{round_up_to_f32, widen};
use crate::mesh::hierarchy::{Child, Hierarchy, JointWeights, LANES, Node};

/// Appends a node with up to eight children, each with the rest data of the vertices below it, and
/// gives its index.
///
/// # Panics
/// With more than eight children.
pub(crate) fn push_node(hierarchy: &mut Hierarchy, children: &[(Child, &NodeBounds)]) -> u32 {
    assert!(children.len() <= LANES, "{} children", children.len());
    let first = hierarchy.joints.len();
    let intervals = || children.iter().flat_map(|(_, bounds)| bounds.intervals());
    hierarchy.joints.extend(intervals().map(|i| i.joint.0));
    hierarchy.joints[first..].sort_unstable();
    let mut kept = first;
    for k in first..hierarchy.joints.len() {
        if kept == first || hierarchy.joints[k] != hierarchy.joints[kept - 1] {
            hierarchy.joints[kept] = hierarchy.joints[k];
            kept += 1;
        }
    }
    hierarchy.joints.truncate(kept);
    hierarchy.weights.resize(kept, JointWeights::default());

    let mut node = Node {
        x: [0.0; LANES],
        y: [0.0; LANES],
        z: [0.0; LANES],
        radius: [0.0; LANES],
        reach: [0.0; LANES],
        inflation: [0.0; LANES],
        children: [0; LANES],
        first_joint: first as u32,
        joints: (kept - first) as u32,
        lanes: children.len() as u8,
    };
    for (lane, (child, bounds)) in children.iter().enumerate() {
        node.set_child(lane, *child);
        set_rest_data(&mut node, lane, bounds);
        for interval in bounds.intervals() {
            // Found: all intervals' joints are in the list.
            if let Ok(row) = hierarchy.joints[first..].binary_search(&interval.joint.0) {
                let weights = &mut hierarchy.weights[first + row];
                weights.middle[lane] = interval.middle;
                weights.deviation[lane] = interval.deviation;
            }
        }
    }
    hierarchy.nodes.push(node);
    (hierarchy.nodes.len() - 1) as u32
}

fn set_rest_data(node: &mut Node, lane: usize, bounds: &NodeBounds) {
    let sphere = bounds.rest_sphere();
    let center = widen(sphere.center);
    node.x[lane] = sphere.center.x;
    node.y[lane] = sphere.center.y;
    node.z[lane] = sphere.center.z;
    node.radius[lane] = sphere.radius;
    // The centre is transformed like a vertex, so the error is that of the farther one.
    let center_reach = center.length() * (1.0 + 1e-15);
    node.reach[lane] = round_up_to_f32(bounds.reach.max(center_reach));
    let deviations = bounds.intervals().iter().map(|i| f64::from(i.deviation));
    node.inflation[lane] = inflation(
        bounds.influences,
        bounds.intervals().len(),
        deviations.sum(),
    );
}
