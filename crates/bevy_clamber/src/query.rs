use bevy_ecs::prelude::*;
use bevy_ecs::query::{IterQueryData, QueryData, ReadOnlyQueryData};
use bevy_ecs::system::SystemParam;
use bevy_math::{Quat, Vec3};
use bevy_shape::Ray3d;
use clamber_surface::geometry::{Capsule, WorldCapsule};
use clamber_surface::mesh::{MeshId, PartId, SurfaceTag, TriangleId};
use clamber_surface::surface::{
    self, CastOptions, SkinnedSurface, SurfacePoint, TargetMotion, WorldMotion,
};
use glam::DVec3;

use crate::{AnchorError, DrawnSurface, PosedSurface, SurfaceAnchor, WorldOrigin};

/// Factor on the nearest distance so far that limits the search on the other surfaces. It keeps equal distances in
/// reach: converting a distance to a surface's units and back rounds to f32 once or twice each way.
const EQUAL: f64 = 1.0 + 8.0 * f32::EPSILON as f64;

/// A system parameter that queries all surfaces in world space, as posed in the last tick.
///
/// The nearest hit comes first; ties go to the smaller entity. Input that is not finite, and lengths that are negative,
/// find nothing; maximum distances may be infinite. It only reads, so systems with it can run in parallel.
///
/// ```
/// # use bevy_ecs::prelude::*;
/// # use bevy_math::{Dir3, Vec3};
/// # use bevy_shape::Ray3d;
/// # use bevy_clamber::prelude::*;
/// fn shoot(surfaces: SurfaceQuery, mut commands: Commands) {
///     let ray = Ray3d::new(Vec3::new(0.0, 1.0, 9.0), Dir3::NEG_Z);
///     let hit = surfaces.cast_ray(ray, 50.0, &SurfaceFilter::default());
///     // An arrow that stays on this point of skin as it moves.
///     if let Some(hit) = hit
///         && let Ok(anchor) = surfaces.anchor_at(&hit)
///     {
///         commands.spawn(anchor);
///     }
/// }
/// ```
///
/// [`DrawnSurfaceQuery`] asks the same of the skin as the last frame drew it.
#[derive(SystemParam)]
pub struct SurfaceQuery<'w, 's, P: SurfacePose = TickPose> {
    surfaces: Query<'w, 's, (Entity, <P as SurfacePose>::Data)>,
    origin: Res<'w, WorldOrigin>,
}

/// A [`SurfaceQuery`] on the skin as the last frame drew it: for things that have to fit the picture, such as cameras,
/// lasers and cursors. Its hits can be anchored.
///
/// In `PostUpdate`, order systems with it after [`ClamberSystems::Sample`](crate::ClamberSystems::Sample): they then
/// see the pose of this frame.
pub type DrawnSurfaceQuery<'w, 's> = SurfaceQuery<'w, 's, DrawnPose>;

/// The pose in which a [`SurfaceQuery`] sees skin: [`TickPose`] or [`DrawnPose`].
pub trait SurfacePose: sealed::Sealed + 'static {
    /// The components that are read.
    type Data: IterQueryData + ReadOnlyQueryData + 'static;

    /// The surface in that pose, if it has one.
    fn surface<'w, 's>(data: <Self::Data as QueryData>::Item<'w, 's>)
    -> Option<&'w SkinnedSurface>;
}

/// The pose of the last tick.
#[derive(Clone, Copy, Debug)]
pub struct TickPose;

/// The pose of the last frame.
#[derive(Clone, Copy, Debug)]
pub struct DrawnPose;

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::TickPose {}
    impl Sealed for super::DrawnPose {}
}

impl SurfacePose for TickPose {
    type Data = &'static PosedSurface;

    fn surface<'w, 's>(
        surface: <Self::Data as QueryData>::Item<'w, 's>,
    ) -> Option<&'w SkinnedSurface> {
        surface.is_placed().then_some(surface)
    }
}

impl SurfacePose for DrawnPose {
    type Data = (&'static PosedSurface, &'static DrawnSurface);

    fn surface<'w, 's>(
        (surface, drawn): <Self::Data as QueryData>::Item<'w, 's>,
    ) -> Option<&'w SkinnedSurface> {
        drawn.pose(surface)
    }
}

