//! The nearest points of a convex core and a segment, by the algorithm of Gilbert, Johnson and Keerthi (1988, "A fast
//! procedure for computing the distance between complex objects in three-dimensional space"), in f64.

use glam::{DQuat, DVec3};

use super::simplex::{Corner, Simplex};
use super::{Convex, Core, MovingConvex};

/// Most rounds. In the tests' thousands of cases, cores with corners take four, at most nine; cores with rims take
/// fourteen, at most 61, at a distance of a micrometre.
const ROUNDS: u32 = 128;

/// Least gain of another corner for the search to go on, as a fraction of the squared distance. Directions are then
/// accurate to a millionth.
const GAIN: f64 = 1e-13;

/// Core and segment meet if their distance is less than this fraction of the lengths involved, which is rounding.
const MEETING: f64 = 1e-14;

/// The nearest points of a core and a segment that do not meet.
#[derive(Clone, Copy, Debug)]
pub(in crate::shapes) struct ClosestPoints {
    /// The core's point, at rest.
    pub(in crate::shapes) on_core: DVec3,
    /// Unit vector from core to segment: of all directions tried, the one with the widest gap.
    pub(in crate::shapes) normal: DVec3,
    pub(in crate::shapes) distance: f64,
}

impl Convex<'_> {
    /// The nearest points of a core and a segment in its local space, if the core is a cuboid, the segment is beyond
    /// one of its faces, and the nearest point is on that face. `None` does not mean that they meet.
    ///
    /// No point of the core is nearer than the plane of a face that the whole segment is beyond. So if the end that is
    /// nearest to the plane lies above the face, its foot is the nearest point.
    fn nearest_on_face(&self, ends: [DVec3; 2]) -> Option<ClosestPoints> {
        let Core::Cuboid { center, half } = &self.core else {
            return None;
        };
        let from_center = ends.map(|end| end - *center);
        let [p, q] = &from_center;
        let beyond = p.min(*q).max(-p.max(*q)) - *half;
        let distance = beyond.max_element();
        let size = p.length() + q.length() + half.max_element();
        if distance <= size * MEETING {
            return None;
        }
        let axis = if distance == beyond.x {
            DVec3::X
        } else if distance == beyond.y {
            DVec3::Y
        } else {
            DVec3::Z
        };
        let normal = axis * 1f64.copysign(axis.dot(*p));
        let [height, other] = [p, q].map(|end| normal.dot(*end));
        let mut order = from_center;
        if other < height {
            order.swap(0, 1);
        }
        // If both ends are equally near, either of them may be the nearest.
        let foot = |end: DVec3| {
            let inside = end.abs().cmple(*half) | axis.cmpne(DVec3::ZERO);
            inside
                .all()
                .then(|| end - normal * normal.dot(end) + normal * half.dot(axis))
        };
        let found = foot(order[0]).or_else(|| (other == height).then(|| foot(order[1])).flatten());
        Some(ClosestPoints {
            on_core: found? + *center,
            normal,
            distance,
        })
    }
}

impl MovingConvex<'_> {
    /// A segment in the solid's local space at a time, and the solid's rotation then. `None` for a turning solid
    /// between the ends of the tick: it has no rotation there, because its points move in straight lines.
    fn in_local_space(&self, time: f64, ends: [DVec3; 2]) -> Option<([DVec3; 2], DQuat)> {
        match &self.before {
            None => Some((ends, DQuat::IDENTITY)),
            Some(before) if time == 0.0 => {
                let local = ends.map(|end| before.inverse_transform(end));
                Some((local, before.rotation))
            }
            Some(before) if before.rotation == DQuat::IDENTITY => {
                let moved = before.translation * (1.0 - time);
                Some((ends.map(|end| end - moved), DQuat::IDENTITY))
            }
            Some(_) => (time == 1.0).then_some((ends, DQuat::IDENTITY)),
        }
    }

    /// The nearest points at a time; `None` if core and segment meet. `guess` is the first direction from core to
    /// segment to try, of any length; zero without a guess.
    pub(in crate::shapes) fn nearest(
        &self,
        time: f64,
        ends: [DVec3; 2],
        guess: DVec3,
    ) -> Option<ClosestPoints> {
        let local = self.in_local_space(time, ends);
        if let Some((local, rotation)) = local
            && let Some(nearest) = self.convex.nearest_on_face(local)
        {
            return Some(ClosestPoints {
                normal: rotation * nearest.normal,
                ..nearest
            });
        }
        let corner = |towards_axis: DVec3| {
            let on_core = self.support(time, towards_axis);
            let farther = towards_axis.dot(ends[1]) < towards_axis.dot(ends[0]);
            let on_axis = ends[usize::from(farther)];
            Corner {
                apart: self.point(time, on_core) - on_axis,
                on_core,
            }
        };
        let axis_size = ends[0].length().max(ends[1].length());
        let mut simplex = Simplex::new(corner(guess));
        let mut best = simplex.nearest();
        let mut size = best.apart.length() + axis_size;
        // The widest gap along a direction so far, and that direction.
        let (mut gap, mut normal) = (f64::NEG_INFINITY, DVec3::Y);
        for _ in 0..ROUNDS {
            let length_sq = best.apart.length_squared();
            if length_sq <= (size * MEETING) * (size * MEETING) {
                return None;
            }
            let next = corner(-best.apart);
            size = size.max(next.apart.length() + axis_size);
            let kept = best.apart.dot(next.apart);
            let length = length_sq.sqrt();
            if kept / length > gap {
                (gap, normal) = (kept / length, -best.apart / length);
            }
            if length_sq - kept <= length_sq * GAIN || simplex.has(&next) {
                break;
            }
            // A plane separates the two, so they do not meet, even if rounding puts the origin inside four corners that
            // are nearly flat.
            let wider = simplex.with(next, gap > 0.0)?;
            let nearest = wider.nearest();
            // Rounding allows no further progress.
            if nearest.apart.length_squared() >= length_sq {
                break;
            }
            (simplex, best) = (wider, nearest);
        }
        Some(ClosestPoints {
            on_core: best.on_core,
            normal,
            distance: best.apart.length(),
        })
    }
}
