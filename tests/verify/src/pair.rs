//! A moving triangle and a moving sphere or capsule.

use glam::Vec3;

/// The core of a moving sphere or capsule: its centre or its segment, without the radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Core {
    /// The centre of a sphere.
    Sphere {
        /// Centre at time 0.
        center: Vec3,
        /// Displacement of the centre from time 0 to time 1.
        motion: Vec3,
    },
    /// The segment of a capsule.
    Capsule {
        /// Ends of the segment at time 0.
        ends: [Vec3; 2],
        /// Displacement of each end from time 0 to time 1.
        motions: [Vec3; 2],
    },
}

/// A triangle and a sphere or capsule. Every corner and end moves on a straight line from time 0 to
/// time 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingPair {
    /// Corners of the triangle, at time 0 and at time 1.
    pub corners: [[Vec3; 3]; 2],
    /// The core of the sphere or capsule.
    pub core: Core,
    /// Radius of the sphere or capsule.
    pub radius: f32,
}

impl MovingPair {
    /// Ends of the core at time 0, and their displacements. For a sphere, both ends and both displacements are equal.
    pub fn ends(&self) -> [[Vec3; 2]; 2] {
        match self.core {
            Core::Sphere { center, motion } => [[center; 2], [motion; 2]],
            Core::Capsule { ends, motions } => [ends, motions],
        }
    }

    /// The largest sum of absolute coordinates of any point relative to the first end of the core,
    /// plus the radius.
    pub fn size(&self) -> f64 {
        let [ends, motions] = self.ends();
        let origin = ends[0].as_dvec3();
        let corners = self.corners.as_flattened().iter().map(|p| p.as_dvec3());
        let starts = ends.map(|end| end.as_dvec3());
        let later = [0, 1].map(|k| ends[k].as_dvec3() + motions[k].as_dvec3());
        let all = corners.chain(starts).chain(later);
        let taxicab = all.map(|p| (p - origin).abs().element_sum());
        taxicab.fold(0.0, f64::max) + f64::from(self.radius)
    }
}