/// Selects the surfaces that a query sees. Default: all, hidden ones as well. To leave out what is not shown:
///
/// ```
/// # use bevy_camera::visibility::InheritedVisibility;
/// # use bevy_ecs::prelude::*;
/// # use bevy_math::{Dir3, Vec3};
/// # use bevy_shape::Ray3d;
/// # use bevy_clamber::prelude::*;
/// fn shoot(surfaces: SurfaceQuery, visibilities: Query<&InheritedVisibility>) {
///     let is_shown = |entity| visibilities.get(entity).is_ok_and(|visibility| visibility.get());
///     let ray = Ray3d::new(Vec3::new(0.0, 1.0, 9.0), Dir3::NEG_Z);
///     let hit = surfaces.cast_ray(ray, 50.0, &SurfaceFilter::only(&is_shown));
/// }
/// ```
#[derive(Clone, Copy, Default)]
pub struct SurfaceFilter<'a> {
    except: &'a [Entity],
    wanted: Option<&'a (dyn Fn(Entity) -> bool + Sync)>,
}

impl<'a> SurfaceFilter<'a> {
    /// Selects all surfaces that are not on these entities.
    pub fn except(entities: &'a [Entity]) -> Self {
        Self {
            except: entities,
            ..Self::default()
        }
    }

    /// Selects the surfaces of the entities for which a function returns true.
    pub fn only(wanted: &'a (dyn Fn(Entity) -> bool + Sync)) -> Self {
        Self {
            wanted: Some(wanted),
            ..Self::default()
        }
    }

    fn sees(&self, entity: Entity) -> bool {
        !self.except.contains(&entity) && self.wanted.is_none_or(|wanted| wanted(entity))
    }
}

/// A point of skin that a query found, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct EntityHit {
    /// The entity with the [`PosedSurface`] that was hit.
    pub entity: Entity,
    /// The point.
    pub point: Vec3,
    /// Outward unit normal of the triangle. If it has collapsed, the direction to the ray's origin, the query's point,
    /// or the capsule's segment.
    pub normal: Vec3,
    /// Distance from the ray's origin, the query's point, or the capsule's segment, metres.
    pub distance: f32,
    /// The collider's mesh.
    pub mesh: MeshId,
    /// The collider's triangle; [`PosedSurface::source_triangle`] gives its index in the mesh asset.
    pub triangle: TriangleId,
    /// Weights of the triangle's three corners, in the order of
    /// [`ColliderMesh::triangles`](clamber_surface::mesh::ColliderMesh::triangles). They are not negative, and add up
    /// to 1, up to rounding.
    pub barycentric: [f32; 3],
    /// The part of the collider: the triangles that one joint moves most.
    pub part: PartId,
    /// The triangle's tag.
    pub tag: SurfaceTag,
}

/// The first contact of a moving capsule with skin, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct EntitySweepHit {
    /// The contact at `fraction` of the motion. Its distance is from the capsule's segment.
    pub hit: EntityHit,
    /// Unit vector from the point to the capsule's segment; if the segment touches the triangle, the triangle's normal.
    pub separation_normal: Vec3,
    /// Fraction of the motion, and so of each displacement, until the contact, 0..=1.
    pub fraction: f32,
    /// True if the capsule overlaps the skin at the start; `fraction` is 0 then.
    pub started_inside: bool,
    /// The solver could not certify the distance within the tolerance. There is no contact before `fraction`.
    pub undecided: bool,
}

impl<P: SurfacePose> SurfaceQuery<'_, '_, P> {
    /// The first point of skin that a ray hits, from either side, up to `max_distance` metres.
    pub fn cast_ray(
        &self,
        ray: Ray3d,
        max_distance: f32,
        filter: &SurfaceFilter<'_>,
    ) -> Option<EntityHit> {
        let (origin, along) = in_f64(ray, self.origin.0);
        self.nearest(filter, max_distance, |surface, max_distance| {
            surface.in_world().cast_ray(origin, along, max_distance)
        })
    }

    /// True if a ray hits any skin, from either side, up to `max_distance` metres; stops at the first hit that it
    /// finds.
    pub fn intersects_ray(
        &self,
        ray: Ray3d,
        max_distance: f32,
        filter: &SurfaceFilter<'_>,
    ) -> bool {
        let (origin, along) = in_f64(ray, self.origin.0);
        self.seen(filter).any(|(_, surface)| {
            let space = surface.in_world();
            space.intersects_ray(origin, along, max_distance.into())
        })
    }

