use super::closest::farthest_first;
use super::hit::{Best, Nearest, by_length};
use super::posed_cluster::PosedCluster;
use super::stack::Stack;
use super::{broad, check_length, root};
use crate::geometry::triangle::{ShearedRay, TrianglePoint, intersect_sheared};
use crate::geometry::{Ray, round_up_to_f32};
use crate::mesh::hierarchy::Child;
use crate::skin::ClusterPositions;
use crate::surface::{SkinnedSurface, SurfaceError, SurfaceHit};

impl SkinnedSurface {
    /// The first triangle along a ray, from either side, up to `max_distance` (may be infinite).
    ///
    /// Watertight across edges and corners that triangles share by index.
    ///
    /// # Errors
    /// [`SurfaceError::Query`] if `max_distance` is negative or NaN.
    pub fn cast_ray(
        &self,
        ray: &Ray,
        max_distance: f32,
    ) -> Result<Option<SurfaceHit>, SurfaceError> {
        let mut best = Best::within(check(max_distance)?);
        self.visit_ray(ray, best.limit(), |posed, triangle, found| {
            best.offer(Nearest {
                triangle: posed.view.id(triangle),
                found,
            });
            Some(best.limit())
        });
        Ok(best.hit(self, ray.origin()))
    }

    /// True if a ray meets any triangle, from either side, up to `max_distance` (may be infinite).
    /// Stops at the first one that it finds.
    ///
    /// # Errors
    /// As [`SkinnedSurface::cast_ray`].
    pub fn intersects_ray(&self, ray: &Ray, max_distance: f32) -> Result<bool, SurfaceError> {
        let mut met = false;
        self.visit_ray(ray, check(max_distance)?, |_, _, _| {
            met = true;
            None
        });
        Ok(met)
    }

    /// All triangles that a ray meets, from either side, up to `max_distance` (may be infinite), by
    /// their distances before these are rounded to f32, equal ones by triangle id: the first is the hit
    /// of [`SkinnedSurface::cast_ray`]. A ray through an edge or a corner meets all triangles
    /// that share it. `hits` is cleared first and keeps its memory.
    ///
    /// # Errors
    /// As [`SkinnedSurface::cast_ray`]; `hits` is unchanged then.
    pub fn cast_ray_all(
        &self,
        ray: &Ray,
        max_distance: f32,
        hits: &mut Vec<SurfaceHit>,
    ) -> Result<(), SurfaceError> {
        let limit = check(max_distance)?;
        hits.clear();
        self.visit_ray(ray, limit, |posed, triangle, found| {
            let nearest = Nearest {
                triangle: posed.view.id(triangle),
                found,
            };
            let corners = posed.corners(triangle);
            hits.push(self.hit(nearest, posed.view.cluster.part, corners, ray.origin()));
            Some(limit)
        });
        let sheared = ShearedRay::new(ray);
        hits.sort_unstable_by(|a, b| {
            // Most distances differ in f32 as well. Those that do not are computed again, since keeping all
            // of them in f64 would take memory that the caller does not keep.
            let exact = |hit: &SurfaceHit| {
                let found = sheared.intersect(self.corners(hit.triangle), f64::INFINITY);
                found.map_or(f64::from(hit.distance), |found| found.distance)
            };
            by_length(a.distance.into(), b.distance.into())
                .then_with(|| by_length(exact(a), exact(b)))
                .then_with(|| a.triangle.cmp(&b.triangle))
        });
        Ok(())
    }

    /// Calls `visit` with every triangle met, nearest bounds first; it gives the distance that still
    /// matters, or none to stop.
    pub(super) fn visit_ray<'a>(
        &'a self,
        ray: &Ray,
        limit: f64,
        mut visit: impl FnMut(&PosedCluster<'a>, usize, TrianglePoint) -> Option<f64>,
    ) {
        if !root::may_meet(self.current.root(), ray, limit) {
            return;
        }
        let hierarchy = self.mesh.hierarchy();
        let sheared_ray = ShearedRay::new(ray);
        let mut posed = PosedCluster::new(self);
        let mut sheared = ClusterPositions::ZERO;
        let root = |node| (0.0f32, Child::Node(node));
        let mut stack = Stack::new(root(0), hierarchy.further_roots().map(root));
        let (mut limit, mut tested) = (limit, 0);
        'search: while let Some((distance, child)) = stack.pop() {
            if f64::from(distance) > limit {
                continue;
            }
            match child {
                Child::Cluster(cluster) => {
                    if !posed.visit(cluster) {
                        continue;
                    }
                    let reach = round_up_to_f32(limit);
                    let survivors = posed.along_ray(&sheared_ray, reach, &mut sheared);
                    for triangle in posed.view.enabled(survivors) {
                        tested += 1;
                        let corners = posed.view.corners_in(&sheared, triangle);
                        let corners = corners.map(|corner| corner.to_array());
                        if let Some(found) = intersect_sheared(corners, limit) {
                            match visit(&posed, triangle, found) {
                                Some(distance) => limit = distance,
                                None => break 'search,
                            }
                        }
                    }
                }
                Child::Node(index) => {
                    let node = &hierarchy.nodes[index as usize];
                    let spheres = self.current.spheres(&self.mesh, index);
                    let reach = round_up_to_f32(limit);
                    let (met, distances) = broad::along_ray(&spheres, ray, reach);
                    for lane in farthest_first(&distances, usize::from(node.lanes)) {
                        if met & 1 << lane != 0 {
                            stack.push((distances[lane], node.child(lane)));
                        }
                    }
                }
            }
        }
        self.count_tested(tested);
    }
}

pub(super) fn check(max_distance: f32) -> Result<f64, SurfaceError> {
    check_length("the ray's maximum distance", max_distance)
}
