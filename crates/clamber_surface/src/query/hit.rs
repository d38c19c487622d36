use std::cmp::Ordering;

use glam::{DVec3, Vec3};

use super::instance::Instance;
use super::probe::Sweep;
use crate::geometry::triangle::{Contact, TrianglePoint, point_at, widened};
use crate::geometry::{Capsule, round_to_f32, widen};
use crate::mesh::{MeshId, PartId, SurfaceTag, TriangleId};

/// A material point that a query found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfaceHit {
    /// The mesh that has the triangle.
    pub mesh: MeshId,
    /// The triangle.
    pub triangle: TriangleId,
    /// Weights of its corners: not negative, sum 1 up to rounding.
    pub barycentric: [f32; 3],
    /// The point, in model space.
    pub point: Vec3,
    /// Outward unit normal of the deformed triangle, in model space. Where the triangle has
    /// collapsed: towards the query's origin.
    pub normal: Vec3,
    /// From the ray's origin, the query's point or the capsule's segment, in units of model space.
    pub distance: f64,
    /// The part that the triangle belongs to.
    pub part: PartId,
    /// The triangle's tag.
    pub tag: SurfaceTag,
}

/// Where a capsule and the surface are nearest to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CapsuleHit {
    /// The surface's point. Its distance is that from the capsule's segment: 0 where they cross.
    pub surface: SurfaceHit,
    /// The segment's point, in model space.
    pub segment: Vec3,
    /// Where that lies on the segment: 0 at the capsule's first end, 1 at its second.
    pub along: f32,
}

/// The first contact of a capsule on its way with a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SweepHit {
    /// The mesh that has the triangle.
    pub mesh: MeshId,
    /// The triangle.
    pub triangle: TriangleId,
    /// Weights of its corners: not negative, sum 1 up to rounding.
    pub barycentric: [f32; 3],
    /// Share of the motion that was made when they touched, 0..=1.
    pub time: f64,
    /// The triangle's point, where it is at that time, in model space.
    pub point: Vec3,
    /// Unit vector from there to the capsule's segment; where that lies on the triangle itself, its own normal.
    pub separation_normal: Vec3,
    /// Outward unit normal of the deformed triangle at that time; where it has collapsed, the separation's.
    pub normal: Vec3,
    /// From the point to the segment, in units of model space.
    pub distance: f64,
    /// The part that the triangle belongs to.
    pub part: PartId,
    /// The triangle's tag.
    pub tag: SurfaceTag,
    /// True if they overlap at the start already; the time is 0.
    pub started_inside: bool,
    /// The solver could not certify the distance within the tolerance. There is no contact before `time`.
    pub undecided: bool,
}

/// A triangle with its point that a query found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FoundPoint {
    pub(super) triangle: TriangleId,
    pub(super) found: TrianglePoint,
}

impl FoundPoint {
    /// By distance, equal ones by triangle id.
    fn compare(&self, other: &Self) -> Ordering {
        by_length(self.found.distance, other.found.distance)
            .then_with(|| self.triangle.cmp(&other.triangle))
    }
}

/// The order of lengths, none of which is NaN. -0 equals 0: which of them a distance of zero comes out as
/// depends on the order of a triangle's corners.
fn by_length(a: f64, b: f64) -> Ordering {
    a.partial_cmp(&b).unwrap_or(Ordering::Equal)
}

/// Sorts hits by distance, equal ones by triangle id: the order in which [`Best`] prefers them.
pub(super) fn sort_by_distance(hits: &mut [SurfaceHit]) {
    hits.sort_unstable_by(|a, b| {
        by_length(a.distance, b.distance).then_with(|| a.triangle.cmp(&b.triangle))
    });
}

/// The nearest triangle so far. Of equal distances the smaller triangle id wins, so the order in
/// which triangles are tested does not matter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best {
    nearest: Option<FoundPoint>,
    limit: f64,
}

impl Best {
    /// Nothing yet, and nothing farther than `limit` ever.
    pub(super) fn within(limit: f64) -> Self {
        Self {
            nearest: None,
            limit,
        }
    }

    /// What is farther than this does not matter; what is as far may.
    pub(super) fn limit(&self) -> f64 {
        self.limit
    }

