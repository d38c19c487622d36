//! Questions of every kind and aim, and their answers.

use clamber_surface::geometry::{Capsule, Ray};
use clamber_surface::measure::BruteForce;
use clamber_surface::surface::{CastOptions, SkinnedSurface, SurfaceHit, SweepHit};
use glam::Vec3;

use crate::same::{same_hits, same_sweeps};

/// A query with its arguments.
#[derive(Clone, Copy, Debug)]
pub(super) enum Question {
    Ray(Ray, f32),
    AnyAlong(Ray, f32),
    AllAlong(Ray, f32),
    Closest(Vec3, f32),
    ClosestToCapsule(Capsule, f32),
    Overlap(Capsule),
    Cast(Capsule, [Vec3; 2], CastOptions),
    CastAll(Capsule, [Vec3; 2], CastOptions),
}

/// A ball from valid numbers.
pub(super) fn ball(center: Vec3, radius: f32) -> Capsule {
    capsule([center; 2], radius)
}

/// A capsule from valid numbers.
pub(super) fn capsule([a, b]: [Vec3; 2], radius: f32) -> Capsule {
    match Capsule::new(a, b, radius) {
        Some(capsule) => capsule,
        None => panic!("no capsule of radius {radius} from {a} to {b}"),
    }
}

/// The answer to a question. Its memory is reused.
#[derive(Clone, Debug, Default)]
pub(super) struct Answer {
    pub(super) hits: Vec<SurfaceHit>,
    pub(super) sweeps: Vec<SweepHit>,
    pub(super) met: bool,
}

/// Asks a question of a surface or of brute force, which differ only in the call for whether a ray hits anything.
macro_rules! ask {
    ($question:expr, $of:expr, $answer:expr, $meets:expr) => {{
        let (of, answer) = ($of, $answer);
        answer.clear();
        match $question {
            Question::Ray(ray, max) => answer.hits.extend(of.cast_ray(ray, *max)),
            Question::AnyAlong(ray, max) => answer.met = $meets(ray, *max),
            Question::AllAlong(ray, max) => of.cast_ray_all(ray, *max, &mut answer.hits),
            Question::Closest(point, max) => answer.hits.extend(of.closest_point(*point, *max)),
            Question::ClosestToCapsule(capsule, max) => {
                let found = of.closest_to_capsule(capsule, *max);
                answer.hits.extend(found.map(|hit| hit.surface));
            }
            Question::Overlap(capsule) => of.overlap_capsule(capsule, &mut answer.hits),
            Question::Cast(capsule, ways, options) => {
                let found = of.cast_capsule(capsule, *ways, options);
                answer.sweeps.extend(found);
            }
            Question::CastAll(capsule, ways, options) => {
                of.cast_capsule_all(capsule, *ways, options, &mut answer.sweeps);
            }
        }
    }};
}

impl Question {
    pub(super) fn ask(&self, surface: &SkinnedSurface, answer: &mut Answer) {
        let space = surface.in_model();
        let meets = |ray: &Ray, max| space.intersects_ray(ray, max);
        ask!(self, space, answer, meets);
    }

    pub(super) fn ask_brute_force(&self, brute_force: &BruteForce<'_>, answer: &mut Answer) {
        let meets = |ray: &Ray, max| brute_force.cast_ray(ray, max).is_some();
        ask!(self, brute_force, answer, meets);
    }
}

impl Answer {
    fn clear(&mut self) {
        self.hits.clear();
        self.sweeps.clear();
        self.met = false;
    }

    /// Number of hits, or 1 if a ray hits anything.
    pub(super) fn count(&self) -> usize {
        self.hits.len() + self.sweeps.len() + usize::from(self.met)
    }

    /// True if both answers are equal in every bit.
    pub(super) fn same(&self, other: &Self) -> bool {
        same_hits(&self.hits, &other.hits)
            && same_sweeps(&self.sweeps, &other.sweeps)
            && self.met == other.met
    }

    /// Panics if a number of the answer is not within its documented range.
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
                && is_unit(hit.separation_normal)
                && is_unit(hit.normal)
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
