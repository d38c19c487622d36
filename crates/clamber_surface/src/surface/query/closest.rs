use glam::Vec3;

use super::cluster_view::by_eight;
use super::hit::{Best, Nearest};
use super::posed_cluster::PosedCluster;
use super::region::{BLUR, Region, box_around};
use super::stack::Stack;
use super::{check_length, root};
use crate::geometry::{Capsule, Sphere, widen};
use crate::mesh::hierarchy::{Child, LANES};
use crate::surface::{SkinnedSurface, SurfaceError, SurfaceHit};

/// Where a capsule and the surface are nearest to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CapsuleHit {
    /// The surface's point. Its distance is that from the capsule's segment: 0 where they cross.
    pub surface: SurfaceHit,
    /// The segment's point, in model space.
    pub segment: Vec3,
    /// Where that lies on the segment: 0 at the capsule's `a`, 1 at `b`.
    pub along: f32,
}

impl SkinnedSurface {
    /// The material point nearest to `point`, no farther than `max_distance` (may be infinite).
    ///
    /// # Errors
    /// [`SurfaceError::Point`] if `point` is not finite, [`SurfaceError::Query`] if `max_distance`
    /// is negative or NaN.
    pub fn closest_point(
        &self,
        point: Vec3,
        max_distance: f32,
    ) -> Result<Option<SurfaceHit>, SurfaceError> {
        let point = Sphere {
            center: point,
            radius: 0.0,
        };
        self.closest(&point, max_distance)
    }

    /// The material point nearest to a capsule's segment, and the point of the segment nearest to
    /// that: for limbs. No farther than `max_distance` (may be infinite) from the capsule, which may
    /// reach into the skin.
    ///
    /// # Errors
    /// [`SurfaceError::Point`] if an end of the segment is not finite, [`SurfaceError::Query`] if the
    /// radius or `max_distance` is negative or NaN.
    pub fn closest_to_capsule(
        &self,
        capsule: &Capsule,
        max_distance: f32,
    ) -> Result<Option<CapsuleHit>, SurfaceError> {
        let surface = self.closest(capsule, max_distance)?;
        Ok(surface.map(|surface| capsule_hit(capsule, surface)))
    }

    fn closest(
        &self,
        region: &impl Region,
        max_distance: f32,
    ) -> Result<Option<SurfaceHit>, SurfaceError> {
        let mut best = Best::within(reach(region, max_distance)?);
        let blur = region.blur(root::size(self.current.root()));
        let [low, high] = box_around(region.segment(), best.limit() + blur);
        if root::overlaps(self.current.root(), low, high) {
            self.search_closest(region, blur, &mut best);
        }
        Ok(best.hit(self, region.middle()))
    }

    /// Nearest bounds first.
    fn search_closest(&self, region: &impl Region, blur: f64, best: &mut Best) {
        let hierarchy = self.mesh.hierarchy();
        let mut posed = PosedCluster::new(self);
        let root = |node| (0.0f32, Child::Node(node));
        let mut stack = Stack::new(root(0), hierarchy.further_roots().map(root));
        let mut tested = 0;
        while let Some((distance, child)) = stack.pop() {
            // What is as far as the best one stays: it may have a smaller id.
            if f64::from(distance) > best.limit() + blur {
                continue;
            }
            match child {
                Child::Cluster(cluster) => {
                    if posed.visit(cluster) {
                        tested += test(&posed, region, blur, best);
                    }
                }
                Child::Node(index) => {
                    let node = &hierarchy.nodes[index as usize];
                    let spheres = self.current.spheres(&self.mesh, index);
                    let distances = region.distances(&spheres);
                    for lane in farthest_first(&distances, usize::from(node.lanes)) {
                        if f64::from(distances[lane]) <= best.limit() + blur {
                            stack.push((distances[lane], node.child(lane)));
                        }
                    }
                }
            }
        }
        self.count_tested(tested);
    }
}

/// How far from a region's core something may be that is `max_distance` from the region.
pub(in crate::surface) fn reach(
    region: &impl Region,
    max_distance: f32,
) -> Result<f64, SurfaceError> {
    let radius = region.check()?;
    Ok(radius + check_length("the distance of a query", max_distance)?)
}

/// Adds the segment's part to the surface's.
pub(in crate::surface) fn capsule_hit(capsule: &Capsule, surface: SurfaceHit) -> CapsuleHit {
    let a = widen(capsule.a);
    let axis = widen(capsule.b) - a;
    let length_sq = axis.length_squared();
    let along = if length_sq > 0.0 {
        ((widen(surface.point) - a).dot(axis) / length_sq).clamp(0.0, 1.0)
    } else {
        0.0
    };
    CapsuleHit {
        surface,
        segment: (a + axis * along).as_vec3(),
        along: along as f32,
    }
}

/// Lanes below `count`, descending by distance: the last one pushed is the first one visited.
pub(super) fn farthest_first(
    distances: &[f32; LANES],
    count: usize,
) -> impl Iterator<Item = usize> + use<> {
    let mut lanes: [usize; LANES] = std::array::from_fn(|lane| lane);
    lanes[..count].sort_unstable_by(|a, b| distances[*b].total_cmp(&distances[*a]));
    lanes.into_iter().take(count)
}

/// Tests a cluster's triangles; gives how many had to be tested exactly.
fn test(posed: &PosedCluster<'_>, region: &impl Region, blur: f64, best: &mut Best) -> usize {
    let (mut tested, view) = (0, &posed.view);
    let [a, b] = region.segment();
    // No triangle farther than the nearest vertex matters, or so little farther as it may measure.
    let (point, lost) = region.facing(posed.somewhere());
    let vertex = f64::from(posed.nearest_vertex(point)) + lost;
    let size = root::size(view.surface.current.root());
    let limit = best.limit().min(vertex + BLUR * size);
    by_eight(view.enabled(posed.near(a, b, limit + blur)), |batch| {
        tested += batch.len();
        let points = region.closest_of_eight(view.level(), &posed.batch(batch));
        for (lane, triangle) in batch.iter().enumerate() {
            best.offer(Nearest {
                triangle: view.id(*triangle),
                found: points.get(lane),
            });
        }
    });
    tested
}
