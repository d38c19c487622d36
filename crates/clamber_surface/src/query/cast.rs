//! A capsule that moves, against the surface at one pose or between two.
//!
//! Nodes and clusters are ruled out by where their spheres are at both ends of the motion: what a
//! sphere holds moves on straight lines, so between the ends it lies in the sphere between the two.
//! Of a cluster that is reached triangles are ruled out by planes that
//! nothing of the cluster crosses; of the others the [first
//! contact](crate::geometry::triangle::first_contact) is found, of eight at a time. Where only the first contact of all is
//! asked for, all of it stops at the earliest one found so far.

use glam::Vec3;

use super::cluster::{PosedCluster, by_eight};
use super::hit::{Earliest, First, sort_by_time};
use super::instance::Instance;
use super::probe::{Sweep, with_probe};
use super::traverse::traverse;
use super::{ModelSpace, SweepHit, broad, root};
use crate::geometry::triangle::first_contact_of_eight;
use crate::geometry::{Capsule, round_up_to_f32};
use crate::mesh::ColliderMesh;
use crate::pose::PosedMesh;

/// What skin, or any obstacle, does while something is cast at it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TargetMotion {
    /// It stands still as it is now.
    #[default]
    Still,
    /// It moves from where it was a tick ago to where it is now, every point of it on a straight line, while what is
    /// cast makes its way: a sweep over the tick.
    Moving,
}

/// How something is cast at skin.
///
/// ```
/// use clamber_surface::surface::{CastOptions, TargetMotion};
///
/// assert_eq!(CastOptions::default(), CastOptions::STILL);
/// let fine = CastOptions::MOVING.with_tolerance(1e-5);
/// assert_eq!((fine.target, fine.tolerance), (TargetMotion::Moving, Some(1e-5)));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct CastOptions {
    /// Whether the skin moves meanwhile.
    pub target: TargetMotion,
    /// How far from touching counts as a contact, in model units; of a cast in the world, in metres. Where none is given, a
    /// 4,000th of the radius, below what one sees, and at least the steps of f32 at the mesh's size.
    pub tolerance: Option<f64>,
}

impl CastOptions {
    /// At skin that stands still.
    pub const STILL: Self = Self {
        target: TargetMotion::Still,
        tolerance: None,
    };

    /// At skin that moves over the tick.
    pub const MOVING: Self = Self {
        target: TargetMotion::Moving,
        tolerance: None,
    };

    /// With another tolerance, in model units or, in the world, metres.
    #[must_use]
    pub const fn with_tolerance(self, tolerance: f64) -> Self {
        Self {
            tolerance: Some(tolerance),
            ..self
        }
    }

    /// `None` if it is negative or NaN.
    pub(super) fn tolerance_for(&self, capsule: &Capsule, mesh: &ColliderMesh) -> Option<f32> {
        let least = mesh.radius() * f32::EPSILON;
        match self.tolerance {
            Some(tolerance) if tolerance >= 0.0 => Some(tolerance as f32),
            Some(_) => None,
            None => Some((capsule.radius() * 2.5e-4).max(least)),
        }
    }
}

impl From<TargetMotion> for CastOptions {
    fn from(target: TargetMotion) -> Self {
        Self {
            target,
            tolerance: None,
        }
    }
}

impl ModelSpace<'_> {
    /// The first contact of a capsule whose ends each go straight by one of `displacements`, with skin that stands still
    /// or moves meanwhile.
    ///
    /// The time of a contact is never later than that at which the capsule first touches the skin, and
    /// if none is found there is none. At that time the capsule is at most the tolerance away from the
    /// skin; less than 2^-45 of the lengths involved counts as that. How much earlier than the
    /// touch that is has no bound where the capsule grazes the skin. Contacts for which neither could
    /// be shown are reported, and flagged [`undecided`](SweepHit::undecided).
    ///
    /// Of contacts at one time the nearest is given, of those as near the one of the smaller triangle
    /// id. A capsule that overlaps the skin at the start is in contact at time 0 with the triangle
    /// nearest to its segment.
    ///
    /// A displacement that is not finite, and a tolerance that is negative or not finite, find nothing.
    pub fn cast_capsule(
        &self,
        capsule: &Capsule,
        displacements: [Vec3; 2],
        options: &CastOptions,
    ) -> Option<SweepHit> {
        self.cast(capsule, displacements, options, None)
    }

    /// [`ModelSpace::cast_capsule`] among chosen contacts. `counts` is called, in any order, with the contact of each
    /// triangle that could be the first; contacts for which it returns false are passed over. A body that is pressed
    /// into skin so finds other skin: `counts` returns false for contacts that [started
    /// inside](SweepHit::started_inside).
    pub fn cast_capsule_where(
        &self,
        capsule: &Capsule,
        displacements: [Vec3; 2],
        options: &CastOptions,
        counts: &mut dyn FnMut(&SweepHit) -> bool,
    ) -> Option<SweepHit> {
        self.cast(capsule, displacements, options, Some(counts))
    }

    fn cast(
        &self,
        capsule: &Capsule,
        displacements: [Vec3; 2],
        options: &CastOptions,
        counts: Option<&mut dyn FnMut(&SweepHit) -> bool>,
    ) -> Option<SweepHit> {
        let instance = self.instance;
        let tolerance = options.tolerance_for(capsule, &instance.mesh)?;
        with_probe!(capsule, displacements, probe => {
            let sweep = Sweep::new(probe, tolerance)?;
            if instance.moves(options.target) {
                let poses = [&instance.previous, &instance.current];
                instance.first_contact(poses, &sweep, counts)
            } else {
                instance.first_contact([&instance.current], &sweep, counts)
            }
        })
    }

    /// Every triangle that [`ModelSpace::cast_capsule`] may meet, each with its own first contact,
    /// by time, at one time by distance, then by id. `hits` is cleared first and keeps its memory.
    pub fn cast_capsule_all(
        &self,
        capsule: &Capsule,
        displacements: [Vec3; 2],
        options: &CastOptions,
        hits: &mut Vec<SweepHit>,
    ) {
        hits.clear();
        let instance = self.instance;
        let Some(tolerance) = options.tolerance_for(capsule, &instance.mesh) else {
            return;
        };
        with_probe!(capsule, displacements, probe => {
            let Some(sweep) = Sweep::new(probe, tolerance) else {
                return;
            };
            if instance.moves(options.target) {
                let poses = [&instance.previous, &instance.current];
                instance.all_contacts(poses, &sweep, hits);
            } else {
                instance.all_contacts([&instance.current], &sweep, hits);
            }
        });
        sort_by_time(hits);
    }
}

