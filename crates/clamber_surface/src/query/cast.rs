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
use crate::geometry::triangle::{Corners8, EIGHT, first_contact_of_eight};
use crate::geometry::{Capsule, round_up_to_f32};
use crate::mesh::{ColliderMesh, TriangleId};
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
    /// The part of the tick that the cast takes: the shares of the tick at which it begins and ends, 0..=1 and in
    /// order; the whole tick by default. Skin that [moves](TargetMotion::Moving) covers this part of its motion
    /// meanwhile. To cast on an arc, cast several parts, one after the other. Times of contacts are shares of the cast,
    /// not of the tick. A cast with another order or NaN finds nothing.
    pub during: [f64; 2],
    /// Ignores the triangles that the shape overlaps at the start ([`SweepHit::started_inside`]): for a body that is
    /// pressed into skin and looks for other obstacles on its way. Costs less than rejecting these contacts one by one.
    pub past_overlaps: bool,
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
        past_overlaps: false,
    };

    /// A cast at skin that moves over the tick.
    pub const MOVING: Self = Self {
        target: TargetMotion::Moving,
        tolerance: None,
        during: [0.0, 1.0],
        past_overlaps: false,
    };

    /// The same options with another tolerance, in model units; for a cast in world space, in metres.
    #[must_use]
    pub const fn with_tolerance(self, tolerance: f64) -> Self {
        Self {
            tolerance: Some(tolerance),
            ..self
        }
    }

    /// The same options, without the triangles that the shape overlaps at the start: see
    /// [`CastOptions::past_overlaps`].
    #[must_use]
    pub const fn past_overlaps(self) -> Self {
        Self {
            past_overlaps: true,
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
    /// Finds no contact if a displacement is not finite, or if the tolerance is negative or not finite.
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
            let mut sweep = Sweep::new(probe, tolerance, Span::new(options.during)?)?;
            sweep.past_overlaps = options.past_overlaps;
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
            let Some(mut sweep) = Sweep::new(probe, tolerance, span) else {
                return;
            };
            sweep.past_overlaps = options.past_overlaps;
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
        // The touch of a vertex may be a contact that `counts` rejects.
        let every_one_counts = counts.is_none() && !sweep.past_overlaps;
        self.visit_contacts::<true, N, P>(poses, sweep, every_one_counts, &mut |first| {
            earliest.offer_if(first, |first| {
                let counts = counts.as_mut();
                counts.is_none_or(|counts| {
                    self.sweep_hit(sweep, *first)
                        .is_some_and(|hit| counts(&hit))
                })
            });
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

    /// Calls `visit` with the first contact of every triangle that is touched up to the limit of time. `visit` returns
    /// the new limit: the last time that still matters. If `every_one_counts`, a touch of a vertex lowers the limit as
    /// well.
    fn visit_contacts<const EARLIEST_FIRST: bool, const N: usize, const P: usize>(
        &self,
        poses: [&PosedMesh; P],
        sweep: &Sweep<N>,
        every_one_counts: bool,
        visit: &mut dyn FnMut(First) -> f64,
    ) {
        let mut tests = Tests {
            instance: self,
            poses,
            sweep,
            visit,
            limit: 1.0,
            tested: 0,
            steps: 0,
        };
        dispatch!(self.simd_level.level(), simd => {
            tests.descend::<_, EARLIEST_FIRST>(simd, every_one_counts);
        });
        self.count_tested(tests.tested, tests.steps);
    }
}

/// The largest number of clusters that are set aside until the touches of their vertices are known.
const ASIDE: usize = 16;

/// The exact tests of a cast.
struct Tests<'a, const N: usize, const P: usize> {
    instance: &'a Instance,
    poses: [&'a PosedMesh; P],
    sweep: &'a Sweep<N>,
    visit: &'a mut dyn FnMut(First) -> f64,
    /// The last time that still matters.
    limit: f64,
    tested: usize,
    steps: u32,
}

impl<const N: usize, const P: usize> Tests<'_, N, P> {
    /// Descends to the clusters on the sweep's path. If `every_one_counts`, they are set aside first, and the touches
    /// of their vertices lower the limit: few triangles are then left for the exact test.
    #[cfg_attr(not(unoptimized), inline(always))]
    fn descend<S: Simd, const EARLIEST_FIRST: bool>(&mut self, simd: S, every_one_counts: bool) {
        let (instance, poses, sweep) = (self.instance, self.poses, self.sweep);
        let path = sweep.bounds();
        let (mut aside, mut count) = ([0; ASIDE], 0);
        traverse::<EARLIEST_FIRST>(
            instance.mesh.hierarchy(),
            self.limit,
            #[cfg_attr(not(unoptimized), inline(always))]
            |node, limit| {
                let bounds = poses.map(|pose| pose.bounds(&instance.mesh, node));
                broad::along(simd, bounds, sweep, path, limit)
            },
            #[cfg_attr(not(unoptimized), inline(always))]
            |cluster, _| {
                let Some(posed) = PosedCluster::visit(instance, poses, cluster) else {
                    return Some(self.limit);
                };
                if !posed.enters(path) {
                    return Some(self.limit);
                }
                aside[count] = cluster;
                count += 1;
                if every_one_counts {
                    let mut ends = None;
                    let posed = posed.during(&sweep.span, &mut ends);
                    let touch = posed.touched_by(simd, &sweep.probe);
                    self.limit = self.limit.min(touch.into());
                }
                if !every_one_counts || count == ASIDE {
                    self.test(&aside[..count]);
                    count = 0;
                }
                Some(self.limit)
            },
        );
        if count > 0 {
            self.test(&aside[..count]);
        }
    }

    /// Tests the triangles of some clusters. Triangles of several clusters are tested together.
    fn test(&mut self, clusters: &[u32]) {
        let level = self.instance.simd_level.level();
        dispatch!(level, simd => self.test_on(simd, clusters));
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn test_on<S: Simd>(&mut self, simd: S, clusters: &[u32]) {
        let (poses, sweep) = (self.poses, self.sweep);
        let mut corners = [Corners8::default(); P];
        let mut ids = [TriangleId(0); EIGHT];
        let mut count = 0;
        for cluster in clusters {
            let Some(posed) = PosedCluster::visit(self.instance, poses, *cluster) else {
                continue;
            };
            let mut ends = None;
            let posed = posed.during(&sweep.span, &mut ends);
            let until = round_up_to_f32(self.limit);
            for triangle in posed.near(simd, &sweep.probe, until).iter() {
                for (corners, of_pose) in corners.iter_mut().zip(posed.corners(triangle)) {
                    corners.set(count, of_pose);
                }
                ids[count] = posed.id(triangle);
                count += 1;
                if count == EIGHT {
                    self.test_eight(&corners, &ids);
                    count = 0;
                }
            }
        }
        if count > 0 {
            for corners in &mut corners {
                let first = corners.get(0);
                for lane in count..EIGHT {
                    corners.set(lane, first);
                }
            }
            self.test_eight(&corners, &ids[..count]);
        }
    }

    fn test_eight(&mut self, corners: &[Corners8; P], triangles: &[TriangleId]) {
        let level = self.instance.simd_level;
        let found = first_contact_of_eight(level, corners, &self.sweep.core, self.limit);
        self.tested += triangles.len();
        self.steps = self.steps.max(found.steps);
        for (lane, triangle) in triangles.iter().enumerate() {
            if let Some(contact) = found.get(lane)
                && self.sweep.counts(&contact)
            {
                let limit = (self.visit)(First {
                    triangle: *triangle,
                    corners: [corners[0].get(lane), corners[P - 1].get(lane)],
                    contact,
                });
                self.limit = self.limit.min(limit);
            }
        }
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
