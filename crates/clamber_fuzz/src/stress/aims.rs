//! Aims of the questions: one question of every kind and aim, at random places of the skin.

use clamber_surface::geometry::{Capsule, Ray};
use clamber_surface::surface::CastOptions;
use glam::{DVec3, Vec3};

use super::posed::{Posed, point_of, random_weights};
use super::questions::{Question, ball, capsule};
use super::soups::random_direction;

/// A question with its name. Questions with the same name are alike.
pub(super) type Named = (&'static str, Question);

/// Random points, shapes and questions around a creature.
pub(super) struct Aims<'a> {
    posed: &'a Posed<'a>,
    rng: &'a mut fastrand::Rng,
    unit: f32,
}

impl<'a> Aims<'a> {
    pub(super) fn new(posed: &'a Posed<'a>, rng: &'a mut fastrand::Rng) -> Self {
        let unit = posed.extent;
        Self { posed, rng, unit }
    }

    /// One question of each name.
    pub(super) fn all(&mut self, questions: &mut Vec<Named>) {
        questions.clear();
        self.rays(questions);
        self.nearest(questions);
        self.overlaps(questions);
        self.moving(questions);
    }

    fn rays(&mut self, questions: &mut Vec<Named>) {
        let across = self.skin();
        let from = self.off(across, 2.0);
        let grazed = self.posed.any_triangle(self.rng);
        let [a, b, _] = self.posed.corners(grazed);
        let weights = random_weights(self.rng);
        let inside = point_of(self.posed.corners(grazed), weights);
        let tangent = (b - a).as_dvec3().try_normalize();
        let tangent = tangent.unwrap_or(DVec3::X).as_vec3() * self.unit;
        let (edge, vertex) = (self.edge(), self.vertex());
        let past = self.skin();
        let beside = self.off(past, 0.5);
        let rays = [
            ("ray across", ray(from, across)),
            ("ray grazing", ray(inside - tangent, inside)),
            ("ray at edge", ray(self.off(edge, 1.5), edge)),
            ("ray at vertex", ray(self.off(vertex, 1.5), vertex)),
            ("ray past", ray(self.off(past, 2.0), beside)),
        ];
        for (name, ray) in rays {
            questions.extend(ray.map(|ray| (name, Question::Ray(ray, f32::INFINITY))));
        }
        let across = ray(from, across);
        let any = across.map(|ray| Question::AnyAlong(ray, f32::INFINITY));
        questions.extend(any.map(|any| ("any along", any)));
        let all = across.map(|ray| Question::AllAlong(ray, 4.0 * self.unit));
        questions.extend(all.map(|all| ("all along", all)));
    }

    fn nearest(&mut self, questions: &mut Vec<Named>) {
        let sum: DVec3 = self.posed.positions.iter().map(|p| p.as_dvec3()).sum();
        let middle = (sum / self.posed.positions.len() as f64).as_vec3();
        let [skin, near, far] = [self.skin(), self.skin(), self.skin()];
        let places = [
            ("closest, near", self.off(skin, 0.02)),
            ("closest, off", self.off(near, 0.3)),
            ("closest, far", self.off(far, 20.0)),
            ("closest, middle", middle),
        ];
        questions.extend(places.map(|(name, p)| (name, Question::Closest(p, f32::INFINITY))));
        let capsule = self.capsule(0.1, 0.02);
        let closest = Question::ClosestToCapsule(capsule, f32::INFINITY);
        questions.push(("closest to capsule", closest));
    }

    fn overlaps(&mut self, questions: &mut Vec<Named>) {
        let [small, large] = [0.02, 0.2].map(|radius| self.ball(0.5 * radius, radius));
        let capsule = self.capsule(0.03, 0.02);
        questions.extend([
            ("overlap, small", Question::Overlap(small)),
            ("overlap, large", Question::Overlap(large)),
            ("overlap, capsule", Question::Overlap(capsule)),
        ]);
    }

    fn moving(&mut self, questions: &mut Vec<Named>) {
        let (through, into) = self.towards_skin();
        let beside = self.ball(0.03, 0.02);
        let aside = random_direction(self.rng).as_vec3() * (0.3 * self.unit);
        let capsule = self.capsule(0.15, 0.02);
        let along = [aside; 2];
        let ways = [into, into + aside * 0.5];
        let still = CastOptions::STILL.with_tolerance(self.tolerance().into());
        let moving = CastOptions::MOVING.with_tolerance(self.tolerance().into());
        questions.extend([
            ("cast through", Question::Cast(through, [into; 2], still)),
            ("cast along", Question::Cast(beside, along, still)),
            ("cast capsule", Question::Cast(capsule, ways, still)),
            ("sweep through", Question::Cast(through, [into; 2], moving)),
            ("sweep along", Question::Cast(beside, along, moving)),
            ("sweep capsule", Question::Cast(capsule, ways, moving)),
            (
                "sweep, all",
                Question::CastAll(beside, [aside * 0.3; 2], moving),
            ),
        ]);
    }

    /// A ball off the skin, and a displacement that moves it through the skin.
    fn towards_skin(&mut self) -> (Capsule, Vec3) {
        let (p, away) = (self.skin(), random_direction(self.rng).as_vec3());
        let off = ball(p + away * (0.2 * self.unit), 0.02 * self.unit);
        (off, away * (-0.4 * self.unit))
    }

    /// The tolerance of casts: a twenty-thousandth of the creature's extent, 0.1 mm for a human.
    pub(super) fn tolerance(&self) -> f32 {
        5e-5 * self.unit
    }

    /// A random point of the skin.
    pub(super) fn skin(&mut self) -> Vec3 {
        let triangle = self.posed.any_triangle(self.rng);
        point_of(self.posed.corners(triangle), random_weights(self.rng))
    }

    /// A random point of an edge.
    pub(super) fn edge(&mut self) -> Vec3 {
        let triangle = self.posed.any_triangle(self.rng);
        let mut corners = self.posed.corners(triangle);
        corners.rotate_left(self.rng.usize(0..3));
        let along = self.rng.f32();
        point_of(corners, [along, 1.0 - along, 0.0])
    }

    /// A random vertex of a triangle.
    pub(super) fn vertex(&mut self) -> Vec3 {
        let triangle = self.posed.any_triangle(self.rng);
        self.posed.corners(triangle)[self.rng.usize(0..3)]
    }

    /// A point in a random direction, so many extents from `p`.
    pub(super) fn off(&mut self, p: Vec3, extents: f32) -> Vec3 {
        p + random_direction(self.rng).as_vec3() * (extents * self.unit)
    }

    fn ball(&mut self, off: f32, radius: f32) -> Capsule {
        let skin = self.skin();
        ball(self.off(skin, off), radius * self.unit)
    }

    fn capsule(&mut self, off: f32, radius: f32) -> Capsule {
        let skin = self.skin();
        let ends = [self.off(skin, off), self.off(skin, off)];
        capsule(ends, radius * self.unit)
    }
}

/// A ray from one point towards another; `None` if they are equal.
fn ray(from: Vec3, to: Vec3) -> Option<Ray> {
    Ray::new(from, to - from)
}
