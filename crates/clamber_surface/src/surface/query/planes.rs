//! Planes that touch a ball or a capsule, on the side that faces a cluster.
//!
//! A triangle whose corners are all beyond one of them is outside. Where a sphere rests on skin, a box
//! holds hundreds of triangles that do not touch it; these planes leave few.

use glam::Vec3;

use crate::geometry::{round_to_f32, widen};

/// How many; as many as a code has bits.
pub(super) const PLANES: usize = 8;

/// How far f32 arithmetic may be off, as a share of a vertex's distance from the origin of the planes:
/// some ten roundings of 2^-24.
pub(super) const SLACK: f32 = 16.0 * f32::EPSILON;

/// Beyond this, products overflow, and nothing is ruled out.
pub(super) const LARGEST: f32 = 1e30;

/// Cosine and sine of the angles between the planes' normals and the direction of the cluster: 25
/// degrees, where a sphere rests on flat skin, and 55, where it stands in a corner.
const NEAR: [f32; 2] = [0.906_307_8, 0.422_618_26];
const FAR: [f32; 2] = [0.573_576_45, 0.819_152];

/// Half-spaces `normal . (p - origin) > limit` that hold nothing of a region.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planes {
    pub(super) origin: [f32; 3],
    pub(super) normals: [[f32; PLANES]; 3],
    pub(super) limits: [f32; PLANES],
}

impl Planes {
    /// Of all points within `radius` of the segment from `a` to `b`, towards `target`.
    pub(super) fn facing(a: Vec3, b: Vec3, radius: f64, target: Vec3) -> Self {
        // In f64: in f32 the squares of what is small underflow, and normals come out too long.
        let (axis, aside) = (widen(b) - widen(a), widen(target) - widen(a));
        let length_sq = axis.length_squared();
        let along = if length_sq > 0.0 {
            (aside.dot(axis) / length_sq).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let facing = (aside - axis * along).try_normalize().map(round_to_f32);
        let facing = facing.unwrap_or(Vec3::Y);
        let axis = b - a;
        let normals = about(facing);
        let size = a.abs().max_element() + axis.abs().max_element();
        let rounded = radius as f32 * (1.0 + SLACK);
        let usable = size < LARGEST && rounded < LARGEST;
        let limit = |normal: Vec3| {
            let core = normal.dot(axis).max(0.0);
            // The last term is for products that underflow.
            core + rounded + SLACK * size + f32::MIN_POSITIVE
        };
        Self {
            origin: a.to_array(),
            normals: std::array::from_fn(|axis| normals.map(|normal| normal[axis])),
            limits: normals.map(|normal| if usable { limit(normal) } else { f32::INFINITY }),
        }
    }
}

/// Unit vectors about one: itself, and others that are tilted away from it.
pub(super) fn about(facing: Vec3) -> [Vec3; PLANES] {
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
