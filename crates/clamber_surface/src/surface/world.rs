use glam::{DQuat, DVec3, Vec3};

use super::motion::Motion;
use super::{Anchor, SkinnedSurface, SurfaceError, SurfacePoint};
use crate::geometry::{Capsule, Ray, Similarity, WorldCapsule};
use crate::query::{CastOptions, SurfaceHit, SweepHit};

/// A view of a surface in world space, in f64: the queries of [`ModelSpace`](super::ModelSpace) at the creature's place
/// in the world. [`SkinnedSurface::in_world`] returns it.
///
/// Queries are transformed to model space and their results back, so a creature far from the world's origin is as exact
/// as one near it. Ray lengths and the distances of closest-point queries may be infinite. Queries find nothing for an
/// infinite radius or displacement, for a length that is NaN or negative, or for a point or direction that is not
/// finite.
#[derive(Clone, Copy, Debug)]
pub struct WorldSpace<'a> {
    surface: &'a SkinnedSurface,
}

/// The motion of an anchor over one tick, in world space. Velocities are differences over the tick's length, never
/// instantaneous.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WorldMotion {
    /// The point's current position.
    pub position: DVec3,
    /// The point's position a tick ago.
    pub previous_position: DVec3,
    /// Displacement over the tick, metres per second. Like both positions, it is rounded to f32 in model space,
    /// independently of them, so it is near their difference over the tick's length but not equal to it.
    pub velocity: DVec3,
    /// Rotation of the material around the point from rest to now, in world space: [`Motion::frame`] followed by the
    /// surface's own rotation.
    pub frame: DQuat,
    /// Rotation from the frame of a tick ago to the current one, by at most half a turn: axis times radians per second.
    pub angular_velocity: DVec3,
    /// Outward unit normal of the triangle now. If the triangle has collapsed: the normal that follows from `frame`.
    pub normal: DVec3,
    /// True if the triangle has collapsed now, so `frame` and `normal` are the last known ones. A sliver without an
    /// orientation even at rest turns with its joint, and does not count.
    pub collapsed: bool,
    /// Area now over area a tick ago, at most `f32::MAX`; 1 if the triangle was collapsed a tick ago.
    pub area_ratio: f32,
    /// Principal stretches since a tick ago, length now over length then, larger first, at most `f32::MAX`; both 1 if
    /// the triangle was collapsed a tick ago.
    pub stretches: [f32; 2],
}

/// The current and previous position of a material point, in world space: the part of its motion that needs no frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldPath {
    /// The point's current position.
    pub position: DVec3,
    /// The point's position a tick ago.
    pub previous_position: DVec3,
    /// Displacement over the tick divided by the tick's length, metres per second; see [`WorldMotion::velocity`].
    pub velocity: DVec3,
}

impl WorldPath {
    /// True if all numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.position.is_finite() && self.previous_position.is_finite() && self.velocity.is_finite()
    }
}

impl SkinnedSurface {
    /// A view of the surface in world space, with its queries.
    pub fn in_world(&self) -> WorldSpace<'_> {
        WorldSpace { surface: self }
    }
}

