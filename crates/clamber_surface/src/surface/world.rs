use glam::{DQuat, DVec3, Vec3};

use super::motion::Motion;
use super::{Anchor, SkinnedSurface, SurfaceError, SurfacePoint};
use crate::geometry::{Capsule, Ray, Similarity, WorldCapsule};
use crate::mesh::{MeshId, PartId, SurfaceTag, TriangleId};
use crate::query::{CastOptions, SurfaceHit, SweepHit};

/// A surface in the world, in f64: the queries of [`ModelSpace`](super::ModelSpace) where the creature stands. Got from
/// [`SkinnedSurface::in_world`].
///
/// Queries go to the model space and come back, so a creature far from the world's origin answers as exactly as one
/// near it. Ray lengths and the distances of closest-point queries may be infinite. A radius or displacement that is
/// infinite, a length that is NaN or negative, and a point or direction that is not finite find nothing.
#[derive(Clone, Copy, Debug)]
pub struct WorldSpace<'a> {
    surface: &'a SkinnedSurface,
}

/// A material point that a query found, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WorldHit {
    /// The mesh that has the triangle.
    pub mesh: MeshId,
    /// The triangle.
    pub triangle: TriangleId,
    /// Weights of its corners: not negative, sum 1 up to rounding.
    pub barycentric: [f32; 3],
    /// The point.
    pub point: DVec3,
    /// Outward unit normal of the deformed triangle. Where the triangle has collapsed: towards the query's origin.
    pub normal: DVec3,
    /// From the ray's origin, the query's point or the capsule's segment, metres.
    pub distance: f64,
    /// The part that the triangle belongs to.
    pub part: PartId,
    /// The triangle's tag.
    pub tag: SurfaceTag,
}

/// The first contact of a capsule on its way with skin, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WorldSweepHit {
    /// What is touched, where it is at that time; its distance is from the capsule's segment.
    pub hit: WorldHit,
    /// Share of the motion that was made when they touched, 0..=1.
    pub time: f64,
    /// Unit vector from the point to the capsule's segment; where that lies on the triangle itself, its normal.
    pub separation_normal: DVec3,
    /// True if they overlap at the start already; the time is 0.
    pub started_inside: bool,
    /// As [`SweepHit::undecided`].
    pub undecided: bool,
}

/// The motion of an anchor over one tick, in world space: differences of positions over the tick's length, never an
/// instantaneous velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WorldMotion {
    /// Where the point is now.
    pub position: DVec3,
    /// Where it was a tick ago.
    pub previous_position: DVec3,
    /// Displacement over the tick, metres per second. Like both places it is rounded to f32 in model space, by itself: it
    /// is near to their difference over the tick, and not equal to it.
    pub velocity: DVec3,
    /// Rotation of the material around the point from rest to now, in world space: [`Motion::frame`], and then the
    /// surface's own rotation.
    pub frame: DQuat,
    /// Axis times radians per second that turns the frame of a tick ago into the current one, by at most half a turn.
    pub angular_velocity: DVec3,
    /// Outward unit normal of the triangle now; of a collapsed triangle, as its frame keeps it.
    pub normal: DVec3,
    /// True if the triangle has no area of its own now: frame and normal are remembered ones.
    pub collapsed: bool,
    /// Area now over area a tick ago; 1 where it was collapsed.
    pub area_ratio: f32,
    /// How much longer the most and the least stretched direction of the triangle became since a tick ago, larger first;
    /// 1 and 1 where it was collapsed.
    pub stretches: [f32; 2],
}

impl From<&WorldHit> for SurfacePoint {
    fn from(hit: &WorldHit) -> Self {
        Self {
            mesh: hit.mesh,
            triangle: hit.triangle,
            barycentric: hit.barycentric,
        }
    }
}

impl From<&WorldSweepHit> for SurfacePoint {
    fn from(hit: &WorldSweepHit) -> Self {
        (&hit.hit).into()
    }
}

impl SkinnedSurface {
    /// The surface where it stands in the world: its queries.
    pub fn in_world(&self) -> WorldSpace<'_> {
        WorldSpace { surface: self }
    }
}

