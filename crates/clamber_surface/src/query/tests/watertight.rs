//! Rays from inside a closed mesh, at its edges and vertices, through the whole surface: bounds, cache and boxes
//! included. Each of them must hit, since the mesh is closed.

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};

use crate::geometry::{Affine, Ray, rotation_from_axis_angle, widen};
use crate::mesh::{ColliderBuildOptions, ColliderMesh, Influence, MeshSource};
use crate::rig::Palette;
use crate::surface::SkinnedSurface;
use crate::testing::{self, advance, cases, influence, point, positions_of};

/// A sphere of radius 1 about `center`. Its south follows one joint and its north another, blended between.
fn sphere(center: Vec3) -> Arc<ColliderMesh> {
    let (local, triangles) = testing::sphere(|_, _| 1.0);
    let influences: Vec<Influence> = local
        .iter()
        .flat_map(|p| [(0, 0.5 - 0.5 * p.y), (1, 0.5 + 0.5 * p.y)])
        .map(|(joint, weight)| influence(joint, weight.max(0.0)))
        .collect();
    let positions: Vec<Vec3> = local.iter().map(|p| *p + center).collect();
    let source = MeshSource {
        positions: &positions,
        triangles: &triangles,
        influences: &influences,
        joint_count: 2,
        ..MeshSource::default()
    };
    let (mesh, report) = ColliderMesh::build(&source, &ColliderBuildOptions::default()).unwrap();
    assert_eq!((report.welded, report.degenerate_triangles), (0, 0));
    Arc::new(mesh)
}

/// Turns the north by `angle` about the centre, and displaces everything by `shift`.
fn pose(center: Vec3, angle: f64, shift: Vec3) -> Palette {
    let center = widen(center);
    let turn = DAffine3::from_translation(center + widen(shift))
        * DAffine3::from_quat(rotation_from_axis_angle(DVec3::Z, angle))
        * DAffine3::from_translation(-center);
    let still = DAffine3::from_translation(widen(shift));
    Palette::from_matrices([still, turn].map(|map| Affine::from_f64(&map)))
}

/// The number of rays, aimed at points of edges or at vertices, that leave without a hit.
fn leaks(surface: &SkinnedSurface, center: Vec3, rays: u32, at_vertices: bool) -> u32 {
    let mut rng = fastrand::Rng::with_seed(91);
    let positions = positions_of(surface);
    let triangles = surface.mesh().triangles();
    let mut leaks = 0;
    for _ in 0..rays {
        let corners = triangles[rng.usize(0..triangles.len())].map(|v| positions[v.index()]);
        let side = rng.usize(0..3);
        let (a, b) = (corners[side], corners[(side + 1) % 3]);
        let along = if at_vertices { 0.0 } else { rng.f32() };
        let target = a + (b - a) * along;
        let origin = center + point(&mut rng, 0.15);
        let ray = Ray::new(origin, target - origin).unwrap();
        let hit = surface.in_model().cast_ray(&ray, f32::INFINITY);
        leaks += u32::from(hit.is_none());
    }
    leaks
}

fn assert_watertight(rays: u32) {
    let far = Vec3::new(1000.0, -1000.0, 1000.0);
    for (center, shift) in [
        (Vec3::ZERO, Vec3::ZERO),
        (Vec3::ZERO, far),
        (far, Vec3::ZERO),
    ] {
        let mut surface = SkinnedSurface::new(sphere(center));
        for angle in [0.0, 0.7] {
            advance(&mut surface, &pose(center, angle, shift));
            for at_vertices in [false, true] {
                let leaks = leaks(&surface, center + shift, rays, at_vertices);
                let case = format!("{center} {shift} {angle} vertices {at_vertices}");
                assert_eq!(leaks, 0, "{case}");
            }
        }
    }
}

#[test]
fn no_ray_at_an_edge_or_a_vertex_leaks_through_the_surface() {
    assert_watertight(cases(100_000) as u32);
}

#[test]
#[ignore = "a million rays per case: run it in release"]
fn no_ray_of_a_million_leaks_through_the_surface() {
    assert_watertight(1_000_000);
}
