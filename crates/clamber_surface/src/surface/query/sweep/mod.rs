//! A sphere or capsule that moves, against the surface at one pose or between two.
//!
//! Nodes and clusters are ruled out by where their spheres are at both ends of the motion: what a
//! sphere holds moves on straight lines, so between the ends it lies in the sphere between the two.
//! Of a cluster that is reached, both poses are skinned, and triangles are ruled out by planes that
//! nothing of the cluster crosses; the others are [advanced](crate::geometry::triangle::advance) to
//! their first contact, eight at a time. Where only the first contact is asked for, all of it stops
//! at the earliest one found so far.

mod boxes;
mod broad;
mod cluster;
mod hit;
mod narrow;
mod planes;
mod search;

pub use boxes::MovingTriangle;
pub use hit::SweepHit;
pub(in crate::surface) use hit::{Earliest, First, sort_by_time};

use glam::{DVec3, Vec3};

use super::{check_length, check_point};
use crate::geometry::triangle::{Contact, MovingCore, advance};
use crate::geometry::{Capsule, Sphere, round_up_to_f32, widen};
use crate::surface::{SkinnedSurface, SurfaceError};

/// By how much rounding may widen a tolerance, as a share of the lengths involved: eight times the 2^-46
/// by which [`advance`] does.
const BLUR: f64 = 1.0 / (1u64 << 43) as f64;

/// What moves: a sphere (N = 1) or a capsule (N = 2).
#[derive(Clone, Copy, Debug)]
pub(in crate::surface) struct Sweep<const N: usize> {
    pub(in crate::surface) core: MovingCore<N>,
    ends: [Vec3; N],
    motions: [Vec3; N],
    radius: f32,
    /// No triangle is reported that is never within this of the core.
    reach: f32,
}

impl Sweep<1> {
    pub(in crate::surface) fn of_sphere(
        sphere: &Sphere,
        motion: Vec3,
        tolerance: f32,
    ) -> Result<Self, SurfaceError> {
        Self::new([sphere.center], [motion], sphere.radius, tolerance)
    }
}

impl Sweep<2> {
    pub(in crate::surface) fn of_capsule(
        capsule: &Capsule,
        motions: [Vec3; 2],
        tolerance: f32,
    ) -> Result<Self, SurfaceError> {
        let ends = [capsule.a, capsule.b];
        Self::new(ends, motions, capsule.radius, tolerance)
    }
}

impl<const N: usize> Sweep<N> {
    fn new(
        ends: [Vec3; N],
        motions: [Vec3; N],
        radius: f32,
        tolerance: f32,
    ) -> Result<Self, SurfaceError> {
        for point in ends.into_iter().chain(motions) {
            check_point(point)?;
        }
        check_finite("the radius of a sweep", radius)?;
        check_finite("the tolerance of a sweep", tolerance)?;
        Ok(Self {
            core: MovingCore::new(ends, motions, radius, tolerance),
            ends,
            motions,
            radius,
            reach: f32::INFINITY,
        })
    }

    /// With the reach that it has among triangles that are up to `size` across and away from it.
    fn among(&self, size: f64) -> Self {
        let reach = self.core.radius + self.core.tolerance + BLUR * (size + self.core.radius);
        Self {
            reach: round_up_to_f32(reach),
            ..*self
        }
    }

    /// Of its core and its way, at least.
    fn length(&self) -> f64 {
        let ends = self.core.start.iter().chain(&self.core.end);
        ends.map(|end| end.length()).sum()
    }

    /// The box around all that it reaches on its way, rounded outwards.
    fn bounds(&self) -> [[f32; 3]; 2] {
        let origin = widen(self.core.origin);
        let ends = self.core.start.iter().chain(&self.core.end);
        let (low, high) = ends.fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(low, high), end| (low.min(origin + *end), high.max(origin + *end)),
        );
        // A step of f32 is more than the sums are off by.
        let reach = f64::from(self.reach);
        let up = |x: f64| round_up_to_f32(x + reach).next_up();
        [(-low).to_array().map(|x| -up(x)), high.to_array().map(up)]
    }

    /// The first contact with one triangle.
    pub(in crate::surface) fn advance(
        &self,
        [start, end]: [[Vec3; 3]; 2],
        limit: f64,
    ) -> Option<Contact> {
        advance(start, end, &self.core, limit).0
    }
}

