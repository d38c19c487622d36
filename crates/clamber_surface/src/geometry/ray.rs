use glam::Vec3;

use super::{round_to_f32, widen};

/// A half-line whose direction has length one, up to the rounding of its f32 coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: Vec3,
    direction: Vec3,
}

impl Ray {
    /// A ray from `origin` along `direction`, which may have any length but zero.
    ///
    /// `None` if a coordinate is not finite or the direction is zero.
    pub fn new(origin: Vec3, direction: Vec3) -> Option<Self> {
        let wide = widen(direction);
        // f32 squared never overflows nor underflows to zero in f64.
        let length = wide.length();
        if !origin.is_finite() || !length.is_finite() || length == 0.0 {
            return None;
        }
        Some(Self {
            origin,
            direction: round_to_f32(wide / length),
        })
    }

    /// The point at which the ray starts.
    pub fn origin(&self) -> Vec3 {
        self.origin
    }

    /// The direction, a unit vector.
    pub fn direction(&self) -> Vec3 {
        self.direction
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_normalised_and_bad_input_is_refused() {
        for scale in [1e-38_f32, 1.0, 1e38] {
            let ray = Ray::new(Vec3::ZERO, Vec3::new(0.0, 3.0, 4.0).normalize() * scale);
            let d = ray.map(|r| r.direction());
            assert!(
                d.is_some_and(|d| (d - Vec3::new(0.0, 0.6, 0.8)).length() < 1e-6),
                "{scale}: {d:?}"
            );
        }
        assert!(Ray::new(Vec3::ZERO, Vec3::ZERO).is_none());
        assert!(Ray::new(Vec3::ZERO, Vec3::new(f32::NAN, 0.0, 0.0)).is_none());
        assert!(Ray::new(Vec3::splat(f32::INFINITY), Vec3::X).is_none());
    }
}
