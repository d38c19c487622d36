//! Compares the queries with brute force over all triangles.

use clamber_surface::geometry::{Capsule, Ray};
use clamber_surface::measure::BruteForce;
use clamber_surface::surface::{CastOptions, ModelSpace, SkinnedSurface};
use glam::Vec3;

/// The result of a comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    /// Number of hits that the queries returned.
    pub hits: usize,
    /// Number of queries whose answer differs from brute force in any bit.
    pub mismatches: usize,
}

/// Compares every query with brute force at so many random places near the skin, in the surface's pose.
///
/// Each query runs twice: on the surface as it is, which skins only what it touches, and on a copy with
/// everything skinned ahead. The skinned positions are compared as well.
pub fn compare_queries(
    surface: &SkinnedSurface,
    rng: &mut fastrand::Rng,
    places: usize,
) -> Agreement {
    let mut eager = surface.clone();
    eager.skin_ahead();
    let brute_force = BruteForce::new(surface.in_model());
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
        let end = place + (target - place) * 0.2 * rng.f32();
        let shapes = [
            Capsule::ball(place, reach),
            Capsule::new(place, end, reach * 0.5),
        ];
        for space in [surface.in_model(), eager.in_model()] {
            if let Some(ray) = Ray::new(place, target - place) {
                let hit = space.cast_ray(&ray, size);
                let reference = brute_force.cast_ray(&ray, size);
                agreement.count(hit.is_some().into(), hit == reference);
                let met = space.intersects_ray(&ray, size);
                agreement.count(0, met == reference.is_some());
                space.cast_ray_all(&ray, size, &mut hits);
                brute_force.cast_ray_all(&ray, size, &mut expected);
                agreement.count(hits.len(), hits == expected);
            }
            let closest = space.closest_point(place, reach);
            let reference = brute_force.closest_point(place, reach);
            agreement.count(closest.is_some().into(), closest == reference);
            for capsule in shapes.iter().flatten() {
                space.overlap_capsule(capsule, &mut hits);
                brute_force.overlap_capsule(capsule, &mut expected);
                agreement.count(hits.len(), hits == expected);
                let closest = space.closest_to_capsule(capsule, reach);
                let reference = brute_force.closest_to_capsule(capsule, reach);
                agreement.count(closest.is_some().into(), closest == reference);
            }
        }
        if number % CAST_EVERY == 0 {
            let motions = [target - place, (target - place) * (1.0 + rng.f32())];
            for space in [surface.in_model(), eager.in_model()] {
                let [ball, capsule] = &shapes;
                if let (Some(ball), Some(capsule)) = (ball, capsule) {
                    agreement.compare_casts(&space, &brute_force, ball, [motions[0]; 2]);
                    agreement.compare_casts(&space, &brute_force, capsule, motions);
                }
            }
        }
    }
    agreement
}

/// Casts are compared only at every so many places: by brute force they take by far the longest.
const CAST_EVERY: usize = 4;

impl Agreement {
    fn compare_casts(
        &mut self,
        space: &ModelSpace<'_>,
        brute_force: &BruteForce<'_>,
        capsule: &Capsule,
        motions: [Vec3; 2],
    ) {
        let (mut hits, mut expected) = (Vec::new(), Vec::new());
        for options in [CastOptions::STILL, CastOptions::MOVING] {
            space.cast_capsule_all(capsule, motions, &options, &mut hits);
            brute_force.cast_capsule_all(capsule, motions, &options, &mut expected);
            self.count(hits.len(), hits == expected);
            let first = space.cast_capsule(capsule, motions, &options);
            self.count(0, first.as_ref() == expected.first());
        }
    }

    fn count(&mut self, hits: usize, equal: bool) {
        self.hits += hits;
        self.mismatches += usize::from(!equal);
    }
}
