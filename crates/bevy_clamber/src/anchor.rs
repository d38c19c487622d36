use bevy_app::{App, Plugin, PostUpdate};
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::*;
use bevy_ecs::world::DeferredWorld;
use bevy_math::{Quat, Vec3};
use bevy_reflect::prelude::*;
use bevy_transform::components::Transform;
use clamber_surface::mesh::MeshId;
use clamber_surface::rig;
use clamber_surface::surface::{Anchor, SkinnedSurface, SurfaceError};
use clamber_world::{Attachment, MaterialPoint, ObstacleId};
use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::{ClamberSystems, DrawnSurface, PosedSurface, WorldOrigin};

/// Maximum number of ancestors of an anchored entity that are followed.
const MAX_DEPTH: usize = 4096;

/// Attaches this entity to a point of skin: an arrow, the end of a rope, a decal, a light, a camera.
///
/// Made by [`SurfaceQuery::anchor_at`](crate::SurfaceQuery::anchor_at). Each frame, after animation, the position
/// and rotation of its `Transform` follow the skin *as that frame draws it*; the scale is not changed. When the
/// surface or the triangle is gone, the anchor is removed and [`AnchorLost`] is triggered. Disabling a triangle or a
/// part does not remove it, nor does rebuilding the collider from the same mesh. A surface entity that is `Disabled`
/// counts as gone, as in all of Bevy's queries.
///
/// Under a parent with a non-uniform scale no rotation is exact. The position and the direction of +Y are exact there.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, PartialEq)]
#[require(Transform)]
#[component(on_insert = relate, on_discard = unrelate)]
pub struct SurfaceAnchor {
    /// The entity with the [`PosedSurface`].
    #[entities]
    pub surface: Entity,
    /// The collider mesh that the point belongs to. On a surface with another mesh, the anchor is lost.
    pub mesh: MeshId,
    /// The point of skin, its position and frame in world space as last drawn, and the offset of the entity from it,
    /// metres, in that frame. Its obstacle is [`SurfaceAnchor::obstacle_of`] the surface.
    pub attachment: Attachment,
    /// Rotation of the entity relative to the frame of the skin around the point.
    pub rotation: Quat,
}

/// The surface that this entity is anchored to: a relationship, inserted and removed with its [`SurfaceAnchor`].
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Component, Clone, Debug, PartialEq)]
#[relationship(relationship_target = SurfaceAnchors)]
pub struct AnchoredTo(pub Entity);

/// The entities that are anchored to this surface, in no promised order; inserted beside the first of them.
///
/// The anchored entities are not despawned with the surface: [`AnchorLost`] is triggered on each.
#[derive(Component, Clone, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
#[relationship_target(relationship = AnchoredTo)]
pub struct SurfaceAnchors(Vec<Entity>);

/// Relates an anchored entity to its surface.
fn relate(mut world: DeferredWorld<'_>, context: HookContext) {
    if let Some(anchor) = world.get::<SurfaceAnchor>(context.entity).copied() {
        let mut commands = world.commands();
        commands
            .entity(context.entity)
            .try_insert(AnchoredTo(anchor.surface));
    }
}

fn unrelate(mut world: DeferredWorld<'_>, context: HookContext) {
    let mut commands = world.commands();
    commands.entity(context.entity).try_remove::<AnchoredTo>();
}

impl SurfaceAnchor {
    /// An anchor at a point of `surface`, the surface of `entity`, in its current pose. `rotation` is the rotation that
    /// the anchored entity has in this pose, in world space; it turns with the skin.
    ///
    /// An `anchor` of another mesh is not refused here. It is lost when it is first followed, with [`AnchorLost`].
    pub fn new(entity: Entity, surface: &SkinnedSurface, anchor: Anchor, rotation: Quat) -> Self {
        let world_from_model = surface.world_from_model();
        let skin = (world_from_model.rotation * anchor.frame.as_dquat()).normalize();
        let here = surface.in_world().motion(&anchor, 1.0);
        let here = here.map(|motion| motion.position);
        Self {
            surface: entity,
            mesh: anchor.mesh,
            attachment: Attachment {
                obstacle: Self::obstacle_of(entity),
                material: MaterialPoint::on_triangle(anchor.triangle, anchor.barycentric),
                point: here.unwrap_or_default(),
                frame: skin,
                offset: DVec3::ZERO,
            },
            rotation: (skin.conjugate() * rotation.as_dquat())
                .normalize()
                .as_quat(),
        }
    }

