use glam::Vec3;

use super::cluster::{PosedCluster, by_eight};
use super::hit::FoundPoint;
use super::instance::Instance;
use super::probe::{Probe, with_probe};
use super::traverse::traverse;
use super::{ModelSpace, SurfaceHit, broad, root};
use crate::geometry::Capsule;
use crate::mesh::hierarchy::LANES;

impl ModelSpace<'_> {
    /// Finds every triangle within the capsule, by ascending triangle id, each with its point closest to the capsule's
    /// segment. The distance of a hit is measured from the segment: 0 where the segment crosses the triangle. `hits` is
    /// cleared first; its memory is reused.
    pub fn overlap_capsule(&self, capsule: &Capsule, hits: &mut Vec<SurfaceHit>) {
        hits.clear();
        self.visit_overlap_capsule(capsule, |hit| hits.push(hit));
        hits.sort_unstable_by_key(|hit| hit.triangle);
    }

    /// [`ModelSpace::overlap_capsule`] with a callback in place of a list. Hits come in unspecified order.
    pub fn visit_overlap_capsule(&self, capsule: &Capsule, visit: impl FnMut(SurfaceHit)) {
        with_probe!(capsule, [Vec3::ZERO; 2], probe => self.instance.visit_overlap(&probe, visit));
    }
}

impl Instance {
    fn visit_overlap<const N: usize>(&self, probe: &Probe<N>, mut visit: impl FnMut(SurfaceHit)) {
        let radius = f64::from(probe.radius);
        let reach = radius + probe.blur(root::size(self.current.root()));
        let [low, high] = probe.box_around(reach);
        if !root::overlaps(self.current.root(), low, high) {
            return;
        }
        let reaching = probe.reaching(reach);
        let mut posed = PosedCluster::new(self, [&self.current]);
        let mut tested = 0;
        traverse::<false>(
            self.mesh.hierarchy(),
            reach,
            |node, _| {
                let spheres = self.current.spheres(&self.mesh, node);
                (broad::near(&spheres, &reaching), [0.0; LANES])
            },
            &mut |cluster, limit| {
                if !posed.visit(cluster) {
                    return Some(limit);
                }
                by_eight(posed.enabled(posed.near(&reaching, 0.0)), |batch| {
                    tested += batch.len();
                    let points = probe.closest_of_eight(posed.level(), &posed.batch(batch)[0]);
                    for (lane, triangle) in batch.iter().enumerate() {
                        let found = points.get(lane);
                        if found.distance <= radius {
                            let nearest = FoundPoint {
                                triangle: posed.id(*triangle),
                                found,
                            };
                            let [corners] = posed.corners(*triangle);
                            visit(self.hit(nearest, posed.part(), corners, probe.middle()));
                        }
                    }
                });
                Some(limit)
            },
        );
        self.count_tested(tested, 0);
    }
}
