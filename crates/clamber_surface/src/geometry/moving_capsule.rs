use glam::DVec3;

use super::MAX_COORDINATE;
use super::triangle::{first_contact_relative, nearest_to_axis};

/// A capsule whose ends each move on a straight line, from time 0 to time 1. It is a sphere if both ends are the same
/// point at both times.
///
/// Runs the surface's own triangle tests on single triangles of other geometry: a terrain, or a rigid body's mesh in
/// the body's frame. All lengths are in the units of the coordinates.
///
/// ```
/// use clamber_surface::geometry::MovingCapsule;
/// use glam::DVec3;
///
/// // A ball of 0.5 m falls by 4 m on a triangle 2 m below.
/// let ball = MovingCapsule::ball(DVec3::new(0.2, 2.0, 0.2), DVec3::NEG_Y * 4.0, 0.5);
/// let triangle = [DVec3::ZERO, DVec3::Z, DVec3::X];
/// let touch = ball.cast_at_triangle([triangle; 2], 1e-4, 1.0).unwrap();
/// assert!((touch.fraction - 0.375).abs() < 1e-4);
/// assert!((touch.separation_normal - DVec3::Y).length() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingCapsule {
    /// Ends of the segment at time 0.
    pub start: [DVec3; 2],
    /// The same ends at time 1.
    pub end: [DVec3; 2],
    /// The radius; not negative.
    pub radius: f64,
}

/// The first contact of a moving capsule with a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TriangleContact {
    /// Fraction of the motion, 0..=1; never later than the first contact.
    pub fraction: f64,
    /// Weights of the triangle's corners: not negative, sum 1 up to rounding.
    pub barycentric: DVec3,
    /// The contact point on the triangle, at that time.
    pub point: DVec3,
    /// Unit normal of the triangle at that time, towards the side from which its corners run counter-clockwise; `None`
    /// if it has collapsed.
    pub normal: Option<DVec3>,
    /// Position, along the capsule's segment, of the segment's point nearest to `point`: 0 at the first end, 1 at the
    /// second.
    pub on_axis: f64,
    /// Distance from the segment to `point`, at that time.
    pub distance: f64,
    /// Unit vector from `point` to the segment. If the segment touches the triangle itself: the triangle's normal, or Y
    /// if the triangle has collapsed.
    pub separation_normal: DVec3,
    /// True if capsule and triangle overlap at time 0.
    pub started_inside: bool,
    /// True if the solver could not certify the distance within the tolerance. There is no contact before `fraction`.
    pub undecided: bool,
}

/// A distance below this share of the lengths involved is rounding error and has no direction.
const ALL_BUT_TOUCHING: f64 = 1.0 / (1u64 << 46) as f64;

impl MovingCapsule {
    /// A sphere that moves by `displacement`.
    pub fn ball(center: DVec3, displacement: DVec3, radius: f64) -> Self {
        Self {
            start: [center; 2],
            end: [center + displacement; 2],
            radius,
        }
    }

    /// The ends at a time, 0..=1.
    pub fn at(&self, time: f64) -> [DVec3; 2] {
        // Exact at both times.
        [0, 1].map(|k| self.start[k] * (1.0 - time) + self.end[k] * time)
    }

    /// True if both ends are the same point at all times.
    pub fn is_ball(&self) -> bool {
        self.start[0] == self.start[1] && self.end[0] == self.end[1]
    }

