//! The obstacles that climbers can touch, found in the world.

use std::any::Any;

use bevy_ecs::entity::EntityMapper;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
#[cfg(any(feature = "avian", feature = "rapier"))]
use bevy_ecs::system::SystemParamValidationError;
#[cfg(feature = "rapier")]
use bevy_rapier3d::rapier::geometry::{Collider as RapierCollider, ColliderHandle as RapierHandle};
use clamber_climber::{ClimberContact, ClimberGroup};
use clamber_surface::geometry::WorldCapsule;
use clamber_surface::surface::TargetMotion;
use clamber_world::{
    Attachment, Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion, SweepContact, WorldPath,
};
use glam::DVec3;

use super::component::ClimberFilter;
#[cfg(feature = "colossus")]
use super::terrain_id::{SpawnNumber, TerrainId, terrain_obstacle};
#[cfg(any(feature = "avian", feature = "rapier"))]
use crate::WorldOrigin;
#[cfg(feature = "avian")]
use crate::obstacles::{AvianObstacles, AvianPushes, AvianTerrain};
#[cfg(feature = "rapier")]
use crate::obstacles::{DebrisBodies, RapierObstacles, RapierProxies, RapierPushes};
use crate::{DrawnSurface, PosedSurface};

/// An obstacle of the app's own: terrain without a physics engine, a moving platform, anything that implements
/// [`Obstacle`]. Climbers touch it from the tick after it was inserted on an entity.
///
/// Bring it up to date once a tick, before [`ClamberSystems::Climb`](crate::ClamberSystems::Climb).
///
/// ```
/// # use bevy_ecs::prelude::*;
/// # use bevy_clamber::prelude::*;
/// # use bevy_clamber::clamber_climber::{Climber as Character, ClimberConfig, ClimberObstacle};
/// # use bevy_math::DVec3;
/// fn spawn(mut commands: Commands) {
///     # let character = Character::new(ClimberConfig::walker(), DVec3::ZERO).unwrap();
///     # let my_terrain = ClimberObstacle::new(&character, &[], 0.1);
///     commands.spawn(CustomObstacle::new(my_terrain));
/// }
/// ```
#[derive(Component)]
#[cfg_attr(feature = "colossus", component(on_add = super::terrain_id::number))]
pub struct CustomObstacle(Box<dyn AnyObstacle>);

/// An obstacle that can be taken back out of its box.
trait AnyObstacle: Obstacle + Any + Send + Sync {}

impl<T: Obstacle + Any + Send + Sync> AnyObstacle for T {}

impl CustomObstacle {
    /// Makes an obstacle a component.
    pub fn new(obstacle: impl Obstacle + Send + Sync + 'static) -> Self {
        Self(Box::new(obstacle))
    }

    /// The obstacle, if it is of this type.
    pub fn get<T: 'static>(&self) -> Option<&T> {
        let any: &dyn Any = &*self.0;
        any.downcast_ref()
    }

    /// The obstacle, to change it, if it is of this type.
    pub fn get_mut<T: 'static>(&mut self) -> Option<&mut T> {
        let any: &mut dyn Any = &mut *self.0;
        any.downcast_mut()
    }
}

/// The id of an engine's whole world. No living entity has these bits.
pub(crate) const AVIAN: ObstacleId = ObstacleId(u64::MAX);
pub(crate) const RAPIER: ObstacleId = ObstacleId(u64::MAX - 1);

/// The same in an arena, which keeps the ids from 2^62 on for its creatures and fighters. No entity lives long enough
/// to have these bits.
#[cfg(all(feature = "avian", feature = "colossus"))]
const ARENA_AVIAN: ObstacleId = ObstacleId((1 << 62) - 1);
#[cfg(all(feature = "rapier", feature = "colossus"))]
const ARENA_RAPIER: ObstacleId = ObstacleId((1 << 62) - 2);

/// Maps the entities of an attachment. An engine's world is no entity: in avian's, the points are on entities, in
/// rapier's on handles.
pub(super) fn map_entities(on: &mut Attachment, mapper: &mut impl EntityMapper) {
    let bits = match on.obstacle {
        RAPIER => return,
        AVIAN => &mut on.material.key,
        ObstacleId(_) => &mut on.obstacle.0,
    };
    if let Some(entity) = Entity::try_from_bits(*bits) {
        *bits = mapper.get_mapped(entity).to_bits();
    }
}

