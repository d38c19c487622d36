mod distances;
mod times;
mod ways_out;

use clamber_surface::geometry::MovingCapsule;
use glam::{DQuat, DVec3, Vec3};
use parry3d::shape::{ConvexPolyhedron, Cuboid, SharedShape};

use super::{Convex, MovingConvex};
use crate::testing::point;

/// A shape, and a second way to compute how far a point is from its core; 0 inside.
struct Case {
    name: &'static str,
    shape: SharedShape,
    distance: Box<dyn Fn(DVec3) -> f64>,
}

impl Case {
    fn convex(&self) -> Convex<'_> {
        Convex::new(&*self.shape).unwrap()
    }

    /// Distance from a segment to the core. Along the segment, the distance of a point is convex.
    fn distance(&self, [a, b]: [DVec3; 2]) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..120 {
            let third = (high - low) / 3.0;
            let at = |s: f64| (self.distance)(a + (b - a) * s);
            if at(low + third) <= at(high - third) {
                high -= third;
            } else {
                low += third;
            }
        }
        (self.distance)(a + (b - a) * ((low + high) * 0.5))
    }
}

fn to_segment([a, b]: [DVec3; 2], p: DVec3) -> f64 {
    let along = b - a;
    let share = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    (p - a - along * share).length()
}

/// Distance to a solid of revolution about Y, given its outline as (radius, height).
fn to_lathe(outline: &[DVec3], p: DVec3) -> f64 {
    let p = DVec3::new(DVec3::new(p.x, 0.0, p.z).length(), p.y, 0.0);
    let sides = outline.windows(2);
    let inside = sides.clone().all(|side| {
        let along = side[1] - side[0];
        along.cross(p - side[0]).z <= 0.0
    });
    if inside {
        return 0.0;
    }
    let distances = sides.map(|side| to_segment([side[0], side[1]], p));
    distances.fold(f64::INFINITY, f64::min)
}

/// All triangles with every point behind them. Parry's own faces are up to a degree off.
fn faces(points: &[Vec3]) -> Vec<[Vec3; 3]> {
    let mut faces = Vec::new();
    for &a in points {
        for &b in points {
            for &c in points {
                let [p, q, r] = [a, b, c].map(|corner| corner.as_dvec3());
                let normal = (q - p).cross(r - p);
                let is_behind =
                    |x: &Vec3| [a, b, c].contains(x) || normal.dot(x.as_dvec3() - p) < 0.0;
                // Each triangle once, not in all three rotations of its corners.
                let first = a.to_array() < b.to_array() && a.to_array() < c.to_array();
                if first && b != c && points.iter().all(is_behind) {
                    faces.push([a, b, c]);
                }
            }
        }
    }
    faces
}

fn to_triangle(corners: [Vec3; 3], p: DVec3) -> f64 {
    let still = MovingCapsule::ball(p, DVec3::ZERO, 0.0);
    let found = still.nearest_of_triangle(corners.map(|corner| corner.as_dvec3()));
    found.unwrap().distance
}

fn to_hull(faces: &[[Vec3; 3]], p: DVec3) -> f64 {
    let mut nearest = f64::INFINITY;
    let mut inside = true;
    for &corners in faces {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        inside &= (b - a).cross(c - a).dot(p - a) <= 0.0;
        nearest = nearest.min(to_triangle(corners, p));
    }
    if inside { 0.0 } else { nearest }
}

fn hull(rng: &mut fastrand::Rng) -> ConvexPolyhedron {
    let points: Vec<Vec3> = (0..24).map(|_| point(rng, 1.0).as_vec3()).collect();
    ConvexPolyhedron::from_convex_hull(&points).unwrap()
}

fn cases(rng: &mut fastrand::Rng) -> Vec<Case> {
    let half = DVec3::new(0.7, 0.2, 1.1);
    let level = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let cylinder = [
        level(0.0, 0.6),
        level(0.8, 0.6),
        level(0.8, -0.6),
        level(0.0, -0.6),
    ];
    let cone = [level(0.0, 0.9), level(0.5, -0.9), level(0.0, -0.9)];
    let ends = [Vec3::new(-0.4, 0.3, 0.0), Vec3::new(0.5, 0.1, 0.6)];
    let corners = [
        Vec3::X,
        Vec3::new(-0.5, 0.0, 0.7),
        Vec3::new(-0.3, 0.4, -0.8),
    ];
    let [a, b, c] = corners;
    let hull = hull(rng);
    let faces = faces(hull.points());
    let Vec3 { x, y, z } = half.as_vec3();
    // The values that the shape stores, rounded to f32.
    let exact = |p: DVec3| p.as_vec3().as_dvec3();
    let (cylinder, cone) = (cylinder.map(exact), cone.map(exact));
    let half = exact(half);
    let to_box = move |p: DVec3| (p.abs() - half).max(DVec3::ZERO).length();
    let case = |name, shape, distance| Case {
        name,
        shape,
        distance,
    };
    vec![
        case("ball", SharedShape::ball(0.7), Box::new(|p| p.length())),
        case(
            "capsule",
            SharedShape::capsule(ends[0], ends[1], 0.3),
            Box::new(move |p| to_segment(ends.map(|end| end.as_dvec3()), p)),
        ),
        case("cuboid", SharedShape::cuboid(x, y, z), Box::new(to_box)),
        case(
            "round cuboid",
            SharedShape::round_cuboid(x, y, z, 0.1),
            Box::new(to_box),
        ),
        case(
            "cylinder",
            SharedShape::cylinder(0.6, 0.8),
            Box::new(move |p| to_lathe(&cylinder, p)),
        ),
        case(
            "cone",
            SharedShape::cone(0.9, 0.5),
            Box::new(move |p| to_lathe(&cone, p)),
        ),
        case(
            "round triangle",
            SharedShape::round_triangle(a, b, c, 0.05),
            Box::new(move |p| to_triangle(corners, p)),
        ),
        case(
            "hull",
            SharedShape::new(hull),
            Box::new(move |p| to_hull(&faces, p)),
        ),
    ]
}

fn direction(rng: &mut fastrand::Rng) -> DVec3 {
    loop {
        let p = point(rng, 1.0);
        if (0.01..=1.0).contains(&p.length_squared()) {
            return p.normalize();
        }
    }
}

/// A segment of up to two metres; sometimes a single point, vertical or level.
fn segment(rng: &mut fastrand::Rng, size: f64) -> [DVec3; 2] {
    let a = point(rng, size);
    let along = match rng.u32(0..6) {
        0 => DVec3::ZERO,
        1 => DVec3::Y,
        2 => DVec3::X * 0.5,
        _ => point(rng, 1.0),
    };
    [a, a + along]
}
