use std::collections::BTreeMap;

use clamber_surface::geometry::Sphere;
use clamber_surface::mesh::{ColliderMesh, Influence, VertexId, normalize_influences};
use clamber_surface::rig::JointId;
use glam::{DVec3, Vec3};

use super::joint_maps::JointMaps;
use super::{BoundingCapsule, round_up_to_f32};

/// The interval of one joint's weights over the vertices of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
struct WeightInterval {
    joint: JointId,
    /// Near the middle of the joint's weights. The middles of a node add up to exactly 1.
    middle: f32,
    /// The largest difference between a weight and `middle`.
    deviation: f32,
}

/// Bounds of a set of vertices under any palette, computed from its rest data. The module's documentation
/// derives them.
///
/// This is the scalar reference of faster forms. A node has at least one vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeBounds {
    intervals: Vec<WeightInterval>,
    sphere: Sphere,
    capsule: BoundingCapsule,
    /// The largest distance of a rest position from the mesh's origin, rounded up.
    reach: f64,
    /// The largest number of influences of a vertex.
    influences: usize,
}

/// A ball in f64, before it is inflated and rounded.
struct Ball {
    center: DVec3,
    radius: f64,
}

impl NodeBounds {
    /// Reads the rest data of `vertices`, in any order. `None` without vertices, or if one is out
    /// of range. Takes about 80 passes over them.
    pub fn new(mesh: &ColliderMesh, vertices: &[VertexId]) -> Option<Self> {
        let all = mesh.positions();
        if vertices.iter().any(|v| v.index() >= all.len()) {
            return None;
        }
        let positions = vertices.iter().map(|v| all[v.index()]);
        let farthest_sq = positions.clone().map(|p| p.as_dvec3().length_squared());
        let influences = vertices.iter().map(|v| mesh.influences(*v).len());
        Some(Self {
            intervals: weight_intervals(mesh, vertices)?,
            sphere: Sphere::nearly_smallest(positions.clone())?,
            capsule: BoundingCapsule::around_principal_axis(positions)?,
            reach: farthest_sq.fold(0.0, f64::max).sqrt() * (1.0 + 1e-15),
            influences: influences.max()?,
        })
    }

    /// A ball around the rest ball's images under every joint, in model space. It is the smallest such
    /// ball for two joints, not always for more.
    ///
    /// # Panics
    /// If `maps` lacks a joint that moves one of the vertices.
    pub fn hull(&self, maps: &JointMaps) -> Sphere {
        self.inflated(maps, self.hull_ball(maps))
    }

    /// The ball by weight intervals, in model space. If all vertices have equal weights, its radius is the
    /// rest radius times the largest stretch of a joint.
    ///
    /// # Panics
    /// As [`NodeBounds::hull`].
    pub fn weight_interval(&self, maps: &JointMaps) -> Sphere {
        self.inflated(maps, self.weight_interval_ball(maps))
    }

    /// A capsule that holds the skinned vertices, in model space: the rest capsule's axis, blended, with the
    /// smaller of the radii by weight intervals and by hull.
    ///
    /// # Panics
    /// As [`NodeBounds::hull`].
    pub fn capsule(&self, maps: &JointMaps) -> BoundingCapsule {
        let ends = [self.capsule.a.as_dvec3(), self.capsule.b.as_dvec3()];
        let blended = ends.map(|end| self.blend(maps, end));
        let rest_radius = f64::from(self.capsule.radius);
        let (mut deviation, mut hull) = ([0.0, 0.0], 0.0f64);
        for interval in &self.intervals {
            let map = maps.of(interval.joint);
            let mut farthest = 0.0f64;
            for k in 0..2 {
                let image = map.model_from_mesh.transform_point3(ends[k]);
                let distance = (image - blended[k]).length();
                deviation[k] += f64::from(interval.deviation) * distance;
                farthest = farthest.max(distance);
            }
            hull = hull.max(map.stretch * rest_radius + farthest);
        }
        let interval = rest_radius * self.stretch(maps) + deviation[0].max(deviation[1]);
        let radius = interval.min(hull) + self.inflation(maps);
        // Rounding the ends moves no point of the segment farther than an end.
        let [a, b] = blended.map(|end| end.as_vec3());
        let moved = |end: DVec3, rounded: Vec3| (end - rounded.as_dvec3()).length();
        let rounding = moved(blended[0], a).max(moved(blended[1], b));
        BoundingCapsule {
            a,
            b,
            radius: round_up_to_f32(radius + rounding),
        }
    }

