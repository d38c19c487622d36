//! Every bound against every vertex that it must hold, and against the tightest.

pub(crate) mod random;
mod weak_spots;

use glam::{DAffine3, DVec3, Vec3};

use super::*;
use crate::geometry::{Affine, Capsule, Sphere, rotation_from_axis_angle, widen};
use crate::mesh::{
    BuildOptions, ColliderMesh, Influence, MeshSource, PartId, SurfaceTag, VertexId,
};
use crate::rig::{JointId, Palette};
use crate::skin::skin;
use crate::surface::{SkinnedSurface, SurfaceError};
use crate::testing::{bend, direction, point, rigid, tube};
use random::{JOINTS, MOTIONS, Motion, Spread, creature, palette};

/// Checks all bounds of a node against all of its vertices; gives how many were checked.
fn check(mesh: &ColliderMesh, vertices: &[VertexId], palette: &Palette, case: &str) -> usize {
    let node = NodeBounds::new(mesh, vertices).unwrap();
    let maps = JointMaps::new(mesh, palette).unwrap();
    check_node(
        &node,
        &skin(mesh, palette.matrices()).unwrap(),
        vertices,
        &maps,
        case,
    )
}

fn check_node(
    node: &NodeBounds,
    skinned: &[Vec3],
    vertices: &[VertexId],
    maps: &JointMaps,
    case: &str,
) -> usize {
    let (hull, interval) = (node.hull(maps), node.weight_interval(maps));
    let (sphere, capsule) = (node.sphere(maps), node.capsule(maps));
    assert!(
        hull.radius.is_finite() && interval.radius.is_finite(),
        "{case}"
    );
    assert!(capsule.radius.is_finite(), "{case}");
    for v in vertices {
        let p = skinned[v.index()];
        assert!(hull.contains(p), "{case}: {p} outside hull {hull:?}");
        assert!(
            interval.contains(p),
            "{case}: {p} outside interval {interval:?}"
        );
        assert!(sphere.contains(p), "{case}: {p} outside {sphere:?}");
        assert!(capsule.contains(p), "{case}: {p} outside {capsule:?}");
        assert!(node.volume(maps).contains(p), "{case}: {p}");
    }
    vertices.len()
}

#[test]
fn no_vertex_lies_outside_whatever_the_creature_and_the_palette() {
    let mut rng = fastrand::Rng::with_seed(51);
    let mut checked = 0;
    for case in 0..2_400 {
        let influences = 1 + case % 16;
        let spread = [
            Spread::Random,
            Spread::NearlyEqual,
            Spread::Uneven,
            Spread::Few,
            Spread::Constant,
        ][case / 16 % 5];
        let (mesh, all) = creature(&mut rng, influences, spread);
        let small = all[..rng.usize(1..6).min(all.len())].to_vec();
        let nodes = [&all[..], &small].map(|v| (v, NodeBounds::new(&mesh, v).unwrap()));
        for motion in MOTIONS.into_iter().chain(MOTIONS) {
            let palette = palette(&mut rng, motion, mesh.radius());
            let maps = JointMaps::new(&mesh, &palette).unwrap();
            let skinned = skin(&mesh, palette.matrices()).unwrap();
            for (vertices, node) in &nodes {
                let case = format!("case {case}, {influences} {spread:?}, {motion:?}");
                checked += check_node(node, &skinned, vertices, &maps, &case);
            }
        }
    }
    assert!(checked > 2_000_000, "{checked} vertices");
}

#[test]
fn a_kilometre_away_what_skinning_rounds_is_within_the_bound() {
    // Rest radius and weights add nothing here: only the inflation holds the vertex.
    let mut rng = fastrand::Rng::with_seed(52);
    let (mut checked, mut outside) = (0, 0);
    for case in 0..2_000 {
        let (mesh, _) = creature(&mut rng, 1 + case % 16, Spread::Random);
        let shift = widen(direction(&mut rng)) * 1e3;
        let turn = rotation_from_axis_angle(widen(direction(&mut rng)).normalize(), 1.0);
        let palette = rigid(JOINTS, turn, shift);
        checked += check(&mesh, &[VertexId(0)], &palette, &format!("case {case}"));
        // The same ball without inflation, to see that this test sees something.
        let maps = JointMaps::new(&mesh, &palette).unwrap();
        let node = NodeBounds::new(&mesh, &[VertexId(0)]).unwrap();
        let center = node.weight_interval(&maps).center;
        let skinned = skin(&mesh, palette.matrices()).unwrap()[0];
        outside += usize::from(center != skinned);
    }
    assert!(checked == 2_000 && outside > 500, "{outside} of {checked}");
}

/// One triangle; every vertex follows both joints, `weights` of them joint 0.
fn triangle(corners: [Vec3; 3], weights: [f32; 3]) -> ColliderMesh {
    let given: Vec<Influence> = weights
        .into_iter()
        .flat_map(|weight| [(0, weight), (1, 1.0 - weight)])
        .map(|(joint, weight)| Influence {
            joint: JointId(joint),
            weight,
        })
        .collect();
    let source = MeshSource {
        positions: &corners,
        triangles: &[[0, 1, 2]],
        influences: &given,
        joint_count: 2,
        ..MeshSource::default()
    };
    ColliderMesh::build(&source, &BuildOptions::default())
        .unwrap()
        .0
}

