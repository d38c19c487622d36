//! Comparison of hits bit for bit: unlike `==`, it tells -0 from 0, and NaN equals itself.

use clamber_surface::surface::{SurfaceHit, SweepHit};
use glam::Vec3;

/// Coordinates as bits.
pub(crate) fn bits(p: Vec3) -> [u32; 3] {
    p.to_array().map(f32::to_bits)
}

/// A hit as bits, with its tag and part.
fn hit_bits(hit: &SurfaceHit) -> impl PartialEq + use<> {
    (
        (hit.mesh, hit.triangle, hit.part, hit.tag),
        hit.barycentric.map(f32::to_bits),
        (bits(hit.point), bits(hit.normal), hit.distance.to_bits()),
    )
}

/// A contact as bits, with its tag and part.
fn sweep_bits(hit: &SweepHit) -> impl PartialEq + use<> {
    (
        (hit.mesh, hit.triangle, hit.part, hit.tag),
        (hit.barycentric.map(f32::to_bits), bits(hit.point)),
        (bits(hit.separation_normal), bits(hit.normal)),
        (hit.time.to_bits(), hit.distance.to_bits()),
        (hit.started_inside, hit.undecided),
    )
}

/// True if both have the same hits in the same order, bit for bit.
pub(crate) fn same_hits(a: &[SurfaceHit], b: &[SurfaceHit]) -> bool {
    a.iter().map(hit_bits).eq(b.iter().map(hit_bits))
}

/// True if both have the same contacts in the same order, bit for bit.
pub(crate) fn same_sweeps(a: &[SweepHit], b: &[SweepHit]) -> bool {
    a.iter().map(sweep_bits).eq(b.iter().map(sweep_bits))
}
