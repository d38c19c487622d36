//! Lets `clamber_oracle` ask a surface and its brute force.

use clamber_oracle::agreement::{Among, Answers, Cast, Found, Hit, Question, Shape};
use glam::Vec3;

use crate::geometry::{Capsule, Ray};
use crate::measure::BruteForce;
use crate::mesh::SurfaceTag;
use crate::surface::{
    CapsuleHit, CastOptions, ModelSpace, MovingTriangle, SurfaceHit, SweepHit, TargetMotion,
};

/// Answers a question. A surface and its brute force have the same queries under the same names.
macro_rules! answer {
    ($of:expr, $question:expr, $found:expr) => {{
        let (of, found) = ($of, $found);
        match *$question {
            Question::CastRay {
                origin,
                direction,
                max_distance,
            } => {
                let ray = Ray::new(origin, direction);
                let hit = ray.and_then(|ray| of.cast_ray(&ray, max_distance));
                found.extend(hit.as_ref().map(Found::from));
            }
            Question::IntersectsRay {
                origin,
                direction,
                max_distance,
            } => {
                let ray = Ray::new(origin, direction);
                let met = ray.is_some_and(|ray| of.intersects_ray(&ray, max_distance));
                found.extend(met.then_some(Found::Any));
            }
            Question::CastRayAll {
                origin,
                direction,
                max_distance,
            } => {
                let mut hits = Vec::new();
                if let Some(ray) = Ray::new(origin, direction) {
                    of.cast_ray_all(&ray, max_distance, &mut hits);
                }
                found.extend(hits.iter().map(Found::from));
            }
            Question::ClosestPoint {
                point,
                max_distance,
            } => {
                let hit = of.closest_point(point, max_distance);
                found.extend(hit.as_ref().map(Found::from));
            }
            Question::ClosestToCapsule {
                shape,
                max_distance,
            } => {
                let hit = capsule(shape)
                    .and_then(|capsule| of.closest_to_capsule(&capsule, max_distance));
                found.extend(hit.as_ref().map(Found::from));
            }
            Question::OverlapCapsule { shape } => {
                let mut hits = Vec::new();
                if let Some(capsule) = capsule(shape) {
                    of.overlap_capsule(&capsule, &mut hits);
                }
                found.extend(hits.iter().map(Found::from));
            }
            Question::CastCapsule { cast, among } => {
                let hit = capsule(cast.shape).and_then(|capsule| {
                    let options = options(&cast);
                    if among == Among::All {
                        return of.cast_capsule(&capsule, cast.displacements, &options);
                    }
                    let counts = &mut |hit: &SweepHit| counts(among, hit);
                    of.cast_capsule_where(&capsule, cast.displacements, &options, counts)
                });
                found.extend(hit.as_ref().map(Found::from));
            }
            Question::CastCapsuleAll { cast } => {
                let mut hits = Vec::new();
                if let Some(capsule) = capsule(cast.shape) {
                    let options = options(&cast);
                    of.cast_capsule_all(&capsule, cast.displacements, &options, &mut hits);
                }
                found.extend(hits.iter().map(Found::from));
            }
            Question::VisitBox { low, high } => {
                let mut all = Vec::new();
                of.visit_box(low, high, |moving| all.push(*moving));
                all.sort_unstable_by_key(|moving| moving.triangle);
                found.extend(all.iter().map(Found::from));
            }
        }
    }};
}

impl Answers for ModelSpace<'_> {
    fn answer(&self, question: &Question, found: &mut Vec<Found>) {
        answer!(self, question, found);
    }
}

impl Answers for BruteForce<'_> {
    fn answer(&self, question: &Question, found: &mut Vec<Found>) {
        answer!(self, question, found);
    }
}

fn capsule(shape: Shape) -> Option<Capsule> {
    let [a, b] = shape.ends;
    Capsule::new(a, b, shape.radius)
}

fn options(cast: &Cast) -> CastOptions {
    let target = if cast.moving {
        TargetMotion::Moving
    } else {
        TargetMotion::Still
    };
    CastOptions {
        tolerance: cast.tolerance,
        ..target.into()
    }
}

fn counts(among: Among, hit: &SweepHit) -> bool {
    among.counts(hit.triangle.0, hit.started_inside)
}

/// All fields of a tag in one number.
fn number(tag: SurfaceTag) -> u64 {
    let SurfaceTag { kind, ledge, user } = tag;
    (kind as u64) << 33 | u64::from(ledge) << 32 | u64::from(user)
}

impl From<&SurfaceHit> for Hit {
    fn from(hit: &SurfaceHit) -> Self {
        Self {
            mesh: hit.mesh.number(),
            triangle: hit.triangle.0,
            part: hit.part.0,
            tag: number(hit.tag),
            barycentric: hit.barycentric,
            point: hit.point,
            normal: hit.normal,
            distance: hit.distance,
        }
    }
}

impl From<&SurfaceHit> for Found {
    fn from(hit: &SurfaceHit) -> Self {
        Self::Hit(hit.into())
    }
}

impl From<&CapsuleHit> for Found {
    fn from(hit: &CapsuleHit) -> Self {
        Self::Nearest {
            hit: (&hit.surface).into(),
            segment: hit.segment,
            along: hit.along,
        }
    }
}

impl From<&SweepHit> for Found {
    fn from(hit: &SweepHit) -> Self {
        Self::Contact {
            hit: Hit {
                mesh: hit.mesh.number(),
                triangle: hit.triangle.0,
                part: hit.part.0,
                tag: number(hit.tag),
                barycentric: hit.barycentric,
                point: hit.point,
                normal: hit.normal,
                distance: hit.distance,
            },
            time: hit.time,
            separation_normal: hit.separation_normal,
            started_inside: hit.started_inside,
            undecided: hit.undecided,
        }
    }
}

impl From<&MovingTriangle> for Found {
    fn from(moving: &MovingTriangle) -> Self {
        Self::Triangle {
            triangle: moving.triangle.0,
            previous: moving.previous,
            current: moving.current,
        }
    }
}

/// The triangles of a surface in its current pose, in model space: the targets of `clamber_oracle`'s `Aims`.
pub fn posed_triangles(space: ModelSpace<'_>) -> Vec<[Vec3; 3]> {
    let brute_force = BruteForce::new(space);
    let positions = brute_force.positions();
    let all = space.instance.mesh.triangles().iter();
    all.map(|corners| corners.map(|v| positions[v.index()]))
        .collect()
}
