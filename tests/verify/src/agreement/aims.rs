//! Questions around triangles: aimed at places that are hard for a query, and at random places.

use glam::{DVec3, Vec3};

use super::{Among, Cast, Line, Question, Shape};

/// Makes random points, shapes and questions around triangles.
#[derive(Debug)]
pub struct Aims<'a> {
    triangles: &'a [[Vec3; 3]],
    unit: f32,
    rng: &'a mut fastrand::Rng,
}

/// The largest side of the box around triangles; 1 if that is 0.
pub fn extent(triangles: &[[Vec3; 3]]) -> f32 {
    let corners = triangles.as_flattened().iter();
    let low = corners.clone().copied().fold(Vec3::INFINITY, Vec3::min);
    let high = corners.copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    let extent = (high - low).max_element();
    if extent > 0.0 { extent } else { 1.0 }
}

impl<'a> Aims<'a> {
    /// Aims at these triangles; pass them in the pose that the questions are asked about. All lengths are shares of
    /// `unit`, a size such as the [`extent`]. Without triangles, all aims are around the origin.
    pub fn new(triangles: &'a [[Vec3; 3]], unit: f32, rng: &'a mut fastrand::Rng) -> Self {
        let triangles = if triangles.is_empty() {
            &[[Vec3::ZERO; 3]]
        } else {
            triangles
        };
        Self {
            triangles,
            unit,
            rng,
        }
    }

    /// Replaces `questions` by one question of every kind and aim, and one of every kind at a random place.
    pub fn all(&mut self, questions: &mut Vec<Question>) {
        let mut named = Vec::new();
        self.named(&mut named);
        questions.clear();
        questions.extend(named.into_iter().map(|(_, question)| question));
        self.anywhere(questions);
    }

