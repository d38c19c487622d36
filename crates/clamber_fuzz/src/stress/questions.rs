//! Questions of every kind and aim, and their answers.

use clamber_surface::geometry::{Capsule, Ray, Sphere};
use clamber_surface::surface::{BruteForce, SkinnedSurface, SurfaceError, SurfaceHit, SweepHit};
use glam::Vec3;

use crate::same::bits;

/// A query with its arguments.
#[derive(Clone, Copy, Debug)]
pub(super) enum Question {
    Ray(Ray, f32),
    AnyAlong(Ray, f32),
    AllAlong(Ray, f32),
    Closest(Vec3, f32),
    ClosestToCapsule(Capsule, f32),
    Sphere(Sphere),
    Capsule(Capsule),
    CastSphere(Sphere, Vec3, f32),
    CastCapsule(Capsule, [Vec3; 2], f32),
    SweepSphere(Sphere, Vec3, f32),
    SweepCapsule(Capsule, [Vec3; 2], f32),
    SweepSphereAll(Sphere, Vec3, f32),
}

/// What came of it. Keeps its memory.
#[derive(Clone, Debug, Default)]
pub(super) struct Answer {
    pub(super) hits: Vec<SurfaceHit>,
    pub(super) sweeps: Vec<SweepHit>,
    pub(super) met: bool,
}

/// Runs the same call on a surface or on brute force.
macro_rules! ask {
    ($question:expr, $of:expr, $answer:expr) => {{
        let (of, answer) = ($of, $answer);
        answer.clear();
        match $question {
            Question::Ray(ray, max) => answer.hits.extend(of.cast_ray(ray, *max)?),
            Question::AnyAlong(ray, max) => answer.met = of.intersects_ray(ray, *max)?,
            Question::AllAlong(ray, max) => of.cast_ray_all(ray, *max, &mut answer.hits)?,
            Question::Closest(point, max) => answer.hits.extend(of.closest_point(*point, *max)?),
            Question::ClosestToCapsule(capsule, max) => {
                let found = of.closest_to_capsule(capsule, *max)?;
                answer.hits.extend(found.map(|hit| hit.surface));
            }
            Question::Sphere(sphere) => of.overlap_sphere(sphere, &mut answer.hits)?,
            Question::Capsule(capsule) => of.overlap_capsule(capsule, &mut answer.hits)?,
            Question::CastSphere(sphere, way, slack) => {
                answer.sweeps.extend(of.cast_sphere(sphere, *way, *slack)?)
            }
            Question::CastCapsule(capsule, ways, slack) => answer
                .sweeps
                .extend(of.cast_capsule(capsule, *ways, *slack)?),
            Question::SweepSphere(sphere, way, slack) => {
                answer.sweeps.extend(of.sweep_sphere(sphere, *way, *slack)?)
            }
            Question::SweepCapsule(capsule, ways, slack) => answer
                .sweeps
                .extend(of.sweep_capsule(capsule, *ways, *slack)?),
            Question::SweepSphereAll(sphere, way, slack) => {
                of.sweep_sphere_all(sphere, *way, *slack, &mut answer.sweeps)?
            }
        }
        Ok(())
    }};
}

impl Question {
    pub(super) fn ask(
        &self,
        surface: &SkinnedSurface,
        answer: &mut Answer,
    ) -> Result<(), SurfaceError> {
        ask!(self, surface, answer)
    }

    pub(super) fn ask_brute_force(
        &self,
        brute_force: &BruteForce<'_>,
        answer: &mut Answer,
    ) -> Result<(), SurfaceError> {
        ask!(self, brute_force, answer)
    }
}

impl Answer {
    fn clear(&mut self) {
        self.hits.clear();
        self.sweeps.clear();
        self.met = false;
    }

    /// How much was found.
    pub(super) fn count(&self) -> usize {
        self.hits.len() + self.sweeps.len() + usize::from(self.met)
    }

    /// Equal in every bit.
    pub(super) fn same(&self, other: &Self) -> bool {
        let sweeps = self.sweeps.iter().map(sweep_bits);
        crate::same::same_hits(&self.hits, &other.hits)
            && sweeps.eq(other.sweeps.iter().map(sweep_bits))
            && self.met == other.met
    }

    /// Panics unless every number is what the documentation says.
    pub(super) fn check(&self, question: &Question) {
        for hit in &self.hits {
            let [u, v, w] = hit.barycentric;
            let sum = f64::from(u) + f64::from(v) + f64::from(w);
            let sound = u.min(v).min(w) >= 0.0
                && (sum - 1.0).abs() < 1e-6
                && hit.point.is_finite()
                && is_unit(hit.normal)
                && hit.distance >= 0.0
                && hit.distance.is_finite();
            assert!(sound, "{question:?}: {hit:?}");
        }
        for hit in &self.sweeps {
            let [u, v, w] = hit.barycentric;
            let sum = f64::from(u) + f64::from(v) + f64::from(w);
            let sound = u.min(v).min(w) >= 0.0
                && (sum - 1.0).abs() < 1e-6
                && (0.0..=1.0).contains(&hit.time)
                && hit.point.is_finite()
                && is_unit(hit.normal)
                && is_unit(hit.surface_normal)
                && hit.distance >= 0.0
                && hit.distance.is_finite()
                && (!hit.started_inside || hit.time == 0.0);
            assert!(sound, "{question:?}: {hit:?}");
        }
    }
}

fn is_unit(normal: Vec3) -> bool {
    (normal.as_dvec3().length() - 1.0).abs() < 1e-6
}

fn sweep_bits(hit: &SweepHit) -> impl PartialEq + use<> {
    (
        (hit.triangle, hit.part, hit.tag),
        (hit.barycentric.map(f32::to_bits), bits(hit.point)),
        (bits(hit.normal), bits(hit.surface_normal)),
        (hit.time.to_bits(), hit.distance.to_bits()),
        (hit.started_inside, hit.undecided),
    )
}
