use glam::{DMat3, DVec3, Vec3};

use super::{round_to_f32, round_up_to_f32, widen};

/// All points within `radius` of the segment from `a` to `b`. A ball where the two are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// One end of the segment, in the space of the points that it bounds.
    pub a: Vec3,
    /// Its other end.
    pub b: Vec3,
    /// Radius, not negative.
    pub radius: f32,
}

/// How often the covariance is squared: the second direction fades by the 64th power of the ratio
/// of their variances. More turns the axis by less than the shape of a limb is uncertain.
const SQUARINGS: usize = 6;

/// Relative slack for a distance from a segment in f64: six roundings of 2^-53, thrice over.
const DISTANCE_SLACK: f64 = 2e-15;

impl Capsule {
    /// The capsule along the direction of greatest spread that holds all `points`; `None` without
    /// points.
    ///
    /// Its axis is the first eigenvector of the covariance, through the middle of the points' box
    /// across it; the segment is as short as the caps allow (Ericson 2005, *Real-Time Collision
    /// Detection*, chapter 4). Six passes; neither axis nor radius is searched for, so it is not the
    /// smallest one, and a round cloud is better off in a sphere. The radius is measured last, from
    /// the rounded segment, and rounded up: no point lies outside. Points must be finite, at most
    /// 2^100 from the origin.
    pub fn around_principal_axis(points: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        let (mean, axis) = principal_axis(points.clone())?;
        let (across, along) = axis.any_orthonormal_pair();
        let local = |p: Vec3| {
            let d = widen(p) - mean;
            DVec3::new(d.dot(axis), d.dot(across), d.dot(along))
        };
        let (low, high) = points
            .clone()
            .map(local)
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), d| {
                (low.min(d), high.max(d))
            });
        let middle = (low + high) * 0.5;
        let off_axis_sq = |d: DVec3| {
            let (y, z) = (d.y - middle.y, d.z - middle.z);
            y * y + z * z
        };
        let radius_sq = points
            .clone()
            .map(|p| off_axis_sq(local(p)))
            .fold(0.0, f64::max);
        let (mut start, mut end) = (f64::INFINITY, f64::NEG_INFINITY);
        for d in points.clone().map(local) {
            let cap = (radius_sq - off_axis_sq(d)).max(0.0).sqrt();
            start = start.min(d.x + cap);
            end = end.max(d.x - cap);
        }
        if start > end {
            (start, end) = ((start + end) * 0.5, (start + end) * 0.5);
        }
        let at = |x: f64| round_to_f32(mean + axis * x + across * middle.y + along * middle.z);
        Some(Self::around_segment(at(start), at(end), points))
    }

    /// The smallest capsule about the segment from `a` to `b` that holds all `points`, its radius
    /// rounded up: no point lies outside.
    pub fn around_segment(a: Vec3, b: Vec3, points: impl Iterator<Item = Vec3>) -> Self {
        let segment = Self { a, b, radius: 0.0 };
        let farthest = points.map(|p| segment.distance(p)).fold(0.0, f64::max);
        let length = (widen(b) - widen(a)).length();
        Self {
            radius: round_up_to_f32(farthest + (farthest + length) * DISTANCE_SLACK),
            ..segment
        }
    }

    /// True if `point` lies in the capsule, by f64 arithmetic.
    pub fn contains(&self, point: Vec3) -> bool {
        self.distance(point) <= f64::from(self.radius)
    }

    /// In cubic units of its space.
    pub fn volume(&self) -> f64 {
        let radius = f64::from(self.radius);
        let length = (widen(self.b) - widen(self.a)).length();
        core::f64::consts::PI * radius * radius * (length + radius * (4.0 / 3.0))
    }

    /// How far `point` is from the segment, in f64: never less than the truth but for
    /// [`DISTANCE_SLACK`], since any point of the segment is at least as far as the nearest.
    fn distance(&self, point: Vec3) -> f64 {
        let segment = widen(self.b) - widen(self.a);
        let offset = widen(point) - widen(self.a);
        let length_sq = segment.length_squared();
        let along = if length_sq > 0.0 {
            (offset.dot(segment) / length_sq).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (offset - segment * along).length()
    }
}

