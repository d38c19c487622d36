use std::cell::{Cell, LazyCell};

use clamber_surface::geometry::MovingCapsule;
use glam::{DVec3, Vec3};
use parry3d::shape::Shape;

use super::ShapeContact;
use super::convex::{Convex, MovingConvex};
use super::overlap::{half_space, solid};
use super::parts::{Part, visit_parts};
use super::swept_bounds::{SweptBounds, is_usable, is_usable_radius};
use crate::{RigidPose, SweepContact, WorldCapsule};

/// [`WorldCapsule::sweep_tolerance`] from the radius alone.
fn sweep_tolerance(radius: f64) -> f64 {
    WorldCapsule::ball(DVec3::ZERO, radius).sweep_tolerance()
}

/// Motion of a capsule and a shape over a tick, in the shape's local space at the end of the tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeSweep {
    /// Motion of the capsule, in that space.
    pub path: MovingCapsule,
    /// Pose of the shape at the start of the tick, in the same space. Its points move in straight lines from there.
    /// `None` for a shape at rest.
    pub before: Option<RigidPose>,
}

/// The first contact of a moving capsule with a shape, in the shape's local space: the contact's point on the shape at
/// rest, and its normal and distance at that time.
type Touch = SweepContact<ShapeContact>;

/// True if one contact comes before another: orders by time, then by distance, then by position and direction, so that
/// the order in which parts are visited does not matter.
fn precedes(one: &Touch, other: &Touch) -> bool {
    let key = |touch: &Touch| {
        let point = touch.contact.point.to_array();
        let place = (point, touch.separation_normal.to_array());
        ((touch.fraction, touch.contact.distance), place)
    };
    key(one) < key(other)
}

/// The first contact of a moving capsule with a shape, up to the fraction `limit` of the motion, in the shape's local
/// space: the contact's point on the shape at rest, and its normal and distance at that time.
///
/// The reported fraction is never later than the true one. The distance at that time is at most the radius plus
/// [`WorldCapsule::sweep_tolerance`], unless the solver for triangles cannot certify a
/// distance: such a contact is reported too, and may be farther away. Triangles are two-sided. Finds nothing if a
/// coordinate is not finite or beyond 2^100, or if the radius is negative.
pub fn sweep_shape(
    shape: &dyn Shape,
    sweep: &ShapeSweep,
    limit: f64,
) -> Option<SweepContact<ShapeContact>> {
    search(shape, sweep, limit, None)
}

/// [`sweep_shape`] restricted to the contacts that `counts` accepts.
pub(super) fn sweep_shape_where(
    shape: &dyn Shape,
    sweep: &ShapeSweep,
    limit: f64,
    counts: &mut dyn FnMut(&Touch) -> bool,
) -> Option<Touch> {
    search(shape, sweep, limit, Some(counts))
}

fn search(
    shape: &dyn Shape,
    sweep: &ShapeSweep,
    limit: f64,
    mut counts: Option<&mut dyn FnMut(&Touch) -> bool>,
) -> Option<Touch> {
    let path = &sweep.path;
    let ends = [path.start, path.end];
    let usable = ends.iter().all(|[a, b]| is_usable(*a) && is_usable(*b));
    let usable = usable && is_usable_radius(path.radius);
    if !usable {
        return None;
    }
    let mut first: Option<Touch> = None;
    let reach = LazyCell::new(|| sweep.reach());
    let until = Cell::new(limit);
    visit_parts(
        shape,
        &|| reach.bounds(),
        &|bounds| reach.meets(bounds, until.get()),
        &mut |part| {
            let Some(touch) = sweep.meet(part, until.get(), &mut counts) else {
                return;
            };
            if touch.fraction <= until.get() && first.is_none_or(|first| precedes(&touch, &first)) {
                until.set(touch.fraction);
                first = Some(touch);
            }
        },
    );
    first
}

impl ShapeSweep {
    /// The capsule's start and end, each relative to the shape's pose at that time.
    fn seen_from_shape(&self) -> MovingCapsule {
        let start = |end: DVec3| match &self.before {
            Some(before) => before.inverse_transform(end),
            None => end,
        };
        MovingCapsule {
            start: self.path.start.map(start),
            ..self.path
        }
    }

    /// The region that the capsule reaches, in the space of the shape at rest.
    ///
    /// Let a point of the capsule move in a straight line from x0 to x1 relative to the shape, and let R be the shape's
    /// rotation. In this space the point deviates from a straight line by `t (1 - t) (1 - R) (x1 - x0)`. This is at
    /// most half the sine of half the angle, times the length of the line. In between, points of the shape that move in
    /// straight lines also come closer to each other: by a factor of no less than the cosine of half the angle.
    fn reach(&self) -> SweptBounds {
        let path = self.seen_from_shape();
        let touch = path.radius + 2.0 * sweep_tolerance(path.radius);
        let Some(before) = &self.before else {
            return SweptBounds::new(&path, touch);
        };
        let half_sine = before.rotation.xyz().length();
        let half_cosine = before.rotation.w.abs();
        let ways = [0, 1].map(|k| (path.end[k] - path.start[k]).length());
        let slack = 0.5 * half_sine * ways[0].max(ways[1]);
        SweptBounds::new(&path, (touch + slack) / half_cosine.max(f64::MIN_POSITIVE))
    }

