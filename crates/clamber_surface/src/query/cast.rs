//! A moving capsule against the surface at one pose or between two.
//!
//! Nodes and clusters are ruled out by their spheres at both ends of the motion. The contents of a sphere move on
//! straight lines, so between the ends they lie in the sphere interpolated between the two. Within a cluster, triangles
//! are ruled out by planes that nothing of the capsule crosses. For the others the [first
//! contact](crate::geometry::triangle::first_contact) is computed, eight triangles at a time. If only the first contact
//! of all is asked for, every stage stops at the earliest contact found so far.

use fearless_simd::{Simd, dispatch};
use glam::Vec3;

use super::cluster::PosedCluster;
use super::hit::{Earliest, First, sort_by_time};
use super::instance::Instance;
use super::probe::{Sweep, with_probe};
use super::span::Span;
use super::traverse::traverse;
use super::{ModelSpace, SweepHit, broad, root};
use crate::geometry::triangle::first_contact_of_eight;
use crate::geometry::{Capsule, round_up_to_f32};
use crate::mesh::ColliderMesh;
use crate::pose::PosedMesh;

/// Whether the target of a cast, skin or any other obstacle, moves during the cast.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TargetMotion {
    /// The target stands still in its current pose.
    #[default]
    Still,
    /// The target moves from its pose a tick ago to its current pose, every point on a straight line, while the cast
    /// shape moves: a sweep over the tick.
    Moving,
}

/// Options of a cast at skin.
///
/// ```
/// use clamber_surface::surface::{CastOptions, TargetMotion};
///
/// assert_eq!(CastOptions::default(), CastOptions::STILL);
/// let fine = CastOptions::MOVING.with_tolerance(1e-5);
/// assert_eq!((fine.target, fine.tolerance), (TargetMotion::Moving, Some(1e-5)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CastOptions {
    /// Whether the skin moves during the cast.
    pub target: TargetMotion,
    /// Largest gap between shape and skin that counts as a contact, in model units; for a cast in world space, in
    /// metres. May be 0; a cast with a negative or infinite tolerance, or NaN, finds nothing.
    ///
    /// `None` stands for 1/4,000 of the shape's radius, or for 2^-23 of the mesh's radius (the spacing of f32 at that
    /// size) if that is larger. Such a gap is too small to see.
    pub tolerance: Option<f64>,
    /// The part of the tick that the cast takes, from which share of it to which, 0..=1 and in order; the whole tick by
    /// default. Skin that [moves](TargetMotion::Moving) goes this part of its way meanwhile. What moves on an arc is cast in
    /// several parts, one after the other. Times of contacts are shares of the cast, not of the tick. A cast with another
    /// order or NaN finds nothing.
    pub during: [f64; 2],
}

impl Default for CastOptions {
    fn default() -> Self {
        Self::STILL
    }
}

impl CastOptions {
    /// A cast at skin that stands still.
    pub const STILL: Self = Self {
        target: TargetMotion::Still,
        tolerance: None,
        during: [0.0, 1.0],
    };

    /// A cast at skin that moves over the tick.
    pub const MOVING: Self = Self {
        target: TargetMotion::Moving,
        tolerance: None,
        during: [0.0, 1.0],
    };

    /// The same options with another tolerance, in model units; for a cast in world space, in metres.
    #[must_use]
    pub const fn with_tolerance(self, tolerance: f64) -> Self {
        Self {
            tolerance: Some(tolerance),
            ..self
        }
    }

    /// The same options for a part of the tick: see [`CastOptions::during`].
    #[must_use]
    pub const fn during(self, from: f64, to: f64) -> Self {
        Self {
            during: [from, to],
            ..self
        }
    }

    /// The tolerance in model units; `None` if it is negative or NaN.
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
            ..Self::STILL
        }
    }
}

