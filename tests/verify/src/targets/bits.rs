use glam::Vec3;

/// The bits of the coordinates. Unlike `==`, they tell -0 from 0, and NaN equals itself.
pub(crate) fn bits(p: Vec3) -> [u32; 3] {
    p.to_array().map(f32::to_bits)
}
