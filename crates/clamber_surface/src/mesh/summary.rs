//! Rest data of sets of vertices, from which bounds are computed.

use glam::Vec3;

use super::weights::{Influence, WEIGHT_ONE, normalize};
use super::{ColliderMesh, VertexId};
use crate::geometry::{Sphere, round_up_to_f32, widen};
use crate::rig::JointId;

/// Rest data of a set of at least one vertex. Together with a palette, they give bounds of the posed vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Summary {
    /// Lower corner of the box around the rest positions.
    pub(crate) low: Vec3,
    /// Upper corner of that box.
    pub(crate) high: Vec3,
    /// A ball about the middle of the box, computed in f32. Rounding may leave a vertex outside, which is good
    /// enough to compare cuts. [`Summary::bound`] replaces it with a ball that holds all vertices.
    pub(crate) ball: Sphere,
    /// The largest distance from the mesh's origin to a vertex or to the ball's centre, rounded up; 0 before
    /// [`Summary::bound`].
    pub(crate) reach: f32,
    /// Number of vertices. In a union, a vertex counts once for each set that holds it.
    pub(crate) vertices: usize,
    /// The most influences of one vertex.
    pub(crate) influences: usize,
    /// The weights of every joint that moves at least one of the vertices, in no particular order.
    pub(crate) spans: Vec<Span>,
}

/// The weights of one joint over a set of vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Span {
    pub(crate) joint: u32,
    /// The smallest weight over the vertices that the joint moves.
    low: f32,
    /// The largest weight over these vertices.
    high: f32,
    /// Number of vertices that the joint moves.
    vertices: usize,
}

impl Span {
    /// The smallest weight over a set of `vertices` vertices: 0 if there is one that the joint does not move.
    fn low(&self, vertices: usize) -> f32 {
        if self.vertices < vertices {
            0.0
        } else {
            self.low
        }
    }

    /// Half of the difference between the largest and the smallest weight over the set.
    pub(crate) fn spread(&self, vertices: usize) -> f32 {
        0.5 * (self.high - self.low(vertices))
    }
}

/// The interval of one joint's weights over a set of vertices. All weights are multiples of 2^-24, so the
/// differences below are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WeightInterval {
    /// The joint; it moves at least one of the vertices.
    pub(crate) joint: u32,
    /// Near the middle of the interval. The middles of all joints of a set add up to exactly 1.
    pub(crate) middle: f32,
    /// The largest difference of a weight from `middle`.
    pub(crate) deviation: f32,
}

/// The most points from which the centre of a ball is computed. Its radius is always computed from all points.
const CENTER_SAMPLE: usize = 1024;

impl Summary {
    /// The middle of the box.
    pub(crate) fn middle(&self) -> Vec3 {
        (self.low + self.high) * 0.5
    }

    /// Replaces the ball by nearly the smallest that holds all vertices, and computes the reach. `points` are the
    /// rest positions of the vertices.
    #[must_use]
    pub(crate) fn bound(mut self, points: &[Vec3]) -> Self {
        let stride = points.len().div_ceil(CENTER_SAMPLE).max(1);
        let sample = points.iter().copied().step_by(stride);
        self.ball = match Sphere::nearly_smallest(sample) {
            Some(ball) if stride == 1 => ball,
            near => {
                let center = near.map_or(Vec3::ZERO, |ball| ball.center);
                Sphere::around(center, points.iter().copied())
            }
        };
        self.reach = points
            .iter()
            .map(|p| reach_of(*p))
            .fold(reach_of(self.ball.center), f32::max);
        self
    }

    /// The weight interval of each joint, in ascending joint order.
    pub(crate) fn intervals(&self) -> Vec<WeightInterval> {
        let mut spans = self.spans.clone();
        spans.sort_unstable_by_key(|span| span.joint);
        // Twice the middles. Their rounding does no harm: `normalize` turns them into integers with an exact sum.
        let doubled = |span: &Span| Influence {
            joint: JointId(span.joint),
            weight: span.low(self.vertices) + span.high,
        };
        let middles: Vec<Influence> = spans.iter().map(doubled).collect();
        // Joints whose middle becomes 0 are missing here.
        let mut middles = normalize(&middles)
            .unwrap_or_default()
            .into_iter()
            .peekable();
        let interval = |span: &Span| {
            let units = middles.next_if(|(joint, _)| joint.0 == span.joint);
            let middle = units.map_or(0, |(_, units)| units) as f32 / WEIGHT_ONE as f32;
            let low = span.low(self.vertices);
            WeightInterval {
                joint: span.joint,
                middle,
                deviation: (span.high - middle).max(middle - low),
            }
        };
        spans.iter().map(interval).collect()
    }
}

/// The distance of a rest position from the mesh's origin, rounded up.
pub(super) fn reach_of(position: Vec3) -> f32 {
    round_up_to_f32(widen(position).length() * (1.0 + 1e-15))
}

/// Computes summaries of sets of vertices of one mesh. Reuses its memory from set to set.
pub(crate) struct Summarizer<'a> {
    pub(crate) mesh: &'a ColliderMesh,
    /// Per vertex, the last set in which it was seen. Sets are numbered from 1.
    vertex_seen: Vec<u32>,
    /// Per joint, the last set in which it was seen.
    joint_seen: Vec<u32>,
    set: u32,
    /// Per joint of the current set, its index in the spans.
    place: Vec<u32>,
    vertices: Vec<u32>,
}

impl<'a> Summarizer<'a> {
    pub(crate) fn new(mesh: &'a ColliderMesh) -> Self {
        Self {
            mesh,
            vertex_seen: vec![0; mesh.positions().len()],
            joint_seen: vec![0; mesh.joint_count()],
            set: 0,
            place: vec![0; mesh.joint_count()],
            vertices: Vec::new(),
        }
    }