    /// Finds every triangle that a ray hits, from either side, up to `max_distance` metres, the nearest first. `hits`
    /// is cleared before and keeps its memory.
    pub fn cast_ray_all(
        &self,
        ray: Ray3d,
        max_distance: f32,
        filter: &SurfaceFilter<'_>,
        hits: &mut Vec<EntityHit>,
    ) {
        let (origin, along) = in_f64(ray, self.origin.0);
        let mut found = Vec::new();
        hits.clear();
        for (entity, surface) in self.seen(filter) {
            let space = surface.in_world();
            space.cast_ray_all(origin, along, max_distance.into(), &mut found);
            hits.extend(found.drain(..).map(|hit| self.hit(entity, &hit)));
        }
        // A stable sort keeps the core's order within a surface.
        hits.sort_by(by_distance);
    }

    /// The point of skin nearest to a point, up to `max_distance` metres.
    pub fn closest_point(
        &self,
        point: Vec3,
        max_distance: f32,
        filter: &SurfaceFilter<'_>,
    ) -> Option<EntityHit> {
        self.nearest(filter, max_distance, |surface, max_distance| {
            surface
                .in_world()
                .closest_point(self.origin.0 + point.as_dvec3(), max_distance)
        })
    }

    /// Finds every triangle that overlaps a capsule, each with its own point nearest to the capsule's segment. `hits`
    /// is cleared first and keeps its memory.
    pub fn overlap_capsule(
        &self,
        capsule: &Capsule,
        filter: &SurfaceFilter<'_>,
        hits: &mut Vec<EntityHit>,
    ) {
        let capsule = WorldCapsule::from(capsule).moved(self.origin.0);
        hits.clear();
        for (entity, surface) in self.seen(filter) {
            let space = surface.in_world();
            space.visit_overlap_capsule(&capsule, |hit| hits.push(self.hit(entity, &hit)));
        }
        hits.sort_unstable_by(by_distance_and_triangle);
    }

    /// The first contact of a moving capsule, or ball, with skin.
    ///
    /// Each end of the capsule moves straight by its own displacement, metres. The skin stands still meanwhile, or
    /// moves over the last tick, as `target` says. Among equal fractions, the smaller distance wins, then the smaller
    /// entity.
    pub fn cast_capsule(
        &self,
        capsule: &Capsule,
        displacements: [Vec3; 2],
        target: TargetMotion,
        filter: &SurfaceFilter<'_>,
    ) -> Option<EntitySweepHit> {
        let capsule = WorldCapsule::from(capsule).moved(self.origin.0);
        let displacements = displacements.map(|displacement| displacement.as_dvec3());
        // The tolerance of a cast at an obstacle, so that a climber and its game get the same contact.
        let options = CastOptions::from(target).with_tolerance(capsule.sweep_tolerance());
        let hits = self.seen(filter).filter_map(|(entity, surface)| {
            let space = surface.in_world();
            let hit = space.cast_capsule(&capsule, displacements, &options)?;
            let found = EntitySweepHit {
                hit: self.hit(entity, &hit.hit),
                separation_normal: hit.separation_normal.as_vec3(),
                fraction: hit.fraction as f32,
                started_inside: hit.started_inside,
                undecided: hit.undecided,
            };
            Some((hit.fraction, found))
        });
        let earlier = hits.min_by(|(fraction, a), (other, b)| {
            let by_fraction = fraction.total_cmp(other);
            by_fraction.then_with(|| by_distance(&a.hit, &b.hit))
        });
        earlier.map(|(_, hit)| hit)
    }

    /// An anchor that attaches an entity to a hit's point, its +Y along the skin's outward normal.
    ///
    /// # Errors
    /// [`AnchorError`] if the hit's surface is gone, its triangle was removed, or the surface has another mesh by now.
    pub fn anchor_at(&self, hit: &EntityHit) -> Result<SurfaceAnchor, AnchorError> {
        let normal = hit.normal.try_normalize().unwrap_or(Vec3::Y);
        self.anchor_with_rotation(hit, Quat::from_rotation_arc(Vec3::Y, normal))
    }

    /// An anchor that attaches an entity to a hit's point with this rotation in world space, such as an arrow's in
    /// flight.
    ///
    /// # Errors
    /// As [`SurfaceQuery::anchor_at`].
    pub fn anchor_with_rotation(
        &self,
        hit: &EntityHit,
        rotation: Quat,
    ) -> Result<SurfaceAnchor, AnchorError> {
        let surface = self.surface(hit.entity)?;
        let anchor = surface.anchor_at(SurfacePoint {
            mesh: hit.mesh,
            triangle: hit.triangle,
            barycentric: hit.barycentric,
        })?;
        Ok(SurfaceAnchor::new(hit.entity, surface, anchor, rotation))
    }

