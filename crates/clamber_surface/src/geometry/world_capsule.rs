use glam::DVec3;

use super::Capsule;

/// A capsule in world space: all points within a radius of a segment. It is the shape of queries against obstacles, and
/// a ball if both ends are the same point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WorldCapsule {
    /// Ends of the segment, metres.
    pub ends: [DVec3; 2],
    /// Metres, not negative.
    pub radius: f64,
}

impl From<&Capsule> for WorldCapsule {
    /// Takes the capsule's coordinates as world coordinates; nothing is transformed.
    fn from(capsule: &Capsule) -> Self {
        Self {
            ends: capsule.ends().map(|end| end.as_dvec3()),
            radius: capsule.radius().into(),
        }
    }
}

impl WorldCapsule {
    /// A ball; `radius` in metres.
    pub const fn ball(center: DVec3, radius: f64) -> Self {
        Self {
            ends: [center, center],
            radius,
        }
    }

    /// True if both ends are the same point.
    pub fn is_ball(&self) -> bool {
        self.ends[0] == self.ends[1]
    }

    /// True if all numbers are finite and the radius is not negative. Queries with any other capsule find nothing.
    pub fn is_valid(&self) -> bool {
        let is_finite = self.ends.iter().all(|end| end.is_finite());
        is_finite && (0.0..f64::INFINITY).contains(&self.radius)
    }

    /// The same capsule, displaced by `by`.
    #[must_use]
    pub fn moved(&self, by: DVec3) -> Self {
        self.with_ends_moved([by; 2])
    }

    /// The same capsule with each end displaced by its own vector.
    #[must_use]
    pub fn with_ends_moved(&self, by: [DVec3; 2]) -> Self {
        Self {
            ends: [self.ends[0] + by[0], self.ends[1] + by[1]],
            ..*self
        }
    }

    /// How far from touching a sweep or cast of this capsule may stop, in metres: a 4,000th of the radius, which is
    /// less than one sees (0.1 mm for a radius of 0.4 m), and at least 1e-6, about the spacing of f32 some metres from
    /// the origin.
    pub fn sweep_tolerance(&self) -> f64 {
        (self.radius * 2.5e-4).max(1e-6)
    }

    /// The same capsule with another radius, in metres.
    #[must_use]
    pub const fn with_radius(&self, radius: f64) -> Self {
        Self { radius, ..*self }
    }

    /// The point of the segment nearest to `point`.
    pub fn nearest_on_axis(&self, point: DVec3) -> DVec3 {
        let [a, b] = self.ends;
        a + (b - a) * self.share_of_axis(point)
    }

    /// Position of the segment's point nearest to `point`: 0 at the first end, 1 at the second; 0 for a ball.
    pub fn share_of_axis(&self, point: DVec3) -> f64 {
        let [a, b] = self.ends;
        let axis = b - a;
        let along = (point - a).dot(axis);
        let length_sq = axis.length_squared();
        if along > 0.0 && length_sq > 0.0 {
            (along / length_sq).min(1.0)
        } else {
            0.0
        }
    }

    /// Centre and radius, in metres, of the ball around the capsule.
    pub fn bounding_ball(&self) -> (DVec3, f64) {
        let [a, b] = self.ends;
        ((a + b) * 0.5, (b - a).length() * 0.5 + self.radius)
    }
}
