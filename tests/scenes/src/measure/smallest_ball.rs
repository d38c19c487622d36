//! The smallest ball around points, in f64: Welzl 1991 ("Smallest enclosing disks (balls and
//! ellipsoids)"), unrolled into one loop per point of support. It takes expected linear time on points in
//! random order. It is a reference for measurements, too slow for every tick.

use glam::{DMat3, DVec3, Vec3};

/// A ball in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Centre.
    pub center: DVec3,
    /// Radius.
    pub radius: f64,
}

/// Relative tolerance: a point that lies outside by less counts as inside. It keeps rounding from adding the
/// same point of support again.
const TOLERANCE: f64 = 1e-10;

impl Ball {
    /// Volume, in cubic units of the ball's space.
    pub fn volume(&self) -> f64 {
        core::f64::consts::PI * (4.0 / 3.0) * self.radius * self.radius * self.radius
    }

    fn holds(&self, point: DVec3) -> bool {
        (point - self.center).length() <= self.radius * (1.0 + TOLERANCE)
    }
}

/// The smallest ball around points, to a relative error of about 1e-10; `None` without points. The points
/// are shuffled with a fixed seed.
pub fn smallest_ball(points: impl Iterator<Item = Vec3>) -> Option<Ball> {
    let mut points: Vec<DVec3> = points.map(|p| p.as_dvec3()).collect();
    fastrand::Rng::with_seed(1).shuffle(&mut points);
    smallest_with(&points, &[])
}

/// The smallest ball around `points` that has `support` (up to four points) on its surface; `None` if
/// there is no such ball, or no point at all.
fn smallest_with(points: &[DVec3], support: &[DVec3]) -> Option<Ball> {
    let mut ball = circumscribed(support);
    if support.len() == 4 || ball.is_none() && !support.is_empty() {
        return ball;
    }
    for (index, point) in points.iter().enumerate() {
        if ball.is_none_or(|ball| !ball.holds(*point)) {
            let extended = [support, &[*point]].concat();
            // If there is no such ball, the point depends on the support and is outside by rounding only.
            ball = smallest_with(&points[..index], &extended).or(ball);
        }
    }
    ball
}

/// The smallest ball with all of `support` on its surface: its centre lies in the points' line, plane or space.
/// `None` without points, and if they are affinely dependent.
fn circumscribed(support: &[DVec3]) -> Option<Ball> {
    let first = *support.first()?;
    let edges: Vec<DVec3> = support[1..].iter().map(|p| *p - first).collect();
    let offset = match edges[..] {
        [] => DVec3::ZERO,
        [u] => u * 0.5,
        [u, v] => equidistant(
            [u, v, u.cross(v)],
            [u.length_squared(), v.length_squared(), 0.0],
        )?,
        [u, v, w, ..] => equidistant([u, v, w], [u, v, w].map(DVec3::length_squared))?,
    };
    Some(Ball {
        center: first + offset,
        radius: offset.length(),
    })
}

/// The x with `2 rows . x = squares`; `None` if the rows are dependent.
fn equidistant(rows: [DVec3; 3], squares: [f64; 3]) -> Option<DVec3> {
    let matrix = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
    let size = rows[0].length() * rows[1].length() * rows[2].length();
    let independent = matrix.determinant().abs() > 1e-12 * size;
    independent.then(|| matrix.inverse() * DVec3::from_array(squares) * 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clamber_surface::geometry::Sphere;

    #[test]
    fn holds_all_points_and_is_no_larger_than_the_iterated_sphere() {
        let mut rng = fastrand::Rng::with_seed(3);
        for case in 0..400 {
            let flat = [1.0, 1e-3, 0.0][case % 3];
            let mut coordinate = || rng.f32() - 0.5;
            let points: Vec<Vec3> = (0..1 + case)
                .map(|_| Vec3::new(coordinate() + 3.0, coordinate(), coordinate() * flat))
                .collect();
            let ball = smallest_ball(points.iter().copied()).unwrap();
            for p in &points {
                assert!(
                    ball.holds(p.as_dvec3()),
                    "case {case}: {p} outside {ball:?}"
                );
            }
            let near = Sphere::nearly_smallest(points.into_iter()).unwrap();
            let near = f64::from(near.radius);
            let range = ball.radius * (1.0 - 1e-9)..=ball.radius * 1.03;
            assert!(range.contains(&near), "case {case}: {near}, {ball:?}");
        }
        assert_eq!(smallest_ball(std::iter::empty()), None);
    }

    #[test]
    fn four_corners_of_a_cube_and_many_equal_points() {
        let corners = [
            Vec3::ONE,
            Vec3::new(1.0, -1.0, -1.0),
            Vec3::new(-1.0, 1.0, -1.0),
        ];
        let corners = corners.into_iter().chain([Vec3::new(-1.0, -1.0, 1.0)]);
        let ball = smallest_ball(corners.flat_map(|p| [p; 50])).unwrap();
        assert!(ball.center.length() < 1e-9, "{ball:?}");
        assert!((ball.radius - 3f64.sqrt()).abs() < 1e-9, "{ball:?}");
    }
}