    /// The obstacle id of a surface, from the bits of its entity.
    pub fn obstacle_of(surface: Entity) -> ObstacleId {
        ObstacleId(surface.to_bits())
    }

    /// The point of skin as an anchor of the core, for
    /// [`ModelSpace::motion`](clamber_surface::surface::ModelSpace::motion). Its frame is the identity.
    ///
    /// # Errors
    /// [`AnchorError::NoSkin`] if the attachment was changed to a point that is not on a triangle.
    pub fn anchor(&self) -> Result<Anchor, AnchorError> {
        let point = &self.attachment.material;
        Ok(Anchor {
            mesh: self.mesh,
            triangle: point.triangle().ok_or(AnchorError::NoSkin)?,
            barycentric: point.coordinates.map(|weight| weight as f32),
            frame: Quat::IDENTITY,
        })
    }

    /// Follows the skin to a pose of its surface. Returns the entity's transform in world space; `None` if the point is
    /// gone.
    pub(crate) fn follow(&mut self, surface: &SkinnedSurface) -> Option<DAffine3> {
        // Only the position and frame are used, so any tick length will do.
        let motion = surface.in_world().motion(&self.anchor().ok()?, 1.0).ok()?;
        let attachment = &mut self.attachment;
        attachment.obstacle = Self::obstacle_of(self.surface);
        attachment.point = motion.position;
        if !motion.collapsed {
            attachment.frame = motion.frame;
        }
        let rotation: DQuat = (attachment.frame * self.rotation.as_dquat()).normalize();
        Some(DAffine3::from_rotation_translation(
            rotation,
            attachment.position(),
        ))
    }
}

/// Why an anchor cannot be made, or has no motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnchorError {
    /// The entity has no [`PosedSurface`]: it was despawned, or its collider is not built yet.
    #[error("entity {0} has no posed surface")]
    NoSurface(Entity),
    /// The anchor's attachment is not on a triangle.
    #[error("the anchor is not attached to a triangle of skin")]
    NoSkin,
    /// The surface refuses the point, because of another mesh or a removed triangle, or the length of the tick.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
}

/// Triggered on an entity whose [`SurfaceAnchor`] was removed because its surface, its mesh or its triangle is gone.
/// Written as a message as well.
///
/// To keep the entity on a creature whose mesh has changed, for example to one with more detail, anchor it anew:
///
/// ```
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::components::Transform;
/// # use bevy_clamber::prelude::*;
/// fn anchor_anew(
///     lost: On<AnchorLost>,
///     places: Query<&Transform>,
///     surfaces: DrawnSurfaceQuery,
///     mut commands: Commands,
/// ) -> Result {
///     let place = places.get(lost.entity)?;
///     let is_same = |entity| entity == lost.surface;
///     let filter = SurfaceFilter::only(&is_same);
///     if let Some(near) = surfaces.closest_point(place.translation, 0.5, &filter) {
///         let anchor = surfaces.anchor_with_rotation(&near, place.rotation)?;
///         commands.entity(lost.entity).insert(anchor);
///     }
///     Ok(())
/// }
/// # let _ = bevy_app::App::new().add_observer(anchor_anew);
/// ```
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Clone, Debug, PartialEq)]
pub struct AnchorLost {
    /// The entity that was anchored.
    pub entity: Entity,
    /// The entity of the surface that it was anchored to; may be despawned.
    pub surface: Entity,
    /// The anchor as it was.
    pub anchor: SurfaceAnchor,
}

/// Moves anchored entities with the skin; part of [`ClamberPlugins`](crate::ClamberPlugins).
#[derive(Clone, Copy, Debug, Default)]
pub struct SurfaceAnchorPlugin;

impl Plugin for SurfaceAnchorPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<SurfaceAnchor>()
            .register_type::<AnchoredTo>()
            .register_type::<SurfaceAnchors>()
            .add_message::<AnchorLost>()
            .add_systems(PostUpdate, follow.in_set(ClamberSystems::Anchor));
    }
}

