use clamber_world::WorldCapsule;
use glam::DVec3;

use crate::MoverError;

/// The shape that is moved: a capsule at a position, with an outer layer that may overlap obstacles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoverBody {
    /// Ends of the capsule's segment relative to the body's position, metres. If both are zero, the body is a ball. The
    /// first end should be zero, since ground beside and under the feet, and grips, are searched around the ball at the
    /// position only.
    pub axis: [DVec3; 2],
    /// Radius of the capsule, metres, positive. The axis of a resting body is at this distance from the surface it
    /// rests on.
    pub radius: f64,
    /// Thickness of the outer layer, metres, not negative and less than the radius. The rest of the body is the core,
    /// which does not enter obstacles. A larger margin tolerates rougher deformation, but more overlap is visible; 1/40
    /// of the radius is a good start.
    pub margin: f64,
}

impl MoverBody {
    /// A ball around the position.
    pub const fn ball(radius: f64, margin: f64) -> Self {
        Self {
            axis: [DVec3::ZERO; 2],
            radius,
            margin,
        }
    }

    /// A capsule from the position to `top`, which is relative to the position.
    pub const fn capsule(top: DVec3, radius: f64, margin: f64) -> Self {
        Self {
            axis: [DVec3::ZERO, top],
            radius,
            margin,
        }
    }

    /// Radius of the core, metres.
    pub fn core_radius(&self) -> f64 {
        self.radius - self.margin
    }

    /// The whole body at a position in world space.
    pub fn at(&self, position: DVec3) -> WorldCapsule {
        WorldCapsule {
            ends: self.axis.map(|end| position + end),
            radius: self.radius,
        }
    }

    /// The core at a position in world space.
    pub fn core_at(&self, position: DVec3) -> WorldCapsule {
        self.at(position).with_radius(self.core_radius())
    }

    /// The crouched body: the ball around the position, with the same radius and margin.
    #[must_use]
    pub const fn crouched(&self) -> Self {
        Self::ball(self.radius, self.margin)
    }

    /// Checks the axis, the radius and the margin.
    ///
    /// # Errors
    /// [`MoverError`] for an axis that is not finite, a radius that is not positive, or a margin that is negative or
    /// not less than the radius.
    pub fn validate(&self) -> Result<(), MoverError> {
        if !self.axis.iter().all(|end| end.is_finite()) {
            return Err(MoverError::NotFinite("axis"));
        }
        let fails = |name, range, found| Err(MoverError::OutOfRange { name, range, found });
        if !(self.radius > 0.0 && self.radius.is_finite()) {
            return fails("radius", "positive and finite", self.radius);
        }
        if !(0.0..self.radius).contains(&self.margin) {
            return fails(
                "margin",
                "not negative and less than the radius",
                self.margin,
            );
        }
        Ok(())
    }
}