    /// The motion of an anchored point over the last tick, which lasted `dt` seconds, in world space.
    ///
    /// # Errors
    /// [`AnchorError`] as for [`SurfaceQuery::anchor_at`], and if `dt` is not positive and finite, or too short for
    /// velocities in f32.
    pub fn motion(&self, anchor: &SurfaceAnchor, dt: f64) -> Result<WorldMotion, AnchorError> {
        let surface = self.surface(anchor.surface)?;
        Ok(surface.in_world().motion(&anchor.anchor()?, dt)?)
    }

    fn surface(&self, entity: Entity) -> Result<&SkinnedSurface, AnchorError> {
        let found = self.surfaces.get(entity).ok();
        let found = found.and_then(|(_, data)| P::surface(data));
        found.ok_or(AnchorError::NoSurface(entity))
    }

    fn hit(&self, entity: Entity, hit: &surface::SurfaceHit<DVec3>) -> EntityHit {
        world_hit(entity, hit, self.origin.0)
    }

    fn seen(&self, filter: &SurfaceFilter<'_>) -> impl Iterator<Item = (Entity, &SkinnedSurface)> {
        let seen = self
            .surfaces
            .iter()
            .filter(|(entity, _)| filter.sees(*entity));
        seen.filter_map(|(entity, data)| Some((entity, P::surface(data)?)))
    }

    /// The nearest hit of `find` on any surface. The maximum distance shrinks with each nearer hit.
    fn nearest(
        &self,
        filter: &SurfaceFilter<'_>,
        max_distance: f32,
        find: impl Fn(&SkinnedSurface, f64) -> Option<surface::SurfaceHit<DVec3>>,
    ) -> Option<EntityHit> {
        let mut max_distance = f64::from(max_distance);
        let mut nearest: Option<(f64, EntityHit)> = None;
        for (entity, surface) in self.seen(filter) {
            let Some(hit) = find(surface, max_distance) else {
                continue;
            };
            let nearer = nearest.is_none_or(|(distance, nearest)| {
                let by_distance = hit.distance.total_cmp(&distance);
                by_distance.then(entity.cmp(&nearest.entity)).is_lt()
            });
            if nearer {
                let least = f64::from(f32::MIN_POSITIVE);
                max_distance = max_distance.min(hit.distance * EQUAL + least);
                nearest = Some((hit.distance, self.hit(entity, &hit)));
            }
        }
        nearest.map(|(_, hit)| hit)
    }
}

impl SurfaceQuery<'_, '_> {
    /// The surface of an entity; `None` if the entity has no surface, or if that has not had a valid pose yet.
    pub fn get(&self, entity: Entity) -> Option<&PosedSurface> {
        let (_, surface) = self.surfaces.get(entity).ok()?;
        surface.is_placed().then_some(surface)
    }

    /// All surfaces that have had a valid pose, in no promised order.
    pub fn iter(&self) -> impl Iterator<Item = (Entity, &PosedSurface)> {
        let all = self.surfaces.iter();
        all.filter(|(_, surface)| surface.is_placed())
    }
}

impl DrawnSurfaceQuery<'_, '_> {
    /// The surface of an entity; `None` if the entity has no surface, or if that cannot take the pose that was drawn.
    pub fn get(&self, entity: Entity) -> Option<&SkinnedSurface> {
        self.surface(entity).ok()
    }
}

fn by_distance(a: &EntityHit, b: &EntityHit) -> std::cmp::Ordering {
    let by_distance = a.distance.total_cmp(&b.distance);
    by_distance.then_with(|| a.entity.cmp(&b.entity))
}

fn by_distance_and_triangle(a: &EntityHit, b: &EntityHit) -> std::cmp::Ordering {
    by_distance(a, b).then_with(|| a.triangle.cmp(&b.triangle))
}

/// Origin and direction of a ray, in world space.
pub(crate) fn in_f64(ray: Ray3d, origin: DVec3) -> (DVec3, DVec3) {
    (
        origin + ray.origin.as_dvec3(),
        ray.direction.as_vec3().as_dvec3(),
    )
}

/// A hit relative to Bevy's origin.
pub(crate) fn world_hit(
    entity: Entity,
    hit: &surface::SurfaceHit<DVec3>,
    origin: DVec3,
) -> EntityHit {
    EntityHit {
        entity,
        point: (hit.point - origin).as_vec3(),
        normal: hit.normal.as_vec3(),
        distance: hit.distance as f32,
        mesh: hit.mesh,
        triangle: hit.triangle,
        barycentric: hit.barycentric,
        part: hit.part,
        tag: hit.tag,
    }
}
