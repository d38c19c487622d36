use fearless_simd::{Simd, dispatch};
use glam::Vec3;

use super::cluster::PosedCluster;
use super::hit::FoundPoint;
use super::instance::Instance;
use super::narrow::Survivors;
use super::probe::{Probe, with_probe};
use super::traverse::traverse;
use super::{ModelSpace, SurfaceHit, broad, root};
use crate::geometry::Capsule;
use crate::geometry::triangle::{Corners8, Points8};
use crate::mesh::TriangleId;
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

    /// Calls `visit` with every triangle of [`ModelSpace::overlap_capsule`], in unspecified order. Takes a fraction of
    /// the time, since most triangles need neither their nearest point nor a normal.
    pub fn visit_triangles_in_capsule(&self, capsule: &Capsule, mut visit: impl FnMut(TriangleId)) {
        let instance = self.instance;
        with_probe!(capsule, [Vec3::ZERO; 2], probe => {
            if let Some(reaching) = instance.overlapping(&probe) {
                dispatch!(instance.simd_level.level(), simd => {
                    instance.descend_triangles(simd, &probe, &reaching, &mut visit);
                });
            }
        });
    }
}

impl Instance {
    /// The probe with the reach that an overlap has; `None` if it comes nowhere near the surface.
    fn overlapping<const N: usize>(&self, probe: &Probe<N>) -> Option<Probe<N>> {
        let reach = f64::from(probe.radius) + probe.blur(root::size(self.current.root()));
        let [low, high] = probe.box_around(reach);
        root::overlaps(self.current.root(), low, high).then(|| probe.reaching(reach))
    }

    fn visit_overlap<const N: usize>(&self, probe: &Probe<N>, mut visit: impl FnMut(SurfaceHit)) {
        if let Some(reaching) = self.overlapping(probe) {
            dispatch!(self.simd_level.level(), simd => {
                self.descend_overlap(simd, probe, &reaching, &mut visit);
            });
        }
    }

    /// Calls `visit` with every triangle within the probe. The exact test is left to triangles that neither a plane
    /// rules out nor a corner inside rules in.
    #[cfg_attr(not(unoptimized), inline(always))]
    fn descend_triangles<S: Simd, const N: usize>(
        &self,
        simd: S,
        probe: &Probe<N>,
        reaching: &Probe<N>,
        visit: &mut impl FnMut(TriangleId),
    ) {
        self.each_near(
            simd,
            reaching,
            #[cfg_attr(not(unoptimized), inline(always))]
            |posed, near| {
                let within = posed.surely_within(simd, probe, near);
                for triangle in within.iter() {
                    visit(posed.id(triangle));
                }
                self.each_within(
                    probe,
                    posed,
                    near.without(within),
                    #[cfg_attr(not(unoptimized), inline(always))]
                    |found, _| visit(found.triangle),
                )
            },
        );
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn descend_overlap<S: Simd, const N: usize>(
        &self,
        simd: S,
        probe: &Probe<N>,
        reaching: &Probe<N>,
        visit: &mut impl FnMut(SurfaceHit),
    ) {
        self.each_near(
            simd,
            reaching,
            #[cfg_attr(not(unoptimized), inline(always))]
            |posed, near| {
                self.each_within(
                    probe,
                    posed,
                    near,
                    #[cfg_attr(not(unoptimized), inline(always))]
                    |found, corners| {
                        visit(self.hit(found, posed.part(), corners, probe.middle()));
                    },
                )
            },
        );
    }

    /// Calls `test` with the triangles that may be within reach, cluster by cluster. It returns how many of them it
    /// tested.
    #[cfg_attr(not(unoptimized), inline(always))]
    fn each_near<S: Simd, const N: usize>(
        &self,
        simd: S,
        reaching: &Probe<N>,
        mut test: impl FnMut(&PosedCluster<'_, 1>, Survivors) -> usize,
    ) {
        let mut tested = 0;
        traverse::<false>(
            self.mesh.hierarchy(),
            0.0,
            #[cfg_attr(not(unoptimized), inline(always))]
            |node, _| {
                let bounds = self.current.bounds(&self.mesh, node);
                (broad::near(simd, bounds, reaching), [0.0; LANES])
            },
            #[cfg_attr(not(unoptimized), inline(always))]
            |cluster, limit| {
                if let Some(posed) = PosedCluster::visit(self, [&self.current], cluster)
                    && posed.comes_within(reaching, reaching.reach)
                {
                    tested += test(&posed, posed.near(simd, reaching, 0.0));
                }
                Some(limit)
            },
        );
        self.count_tested(tested, 0);
    }

    /// Calls `visit` with each of the given triangles that is within the probe by the exact test, and with its corners.
    /// Returns the number of tested triangles.
    #[cfg_attr(not(unoptimized), inline(always))]
    fn each_within<const N: usize>(
        &self,
        probe: &Probe<N>,
        posed: &PosedCluster<'_, 1>,
        triangles: Survivors,
        mut visit: impl FnMut(FoundPoint, [Vec3; 3]),
    ) -> usize {
        let radius = f64::from(probe.radius);
        let (mut corners, mut points) = ([Corners8::default()], Points8::default());
        let mut tested = 0;
        triangles.by_eight(
            #[cfg_attr(not(unoptimized), inline(always))]
            |batch| {
                tested += batch.len();
                posed.batch(batch, &mut corners);
                probe.closest_of_eight(self.simd_level, &corners[0], &mut points);
                for (lane, triangle) in batch.iter().enumerate() {
                    let found = points.get(lane);
                    if found.distance <= radius {
                        let triangle = posed.id(usize::from(*triangle));
                        visit(FoundPoint { triangle, found }, corners[0].get(lane));
                    }
                }
            },
        );
        tested
    }
}
