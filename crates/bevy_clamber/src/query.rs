use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_math::{Quat, Vec3};
use bevy_shape::Ray3d;
use clamber_surface::geometry::{Capsule, WorldCapsule};
use clamber_surface::mesh::{MeshId, PartId, SurfaceTag, TriangleId};
use clamber_surface::surface::{self, CastOptions, SurfacePoint, TargetMotion, WorldMotion};
use glam::DVec3;

use crate::{AnchorError, PosedSurface, SurfaceAnchor};

/// How far, as a factor, to look for what is no farther, in the units of another surface: each way rounds to f32
/// once or twice.
const EQUAL: f64 = 1.0 + 8.0 * f32::EPSILON as f64;

/// All surfaces of the world, in world space, as posed in the last tick.
///
/// Nearest first; of equal distances the smaller entity. What is not finite, or negative where it must not be,
/// finds nothing; distances may be infinite. Reads only, so systems with it run in parallel.
///
/// ```
/// # use bevy_ecs::prelude::*;
/// # use bevy_math::{Dir3, Vec3};
/// # use bevy_shape::Ray3d;
/// # use bevy_clamber::prelude::*;
/// fn shoot(surfaces: SurfaceQuery, mut commands: Commands) {
///     let ray = Ray3d::new(Vec3::new(0.0, 1.0, 9.0), Dir3::NEG_Z);
///     let hit = surfaces.cast_ray(ray, 50.0, &SurfaceFilter::default());
///     // An arrow that sticks there, whatever the skin does.
///     if let Some(hit) = hit
///         && let Ok(anchor) = surfaces.anchor_at(&hit)
///     {
///         commands.spawn(anchor);
///     }
/// }
/// ```
#[derive(SystemParam)]
pub struct SurfaceQuery<'w, 's> {
    surfaces: Query<'w, 's, (Entity, &'static PosedSurface)>,
}

/// Which surfaces a query sees. Default: all.
#[derive(Clone, Copy, Default)]
pub struct SurfaceFilter<'a> {
    except: &'a [Entity],
    wanted: Option<&'a (dyn Fn(Entity) -> bool + Sync)>,
}

impl<'a> SurfaceFilter<'a> {
    /// All but these.
    pub fn except(entities: &'a [Entity]) -> Self {
        Self {
            except: entities,
            ..Self::default()
        }
    }

    /// Those that a function says yes to.
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
    /// Whose skin: the entity with the [`PosedSurface`].
    pub entity: Entity,
    /// The point.
    pub point: Vec3,
    /// Outward unit normal of the triangle.
    pub normal: Vec3,
    /// From the ray's origin, the query's point, or the capsule's segment, metres.
    pub distance: f32,
    /// The collider's mesh.
    pub mesh: MeshId,
    /// The collider's triangle; [`PosedSurface::source_triangle`] tells the mesh asset's.
    pub triangle: TriangleId,
    /// Weights of its corners: not negative, sum 1.
    pub barycentric: [f32; 3],
    /// The part of the collider: the triangles that one joint moves most.
    pub part: PartId,
    /// What it is made of.
    pub tag: SurfaceTag,
}

/// The first contact of something that moves with skin, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct EntitySweepHit {
    /// The contact, where it is at that time; its distance is from the capsule's segment.
    pub hit: EntityHit,
    /// Unit vector from the point to the capsule's segment; where that lies on the triangle itself, its normal.
    pub separation_normal: Vec3,
    /// Share of the motion that was made, 0 to 1.
    pub time: f32,
    /// They overlap at the start already; the time is 0.
    pub started_inside: bool,
    /// They do not touch before `time`, but how near they are then is not certain.
    pub undecided: bool,
}

impl SurfaceQuery<'_, '_> {
    /// The first point along a ray, from either side of the skin.
    pub fn cast_ray(
        &self,
        ray: Ray3d,
        max_distance: f32,
        filter: &SurfaceFilter<'_>,
    ) -> Option<EntityHit> {
        let (origin, along) = in_f64(ray);
        self.nearest(filter, max_distance, |surface, max_distance| {
            surface.in_world().cast_ray(origin, along, max_distance)
        })
    }

    /// True if a ray meets any skin; stops at the first that it finds.
    pub fn intersects_ray(
        &self,
        ray: Ray3d,
        max_distance: f32,
        filter: &SurfaceFilter<'_>,
    ) -> bool {
        let (origin, along) = in_f64(ray);
        self.seen(filter).any(|(_, surface)| {
            let space = surface.in_world();
            space.intersects_ray(origin, along, max_distance.into())
        })
    }

    /// Every triangle along a ray. `hits` is cleared first and keeps its memory.
    pub fn cast_ray_all(
        &self,
        ray: Ray3d,
        max_distance: f32,
        filter: &SurfaceFilter<'_>,
        hits: &mut Vec<EntityHit>,
    ) {
        let (origin, along) = in_f64(ray);
        let mut found = Vec::new();
        hits.clear();
        for (entity, surface) in self.seen(filter) {
            let space = surface.in_world();
            space.cast_ray_all(origin, along, max_distance.into(), &mut found);
            hits.extend(found.drain(..).map(|hit| world_hit(entity, &hit)));
        }
        // Stable: within a surface the core's order stands.
        hits.sort_by(by_distance);
    }

    /// The skin nearest to a point.
    pub fn closest_point(
        &self,
        point: Vec3,
        max_distance: f32,
        filter: &SurfaceFilter<'_>,
    ) -> Option<EntityHit> {
        self.nearest(filter, max_distance, |surface, max_distance| {
            surface
                .in_world()
                .closest_point(point.as_dvec3(), max_distance)
        })
    }

