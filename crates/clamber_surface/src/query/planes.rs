//! Planes that move with a ball or capsule and touch it, on the side that faces a cluster.
//!
//! The distance of a vertex from such a plane changes evenly, and so does a triangle's: one whose
//! corners are beyond a plane at both ends of the motion is beyond it all the time between. Where a
//! sphere rests on skin, a box holds hundreds of triangles that do not touch it; these planes leave few.

use glam::{DVec3, Vec3};

use super::broad::SLACK;
use super::probe::Probe;
use crate::geometry::{round_to_f32, widen};

/// How many; as many as a code has bits.
pub(super) const PLANES: usize = 8;

/// Beyond this, products overflow, and nothing is ruled out.
const LARGEST: f32 = 1e30;

/// Cosine and sine of the angles between the planes' normals and the direction of the cluster: 25
/// degrees, where a sphere rests on flat skin, and 55, where it stands in a corner.
const NEAR: [f32; 2] = [0.906_307_8, 0.422_618_26];
const FAR: [f32; 2] = [0.573_576_45, 0.819_152];

/// Half-spaces `normal . (p - origin) > limit` that hold nothing of a probe: for vertices that move a limit at time 0
/// and one at the time that still matters, for others one that holds at both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planes<const P: usize> {
    pub(super) origin: [f32; 3],
    pub(super) normals: [[f32; PLANES]; 3],
    pub(super) limits: [[f32; PLANES]; P],
}

impl<const P: usize> Planes<P> {
    /// Of all that a probe reaches up to the time `until`, towards something that moves from the first target to the
    /// last by then.
    pub(super) fn facing<const N: usize>(probe: &Probe<N>, until: f32, targets: [Vec3; P]) -> Self {
        let [origin, last] = probe.segment();
        let axis = last - origin;
        let motions = [0, N - 1].map(|end| probe.motions[end] * until);
        let facing = direction(axis, motions, origin, [targets[0], targets[P - 1]]);
        let normals = about(round_to_f32(facing));
        let radius = probe.reach * (1.0 + SLACK);
        let size = [origin, axis, motions[0], motions[1]]
            .map(|v| v.abs().max_element())
            .into_iter()
            .fold(radius, f32::max);
        let limit = |normal: Vec3, ends: [Vec3; 2]| {
            let core = f32::max(normal.dot(ends[0]), normal.dot(ends[1]));
            // The last term is for products that underflow.
            let limit = core + radius + SLACK * size + f32::MIN_POSITIVE;
            if size < LARGEST { limit } else { f32::INFINITY }
        };
        let first = normals.map(|normal| limit(normal, [Vec3::ZERO, axis]));
        let last = normals.map(|normal| limit(normal, [motions[0], axis + motions[1]]));
        let mut limits = [first; P];
        if P == 1 {
            for (limit, last) in limits[0].iter_mut().zip(last) {
                *limit = limit.max(last);
            }
        } else {
            limits[P - 1] = last;
        }
        Self {
            origin: origin.to_array(),
            normals: std::array::from_fn(|axis| normals.map(|normal| normal[axis])),
            limits,
        }
    }
}

/// From the core to the target where they are nearest, about: any direction will do.
fn direction(axis: Vec3, motions: [Vec3; 2], origin: Vec3, targets: [Vec3; 2]) -> DVec3 {
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
    aside.or((-change).try_normalize()).unwrap_or(DVec3::Y)
}

fn share(numerator: f64, denominator: f64) -> f64 {
    if denominator > 0.0 {
        (numerator / denominator).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Unit vectors about one: itself, and others that are tilted away from it.
fn about(facing: Vec3) -> [Vec3; PLANES] {
    let (across, up) = facing.any_orthonormal_pair();
    let tilted = |[cos, sin]: [f32; 2], aside: Vec3| facing * cos + aside * sin;
    let slanted = |x: f32, y: f32| across * x + up * y;
    let half_root_3 = 0.866_025_4;
    [
        facing,
        tilted(NEAR, across),
        tilted(NEAR, -across),
        tilted(NEAR, up),
        tilted(NEAR, -up),
        tilted(FAR, up),
        tilted(FAR, slanted(half_root_3, -0.5)),
        tilted(FAR, slanted(-half_root_3, -0.5)),
    ]
}
