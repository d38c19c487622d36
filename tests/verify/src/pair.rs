//! A moving triangle and a moving sphere or capsule.

use glam::Vec3;

/// A triangle and a sphere or capsule. Every corner and end moves on a straight line from time 0 to time 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingPair {
    /// Corners of the triangle, at time 0 and at time 1.
    pub corners: [[Vec3; 3]; 2],
    /// Ends of the core at time 0: of the capsule's segment, or twice the sphere's centre.
    pub ends: [Vec3; 2],
    /// Displacement of each end from time 0 to time 1. Those of a sphere are equal.
    pub motions: [Vec3; 2],
    /// Radius of the sphere or capsule.
    pub radius: f32,
}

impl MovingPair {
    /// The largest sum of absolute coordinates of any point relative to the first end of the core, plus the radius.
    pub fn size(&self) -> f64 {
        let ends = self.ends.map(|end| end.as_dvec3());
        let corners = self.corners.as_flattened().iter().map(|p| p.as_dvec3());
        let later = [0, 1].map(|k| ends[k] + self.motions[k].as_dvec3());
        let all = corners.chain(ends).chain(later);
        let taxicab = all.map(|p| (p - ends[0]).abs().element_sum());
        taxicab.fold(0.0, f64::max) + f64::from(self.radius)
    }
}