    /// Every triangle within a capsule, each with its own point nearest to the capsule's segment. `hits` is
    /// cleared first and keeps its memory.
    pub fn overlap_capsule(
        &self,
        capsule: &Capsule,
        filter: &SurfaceFilter<'_>,
        hits: &mut Vec<EntityHit>,
    ) {
        let capsule = WorldCapsule::from(capsule);
        hits.clear();
        for (entity, surface) in self.seen(filter) {
            let space = surface.in_world();
            space.visit_overlap_capsule(&capsule, |hit| hits.push(world_hit(entity, &hit)));
        }
        hits.sort_unstable_by(by_distance_and_triangle);
    }

    /// The first contact of a capsule, or a ball, each of whose ends goes straight by its own displacement, with all skin,
    /// which stands still, or moves over the last tick meanwhile.
    pub fn cast_capsule(
        &self,
        capsule: &Capsule,
        displacements: [Vec3; 2],
        target: TargetMotion,
        filter: &SurfaceFilter<'_>,
    ) -> Option<EntitySweepHit> {
        let capsule = WorldCapsule::from(capsule);
        let displacements = displacements.map(|displacement| displacement.as_dvec3());
        // As an obstacle does, so that a climber and its game see the same.
        let options = CastOptions::from(target).with_tolerance(capsule.sweep_tolerance());
        let hits = self.seen(filter).filter_map(|(entity, surface)| {
            let space = surface.in_world();
            let hit = space.cast_capsule(&capsule, displacements, &options)?;
            Some((hit.time, world_sweep_hit(entity, &hit)))
        });
        let earlier = hits.min_by(|(time, a), (other, b)| {
            let by_time = time.total_cmp(other);
            by_time.then_with(|| by_distance(&a.hit, &b.hit))
        });
        earlier.map(|(_, hit)| hit)
    }

    /// What sticks an entity to a hit's point, its +Y along the skin's outward normal.
    ///
    /// # Errors
    /// [`AnchorError`], for a hit of a surface that is gone, of a triangle that was removed, or of another mesh than the
    /// surface has now.
    pub fn anchor_at(&self, hit: &EntityHit) -> Result<SurfaceAnchor, AnchorError> {
        let normal = hit.normal.try_normalize().unwrap_or(Vec3::Y);
        self.anchor_with_rotation(hit, Quat::from_rotation_arc(Vec3::Y, normal))
    }

    /// What sticks an entity to a hit's point, as it is turned in the world now: an arrow in flight.
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

    /// How an anchored point moves over the last tick of `dt` seconds, in world space.
    ///
    /// # Errors
    /// [`AnchorError`], as for [`SurfaceQuery::anchor_at`], and for a `dt` that is not positive and finite.
    pub fn motion(&self, anchor: &SurfaceAnchor, dt: f64) -> Result<WorldMotion, AnchorError> {
        let surface = self.surface(anchor.surface)?;
        Ok(surface.in_world().motion(&anchor.anchor()?, dt)?)
    }

    /// One surface; `None` while it has had no pose that it could take, and is nowhere.
    pub fn get(&self, entity: Entity) -> Option<&PosedSurface> {
        let (_, surface) = self.surfaces.get(entity).ok()?;
        surface.is_placed().then_some(surface)
    }

    /// All surfaces that are somewhere, in no promised order.
    pub fn iter(&self) -> impl Iterator<Item = (Entity, &PosedSurface)> {
        let all = self.surfaces.iter();
        all.filter(|(_, surface)| surface.is_placed())
    }

    fn surface(&self, entity: Entity) -> Result<&PosedSurface, AnchorError> {
        let found = self.surfaces.get(entity);
        let (_, surface) = found.map_err(|_| AnchorError::NoSurface(entity))?;
        Ok(surface)
    }

    fn seen(&self, filter: &SurfaceFilter<'_>) -> impl Iterator<Item = (Entity, &PosedSurface)> {
        self.iter().filter(|(entity, _)| filter.sees(*entity))
    }

    /// The nearest that `find` finds up to a distance, which shrinks as something is found.
    fn nearest(
        &self,
        filter: &SurfaceFilter<'_>,
        max_distance: f32,
        find: impl Fn(&PosedSurface, f64) -> Option<surface::WorldHit>,
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
                nearest = Some((hit.distance, world_hit(entity, &hit)));
            }
        }
        nearest.map(|(_, hit)| hit)
    }
}

fn by_distance(a: &EntityHit, b: &EntityHit) -> std::cmp::Ordering {
    let by_distance = a.distance.total_cmp(&b.distance);
    by_distance.then_with(|| a.entity.cmp(&b.entity))
}

fn by_distance_and_triangle(a: &EntityHit, b: &EntityHit) -> std::cmp::Ordering {
    by_distance(a, b).then_with(|| a.triangle.cmp(&b.triangle))
}

/// Origin and direction.
pub(crate) fn in_f64(ray: Ray3d) -> (DVec3, DVec3) {
    (ray.origin.as_dvec3(), ray.direction.as_vec3().as_dvec3())
}

pub(crate) fn world_hit(entity: Entity, hit: &surface::WorldHit) -> EntityHit {
    EntityHit {
        entity,
        point: hit.point.as_vec3(),
        normal: hit.normal.as_vec3(),
        distance: hit.distance as f32,
        mesh: hit.mesh,
        triangle: hit.triangle,
        barycentric: hit.barycentric,
        part: hit.part,
        tag: hit.tag,
    }
}

fn world_sweep_hit(entity: Entity, hit: &surface::WorldSweepHit) -> EntitySweepHit {
    EntitySweepHit {
        hit: world_hit(entity, &hit.hit),
        separation_normal: hit.separation_normal.as_vec3(),
        time: hit.time as f32,
        started_inside: hit.started_inside,
        undecided: hit.undecided,
    }
}
