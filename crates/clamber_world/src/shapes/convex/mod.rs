//! Solid convex shapes in f64: a core that is known only by its support points, and a radius by which it is rounded.

mod first_contact;
mod moving_convex;
mod nearest;
mod simplex;
mod way_out;

pub(super) use moving_convex::MovingConvex;
pub(super) use nearest::ClosestPoints;

use glam::{DVec3, Vec3};
use parry3d::shape::{ConvexPolyhedron, Shape, SupportMap, TypedShape};

/// All points within the distance `round` of a convex core.
pub(super) struct Convex<'a> {
    core: Core<'a>,
    /// Metres, not negative.
    pub(super) round: f64,
}

enum Core<'a> {
    Few([DVec3; 3], usize),
    Cuboid {
        center: DVec3,
        half: DVec3,
    },
    /// Along Y.
    Cylinder {
        half_height: f64,
        radius: f64,
    },
    /// Along Y, the tip at the top.
    Cone {
        half_height: f64,
        radius: f64,
    },
    Polyhedron(&'a ConvexPolyhedron),
    /// A shape defined outside parry.
    Custom(&'a dyn SupportMap),
}

impl<'a> Convex<'a> {
    /// `None` for a shape that is not convex.
    pub(super) fn new(shape: &'a dyn Shape) -> Option<Self> {
        let (core, round) = match shape.as_typed_shape() {
            TypedShape::Ball(ball) => (Core::Few([DVec3::ZERO; 3], 1), ball.radius),
            TypedShape::Capsule(capsule) => {
                let segment = capsule.segment;
                let round = f64::from(capsule.radius);
                return Some(Self::segment(segment.a, segment.b, round));
            }
            TypedShape::Segment(segment) => return Some(Self::segment(segment.a, segment.b, 0.0)),
            TypedShape::Cuboid(cuboid) => (centred(cuboid.half_extents), 0.0),
            TypedShape::RoundCuboid(cuboid) => {
                let half = cuboid.inner_shape.half_extents;
                (centred(half), cuboid.border_radius)
            }
            TypedShape::RoundTriangle(round) => {
                let triangle = round.inner_shape;
                let corners = [triangle.a, triangle.b, triangle.c];
                let corners = corners.map(|corner| corner.as_dvec3());
                (Core::Few(corners, 3), round.border_radius)
            }
            TypedShape::Cylinder(cylinder) => {
                (cylinder_of(cylinder.half_height, cylinder.radius), 0.0)
            }
            TypedShape::RoundCylinder(round) => {
                let cylinder = round.inner_shape;
                let core = cylinder_of(cylinder.half_height, cylinder.radius);
                (core, round.border_radius)
            }
            TypedShape::Cone(cone) => (cone_of(cone.half_height, cone.radius), 0.0),
            TypedShape::RoundCone(round) => {
                let cone = round.inner_shape;
                let core = cone_of(cone.half_height, cone.radius);
                (core, round.border_radius)
            }
            TypedShape::ConvexPolyhedron(polyhedron) => (Core::Polyhedron(polyhedron), 0.0),
            TypedShape::RoundConvexPolyhedron(round) => {
                (Core::Polyhedron(&round.inner_shape), round.border_radius)
            }
            _ => (Core::Custom(shape.as_support_map()?), 0.0),
        };
        Some(Self {
            core,
            round: f64::from(round),
        })
    }

    pub(super) fn segment(a: Vec3, b: Vec3, round: f64) -> Self {
        let (a, b) = (a.as_dvec3(), b.as_dvec3());
        Self {
            core: Core::Few([a, b, b], 2),
            round,
        }
    }

    pub(super) fn cuboid(center: DVec3, half: DVec3, round: f64) -> Self {
        Self {
            core: Core::Cuboid { center, half },
            round,
        }
    }

    /// A point of the core that is farthest along a direction of any length; any point of the core for a zero
    /// direction.
    fn support(&self, direction: DVec3) -> DVec3 {
        match &self.core {
            Core::Few(points, count) => farthest(points[..*count].iter().copied(), direction),
            Core::Cuboid { center, half } => *center + with_signs(*half, direction),
            Core::Cylinder {
                half_height,
                radius,
            } => rim(direction, *radius) + DVec3::Y * half_height.copysign(direction.y),
            Core::Cone {
                half_height,
                radius,
            } => {
                let base = rim(direction, *radius) - DVec3::Y * *half_height;
                let tip = DVec3::Y * *half_height;
                farthest([tip, base].into_iter(), direction)
            }
            Core::Polyhedron(polyhedron) => {
                let points = polyhedron.points().iter();
                farthest(points.map(|point| point.as_dvec3()), direction)
            }
            Core::Custom(map) => {
                let direction = direction.normalize_or(DVec3::Y);
                map.local_support_point(direction.as_vec3()).as_dvec3()
            }
        }
    }

    /// How far the core reaches along a direction.
    fn extent(&self, direction: DVec3) -> f64 {
        self.support(direction).dot(direction)
    }
}

fn centred(half: Vec3) -> Core<'static> {
    Core::Cuboid {
        center: DVec3::ZERO,
        half: half.as_dvec3(),
    }
}

fn cylinder_of(half_height: f32, radius: f32) -> Core<'static> {
    Core::Cylinder {
        half_height: f64::from(half_height),
        radius: f64::from(radius),
    }
}

fn cone_of(half_height: f32, radius: f32) -> Core<'static> {
    Core::Cone {
        half_height: f64::from(half_height),
        radius: f64::from(radius),
    }
}

fn with_signs(half: DVec3, direction: DVec3) -> DVec3 {
    DVec3::new(
        half.x.copysign(direction.x),
        half.y.copysign(direction.y),
        half.z.copysign(direction.z),
    )
}

/// The point of a circle about Y that is farthest along a direction; its centre if all points are equally far.
fn rim(direction: DVec3, radius: f64) -> DVec3 {
    let level = DVec3::new(direction.x, 0.0, direction.z);
    level.normalize_or_zero() * radius
}

/// The first of the points that are farthest along a direction; the origin if there are no points.
fn farthest(points: impl Iterator<Item = DVec3>, direction: DVec3) -> DVec3 {
    let mut best = (f64::NEG_INFINITY, DVec3::ZERO);
    for point in points {
        let along = point.dot(direction);
        if along > best.0 {
            best = (along, point);
        }
    }
    best.1
}

#[cfg(test)]
mod tests;
