use std::cmp::Ordering;

use glam::{DVec3, Vec3};

use super::instance::Instance;
use super::probe::Sweep;
use crate::geometry::triangle::{Contact, TrianglePoint, point_at, widened};
use crate::geometry::{round_to_f32, widen};
use crate::mesh::{MeshId, PartId, SurfaceTag, TriangleId};

/// A material point that a query found: in model space, or in world space as `SurfaceHit<DVec3>`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfaceHit<V = Vec3> {
    /// The mesh that the triangle belongs to.
    pub mesh: MeshId,
    /// The triangle's id.
    pub triangle: TriangleId,
    /// Weights of the triangle's corners: not negative, sum 1 up to rounding.
    pub barycentric: [f32; 3],
    /// The point.
    pub point: V,
    /// Outward unit normal of the deformed triangle. If the triangle has collapsed: the unit vector from the point
    /// towards the ray's origin, the query's point or the middle of the capsule's segment; for a sweep, the separation
    /// normal.
    pub normal: V,
    /// Distance from the ray's origin, the query's point or the capsule's segment, in model units or metres.
    pub distance: f64,
    /// The part that the triangle belongs to.
    pub part: PartId,
    /// The triangle's tag.
    pub tag: SurfaceTag,
}

/// The first contact of a moving capsule with a triangle: in model space, or in world space as `SweepHit<DVec3>`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SweepHit<V = Vec3> {
    /// The contact point on the triangle at that time; its `distance` is measured from the capsule's segment.
    pub hit: SurfaceHit<V>,
    /// Fraction of the motion until the contact, 0..=1.
    pub fraction: f64,
    /// Unit vector from the contact point to the capsule's segment. If the segment touches the triangle itself: the
    /// triangle's normal.
    pub separation_normal: V,
    /// True if capsule and triangle overlap at the start; the fraction is 0 then.
    pub started_inside: bool,
    /// True if the solver could not certify the distance within the tolerance. There is no contact before `fraction`.
    pub undecided: bool,
}

/// A triangle and its point that a query found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FoundPoint {
    pub(super) triangle: TriangleId,
    pub(super) found: TrianglePoint,
}

impl FoundPoint {
    /// Orders by distance, then by triangle id.
    fn compare(&self, other: &Self) -> Ordering {
        by_length(self.found.distance, other.found.distance)
            .then_with(|| self.triangle.cmp(&other.triangle))
    }
}

/// Orders lengths that are not NaN. -0 equals 0: the sign of a distance of zero depends on the order of a triangle's
/// corners.
fn by_length(a: f64, b: f64) -> Ordering {
    a.partial_cmp(&b).unwrap_or(Ordering::Equal)
}

/// Sorts hits by distance, then by triangle id: the order in which [`Best`] prefers them.
pub(super) fn sort_by_distance(hits: &mut [SurfaceHit]) {
    hits.sort_unstable_by(|a, b| {
        by_length(a.distance, b.distance).then_with(|| a.triangle.cmp(&b.triangle))
    });
}

/// The nearest triangle so far. Among equal distances the smaller triangle id wins, so the order in which triangles are
/// tested does not matter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best {
    /// The nearest point, with the part and the corners of its triangle.
    nearest: Option<(FoundPoint, PartId, [Vec3; 3])>,
    limit: f64,
}

impl Best {
    /// Empty; ignores everything farther than `limit`.
    pub(super) fn within(limit: f64) -> Self {
        Self {
            nearest: None,
            limit,
        }
    }

    /// Triangles farther than this do not matter; a triangle exactly as far may.
    pub(super) fn limit(&self) -> f64 {
        self.limit
    }

    /// Takes a triangle, of a part and with corners, if it is the nearest.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn offer(
        &mut self,
        candidate: FoundPoint,
        part: PartId,
        corners: impl FnOnce() -> [Vec3; 3],
    ) {
        let nearer = match &self.nearest {
            Some((best, ..)) => candidate.compare(best).is_lt(),
            None => candidate.found.distance <= self.limit,
        };
        if nearer {
            self.limit = candidate.found.distance;
            self.nearest = Some((candidate, part, corners()));
        }
    }

    /// The best as a hit; `origin` is the query's origin, as for [`Instance::hit`].
    pub(super) fn hit(&self, instance: &Instance, origin: Vec3) -> Option<SurfaceHit> {
        let (nearest, part, corners) = self.nearest?;
        Some(instance.hit(nearest, part, corners, origin))
    }
}

/// A distance below this share of the lengths involved is rounding error and has no direction.
const ALL_BUT_TOUCHING: f64 = 1.0 / (1u64 << 46) as f64;

/// A triangle and its first contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct First {
    pub(super) triangle: TriangleId,
    /// Corners of the triangle at the start and at the end.
    pub(super) corners: [[Vec3; 3]; 2],
    pub(super) contact: Contact,
}

