//! The giant's bounds over all its clips, checked through queries: a query at a vertex must pass all bounds that
//! contain the vertex (root box, lanes of nodes, its cluster's lane, its boxes).

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use clamber::geometry::{Capsule, Ray};
use clamber::prelude::*;
use clamber_scenes::giant;
use glam::Vec3;

/// Checks every `stride`th vertex in `poses` poses of each clip; returns the number of checks.
fn check(poses: u32, stride: usize) -> usize {
    let creature = giant::giant().unwrap();
    let mesh = &creature.rig.collider;
    let mut around = vec![Vec::new(); mesh.positions().len()];
    for (id, corners) in mesh.triangles().iter().enumerate() {
        for corner in corners {
            around[corner.index()].push(TriangleId(id as u32));
        }
    }
    let rest = creature.rig.skeleton.rest_pose();
    let mut surface = SkinnedSurface::new(mesh.clone());
    let (mut positions, mut hits) = (Vec::new(), Vec::new());
    let mut checked = 0;
    for clip in &creature.rig.clips {
        for k in 0..poses {
            let time = clip.duration() * f64::from(k) / f64::from(poses);
            let pose = clip.sample(&rest, time, Playback::Loop).unwrap();
            let palette = creature.rig.skeleton.palette(&pose).unwrap();
            surface.advance(&palette, Similarity::IDENTITY).unwrap();
            if k % 2 == 1 {
                surface.skin_ahead();
            }
            surface.skin_all(&mut positions);
            for (part, volume) in surface.in_model().part_spheres() {
                let part = &mesh.parts()[part.index()];
                for vertex in &part.vertices {
                    let p = positions[vertex.index()];
                    assert!(volume.contains(p), "{}, {time} s: {p}", clip.name);
                    checked += 1;
                }
            }
            let first = k as usize % stride;
            for (vertex, p) in positions.iter().enumerate().skip(first).step_by(stride) {
                let touching = Capsule::ball(*p, 0.0).unwrap();
                let space = surface.in_model();
                space.overlap_capsule(&touching, &mut hits);
                for triangle in &around[vertex] {
                    let found = hits.iter().any(|hit| hit.triangle == *triangle);
                    assert!(found, "{}, {time} s: {vertex}, {triangle}", clip.name);
                }
                let nearest = space.closest_point(*p, 0.0);
                assert!(nearest.is_some(), "{}, {time} s: {vertex}", clip.name);
                let above = Ray::new(*p + Vec3::Y * 100.0, -Vec3::Y).unwrap();
                let met = surface.in_model().intersects_ray(&above, 100.5);
                assert!(met, "{}, {time} s: {vertex}", clip.name);
                checked += 1;
            }
        }
    }
    checked
}

#[test]
fn a_query_at_a_vertex_reaches_its_triangles_in_every_clip() {
    let checked = check(20, 20);
    println!("{checked} checks");
    assert!(checked > 1_000_000, "{checked}");
}

#[test]
#[ignore = "minutes: run it in release"]
fn a_query_at_any_vertex_reaches_its_triangles_in_every_clip() {
    println!("{} checks", check(60, 1));
}
