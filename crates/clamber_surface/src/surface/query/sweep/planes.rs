//! Planes that move with a sphere or capsule and touch it, on the side that faces a cluster.
//!
//! The distance of a vertex from such a plane changes evenly, and so does a triangle's: one whose
//! corners are beyond a plane at both ends of the motion is beyond it all the time between.

use glam::Vec3;

use super::super::planes::{LARGEST, PLANES, SLACK, about};
use super::Sweep;
use crate::geometry::{round_to_f32, widen};

/// Half-spaces `normal . (p - origin) > limit` that hold nothing of the region, with a limit at time 0
/// and one at the time that still matters.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingPlanes {
    pub(super) origin: [f32; 3],
    pub(super) normals: [[f32; PLANES]; 3],
    pub(super) limits: [[f32; PLANES]; 2],
}

impl MovingPlanes {
    /// Up to the time `until`, towards something that moves from one target to the other by then.
    pub(super) fn facing<const N: usize>(sweep: &Sweep<N>, until: f32, targets: [Vec3; 2]) -> Self {
        let origin = sweep.ends[0];
        let axis = sweep.ends[N - 1] - origin;
        let motions = sweep.motions.map(|motion| motion * until);
        let facing = round_to_f32(direction(
            axis,
            [motions[0], motions[N - 1]],
            origin,
            targets,
        ));
        let normals = about(facing);
        let radius = sweep.reach * (1.0 + SLACK);
        let size = [origin, axis, motions[0], motions[N - 1]]
            .map(|v| v.abs().max_element())
            .into_iter()
            .fold(radius, f32::max);
        let limits = |ends: [Vec3; 2]| {
            normals.map(|normal| {
                let core = f32::max(normal.dot(ends[0]), normal.dot(ends[1]));
                // The last term is for products that underflow.
                let limit = core + radius + SLACK * size + f32::MIN_POSITIVE;
                if size < LARGEST { limit } else { f32::INFINITY }
            })
        };
        Self {
            origin: origin.to_array(),
            normals: std::array::from_fn(|axis| normals.map(|normal| normal[axis])),
            limits: [
                limits([Vec3::ZERO, axis]),
                limits([motions[0], axis + motions[N - 1]]),
            ],
        }
    }
}

/// From the core to the target where they are nearest, about: any direction will do.
fn direction(axis: Vec3, motions: [Vec3; 2], origin: Vec3, targets: [Vec3; 2]) -> glam::DVec3 {
    // In f64: in f32 the squares of what is small underflow, and normals come out too long.
    let axis = widen(axis);
    let motions = motions.map(widen);
    let [start, end] = targets.map(|target| widen(target) - widen(origin));
    let middle = start - axis * 0.5;
    let change = (end - start) - (motions[0] + motions[1]) * 0.5;
    let time = share(-middle.dot(change), change.length_squared());
    let from = start + (end - start) * time - motions[0] * time;
    let axis = axis + (motions[1] - motions[0]) * time;
    let along = share(from.dot(axis), axis.length_squared());
    let aside = (from - axis * along).try_normalize();
    aside
        .or((-change).try_normalize())
        .unwrap_or(glam::DVec3::Y)
}

fn share(numerator: f64, denominator: f64) -> f64 {
    if denominator > 0.0 {
        (numerator / denominator).clamp(0.0, 1.0)
    } else {
        0.0
    }
}
