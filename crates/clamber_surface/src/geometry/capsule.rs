use glam::Vec3;

/// A query shape: all points within a radius of the segment between two points. It is a ball if both points are equal.
///
/// Coordinates and radius are in the units of the space that is queried. They are checked when the capsule is made, so
/// queries cannot fail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    ends: [Vec3; 2],
    radius: f32,
}

impl Capsule {
    /// A capsule about the segment from `a` to `b`; `None` if a number is not finite or the radius is negative.
    pub fn new(a: Vec3, b: Vec3, radius: f32) -> Option<Self> {
        let usable = a.is_finite() && b.is_finite() && (0.0..f32::INFINITY).contains(&radius);
        usable.then_some(Self {
            ends: [a, b],
            radius,
        })
    }

    /// A ball; `None` if a number is not finite or the radius is negative.
    pub fn ball(center: Vec3, radius: f32) -> Option<Self> {
        Self::new(center, center, radius)
    }

    /// The ends of the segment.
    pub const fn ends(&self) -> [Vec3; 2] {
        self.ends
    }

    /// The radius; not negative.
    pub const fn radius(&self) -> f32 {
        self.radius
    }

    /// True if both ends are the same point.
    pub fn is_ball(&self) -> bool {
        self.ends[0] == self.ends[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn non_finite_or_negative_numbers_make_no_capsule() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(Capsule::ball(Vec3::ZERO, bad), None);
            assert_eq!(Capsule::new(Vec3::ZERO, Vec3::X * bad, 1.0), None);
            assert_eq!(Capsule::new(Vec3::Z * bad, Vec3::X, 1.0), None);
        }
        assert_eq!(Capsule::ball(Vec3::ZERO, -1e-30), None);
        assert!(Capsule::ball(Vec3::ZERO, 0.0).is_some_and(|point| point.is_ball()));
        assert!(Capsule::new(Vec3::ZERO, Vec3::X, 1.0).is_some_and(|limb| !limb.is_ball()));
    }
}
