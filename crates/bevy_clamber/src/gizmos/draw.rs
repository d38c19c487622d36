use std::collections::BTreeMap;

use bevy_color::Color;
use bevy_ecs::prelude::*;
use bevy_gizmos::gizmos::Gizmos;
use bevy_math::{Isometry3d, Vec3};
use bevy_time::{Fixed, Time};
use bevy_transform::components::Transform;
use clamber_surface::mesh::{ColliderMesh, TriangleId, VertexId};
use clamber_surface::surface::SkinnedSurface;

use glam::DVec3;

use super::SurfaceGizmos;
use super::touched::TouchedClusters;
use crate::{DrawnSurface, PosedSurface, SurfaceAnchor, WorldOrigin};

// Colours by Okabe and Ito, which colour-blind people can tell apart.
const PART: Color = Color::srgba(0.34, 0.71, 0.91, 0.5);
const CLUSTER: Color = Color::srgb(0.9, 0.62, 0.0);
const CONTACT: Color = Color::srgba(0.0, 0.62, 0.45, 0.6);
const VELOCITY: Color = Color::srgb(0.94, 0.89, 0.26);

/// Length of a velocity's arrow, seconds of motion: visible on a walking creature, and not longer than the picture on a
/// fast one.
const VELOCITY_ARROW: f64 = 0.1;

/// Length of an anchor's axes, as a share of the mesh's radius: visible with the whole creature in view, and shorter
/// than its limbs.
const ANCHOR_AXES: f64 = 0.03;

/// Draws parts, clusters and contacts.
pub(super) fn draw_surfaces(
    surfaces: Query<(Entity, &PosedSurface, &DrawnSurface)>,
    touched: Res<TouchedClusters>,
    origin: Res<WorldOrigin>,
    mut gizmos: Gizmos<SurfaceGizmos>,
) {
    let show = *gizmos.config_ext;
    if gizmos.config.enabled {
        for (entity, surface, drawn) in &surfaces {
            if !(show.parts || show.clusters || show.contacts) {
                continue;
            }
            let Some(drawn) = drawn.pose(surface) else {
                continue;
            };
            if show.parts {
                draw_parts(drawn, origin.0, &mut gizmos);
            }
            if !(show.clusters || show.contacts) {
                continue;
            }
            let clusters = surface.clusters().zip(touched.of(entity, surface));
            for (cluster, _) in clusters.filter(|(_, touched)| *touched) {
                if show.contacts {
                    draw_triangles(drawn, origin.0, cluster.triangles, &mut gizmos);
                }
                if show.clusters {
                    draw_border(drawn, origin.0, cluster.triangles, &mut gizmos);
                }
            }
        }
    }
}

/// Draws anchors and velocities.
pub(super) fn draw_anchors(
    anchors: Query<&SurfaceAnchor>,
    surfaces: Query<(&PosedSurface, &DrawnSurface)>,
    tick: Res<Time<Fixed>>,
    origin: Res<WorldOrigin>,
    mut gizmos: Gizmos<SurfaceGizmos>,
) {
    let show = *gizmos.config_ext;
    if !gizmos.config.enabled || !(show.anchors || show.velocities) {
        return;
    }
    for anchor in &anchors {
        let Ok((surface, drawn)) = surfaces.get(anchor.surface) else {
            continue;
        };
        let Some(drawn) = drawn.pose(surface) else {
            continue;
        };
        let mut here = *anchor;
        let Some(world_from_anchor) = here.follow(drawn) else {
            continue;
        };
        let size = f64::from(drawn.mesh().radius()) * drawn.world_from_model().scale;
        let (_, rotation, position) = world_from_anchor.to_scale_rotation_translation();
        let start = (position - origin.0).as_vec3();
        if show.anchors {
            let axes = Transform::from_translation(start).with_rotation(rotation.as_quat());
            gizmos.axes(axes, (size * ANCHOR_AXES) as f32);
        }
        let seconds = tick.timestep().as_secs_f64();
        let motion = anchor.anchor().ok();
        let motion = motion.and_then(|anchor| surface.in_world().motion(&anchor, seconds).ok());
        if let (true, Some(motion)) = (show.velocities, motion) {
            let arrow = (motion.velocity * VELOCITY_ARROW).as_vec3();
            // The head of an arrow of zero length has no direction.
            if arrow.try_normalize().is_some() {
                gizmos.arrow(start, start + arrow, VELOCITY);
            }
        }
    }
}

fn draw_parts(drawn: &SkinnedSurface, origin: DVec3, gizmos: &mut Gizmos<SurfaceGizmos>) {
    let world_from_model = drawn.world_from_model();
    for (_, sphere) in drawn.in_model().part_spheres() {
        let center = world_from_model.transform_point_f32(sphere.center);
        let radius = f64::from(sphere.radius) * world_from_model.scale;
        let place = Isometry3d::from_translation((center - origin).as_vec3());
        gizmos.sphere(place, radius as f32, PART);
    }
}

fn draw_triangles(
    drawn: &SkinnedSurface,
    origin: DVec3,
    triangles: &[TriangleId],
    gizmos: &mut Gizmos<SurfaceGizmos>,
) {
    for triangle in triangles {
        let corners = corners(drawn.mesh(), *triangle);
        if let Some([a, b, c]) = corners.and_then(|corners| positions(drawn, origin, corners)) {
            gizmos.linestrip([a, b, c, a], CONTACT);
        }
    }
}

/// Draws the edges that belong to only one of the given triangles.
fn draw_border(
    drawn: &SkinnedSurface,
    origin: DVec3,
    triangles: &[TriangleId],
    gizmos: &mut Gizmos<SurfaceGizmos>,
) {
    let mut counts: BTreeMap<[VertexId; 2], u32> = BTreeMap::new();
    for triangle in triangles {
        let Some([a, b, c]) = corners(drawn.mesh(), *triangle) else {
            continue;
        };
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *counts.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
    }
    for (edge, _) in counts.into_iter().filter(|(_, count)| *count == 1) {
        if let Some([from, to]) = positions(drawn, origin, edge) {
            gizmos.line(from, to, CLUSTER);
        }
    }
}

fn corners(mesh: &ColliderMesh, triangle: TriangleId) -> Option<[VertexId; 3]> {
    mesh.triangles().get(triangle.index()).copied()
}

/// Positions of vertices, relative to Bevy's origin.
fn positions<const N: usize>(
    drawn: &SkinnedSurface,
    origin: DVec3,
    vertices: [VertexId; N],
) -> Option<[Vec3; N]> {
    let mut positions = [Vec3::ZERO; N];
    for (position, vertex) in positions.iter_mut().zip(vertices) {
        let in_model = drawn.in_model().position(vertex)?;
        let in_world = drawn.world_from_model().transform_point_f32(in_model);
        *position = (in_world - origin).as_vec3();
    }
    Some(positions)
}