/// Moves parents before children, so that an anchored child sees the current transform of an anchored parent.
fn follow(
    mut anchors: Query<(Entity, &mut SurfaceAnchor, Option<&ChildOf>)>,
    surfaces: Query<(&PosedSurface, &DrawnSurface)>,
    origin: Res<WorldOrigin>,
    mut transforms: Query<(&mut Transform, Option<&ChildOf>)>,
    mut order: Local<Vec<(usize, Entity)>>,
    mut commands: Commands,
) {
    order.clear();
    order.extend(anchors.iter().map(|(entity, _, child_of)| {
        let parent = child_of.map(ChildOf::parent);
        (depth(parent, &transforms), entity)
    }));
    order.sort_unstable();
    for (_, entity) in order.iter() {
        let Ok((entity, mut anchor, child_of)) = anchors.get_mut(*entity) else {
            continue;
        };
        let Some(placed) = place(anchor.bypass_change_detection(), &surfaces) else {
            let (surface, anchor) = (anchor.surface, *anchor);
            // Silenced: the entity may be despawned at the same time.
            commands
                .entity(entity)
                .queue_silenced(move |mut entity: EntityWorldMut<'_>| {
                    entity.remove::<SurfaceAnchor>();
                    let lost = |entity| AnchorLost {
                        entity,
                        surface,
                        anchor,
                    };
                    let told = lost(entity.id());
                    entity.world_scope(|world| world.write_message(told));
                    entity.trigger(lost);
                });
            continue;
        };
        let Some(world) = placed else {
            // The surface has no pose for this frame: the entity stays where it is.
            continue;
        };
        let world = DAffine3::from_translation(-origin.0) * world;
        let local = match child_of {
            None => world,
            Some(child_of) => parent(child_of.parent(), &transforms).inverse() * world,
        };
        let Some((rotation, translation)) = turned_and_moved(&local) else {
            continue;
        };
        if let Ok((mut transform, _)) = transforms.get_mut(entity) {
            let scale = transform.scale;
            transform.set_if_neq(Transform {
                translation,
                rotation,
                scale,
            });
        }
    }
}

/// The transform of an anchored entity in world space; `None` if the point is gone, `Some(None)` if the surface has no
/// pose of this frame.
fn place(
    anchor: &mut SurfaceAnchor,
    surfaces: &Query<(&PosedSurface, &DrawnSurface)>,
) -> Option<Option<DAffine3>> {
    let (surface, drawn) = surfaces.get(anchor.surface).ok()?;
    surface
        .mesh()
        .part_of(anchor.attachment.material.triangle()?)?;
    let Some(drawn) = drawn.pose(surface) else {
        return Some(None);
    };
    anchor.follow(drawn).map(Some)
}

/// The rotation and translation of a map. If it is sheared, as under a parent with a non-uniform scale, the direction
/// of +Y is kept, along which arrows point. `None` if the map is degenerate or not finite.
fn turned_and_moved(map: &DAffine3) -> Option<(Quat, Vec3)> {
    let y = map.matrix3.y_axis.try_normalize()?;
    let z = map.matrix3.x_axis.cross(y).try_normalize()?;
    let axes = DMat3::from_cols(y.cross(z), y, z);
    let rotation = DQuat::from_mat3(&axes).normalize().as_quat();
    let translation = map.translation.as_vec3();
    (rotation.is_finite() && translation.is_finite()).then_some((rotation, translation))
}

/// Number of ancestors, `next` included.
fn depth(
    mut next: Option<Entity>,
    transforms: &Query<(&mut Transform, Option<&ChildOf>)>,
) -> usize {
    let mut depth = 0;
    while let Some(entity) = next
        && depth < MAX_DEPTH
    {
        depth += 1;
        let child_of = transforms
            .get(entity)
            .ok()
            .and_then(|(_, child_of)| child_of);
        next = child_of.map(ChildOf::parent);
    }
    depth
}

/// A parent's transform in world space, from the `Transform`s of this frame.
fn parent(entity: Entity, transforms: &Query<(&mut Transform, Option<&ChildOf>)>) -> DAffine3 {
    let mut world = DAffine3::IDENTITY;
    let mut next = Some(entity);
    for _ in 0..MAX_DEPTH {
        let Some(Ok((transform, child_of))) = next.map(|entity| transforms.get(entity)) else {
            break;
        };
        let local = rig::Transform {
            translation: transform.translation,
            rotation: transform.rotation,
            scale: transform.scale,
        };
        world = local.to_affine() * world;
        next = child_of.map(ChildOf::parent);
    }
    world
}