#[test]
fn a_vertex_far_from_a_turning_mesh_origin_is_within_the_bound() {
    // No translation: what skinning rounds grows with the rest position alone, and the far vertex
    // stands on the rest ball.
    let mut rng = fastrand::Rng::with_seed(55);
    for case in 0..4_000 {
        let far = direction(&mut rng) * 1e3;
        let mesh = triangle([far, Vec3::ZERO, point(&mut rng, 1.0)], [rng.f32(); 3]);
        let turn = rotation_from_axis_angle(widen(direction(&mut rng)).normalize(), 1.0);
        let matrix = Affine::from_f64(&DAffine3::from_quat(turn));
        let palette = Palette::from_matrices([matrix; 2]);
        let case = format!("case {case}: {far}");
        check(&mesh, &[VertexId(0), VertexId(1)], &palette, &case);
        check(&mesh, &[VertexId(0)], &palette, &case);
    }
}

#[test]
fn the_hull_of_two_joints_is_the_smallest_ball_around_two_balls() {
    let mesh = triangle([Vec3::X, -Vec3::X, Vec3::Y], [1.0, 0.0, 0.5]);
    let all = [0, 1, 2].map(VertexId);
    let node = NodeBounds::new(&mesh, &all).unwrap();
    let moved = |scale: f32, x: f32| {
        let mut matrix = Affine::IDENTITY;
        matrix.rows = matrix.rows.map(|row| row.map(|m| m * scale));
        matrix.rows[0][3] = x;
        matrix
    };
    // Radius 3 about 0 and, in turn: 3 about 10, 1 about 1 (inside), 9 about 2 (around it).
    let cases = [
        (3.0, 10.0, 8.0, 5.0),
        (1.0, 1.0, 3.0, 0.0),
        (9.0, 2.0, 9.0, 2.0),
    ];
    for (scale, distance, radius, center) in cases {
        let palette = Palette::from_matrices([moved(3.0, 0.0), moved(scale, distance)]);
        let hull = node.hull(&JointMaps::new(&mesh, &palette).unwrap());
        assert!((hull.radius - radius).abs() < 0.1, "{radius}: {hull:?}");
        assert!((hull.center.x - center).abs() < 0.1, "{center}: {hull:?}");
    }
}

#[test]
fn at_rest_the_bound_is_the_rest_ball_by_a_hair() {
    let mesh = tube(4, 16);
    let bounds = PartBounds::new(&mesh);
    let palette = Palette::from_matrices([Affine::IDENTITY; 4]);
    let maps = JointMaps::new(&mesh, &palette).unwrap();
    assert_eq!(bounds.part_count(), mesh.parts().len());
    for (k, part) in mesh.parts().iter().enumerate() {
        let id = PartId(k as u32);
        check(&mesh, &part.vertices, &palette, &format!("{id}"));
        let node = bounds.node(id).unwrap();
        let (rest, sphere) = (node.rest_sphere(), bounds.sphere(id, &maps).unwrap());
        let share = sphere.radius / rest.radius;
        assert!(
            (1.0..1.00001).contains(&share),
            "{id}: {sphere:?}, {rest:?}"
        );
        let (rest, capsule) = (node.rest_capsule(), bounds.capsule(id, &maps).unwrap());
        let share = capsule.radius / rest.radius;
        assert!(
            (1.0..1.00001).contains(&share),
            "{id}: {capsule:?}, {rest:?}"
        );
    }
}

#[test]
fn on_a_bent_tube_the_sphere_is_within_a_fifth_of_the_tightest() {
    let mesh = tube(6, 24);
    let bounds = PartBounds::new(&mesh);
    let mut worst = [0.0f32; 2];
    for step in 0..40 {
        let palette = bend(6, DVec3::new(0.0, 0.6, 0.8), f64::from(step) * 0.03 - 0.6);
        let maps = JointMaps::new(&mesh, &palette).unwrap();
        let skinned = skin(&mesh, palette.matrices()).unwrap();
        for (k, part) in mesh.parts().iter().enumerate() {
            let id = PartId(k as u32);
            check(
                &mesh,
                &part.vertices,
                &palette,
                &format!("step {step}, part {id}"),
            );
            let positions = part.vertices.iter().map(|v| skinned[v.index()]);
            let tightest = Sphere::nearly_smallest(positions.clone()).unwrap();
            let sphere = bounds.sphere(id, &maps).unwrap();
            worst[0] = worst[0].max(sphere.radius / tightest.radius);
            let tightest = Capsule::around_principal_axis(positions).unwrap();
            let capsule = bounds.capsule(id, &maps).unwrap();
            worst[1] = worst[1].max(capsule.radius / tightest.radius);
        }
    }
    assert!(worst[0] < 1.2 && worst[1] < 1.6, "{worst:?}");
}