    /// The number of distinct corners of some triangles.
    pub(crate) fn count_corners(&mut self, triangles: impl Iterator<Item = u32>) -> usize {
        self.collect_corners(triangles);
        self.vertices.len()
    }

    /// Summarises the corners of at least one triangle into `summary`, which keeps its memory.
    pub(crate) fn of_corners(
        &mut self,
        triangles: impl Iterator<Item = u32>,
        summary: &mut Summary,
    ) {
        self.collect_corners(triangles);
        self.read(summary);
    }

    /// The summary of vertices that are listed once each, after [`Summary::bound`].
    pub(crate) fn of_vertices(&mut self, vertices: &[VertexId]) -> Summary {
        self.set += 1;
        self.vertices.clear();
        self.vertices.extend(vertices.iter().map(|vertex| vertex.0));
        let mut summary = Summary::default();
        self.read(&mut summary);
        let positions = self.mesh.positions();
        let points: Vec<Vec3> = vertices.iter().map(|v| positions[v.index()]).collect();
        summary.bound(&points)
    }

    /// The summary of several sets together, before [`Summary::bound`].
    pub(crate) fn union<'s>(&mut self, sets: impl Iterator<Item = &'s Summary> + Clone) -> Summary {
        self.set += 1;
        let mut union = Summary {
            low: sets.clone().map(|s| s.low).fold(Vec3::INFINITY, Vec3::min),
            high: sets
                .clone()
                .map(|s| s.high)
                .fold(Vec3::NEG_INFINITY, Vec3::max),
            ..Summary::default()
        };
        let middle = union.middle();
        union.ball.center = middle;
        for set in sets {
            let reach = (set.middle() - middle).length() + set.ball.radius;
            union.ball.radius = union.ball.radius.max(reach);
            union.vertices += set.vertices;
            union.influences = union.influences.max(set.influences);
            for span in &set.spans {
                // A joint that does not move all vertices of a set counts fewer than all in the union too.
                self.add(*span, &mut union.spans);
            }
        }
        union
    }

    /// Collects the distinct corners of some triangles, in the order of first appearance.
    fn collect_corners(&mut self, triangles: impl Iterator<Item = u32>) {
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

    /// Summarises the collected vertices.
    fn read(&mut self, summary: &mut Summary) {
        let positions = self.mesh.positions();
        let points = self.vertices.iter().map(|v| positions[*v as usize]);
        summary.low = points.clone().fold(Vec3::INFINITY, Vec3::min);
        summary.high = points.clone().fold(Vec3::NEG_INFINITY, Vec3::max);
        let middle = summary.middle();
        let farthest = points.map(|p| (p - middle).length_squared());
        summary.ball = Sphere {
            center: middle,
            radius: farthest.fold(0.0, f32::max).sqrt(),
        };
        summary.reach = 0.0;
        summary.vertices = self.vertices.len();
        summary.influences = 0;
        summary.spans.clear();
        let vertices = std::mem::take(&mut self.vertices);
        for vertex in &vertices {
            let influences = self.mesh.influences(VertexId(*vertex));
            summary.influences = summary.influences.max(influences.len());
            for (joint, weight) in influences {
                let span = Span {
                    joint: joint.0,
                    low: weight,
                    high: weight,
                    vertices: 1,
                };
                self.add(span, &mut summary.spans);
            }
        }
        self.vertices = vertices;
    }

    fn add(&mut self, span: Span, spans: &mut Vec<Span>) {
        let joint = span.joint as usize;
        if self.joint_seen[joint] == self.set {
            let known = &mut spans[self.place[joint] as usize];
            known.low = known.low.min(span.low);
            known.high = known.high.max(span.high);
            known.vertices += span.vertices;
        } else {
            self.joint_seen[joint] = self.set;
            self.place[joint] = spans.len() as u32;
            spans.push(span);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::tests::random::{Spread, creature};

    #[test]
    fn middles_of_weights_add_up_to_exactly_one() {
        let mut rng = fastrand::Rng::with_seed(54);
        for case in 0..300 {
            let spread = [Spread::Uneven, Spread::Few][case / 16 % 2];
            let (mesh, patch) = creature(&mut rng, 1 + case % 16, spread);
            let vertices = patch[..rng.usize(1..=patch.len())].to_vec();
            let intervals = Summarizer::new(&mesh).of_vertices(&vertices).intervals();
            let sum: f64 = intervals.iter().map(|i| f64::from(i.middle)).sum();
            assert_eq!(sum, 1.0, "case {case}");
            for v in &vertices {
                for interval in &intervals {
                    let weight = mesh.influences(*v).find(|(j, _)| j.0 == interval.joint);
                    let weight = weight.map_or(0.0, |(_, w)| w);
                    let off = (weight - interval.middle).abs();
                    assert!(off <= interval.deviation, "case {case}: {interval:?}");
                }
            }
        }
    }

    #[test]
    fn a_union_has_the_intervals_of_its_sets() {
        let mut rng = fastrand::Rng::with_seed(55);
        for case in 0..300 {
            let (mesh, patch) = creature(&mut rng, 1 + case % 5, Spread::Few);
            if patch.len() < 2 {
                continue;
            }
            let mut summarizer = Summarizer::new(&mesh);
            let (left, right) = patch.split_at(rng.usize(1..patch.len()));
            let sets = [left, right].map(|set| summarizer.of_vertices(set));
            let union = summarizer.union(sets.iter());
            let whole = summarizer.of_vertices(&patch);
            assert_eq!(union.intervals(), whole.intervals(), "case {case}");
            assert_eq!(union.influences, whole.influences, "case {case}");
            assert_eq!(
                (union.low, union.high),
                (whole.low, whole.high),
                "case {case}"
            );
        }
    }
}