    /// Replaces `questions` by one question of every name. Questions with the same name have the same kind and the same
    /// aim.
    pub fn named(&mut self, questions: &mut Vec<(&'static str, Question)>) {
        questions.clear();
        self.rays(questions);
        self.nearest(questions);
        self.overlaps(questions);
        self.moving(questions);
    }

    fn rays(&mut self, questions: &mut Vec<(&'static str, Question)>) {
        let across = self.skin();
        let from = self.off(across, 2.0);
        let grazed = self.triangle();
        let [a, b, _] = grazed;
        let inside = point_of(grazed, weights(self.rng));
        let tangent = (b - a).as_dvec3().try_normalize();
        let tangent = tangent.unwrap_or(DVec3::X).as_vec3() * self.unit;
        let (edge, vertex) = (self.edge(), self.vertex());
        let past = self.skin();
        let beside = self.off(past, 0.5);
        let rays = [
            ("ray across", [from, across]),
            ("ray grazing", [inside - tangent, inside]),
            ("ray at edge", [self.off(edge, 1.5), edge]),
            ("ray at vertex", [self.off(vertex, 1.5), vertex]),
            ("ray past", [self.off(past, 2.0), beside]),
        ];
        let line = |[origin, to]: [Vec3; 2], max_distance| Line {
            origin,
            direction: to - origin,
            max_distance,
        };
        let cast = |way| Question::CastRay(line(way, f32::INFINITY));
        questions.extend(rays.map(|(name, way)| (name, cast(way))));
        let any = Question::IntersectsRay(line([from, across], f32::INFINITY));
        let all = Question::CastRayAll(line([from, across], 4.0 * self.unit));
        questions.extend([("any along", any), ("all along", all)]);
    }

    fn nearest(&mut self, questions: &mut Vec<(&'static str, Question)>) {
        let corners = self.triangles.as_flattened();
        let sum: DVec3 = corners.iter().map(|p| p.as_dvec3()).sum();
        let middle = (sum / corners.len() as f64).as_vec3();
        let [skin, near, far] = [self.skin(), self.skin(), self.skin()];
        let places = [
            ("closest, near", self.off(skin, 0.02)),
            ("closest, off", self.off(near, 0.3)),
            ("closest, far", self.off(far, 20.0)),
            ("closest, middle", middle),
        ];
        questions.extend(places.map(|(name, point)| {
            let max_distance = f32::INFINITY;
            let closest = Question::ClosestPoint {
                point,
                max_distance,
            };
            (name, closest)
        }));
        let closest = Question::ClosestToCapsule {
            shape: self.capsule(0.1, 0.02),
            max_distance: f32::INFINITY,
        };
        questions.push(("closest to capsule", closest));
    }

    fn overlaps(&mut self, questions: &mut Vec<(&'static str, Question)>) {
        let shapes = [
            ("overlap, small", self.ball(0.01, 0.02)),
            ("overlap, large", self.ball(0.1, 0.2)),
            ("overlap, capsule", self.capsule(0.03, 0.02)),
        ];
        questions.extend(shapes.map(|(name, shape)| (name, Question::OverlapCapsule { shape })));
    }

    fn moving(&mut self, questions: &mut Vec<(&'static str, Question)>) {
        let (through, into) = self.towards_skin();
        let beside = self.ball(0.03, 0.02);
        let aside = self.direction() * (0.3 * self.unit);
        let capsule = self.capsule(0.15, 0.02);
        let ways = [into, into + aside * 0.5];
        let tolerance = Some(self.tolerance().into());
        let cast = |shape, displacements, moving| Cast {
            shape,
            displacements,
            moving,
            tolerance,
        };
        let casts = [
            ("cast through", cast(through, [into; 2], false)),
            ("cast along", cast(beside, [aside; 2], false)),
            ("cast capsule", cast(capsule, ways, false)),
            ("sweep through", cast(through, [into; 2], true)),
            ("sweep along", cast(beside, [aside; 2], true)),
            ("sweep capsule", cast(capsule, ways, true)),
        ];
        questions.extend(casts.map(|(name, cast)| {
            let among = Among::All;
            (name, Question::CastCapsule { cast, among })
        }));
        let cast = cast(beside, [aside * 0.3; 2], true);
        questions.push(("sweep, all", Question::CastCapsuleAll { cast }));
    }

    /// Appends one or more questions of every kind, from a place on the skin, near it or far from it. Lengths may be 0
    /// or infinite. In half of all boxes, `low.x` is above `high.x`, so the box is inside out.
    pub fn anywhere(&mut self, questions: &mut Vec<Question>) {
        let spread = self.unit * [0.0, 0.01, 0.3, 2.0][self.rng.usize(0..4)];
        let origin = self.vertex() + self.offset(spread);
        let direction = match self.rng.u32(0..3) {
            0 => self.direction(),
            _ => self.vertex() - origin,
        };
        let max_distance = self.unit * [0.0, 0.05, 0.5, f32::INFINITY][self.rng.usize(0..4)];
        questions.extend(Question::along_ray(origin, direction, max_distance));
        questions.push(Question::ClosestPoint {
            point: origin,
            max_distance,
        });
        let radius = if max_distance.is_finite() {
            max_distance
        } else {
            self.unit * 0.8
        };
        let other = origin + self.offset(self.unit * 0.3);
        let capsule = Shape {
            ends: [origin, other],
            radius: radius * 0.5,
        };
        for shape in [Shape::ball(origin, radius), capsule] {
            questions.extend([
                Question::OverlapCapsule { shape },
                Question::ClosestToCapsule {
                    shape,
                    max_distance,
                },
            ]);
            self.casts(shape, questions);
        }
        let half = self.offset(self.unit * 0.2);
        let half = half.with_y(half.y.abs()).with_z(half.z.abs());
        let (low, high) = (origin - half, origin + half);
        questions.push(Question::VisitBox { low, high });
    }

    /// Casts of a shape at skin that stands still and at skin that moves.
    fn casts(&mut self, shape: Shape, questions: &mut Vec<Question>) {
        let aim = self.vertex() - shape.ends[0];
        let aim = aim * [0.0, 0.5, 1.1, 3.0][self.rng.usize(0..4)];
        let turn = [0.0, 0.5][self.rng.usize(0..2)];
        let displacements = [aim, aim + self.offset(aim.length() * turn)];
        let share = [None, Some(0.0), Some(1e-5), Some(1e-2), Some(1.0)][self.rng.usize(0..5)];
        let tolerance = share.map(|share: f32| f64::from(shape.radius * share));
        for moving in [false, true] {
            let cast = Cast {
                shape,
                displacements,
                moving,
                tolerance,
            };
            let all = [Among::All, Among::OutsideAtStart, Among::EveryThirdTriangle];
            questions.extend(all.map(|among| Question::CastCapsule { cast, among }));
            questions.push(Question::CastCapsuleAll { cast });
        }
    }

    /// The tolerance of casts: a twenty-thousandth of the unit, 0.1 mm for a human.
    pub fn tolerance(&self) -> f32 {
        5e-5 * self.unit
    }

    /// A random triangle.
    pub fn triangle(&mut self) -> [Vec3; 3] {
        self.triangles[self.rng.usize(0..self.triangles.len())]
    }

    /// A random point of a triangle.
    pub fn skin(&mut self) -> Vec3 {
        let triangle = self.triangle();
        point_of(triangle, weights(self.rng))
    }

    /// A random point of an edge.
    pub fn edge(&mut self) -> Vec3 {
        let mut corners = self.triangle();
        corners.rotate_left(self.rng.usize(0..3));
        let along = self.rng.f32();
        point_of(corners, [along, 1.0 - along, 0.0])
    }

    /// A random corner of a triangle.
    pub fn vertex(&mut self) -> Vec3 {
        self.triangle()[self.rng.usize(0..3)]
    }

    /// A point at the distance of `units` units from `p`, in a random direction.
    pub fn off(&mut self, p: Vec3, units: f32) -> Vec3 {
        p + self.direction() * (units * self.unit)
    }

    /// A random unit vector, evenly distributed over the sphere.
    pub fn direction(&mut self) -> Vec3 {
        let up = 2.0 * self.rng.f64() - 1.0;
        let angle = self.rng.f64() * core::f64::consts::TAU;
        let across = (1.0 - up * up).sqrt();
        let (sin, cos) = libm::sincos(angle);
        DVec3::new(across * cos, across * sin, up).as_vec3()
    }

    /// A random vector in a cube with sides of `2 * half`.
    fn offset(&mut self, half: f32) -> Vec3 {
        let mut coordinate = || (self.rng.f32() * 2.0 - 1.0) * half;
        Vec3::new(coordinate(), coordinate(), coordinate())
    }

    fn ball(&mut self, off: f32, radius: f32) -> Shape {
        let skin = self.skin();
        Shape::ball(self.off(skin, off), radius * self.unit)
    }

    fn capsule(&mut self, off: f32, radius: f32) -> Shape {
        let skin = self.skin();
        Shape {
            ends: [self.off(skin, off), self.off(skin, off)],
            radius: radius * self.unit,
        }
    }

    /// A ball beside the skin, and a displacement that moves it through the skin.
    fn towards_skin(&mut self) -> (Shape, Vec3) {
        let (p, away) = (self.skin(), self.direction());
        let off = Shape::ball(p + away * (0.2 * self.unit), 0.02 * self.unit);
        (off, away * (-0.4 * self.unit))
    }
}

/// Barycentric weights of a random point of a triangle, evenly distributed.
pub fn weights(rng: &mut fastrand::Rng) -> [f32; 3] {
    let (u, v) = (rng.f32(), rng.f32());
    let (u, v) = if u + v > 1.0 {
        (1.0 - u, 1.0 - v)
    } else {
        (u, v)
    };
    [u, v, 1.0 - u - v]
}

/// The point of a triangle with the given barycentric weights, computed in f64 and rounded.
pub fn point_of([a, b, c]: [Vec3; 3], [u, v, w]: [f32; 3]) -> Vec3 {
    let sum =
        a.as_dvec3() * f64::from(u) + b.as_dvec3() * f64::from(v) + c.as_dvec3() * f64::from(w);
    sum.as_vec3()
}
