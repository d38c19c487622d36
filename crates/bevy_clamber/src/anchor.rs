use bevy_app::{App, Plugin, PostUpdate};
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_reflect::prelude::*;
use bevy_transform::components::Transform;
use clamber_surface::mesh::MeshId;
use clamber_surface::rig;
use clamber_surface::surface::{Anchor, SkinnedSurface, SurfaceError};
use clamber_world::{Attachment, MaterialPoint, ObstacleId};
use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::{ClamberSystems, PosedSurface};

/// The deepest hierarchy that an anchored entity may hang in.
const MAX_DEPTH: usize = 4096;

/// Sticks this entity to a point of skin: an arrow, the end of a rope, a decal, a light, a camera.
///
/// Made by [`SurfaceQuery::anchor_at`](crate::SurfaceQuery::anchor_at). Each frame, after animation, position
/// and rotation of its `Transform` follow the skin *as that frame draws it*; the scale is left alone. When the
/// surface or the triangle is gone the anchor is taken off, and [`AnchorLost`] is triggered. Of skin that is only
/// disabled it is not, nor where a collider is built anew from the same mesh. An entity that is
/// `Disabled` is gone, as for all of Bevy's queries.
///
/// Under a parent that is scaled unevenly no rotation is exact: the position is, and where +Y points.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug, PartialEq)]
#[require(Transform)]
pub struct SurfaceAnchor {
    /// The entity with the [`PosedSurface`].
    #[entities]
    pub surface: Entity,
    /// The collider mesh that the point belongs to: on another one it is gone.
    pub mesh: MeshId,
    /// The point of skin, where it was last drawn, how the skin around it was turned, and how far off it the entity is.
    /// Its obstacle is [`SurfaceAnchor::obstacle_of`] the surface.
    pub attachment: Attachment,
    /// Rotation of the entity relative to the skin around the point.
    pub rotation: Quat,
}

impl SurfaceAnchor {
    /// At a point of a surface as it is posed now, turned in the world as given.
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

    /// The id that a surface's entity has as an obstacle.
    pub fn obstacle_of(surface: Entity) -> ObstacleId {
        ObstacleId(surface.to_bits())
    }

    /// The point of skin, to ask its surface about: [`ModelSpace::motion`](clamber_surface::surface::ModelSpace::motion).
    ///
    /// # Errors
    /// [`AnchorError::NoSkin`] if the attachment was changed to a point of something else.
    pub fn anchor(&self) -> Result<Anchor, AnchorError> {
        let point = &self.attachment.material;
        Ok(Anchor {
            mesh: self.mesh,
            triangle: point.triangle().ok_or(AnchorError::NoSkin)?,
            barycentric: point.coordinates.map(|weight| weight as f32),
            frame: Quat::IDENTITY,
        })
    }

    /// Follows the skin to a pose of its surface; gives where the entity belongs, in world space. `None` if the point is
    /// gone.
    pub(crate) fn follow(&mut self, surface: &SkinnedSurface) -> Option<DAffine3> {
        // The motion is not asked for: any tick will do.
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

/// Why something cannot be stuck to skin, or has no motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnchorError {
    /// The entity has no [`PosedSurface`]: it was despawned, or its collider is not built yet.
    #[error("entity {0} has no posed surface")]
    NoSurface(Entity),
    /// The anchor's attachment is to no triangle.
    #[error("the anchor is at no point of skin")]
    NoSkin,
    /// The surface does not know the point, or the tick has no length.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
}

/// Triggered on an entity whose [`SurfaceAnchor`] was taken off because what it stuck to is gone.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct AnchorLost {
    /// That entity.
    pub entity: Entity,
    /// What it stuck to; may be despawned.
    pub surface: Entity,
}

/// Moves anchored entities with the skin; part of [`ClamberPlugins`](crate::ClamberPlugins).
#[derive(Clone, Copy, Debug, Default)]
pub struct SurfaceAnchorPlugin;

impl Plugin for SurfaceAnchorPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<SurfaceAnchor>().add_systems(
            PostUpdate,
            (pose_anchored_surfaces, follow)
                .chain()
                .in_set(ClamberSystems::Anchor),
        );
    }
}

/// Poses those surfaces as drawn that something sticks to.
fn pose_anchored_surfaces(anchors: Query<&SurfaceAnchor>, mut surfaces: Query<&mut PosedSurface>) {
    for anchor in &anchors {
        if let Ok(mut surface) = surfaces.get_mut(anchor.surface) {
            surface.bypass_change_detection().pose_as_drawn();
        }
    }
}

/// Parents before children, so that what hangs under an anchored entity finds it where it is now.
fn follow(
    mut anchors: Query<(Entity, &mut SurfaceAnchor, Option<&ChildOf>)>,
    surfaces: Query<&PosedSurface>,
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
            let surface = anchor.surface;
            // Unless it goes at the same time.
            commands
                .entity(entity)
                .queue_silenced(move |mut entity: EntityWorldMut<'_>| {
                    entity.remove::<SurfaceAnchor>();
                    entity.trigger(|entity| AnchorLost { entity, surface });
                });
            continue;
        };
        let Some(world) = placed else {
            // This frame's pose cannot be had: it stays where it is.
            continue;
        };
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

/// Where an anchored entity belongs; `None` if the point is gone, `Some(None)` if the surface has no pose of this frame.
fn place(anchor: &mut SurfaceAnchor, surfaces: &Query<&PosedSurface>) -> Option<Option<DAffine3>> {
    let surface = surfaces.get(anchor.surface).ok()?;
    surface
        .mesh()
        .part_of(anchor.attachment.material.triangle()?)?;
    let Some(drawn) = surface.as_drawn() else {
        return Some(None);
    };
    anchor.follow(drawn).map(Some)
}

/// The rotation and translation of a map that may be sheared, as under a parent that is scaled unevenly: +Y is kept,
/// where arrows point. `None` if there is none.
fn turned_and_moved(map: &DAffine3) -> Option<(Quat, Vec3)> {
    let y = map.matrix3.y_axis.try_normalize()?;
    let z = map.matrix3.x_axis.cross(y).try_normalize()?;
    let axes = DMat3::from_cols(y.cross(z), y, z);
    let rotation = DQuat::from_mat3(&axes).normalize().as_quat();
    let translation = map.translation.as_vec3();
    (rotation.is_finite() && translation.is_finite()).then_some((rotation, translation))
}

/// How many entities stand above.
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

/// Where a parent is in the world, from the transforms of this frame.
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
