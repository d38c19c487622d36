use glam::{DMat3, DVec3, Vec3};

use super::round_up_to_f32;

/// All points within `radius` of the segment from `a` to `b`; a ball if the two are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingCapsule {
    /// First end of the segment, in the space of the bounded points.
    pub a: Vec3,
    /// Second end of the segment.
    pub b: Vec3,
    /// Radius, at least 0.
    pub radius: f32,
}

/// The covariance is squared once more than this: the second direction fades by the 128th power of the
/// ratio of the variances. Further squarings change the axis by less than a limb's own shape leaves open.
const SQUARINGS: usize = 6;

/// Relative slack for a distance from a segment in f64: three times six roundings of 2^-53.
const DISTANCE_SLACK: f64 = 2e-15;

impl BoundingCapsule {
    /// A capsule that holds all `points`, along the direction of their greatest spread; `None` without
    /// points.
    ///
    /// Its axis is the first eigenvector of the covariance, through the middle of the points' bounding
    /// box across the axis; the segment is as short as the caps allow (Ericson 2005, *Real-Time Collision
    /// Detection*, chapter 4). It takes six passes over the points. Neither axis nor radius is optimised,
    /// so it is not the smallest capsule, and for a round cloud a sphere is tighter. The radius is measured
    /// last, from the rounded segment, and rounded up: no point lies outside. Points must be finite and at
    /// most 2^100 from the origin.
    pub fn around_principal_axis(points: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        let (mean, axis) = principal_axis(points.clone())?;
        let (across, along) = axis.any_orthonormal_pair();
        let local = |p: Vec3| {
            let d = p.as_dvec3() - mean;
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
        let at = |x: f64| (mean + axis * x + across * middle.y + along * middle.z).as_vec3();
        Some(Self::around_segment(at(start), at(end), points))
    }

    /// The smallest capsule around the segment from `a` to `b` that holds all `points`. Its radius is
    /// rounded up: no point lies outside.
    pub fn around_segment(a: Vec3, b: Vec3, points: impl Iterator<Item = Vec3>) -> Self {
        let segment = Self { a, b, radius: 0.0 };
        let farthest = points.map(|p| segment.distance(p)).fold(0.0, f64::max);
        let length = (b.as_dvec3() - a.as_dvec3()).length();
        Self {
            radius: round_up_to_f32(farthest + (farthest + length) * DISTANCE_SLACK),
            ..segment
        }
    }

    /// True if `point` lies in the capsule, by f64 arithmetic.
    pub fn contains(&self, point: Vec3) -> bool {
        self.distance(point) <= f64::from(self.radius)
    }

    /// Volume, in cubic units of the capsule's space.
    pub fn volume(&self) -> f64 {
        let radius = f64::from(self.radius);
        let length = (self.b.as_dvec3() - self.a.as_dvec3()).length();
        core::f64::consts::PI * radius * radius * (length + radius * (4.0 / 3.0))
    }

    /// Distance of `point` from the segment, in f64. Rounding may make it smaller by [`DISTANCE_SLACK`] at
    /// most: it is measured to some point of the segment, and none is nearer than the nearest.
    fn distance(&self, point: Vec3) -> f64 {
        let segment = self.b.as_dvec3() - self.a.as_dvec3();
        let offset = point.as_dvec3() - self.a.as_dvec3();
        let length_sq = segment.length_squared();
        let along = if length_sq > 0.0 {
            (offset.dot(segment) / length_sq).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (offset - segment * along).length()
    }
}

/// The mean of points and the unit direction of their greatest spread, or X if all are equal; `None`
/// without points.
fn principal_axis(points: impl Iterator<Item = Vec3> + Clone) -> Option<(DVec3, DVec3)> {
    let (sum, count) = points.clone().fold((DVec3::ZERO, 0.0), |(sum, count), p| {
        (sum + p.as_dvec3(), count + 1.0)
    });
    if count == 0.0 {
        return None;
    }
    let mean = sum / count;
    let mut spread = points.fold(DMat3::ZERO, |spread, p| {
        let d = p.as_dvec3() - mean;
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
