//! What a set of vertices costs: how large its bound is when posed.

use glam::Vec3;

use super::super::ColliderMesh;
use crate::geometry::Affine;

/// Rest data of a set of vertices as far as its bound needs them, in f32: it guides choices, and
/// bounds nothing.
#[derive(Clone, Debug, Default)]
pub(super) struct Extent {
    pub(super) low: Vec3,
    pub(super) high: Vec3,
    /// About the middle of the box.
    pub(super) radius: f32,
    pub(super) vertices: usize,
    /// Joint, smallest and largest weight, and how many of the vertices the joint moves.
    pub(super) weights: Vec<Span>,
}

/// The weights of one joint over a set of vertices.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Span {
    pub(super) joint: u32,
    pub(super) low: f32,
    pub(super) high: f32,
    pub(super) vertices: usize,
}

impl Span {
    /// 0 as soon as there is a vertex that the joint does not move.
    fn low(&self, vertices: usize) -> f32 {
        if self.vertices < vertices {
            0.0
        } else {
            self.low
        }
    }

    /// Half of how far its weights lie apart.
    pub(super) fn spread(&self, vertices: usize) -> f32 {
        0.5 * (self.high - self.low(vertices))
    }
}

/// Reads extents and says what they cost. Keeps its memory from one set to the next.
pub(super) struct Meter<'a> {
    pub(super) mesh: &'a ColliderMesh,
    poses: &'a [Vec<Affine>],
    /// The last set that a vertex, or a joint, was seen in; sets are numbered from 1.
    vertex_seen: Vec<u32>,
    joint_seen: Vec<u32>,
    set: u32,
    /// Where a joint of the current set stands in its weights.
    place: Vec<u32>,
    vertices: Vec<u32>,
    images: Vec<Vec3>,
}

impl<'a> Meter<'a> {
    /// `poses` are palettes; one that does not fit the mesh is left out.
    pub(super) fn new(mesh: &'a ColliderMesh, poses: &'a [Vec<Affine>]) -> Self {
        Self {
            mesh,
            poses,
            vertex_seen: vec![0; mesh.positions().len()],
            joint_seen: vec![0; mesh.joint_count()],
            set: 0,
            place: vec![0; mesh.joint_count()],
            vertices: Vec::new(),
            images: Vec::new(),
        }
    }

    /// The distinct corners of `triangles`, by first appearance.
    fn collect(&mut self, triangles: impl Iterator<Item = u32>) {
        self.set += 1;
        self.vertices.clear();
        for triangle in triangles {
            for corner in self.mesh.triangles()[triangle as usize] {
                if self.vertex_seen[corner.index()] != self.set {
                    self.vertex_seen[corner.index()] = self.set;
                    self.vertices.push(corner.0);
                }
            }
        }
    }

    /// How many vertices the triangles have.
    pub(super) fn slots(&mut self, triangles: impl Iterator<Item = u32>) -> usize {
        self.collect(triangles);
        self.vertices.len()
    }

    /// Reads the extent of the corners of `triangles`, of which there is at least one.
    pub(super) fn extent(&mut self, triangles: impl Iterator<Item = u32>, extent: &mut Extent) {
        self.collect(triangles);
        let positions = self.mesh.positions();
        let points = self.vertices.iter().map(|v| positions[*v as usize]);
        extent.low = points.clone().fold(Vec3::INFINITY, Vec3::min);
        extent.high = points.clone().fold(Vec3::NEG_INFINITY, Vec3::max);
        let middle = (extent.low + extent.high) * 0.5;
        let farthest = points.map(|p| (p - middle).length_squared());
        extent.radius = farthest.fold(0.0, f32::max).sqrt();
        extent.vertices = self.vertices.len();
        extent.weights.clear();
        for vertex in &self.vertices {
            let (joints, weights) = self.mesh.influence_slices(*vertex as usize);
            for (joint, weight) in joints.iter().zip(weights) {
                let span = Span {
                    joint: *joint,
                    low: *weight,
                    high: *weight,
                    vertices: 1,
                };
                merge(
                    &mut self.joint_seen,
                    &mut self.place,
                    self.set,
                    span,
                    extent,
                );
            }
        }
    }

    /// The extent of several sets together.
    pub(super) fn union<'e>(&mut self, sets: impl Iterator<Item = &'e Extent> + Clone) -> Extent {
        self.set += 1;
        let mut union = Extent {
            low: sets.clone().map(|e| e.low).fold(Vec3::INFINITY, Vec3::min),
            high: sets
                .clone()
                .map(|e| e.high)
                .fold(Vec3::NEG_INFINITY, Vec3::max),
            ..Extent::default()
        };
        let middle = (union.low + union.high) * 0.5;
        for set in sets {
            let center = (set.low + set.high) * 0.5;
            union.radius = union.radius.max((center - middle).length() + set.radius);
            union.vertices += set.vertices;
            for span in &set.weights {
                // A joint that does not move all of the set's vertices has fewer in the union too.
                merge(
                    &mut self.joint_seen,
                    &mut self.place,
                    self.set,
                    *span,
                    &mut union,
                );
            }
        }
        union
    }

    /// The radius of the set's bound by weight intervals, see `surface::bounds`, as the square mean
    /// over the poses. Without poses, as if every joint took the set's centre one radius away.
    pub(super) fn radius(&mut self, extent: &Extent) -> f32 {
        let vertices = extent.vertices;
        let doubled_middle = |span: &Span| span.high + span.low(vertices);
        let sum: f32 = extent.weights.iter().map(doubled_middle).sum();
        let center = (extent.low + extent.high) * 0.5;
        let (mut total, mut count) = (0.0, 0.0f32);
        for pose in self.poses {
            if pose.len() != self.mesh.joint_count() {
                continue;
            }
            let (mut blend, mut stretch_sq) = (Vec3::ZERO, 0.0f32);
            self.images.clear();
            for span in &extent.weights {
                let matrix = &pose[span.joint as usize];
                let image = matrix.transform_point(center);
                blend += image * (doubled_middle(span) / sum);
                let linear = matrix.rows.iter().flat_map(|row| &row[..3]);
                stretch_sq = stretch_sq.max(linear.map(|x| x * x).sum::<f32>() / 3.0);
                self.images.push(image);
            }
            let apart: f32 = core::iter::zip(&extent.weights, &self.images)
                .map(|(span, image)| span.spread(vertices) * (*image - blend).length())
                .sum();
            let radius = extent.radius * stretch_sq.sqrt() + apart;
            total += radius * radius;
            count += 1.0;
        }
        if count > 0.0 {
            return (total / count).sqrt();
        }
        let spread: f32 = extent.weights.iter().map(|s| s.spread(vertices)).sum();
        extent.radius * (1.0 + spread)
    }
}

fn merge(seen: &mut [u32], place: &mut [u32], set: u32, span: Span, extent: &mut Extent) {
    let joint = span.joint as usize;
    if seen[joint] == set {
        let known = &mut extent.weights[place[joint] as usize];
        known.low = known.low.min(span.low);
        known.high = known.high.max(span.high);
        known.vertices += span.vertices;
    } else {
        seen[joint] = set;
        place[joint] = extent.weights.len() as u32;
        extent.weights.push(span);
    }
}