/// All that climbers can touch, beside each other.
#[derive(SystemParam)]
pub(crate) struct Touchable<'w, 's> {
    surfaces: Query<'w, 's, (Entity, &'static PosedSurface)>,
    custom: Query<'w, 's, (Entity, &'static CustomObstacle)>,
    #[cfg(feature = "colossus")]
    numbers: Query<'w, 's, (Option<&'static TerrainId>, Option<&'static SpawnNumber>)>,
    #[cfg(any(feature = "avian", feature = "rapier"))]
    origin: Res<'w, WorldOrigin>,
    #[cfg(feature = "avian")]
    avian: Result<AvianObstacles<'w, 's>, SystemParamValidationError>,
    #[cfg(feature = "rapier")]
    rapier: Result<RapierObstacles<'w, 's>, SystemParamValidationError>,
    #[cfg(feature = "rapier")]
    debris: Option<Res<'w, DebrisBodies>>,
    #[cfg(feature = "rapier")]
    proxies: Option<Res<'w, RapierProxies>>,
}

/// Pushes bodies of physics engines.
#[cfg(any(feature = "avian", feature = "rapier"))]
#[derive(SystemParam)]
pub(super) struct Pushes<'w, 's> {
    #[cfg(feature = "avian")]
    avian: Result<AvianPushes<'w, 's>, SystemParamValidationError>,
    #[cfg(feature = "rapier")]
    rapier: RapierPushes<'w, 's>,
}

#[cfg(any(feature = "avian", feature = "rapier"))]
impl Pushes<'_, '_> {
    pub(super) fn push(&mut self, push: &clamber_climber::Push) {
        #[cfg(feature = "avian")]
        if let (AVIAN, Ok(avian)) = (push.obstacle, &mut self.avian) {
            avian.push(&push.material, push.impulse);
        }
        #[cfg(feature = "rapier")]
        if push.obstacle == RAPIER {
            self.rapier.push(&push.material, push.impulse);
        }
    }
}

impl Touchable<'_, '_> {
    /// The surface of an obstacle, if it is one.
    pub(super) fn surface(&self, id: ObstacleId) -> Option<&PosedSurface> {
        let entity = Entity::try_from_bits(id.0)?;
        let (_, surface) = self.surfaces.get(entity).ok()?;
        surface.is_placed().then_some(surface)
    }

    /// Calls `step` with all obstacles of one climber.
    pub(super) fn around<T>(
        &self,
        climber: Entity,
        filter: Option<&ClimberFilter>,
        climbers: Option<&ClimberGroup>,
        gone: Option<(ObstacleId, MaterialPoint)>,
        step: impl FnOnce(&[(ObstacleId, &dyn Obstacle)]) -> T,
    ) -> T {
        let touches = |entity: Entity| {
            entity != climber && filter.is_none_or(|filter| !filter.ignored.contains(&entity))
        };
        let id = |entity: Entity| ObstacleId(entity.to_bits());
        let mut all: Vec<(ObstacleId, &dyn Obstacle)> = Vec::new();
        #[cfg(feature = "avian")]
        let avian = self
            .avian
            .as_ref()
            .ok()
            .map(|avian| in_avian(avian, climber, filter).with_origin(self.origin.0));
        #[cfg(feature = "avian")]
        all.extend(avian.as_ref().map(|avian| (AVIAN, avian as &dyn Obstacle)));
        #[cfg(feature = "rapier")]
        let rapier = self.rapier.as_ref().ok().and_then(RapierObstacles::terrain);
        #[cfg(feature = "rapier")]
        let wanted = |handle, collider: &RapierCollider| {
            is_wanted(filter, climber, collider)
                && !is_stand_in(self.debris.as_deref(), self.proxies.as_deref(), handle)
        };
        #[cfg(feature = "rapier")]
        let rapier = rapier.map(|rapier| rapier.with_filter(&wanted).with_origin(self.origin.0));
        #[cfg(feature = "rapier")]
        all.extend(
            rapier
                .as_ref()
                .map(|rapier| (RAPIER, rapier as &dyn Obstacle)),
        );

        let lost = gone.and_then(|(id, point)| {
            let surface = self.surface(id)?;
            Some((id, WithoutPoint { surface, point }))
        });
        for (entity, surface) in &self.surfaces {
            if surface.is_placed() && touches(entity) {
                let seen: &dyn Obstacle = match &lost {
                    Some((lost, without)) if *lost == id(entity) => without,
                    _ => &**surface,
                };
                all.push((id(entity), seen));
            }
        }
        for (entity, custom) in &self.custom {
            if touches(entity) {
                all.push((id(entity), &*custom.0));
            }
        }
        let others = climbers
            .into_iter()
            .flat_map(|group| group.others(id(climber)));
        all.extend(others.filter(|(other, _)| {
            let entity = Entity::try_from_bits(other.0);
            entity.is_some_and(touches)
        }));
        step(&all)
    }

    /// Calls `look` with the terrain: the worlds of physics engines, and obstacles of the app.
    #[cfg(feature = "colossus")]
    pub(crate) fn terrain<T>(&self, look: impl FnOnce(&[&dyn Obstacle]) -> T) -> T {
        self.terrain_by_id(|all| {
            let all: Vec<&dyn Obstacle> = all.iter().map(|(_, obstacle)| *obstacle).collect();
            look(&all)
        })
    }

    /// The id of an obstacle of the app in a fight.
    #[cfg(feature = "colossus")]
    fn number(&self, entity: Entity) -> Option<ObstacleId> {
        let (given, spawned) = self.numbers.get(entity).ok()?;
        terrain_obstacle(given, spawned)
    }

    /// The obstacle of the app with this id in a fight.
    #[cfg(feature = "fight")]
    pub(crate) fn numbered(&self, id: ObstacleId) -> Option<Entity> {
        let mut all = self.custom.iter().map(|(entity, _)| entity);
        all.find(|entity| self.number(*entity) == Some(id))
    }

    /// Calls `look` with the terrain, by ascending id. The ids are below the ids of an arena's creatures.
    #[cfg(feature = "colossus")]
    pub(crate) fn terrain_by_id<T>(
        &self,
        look: impl FnOnce(&[(ObstacleId, &dyn Obstacle)]) -> T,
    ) -> T {
        let mut all: Vec<(ObstacleId, &dyn Obstacle)> = Vec::new();
        #[cfg(feature = "avian")]
        let avian = self.avian.as_ref().ok();
        #[cfg(feature = "avian")]
        let avian = avian.map(|avian| avian.terrain().with_origin(self.origin.0));
        #[cfg(feature = "rapier")]
        let rapier = self.rapier.as_ref().ok().and_then(RapierObstacles::terrain);
        #[cfg(feature = "rapier")]
        let wanted = |handle, _: &RapierCollider| {
            !is_stand_in(self.debris.as_deref(), self.proxies.as_deref(), handle)
        };
        #[cfg(feature = "rapier")]
        let rapier = rapier.map(|rapier| rapier.with_filter(&wanted).with_origin(self.origin.0));
        for (entity, custom) in &self.custom {
            if let Some(id) = self.number(entity) {
                all.push((id, &*custom.0));
            }
        }
        all.sort_unstable_by_key(|(id, _)| id.0);
        #[cfg(feature = "rapier")]
        all.extend(
            rapier
                .as_ref()
                .map(|rapier| (ARENA_RAPIER, rapier as &dyn Obstacle)),
        );
        #[cfg(feature = "avian")]
        all.extend(
            avian
                .as_ref()
                .map(|avian| (ARENA_AVIAN, avian as &dyn Obstacle)),
        );
        look(&all)
    }

    /// The entity of a material point: a collider's, for an engine's world.
    pub(super) fn entity(&self, id: ObstacleId, point: Option<&MaterialPoint>) -> Option<Entity> {
        #[cfg(feature = "avian")]
        if id == AVIAN {
            return Entity::try_from_bits(point?.key);
        }
        #[cfg(feature = "rapier")]
        if id == RAPIER {
            return self.rapier.as_ref().ok()?.entity(point?);
        }
        let _ = point;
        Entity::try_from_bits(id.0)
    }
}

/// The obstacles that a camera can bump into: skin as it is drawn, and the obstacles of the last tick.
#[derive(SystemParam)]
pub(crate) struct DrawnTouchable<'w, 's> {
    surfaces: Query<'w, 's, (Entity, &'static PosedSurface, &'static DrawnSurface)>,
    custom: Query<'w, 's, (Entity, &'static CustomObstacle)>,
    #[cfg(any(feature = "avian", feature = "rapier"))]
    origin: Res<'w, WorldOrigin>,
    #[cfg(feature = "avian")]
    avian: Result<AvianObstacles<'w, 's>, SystemParamValidationError>,
    #[cfg(feature = "rapier")]
    rapier: Result<RapierObstacles<'w, 's>, SystemParamValidationError>,
    #[cfg(feature = "rapier")]
    debris: Option<Res<'w, DebrisBodies>>,
    #[cfg(feature = "rapier")]
    proxies: Option<Res<'w, RapierProxies>>,
}

impl DrawnTouchable<'_, '_> {
    /// Calls `touch` with everything that a climber with this filter touches, but other climbers.
    #[cfg(feature = "clamber_gltf")]
    pub(crate) fn around<T>(
        &self,
        climber: Entity,
        filter: Option<&ClimberFilter>,
        touch: impl FnOnce(&[(ObstacleId, &dyn Obstacle)]) -> T,
    ) -> T {
        let touches =
            |entity: &Entity| filter.is_none_or(|filter| !filter.ignored.contains(entity));
        let id = |entity: Entity| ObstacleId(entity.to_bits());
        let _ = climber;
        let mut all: Vec<(ObstacleId, &dyn Obstacle)> = Vec::new();
        #[cfg(feature = "avian")]
        let avian = self
            .avian
            .as_ref()
            .ok()
            .map(|avian| in_avian(avian, climber, filter).with_origin(self.origin.0));
        #[cfg(feature = "avian")]
        all.extend(avian.as_ref().map(|avian| (AVIAN, avian as &dyn Obstacle)));
        #[cfg(feature = "rapier")]
        let rapier = self.rapier.as_ref().ok().and_then(RapierObstacles::terrain);
        #[cfg(feature = "rapier")]
        let wanted = |handle, collider: &RapierCollider| {
            is_wanted(filter, climber, collider)
                && !is_stand_in(self.debris.as_deref(), self.proxies.as_deref(), handle)
        };
        #[cfg(feature = "rapier")]
        let rapier = rapier.map(|rapier| rapier.with_filter(&wanted).with_origin(self.origin.0));
        #[cfg(feature = "rapier")]
        all.extend(
            rapier
                .as_ref()
                .map(|rapier| (RAPIER, rapier as &dyn Obstacle)),
        );
        for (entity, surface, drawn) in &self.surfaces {
            if touches(&entity)
                && let Some(drawn) = drawn.pose(surface)
            {
                all.push((id(entity), drawn));
            }
        }
        for (entity, custom) in &self.custom {
            if touches(&entity) {
                all.push((id(entity), &*custom.0));
            }
        }
        touch(&all)
    }

    /// The share of a way that a ball can go, 0 to 1, up to the first thing that a climber with this filter touches;
    /// `None` if it can go all of it.
    pub(crate) fn free_way(
        &self,
        filter: Option<&ClimberFilter>,
        ball: &WorldCapsule,
        way: DVec3,
    ) -> Option<f64> {
        let mut first: Option<f64> = None;
        let mut meet = |obstacle: &dyn Obstacle| {
            let left = first.unwrap_or(1.0);
            if let Some(hit) = obstacle.cast_capsule(ball, [way * left; 2], TargetMotion::Still) {
                first = Some(left * hit.fraction);
            }
        };
        let touches =
            |entity: &Entity| filter.is_none_or(|filter| !filter.ignored.contains(entity));
        for (entity, surface, drawn) in &self.surfaces {
            if touches(&entity)
                && let Some(drawn) = drawn.pose(surface)
            {
                meet(drawn);
            }
        }
        for (entity, custom) in &self.custom {
            if touches(&entity) {
                meet(&*custom.0);
            }
        }
        #[cfg(feature = "avian")]
        if let Ok(avian) = &self.avian {
            let terrain = in_avian(avian, Entity::PLACEHOLDER, filter);
            meet(&terrain.with_origin(self.origin.0));
        }
        #[cfg(feature = "rapier")]
        if let Some(rapier) = self.rapier.as_ref().ok().and_then(RapierObstacles::terrain) {
            let wanted = |handle, collider: &RapierCollider| {
                is_wanted(filter, Entity::PLACEHOLDER, collider)
                    && !is_stand_in(self.debris.as_deref(), self.proxies.as_deref(), handle)
            };
            let terrain = rapier.with_filter(&wanted);
            meet(&terrain.with_origin(self.origin.0));
        }
        first
    }
}

/// The point of an obstacle that was touched in a tick, if any was.
pub(super) fn touched(contacts: &[ClimberContact], id: ObstacleId) -> Option<&MaterialPoint> {
    let of_it = contacts.iter().filter(|contact| contact.obstacle == id);
    of_it.map(|contact| &contact.material).next_back()
}

#[cfg(feature = "avian")]
fn in_avian<'a>(
    avian: &'a AvianObstacles<'_, '_>,
    climber: Entity,
    filter: Option<&ClimberFilter>,
) -> AvianTerrain<'a> {
    use avian3d::prelude::{LayerMask, SpatialQueryFilter};
    let mut wanted = SpatialQueryFilter::from_excluded_entities([climber]);
    if let Some(filter) = filter {
        wanted.mask = LayerMask(filter.layers);
        wanted
            .excluded_entities
            .extend(filter.ignored.iter().copied());
    }
    avian.terrain().with_filter(wanted)
}

/// True for a collider of rapier that stands for skin or for a climber, which climbers touch themselves.
#[cfg(feature = "rapier")]
fn is_stand_in(
    debris: Option<&DebrisBodies>,
    proxies: Option<&RapierProxies>,
    collider: RapierHandle,
) -> bool {
    debris.is_some_and(|debris| debris.is_skin(collider))
        || proxies.is_some_and(|proxies| proxies.has(collider))
}

/// True for a collider of rapier that a climber touches: of its layers, and neither its own nor ignored.
#[cfg(feature = "rapier")]
fn is_wanted(filter: Option<&ClimberFilter>, climber: Entity, collider: &RapierCollider) -> bool {
    let entity = u64::try_from(collider.user_data).ok();
    let entity = entity.and_then(Entity::try_from_bits);
    if entity == Some(climber) {
        return false;
    }
    filter.is_none_or(|filter| {
        let layers = collider.collision_groups().memberships.bits();
        let is_ignored = entity.is_some_and(|entity| filter.ignored.contains(&entity));
        layers & filter.layers != 0 && !is_ignored
    })
}

/// A surface whose mesh is another one by now, so that a point which was made on the old mesh is gone.
struct WithoutPoint<'a> {
    surface: &'a PosedSurface,
    point: MaterialPoint,
}

