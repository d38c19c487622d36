use glam::Vec3;

use super::{round_to_f32, round_up_to_f32, widen};

/// A ball: all points within `radius` of `center`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sphere {
    /// The centre, in the space of the points that the sphere bounds.
    pub center: Vec3,
    /// The radius; not negative.
    pub radius: f32,
}

/// Steps of [`Sphere::nearly_smallest`]: the radius is at most `1 + 1 / sqrt(64)` times the smallest. Measured radii
/// are one or two percent above the smallest. The excess falls slowly with the steps, so more steps gain little.
const CENTER_STEPS: u32 = 64;

impl Sphere {
    /// A sphere about the mean of `points` that holds all of them. Takes two passes, as in the thesis that this library
    /// grew from (5.2.4, "Collider partitioning"). It is not the smallest sphere: its radius is up to twice as large.
    /// The radius is rounded up, so no point lies outside. `None` without points.
    #[doc(hidden)]
    pub fn around_mean(points: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        let (sum, count) = points
            .clone()
            .fold((glam::DVec3::ZERO, 0.0), |(sum, count), p| {
                (sum + widen(p), count + 1.0)
            });
        if count == 0.0 {
            return None;
        }
        Some(Self::around(round_to_f32(sum / count), points))
    }

    /// A sphere that holds all `points` and is nearly the smallest. Every step moves the centre towards the farthest
    /// point, by a share that shrinks (Bădoiu and Clarkson 2003, "Smaller core-sets for balls"). The radius is at most
    /// 1.13 times the smallest, seldom more than 1.02 times. Takes some 66 passes, so it is for rest data, not for
    /// every tick. The radius is rounded up, so no point lies outside. `None` without points.
    #[doc(hidden)]
    pub fn nearly_smallest(points: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        let around_mean = Self::around_mean(points.clone())?;
        let mut center = widen(around_mean.center);
        for step in 1..=CENTER_STEPS {
            let (farthest, _) = points.clone().map(widen).fold((center, 0.0), |best, p| {
                let distance_sq = (p - center).length_squared();
                if distance_sq > best.1 {
                    (p, distance_sq)
                } else {
                    best
                }
            });
            center += (farthest - center) / f64::from(step + 1);
        }
        let found = Self::around(round_to_f32(center), points);
        Some(if found.radius < around_mean.radius {
            found
        } else {
            around_mean
        })
    }

    /// The smallest sphere about `center` that holds all `points`. Its radius is rounded up, so no point lies outside.
    #[doc(hidden)]
    pub fn around(center: Vec3, points: impl Iterator<Item = Vec3>) -> Self {
        let farthest_sq = points
            .map(|p| (widen(p) - widen(center)).length_squared())
            .fold(0.0, f64::max);
        // The root and the square sum carry a few units of 2^-53; one f32 step up covers them.
        let radius = round_up_to_f32(farthest_sq.sqrt() * (1.0 + 1e-15));
        Self { center, radius }
    }

    /// True if `point` lies in the sphere or on it, computed in f64.
    pub fn contains(&self, point: Vec3) -> bool {
        (widen(point) - widen(self.center)).length() <= f64::from(self.radius)
    }

    /// The volume, in cubic units of the sphere's space.
    #[doc(hidden)]
    pub fn volume(&self) -> f64 {
        let radius = f64::from(self.radius);
        core::f64::consts::PI * (4.0 / 3.0) * radius * radius * radius
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
            let around_mean = Sphere::around_mean(points.iter().copied()).unwrap();
            let nearly = Sphere::nearly_smallest(points.iter().copied()).unwrap();
            for p in &points {
                for sphere in [around_mean, nearly] {
                    let d = (widen(*p) - widen(sphere.center)).length();
                    assert!(d <= f64::from(sphere.radius), "{p} outside {sphere:?}");
                    assert!(sphere.contains(*p), "{p} outside {sphere:?}");
                }
            }
            assert!(nearly.radius <= around_mean.radius);
        }
        assert_eq!(Sphere::around_mean(core::iter::empty()), None);
        assert_eq!(Sphere::nearly_smallest(core::iter::empty()), None);
    }

    #[test]
    fn nearly_the_smallest_sphere_of_an_uneven_pair_and_of_a_shell() {
        // The mean is far from the middle: a thousand points at one end, one at the other.
        let crowd = (0..1_000).map(|_| Vec3::X).chain([-Vec3::X]);
        let sphere = Sphere::nearly_smallest(crowd).unwrap();
        assert!(sphere.radius < 1.02, "{sphere:?}");
        let mut rng = fastrand::Rng::with_seed(8);
        let shell: Vec<Vec3> = (0..500)
            .map(|_| crate::testing::direction(&mut rng))
            .collect();
        let sphere = Sphere::nearly_smallest(shell.into_iter()).unwrap();
        assert!(sphere.radius < 1.02, "{sphere:?}");
        assert!((sphere.volume() / 4.18879 - 1.0).abs() < 0.06);
    }
}
