//! A query against the box around the whole surface. A query that misses the box does no other work.

use glam::DVec3;

use crate::bounds::RootBox;
use crate::geometry::{Ray, widen};

/// Allowance for the error of the f32 triangle test, as a share of the distances involved.
const SLACK: f64 = 16.0 * f32::EPSILON as f64;

/// An upper bound of the length of the surface's edges; may be infinite.
pub(super) fn size(root: &RootBox) -> f64 {
    (widen(root.max) - widen(root.min)).length()
}

/// False only if nothing on the surface lies in the box from `low` to `high`.
pub(super) fn overlaps(root: &RootBox, low: [f32; 3], high: [f32; 3]) -> bool {
    let (min, max) = (root.min.to_array(), root.max.to_array());
    (0..3).all(|axis| low[axis] <= max[axis] && min[axis] <= high[axis])
}

/// False only if a ray up to the distance `limit` meets nothing on the surface. Clips the ray to the three slabs of the
/// box (Kay and Kajiya 1986), widened by the error of the triangle test.
pub(super) fn may_meet(root: &RootBox, ray: &Ray, limit: f64) -> bool {
    let origin = widen(ray.origin());
    let (min, max) = (widen(root.min) - origin, widen(root.max) - origin);
    let farthest = min.abs().max(max.abs());
    let size = farthest.x + farthest.y + farthest.z;
    let slack = DVec3::splat(SLACK * size + f64::from(f32::MIN_POSITIVE));
    let (min, max) = ((min - slack).to_array(), (max + slack).to_array());
    let direction = widen(ray.direction()).to_array();
    let (mut enter, mut leave) = (-slack.x, limit + slack.x);
    for axis in 0..3 {
        if direction[axis] == 0.0 {
            if min[axis] > 0.0 || max[axis] < 0.0 {
                return false;
            }
            continue;
        }
        let (a, b) = (min[axis] / direction[axis], max[axis] / direction[axis]);
        let (first, last) = if a < b { (a, b) } else { (b, a) };
        enter = if first > enter { first } else { enter };
        leave = if last < leave { last } else { leave };
    }
    enter <= leave
}
