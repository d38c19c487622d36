use super::super::broad::each_lane;
use super::super::closest::farthest_first;
use super::super::cluster_view::by_eight;
use super::super::root;
use super::super::stack::Stack;
use super::cluster::MovingCluster;
use super::{Earliest, First, Sweep, SweepHit, broad, sort_by_time};
use crate::geometry::round_up_to_f32;
use crate::geometry::triangle::advance_eight;
use crate::mesh::hierarchy::Child;
use crate::surface::SkinnedSurface;
use crate::surface::bounds::Spheres;
use crate::surface::pose::Pose;

impl SkinnedSurface {
    /// The first contact.
    pub(super) fn first_contact<const N: usize>(
        &self,
        poses: [&Pose; 2],
        sweep: &Sweep<N>,
    ) -> Option<SweepHit> {
        self.search(poses, sweep, None)
    }

    /// The first contact that counts.
    pub(super) fn first_contact_where<const N: usize>(
        &self,
        poses: [&Pose; 2],
        sweep: &Sweep<N>,
        counts: &mut dyn FnMut(&SweepHit) -> bool,
    ) -> Option<SweepHit> {
        self.search(poses, sweep, Some(counts))
    }

    /// Earliest bounds first. With `counts`, among the contacts that count.
    fn search<const N: usize>(
        &self,
        poses: [&Pose; 2],
        sweep: &Sweep<N>,
        mut counts: Option<&mut dyn FnMut(&SweepHit) -> bool>,
    ) -> Option<SweepHit> {
        let sweep = &self.near(poses, sweep)?;
        let mut earliest = Earliest::NONE;
        let hierarchy = self.mesh.hierarchy();
        let mut cluster = MovingCluster::new(self, poses);
        let root = |node| (0.0f32, Child::Node(node));
        let mut stack = Stack::new(root(0), hierarchy.further_roots().map(root));
        let mut count = Count::default();
        while let Some((begin, child)) = stack.pop() {
            // What begins with the best one stays: it may be nearer, or have a smaller id.
            if f64::from(begin) > earliest.limit() {
                continue;
            }
            match child {
                Child::Cluster(index) => {
                    if cluster.visit(index) {
                        // The first that is touched may be one that is passed over.
                        let touched_by = match counts {
                            None => cluster.touched_by(sweep).into(),
                            Some(_) => f64::INFINITY,
                        };
                        let limit = earliest.limit().min(touched_by);
                        count.add(contacts(&cluster, sweep, limit, |first| {
                            let is_counted = counts.as_mut().is_none_or(|counts| {
                                self.sweep_hit(sweep, first).is_some_and(|hit| counts(&hit))
                            });
                            if is_counted {
                                earliest.offer(first);
                            }
                            earliest.limit()
                        }));
                    }
                }
                Child::Node(index) => {
                    let node = &hierarchy.nodes[index as usize];
                    let spheres = self.moving_spheres(poses, index);
                    let limit = round_up_to_f32(earliest.limit());
                    let (near, begins) = broad::along(&spheres, sweep, limit);
                    for lane in farthest_first(&begins, usize::from(node.lanes)) {
                        if near & 1 << lane != 0 {
                            stack.push((begins[lane], node.child(lane)));
                        }
                    }
                }
            }
        }
        self.count_swept(count.triangles, count.steps);
        earliest.hit(self, sweep)
    }

    pub(super) fn all_contacts<const N: usize>(
        &self,
        poses: [&Pose; 2],
        sweep: &Sweep<N>,
        hits: &mut Vec<SweepHit>,
    ) {
        hits.clear();
        let Some(sweep) = &self.near(poses, sweep) else {
            return;
        };
        let hierarchy = self.mesh.hierarchy();
        let mut cluster = MovingCluster::new(self, poses);
        let mut stack = Stack::new(0, hierarchy.further_roots());
        let mut count = Count::default();
        while let Some(index) = stack.pop() {
            let node = &hierarchy.nodes[index as usize];
            let spheres = self.moving_spheres(poses, index);
            let (near, _) = broad::along(&spheres, sweep, 1.0);
            for lane in each_lane(near & node.lane_mask()) {
                match node.child(lane) {
                    Child::Node(child) => stack.push(child),
                    Child::Cluster(index) => {
                        if cluster.visit(index) {
                            count.add(contacts(&cluster, sweep, 1.0, |first| {
                                hits.extend(self.sweep_hit(sweep, first));
                                1.0
                            }));
                        }
                    }
                }
            }
        }
        self.count_swept(count.triangles, count.steps);
        sort_by_time(hits);
    }

    /// The sweep with the reach that it has here; `None` if that is nowhere near the surface.
    fn near<const N: usize>(&self, [start, end]: [&Pose; 2], sweep: &Sweep<N>) -> Option<Sweep<N>> {
        let bounds = start.root().union(end.root());
        let sweep = sweep.among(root::size(&bounds) * 2.0 + sweep.length());
        let [low, high] = sweep.bounds();
        root::overlaps(&bounds, low, high).then_some(sweep)
    }

    pub(super) fn moving_spheres(&self, [start, end]: [&Pose; 2], node: u32) -> [Spheres; 2] {
        let first = start.spheres(&self.mesh, node);
        if std::ptr::eq(start, end) {
            [first; 2]
        } else {
            [first, end.spheres(&self.mesh, node)]
        }
    }
}

/// What a query tested.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    triangles: usize,
    /// Most of any triangle.
    steps: u32,
}

impl Count {
    fn add(&mut self, other: Self) {
        self.triangles += other.triangles;
        self.steps = self.steps.max(other.steps);
    }
}

/// Calls `visit` with the first contact of every triangle of a cluster that is touched up to `limit`;
/// it gives the time that still matters.
fn contacts<const N: usize>(
    cluster: &MovingCluster<'_>,
    sweep: &Sweep<N>,
    mut limit: f64,
    mut visit: impl FnMut(First) -> f64,
) -> Count {
    let mut count = Count::default();
    let view = &cluster.view;
    let survivors = cluster.along(sweep, round_up_to_f32(limit));
    by_eight(view.enabled(survivors), |batch| {
        let [start, end] = cluster.batch(batch);
        let found = advance_eight(view.level(), &start, &end, &sweep.core, limit);
        count.add(Count {
            triangles: batch.len(),
            steps: found.steps,
        });
        for (lane, triangle) in batch.iter().enumerate() {
            if let Some(contact) = found.get(lane) {
                let first = First {
                    triangle: view.id(*triangle),
                    corners: [start.get(lane), end.get(lane)],
                    contact,
                };
                limit = limit.min(visit(first));
            }
        }
    });
    count
}
