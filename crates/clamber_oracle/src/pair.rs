//! A triangle and a sphere or capsule that move.

use glam::Vec3;

/// What moves against the triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Core {
    /// A sphere.
    Sphere {
        /// At time 0.
        center: Vec3,
        /// From time 0 to time 1.
        motion: Vec3,
    },
    /// A capsule.
    Capsule {
        /// Of its segment, at time 0.
        ends: [Vec3; 2],
        /// Of each end, from time 0 to time 1.
        motions: [Vec3; 2],
    },
}

/// A triangle and a sphere or capsule; every corner and end moves on a straight line from time 0 to
/// time 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingPair {
    /// Of the triangle, at both times.
    pub corners: [[Vec3; 3]; 2],
    /// The centre or the segment.
    pub core: Core,
    /// Of sphere or capsule.
    pub radius: f32,
}

impl MovingPair {
    /// Ends of the core at time 0, and their motions: a sphere has two equal ones.
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
