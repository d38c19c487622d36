use glam::DVec3;

use super::Capsule;

/// All points within a radius of a segment, in world space: the shape that obstacles are queried with. A ball where
/// both ends are one point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WorldCapsule {
    /// Ends of the segment.
    pub ends: [DVec3; 2],
    /// Metres, not negative.
    pub radius: f64,
}

impl From<&Capsule> for WorldCapsule {
    /// The same numbers, of a capsule whose space is the world.
    fn from(capsule: &Capsule) -> Self {
        Self {
            ends: capsule.ends().map(|end| end.as_dvec3()),
            radius: capsule.radius().into(),
        }
    }
}

impl WorldCapsule {
    /// A ball.
    pub const fn ball(center: DVec3, radius: f64) -> Self {
        Self {
            ends: [center, center],
            radius,
        }
    }

    /// Both ends are one point.
    pub fn is_ball(&self) -> bool {
        self.ends[0] == self.ends[1]
    }

    /// Whether all of it is finite and its radius not negative: what queries find nothing for otherwise.
    pub fn is_valid(&self) -> bool {
        let is_finite = self.ends.iter().all(|end| end.is_finite());
        is_finite && (0.0..f64::INFINITY).contains(&self.radius)
    }

    /// The same, somewhere else.
    #[must_use]
    pub fn moved(&self, by: DVec3) -> Self {
        self.with_ends_moved([by; 2])
    }

    /// With each end somewhere else.
    #[must_use]
    pub fn with_ends_moved(&self, by: [DVec3; 2]) -> Self {
        Self {
            ends: [self.ends[0] + by[0], self.ends[1] + by[1]],
            ..*self
        }
    }

    /// How far from touching a sweep or cast of it may stop, metres: a share of its radius below what one sees, 0.1 mm
    /// for a ball of 0.4 m. For thin capsules no less than the steps of f32 some metres out.
    pub fn sweep_tolerance(&self) -> f64 {
        (self.radius * 2.5e-4).max(1e-6)
    }

    /// With another radius.
    #[must_use]
    pub const fn with_radius(&self, radius: f64) -> Self {
        Self { radius, ..*self }
    }

    /// The point of the segment nearest to a point.
    pub fn nearest_on_axis(&self, point: DVec3) -> DVec3 {
        let [a, b] = self.ends;
        a + (b - a) * self.share_of_axis(point)
    }

    /// Where the point of the segment nearest to a point lies, as a share of the way from the first end to the second.
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

    /// Centre and radius of a ball around it.
    pub fn bounding_ball(&self) -> (DVec3, f64) {
        let [a, b] = self.ends;
        ((a + b) * 0.5, (b - a).length() * 0.5 + self.radius)
    }
}