/// Refuses lengths that are NaN, negative or infinite.
fn check_finite(what: &'static str, length: f32) -> Result<(), SurfaceError> {
    check_length(what, length)?;
    if length.is_finite() {
        Ok(())
    } else {
        Err(SurfaceError::Query {
            what,
            range: "not negative and finite",
            found: f64::from(length),
        })
    }
}

impl SkinnedSurface {
    /// The first contact of a sphere that moves by `motion`, with the surface as posed now and
    /// standing still.
    ///
    /// See [`SkinnedSurface::sweep_sphere`] for `tolerance` and what is promised.
    ///
    /// # Errors
    /// As [`SkinnedSurface::sweep_sphere`].
    pub fn cast_sphere(
        &self,
        sphere: &Sphere,
        motion: Vec3,
        tolerance: f32,
    ) -> Result<Option<SweepHit>, SurfaceError> {
        let sweep = Sweep::of_sphere(sphere, motion, tolerance)?;
        Ok(self.first_contact([&self.current; 2], &sweep))
    }

    /// The first contact of a capsule whose ends each move by one of `motions`, with the surface as
    /// posed now and standing still.
    ///
    /// See [`SkinnedSurface::sweep_sphere`] for `tolerance` and what is promised.
    ///
    /// # Errors
    /// As [`SkinnedSurface::sweep_sphere`].
    pub fn cast_capsule(
        &self,
        capsule: &Capsule,
        motions: [Vec3; 2],
        tolerance: f32,
    ) -> Result<Option<SweepHit>, SurfaceError> {
        let sweep = Sweep::of_capsule(capsule, motions, tolerance)?;
        Ok(self.first_contact([&self.current; 2], &sweep))
    }

    /// The first contact of a sphere that moves by `motion`, while the surface moves from its
    /// previous pose to the current one. All is in the current model frame; every point moves on a
    /// straight line.
    ///
    /// The time of a contact is never later than that at which the sphere first touches the skin, and
    /// if none is found there is none. At that time the sphere is at most `tolerance` away from the
    /// skin, a length in model units: [`TOLERANCE`](crate::surface::TOLERANCE) is right at human
    /// scale; less than 2^-45 of the lengths involved counts as that. How much earlier than the
    /// touch that is has no bound where the sphere grazes the skin. Contacts for which neither could
    /// be shown are reported, and flagged [`undecided`](SweepHit::undecided).
    ///
    /// Of contacts at one time the nearest is given, of those as near the one of the smaller triangle
    /// id. A sphere that overlaps the skin at the start is in contact at time 0 with the triangle
    /// nearest to its centre.
    ///
    /// # Errors
    /// [`SurfaceError::Point`] if centre or motion is not finite, [`SurfaceError::Query`] if radius or
    /// tolerance is negative or not finite.
    pub fn sweep_sphere(
        &self,
        sphere: &Sphere,
        motion: Vec3,
        tolerance: f32,
    ) -> Result<Option<SweepHit>, SurfaceError> {
        let sweep = Sweep::of_sphere(sphere, motion, tolerance)?;
        Ok(self.first_contact([&self.previous, &self.current], &sweep))
    }

    /// The first contact of a capsule whose ends each move by one of `motions`, while the surface
    /// moves from its previous pose to the current one.
    ///
    /// See [`SkinnedSurface::sweep_sphere`] for `tolerance` and what is promised.
    ///
    /// # Errors
    /// As [`SkinnedSurface::sweep_sphere`].
    pub fn sweep_capsule(
        &self,
        capsule: &Capsule,
        motions: [Vec3; 2],
        tolerance: f32,
    ) -> Result<Option<SweepHit>, SurfaceError> {
        let sweep = Sweep::of_capsule(capsule, motions, tolerance)?;
        Ok(self.first_contact([&self.previous, &self.current], &sweep))
    }

