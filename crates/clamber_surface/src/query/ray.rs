use fearless_simd::{Simd, dispatch};

use super::cluster::PosedCluster;
use super::hit::{Best, FoundPoint, sort_by_distance};
use super::instance::Instance;
use super::traverse::traverse;
use super::{ModelSpace, SurfaceHit, broad, length, root};
use crate::geometry::triangle::{ShearedRay, TrianglePoint};
use crate::geometry::{Ray, round_up_to_f32};

impl ModelSpace<'_> {
    /// The first triangle that a ray meets, from either side, up to `max_distance`, in model units.
    ///
    /// Watertight across edges and corners that triangles share by index. Among equal distances the smaller triangle id
    /// wins.
    pub fn cast_ray(&self, ray: &Ray, max_distance: f32) -> Option<SurfaceHit> {
        let mut best = Best::within(length(max_distance)?);
        self.instance
            .visit_ray(ray, best.limit(), &mut |posed, triangle, found| {
                let candidate = FoundPoint {
                    triangle: posed.id(triangle),
                    found,
                };
                best.offer(candidate, posed.part(), || posed.corners(triangle)[0]);
                Some(best.limit())
            });
        best.hit(self.instance, ray.origin())
    }

    /// True if a ray meets any triangle, from either side, up to `max_distance`. Stops at the first triangle that it
    /// finds.
    pub fn intersects_ray(&self, ray: &Ray, max_distance: f32) -> bool {
        let mut met = false;
        if let Some(limit) = length(max_distance) {
            self.instance.visit_ray(ray, limit, &mut |_, _, _| {
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
            .visit_ray(ray, limit, &mut |posed, triangle, found| {
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
    pub(super) fn visit_ray(
        &self,
        ray: &Ray,
        limit: f64,
        visit: &mut dyn FnMut(&PosedCluster<'_, 1>, usize, TrianglePoint) -> Option<f64>,
    ) {
        if root::may_meet(self.current.root(), ray, limit) {
            dispatch!(self.simd_level.level(), simd => self.descend_ray(simd, ray, limit, visit));
        }
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn descend_ray<S: Simd>(
        &self,
        simd: S,
        ray: &Ray,
        limit: f64,
        visit: &mut dyn FnMut(&PosedCluster<'_, 1>, usize, TrianglePoint) -> Option<f64>,
    ) {
        let sheared_ray = ShearedRay::new(ray);
        let mut tested = 0;
        traverse::<true>(
            self.mesh.hierarchy(),
            limit,
            #[cfg_attr(not(unoptimized), inline(always))]
            |node, limit| {
                let bounds = self.current.bounds(&self.mesh, node);
                broad::along_ray(simd, bounds, ray, &sheared_ray, limit)
            },
            #[cfg_attr(not(unoptimized), inline(always))]
            |cluster, mut limit| {
                let Some(posed) = PosedCluster::visit(self, [&self.current], cluster) else {
                    return Some(limit);
                };
                let reach = round_up_to_f32(limit);
                if !posed.may_meet(&sheared_ray, reach) {
                    return Some(limit);
                }
                for triangle in posed.along_ray(simd, &sheared_ray, reach).iter() {
                    tested += 1;
                    let [corners] = posed.corners(triangle);
                    if let Some(found) = sheared_ray.intersect(corners, limit) {
                        limit = visit(&posed, triangle, found)?;
                    }
                }
                Some(limit)
            },
        );
        self.count_tested(tested, 0);
    }
}
