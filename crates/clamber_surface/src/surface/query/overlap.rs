use super::cluster_view::by_eight;
use super::hit::Nearest;
use super::posed_cluster::PosedCluster;
use super::region::{Region, box_around};
use super::stack::Stack;
use super::{broad, root};
use crate::geometry::{Capsule, Sphere};
use crate::mesh::hierarchy::Child;
use crate::surface::{SkinnedSurface, SurfaceError, SurfaceHit};

impl SkinnedSurface {
    /// Every triangle within the sphere, each with its own point closest to the sphere's centre,
    /// by ascending triangle id. `hits` is cleared first and keeps its memory.
    ///
    /// # Errors
    /// [`SurfaceError::Point`] if the sphere's centre is not finite, [`SurfaceError::Query`] if its
    /// radius (may be infinite) is negative or NaN; `hits` is unchanged then.
    pub fn overlap_sphere(
        &self,
        sphere: &Sphere,
        hits: &mut Vec<SurfaceHit>,
    ) -> Result<(), SurfaceError> {
        self.overlap(sphere, hits)
    }

    /// Every triangle within the capsule, each with its own point closest to the capsule's segment,
    /// by ascending triangle id. A hit's distance is that from the segment: 0 where it crosses the
    /// triangle. `hits` is cleared first and keeps its memory.
    ///
    /// # Errors
    /// As [`SkinnedSurface::overlap_sphere`], for both ends.
    pub fn overlap_capsule(
        &self,
        capsule: &Capsule,
        hits: &mut Vec<SurfaceHit>,
    ) -> Result<(), SurfaceError> {
        self.overlap(capsule, hits)
    }

    /// [`SkinnedSurface::overlap_sphere`] for callers with a place of their own for the hits, which
    /// come in no promised order.
    ///
    /// # Errors
    /// As [`SkinnedSurface::overlap_sphere`]; nothing is visited then.
    pub fn visit_overlap_sphere(
        &self,
        sphere: &Sphere,
        visit: impl FnMut(SurfaceHit),
    ) -> Result<(), SurfaceError> {
        let radius = sphere.check()?;
        self.visit_region(sphere, radius, visit);
        Ok(())
    }

    /// [`SkinnedSurface::overlap_capsule`] for callers with a place of their own for the hits, which
    /// come in no promised order.
    ///
    /// # Errors
    /// As [`SkinnedSurface::overlap_capsule`]; nothing is visited then.
    pub fn visit_overlap_capsule(
        &self,
        capsule: &Capsule,
        visit: impl FnMut(SurfaceHit),
    ) -> Result<(), SurfaceError> {
        let radius = capsule.check()?;
        self.visit_region(capsule, radius, visit);
        Ok(())
    }

    fn overlap(
        &self,
        region: &impl Region,
        hits: &mut Vec<SurfaceHit>,
    ) -> Result<(), SurfaceError> {
        let radius = region.check()?;
        hits.clear();
        self.visit_region(region, radius, |hit| hits.push(hit));
        hits.sort_unstable_by_key(|hit| hit.triangle);
        Ok(())
    }

    fn visit_region(&self, region: &impl Region, radius: f64, mut visit: impl FnMut(SurfaceHit)) {
        let reach = radius + region.blur(root::size(self.current.root()));
        let [low, high] = box_around(region.segment(), reach);
        if !root::overlaps(self.current.root(), low, high) {
            return;
        }
        let hierarchy = self.mesh.hierarchy();
        let mut posed = PosedCluster::new(self);
        let mut stack = Stack::new(0, hierarchy.further_roots());
        let mut tested = 0;
        while let Some(index) = stack.pop() {
            let node = &hierarchy.nodes[index as usize];
            let near = region.near(&self.current.spheres(&self.mesh, index)) & node.lane_mask();
            for lane in broad::each_lane(near) {
                match node.child(lane) {
                    Child::Node(child) => stack.push(child),
                    Child::Cluster(cluster) => {
                        if posed.visit(cluster) {
                            tested += test(&posed, region, radius, reach, &mut visit);
                        }
                    }
                }
            }
        }
        self.count_tested(tested);
    }
}

/// Tests a cluster's triangles, those within `reach` exactly; gives how many these were.
fn test(
    posed: &PosedCluster<'_>,
    region: &impl Region,
    radius: f64,
    reach: f64,
    visit: &mut impl FnMut(SurfaceHit),
) -> usize {
    let mut tested = 0;
    let view = &posed.view;
    let [a, b] = region.segment();
    by_eight(view.enabled(posed.near(a, b, reach)), |batch| {
        tested += batch.len();
        let points = region.closest_of_eight(view.level(), &posed.batch(batch));
        for (lane, triangle) in batch.iter().enumerate() {
            let found = points.get(lane);
            if found.distance <= radius {
                let nearest = Nearest {
                    triangle: view.id(*triangle),
                    found,
                };
                let (part, corners) = (view.cluster.part, posed.corners(*triangle));
                visit(view.surface.hit(nearest, part, corners, region.middle()));
            }
        }
    });
    tested
}
