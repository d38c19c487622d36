use std::cmp::Ordering;

use glam::{DVec3, Vec3};

use super::super::by_length;
use super::Sweep;
use crate::geometry::triangle::Contact;
use crate::geometry::{round_to_f32, widen};
use crate::mesh::{PartId, SurfaceTag, TriangleId};
use crate::surface::SkinnedSurface;

/// The first contact of a moving sphere or capsule with a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepHit {
    /// The triangle.
    pub triangle: TriangleId,
    /// Weights of its corners: not negative, sum 1 up to rounding.
    pub barycentric: [f32; 3],
    /// Share of the motion that was made when they touched, 0..=1.
    pub time: f64,
    /// The triangle's point, where it is at that time, in model space.
    pub point: Vec3,
    /// Unit vector from there to the sphere's centre or the capsule's segment; where these lie on the
    /// triangle itself, its own normal.
    pub normal: Vec3,
    /// Outward unit normal of the deformed triangle at that time; where it has collapsed, `normal`.
    pub surface_normal: Vec3,
    /// From the point to the centre or the segment, in units of model space.
    pub distance: f64,
    /// The part that the triangle belongs to.
    pub part: PartId,
    /// The triangle's tag.
    pub tag: SurfaceTag,
    /// True if they overlap at the start already; the time is 0.
    pub started_inside: bool,
    /// True if rounding, or the limit of the number of steps, kept it from being shown how near they
    /// are: they do not touch before `time`, but may be farther than radius and tolerance at it.
    pub undecided: bool,
}

/// Below this share of the lengths involved a distance is rounding, and has no direction.
const ALL_BUT_TOUCHING: f64 = 1.0 / (1u64 << 46) as f64;

/// A triangle with its first contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::surface) struct First {
    pub(in crate::surface) triangle: TriangleId,
    /// Of the triangle, at the start and the end.
    pub(in crate::surface) corners: [[Vec3; 3]; 2],
    pub(in crate::surface) contact: Contact,
}

impl First {
    fn precedes(&self, other: &Self) -> bool {
        let key = |first: &Self| (first.contact.time, first.contact.distance, first.triangle);
        by_time(key(self), key(other)).is_lt()
    }
}

/// The earliest contact so far; of those at one time the nearest, of those as near the one with the
/// smaller triangle id.
#[derive(Clone, Copy, Debug)]
pub(in crate::surface) struct Earliest {
    first: Option<First>,
}

impl Earliest {
    pub(in crate::surface) const NONE: Self = Self { first: None };

    /// What is later than this does not matter; what is at that time may.
    pub(in crate::surface) fn limit(&self) -> f64 {
        self.first.map_or(1.0, |first| first.contact.time)
    }

    pub(in crate::surface) fn offer(&mut self, candidate: First) {
        if self.first.is_none_or(|first| candidate.precedes(&first)) {
            self.first = Some(candidate);
        }
    }

    pub(in crate::surface) fn hit<const N: usize>(
        &self,
        surface: &SkinnedSurface,
        sweep: &Sweep<N>,
    ) -> Option<SweepHit> {
        surface.sweep_hit(sweep, self.first?)
    }
}

impl SkinnedSurface {
    /// Completes a contact.
    pub(in crate::surface) fn sweep_hit<const N: usize>(
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
        let mut corners = start.map(widen);
        for (corner, end) in corners.iter_mut().zip(end.map(widen)) {
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
            triangle,
            barycentric: round_to_f32(weights).to_array(),
            time: contact.time,
            point: round_to_f32(point),
            normal: round_to_f32(normal),
            surface_normal: round_to_f32(outward.unwrap_or(normal)),
            distance: contact.distance,
            part,
            tag: self.mesh.tags()[triangle.index()],
            started_inside: contact.time == 0.0 && contact.distance <= sweep.core.radius,
            undecided: contact.undecided,
        })
    }
}

/// The order of contacts: by time, then distance, then triangle id.
fn by_time(a: (f64, f64, TriangleId), b: (f64, f64, TriangleId)) -> Ordering {
    by_length(a.0, b.0)
        .then_with(|| by_length(a.1, b.1))
        .then_with(|| a.2.cmp(&b.2))
}

/// Sorts contacts into the order in which [`Earliest`] prefers them.
pub(in crate::surface) fn sort_by_time(hits: &mut [SweepHit]) {
    let key = |hit: &SweepHit| (hit.time, hit.distance, hit.triangle);
    hits.sort_unstable_by(|a, b| by_time(key(a), key(b)));
}
