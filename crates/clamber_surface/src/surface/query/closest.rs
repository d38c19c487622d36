use glam::Vec3;

use super::hit::{Best, Nearest};
use super::posed_cluster::PosedCluster;
use super::region::{BLUR, box_around, check_point};
use super::stack::Stack;
use super::{broad, check_length, root};
use crate::geometry::triangle::{EIGHT, closest_points};
use crate::mesh::hierarchy::{Child, LANES};
use crate::surface::{SkinnedSurface, SurfaceError, SurfaceHit};

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
        check_point(point)?;
        let max_distance = check_length("the distance of a query", max_distance)?;
        let mut best = Best::within(max_distance);
        let [low, high] = box_around([point; 2], max_distance);
        if root::overlaps(self.current.root(), low, high) {
            self.search_closest(point, &mut best);
        }
        Ok(best.hit(self, point))
    }

    /// Nearest bounds first.
    fn search_closest(&self, point: Vec3, best: &mut Best) {
        let hierarchy = self.mesh.hierarchy();
        let mut posed = PosedCluster::new(self);
        let mut stack = Stack::new((0.0f32, Child::Node(0)));
        // A triangle may measure so much farther than its nearest vertex.
        let blur = BLUR * root::size(self.current.root());
        let mut tested = 0;
        while let Some((distance, child)) = stack.pop() {
            // What is as far as the best one stays: it may have a smaller id.
            if f64::from(distance) > best.limit() {
                continue;
            }
            match child {
                Child::Cluster(cluster) => {
                    if posed.visit(cluster) {
                        tested += test(&posed, point, blur, best);
                    }
                }
                Child::Node(index) => {
                    let node = &hierarchy.nodes[index as usize];
                    let spheres = self.current.spheres(&self.mesh, index);
                    let distances = broad::distances(&spheres, point);
                    for lane in farthest_first(&distances, usize::from(node.lanes)) {
                        if f64::from(distances[lane]) <= best.limit() {
                            stack.push((distances[lane], node.child(lane)));
                        }
                    }
                }
            }
        }
        self.count_tested(tested);
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
fn test(posed: &PosedCluster<'_>, point: Vec3, blur: f64, best: &mut Best) -> usize {
    // No triangle farther than the nearest vertex matters.
    let limit = best
        .limit()
        .min(f64::from(posed.nearest_vertex(point)) + blur);
    let mut survivors = posed.enabled(posed.near(point, point, limit));
    let mut tested = 0;
    let mut batch = [0; EIGHT];
    loop {
        let mut count = 0;
        for (place, triangle) in batch.iter_mut().zip(&mut survivors) {
            *place = triangle;
            count += 1;
        }
        if count == 0 {
            return tested;
        }
        tested += count;
        let corners = posed.batch(&batch[..count]);
        let points = closest_points(posed.surface.simd_level, &corners, point);
        for (lane, triangle) in batch[..count].iter().enumerate() {
            best.offer(Nearest {
                triangle: posed.id(*triangle),
                found: points.get(lane),
            });
        }
    }
}