    /// The first contact with a triangle up to the time `limit`.
    ///
    /// The triangle's corners each move on a straight line, from the first three at time 0 to the last three at time 1;
    /// pass the same three twice for a triangle at rest.
    ///
    /// The time of the contact is never later than the first touch, and for valid input `None` guarantees that there is
    /// no touch up to `limit`. A `limit` above 1 counts as 1. At the time of the contact the distance is at most the
    /// radius plus `tolerance`, unless the contact is [undecided](TriangleContact::undecided). A tolerance below 2^-45
    /// of the lengths involved counts as 2^-45 of them. The triangle is hit from both sides and may have collapsed.
    ///
    /// `None` as well if a number is not finite or larger than 2^100, or if radius, `tolerance` or `limit` is negative.
    pub fn cast_at_triangle(
        &self,
        corners: [[DVec3; 3]; 2],
        tolerance: f64,
        limit: f64,
    ) -> Option<TriangleContact> {
        let usable = |length: f64| (0.0..=MAX_COORDINATE).contains(&length);
        if !(self.is_usable(corners) && usable(tolerance) && usable(limit)) {
            return None;
        }
        let origin = self.start[0];
        let relative = corners.map(|corners| corners.map(|corner| corner - origin));
        let core = [self.start, self.end].map(|ends| ends.map(|end| end - origin));
        let lengths = [self.radius, tolerance];
        let contact = if self.is_ball() {
            let core = core.map(|[center, _]| [center]);
            first_contact_relative(relative, core, lengths, limit.min(1.0))
        } else {
            first_contact_relative(relative, core, lengths, limit.min(1.0))
        };
        let contact = contact?;
        let [start, end] = corners;
        let mut then = start;
        for (corner, end) in then.iter_mut().zip(end) {
            *corner += (end - *corner) * contact.time;
        }
        Some(TriangleContact {
            distance: contact.distance,
            undecided: contact.undecided,
            started_inside: contact.time == 0.0 && contact.distance <= self.radius,
            ..self.touch(then, contact.barycentric, contact.time)
        })
    }

    /// The point of a triangle nearest to the capsule's segment at time 0, at any distance. The result has time 0.
    ///
    /// `None` if a number is not finite or larger than 2^100, or if the radius is negative.
    pub fn nearest_of_triangle(&self, corners: [DVec3; 3]) -> Option<TriangleContact> {
        if !self.is_usable([corners; 2]) {
            return None;
        }
        let nearest = nearest_to_axis(corners, self.start);
        Some(TriangleContact {
            distance: nearest.distance,
            started_inside: nearest.distance <= self.radius,
            ..self.touch(corners, nearest.barycentric, 0.0)
        })
    }

    fn is_usable(&self, corners: [[DVec3; 3]; 2]) -> bool {
        // NaN is in no range.
        let small = |x: f64| (-MAX_COORDINATE..=MAX_COORDINATE).contains(&x);
        let ends = self.start.into_iter().chain(self.end);
        let mut points = ends.chain(corners.into_iter().flatten());
        points.all(|p| p.to_array().into_iter().all(small))
            && (0.0..=MAX_COORDINATE).contains(&self.radius)
    }