#[test]
fn the_smaller_of_hull_and_weight_interval_counts() {
    let mut rng = fastrand::Rng::with_seed(53);
    let mut hulls = 0;
    for case in 0..400 {
        let spread = [Spread::Random, Spread::Few, Spread::NearlyEqual][case % 3];
        let (mesh, all) = creature(&mut rng, 1 + case % 5, spread);
        let node = NodeBounds::new(&mesh, &all).unwrap();
        let palette = palette(&mut rng, Motion::Rotations, mesh.radius());
        let maps = JointMaps::new(&mesh, &palette).unwrap();
        let (hull, interval) = (node.hull(&maps), node.weight_interval(&maps));
        let sphere = node.sphere(&maps);
        let smaller = hull.radius.min(interval.radius);
        assert!(
            sphere.radius <= smaller.next_up(),
            "case {case}: {sphere:?}, {smaller}"
        );
        hulls += usize::from(hull.radius < interval.radius);
    }
    assert!((40..360).contains(&hulls), "hull smaller in {hulls} of 400");
}

#[test]
fn one_vertex_has_its_skinned_position_and_no_more() {
    let mesh = tube(4, 12);
    let palette = bend(4, DVec3::Z, 0.5);
    let maps = JointMaps::new(&mesh, &palette).unwrap();
    let skinned = skin(&mesh, palette.matrices()).unwrap();
    for (v, position) in skinned.iter().enumerate() {
        let node = NodeBounds::new(&mesh, &[VertexId(v as u32)]).unwrap();
        let sphere = node.sphere(&maps);
        assert!(
            sphere.contains(*position) && sphere.radius < 2e-5,
            "{v}: {sphere:?}"
        );
        let capsule = node.capsule(&maps);
        assert!(
            capsule.contains(*position) && capsule.radius < 2e-5,
            "{v}: {capsule:?}"
        );
    }
}

#[test]
fn middles_of_weights_add_up_to_exactly_one() {
    let mut rng = fastrand::Rng::with_seed(54);
    for case in 0..300 {
        let spread = [Spread::Uneven, Spread::Few][case / 16 % 2];
        let (mesh, patch) = creature(&mut rng, 1 + case % 16, spread);
        let vertices = patch[..rng.usize(1..=patch.len())].to_vec();
        let node = NodeBounds::new(&mesh, &vertices).unwrap();
        let sum: f64 = node.intervals().iter().map(|i| f64::from(i.middle)).sum();
        assert_eq!(sum, 1.0, "case {case}");
        for v in &vertices {
            for interval in node.intervals() {
                let weight = mesh.influences(*v).find(|(j, _)| *j == interval.joint);
                let weight = weight.map_or(0.0, |(_, w)| w);
                let (low, high) = (interval.low, interval.high);
                assert!((low..=high).contains(&weight), "case {case}: {interval:?}");
                let off = (weight - interval.middle).abs();
                assert!(off <= interval.deviation, "case {case}: {interval:?}");
            }
        }
    }
}

#[test]
fn parts_without_triangles_and_bad_input() {
    let mesh = tube(3, 8);
    let mut surface = SkinnedSurface::new(mesh.clone());
    for triangle in &mesh.parts()[0].triangles {
        surface
            .edit(|edit| edit.remove_triangle(*triangle))
            .unwrap();
    }
    let bounds = PartBounds::new(surface.mesh());
    let palette = Palette::from_matrices([Affine::IDENTITY; 3]);
    let mut maps = JointMaps::new(surface.mesh(), &palette).unwrap();
    assert_eq!(bounds.sphere(PartId(0), &maps), None);
    assert_eq!(bounds.capsule(PartId(99), &maps), None);
    assert!(bounds.volume(PartId(1), &maps).is_some());

    // A part that an edit appended is bounded as well.
    let corners = mesh.triangles()[mesh.parts()[0].triangles[0].index()];
    surface
        .edit(|edit| edit.add_triangle(corners, SurfaceTag::default()))
        .unwrap();
    assert!(PartBounds::new(surface.mesh()).node(PartId(0)).is_some());

    assert!(NodeBounds::new(&mesh, &[]).is_none());
    assert!(NodeBounds::new(&mesh, &[VertexId(u32::MAX)]).is_none());
    let short = Palette::from_matrices([Affine::IDENTITY; 2]);
    let refused = maps.update(&mesh, &short);
    assert!(matches!(
        refused,
        Err(SurfaceError::JointCount {
            expected: 3,
            found: 2
        })
    ));
    for bad in [f32::NAN, f32::INFINITY, 2e30] {
        let mut broken = Affine::IDENTITY;
        broken.rows[1][2] = bad;
        let palette = Palette::from_matrices([Affine::IDENTITY, broken, Affine::IDENTITY]);
        let refused = maps.update(&mesh, &palette);
        assert!(
            matches!(refused, Err(SurfaceError::Palette(JointId(1)))),
            "{bad}"
        );
    }
    assert!(
        maps.stretch(JointId(2))
            .is_some_and(|s| (1.0..1.0001).contains(&s))
    );
    assert!(maps.stretch(JointId(3)).is_none());
}
