//! Checks that every bound holds its vertices, and that it is little larger than the tightest one.

pub(crate) mod random;
mod weak_spots;

use glam::{DAffine3, DVec3, Vec3};

use super::*;
use crate::geometry::{Affine, Sphere, rotation_from_axis_angle, widen};
use crate::mesh::hierarchy::{Child, Hierarchy};
use crate::mesh::{ColliderMesh, PaletteError, PartId, Summarizer, SurfaceTag, VertexId};
use crate::rig::{JointId, Palette};
use crate::simd::SimdLevel;
use crate::skin::skin;
use crate::surface::SkinnedSurface;
use crate::testing::{bend, direction, influence, point, rigid, skinned_mesh, tube};
use random::{JOINTS, Spread, creature};

/// A node whose children are sets of vertices.
pub(super) fn node_of(mesh: &ColliderMesh, sets: &[Vec<VertexId>]) -> Hierarchy {
    let mut summarizer = Summarizer::new(mesh);
    let children = (0..).map(Child::Cluster).zip(sets);
    let children: Vec<_> = children
        .map(|(child, set)| (child, summarizer.of_vertices(set)))
        .collect();
    let mut hierarchy = Hierarchy::default();
    let node = hierarchy.node_of(&children);
    hierarchy.nodes.push(node);
    hierarchy
}

/// Asserts that every vertex lies in the box around the mesh, and returns the box.
pub(super) fn assert_in_root_box(mesh: &ColliderMesh, palette: &[Affine], case: &str) -> RootBox {
    let mut table = JointTable::default();
    table.update(palette);
    let found = root_box(mesh.joint_balls(), &table);
    for p in skin(mesh, palette).unwrap() {
        let inside = p.cmpge(found.min).all() && p.cmple(found.max).all();
        assert!(inside, "{case}: {p} outside {found:?}");
    }
    found
}

/// Asserts that the sphere of a set of vertices holds all of them, and returns it.
fn check(mesh: &ColliderMesh, vertices: &[VertexId], palette: &Palette, case: &str) -> Sphere {
    let hierarchy = node_of(mesh, &[vertices.to_vec()]);
    let mut table = JointTable::default();
    table.update(palette.matrices());
    let found = spheres(SimdLevel::best(), &hierarchy, &hierarchy.nodes[0], &table);
    let sphere = found.sphere(0);
    let skinned = skin(mesh, palette.matrices()).unwrap();
    for v in vertices {
        let p = skinned[v.index()];
        assert!(sphere.contains(p), "{case}: {p} outside {sphere:?}");
    }
    sphere
}

#[test]
fn rounding_errors_a_kilometre_away_are_within_the_bound() {
    // Rest radius and weights add nothing here: only the inflation holds the vertices.
    let mut rng = fastrand::Rng::with_seed(52);
    for case in 0..2_000 {
        let (mesh, _) = creature(&mut rng, 1 + case % 16, Spread::Random);
        let shift = widen(direction(&mut rng)) * 1e3;
        let turn = rotation_from_axis_angle(widen(direction(&mut rng)).normalize(), 1.0);
        let palette = rigid(JOINTS, turn, shift);
        check(&mesh, &[VertexId(0)], &palette, &format!("case {case}"));
    }
}

#[test]
fn a_vertex_far_from_a_turning_mesh_origin_is_within_the_bound() {
    // No translation: the rounding error of skinning grows with the rest position alone, and the far vertex lies on
    // the rest ball.
    let mut rng = fastrand::Rng::with_seed(55);
    for case in 0..4_000 {
        let far = direction(&mut rng) * 1e3;
        let weight = rng.f32();
        let influences = [influence(0, weight), influence(1, 1.0 - weight)];
        let corners = [far, Vec3::ZERO, point(&mut rng, 1.0)];
        let mesh = skinned_mesh(&corners, &[[0, 1, 2]], &[influences; 3].concat(), 2);
        let turn = rotation_from_axis_angle(widen(direction(&mut rng)).normalize(), 1.0);
        let matrix = Affine::from_f64(&DAffine3::from_quat(turn));
        let palette = Palette::from_matrices([matrix; 2]);
        let case = format!("case {case}: {far}");
        check(&mesh, &[VertexId(0), VertexId(1)], &palette, &case);
        check(&mesh, &[VertexId(0)], &palette, &case);
    }
}