    /// A touch with its distance measured; `started_inside` and `undecided` are left false.
    fn touch(&self, corners: [DVec3; 3], barycentric: DVec3, time: f64) -> TriangleContact {
        let [a, b, c] = corners;
        let point = a * barycentric.x + b * barycentric.y + c * barycentric.z;
        let [first, last] = self.at(time);
        let axis = last - first;
        let along = (point - first).dot(axis);
        let on_axis = if along > 0.0 {
            (along / axis.length_squared()).min(1.0)
        } else {
            0.0
        };
        let apart = first + axis * on_axis - point;
        let size = (b - a).length() + (c - a).length() + axis.length() + point.length();
        let away = apart.try_normalize();
        let away = away.filter(|_| apart.length() > size * ALL_BUT_TOUCHING);
        let normal = (b - a).cross(c - a).try_normalize();
        TriangleContact {
            fraction: time,
            barycentric,
            point,
            normal,
            on_axis,
            distance: apart.length(),
            separation_normal: away.or(normal).unwrap_or(DVec3::Y),
            started_inside: false,
            undecided: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::point;

    fn random(rng: &mut fastrand::Rng, size: f64) -> DVec3 {
        point(rng, 1.0).as_dvec3() * size
    }

    /// A random capsule and triangle, with coordinates in full f64 precision.
    fn case(rng: &mut fastrand::Rng, is_ball: bool) -> (MovingCapsule, [[DVec3; 3]; 2]) {
        let offset = random(rng, 1.0) * [0.0, 1e3][rng.usize(0..2)];
        let a = random(rng, 2.0) + offset;
        let by = random(rng, 3.0);
        let mut along = || match is_ball {
            true => DVec3::ZERO,
            false => random(rng, 1.0),
        };
        let [along, turned] = [along(), along()];
        let capsule = MovingCapsule {
            start: [a, a + along],
            end: [a + by, a + by + turned],
            radius: rng.f64() * 0.3,
        };
        let corners = [(); 2].map(|()| [(); 3].map(|()| random(rng, 1.5) + offset));
        (capsule, corners)
    }

    #[test]
    fn touches_are_never_late_and_within_the_tolerance() {
        let mut rng = fastrand::Rng::with_seed(91);
        let (mut met, mut missed) = (0, 0);
        for round in 0..3_000 {
            let (capsule, corners) = case(&mut rng, round % 2 == 0);
            let touch = capsule.cast_at_triangle(corners, 1e-4, 1.0);
            let gap = |time: f64| {
                let [first, last] = corners;
                let then = [0, 1, 2].map(|k| first[k] * (1.0 - time) + last[k] * time);
                let still = MovingCapsule {
                    start: capsule.at(time),
                    end: capsule.at(time),
                    ..capsule
                };
                still.nearest_of_triangle(then).unwrap().distance - capsule.radius
            };
            let until = touch.map_or(1.0, |touch| touch.fraction);
            let inside = touch.is_some_and(|touch| touch.started_inside);
            for step in 0..200 {
                let time = until * f64::from(step) / 200.0;
                let apart = gap(time);
                let is_apart = inside || apart > -1e-9;
                assert!(is_apart, "{round} {capsule:?}: {apart} at {time}");
            }
            let Some(touch) = touch else {
                missed += 1;
                continue;
            };
            met += 1;
            let apart = gap(touch.fraction);
            assert!(!touch.undecided, "{round} {touch:?}");
            assert!(apart <= 1e-4 + 1e-9, "{round} {touch:?}: {apart}");
            let began = touch.fraction == 0.0 && apart <= 0.0;
            assert_eq!(inside, began, "{round} {touch:?}");
            // Point, direction and distance agree with the segment at that time.
            let [a, b] = capsule.at(touch.fraction);
            let on_axis = a + (b - a) * touch.on_axis;
            let off = touch.point + touch.separation_normal * touch.distance - on_axis;
            assert!(off.length() < 1e-9, "{round} {touch:?}: {off}");
        }
        assert!(met > 150 && missed > 500, "{met} {missed}");
    }

    #[test]
    fn non_finite_or_negative_numbers_touch_nothing() {
        let mut rng = fastrand::Rng::with_seed(92);
        let (mut capsule, corners) = case(&mut rng, false);
        capsule.start[0] = corners[0][0];
        assert!(capsule.cast_at_triangle(corners, 1e-4, 1.0).is_some());
        for bad in [f64::NAN, f64::INFINITY, -1.0, 1e300] {
            let radius = MovingCapsule {
                radius: bad,
                ..capsule
            };
            assert_eq!(radius.cast_at_triangle(corners, 1e-4, 1.0), None, "{bad}");
            assert_eq!(capsule.cast_at_triangle(corners, bad, 1.0), None, "{bad}");
            if bad != -1.0 {
                let mut broken = corners;
                broken[1][2].y = bad;
                assert_eq!(capsule.cast_at_triangle(broken, 1e-4, 1.0), None, "{bad}");
                assert_eq!(capsule.nearest_of_triangle(broken[1]), None, "{bad}");
                let mut broken = capsule;
                broken.end[1].z = bad;
                assert_eq!(broken.cast_at_triangle(corners, 1e-4, 1.0), None, "{bad}");
            }
        }
    }
}
