//! Creatures whose vertices lie within a bound because of a single term. Without that term, a test fails.

use std::sync::Arc;

use glam::{DAffine3, Vec3};

use super::assert_in_root_box;
use crate::bounds::{JointTable, spheres};
use crate::geometry::{Affine, rotation_from_axis_angle, widen};
use crate::mesh::{ColliderMesh, Influence};
use crate::simd::SimdLevel;
use crate::skin::skin;
use crate::testing::{direction, influence, skinned_mesh};

/// A mesh of one triangle, from its corners and the weights of each corner by joint.
fn triangle(corners: [Vec3; 3], weights: [&[f32]; 3]) -> Arc<ColliderMesh> {
    let joints = weights.map(<[f32]>::len).into_iter().max().unwrap_or(0);
    let given: Vec<Influence> = weights
        .iter()
        .flat_map(|weights| (0..).zip(weights.iter()))
        .map(|(joint, weight)| influence(joint, *weight))
        .collect();
    Arc::new(skinned_mesh(&corners, &[[0, 1, 2]], &given, joints))
}

fn turn(rng: &mut fastrand::Rng) -> Affine {
    let axis = widen(direction(rng)).normalize();
    let angle = rng.f64() * 6.0;
    Affine::from_f64(&DAffine3::from_quat(rotation_from_axis_angle(axis, angle)))
}

/// Asserts that every vertex lies in the sphere of the hierarchy's only lane.
fn assert_in_lane(mesh: &ColliderMesh, palette: &[Affine], case: &str) {
    let hierarchy = mesh.hierarchy();
    let node = &hierarchy.nodes[0];
    let mut table = JointTable::default();
    table.update(palette);
    for level in SimdLevel::available() {
        let found = spheres(level, hierarchy, node, &table);
        let sphere = found.sphere(0);
        for p in skin(mesh, palette).unwrap() {
            let inside = sphere.contains(p);
            assert!(inside, "{case}, {level}: {p} outside {sphere:?}");
        }
    }
}

#[test]
fn rounding_errors_are_within_the_root_box_where_each_joint_moves_one_vertex() {
    // Every joint's rest ball is a point: only the inflation relative to its distance is left.
    let mut rng = fastrand::Rng::with_seed(111);
    for case in 0..2_000 {
        let center = direction(&mut rng) * 1e3;
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| p + center);
        let mesh = triangle(
            corners,
            [&[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0], &[0.0, 0.0, 1.0]],
        );
        let palette = [turn(&mut rng), turn(&mut rng), turn(&mut rng)];
        assert_in_root_box(&mesh, &palette, &format!("case {case}"));
    }
}

#[test]
fn rounding_errors_of_a_far_translation_are_within_the_root_box() {
    let mut rng = fastrand::Rng::with_seed(112);
    for case in 0..2_000 {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| p * 1e-3);
        let mesh = triangle(
            corners,
            [&[0.3, 0.3, 0.4], &[0.1, 0.3, 0.6], &[0.2, 0.2, 0.6]],
        );
        let mut matrix = turn(&mut rng);
        let far = direction(&mut rng) * 1e6;
        for (row, x) in matrix.rows.iter_mut().zip(far.to_array()) {
            row[3] = x;
        }
        assert_in_root_box(&mesh, &[matrix; 3], &format!("case {case}"));
    }
}

#[test]
fn a_joint_whose_weight_middle_rounds_to_zero_still_moves_its_vertex() {
    // The smallest weight above zero, on a joint a thousand kilometres away, moves the vertex by 6 cm.
    let unit = 1.0 / 16_777_216.0;
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| p * 1e-3);
    let mesh = triangle(corners, [&[1.0 - unit, unit], &[1.0, 0.0], &[1.0, 0.0]]);
    let node = &mesh.hierarchy().nodes[0];
    let rows = node.weights(mesh.hierarchy());
    assert_eq!((rows[1].middle[0], rows[1].deviation[0]), (0.0, unit));
    let mut far = Affine::IDENTITY;
    far.rows[1][3] = 1e6;
    let palette = [Affine::IDENTITY, far];
    let moved = skin(&mesh, &palette).unwrap()[0] - corners[0];
    assert!(moved.length() > 0.05, "{moved}");
    assert_in_lane(&mesh, &palette, "tiny weight");
}

#[test]
fn rounding_errors_of_a_turning_lane_far_from_the_origin_are_within_its_sphere() {
    // No translation: the rounding error of skinning grows with the rest position alone.
    let mut rng = fastrand::Rng::with_seed(113);
    for case in 0..4_000 {
        let far = direction(&mut rng) * 1e3;
        // As small as the coordinates allow: their last place is 6e-5 there.
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| far + p * 1.3e-4);
        // Rounding puts the corners of some triangles on one line.
        if crate::geometry::triangle::scaled_normal(corners).length() == 0.0 {
            continue;
        }
        let mesh = triangle(corners, [&[1.0], &[1.0], &[1.0]]);
        assert_in_lane(&mesh, &[turn(&mut rng)], &format!("case {case}: {far}"));
    }
}