/// The mean of points and the unit direction of their greatest spread; X where all are equal.
fn principal_axis(points: impl Iterator<Item = Vec3> + Clone) -> Option<(DVec3, DVec3)> {
    let (sum, count) = points.clone().fold((DVec3::ZERO, 0.0), |(sum, count), p| {
        (sum + widen(p), count + 1.0)
    });
    if count == 0.0 {
        return None;
    }
    let mean = sum / count;
    let mut spread = points.fold(DMat3::ZERO, |spread, p| {
        let d = widen(p) - mean;
        spread + DMat3::from_cols(d * d.x, d * d.y, d * d.z)
    });
    for _ in 0..=SQUARINGS {
        let trace = spread.x_axis.x + spread.y_axis.y + spread.z_axis.z;
        if trace <= 0.0 {
            return Some((mean, DVec3::X));
        }
        spread *= 1.0 / trace;
        spread = spread * spread;
    }
    let columns = [spread.x_axis, spread.y_axis, spread.z_axis];
    let longest = columns
        .into_iter()
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?;
    Some((mean, longest.try_normalize().unwrap_or(DVec3::X)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{direction, point};

    /// Three cases in place of a clamp: beyond a, beyond b, beside the segment.
    fn distance_reference(capsule: &Capsule, point: Vec3) -> f64 {
        let [a, b, p] = [capsule.a, capsule.b, point].map(widen);
        let axis = b - a;
        if (p - a).dot(axis) <= 0.0 {
            (p - a).length()
        } else if (p - b).dot(axis) >= 0.0 {
            (p - b).length()
        } else {
            axis.cross(p - a).length() / axis.length()
        }
    }

    #[test]
    fn holds_every_point_at_any_scale_and_place() {
        let mut rng = fastrand::Rng::with_seed(31);
        for case in 0..3_000 {
            let scale = libm::powf(10.0, rng.f32() * 40.0 - 20.0);
            let offset = direction(&mut rng) * scale * [0.0, 1.0, 1e3, 1e6][rng.usize(0..4)];
            let flat = direction(&mut rng) * [0.0, 1.0][rng.usize(0..2)];
            let points: Vec<Vec3> = (0..rng.usize(1..40))
                .map(|_| point(&mut rng, scale))
                .map(|p| p - flat * p.dot(flat) + offset)
                .collect();
            let capsule = Capsule::around_principal_axis(points.iter().copied()).unwrap();
            for p in &points {
                assert!(capsule.contains(*p), "case {case}: {p} outside {capsule:?}");
                let size = f64::from(capsule.radius) + widen(capsule.b - capsule.a).length();
                let distance = distance_reference(&capsule, *p);
                let over = distance - f64::from(capsule.radius);
                assert!(over <= size * 1e-15, "case {case}: {p} outside {capsule:?}");
            }
        }
        assert_eq!(Capsule::around_principal_axis(core::iter::empty()), None);
    }

    #[test]
    fn points_of_a_slanted_cylinder_give_its_axis_and_radius() {
        let (start, axis) = (DVec3::new(5.0, -3.0, 2.0), DVec3::new(2.0, 3.0, 6.0) / 7.0);
        let (u, v) = axis.any_orthonormal_pair();
        let points = (0..2_000).map(|k| {
            let angle = f64::from(k) * 0.61;
            let off_axis = u * libm::cos(angle) + v * libm::sin(angle);
            (start + axis * (f64::from(k) * 0.005) + off_axis * 0.5).as_vec3()
        });
        let capsule = Capsule::around_principal_axis(points).unwrap();
        assert!((capsule.radius - 0.5).abs() < 0.01, "{capsule:?}");
        let length = capsule.a.distance(capsule.b);
        assert!((length - 10.0).abs() < 0.1, "{capsule:?}");
        let cylinder = core::f64::consts::PI * 0.25 * 10.0;
        let ends = core::f64::consts::PI / 6.0;
        assert!((capsule.volume() / (cylinder + ends) - 1.0).abs() < 0.05);
    }

    #[test]
    fn one_point_and_collinear_points() {
        let one = Capsule::around_principal_axis([Vec3::ONE; 3].into_iter()).unwrap();
        assert_eq!((one.a, one.b, one.radius), (Vec3::ONE, Vec3::ONE, 0.0));
        let line = [Vec3::ZERO, Vec3::Y * 2.0, Vec3::Y];
        let capsule = Capsule::around_principal_axis(line.into_iter()).unwrap();
        assert!(capsule.radius < 1e-12, "{capsule:?}");
        assert_eq!(capsule.a.distance(capsule.b), 2.0);
    }
}
