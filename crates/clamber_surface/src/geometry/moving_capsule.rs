use glam::{DVec3, Vec3};

use super::triangle::{MovingCore, advance, nearest_to_axis, point_at};
use super::{MAX_COORDINATE, widen};

/// A capsule whose ends each move on a straight line, over a time from 0 to 1; a sphere where both ends are one point
/// at both times.
///
/// What the sweeps of a surface do with its triangles, for one triangle of anything else: an own terrain, a mesh of a
/// rigid body in the body's frame.
///
/// ```
/// use clamber_surface::geometry::MovingCapsule;
/// use glam::{DVec3, Vec3};
///
/// // A ball of 0.5 m falls by 4 m on a triangle 2 m below.
/// let ball = MovingCapsule::ball(DVec3::new(0.2, 2.0, 0.2), DVec3::NEG_Y * 4.0, 0.5);
/// let touch = ball.cast_at_triangle([Vec3::ZERO, Vec3::Z, Vec3::X], 1e-4, 1.0).unwrap();
/// assert!((touch.time - 0.375).abs() < 1e-4);
/// assert!((touch.away - DVec3::Y).length() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingCapsule {
    /// Ends of the segment at time 0.
    pub start: [DVec3; 2],
    /// The same ends at time 1.
    pub end: [DVec3; 2],
    /// Not negative.
    pub radius: f64,
}

/// Where a moving capsule first touches a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleTouch {
    /// 0..=1, never later than the first contact.
    pub time: f64,
    /// Weights of the corners: not negative, sum 1 up to rounding.
    pub barycentric: DVec3,
    /// The triangle's point.
    pub point: DVec3,
    /// Where on the capsule's segment the point nearest to it lies, from 0 at the first end to 1.
    pub on_axis: f64,
    /// From the segment to the point, at that time.
    pub distance: f64,
    /// Unit vector from the point to the segment; where they cross, the triangle's normal.
    pub away: DVec3,
    /// They overlap at time 0.
    pub started_inside: bool,
    /// Neither contact nor its absence could be shown, for rounding or within the steps allowed: no contact before
    /// the time, but the distance may be larger than promised.
    pub undecided: bool,
}

/// Below this share of the lengths involved a distance is rounding, and has no direction.
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

    /// Where the ends are at a time, 0..=1.
    pub fn at(&self, time: f64) -> [DVec3; 2] {
        // Exact at both times.
        [0, 1].map(|k| self.start[k] * (1.0 - time) + self.end[k] * time)
    }

    /// Whether both ends stay one point.
    pub fn is_ball(&self) -> bool {
        self.start[0] == self.start[1] && self.end[0] == self.end[1]
    }

    /// The first contact with a triangle that stands still, up to the time `limit`.
    ///
    /// Its time is never later than that of the first touch, and if none is found there is none up to `limit`. At
    /// that time the distance is at most radius and `tolerance`; less than 2^-45 of the lengths involved counts as
    /// that. The triangle is met from both sides and may have collapsed. `None` if anything is not finite or larger
    /// than 2^100, or if radius or tolerance is negative.
    pub fn cast_at_triangle(
        &self,
        corners: [Vec3; 3],
        tolerance: f64,
        limit: f64,
    ) -> Option<TriangleTouch> {
        let usable = |length: f64| (0.0..=MAX_COORDINATE).contains(&length);
        if !(self.is_usable(corners) && usable(tolerance) && usable(limit)) {
            return None;
        }
        // Relative to a point of f32, as corners are.
        let origin = self.start[0].as_vec3();
        let local = |p: DVec3| p - widen(origin);
        let contact = if self.is_ball() {
            let core = MovingCore {
                origin,
                start: [local(self.start[0])],
                end: [local(self.end[0])],
                radius: self.radius,
                tolerance,
            };
            advance(corners, corners, &core, limit.min(1.0)).0
        } else {
            let core = MovingCore {
                origin,
                start: self.start.map(local),
                end: self.end.map(local),
                radius: self.radius,
                tolerance,
            };
            advance(corners, corners, &core, limit.min(1.0)).0
        };
        let contact = contact?;
        let mut touch = self.touch(corners, contact.barycentric, contact.time);
        touch.distance = contact.distance;
        touch.undecided = contact.undecided;
        touch.started_inside = contact.time == 0.0 && contact.distance <= self.radius;
        Some(touch)
    }

    /// The point of a triangle nearest to the capsule's segment at time 0, whatever the radius; its time is 0. `None`
    /// as for [`MovingCapsule::cast_at_triangle`].
    pub fn nearest_of_triangle(&self, corners: [Vec3; 3]) -> Option<TriangleTouch> {
        if !self.is_usable(corners) {
            return None;
        }
        let nearest = nearest_to_axis(corners, self.start);
        let mut touch = self.touch(corners, nearest.barycentric, 0.0);
        touch.distance = nearest.distance;
        touch.started_inside = nearest.distance <= self.radius;
        Some(touch)
    }

    fn is_usable(&self, corners: [Vec3; 3]) -> bool {
        // NaN is in no range.
        let small = |x: f64| (-MAX_COORDINATE..=MAX_COORDINATE).contains(&x);
        let ends = self.start.into_iter().chain(self.end);
        let mut points = ends.chain(corners.map(widen));
        points.all(|p| p.to_array().into_iter().all(small))
            && (0.0..=MAX_COORDINATE).contains(&self.radius)
    }

    /// With the distance measured, and nothing said of inside and undecided.
    fn touch(&self, corners: [Vec3; 3], barycentric: DVec3, time: f64) -> TriangleTouch {
        let point = point_at(corners, barycentric);
        let [first, last] = self.at(time);
        let axis = last - first;
        let along = (point - first).dot(axis);
        let on_axis = if along > 0.0 {
            (along / axis.length_squared()).min(1.0)
        } else {
            0.0
        };
        let apart = first + axis * on_axis - point;
        let [a, b, c] = corners.map(widen);
        let size = (b - a).length() + (c - a).length() + axis.length() + point.length();
        let away = apart.try_normalize();
        let away = away.filter(|_| apart.length() > size * ALL_BUT_TOUCHING);
        let normal = || (b - a).cross(c - a).try_normalize();
        TriangleTouch {
            time,
            barycentric,
            point,
            on_axis,
            distance: apart.length(),
            away: away.or_else(normal).unwrap_or(DVec3::Y),
            started_inside: false,
            undecided: false,
        }
    }
}
