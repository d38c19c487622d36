use std::collections::BTreeMap;

use clamber_surface::geometry::Sphere;
use clamber_surface::mesh::{ColliderMesh, Influence, VertexId, normalize_influences};
use clamber_surface::rig::JointId;
use glam::{DVec3, Vec3};

use super::joint_maps::JointMaps;
use super::{BoundingCapsule, round_up_to_f32};

/// How much one joint moves the vertices of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
struct WeightInterval {
    joint: JointId,
    /// Near the middle of its weights; those of a node add up to exactly 1.
    middle: f32,
    /// The most by which a weight differs from `middle`.
    deviation: f32,
}

/// The rest data of a set of vertices, and from them bounds of the skinned vertices under any
/// palette, whatever way the joints go. The module's documentation derives them.
///
/// The scalar reference of faster forms. A node that holds no vertex does not exist.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeBounds {
    intervals: Vec<WeightInterval>,
    sphere: Sphere,
    capsule: BoundingCapsule,
    /// The largest distance of a rest position from the mesh's origin, rounded up.
    reach: f64,
    /// The most influences of one vertex.
    influences: usize,
}

/// A centre with a radius, not yet inflated and rounded.
struct Ball {
    center: DVec3,
    radius: f64,
}

impl NodeBounds {
    /// Reads the rest data of `vertices`, in any order. `None` without vertices, or if one is out
    /// of range. Costs some 80 passes over them.
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

    /// A ball about the hull of the rest ball's images under each joint, in model space. The
    /// smallest such ball for two joints, not always for more.
    ///
    /// # Panics
    /// If `maps` belong to a mesh with fewer joints; so do all bounds below.
    pub fn hull(&self, maps: &JointMaps) -> Sphere {
        self.inflated(maps, self.hull_ball(maps))
    }

    /// The ball that the weight intervals leave, in model space: that of a rigid body where all
    /// vertices have equal weights.
    pub fn weight_interval(&self, maps: &JointMaps) -> Sphere {
        self.inflated(maps, self.weight_interval_ball(maps))
    }

    /// A capsule that holds the skinned vertices, in model space, from the rest capsule by weight
    /// intervals or hull, whichever gives the smaller radius.
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
        // A point of the segment moves no farther than its ends when these are rounded.
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
        // Measured once more: rounding of the growth does not matter then.
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

    /// Where the joints take a rest point, each with the middle of its weights.
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

    /// What f32 skinning may add to a radius; see the module's documentation.
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

/// Rounded up.
const SQRT_3: f64 = 1.732_050_807_568_878;

/// The interval of every joint that moves one of the vertices, ascending; `None` without vertices.
fn weight_intervals(mesh: &ColliderMesh, vertices: &[VertexId]) -> Option<Vec<WeightInterval>> {
    // Smallest and largest weight, and how many vertices the joint moves.
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
    // Twice the middles. Their rounding does not matter, that they add up to 1 does.
    let doubled = |(joint, (low, high, _)): (&JointId, &(f32, f32, usize))| Influence {
        joint: *joint,
        weight: low + high,
    };
    let middles = normalize_influences(&seen.iter().map(doubled).collect::<Vec<_>>())?;
    let interval = |(joint, (low, high, _)): (JointId, (f32, f32, usize))| {
        // Without those of the joints whose middle rounds to 0.
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