    fn hull_ball(&self, maps: &JointMaps) -> Ball {
        let rest_center = self.sphere.center.as_dvec3();
        let rest_radius = f64::from(self.sphere.radius);
        let image = |interval: &WeightInterval| {
            let map = maps.of(interval.joint);
            let center = map.model_from_mesh.transform_point3(rest_center);
            (center, map.stretch * rest_radius)
        };
        // Grow the first ball over each next one in turn, as little as possible.
        let (mut center, mut radius) = (DVec3::ZERO, f64::NEG_INFINITY);
        for (next, next_radius) in self.intervals.iter().map(image) {
            let distance = (next - center).length();
            if radius == f64::NEG_INFINITY || distance + radius <= next_radius {
                (center, radius) = (next, next_radius);
            } else if distance + next_radius > radius {
                let grown = (distance + radius + next_radius) * 0.5;
                center += (next - center) * ((grown - radius) / distance);
                radius = grown;
            }
        }
        // The radius is measured again, so that rounding in the growth does not matter.
        let farthest = self
            .intervals
            .iter()
            .map(image)
            .map(|(next, next_radius)| (next - center).length() + next_radius);
        Ball {
            center,
            radius: farthest.fold(0.0, f64::max),
        }
    }

    fn weight_interval_ball(&self, maps: &JointMaps) -> Ball {
        let rest_center = self.sphere.center.as_dvec3();
        let center = self.blend(maps, rest_center);
        let deviation: f64 = self
            .intervals
            .iter()
            .map(|interval| {
                let map = maps.of(interval.joint);
                let image = map.model_from_mesh.transform_point3(rest_center);
                f64::from(interval.deviation) * (image - center).length()
            })
            .sum();
        Ball {
            center,
            radius: f64::from(self.sphere.radius) * self.stretch(maps) + deviation,
        }
    }

    /// Skins a rest point with the middles as weights.
    fn blend(&self, maps: &JointMaps, rest: DVec3) -> DVec3 {
        self.intervals.iter().fold(DVec3::ZERO, |sum, interval| {
            let map = maps.of(interval.joint);
            sum + map.model_from_mesh.transform_point3(rest) * f64::from(interval.middle)
        })
    }

    /// The largest stretch of any joint of the node.
    fn stretch(&self, maps: &JointMaps) -> f64 {
        let stretches = self.intervals.iter().map(|i| maps.of(i.joint).stretch);
        stretches.fold(0.0, f64::max)
    }

    /// How far f32 skinning may move a vertex out of an exact bound, with slack. `clamber_surface`'s
    /// `bounds/spheres.rs` derives it.
    fn inflation(&self, maps: &JointMaps) -> f64 {
        let size = self
            .intervals
            .iter()
            .map(|interval| maps.of(interval.joint))
            .map(|map| map.stretch * self.reach + map.shift)
            .fold(0.0, f64::max);
        let (influences, joints) = (self.influences as f64, self.intervals.len() as f64);
        let relative = (influences + joints + 12.0) * f64::from(f32::EPSILON) * 0.5;
        let underflow = (4.0 * influences + 4.0) * f64::from(f32::from_bits(1));
        SQRT_3 * (relative * size + underflow)
    }

    fn inflated(&self, maps: &JointMaps, ball: Ball) -> Sphere {
        let center = ball.center.as_vec3();
        let rounding = (ball.center - center.as_dvec3()).length();
        Sphere {
            center,
            radius: round_up_to_f32(ball.radius + self.inflation(maps) + rounding),
        }
    }
}

/// The square root of 3, rounded up.
const SQRT_3: f64 = 1.732_050_807_568_878;

/// The weight interval of every joint that moves one of the vertices, by ascending joint; `None` without
/// vertices.
fn weight_intervals(mesh: &ColliderMesh, vertices: &[VertexId]) -> Option<Vec<WeightInterval>> {
    // Smallest and largest weight of each joint, and the number of vertices that it moves.
    let mut seen: BTreeMap<JointId, (f32, f32, usize)> = BTreeMap::new();
    for vertex in vertices {
        for (joint, weight) in mesh.influences(*vertex) {
            let (low, high, count) = seen.entry(joint).or_insert((1.0, 0.0, 0));
            *low = low.min(weight);
            *high = high.max(weight);
            *count += 1;
        }
    }
    for (low, _, count) in seen.values_mut() {
        if *count < vertices.len() {
            *low = 0.0;
        }
    }
    // Twice the middles. Their rounding does not matter; their sum of 1 does.
    let doubled = |(joint, (low, high, _)): (&JointId, &(f32, f32, usize))| Influence {
        joint: *joint,
        weight: low + high,
    };
    let middles = normalize_influences(&seen.iter().map(doubled).collect::<Vec<_>>())?;
    let interval = |(joint, (low, high, _)): (JointId, (f32, f32, usize))| {
        // A joint whose middle rounds to 0 is missing from the middles.
        let middle = middles.iter().find(|influence| influence.joint == joint);
        let middle = middle.map_or(0.0, |influence| influence.weight);
        WeightInterval {
            joint,
            middle,
            deviation: (high - middle).max(middle - low),
        }
    };
    Some(seen.into_iter().map(interval).collect())
}
