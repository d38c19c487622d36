use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_math::{Quat, Vec3};
use bevy_shape::Ray3d;
use clamber_surface::geometry::{Similarity, WorldCapsule};
use clamber_surface::mesh::{PartId, SurfaceTag, TriangleId};
use clamber_surface::surface::{self, Motion, TargetMotion};
use glam::DVec3;

use crate::{PosedSurface, SurfaceAnchor};

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
///     if let Some(anchor) = hit.and_then(|hit| surfaces.anchor_at(&hit)) {
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
pub struct WorldHit {
    /// Whose skin: the entity with the [`PosedSurface`].
    pub entity: Entity,
    /// The point.
    pub point: Vec3,
    /// Outward unit normal of the triangle.
    pub normal: Vec3,
    /// From the ray's origin, the query's point, or the capsule's segment, metres.
    pub distance: f32,
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
pub struct WorldSweepHit {
    /// The contact, where it is at that time. Its normal points from the skin to what moves, its distance is that
    /// from the sphere's centre or the capsule's segment.
    pub hit: WorldHit,
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
    ) -> Option<WorldHit> {
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
        hits: &mut Vec<WorldHit>,
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
    ) -> Option<WorldHit> {
        self.nearest(filter, max_distance, |surface, max_distance| {
            surface
                .in_world()
                .closest_point(point.as_dvec3(), max_distance)
        })
    }

    /// Every triangle within a sphere, each with its own point nearest to the centre. `hits` is cleared first and
    /// keeps its memory.
    pub fn overlap_sphere(
        &self,
        center: Vec3,
        radius: f32,
        filter: &SurfaceFilter<'_>,
        hits: &mut Vec<WorldHit>,
    ) {
        self.overlap_capsule([center; 2], radius, filter, hits);
    }

    /// Every triangle within a capsule around a segment, each with its own point nearest to the segment. `hits` is
    /// cleared first and keeps its memory.
    pub fn overlap_capsule(
        &self,
        ends: [Vec3; 2],
        radius: f32,
        filter: &SurfaceFilter<'_>,
        hits: &mut Vec<WorldHit>,
    ) {
        let capsule = capsule(ends, radius);
        hits.clear();
        for (entity, surface) in self.seen(filter) {
            let space = surface.in_world();
            space.visit_overlap_capsule(&capsule, |hit| hits.push(world_hit(entity, &hit)));
        }
        hits.sort_unstable_by(by_distance_and_triangle);
    }

    /// The first contact of a sphere that moves by `motion` with all skin, which stands still, or moves over the last
    /// tick meanwhile.
    pub fn cast_sphere(
        &self,
        center: Vec3,
        radius: f32,
        motion: Vec3,
        target: TargetMotion,
        filter: &SurfaceFilter<'_>,
    ) -> Option<WorldSweepHit> {
        self.cast_capsule([center; 2], radius, [motion; 2], target, filter)
    }

    /// The first contact of a capsule whose ends each move by one of `motions` with all skin, which stands still, or moves
    /// over the last tick meanwhile.
    pub fn cast_capsule(
        &self,
        ends: [Vec3; 2],
        radius: f32,
        motions: [Vec3; 2],
        target: TargetMotion,
        filter: &SurfaceFilter<'_>,
    ) -> Option<WorldSweepHit> {
        let capsule = capsule(ends, radius);
        let motions = motions.map(|motion| motion.as_dvec3());
        let hits = self.seen(filter).filter_map(|(entity, surface)| {
            let hit = surface.in_world().cast_capsule(&capsule, motions, target)?;
            Some((hit.time, world_sweep_hit(entity, &hit)))
        });
        let earlier = hits.min_by(|(time, a), (other, b)| {
            let by_time = time.total_cmp(other);
            by_time.then_with(|| by_distance(&a.hit, &b.hit))
        });
        earlier.map(|(_, hit)| hit)
    }

    /// What sticks an entity to a hit's point, its +Y along the skin's outward normal. `None` if that surface or
    /// triangle is gone.
    pub fn anchor_at(&self, hit: &WorldHit) -> Option<SurfaceAnchor> {
        let outward = Quat::from_rotation_arc(Vec3::Y, hit.normal.try_normalize()?);
        self.anchor_with_rotation(hit, outward)
    }

    /// What sticks an entity to a hit's point, as it is turned in the world now: an arrow in flight.
    pub fn anchor_with_rotation(&self, hit: &WorldHit, rotation: Quat) -> Option<SurfaceAnchor> {
        let (entity, surface) = self.surfaces.get(hit.entity).ok()?;
        let anchor = surface.anchor(hit.triangle, hit.barycentric).ok()?;
        Some(SurfaceAnchor::new(entity, surface, anchor, rotation))
    }

    /// How an anchored point moves over the last tick of `dt` seconds, in the creature's model space, and where that is;
    /// `None` if its surface or triangle is gone. The velocity in the world is
    /// `world_from_model.transform_vector(motion.velocity.as_dvec3())`.
    pub fn motion(&self, anchor: &SurfaceAnchor, dt: f64) -> Option<(Motion, Similarity)> {
        let (_, surface) = self.surfaces.get(anchor.surface).ok()?;
        let motion = surface.motion(&anchor.anchor()?, dt).ok()?;
        Some((motion, *surface.world_from_model()))
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

    fn seen(&self, filter: &SurfaceFilter<'_>) -> impl Iterator<Item = (Entity, &PosedSurface)> {
        self.iter().filter(|(entity, _)| filter.sees(*entity))
    }

    /// The nearest that `find` finds up to a distance, which shrinks as something is found.
    fn nearest(
        &self,
        filter: &SurfaceFilter<'_>,
        max_distance: f32,
        find: impl Fn(&PosedSurface, f64) -> Option<surface::WorldHit>,
    ) -> Option<WorldHit> {
        let mut max_distance = f64::from(max_distance);
        let mut nearest: Option<(f64, WorldHit)> = None;
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

fn by_distance(a: &WorldHit, b: &WorldHit) -> std::cmp::Ordering {
    let by_distance = a.distance.total_cmp(&b.distance);
    by_distance.then_with(|| a.entity.cmp(&b.entity))
}

fn by_distance_and_triangle(a: &WorldHit, b: &WorldHit) -> std::cmp::Ordering {
    by_distance(a, b).then_with(|| a.triangle.cmp(&b.triangle))
}

/// Origin and direction.
pub(crate) fn in_f64(ray: Ray3d) -> (DVec3, DVec3) {
    (ray.origin.as_dvec3(), ray.direction.as_vec3().as_dvec3())
}

fn capsule(ends: [Vec3; 2], radius: f32) -> WorldCapsule {
    WorldCapsule {
        ends: ends.map(|end| end.as_dvec3()),
        radius: radius.into(),
    }
}

pub(crate) fn world_hit(entity: Entity, hit: &surface::WorldHit) -> WorldHit {
    WorldHit {
        entity,
        point: hit.point.as_vec3(),
        normal: hit.normal.as_vec3(),
        distance: hit.distance as f32,
        triangle: hit.triangle,
        barycentric: hit.barycentric,
        part: hit.part,
        tag: hit.tag,
    }
}

fn world_sweep_hit(entity: Entity, hit: &surface::WorldSweepHit) -> WorldSweepHit {
    WorldSweepHit {
        hit: WorldHit {
            normal: hit.away.as_vec3(),
            ..world_hit(entity, &hit.hit)
        },
        time: hit.time as f32,
        started_inside: hit.started_inside,
        undecided: hit.undecided,
    }
}