impl ModelSpace<'_> {
    /// The first contact of a moving capsule with skin that stands still or moves meanwhile. Each end of the capsule
    /// moves straight by one of `displacements`, in model units.
    ///
    /// The time of the contact is never later than the first touch, and `None` guarantees that there is no contact. At
    /// that time the capsule is at most the tolerance away from the skin; a tolerance below 2^-45 of the lengths
    /// involved counts as 2^-45 of them. Where the capsule grazes the skin, the time may be earlier than the touch by
    /// any amount. If the solver can show neither contact nor miss, it reports a contact flagged
    /// [`undecided`](SweepHit::undecided).
    ///
    /// If several contacts have the same time, the nearest one is returned; if they are equally near, the one with the
    /// smaller triangle id. A capsule that overlaps the skin at the start is in contact at time 0 with the triangle
    /// nearest to its segment.
    ///
    /// Nothing is found if a displacement is not finite, or if the tolerance is negative or not finite.
    pub fn cast_capsule(
        &self,
        capsule: &Capsule,
        displacements: [Vec3; 2],
        options: &CastOptions,
    ) -> Option<SweepHit> {
        self.cast(capsule, displacements, options, None)
    }

    /// [`ModelSpace::cast_capsule`] among the contacts that `counts` accepts.
    ///
    /// `counts` is called, in any order, with the contact of each triangle that could be the first. A contact for which
    /// it returns false is skipped. For example, a body that is pressed into skin finds the other skin in its way if
    /// `counts` rejects contacts that [started inside](SweepHit::started_inside).
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
            let sweep = Sweep::new(probe, tolerance, Span::new(options.during)?)?;
            if instance.moves(options.target) {
                let poses = [&instance.previous, &instance.current];
                instance.first_contact(poses, &sweep, counts)
            } else {
                instance.first_contact([&instance.current], &sweep, counts)
            }
        })
    }

    /// Finds every triangle that [`ModelSpace::cast_capsule`] may meet, each with its own first contact, sorted by
    /// time, then distance, then triangle id. `hits` is cleared first; its memory is reused.
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
        let Some(span) = Span::new(options.during) else {
            return;
        };
        with_probe!(capsule, displacements, probe => {
            let Some(sweep) = Sweep::new(probe, tolerance, span) else {
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
    /// True if a cast needs both poses: skin that stands still has the same pose at both ends.
    fn moves(&self, target: TargetMotion) -> bool {
        target == TargetMotion::Moving && !self.is_still
    }

    /// Visits nodes with the earliest bounds first. With `counts`, considers only the contacts that it accepts.
    fn first_contact<const N: usize, const P: usize>(
        &self,
        poses: [&PosedMesh; P],
        sweep: &Sweep<N>,
        mut counts: Option<&mut dyn FnMut(&SweepHit) -> bool>,
    ) -> Option<SweepHit> {
        let sweep = &near(poses, sweep)?;
        let mut earliest = Earliest::default();
        // The triangle that is touched by then may be one that `counts` rejects.
        let every_one_counts = counts.is_none();
        self.visit_contacts::<true, N, P>(poses, sweep, every_one_counts, &mut |first| {
            let is_counted = counts
                .as_mut()
                .is_none_or(|counts| self.sweep_hit(sweep, first).is_some_and(|hit| counts(&hit)));
            if is_counted {
                earliest.offer(first);
            }
            earliest.limit()
        });
        earliest.hit(self, sweep)
    }

    /// Appends all contacts, in no order.
    fn all_contacts<const N: usize, const P: usize>(
        &self,
        poses: [&PosedMesh; P],
        sweep: &Sweep<N>,
        hits: &mut Vec<SweepHit>,
    ) {
        if let Some(sweep) = &near(poses, sweep) {
            self.visit_contacts::<false, N, P>(poses, sweep, false, &mut |first| {
                hits.extend(self.sweep_hit(sweep, first));
                1.0
            });
        }
    }

    /// Calls `visit` with the first contact of every triangle that is touched before contacts stop mattering. `visit`
    /// returns the last time that still matters. If `every_one_counts`, nothing matters that is later than a touch of a
    /// vertex.
    fn visit_contacts<const EARLIEST_FIRST: bool, const N: usize, const P: usize>(
        &self,
        poses: [&PosedMesh; P],
        sweep: &Sweep<N>,
        every_one_counts: bool,
        visit: &mut dyn FnMut(First) -> f64,
    ) {
        dispatch!(self.simd_level.level(), simd => {
            self.descend_cast::<_, EARLIEST_FIRST, N, P>(simd, poses, sweep, every_one_counts, visit);
        });
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn descend_cast<S: Simd, const EARLIEST_FIRST: bool, const N: usize, const P: usize>(
        &self,
        simd: S,
        poses: [&PosedMesh; P],
        sweep: &Sweep<N>,
        every_one_counts: bool,
        visit: &mut dyn FnMut(First) -> f64,
    ) {
        let path = sweep.bounds();
        let (mut tested, mut steps) = (0, 0);
        traverse::<EARLIEST_FIRST>(
            self.mesh.hierarchy(),
            1.0,
            #[cfg_attr(not(unoptimized), inline(always))]
            |node, limit| {
                let spheres = poses.map(|pose| pose.spheres(&self.mesh, node));
                broad::along(simd, spheres, sweep, limit)
            },
            #[cfg_attr(not(unoptimized), inline(always))]
            |cluster, limit| {
                let Some(posed) = PosedCluster::visit(self, poses, cluster) else {
                    return Some(limit);
                };
                if !posed.enters(path) {
                    return Some(limit);
                }
                let mut ends;
                let posed = if P == 1 || sweep.span.is_whole() {
                    posed
                } else {
                    ends = Default::default();
                    posed.during(&sweep.span, &mut ends)
                };
                let mut limit = limit;
                let mut until = limit;
                if every_one_counts {
                    until = until.min(posed.touched_by(simd, &sweep.probe).into());
                }
                posed
                    .near(simd, &sweep.probe, round_up_to_f32(until))
                    .by_eight(
                        #[cfg_attr(not(unoptimized), inline(always))]
                        |batch| {
                            let corners = posed.batch(batch);
                            let found =
                                first_contact_of_eight(posed.level(), &corners, &sweep.core, until);
                            tested += batch.len();
                            steps = steps.max(found.steps);
                            for (lane, triangle) in batch.iter().enumerate() {
                                if let Some(contact) = found.get(lane) {
                                    limit = visit(First {
                                        triangle: posed.id(usize::from(*triangle)),
                                        corners: [corners[0].get(lane), corners[P - 1].get(lane)],
                                        contact,
                                    });
                                    until = until.min(limit);
                                }
                            }
                        },
                    );
                Some(limit)
            },
        );
        self.count_tested(tested, steps);
    }
}

/// The sweep with the reach that it has among these poses; `None` if it comes nowhere near them.
fn near<const N: usize, const P: usize>(
    poses: [&PosedMesh; P],
    sweep: &Sweep<N>,
) -> Option<Sweep<N>> {
    let bounds = poses[0].root().union(poses[P - 1].root());
    let sweep = sweep.among(root::size(&bounds) * 2.0 + sweep.length());
    let [low, high] = sweep.bounds();
    root::overlaps(&bounds, low, high).then_some(sweep)
}
