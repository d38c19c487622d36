//! Lets `clamber_surface` answer the questions of [`agreement`](crate::agreement).

/// Implements [`Answers`](crate::agreement::Answers) for the `ModelSpace` and the `BruteForce` of `clamber_surface`,
/// whose path is the argument.
///
/// It is a macro because the unit tests of `clamber_surface` need it as well. They are compiled with a copy of that
/// crate whose types differ from those that this crate depends on, and call the macro with `crate`.
#[macro_export]
macro_rules! answer_as_surface {
    (@impl $type:ident) => {
        impl Answers for $type<'_> {
            fn answer(&self, question: &Question, found: &mut Vec<Found>) {
                match *question {
                    Question::CastRay(line) => {
                        let hit = ray(line).and_then(|ray| self.cast_ray(&ray, line.max_distance));
                        found.extend(hit.as_ref().map(surface_row));
                    }
                    Question::IntersectsRay(line) => {
                        let met = |ray: Ray| self.intersects_ray(&ray, line.max_distance);
                        found.extend(ray(line).is_some_and(met).then_some(Found::Any));
                    }
                    Question::CastRayAll(line) => {
                        let mut hits = Vec::new();
                        if let Some(ray) = ray(line) {
                            self.cast_ray_all(&ray, line.max_distance, &mut hits);
                        }
                        found.extend(hits.iter().map(surface_row));
                    }
                    Question::ClosestPoint {
                        point,
                        max_distance,
                    } => {
                        let hit = self.closest_point(point, max_distance);
                        found.extend(hit.as_ref().map(surface_row));
                    }
                    Question::ClosestToCapsule {
                        shape,
                        max_distance,
                    } => {
                        let hit = capsule(shape)
                            .and_then(|capsule| self.closest_to_capsule(&capsule, max_distance));
                        found.extend(hit.as_ref().map(surface_row));
                    }
                    Question::OverlapCapsule { shape } => {
                        let mut hits = Vec::new();
                        if let Some(capsule) = capsule(shape) {
                            self.overlap_capsule(&capsule, &mut hits);
                        }
                        found.extend(hits.iter().map(surface_row));
                    }
                    Question::CastCapsule { cast, among } => {
                        let hit = capsule(cast.shape).and_then(|capsule| {
                            let options = options(&cast);
                            if among == Among::All {
                                return self.cast_capsule(&capsule, cast.displacements, &options);
                            }
                            let counts = &mut |sweep: &SweepHit| {
                                among.counts(sweep.hit.triangle.0, sweep.started_inside)
                            };
                            self.cast_capsule_where(&capsule, cast.displacements, &options, counts)
                        });
                        found.extend(hit.as_ref().map(sweep_row));
                    }
                    Question::CastCapsuleAll { cast } => {
                        let mut hits = Vec::new();
                        if let Some(capsule) = capsule(cast.shape) {
                            let options = options(&cast);
                            self.cast_capsule_all(
                                &capsule,
                                cast.displacements,
                                &options,
                                &mut hits,
                            );
                        }
                        found.extend(hits.iter().map(sweep_row));
                    }
                    Question::VisitBox { low, high } => {
                        let mut all = Vec::new();
                        self.visit_box(low, high, |moving| all.push(*moving));
                        all.sort_unstable_by_key(|moving| moving.triangle);
                        found.extend(all.iter().map(triangle_row));
                    }
                }
            }
        }
    };
    ($surface:tt) => {
        const _: () = {
            use std::hash::{DefaultHasher, Hash, Hasher};

            use $crate::agreement::{Among, Answers, Cast, Found, Hit, Line, Question, Shape};
            use $surface::geometry::{Capsule, Ray};
            use $surface::measure::BruteForce;
            use $surface::surface::{
                CastOptions, ModelSpace, MovingTriangle, SurfaceHit, SweepHit, TargetMotion,
            };

    $crate::answer_as_surface!(@impl ModelSpace);
    $crate::answer_as_surface!(@impl BruteForce);

            fn ray(line: Line) -> Option<Ray> {
                Ray::new(line.origin, line.direction)
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
                let mut options = CastOptions::from(target);
                options.tolerance = cast.tolerance;
                options
            }

            /// A hash of an id or a tag. Equal values have the same hash within one run of a program.
            fn hashed(value: &impl Hash) -> u64 {
                let mut hasher = DefaultHasher::new();
                value.hash(&mut hasher);
                hasher.finish()
            }

            fn surface_hit(hit: &SurfaceHit) -> Hit {
                Hit {
                    mesh: hashed(&hit.mesh),
                    triangle: hit.triangle.0,
                    part: hit.part.0,
                    tag: hashed(&hit.tag),
                    barycentric: hit.barycentric,
                    point: hit.point,
                    normal: hit.normal,
                    distance: hit.distance,
                }
            }

            fn surface_row(hit: &SurfaceHit) -> Found {
                Found::Hit(surface_hit(hit))
            }

            fn sweep_row(sweep: &SweepHit) -> Found {
                Found::Contact {
                    hit: surface_hit(&sweep.hit),
                    fraction: sweep.fraction,
                    separation_normal: sweep.separation_normal,
                    started_inside: sweep.started_inside,
                    undecided: sweep.undecided,
                }
            }

            fn triangle_row(moving: &MovingTriangle) -> Found {
                Found::Triangle {
                    triangle: moving.triangle.0,
                    previous: moving.previous,
                    current: moving.current,
                }
            }
        };
    };
}

answer_as_surface!(clamber_surface);
