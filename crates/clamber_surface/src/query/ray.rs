use super::cluster::PosedCluster;
use super::hit::{Best, FoundPoint, sort_by_distance};
use super::instance::Instance;
use super::traverse::traverse;
use super::{ModelSpace, SurfaceHit, broad, length, root};
use crate::geometry::triangle::{ShearedRay, TrianglePoint, intersect_sheared};
use crate::geometry::{Ray, round_up_to_f32};
use crate::skin::ClusterPositions;

impl ModelSpace<'_> {
    /// The first triangle that a ray meets, from either side, up to `max_distance`, in model units.
    ///
    /// Watertight across edges and corners that triangles share by index. Among equal distances the smaller triangle id
    /// wins.
    pub fn cast_ray(&self, ray: &Ray, max_distance: f32) -> Option<SurfaceHit> {
        let mut best = Best::within(length(max_distance)?);
        self.instance
            .visit_ray(ray, best.limit(), |posed, triangle, found| {
                best.offer(FoundPoint {
                    triangle: posed.id(triangle),
                    found,
                });
                Some(best.limit())
            });
        best.hit(self.instance, ray.origin())
    }

    /// True if a ray meets any triangle, from either side, up to `max_distance`. Stops at the first triangle that it
    /// finds.
    pub fn intersects_ray(&self, ray: &Ray, max_distance: f32) -> bool {
        let mut met = false;
        if let Some(limit) = length(max_distance) {
            self.instance.visit_ray(ray, limit, |_, _, _| {
                met = true;
                None
            });
        }
        met
    }

    /// Finds all triangles that a ray meets, from either side, up to `max_distance`, sorted by distance, then by
    /// triangle id. The first is the hit of [`ModelSpace::cast_ray`]. A ray through an edge or a corner meets all
    /// triangles that share it. `hits` is cleared first; its memory is reused.
    pub fn cast_ray_all(&self, ray: &Ray, max_distance: f32, hits: &mut Vec<SurfaceHit>) {
        hits.clear();
        let Some(limit) = length(max_distance) else {
            return;
        };
        self.instance
            .visit_ray(ray, limit, |posed, triangle, found| {
                let nearest = FoundPoint {
                    triangle: posed.id(triangle),
                    found,
                };
                let [corners] = posed.corners(triangle);
                let hit = self
                    .instance
                    .hit(nearest, posed.part(), corners, ray.origin());
                hits.push(hit);
                Some(limit)
            });
        sort_by_distance(hits);
    }
}

impl Instance {
    /// Calls `visit` with every triangle that the ray meets, nearest bounds first. `visit` returns the distance that
    /// still matters, or `None` to stop.
    pub(super) fn visit_ray<'a>(
        &'a self,
        ray: &Ray,
        limit: f64,
        mut visit: impl FnMut(&PosedCluster<'a, 1>, usize, TrianglePoint) -> Option<f64>,
    ) {
        if !root::may_meet(self.current.root(), ray, limit) {
            return;
        }
        let sheared_ray = ShearedRay::new(ray);
        let mut posed = PosedCluster::new(self, [&self.current]);
        let mut sheared = ClusterPositions::ZERO;
        let mut tested = 0;
        traverse::<true>(
            self.mesh.hierarchy(),
            limit,
            |node, limit| {
                let spheres = self.current.spheres(&self.mesh, node);
                broad::along_ray(&spheres, ray, round_up_to_f32(limit))
            },
            &mut |cluster, mut limit| {
                if !posed.visit(cluster) {
                    return Some(limit);
                }
                let reach = round_up_to_f32(limit);
                let survivors = posed.along_ray(&sheared_ray, reach, &mut sheared);
                for triangle in posed.enabled(survivors) {
                    tested += 1;
                    let corners = posed.corners_in(&sheared, triangle);
                    let corners = corners.map(|corner| corner.to_array());
                    if let Some(found) = intersect_sheared(corners, limit) {
                        limit = visit(&posed, triangle, found)?;
                    }
                }
                Some(limit)
            },
        );
        self.count_tested(tested, 0);
    }
}