impl WorldSpace<'_> {
    /// The first triangle that a ray meets, from either side, up to `max_distance` metres. `direction` may have any
    /// length but zero; distances along it are in metres.
    pub fn cast_ray(
        &self,
        origin: DVec3,
        direction: DVec3,
        max_distance: f64,
    ) -> Option<SurfaceHit<DVec3>> {
        let ray = self.ray(origin, direction)?;
        let hit = self
            .surface
            .in_model()
            .cast_ray(&ray, self.length(max_distance))?;
        Some(self.hit(&hit, |_| origin))
    }

    /// True if a ray meets any triangle, from either side, up to `max_distance` metres.
    pub fn intersects_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> bool {
        self.ray(origin, direction).is_some_and(|ray| {
            let length = self.length(max_distance);
            self.surface.in_model().intersects_ray(&ray, length)
        })
    }

    /// Finds all triangles that a ray meets, sorted by distance in model space, then by triangle id. The first is the
    /// hit of [`WorldSpace::cast_ray`]. `hits` is cleared first.
    pub fn cast_ray_all(
        &self,
        origin: DVec3,
        direction: DVec3,
        max_distance: f64,
        hits: &mut Vec<SurfaceHit<DVec3>>,
    ) {
        hits.clear();
        if let Some(ray) = self.ray(origin, direction) {
            // Keeps the order of the model's distances, so that the first hit is the one of `cast_ray`.
            let (length, mut found) = (self.length(max_distance), Vec::new());
            let space = self.surface.in_model();
            space.cast_ray_all(&ray, length, &mut found);
            hits.extend(found.iter().map(|hit| self.hit(hit, |_| origin)));
        }
    }

    /// The material point nearest to `point`, at most `max_distance` metres away.
    pub fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<SurfaceHit<DVec3>> {
        let local = self.place().inverse_transform_point_f32(point);
        let hit = self
            .surface
            .in_model()
            .closest_point(local, self.length(max_distance))?;
        Some(self.hit(&hit, |_| point))
    }

    /// Calls `visit` with every triangle within a capsule, each with its point closest to the capsule's segment. The
    /// order is unspecified.
    pub fn visit_overlap_capsule(
        &self,
        capsule: &WorldCapsule,
        mut visit: impl FnMut(SurfaceHit<DVec3>),
    ) {
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

    /// The material point nearest to a capsule's segment, at most `max_distance` metres away from the capsule.
    pub fn closest_to_capsule(
        &self,
        capsule: &WorldCapsule,
        max_distance: f64,
    ) -> Option<SurfaceHit<DVec3>> {
        let (local, space) = (self.capsule(capsule)?, self.surface.in_model());
        let found = space.closest_to_capsule(&local, self.length(max_distance))?;
        Some(self.hit(&found, |point| capsule.nearest_on_axis(point)))
    }

    /// True if a point is inside the surface: see [`ModelSpace::is_inside`](super::ModelSpace::is_inside).
    pub fn is_inside(&self, point: DVec3) -> bool {
        let local = self.place().inverse_transform_point_f32(point);
        self.surface.in_model().is_inside(local)
    }

    /// The first contact of a moving capsule with skin that stands still, or that moves over the tick meanwhile. Each
    /// end of the capsule moves straight by one of `displacements`. This is
    /// [`ModelSpace::cast_capsule`](super::ModelSpace::cast_capsule) with displacements and tolerance in metres.
    pub fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        options: &CastOptions,
    ) -> Option<SweepHit<DVec3>> {
        let (local, displacements, options) = self.cast(capsule, displacements, options)?;
        let space = self.surface.in_model();
        let hit = space.cast_capsule(&local, displacements, &options)?;
        Some(self.sweep_hit(&hit))
    }

    /// [`WorldSpace::cast_capsule`] among the contacts that `counts` accepts. `counts` is called, in any order, with
    /// the contact of each triangle that could be the first; a contact for which it returns false is skipped.
    pub fn cast_capsule_where(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        options: &CastOptions,
        counts: &mut dyn FnMut(&SweepHit<DVec3>) -> bool,
    ) -> Option<SweepHit<DVec3>> {
        let (local, displacements, options) = self.cast(capsule, displacements, options)?;
        let mut counts = |hit: &SweepHit| counts(&self.sweep_hit(hit));
        let space = self.surface.in_model();
        let hit = space.cast_capsule_where(&local, displacements, &options, &mut counts)?;
        Some(self.sweep_hit(&hit))
    }

    /// The motion of an anchor over a tick of `dt` seconds, in world space. Skins the triangle's three vertices.
    ///
    /// # Errors
    /// As [`ModelSpace::motion`](super::ModelSpace::motion).
    pub fn motion(&self, anchor: &Anchor, dt: f64) -> Result<WorldMotion, SurfaceError> {
        let motion = self.surface.in_model().motion(anchor, dt)?;
        Ok(self.motion_of(&motion))
    }

    /// The positions of a point now and a tick of `dt` seconds ago, and its velocity: the results of
    /// [`WorldSpace::motion`], for a fraction of the time.
    ///
    /// # Errors
    /// As [`ModelSpace::path`](super::ModelSpace::path).
    pub fn path(&self, point: impl Into<SurfacePoint>, dt: f64) -> Result<WorldPath, SurfaceError> {
        let path = self.surface.in_model().path(point, dt)?;
        let world_from_model = self.place();
        Ok(WorldPath {
            position: world_from_model.transform_point_f32(path.position),
            previous_position: world_from_model.transform_point_f32(path.previous_position),
            velocity: world_from_model.transform_vector(path.velocity.as_dvec3()),
        })
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

    /// Converts a length in metres to model units.
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

    /// Transforms a hit to world space. `origin` returns the query's origin for a point. The distance is measured again
    /// in world space, since the hit's own distance starts from an origin that was rounded to f32.
    fn hit(&self, hit: &SurfaceHit, origin: impl Fn(DVec3) -> DVec3) -> SurfaceHit<DVec3> {
        let point = self.place().transform_point_f32(hit.point);
        SurfaceHit {
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

    fn sweep_hit(&self, sweep: &SweepHit) -> SweepHit<DVec3> {
        let hit = &sweep.hit;
        let separation_normal = self
            .direction(sweep.separation_normal)
            .normalize_or(DVec3::Y);
        SweepHit {
            hit: SurfaceHit {
                mesh: hit.mesh,
                triangle: hit.triangle,
                barycentric: hit.barycentric,
                point: self.place().transform_point_f32(hit.point),
                normal: self.direction(hit.normal).normalize_or(separation_normal),
                distance: hit.distance * self.place().scale,
                part: hit.part,
                tag: hit.tag,
            },
            fraction: sweep.fraction,
            separation_normal,
            started_inside: sweep.started_inside,
            undecided: sweep.undecided,
        }
    }

    fn direction(&self, v: Vec3) -> DVec3 {
        self.place().rotation * v.as_dvec3()
    }
}
