//! The reference for queries: every vertex skinned in scalar code, every triangle tested.

use glam::Vec3;

use super::hit::{Best, Earliest, First, FoundPoint, sort_by_distance, sort_by_time};
use super::instance::Instance;
use super::probe::{Probe, Sweep, with_probe};
use super::span::Span;
use super::{CastOptions, ModelSpace, MovingTriangle, SurfaceHit, SweepHit, TargetMotion, length};
use crate::geometry::triangle::{ShearedRay, first_contact};
use crate::geometry::{Capsule, Ray};
use crate::mesh::{PartId, TriangleId};
use crate::skin::skin_vertex;

/// The queries of a surface by brute force: slow and simple, for tests.
///
/// Skins every vertex in scalar code when it is made, uses no bounds, and tests all enabled triangles one by one. The
/// surface must return the same bits. The only exception is a sweep among coordinates that differ by some 2^50 in size:
/// there, bounds may rule out a contact that the exact test leaves [`undecided`](SweepHit::undecided).
#[derive(Clone, Debug)]
pub struct BruteForce<'a> {
    instance: &'a Instance,
    positions: Vec<Vec3>,
}

impl<'a> BruteForce<'a> {
    /// Skins the surface in its current pose.
    pub fn new(space: ModelSpace<'a>) -> Self {
        let instance = space.instance;
        let vertices = 0..instance.mesh.positions().len();
        let palette = instance.current.palette();
        Self {
            instance,
            positions: vertices
                .map(|vertex| skin_vertex(&instance.mesh, palette, vertex))
                .collect(),
        }
    }

    /// Every vertex, skinned in scalar code, in model space.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// The posed corners of all triangles by ascending id, disabled and removed ones included, in model space.
    pub fn posed_triangles(&self) -> Vec<[Vec3; 3]> {
        let all = self.instance.mesh.triangles().iter();
        all.map(|corners| corners.map(|v| self.positions[v.index()]))
            .collect()
    }

    /// Reference for [`ModelSpace::cast_ray`].
    pub fn cast_ray(&self, ray: &Ray, max_distance: f32) -> Option<SurfaceHit> {
        let sheared = ShearedRay::new(ray);
        let mut best = Best::within(length(max_distance)?);
        for (triangle, part, corners) in self.triangles() {
            if let Some(found) = sheared.intersect(corners, best.limit()) {
                best.offer(FoundPoint { triangle, found }, part, || corners);
            }
        }
        best.hit(self.instance, ray.origin())
    }

    /// Reference for [`ModelSpace::intersects_ray`].
    pub fn intersects_ray(&self, ray: &Ray, max_distance: f32) -> bool {
        self.cast_ray(ray, max_distance).is_some()
    }

    /// Reference for [`ModelSpace::cast_ray_all`].
    pub fn cast_ray_all(&self, ray: &Ray, max_distance: f32, hits: &mut Vec<SurfaceHit>) {
        hits.clear();
        let Some(limit) = length(max_distance) else {
            return;
        };
        let sheared = ShearedRay::new(ray);
        for (triangle, part, corners) in self.triangles() {
            if let Some(found) = sheared.intersect(corners, limit) {
                let nearest = FoundPoint { triangle, found };
                hits.push(self.instance.hit(nearest, part, corners, ray.origin()));
            }
        }
        sort_by_distance(hits);
    }

    /// Reference for [`ModelSpace::closest_point`].
    pub fn closest_point(&self, point: Vec3, max_distance: f32) -> Option<SurfaceHit> {
        let ball = Capsule::ball(point, 0.0)?;
        self.closest(&Probe::of_ball(&ball, Vec3::ZERO), length(max_distance)?)
    }

    /// Reference for [`ModelSpace::closest_to_capsule`].
    pub fn closest_to_capsule(&self, capsule: &Capsule, max_distance: f32) -> Option<SurfaceHit> {
        let reach = f64::from(capsule.radius()) + length(max_distance)?;
        with_probe!(capsule, [Vec3::ZERO; 2], probe => self.closest(&probe, reach))
    }

    fn closest<const N: usize>(&self, probe: &Probe<N>, reach: f64) -> Option<SurfaceHit> {
        let mut best = Best::within(reach);
        for (triangle, part, corners) in self.triangles() {
            let found = probe.closest(corners);
            best.offer(FoundPoint { triangle, found }, part, || corners);
        }
        best.hit(self.instance, probe.middle())
    }

