//! Equal in every bit: where `==` would take -0 for 0, and NaN for nothing.

use clamber_surface::surface::{SurfaceError, SurfaceHit};
use glam::Vec3;

/// Coordinates as bits.
pub(crate) fn bits(p: Vec3) -> [u32; 3] {
    p.to_array().map(f32::to_bits)
}

/// A hit as bits, with its tag and part.
fn hit_bits(hit: &SurfaceHit) -> impl PartialEq {
    (
        (hit.triangle, hit.part, hit.tag),
        hit.barycentric.map(f32::to_bits),
        (bits(hit.point), bits(hit.normal), hit.distance.to_bits()),
    )
}

/// True for hits of equal bits in equal order.
pub(crate) fn same_hits(a: &[SurfaceHit], b: &[SurfaceHit]) -> bool {
    let equal = |(a, b)| hit_bits(a) == hit_bits(b);
    a.len() == b.len() && a.iter().zip(b).all(equal)
}

/// True for errors that say the same: compared as text, since one may hold NaN.
pub(crate) fn same_errors(a: &SurfaceError, b: &SurfaceError) -> bool {
    format!("{a:?}") == format!("{b:?}")
}