impl First {
    fn precedes(&self, other: &Self) -> bool {
        let key = |first: &Self| (first.contact.time, first.contact.distance, first.triangle);
        by_time(key(self), key(other)).is_lt()
    }
}

/// The earliest contact so far. Among contacts at one time the nearest wins, then the one with the smaller triangle id.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Earliest {
    first: Option<First>,
}

impl Earliest {
    /// Contacts later than this do not matter; a contact at exactly this time may.
    pub(super) fn limit(&self) -> f64 {
        self.first.map_or(1.0, |first| first.contact.time)
    }

    pub(super) fn offer(&mut self, candidate: First) {
        self.offer_if(candidate, |_| true);
    }

    /// Takes a contact if it would be the earliest and `counts` accepts it. Calls `counts` only for such a contact.
    pub(super) fn offer_if(&mut self, candidate: First, counts: impl FnOnce(&First) -> bool) {
        if self.first.is_none_or(|first| candidate.precedes(&first)) && counts(&candidate) {
            self.first = Some(candidate);
        }
    }

    pub(super) fn hit<const N: usize>(
        &self,
        instance: &Instance,
        sweep: &Sweep<N>,
    ) -> Option<SweepHit> {
        instance.sweep_hit(sweep, self.first?)
    }
}

/// Orders contacts by time, then distance, then triangle id.
fn by_time(a: (f64, f64, TriangleId), b: (f64, f64, TriangleId)) -> Ordering {
    by_length(a.0, b.0)
        .then_with(|| by_length(a.1, b.1))
        .then_with(|| a.2.cmp(&b.2))
}

/// Sorts contacts into the order in which [`Earliest`] prefers them.
pub(super) fn sort_by_time(hits: &mut [SweepHit]) {
    let key = |sweep: &SweepHit| (sweep.fraction, sweep.hit.distance, sweep.hit.triangle);
    hits.sort_unstable_by(|a, b| by_time(key(a), key(b)));
}

impl Instance {
    /// Completes a hit on a triangle with the given posed corners. `origin` is the query's origin: the normal of a
    /// collapsed triangle points to it.
    // Inlined: a call would pass its arguments through memory, once for every hit of an overlap.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn hit(
        &self,
        nearest: FoundPoint,
        part: PartId,
        corners: [Vec3; 3],
        origin: Vec3,
    ) -> SurfaceHit {
        let FoundPoint { triangle, found } = nearest;
        let point = point_at(corners, found.barycentric);
        let normal = self
            .outward_normal(corners, part)
            .unwrap_or_else(|| (widen(origin) - point).try_normalize().unwrap_or(DVec3::Y));
        SurfaceHit {
            mesh: self.mesh.id_of(triangle),
            triangle,
            barycentric: round_to_f32(found.barycentric).to_array(),
            point: round_to_f32(point),
            normal: round_to_f32(normal),
            distance: found.distance,
            part,
            tag: self.mesh.tags()[triangle.index()],
        }
    }

    /// Completes a contact; `None` if the triangle was removed.
    pub(super) fn sweep_hit<const N: usize>(
        &self,
        sweep: &Sweep<N>,
        first: First,
    ) -> Option<SweepHit> {
        let First {
            triangle,
            corners: [start, end],
            contact,
        } = first;
        let part = self.mesh.part_of(triangle)?;
        let mut corners = widened(start);
        for (corner, end) in corners.iter_mut().zip(widened(end)) {
            *corner += (end - *corner) * contact.time;
        }
        let [a, b, c] = corners;
        let weights = contact.barycentric;
        let point = a * weights.x + b * weights.y + c * weights.z;
        let outward = (b - a).cross(c - a).try_normalize();
        let outward = outward.map(|n| if self.is_mirrored(part) { -n } else { n });
        let core = sweep.core.nearest(contact.time, point);
        let (ab, ac) = (b - a, c - a);
        // An upper bound of the lengths. The lengths themselves are seldom needed.
        let most = taxicab(ab) + taxicab(ac) + taxicab(core);
        let is_apart = contact.distance > most * ALL_BUT_TOUCHING || {
            let size = ab.length() + ac.length() + core.length();
            contact.distance > size * ALL_BUT_TOUCHING
        };
        let apart = (core - point).try_normalize().filter(|_| is_apart);
        let normal = apart.or(outward).unwrap_or(DVec3::Y);
        let hit = SurfaceHit {
            mesh: self.mesh.id_of(triangle),
            triangle,
            barycentric: round_to_f32(weights).to_array(),
            point: round_to_f32(point),
            normal: round_to_f32(outward.unwrap_or(normal)),
            distance: contact.distance,
            part,
            tag: self.mesh.tags()[triangle.index()],
        };
        Some(SweepHit {
            hit,
            fraction: contact.time,
            separation_normal: round_to_f32(normal),
            started_inside: sweep.started_inside(&contact),
            undecided: contact.undecided,
        })
    }
}

/// The sum of absolute coordinates: at least the length.
fn taxicab(v: DVec3) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}