    fn meet(
        &self,
        part: Part<'_>,
        limit: f64,
        counts: &mut Option<&mut dyn FnMut(&Touch) -> bool>,
    ) -> Option<Touch> {
        let touch = match part {
            Part::Triangle(corners) => self.meet_triangle(corners, limit),
            Part::Convex(convex) => self.meet_solid(&convex, limit),
            Part::HalfSpace(normal) => self.meet_half_space(normal),
            Part::Posed(pose, part) => {
                let inner = Self {
                    path: MovingCapsule {
                        start: self.path.start.map(|end| pose.inverse_transform(end)),
                        end: self.path.end.map(|end| pose.inverse_transform(end)),
                        ..self.path
                    },
                    before: self
                        .before
                        .map(|before| pose.inverse().compose(&before.compose(&pose))),
                };
                let outer = |touch: &Touch| Touch {
                    contact: ShapeContact {
                        point: pose.transform(touch.contact.point),
                        normal: pose.rotation * touch.contact.normal,
                        ..touch.contact
                    },
                    separation_normal: pose.rotation * touch.separation_normal,
                    ..*touch
                };
                // `search` has called `counts` for each of its parts.
                let touch = match counts {
                    Some(counts) => {
                        let mut counts = |touch: &Touch| counts(&outer(touch));
                        search(part, &inner, limit, Some(&mut counts))
                    }
                    None => search(part, &inner, limit, None),
                };
                return Some(outer(&touch?));
            }
        };
        touch.filter(|touch| counts.as_mut().is_none_or(|counts| counts(touch)))
    }

    fn meet_triangle(&self, corners: [Vec3; 3], limit: f64) -> Option<Touch> {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let start = match &self.before {
            Some(before) => [a, b, c].map(|corner| before.transform(corner)),
            None => [a, b, c],
        };
        let touch = self.path.cast_at_triangle(
            [start, [a, b, c]],
            sweep_tolerance(self.path.radius),
            limit,
        )?;
        let weights = touch.barycentric;
        Some(SweepContact {
            fraction: touch.fraction,
            contact: ShapeContact {
                point: a * weights.x + b * weights.y + c * weights.z,
                normal: touch.normal.unwrap_or(touch.separation_normal),
                distance: touch.distance,
            },
            separation_normal: touch.separation_normal,
            started_inside: touch.started_inside,
        })
    }

    fn meet_solid(&self, convex: &Convex<'_>, limit: f64) -> Option<Touch> {
        let moving = MovingConvex {
            convex,
            before: self.before,
        };
        let touch = moving.first_contact(&self.path, sweep_tolerance(self.path.radius), limit)?;
        let time = touch.time;
        let ends = self.path.at(time);
        let contact = match touch.nearest {
            Some(nearest) => {
                let round = moving.at_rest(time, nearest.normal).normalize_or_zero() * convex.round;
                ShapeContact {
                    point: nearest.on_core + round,
                    normal: nearest.normal,
                    distance: nearest.distance - convex.round,
                }
            }
            // The segment meets the core: at the start, or at any time if the radius is zero.
            None => {
                let place = moving.place(time);
                let contact = solid(convex, ends.map(|end| place.inverse_transform(end)));
                ShapeContact {
                    normal: place.rotation * contact.normal,
                    ..contact
                }
            }
        };
        Some(SweepContact {
            fraction: time,
            contact,
            separation_normal: contact.normal,
            started_inside: time == 0.0 && contact.distance <= self.path.radius,
        })
    }

    /// Solved relative to the half-space: the points of an infinite solid that turns have no largest speed.
    fn meet_half_space(&self, normal: DVec3) -> Option<Touch> {
        let path = self.seen_from_shape();
        let starts = path.start.map(|end| normal.dot(end) - path.radius);
        let ends = path.end.map(|end| normal.dot(end) - path.radius);
        let time = |k: usize| match (starts[k] <= 0.0, ends[k] <= 0.0) {
            (true, _) => 0.0,
            (false, true) => starts[k] / (starts[k] - ends[k]),
            (false, false) => f64::INFINITY,
        };
        let time = time(0).min(time(1));
        if time > 1.0 {
            return None;
        }
        let at = path.at(time);
        let contact = half_space(normal, at);
        Some(SweepContact {
            fraction: time,
            contact,
            separation_normal: normal,
            started_inside: time == 0.0 && contact.distance <= path.radius,
        })
    }
}