    /// [`SkinnedSurface::sweep_sphere`] among the contacts that count: of each triangle that may be the first to be touched
    /// its contact is shown to `counts`, in no order. For a body that is pressed into skin, while other skin is still on
    /// its way: contacts that [started inside](SweepHit::started_inside) do not count then.
    ///
    /// # Errors
    /// As [`SkinnedSurface::sweep_sphere`].
    pub fn sweep_sphere_where(
        &self,
        sphere: &Sphere,
        motion: Vec3,
        tolerance: f32,
        counts: &mut dyn FnMut(&SweepHit) -> bool,
    ) -> Result<Option<SweepHit>, SurfaceError> {
        let sweep = Sweep::of_sphere(sphere, motion, tolerance)?;
        Ok(self.first_contact_where([&self.previous, &self.current], &sweep, counts))
    }

    /// [`SkinnedSurface::sweep_sphere_where`] for a capsule.
    ///
    /// # Errors
    /// As [`SkinnedSurface::sweep_sphere`].
    pub fn sweep_capsule_where(
        &self,
        capsule: &Capsule,
        motions: [Vec3; 2],
        tolerance: f32,
        counts: &mut dyn FnMut(&SweepHit) -> bool,
    ) -> Result<Option<SweepHit>, SurfaceError> {
        let sweep = Sweep::of_capsule(capsule, motions, tolerance)?;
        Ok(self.first_contact_where([&self.previous, &self.current], &sweep, counts))
    }

    /// Every triangle that [`SkinnedSurface::cast_sphere`] may meet, each with its own first contact,
    /// by time, at one time by distance, then by id. `hits` is cleared first and keeps its memory.
    ///
    /// # Errors
    /// As [`SkinnedSurface::sweep_sphere`]; `hits` is unchanged then.
    pub fn cast_sphere_all(
        &self,
        sphere: &Sphere,
        motion: Vec3,
        tolerance: f32,
        hits: &mut Vec<SweepHit>,
    ) -> Result<(), SurfaceError> {
        let sweep = Sweep::of_sphere(sphere, motion, tolerance)?;
        self.all_contacts([&self.current; 2], &sweep, hits);
        Ok(())
    }

    /// [`SkinnedSurface::cast_sphere_all`] for a capsule.
    ///
    /// # Errors
    /// As [`SkinnedSurface::sweep_sphere`]; `hits` is unchanged then.
    pub fn cast_capsule_all(
        &self,
        capsule: &Capsule,
        motions: [Vec3; 2],
        tolerance: f32,
        hits: &mut Vec<SweepHit>,
    ) -> Result<(), SurfaceError> {
        let sweep = Sweep::of_capsule(capsule, motions, tolerance)?;
        self.all_contacts([&self.current; 2], &sweep, hits);
        Ok(())
    }

    /// Every triangle that [`SkinnedSurface::sweep_sphere`] may meet, each with its own first
    /// contact, by time, at one time by distance, then by id. `hits` is cleared first and keeps its
    /// memory.
    ///
    /// # Errors
    /// As [`SkinnedSurface::sweep_sphere`]; `hits` is unchanged then.
    pub fn sweep_sphere_all(
        &self,
        sphere: &Sphere,
        motion: Vec3,
        tolerance: f32,
        hits: &mut Vec<SweepHit>,
    ) -> Result<(), SurfaceError> {
        let sweep = Sweep::of_sphere(sphere, motion, tolerance)?;
        self.all_contacts([&self.previous, &self.current], &sweep, hits);
        Ok(())
    }

    /// [`SkinnedSurface::sweep_sphere_all`] for a capsule.
    ///
    /// # Errors
    /// As [`SkinnedSurface::sweep_sphere`]; `hits` is unchanged then.
    pub fn sweep_capsule_all(
        &self,
        capsule: &Capsule,
        motions: [Vec3; 2],
        tolerance: f32,
        hits: &mut Vec<SweepHit>,
    ) -> Result<(), SurfaceError> {
        let sweep = Sweep::of_capsule(capsule, motions, tolerance)?;
        self.all_contacts([&self.previous, &self.current], &sweep, hits);
        Ok(())
    }
}
