//! Queries against brute force over all triangles.

use clamber_surface::geometry::{Capsule, Ray, Sphere};
use clamber_surface::surface::{BruteForce, SkinnedSurface, SurfaceError};
use glam::Vec3;

/// What a comparison found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    /// Hits of the queries.
    pub hits: usize,
    /// Queries whose answer differs from brute force in any bit.
    pub mismatches: usize,
}

/// Compares every query with brute force at random places near the skin, in the surface's pose: as the
/// surface answers, skinning what it touches, and as it does with everything skinned ahead. Positions
/// are compared as well.
///
/// # Errors
/// [`SurfaceError`] if a query refuses its input, which for a finite surface none does.
pub fn compare_queries(
    surface: &SkinnedSurface,
    rng: &mut fastrand::Rng,
    places: usize,
) -> Result<Agreement, SurfaceError> {
    let mut eager = surface.clone();
    eager.skin_ahead();
    let brute_force = BruteForce::new(surface);
    let positions = brute_force.positions();
    let low = positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let high = positions
        .iter()
        .copied()
        .fold(Vec3::NEG_INFINITY, Vec3::max);
    let size = (high - low).length();
    let mut all = Vec::new();
    surface.skin_all(&mut all);
    let mut agreement = Agreement::default();
    agreement.count(0, all == positions);
    let (mut hits, mut expected) = (Vec::new(), Vec::new());
    for number in 0..places {
        let near = positions[rng.usize(0..positions.len())];
        let mut offset = || (rng.f32() - 0.5) * size * 0.2;
        let place = near + Vec3::new(offset(), offset(), offset());
        let target = positions[rng.usize(0..positions.len())];
        let reach = size * rng.f32() * 0.2;
        let sphere = Sphere {
            center: place,
            radius: reach,
        };
        let capsule = Capsule {
            a: place,
            b: place + (target - place) * 0.2 * rng.f32(),
            radius: reach * 0.5,
        };
        for surface in [surface, &eager] {
            if let Some(ray) = Ray::new(place, target - place) {
                let hit = surface.cast_ray(&ray, size)?;
                let reference = brute_force.cast_ray(&ray, size)?;
                agreement.count(hit.is_some().into(), hit == reference);
                let met = surface.intersects_ray(&ray, size)?;
                agreement.count(0, met == reference.is_some());
                surface.cast_ray_all(&ray, size, &mut hits)?;
                brute_force.cast_ray_all(&ray, size, &mut expected)?;
                agreement.count(hits.len(), hits == expected);
            }
            let closest = surface.closest_point(place, reach)?;
            let reference = brute_force.closest_point(place, reach)?;
            agreement.count(closest.is_some().into(), closest == reference);
            surface.overlap_sphere(&sphere, &mut hits)?;
            brute_force.overlap_sphere(&sphere, &mut expected)?;
            agreement.count(hits.len(), hits == expected);
            surface.overlap_capsule(&capsule, &mut hits)?;
            brute_force.overlap_capsule(&capsule, &mut expected)?;
            agreement.count(hits.len(), hits == expected);
            let closest = surface.closest_to_capsule(&capsule, reach)?;
            let reference = brute_force.closest_to_capsule(&capsule, reach)?;
            agreement.count(closest.is_some().into(), closest == reference);
        }
        if number % SWEEP_EVERY == 0 {
            let motions = [target - place, (target - place) * (1.0 + rng.f32())];
            for surface in [surface, &eager] {
                agreement.compare_sweeps(surface, &brute_force, &capsule, motions)?;
            }
        }
    }
    Ok(agreement)
}

/// Sweeps are compared at every so many places: by brute force they take by far the longest.
const SWEEP_EVERY: usize = 4;

impl Agreement {
    /// Of the capsule, and of the sphere about its first end.
    fn compare_sweeps(
        &mut self,
        surface: &SkinnedSurface,
        brute_force: &BruteForce<'_>,
        capsule: &Capsule,
        motions: [Vec3; 2],
    ) -> Result<(), SurfaceError> {
        let sphere = Sphere {
            center: capsule.a,
            radius: capsule.radius,
        };
        let tolerance = capsule.radius * 1e-3;
        let hit = surface.cast_sphere(&sphere, motions[0], tolerance)?;
        let reference = brute_force.cast_sphere(&sphere, motions[0], tolerance)?;
        self.count(hit.is_some().into(), hit == reference);
        let (mut hits, mut expected) = (Vec::new(), Vec::new());
        surface.sweep_sphere_all(&sphere, motions[0], tolerance, &mut hits)?;
        brute_force.sweep_sphere_all(&sphere, motions[0], tolerance, &mut expected)?;
        self.count(hits.len(), hits == expected);
        let first = surface.sweep_sphere(&sphere, motions[0], tolerance)?;
        self.count(0, first.as_ref() == expected.first());
        surface.sweep_capsule_all(capsule, motions, tolerance, &mut hits)?;
        brute_force.sweep_capsule_all(capsule, motions, tolerance, &mut expected)?;
        self.count(hits.len(), hits == expected);
        let first = surface.sweep_capsule(capsule, motions, tolerance)?;
        self.count(0, first.as_ref() == expected.first());
        Ok(())
    }

    fn count(&mut self, hits: usize, equal: bool) {
        self.hits += hits;
        self.mismatches += usize::from(!equal);
    }
}