    /// Reference for [`ModelSpace::overlap_capsule`].
    pub fn overlap_capsule(&self, capsule: &Capsule, hits: &mut Vec<SurfaceHit>) {
        hits.clear();
        with_probe!(capsule, [Vec3::ZERO; 2], probe => {
            for (triangle, part, corners) in self.triangles() {
                let found = probe.closest(corners);
                if found.distance <= f64::from(capsule.radius()) {
                    let nearest = FoundPoint { triangle, found };
                    hits.push(self.instance.hit(nearest, part, corners, probe.middle()));
                }
            }
        });
    }

    /// Reference for [`ModelSpace::cast_capsule`].
    pub fn cast_capsule(
        &self,
        capsule: &Capsule,
        displacements: [Vec3; 2],
        options: &CastOptions,
    ) -> Option<SweepHit> {
        let mut earliest = Earliest::default();
        let tolerance = options.tolerance_for(capsule, &self.instance.mesh);
        with_probe!(capsule, displacements, probe => {
            let sweep = Sweep::new(probe, tolerance?, Span::new(options.during)?)?;
            self.contacts(&sweep, options.target, |first| {
                if !options.past_overlaps || !sweep.started_inside(&first.contact) {
                    earliest.offer(first);
                }
            });
            earliest.hit(self.instance, &sweep)
        })
    }

    /// Reference for [`ModelSpace::cast_capsule_where`].
    pub fn cast_capsule_where(
        &self,
        capsule: &Capsule,
        displacements: [Vec3; 2],
        options: &CastOptions,
        counts: &mut dyn FnMut(&SweepHit) -> bool,
    ) -> Option<SweepHit> {
        let mut hits = Vec::new();
        self.cast_capsule_all(capsule, displacements, options, &mut hits);
        hits.into_iter().find(counts)
    }

    /// Reference for [`ModelSpace::cast_capsule_all`].
    pub fn cast_capsule_all(
        &self,
        capsule: &Capsule,
        displacements: [Vec3; 2],
        options: &CastOptions,
        hits: &mut Vec<SweepHit>,
    ) {
        hits.clear();
        let tolerance = options.tolerance_for(capsule, &self.instance.mesh);
        with_probe!(capsule, displacements, probe => {
            let span = tolerance.zip(Span::new(options.during));
            if let Some(sweep) = span.and_then(|(tolerance, span)| Sweep::new(probe, tolerance, span)) {
                self.contacts(&sweep, options.target, |first| {
                    hits.extend(self.instance.sweep_hit(&sweep, first));
                });
            }
        });
        hits.retain(|hit| !options.past_overlaps || !hit.started_inside);
        sort_by_time(hits);
    }

    /// Reference for [`ModelSpace::visit_box`], by ascending triangle id.
    pub fn visit_box(&self, low: Vec3, high: Vec3, mut visit: impl FnMut(&MovingTriangle)) {
        let is_box = low.is_finite() && high.is_finite() && low.cmple(high).all();
        for (triangle, _, current) in self.triangles() {
            let moving = MovingTriangle {
                triangle,
                previous: self.instance.corners_in(&self.instance.previous, triangle),
                current,
            };
            if is_box && moving.meets_box(low, high) {
                visit(&moving);
            }
        }
    }

    /// Calls `visit` with the first contact of every triangle that has one.
    fn contacts<const N: usize>(
        &self,
        sweep: &Sweep<N>,
        target: TargetMotion,
        mut visit: impl FnMut(First),
    ) {
        for (triangle, _, current) in self.triangles() {
            let previous = match target {
                TargetMotion::Still => current,
                TargetMotion::Moving => self.instance.corners_in(&self.instance.previous, triangle),
            };
            let corners = match target {
                TargetMotion::Still => [previous, current],
                TargetMotion::Moving => sweep.span.corners([previous, current]),
            };
            if let (Some(contact), _) = first_contact(corners, &sweep.core, 1.0) {
                visit(First {
                    triangle,
                    corners,
                    contact,
                });
            }
        }
    }

    /// All enabled triangles, by ascending id, with their parts and posed corners.
    fn triangles(&self) -> impl Iterator<Item = (TriangleId, PartId, [Vec3; 3])> {
        let mesh = &self.instance.mesh;
        let all = (0..).map(TriangleId).zip(mesh.triangles());
        all.filter_map(|(triangle, corners)| {
            let part = mesh.part_of(triangle)?;
            let corners = corners.map(|v| self.positions[v.index()]);
            let enabled = self.instance.is_enabled(triangle);
            enabled.then_some((triangle, part, corners))
        })
    }
}