impl WorldSpace<'_> {
    /// The first triangle along a ray, from either side, up to `max_distance`. `direction` may have any length but zero;
    /// distances are in metres along it.
    pub fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<WorldHit> {
        let ray = self.ray(origin, direction)?;
        let hit = self
            .surface
            .in_model()
            .cast_ray(&ray, self.length(max_distance))?;
        Some(self.hit(&hit, |_| origin))
    }

    /// True if a ray meets any triangle, from either side, up to `max_distance`.
    pub fn intersects_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> bool {
        self.ray(origin, direction).is_some_and(|ray| {
            let length = self.length(max_distance);
            self.surface.in_model().intersects_ray(&ray, length)
        })
    }

    /// All triangles along a ray, by distance, equal ones by triangle id. `hits` is cleared first.
    pub fn cast_ray_all(
        &self,
        origin: DVec3,
        direction: DVec3,
        max_distance: f64,
        hits: &mut Vec<WorldHit>,
    ) {
        hits.clear();
        if let Some(ray) = self.ray(origin, direction) {
            // In the order of the model's distances, so that the first is the one of `cast_ray`.
            let (length, mut found) = (self.length(max_distance), Vec::new());
            let space = self.surface.in_model();
            space.cast_ray_all(&ray, length, &mut found);
            hits.extend(found.iter().map(|hit| self.hit(hit, |_| origin)));
        }
    }

    /// The material point nearest to `point`, no farther than `max_distance`.
    pub fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<WorldHit> {
        let local = self.place().inverse_transform_point_f32(point);
        let hit = self
            .surface
            .in_model()
            .closest_point(local, self.length(max_distance))?;
        Some(self.hit(&hit, |_| point))
    }

    /// Every triangle within a capsule, each with its own point closest to the capsule's segment, in no promised order.
    pub fn visit_overlap_capsule(&self, capsule: &WorldCapsule, mut visit: impl FnMut(WorldHit)) {
        if let Some(local) = self.capsule(capsule) {
            let is_ball = capsule.is_ball();
            let nearest = |point: DVec3| match capsule.ends {
                [center, _] if is_ball => center,
                _ => capsule.nearest_on_axis(point),
            };
            let space = self.surface.in_model();
            space.visit_overlap_capsule(&local, |hit| visit(self.hit(&hit, nearest)));
        }
    }

    /// The material point nearest to a capsule's segment, no farther from the capsule than `max_distance`.
    pub fn closest_to_capsule(
        &self,
        capsule: &WorldCapsule,
        max_distance: f64,
    ) -> Option<WorldHit> {
        let (local, space) = (self.capsule(capsule)?, self.surface.in_model());
        let found = space.closest_to_capsule(&local, self.length(max_distance))?;
        Some(self.hit(&found.surface, |point| capsule.nearest_on_axis(point)))
    }

    /// [`ModelSpace::is_inside`](super::ModelSpace::is_inside).
    pub fn is_inside(&self, point: DVec3) -> bool {
        let local = self.place().inverse_transform_point_f32(point);
        self.surface.in_model().is_inside(local)
    }

    /// The first contact of a capsule whose ends each go straight by one of `displacements`, with skin that stands still,
    /// or that moves over the tick meanwhile: [`ModelSpace::cast_capsule`](super::ModelSpace::cast_capsule), with a
    /// tolerance in metres.
    pub fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        options: &CastOptions,
    ) -> Option<WorldSweepHit> {
        let (local, displacements, options) = self.cast(capsule, displacements, options)?;
        let space = self.surface.in_model();
        let hit = space.cast_capsule(&local, displacements, &options)?;
        Some(self.sweep_hit(&hit))
    }

    /// [`WorldSpace::cast_capsule`] among chosen contacts. `counts` is called, in any order, with the contact of each
    /// triangle that could be the first; contacts for which it returns false are passed over.
    pub fn cast_capsule_where(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        options: &CastOptions,
        counts: &mut dyn FnMut(&WorldSweepHit) -> bool,
    ) -> Option<WorldSweepHit> {
        let (local, displacements, options) = self.cast(capsule, displacements, options)?;
        let mut counts = |hit: &SweepHit| counts(&self.sweep_hit(hit));
        let space = self.surface.in_model();
        let hit = space.cast_capsule_where(&local, displacements, &options, &mut counts)?;
        Some(self.sweep_hit(&hit))
    }

    /// The motion of an anchor over a tick of `dt` seconds, in world space. Skins three vertices.
    ///
    /// # Errors
    /// As [`ModelSpace::motion`](super::ModelSpace::motion).
    pub fn motion(&self, anchor: &Anchor, dt: f64) -> Result<WorldMotion, SurfaceError> {
        let motion = self.surface.in_model().motion(anchor, dt)?;
        Ok(self.motion_of(&motion))
    }

    fn motion_of(&self, motion: &Motion) -> WorldMotion {
        let world_from_model = self.place();
        WorldMotion {
            position: world_from_model.transform_point_f32(motion.position),
            previous_position: world_from_model.transform_point_f32(motion.previous_position),
            velocity: world_from_model.transform_vector(motion.velocity.as_dvec3()),
            frame: (world_from_model.rotation * motion.frame.as_dquat()).normalize(),
            angular_velocity: self.direction(motion.angular_velocity),
            normal: self.direction(motion.normal),
            collapsed: motion.collapsed,
            area_ratio: motion.area_ratio,
            stretches: motion.stretches,
        }
    }

    fn place(&self) -> &Similarity {
        self.surface.world_from_model()
    }

    /// A length in model units.
    fn length(&self, length: f64) -> f32 {
        (length / self.place().scale) as f32
    }

    fn ray(&self, origin: DVec3, direction: DVec3) -> Option<Ray> {
        let start = self.place().inverse_transform_point_f32(origin);
        let along = self
            .place()
            .inverse_transform_vector(direction.try_normalize()?)
            .normalize();
        Ray::new(start, along.as_vec3())
    }

    fn capsule(&self, capsule: &WorldCapsule) -> Option<Capsule> {
        let [a, b] = capsule.ends;
        let [a, b] = [a, b].map(|end| self.place().inverse_transform_point_f32(end));
        Capsule::new(a, b, self.length(capsule.radius))
    }

    fn cast(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        options: &CastOptions,
    ) -> Option<(Capsule, [Vec3; 2], CastOptions)> {
        let in_model = |v: DVec3| self.place().inverse_transform_vector(v).as_vec3();
        let tolerance = options.tolerance.map(|metres| metres / self.place().scale);
        let options = CastOptions {
            tolerance,
            ..*options
        };
        Some((self.capsule(capsule)?, displacements.map(in_model), options))
    }

    /// A hit in the world. `origin` is where the query was made from, given the point: the distance is measured anew,
    /// since that in the hit starts from the origin's rounding to f32.
    fn hit(&self, hit: &SurfaceHit, origin: impl Fn(DVec3) -> DVec3) -> WorldHit {
        let point = self.place().transform_point_f32(hit.point);
        WorldHit {
            mesh: hit.mesh,
            triangle: hit.triangle,
            barycentric: hit.barycentric,
            point,
            normal: self.direction(hit.normal).normalize_or(DVec3::Y),
            distance: (origin(point) - point).length(),
            part: hit.part,
            tag: hit.tag,
        }
    }

    fn sweep_hit(&self, hit: &SweepHit) -> WorldSweepHit {
        let separation_normal = self.direction(hit.separation_normal).normalize_or(DVec3::Y);
        WorldSweepHit {
            hit: WorldHit {
                mesh: hit.mesh,
                triangle: hit.triangle,
                barycentric: hit.barycentric,
                point: self.place().transform_point_f32(hit.point),
                normal: self.direction(hit.normal).normalize_or(separation_normal),
                distance: hit.distance * self.place().scale,
                part: hit.part,
                tag: hit.tag,
            },
            time: hit.time,
            separation_normal,
            started_inside: hit.started_inside,
            undecided: hit.undecided,
        }
    }

    fn direction(&self, v: Vec3) -> DVec3 {
        self.place().rotation * v.as_dvec3()
    }
}
