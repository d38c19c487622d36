use glam::Vec3;

use super::{round_to_f32, round_up_to_f32, widen};

/// A ball: all points within `radius` of `center`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre, in the space of the points that it bounds.
    pub center: Vec3,
    /// Radius, not negative.
    pub radius: f32,
}

impl Sphere {
    /// The sphere about the mean of `points` that holds them all: two passes, as in the thesis
    /// this library grew from (5.2.4, "Collider partitioning"). Not the smallest one: up to twice
    /// its radius. The radius is rounded up, so no point lies outside. `None` without points.
    pub fn around_mean(points: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        let (sum, count) = points
            .clone()
            .fold((glam::DVec3::ZERO, 0.0), |(sum, count), p| {
                (sum + widen(p), count + 1.0)
            });
        if count == 0.0 {
            return None;
        }
        let center = round_to_f32(sum / count);
        let farthest_sq = points
            .map(|p| (widen(p) - widen(center)).length_squared())
            .fold(0.0, f64::max);
        // The root and the square sum carry a few units of 2^-53; one f32 step up covers them.
        let radius = round_up_to_f32(farthest_sq.sqrt() * (1.0 + 1e-15));
        Some(Self { center, radius })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holds_every_point_at_any_scale() {
        let mut rng = fastrand::Rng::with_seed(7);
        for _ in 0..2_000 {
            let scale = libm::powf(10.0, rng.f32() * 12.0 - 6.0);
            let points: Vec<Vec3> = (0..rng.usize(1..20))
                .map(|_| Vec3::new(rng.f32(), rng.f32(), rng.f32()) * scale)
                .collect();
            let sphere = Sphere::around_mean(points.iter().copied()).unwrap();
            for p in &points {
                let d = (widen(*p) - widen(sphere.center)).length();
                assert!(d <= f64::from(sphere.radius), "{p} outside {sphere:?}");
            }
        }
        assert_eq!(Sphere::around_mean(core::iter::empty()), None);
    }
}