    pub(super) fn offer(&mut self, candidate: FoundPoint) {
        let nearer = match &self.nearest {
            Some(best) => candidate.compare(best).is_lt(),
            None => candidate.found.distance <= self.limit,
        };
        if nearer {
            self.limit = candidate.found.distance;
            self.nearest = Some(candidate);
        }
    }

    /// The best as a hit; `origin` is where the query looked from.
    pub(super) fn hit(&self, instance: &Instance, origin: Vec3) -> Option<SurfaceHit> {
        let nearest = self.nearest?;
        let part = instance.mesh.part_of(nearest.triangle)?;
        Some(instance.hit(nearest, part, instance.corners(nearest.triangle), origin))
    }
}

/// Below this share of the lengths involved a distance is rounding, and has no direction.
const ALL_BUT_TOUCHING: f64 = 1.0 / (1u64 << 46) as f64;

/// A triangle with its first contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct First {
    pub(super) triangle: TriangleId,
    /// Of the triangle, at the start and the end.
    pub(super) corners: [[Vec3; 3]; 2],
    pub(super) contact: Contact,
}

impl First {
    fn precedes(&self, other: &Self) -> bool {
        let key = |first: &Self| (first.contact.time, first.contact.distance, first.triangle);
        by_time(key(self), key(other)).is_lt()
    }
}

/// The earliest contact so far; of those at one time the nearest, of those as near the one with the
/// smaller triangle id.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Earliest {
    first: Option<First>,
}

impl Earliest {
    /// What is later than this does not matter; what is at that time may.
    pub(super) fn limit(&self) -> f64 {
        self.first.map_or(1.0, |first| first.contact.time)
    }

    pub(super) fn offer(&mut self, candidate: First) {
        if self.first.is_none_or(|first| candidate.precedes(&first)) {
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

/// The order of contacts: by time, then distance, then triangle id.
fn by_time(a: (f64, f64, TriangleId), b: (f64, f64, TriangleId)) -> Ordering {
    by_length(a.0, b.0)
        .then_with(|| by_length(a.1, b.1))
        .then_with(|| a.2.cmp(&b.2))
}

/// Sorts contacts into the order in which [`Earliest`] prefers them.
pub(super) fn sort_by_time(hits: &mut [SweepHit]) {
    let key = |hit: &SweepHit| (hit.time, hit.distance, hit.triangle);
    hits.sort_unstable_by(|a, b| by_time(key(a), key(b)));
}

/// Adds the segment's part to the surface's.
pub(super) fn capsule_hit(capsule: &Capsule, surface: SurfaceHit) -> CapsuleHit {
    let [a, b] = capsule.ends().map(widen);
    let axis = b - a;
    let length_sq = axis.length_squared();
    let along = if length_sq > 0.0 {
        ((widen(surface.point) - a).dot(axis) / length_sq).clamp(0.0, 1.0)
    } else {
        0.0
    };
    CapsuleHit {
        surface,
        segment: (a + axis * along).as_vec3(),
        along: along as f32,
    }
}

impl Instance {
    /// Completes a hit on a triangle with the given posed corners. `origin` is where the query looked
    /// from.
    // Called, it would be handed its arguments through memory, once for every hit of an overlap.
    #[inline(always)]
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

    /// Completes a contact.
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
        let size = (b - a).length() + (c - a).length() + core.length();
        let apart = (core - point).try_normalize();
        let apart = apart.filter(|_| contact.distance > size * ALL_BUT_TOUCHING);
        let normal = apart.or(outward).unwrap_or(DVec3::Y);
        Some(SweepHit {
            mesh: self.mesh.id_of(triangle),
            triangle,
            barycentric: round_to_f32(weights).to_array(),
            time: contact.time,
            point: round_to_f32(point),
            separation_normal: round_to_f32(normal),
            normal: round_to_f32(outward.unwrap_or(normal)),
            distance: contact.distance,
            part,
            tag: self.mesh.tags()[triangle.index()],
            started_inside: contact.time == 0.0 && contact.distance <= sweep.core.radius,
            undecided: contact.undecided,
        })
    }
}