impl Instance {
    /// Whether skin has two poses for a cast: one that stands still is the same as one that moves nowhere.
    fn moves(&self, target: TargetMotion) -> bool {
        target == TargetMotion::Moving && !self.is_still
    }

    /// Earliest bounds first. With `counts`, among the contacts that count.
    fn first_contact<const N: usize, const P: usize>(
        &self,
        poses: [&PosedMesh; P],
        sweep: &Sweep<N>,
        mut counts: Option<&mut dyn FnMut(&SweepHit) -> bool>,
    ) -> Option<SweepHit> {
        let sweep = &near(poses, sweep)?;
        let mut earliest = Earliest::default();
        // The first that is touched may be one that is passed over.
        let every_one_counts = counts.is_none();
        self.visit_contacts::<true, N, P>(
            poses,
            sweep,
            |posed| {
                if every_one_counts {
                    posed.touched_by(&sweep.probe).into()
                } else {
                    f64::INFINITY
                }
            },
            |first| {
                let is_counted = counts.as_mut().is_none_or(|counts| {
                    self.sweep_hit(sweep, first).is_some_and(|hit| counts(&hit))
                });
                if is_counted {
                    earliest.offer(first);
                }
                earliest.limit()
            },
        );
        earliest.hit(self, sweep)
    }

    /// In no order.
    fn all_contacts<const N: usize, const P: usize>(
        &self,
        poses: [&PosedMesh; P],
        sweep: &Sweep<N>,
        hits: &mut Vec<SweepHit>,
    ) {
        if let Some(sweep) = &near(poses, sweep) {
            self.visit_contacts::<false, N, P>(
                poses,
                sweep,
                |_| f64::INFINITY,
                |first| {
                    hits.extend(self.sweep_hit(sweep, first));
                    1.0
                },
            );
        }
    }

    /// Calls `visit` with the first contact of every triangle that is touched up to the time that still matters, which
    /// `visit` gives; of a cluster not beyond `touched_by`.
    fn visit_contacts<'a, const EARLIEST_FIRST: bool, const N: usize, const P: usize>(
        &'a self,
        poses: [&'a PosedMesh; P],
        sweep: &Sweep<N>,
        touched_by: impl Fn(&PosedCluster<'a, P>) -> f64,
        mut visit: impl FnMut(First) -> f64,
    ) {
        let mut posed = PosedCluster::new(self, poses);
        let (mut tested, mut steps) = (0, 0);
        traverse::<EARLIEST_FIRST>(
            self.mesh.hierarchy(),
            1.0,
            |node, limit| broad::along(&self.spheres(poses, node), sweep, round_up_to_f32(limit)),
            &mut |cluster, mut limit| {
                if !posed.visit(cluster) {
                    return Some(limit);
                }
                let mut until = limit.min(touched_by(&posed));
                let survivors = posed.near(&sweep.probe, round_up_to_f32(until));
                by_eight(posed.enabled(survivors), |batch| {
                    let corners = posed.batch(batch);
                    let level = posed.level();
                    let found = first_contact_of_eight(level, &corners, &sweep.core, until);
                    tested += batch.len();
                    steps = steps.max(found.steps);
                    for (lane, triangle) in batch.iter().enumerate() {
                        if let Some(contact) = found.get(lane) {
                            limit = visit(First {
                                triangle: posed.id(*triangle),
                                corners: [corners[0].get(lane), corners[P - 1].get(lane)],
                                contact,
                            });
                            until = until.min(limit);
                        }
                    }
                });
                Some(limit)
            },
        );
        self.count_tested(tested, steps);
    }
}

/// The sweep with the reach that it has among these poses; `None` if that is nowhere near them.
fn near<const N: usize, const P: usize>(
    poses: [&PosedMesh; P],
    sweep: &Sweep<N>,
) -> Option<Sweep<N>> {
    let bounds = poses[0].root().union(poses[P - 1].root());
    let sweep = sweep.among(root::size(&bounds) * 2.0 + sweep.length());
    let [low, high] = sweep.bounds();
    root::overlaps(&bounds, low, high).then_some(sweep)
}
