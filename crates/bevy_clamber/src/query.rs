use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_math::{Quat, Vec3};
use bevy_shape::Ray3d;
use clamber_surface::geometry::{Capsule, Ray, Similarity, Sphere};
use clamber_surface::mesh::{PartId, SurfaceTag, TriangleId};
use clamber_surface::surface::{Motion, SkinnedSurface, SurfaceHit, SweepHit, TOLERANCE};

use crate::{PosedSurface, SurfaceAnchor};

/// How far, as a factor, to look for what is no farther, in the units of another surface: each way rounds to f32
/// once or twice.
const EQUAL: f32 = 1.0 + 8.0 * f32::EPSILON;

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
        self.nearest(filter, max_distance, |surface, max_distance| {
            let (local, length) = local_ray(surface, ray, max_distance)?;
            surface.cast_ray(&local, length).ok()?
        })
    }

    /// True if a ray meets any skin; stops at the first that it finds.
    pub fn intersects_ray(
        &self,
        ray: Ray3d,
        max_distance: f32,
        filter: &SurfaceFilter<'_>,
    ) -> bool {
        self.seen(filter).any(|(_, surface)| {
            let met = local_ray(surface, ray, max_distance)
                .and_then(|(local, length)| surface.intersects_ray(&local, length).ok());
            met.unwrap_or(false)
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
        let mut found = Vec::new();
        self.all(filter, hits, |surface, visit| {
            let (local, length) = local_ray(surface, ray, max_distance)?;
            surface.cast_ray_all(&local, length, &mut found).ok()?;
            found.iter().for_each(visit);
            Some(())
        });
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
            let local = local_point(surface, point);
            let length = local_length(surface, max_distance);
            surface.closest_point(local, length).ok()?
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
        self.all(filter, hits, |surface, visit| {
            let sphere = local_sphere(surface, center, radius);
            surface
                .visit_overlap_sphere(&sphere, |hit| visit(&hit))
                .ok()
        });
        hits.sort_unstable_by(by_distance_and_triangle);
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
        self.all(filter, hits, |surface, visit| {
            let capsule = local_capsule(surface, ends, radius);
            surface
                .visit_overlap_capsule(&capsule, |hit| visit(&hit))
                .ok()
        });
        hits.sort_unstable_by(by_distance_and_triangle);
    }

    /// The first contact of a sphere that moves by `motion`, with all skin standing still.
    pub fn cast_sphere(
        &self,
        center: Vec3,
        radius: f32,
        motion: Vec3,
        filter: &SurfaceFilter<'_>,
    ) -> Option<WorldSweepHit> {
        self.first(filter, |surface| {
            let sphere = local_sphere(surface, center, radius);
            let motion = local_vector(surface, motion);
            surface
                .cast_sphere(&sphere, motion, tolerance(surface))
                .ok()?
        })
    }

    /// The first contact of a capsule whose ends each move by one of `motions`, with all skin standing still.
    pub fn cast_capsule(
        &self,
        ends: [Vec3; 2],
        radius: f32,
        motions: [Vec3; 2],
        filter: &SurfaceFilter<'_>,
    ) -> Option<WorldSweepHit> {
        self.first(filter, |surface| {
            let capsule = local_capsule(surface, ends, radius);
            let motions = motions.map(|motion| local_vector(surface, motion));
            surface
                .cast_capsule(&capsule, motions, tolerance(surface))
                .ok()?
        })
    }

    /// The first contact of a sphere that moves by `motion` over the last tick, with skin that moves over the same
    /// tick.
    pub fn sweep_sphere(
        &self,
        center: Vec3,
        radius: f32,
        motion: Vec3,
        filter: &SurfaceFilter<'_>,
    ) -> Option<WorldSweepHit> {
        self.first(filter, |surface| {
            let sphere = local_sphere(surface, center, radius);
            let motion = local_vector(surface, motion);
            surface
                .sweep_sphere(&sphere, motion, tolerance(surface))
                .ok()?
        })
    }

    /// The first contact of a capsule whose ends each move by one of `motions` over the last tick, with skin that
    /// moves over the same tick.
    pub fn sweep_capsule(
        &self,
        ends: [Vec3; 2],
        radius: f32,
        motions: [Vec3; 2],
        filter: &SurfaceFilter<'_>,
    ) -> Option<WorldSweepHit> {
        self.first(filter, |surface| {
            let capsule = local_capsule(surface, ends, radius);
            let motions = motions.map(|motion| local_vector(surface, motion));
            surface
                .sweep_capsule(&capsule, motions, tolerance(surface))
                .ok()?
        })
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
        mut max_distance: f32,
        find: impl Fn(&PosedSurface, f32) -> Option<SurfaceHit>,
    ) -> Option<WorldHit> {
        let mut nearest: Option<WorldHit> = None;
        for (entity, surface) in self.seen(filter) {
            let Some(hit) = find(surface, max_distance) else {
                continue;
            };
            let hit = world_hit(entity, surface, &hit);
            if nearest.is_none_or(|nearest| by_distance(&hit, &nearest).is_lt()) {
                max_distance = max_distance.min(hit.distance * EQUAL + f32::MIN_POSITIVE);
                nearest = Some(hit);
            }
        }
        nearest
    }

    /// What `visit` finds in each surface; where it gives `None`, that is nothing.
    fn all(
        &self,
        filter: &SurfaceFilter<'_>,
        hits: &mut Vec<WorldHit>,
        mut visit: impl FnMut(&PosedSurface, &mut dyn FnMut(&SurfaceHit)) -> Option<()>,
    ) {
        hits.clear();
        for (entity, surface) in self.seen(filter) {
            let _ = visit(surface, &mut |hit| {
                hits.push(world_hit(entity, surface, hit));
            });
        }
    }

    fn first(
        &self,
        filter: &SurfaceFilter<'_>,
        find: impl Fn(&PosedSurface) -> Option<SweepHit>,
    ) -> Option<WorldSweepHit> {
        let hits = self.seen(filter).filter_map(|(entity, surface)| {
            let hit = find(surface)?;
            Some((hit.time, world_sweep_hit(entity, surface, &hit)))
        });
        let earlier = hits.min_by(|(time, a), (other, b)| {
            let by_time = time.total_cmp(other);
            by_time.then_with(|| by_distance(&a.hit, &b.hit))
        });
        earlier.map(|(_, hit)| hit)
    }
}

fn by_distance(a: &WorldHit, b: &WorldHit) -> std::cmp::Ordering {
    let by_distance = a.distance.total_cmp(&b.distance);
    by_distance.then_with(|| a.entity.cmp(&b.entity))
}

fn by_distance_and_triangle(a: &WorldHit, b: &WorldHit) -> std::cmp::Ordering {
    by_distance(a, b).then_with(|| a.triangle.cmp(&b.triangle))
}

pub(crate) fn world_hit(entity: Entity, surface: &SkinnedSurface, hit: &SurfaceHit) -> WorldHit {
    let world_from_model = surface.world_from_model();
    WorldHit {
        entity,
        point: world_from_model.transform_point_f32(hit.point).as_vec3(),
        normal: direction(world_from_model, hit.normal),
        distance: (f64::from(hit.distance) * world_from_model.scale) as f32,
        triangle: hit.triangle,
        barycentric: hit.barycentric,
        part: hit.part,
        tag: hit.tag,
    }
}

fn world_sweep_hit(entity: Entity, surface: &PosedSurface, hit: &SweepHit) -> WorldSweepHit {
    let world_from_model = surface.world_from_model();
    WorldSweepHit {
        hit: WorldHit {
            entity,
            point: world_from_model.transform_point_f32(hit.point).as_vec3(),
            normal: direction(world_from_model, hit.normal),
            distance: (hit.distance * world_from_model.scale) as f32,
            triangle: hit.triangle,
            barycentric: hit.barycentric,
            part: hit.part,
            tag: hit.tag,
        },
        time: hit.time as f32,
        started_inside: hit.started_inside,
        undecided: hit.undecided,
    }
}

fn direction(world_from_model: &Similarity, v: Vec3) -> Vec3 {
    (world_from_model.rotation * v.as_dvec3()).as_vec3()
}

fn local_point(surface: &SkinnedSurface, point: Vec3) -> Vec3 {
    surface
        .world_from_model()
        .inverse_transform_point_f32(point.as_dvec3())
}

fn local_vector(surface: &PosedSurface, vector: Vec3) -> Vec3 {
    surface
        .world_from_model()
        .inverse_transform_vector(vector.as_dvec3())
        .as_vec3()
}

fn local_length(surface: &SkinnedSurface, length: f32) -> f32 {
    (f64::from(length) / surface.world_from_model().scale) as f32
}

pub(crate) fn local_ray(
    surface: &SkinnedSurface,
    ray: Ray3d,
    max_distance: f32,
) -> Option<(Ray, f32)> {
    let along = surface
        .world_from_model()
        .inverse_transform_vector(ray.direction.as_dvec3())
        .try_normalize()?;
    let local = Ray::new(local_point(surface, ray.origin), along.as_vec3())?;
    Some((local, local_length(surface, max_distance)))
}

fn local_sphere(surface: &PosedSurface, center: Vec3, radius: f32) -> Sphere {
    Sphere {
        center: local_point(surface, center),
        radius: local_length(surface, radius),
    }
}

fn local_capsule(surface: &PosedSurface, [a, b]: [Vec3; 2], radius: f32) -> Capsule {
    Capsule {
        a: local_point(surface, a),
        b: local_point(surface, b),
        radius: local_length(surface, radius),
    }
}

/// A tenth of a millimetre of the world.
fn tolerance(surface: &PosedSurface) -> f32 {
    local_length(surface, TOLERANCE)
}
