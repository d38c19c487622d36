use clamber_surface::geometry::MovingCapsule;
use clamber_surface::parry::parry3d;
use glam::{DVec3, Vec3};
use parry3d::shape::Shape;

use super::convex::Convex;
use super::overlap::{half_space, outward, solid};
use super::parts::{Part, visit_parts};
use super::reach::Reach;
use super::{RigidPose, ShapeContact, TOLERANCE};

/// Where a capsule on its way first touches a shape, in the shape's own space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeTouch {
    /// Share of the way, 0..=1.
    pub time: f64,
    /// Where and how the shape is touched then.
    pub contact: ShapeContact,
    /// Unit vector from there towards the capsule's segment; the way out where that lies inside of a solid.
    pub away: DVec3,
    /// Where on the segment the nearest point lies, from 0 at the first end to 1.
    pub on_axis: f64,
    /// They overlap at the start; the time is 0.
    pub started_inside: bool,
    /// Neither contact nor its absence could be shown, for rounding or within the steps allowed: no contact before
    /// the time, but the distance may be larger than promised.
    pub undecided: bool,
}

impl ShapeTouch {
    /// The earlier; of those at one time the nearer; then by place and normal, so that the order in which parts are
    /// met does not matter.
    fn precedes(&self, other: &Self) -> bool {
        let key = |touch: &Self| {
            let contact = &touch.contact;
            let place = (contact.point.to_array(), contact.normal.to_array());
            ((touch.time, contact.distance), place)
        };
        key(self) < key(other)
    }
}

/// The first contact of a capsule with a shape that stands still, both in the shape's own space, up to the time
/// `limit`.
///
/// Never later than the true one, at a distance of at most the capsule's radius and 0.1 mm. Triangles are met from both
/// sides. `None` if anything is not finite, or the radius negative.
pub fn sweep_shape(shape: &dyn Shape, path: &MovingCapsule, limit: f64) -> Option<ShapeTouch> {
    let mut ends = path.start.into_iter().chain(path.end);
    let usable = ends.all(DVec3::is_finite) && (0.0..f64::INFINITY).contains(&path.radius);
    if !usable {
        return None;
    }
    let mut first = None;
    sweep_parts(shape, path, limit, &mut first);
    first
}

fn sweep_parts(
    shape: &dyn Shape,
    path: &MovingCapsule,
    limit: f64,
    first: &mut Option<ShapeTouch>,
) {
    let reach = Reach::new(path, path.radius + 2.0 * TOLERANCE);
    let until = std::cell::Cell::new(first.map_or(limit, |first| first.time.min(limit)));
    visit_parts(
        shape,
        &reach.bounds(),
        &|bounds| reach.meets(bounds, until.get()),
        &mut |part| {
            let found = match part {
                Part::Triangle(corners) => sweep_triangle(corners, path, until.get()),
                Part::Convex(convex) => sweep_solid(&convex, path, until.get()),
                Part::HalfSpace(normal) => sweep_half_space(normal, path),
                Part::Posed(pose, part) => {
                    let local = MovingCapsule {
                        start: path.start.map(|end| pose.inverse_transform(end)),
                        end: path.end.map(|end| pose.inverse_transform(end)),
                        ..*path
                    };
                    let mut found = None;
                    sweep_parts(part, &local, until.get(), &mut found);
                    found.map(|touch| placed(&touch, &pose))
                }
            };
            let Some(touch) = found.filter(|touch| touch.time <= until.get()) else {
                return;
            };
            if first.is_none_or(|first| touch.precedes(&first)) {
                until.set(touch.time);
                *first = Some(touch);
            }
        },
    );
}

fn placed(touch: &ShapeTouch, pose: &RigidPose) -> ShapeTouch {
    ShapeTouch {
        contact: ShapeContact {
            point: pose.transform(touch.contact.point),
            normal: pose.rotation * touch.contact.normal,
            ..touch.contact
        },
        away: pose.rotation * touch.away,
        ..*touch
    }
}

fn sweep_triangle(corners: [Vec3; 3], path: &MovingCapsule, limit: f64) -> Option<ShapeTouch> {
    let touch = path.cast_at_triangle(corners, TOLERANCE, limit)?;
    Some(ShapeTouch {
        time: touch.time,
        contact: ShapeContact {
            point: touch.point,
            normal: outward(corners).unwrap_or(touch.away),
            distance: touch.distance,
        },
        away: touch.away,
        on_axis: touch.on_axis,
        started_inside: touch.started_inside,
        undecided: touch.undecided,
    })
}

fn sweep_solid(convex: &Convex<'_>, path: &MovingCapsule, limit: f64) -> Option<ShapeTouch> {
    let touch = convex.advance(path, TOLERANCE, limit)?;
    let ends = path.at(touch.time);
    let contact = match touch.nearest {
        Some(nearest) => ShapeContact {
            point: nearest.on_core + nearest.normal * convex.round,
            normal: nearest.normal,
            distance: nearest.distance - convex.round,
        },
        None => solid(convex, ends),
    };
    let on_axis = contact.point + contact.normal * contact.distance;
    Some(ShapeTouch {
        time: touch.time,
        contact,
        away: contact.normal,
        on_axis: share(ends, on_axis),
        started_inside: touch.time == 0.0 && contact.distance <= path.radius,
        undecided: touch.undecided,
    })
}

fn sweep_half_space(normal: DVec3, path: &MovingCapsule) -> Option<ShapeTouch> {
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
    Some(ShapeTouch {
        time,
        contact,
        away: normal,
        on_axis: share(at, contact.point),
        started_inside: time == 0.0 && contact.distance <= path.radius,
        undecided: false,
    })
}

/// Where on a segment its point nearest to `point` lies, 0..=1.
fn share([a, b]: [DVec3; 2], point: DVec3) -> f64 {
    let axis = b - a;
    let share = (point - a).dot(axis) / axis.length_squared();
    if share > 0.0 { share.min(1.0) } else { 0.0 }
}