#[test]
fn at_rest_the_bound_is_hardly_larger_than_the_rest_ball() {
    let mesh = tube(4, 16);
    let palette = Palette::from_matrices([Affine::IDENTITY; 4]);
    for (index, part) in mesh.parts().iter().enumerate() {
        let rest = Summarizer::new(&mesh).of_vertices(&part.vertices).ball;
        let sphere = check(&mesh, &part.vertices, &palette, &format!("part {index}"));
        let share = sphere.radius / rest.radius;
        assert!((1.0..1.00001).contains(&share), "{sphere:?}, {rest:?}");
    }
}

#[test]
fn on_a_bent_tube_the_spheres_of_parts_are_within_a_fifth_of_the_tightest() {
    let mesh = tube(6, 24);
    let mut surface = SkinnedSurface::new(mesh.clone());
    let mut worst = 0.0f32;
    for step in 0..40 {
        let palette = bend(6, DVec3::new(0.0, 0.6, 0.8), f64::from(step) * 0.03 - 0.6);
        surface.advance(&palette, Default::default()).unwrap();
        let skinned = skin(&mesh, palette.matrices()).unwrap();
        let mut parts = 0;
        for (id, sphere) in surface.in_model().part_spheres() {
            let vertices = mesh.parts()[id.index()].vertices.iter();
            let positions = vertices.map(|v| skinned[v.index()]);
            for p in positions.clone() {
                assert!(sphere.contains(p), "step {step}, part {id}: {p} {sphere:?}");
            }
            let tightest = Sphere::nearly_smallest(positions).unwrap();
            worst = worst.max(sphere.radius / tightest.radius);
            parts += 1;
        }
        assert_eq!(parts, mesh.parts().len());
    }
    assert!(worst < 1.2, "{worst}");
}

#[test]
fn the_bound_of_one_vertex_is_hardly_more_than_its_position() {
    let mesh = tube(4, 12);
    let palette = bend(4, DVec3::Z, 0.5);
    for v in (0..mesh.positions().len() as u32).map(VertexId) {
        let sphere = check(&mesh, &[v], &palette, &format!("{v}"));
        assert!(sphere.radius < 2e-5, "{v}: {sphere:?}");
    }
}

#[test]
fn a_part_has_a_bound_while_it_has_triangles() {
    let mesh = tube(3, 8);
    let mut surface = SkinnedSurface::new(mesh.clone());
    let bounded = |surface: &SkinnedSurface| -> Vec<PartId> {
        let space = surface.in_model();
        space.part_spheres().map(|(part, _)| part).collect()
    };
    assert_eq!(bounded(&surface), [0, 1, 2].map(PartId));
    for triangle in &mesh.parts()[0].triangles {
        surface
            .edit(|edit| edit.remove_triangle(*triangle))
            .unwrap();
    }
    assert_eq!(bounded(&surface), [1, 2].map(PartId));
    let corners = mesh.triangles()[mesh.parts()[0].triangles[0].index()];
    surface
        .edit(|edit| edit.add_triangle(corners, SurfaceTag::default()))
        .unwrap();
    assert_eq!(bounded(&surface), [0, 1, 2].map(PartId));
}

#[test]
fn palettes_that_do_not_fit_are_refused() {
    let mesh = tube(3, 8);
    let refused = mesh.check_palette(&[Affine::IDENTITY; 2]);
    let (expected, found) = (3, 2);
    assert_eq!(refused, Err(PaletteError::JointCount { expected, found }));
    for bad in [f32::NAN, f32::INFINITY, 2e30] {
        let mut broken = Affine::IDENTITY;
        broken.rows[1][2] = bad;
        let refused = mesh.check_palette(&[Affine::IDENTITY, broken, Affine::IDENTITY]);
        assert_eq!(refused, Err(PaletteError::Matrix(JointId(1))), "{bad}");
    }
    assert_eq!(mesh.check_palette(&[Affine::IDENTITY; 3]), Ok(()));
}