impl Obstacle for WithoutPoint<'_> {
    fn bounds(&self) -> Option<(DVec3, f64)> {
        self.surface.bounds()
    }

    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        Obstacle::cast_ray(&**self.surface, origin, direction, max_distance)
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        Obstacle::closest_point(&**self.surface, point, max_distance)
    }

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        Obstacle::overlap_capsule(&**self.surface, capsule, contacts);
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        Obstacle::cast_capsule(&**self.surface, capsule, displacements, target)
    }

    fn cast_capsule_where(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        self.surface
            .cast_capsule_where(capsule, displacements, target, counts)
    }

    fn cast_capsule_past_overlaps(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        self.surface
            .cast_capsule_past_overlaps(capsule, displacements, target, counts)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        if *point == self.point {
            return None;
        }
        Obstacle::motion(&**self.surface, point, dt)
    }

    fn path(&self, point: &MaterialPoint, dt: f64) -> Option<WorldPath> {
        if *point == self.point {
            return None;
        }
        Obstacle::path(&**self.surface, point, dt)
    }
}

#[cfg(test)]
mod tests {
    use bevy_ecs::entity::EntityHashMap;
    use glam::DQuat;

    use super::*;

    #[test]
    fn entities_are_mapped_and_engines_are_not() {
        let [old, new] = [7, 900].map(|index| Entity::from_raw_u32(index).unwrap());
        let mut mapped = EntityHashMap::default();
        mapped.insert(old, new);
        let key = 5;
        for (obstacle, key, expected) in [
            (
                ObstacleId(old.to_bits()),
                key,
                (ObstacleId(new.to_bits()), key),
            ),
            (AVIAN, old.to_bits(), (AVIAN, new.to_bits())),
            (RAPIER, old.to_bits(), (RAPIER, old.to_bits())),
        ] {
            let material = MaterialPoint {
                key,
                coordinates: [0.0; 3],
            };
            let mut on = Attachment {
                obstacle,
                material,
                point: DVec3::ZERO,
                frame: DQuat::IDENTITY,
                offset: DVec3::ZERO,
            };
            map_entities(&mut on, &mut mapped);
            assert_eq!((on.obstacle, on.material.key), expected);
        }
    }
}
