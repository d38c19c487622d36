//! Shapes, and maps between spaces, as plain values. Their arithmetic gives the same bits at every SIMD level.

mod affine;
mod capsule;
mod lanes;
mod moving_capsule;
mod quaternion;
mod ray;
mod similarity;
mod slerp;
mod sphere;
pub(crate) mod triangle;
mod vector3;
mod world_capsule;

pub use affine::Affine;
pub use capsule::Capsule;
pub use moving_capsule::{MovingCapsule, TriangleContact};
pub use quaternion::{rotation_from_axis_angle, rotation_vector};
pub use ray::Ray;
pub use similarity::{Similarity, SimilarityError};
pub(crate) use slerp::Slerp;
pub use slerp::slerp;
pub use sphere::Sphere;
pub use world_capsule::WorldCapsule;

use glam::{DVec3, Vec3};

/// Largest length that a skinned position may have, 2^100. Sums of a few such numbers stay finite in f32, and products
/// of six of them stay finite in f64, so no skinned position makes an exact test overflow.
pub(crate) const MAX_COORDINATE: f64 = (1u128 << 100) as f64;

/// Rounds each coordinate to the nearest f32.
pub(crate) fn round_to_f32(v: DVec3) -> Vec3 {
    v.as_vec3()
}

/// Converts each coordinate to f64; exact.
pub(crate) fn widen(v: Vec3) -> DVec3 {
    v.as_dvec3()
}

/// The smallest f32 that is not below `x`; infinity if no finite f32 is large enough.
pub(crate) fn round_up_to_f32(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) < x {
        nearest.next_up()
    } else {
        nearest
    }
}
