//! A backend of `bevy_picking` that hits animated skin.

use bevy_app::{App, Plugin, PreUpdate};
use bevy_camera::Camera;
use bevy_camera::visibility::{RenderLayers, ViewVisibility};
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_picking::backend::ray::RayMap;
use bevy_picking::backend::{HitData, PointerHits};
use bevy_picking::{Pickable, PickingPlugin, PickingSystems};
use bevy_reflect::prelude::*;
use bevy_shape::Ray3d;
use clamber_surface::mesh::{PartId, SurfaceTag, TriangleId};
use glam::DVec3;

use crate::needs::need_plugin;
use crate::query::{in_f64, world_hit};
use crate::{
    ClamberSystems, DrawnSurface, EntityHit, PosedSurface, SurfaceAnchor, SurfacePlugin,
    WorldOrigin,
};

/// The point of skin that a pointer hits: the extra data of a `HitData`, whose position and outward unit normal are in
/// world space.
///
/// The pick is a material point, so it stays valid when the skin moves in later frames. A click, for example, has the
/// hit of the frame before.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfacePick {
    /// The collider's triangle.
    pub triangle: TriangleId,
    /// Index of the triangle in the mesh asset, in the order of the asset's list or strip. Triangles of a strip that
    /// have no area are counted too. `None` for a triangle that an edit added.
    pub source_triangle: Option<u32>,
    /// Weights of the triangle's corners: not negative, sum 1 up to rounding.
    pub barycentric: [f32; 3],
    /// The part of the collider: the triangles that one joint moves most.
    pub part: PartId,
    /// The triangle's tag.
    pub tag: SurfaceTag,
    /// Attaches an entity there when it is spawned with this component, its +Y along the skin's outward normal.
    pub anchor: SurfaceAnchor,
}

/// Makes pointers hit skin in the pose that is drawn, not in the bind pose. Add it beside
/// [`ClamberPlugins`](crate::ClamberPlugins) and Bevy's `DefaultPickingPlugins`.
///
/// The backend runs in `PreUpdate`, in `PickingSystems::Backend`, after [`ClamberSystems::Build`]. It casts each ray of
/// Bevy's `RayMap` at all surfaces, in the pose that the last frame drew, since that is the pose that the user has
/// seen. It writes `PointerHits` with [`SurfacePick`] as extra data. The hit entity is the one with the
/// [`PosedSurface`]; its skin is hit from either side. The depth is the distance from the ray's origin, which lies on
/// the camera's near plane.
///
/// Like Bevy's backend for meshes, it skips entities that no view shows (`ViewVisibility`), that share no
/// `RenderLayers` with the camera, or that are `Pickable::IGNORE`, and it gives the hits the camera's order. A surface
/// blocks all surfaces behind it if its `Pickable` says so, or if it has none. Blocked surfaces are not reported,
/// hoverable or not.
///
/// ```
/// # use bevy_app::App;
/// # use bevy_ecs::prelude::*;
/// # use bevy_picking::events::PointerClick;
/// # use bevy_clamber::SurfacePick;
/// /// Attaches an entity to the point of skin that the user has clicked.
/// fn stick(click: On<PointerClick>, mut commands: Commands) {
///     let Some(pick) = click.hit.extra_as::<SurfacePick>() else {
///         return;
///     };
///     // The click bubbles up to the parents of the clicked entity.
///     if pick.anchor.surface == click.entity {
///         commands.spawn(pick.anchor);
///     }
/// }
/// # let mut app = App::new();
/// app.add_observer(stick);
/// ```
///
/// Bevy's `MeshPickingPlugin` picks skinned meshes in their bind pose. If the app has both plugins, insert
/// `SimplifiedMesh(Handle::default())` on the skinned meshes: Bevy's plugin then finds no triangles of them.
#[derive(Clone, Copy, Debug, Default)]
pub struct SurfacePickingPlugin;

impl Plugin for SurfacePickingPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<RayMap>()
            .add_message::<PointerHits>()
            .register_type::<SurfacePick>()
            .add_systems(
                PreUpdate,
                pick.in_set(PickingSystems::Backend)
                    .after(ClamberSystems::Build),
            );
    }

    fn finish(&self, app: &mut App) {
        let me = "clamber's SurfacePickingPlugin";
        need_plugin::<SurfacePlugin>(app, me, "ClamberPlugins");
        need_plugin::<PickingPlugin>(
            app,
            me,
            "PickingPlugin of bevy_picking (DefaultPickingPlugins)",
        );
    }
}

/// An entity that a pointer may hit.
type Target = (
    Entity,
    &'static PosedSurface,
    &'static DrawnSurface,
    Option<&'static Pickable>,
    Option<&'static RenderLayers>,
    Option<&'static ViewVisibility>,
);

fn pick(
    rays: Res<RayMap>,
    cameras: Query<(&Camera, Option<&RenderLayers>)>,
    targets: Query<Target>,
    origin: Res<WorldOrigin>,
    mut hits: MessageWriter<PointerHits>,
) {
    for (id, ray) in rays.iter() {
        let Ok((camera, seen_layers)) = cameras.get(id.camera) else {
            continue;
        };
        let seen_layers = seen_layers.unwrap_or_default();
        let mut picks = Vec::new();
        let mut nearest_blocking = f32::INFINITY;
        for (entity, surface, drawn, pickable, layers, visibility) in &targets {
            let ignored = pickable == Some(&Pickable::IGNORE);
            let hidden = visibility.is_some_and(|visibility| !visibility.get());
            if ignored || hidden || !seen_layers.intersects(layers.unwrap_or_default()) {
                continue;
            }
            let Some((hit, pick)) =
                cast(entity, (surface, drawn), *ray, nearest_blocking, origin.0)
            else {
                continue;
            };
            if pickable.is_none_or(|pickable| pickable.should_block_lower) {
                nearest_blocking = hit.distance;
            }
            let (point, normal) = (Some(hit.point), Some(hit.normal));
            let data = HitData::new_with_extra(id.camera, hit.distance, point, normal, pick);
            picks.push((entity, data));
        }
        picks.retain(|(_, hit)| hit.depth <= nearest_blocking);
        if !picks.is_empty() {
            hits.write(PointerHits::new(id.pointer, picks, camera.order as f32));
        }
    }
}

/// The first point of skin along a ray, in the pose that the last frame drew.
fn cast(
    entity: Entity,
    (surface, drawn): (&PosedSurface, &DrawnSurface),
    ray: Ray3d,
    max_distance: f32,
    world: DVec3,
) -> Option<(EntityHit, SurfacePick)> {
    let drawn = drawn.pose(surface)?;
    let (origin, along) = in_f64(ray, world);
    let hit = drawn
        .in_world()
        .cast_ray(origin, along, max_distance.into())?;
    let world = world_hit(entity, &hit, world);
    let normal = world.normal.try_normalize().unwrap_or(Vec3::Y);
    let outward = Quat::from_rotation_arc(Vec3::Y, normal);
    let pick = SurfacePick {
        triangle: hit.triangle,
        source_triangle: surface.source_triangle(hit.triangle),
        barycentric: hit.barycentric,
        part: hit.part,
        tag: hit.tag,
        anchor: SurfaceAnchor::new(entity, drawn, drawn.anchor_at(&hit).ok()?, outward),
    };
    Some((world, pick))
}
