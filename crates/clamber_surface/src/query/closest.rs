use fearless_simd::{Simd, dispatch};
use glam::Vec3;

use super::cluster::PosedCluster;
use super::hit::{Best, FoundPoint};
use super::instance::Instance;
use super::probe::{BLUR, Probe, with_probe};
use super::traverse::traverse;
use super::{ModelSpace, SurfaceHit, broad, length, root};
use crate::geometry::triangle::{Corners8, Points8};
use crate::geometry::{Capsule, round_up_to_f32};

impl ModelSpace<'_> {
    /// The material point nearest to `point`, at most `max_distance` away, in model space. `None` if there is no such
    /// point, or if `point` is not finite.
    pub fn closest_point(&self, point: Vec3, max_distance: f32) -> Option<SurfaceHit> {
        let ball = Capsule::ball(point, 0.0)?;
        let probe = Probe::of_ball(&ball, Vec3::ZERO);
        self.instance.closest(&probe, length(max_distance)?)
    }

    /// The material point nearest to a capsule's segment, at most the capsule's radius plus `max_distance` away from
    /// the segment. The hit's `distance` is measured from the segment, and is 0 if the segment crosses the skin. The
    /// capsule may overlap the skin. `None` if there is no such point. Made for limbs.
    pub fn closest_to_capsule(&self, capsule: &Capsule, max_distance: f32) -> Option<SurfaceHit> {
        let reach = f64::from(capsule.radius()) + length(max_distance)?;
        with_probe!(capsule, [Vec3::ZERO; 2], probe => {
            self.instance.closest(&probe, reach)
        })
    }
}

impl Instance {
    /// The material point nearest to a probe's core, within `reach` of it.
    fn closest<const N: usize>(&self, probe: &Probe<N>, reach: f64) -> Option<SurfaceHit> {
        let mut best = Best::within(reach);
        let size = root::size(self.current.root());
        let blur = probe.blur(size);
        let [low, high] = probe.box_around(reach + blur);
        if !root::overlaps(self.current.root(), low, high) {
            return None;
        }
        dispatch!(self.simd_level.level(), simd => {
            self.descend_closest(simd, probe, [size, blur], &mut best);
        });
        best.hit(self, probe.middle())
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn descend_closest<S: Simd, const N: usize>(
        &self,
        simd: S,
        probe: &Probe<N>,
        [size, blur]: [f64; 2],
        best: &mut Best,
    ) {
        let mut tested = 0;
        traverse::<true>(
            self.mesh.hierarchy(),
            best.limit() + blur,
            #[cfg_attr(not(unoptimized), inline(always))]
            |node, limit| {
                let bounds = self.current.bounds(&self.mesh, node);
                let distances = broad::distances(simd, bounds, probe);
                (broad::within(simd, &distances, limit), distances)
            },
            #[cfg_attr(not(unoptimized), inline(always))]
            |cluster, limit| {
                let Some(posed) = PosedCluster::visit(self, [&self.current], cluster) else {
                    return Some(limit);
                };
                if !posed.comes_within(probe, round_up_to_f32(limit)) {
                    return Some(limit);
                }
                // No triangle farther than the nearest vertex matters, except for rounding in its measured distance.
                let (point, lost) = probe.facing(posed.middle()[0]);
                let vertex = f64::from(posed.nearest_vertex(simd, point)) + lost;
                let near = best.limit().min(vertex + BLUR * size) + blur;
                let survivors = posed.near(simd, &probe.reaching(near), 0.0);
                let (mut corners, mut points) = ([Corners8::default()], Points8::default());
                survivors.by_eight(
                    #[cfg_attr(not(unoptimized), inline(always))]
                    |batch| {
                        tested += batch.len();
                        posed.batch(batch, &mut corners);
                        probe.closest_of_eight(posed.level(), &corners[0], &mut points);
                        for (lane, triangle) in batch.iter().enumerate() {
                            let candidate = FoundPoint {
                                triangle: posed.id(usize::from(*triangle)),
                                found: points.get(lane),
                            };
                            best.offer(candidate, posed.part(), || corners[0].get(lane));
                        }
                    },
                );
                Some(best.limit() + blur)
            },
        );
        self.count_tested(tested, 0);
    }
}
