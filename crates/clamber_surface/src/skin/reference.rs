use glam::DVec3;

use crate::geometry::{Affine, widen};
use crate::mesh::{ColliderMesh, VertexId};

/// Skins a vertex in f64 on the same f32 palette: the reference for every f32 kernel.
///
/// The reference's own error is about 2^-29 times the error of an f32 kernel. `None` if the vertex is out of range, or
/// if the number of matrices differs from the number of joints of the mesh.
pub fn skin_vertex_reference(
    mesh: &ColliderMesh,
    palette: &[Affine],
    vertex: VertexId,
) -> Option<DVec3> {
    let p = *mesh.positions().get(vertex.index())?;
    if palette.len() != mesh.joint_count() {
        return None;
    }
    let mut sum = DVec3::ZERO;
    for (joint, weight) in mesh.influences(vertex) {
        sum += palette[joint.0 as usize].transform_point_reference(p) * f64::from(weight);
    }
    Some(sum)
}

/// An upper bound, per coordinate, of the difference between an f32 kernel that keeps the skinning contract and
/// exact arithmetic: `(n + 4) 2^-24 sum_k w_k (|M_k| |p| + |t_k|) + (4 n + 4) 2^-149` for n influences.
///
/// Each term has three roundings in its row, one by its weight and at most n in the sum, each of relative size
/// 2^-24 (Higham 2002, section 3.1). The addition to +0 is exact, so one unit is left to cover the products of
/// roundings. The last term bounds underflow. `None` as for [`skin_vertex_reference`].
pub fn error_bound(mesh: &ColliderMesh, palette: &[Affine], vertex: VertexId) -> Option<DVec3> {
    let p = widen(*mesh.positions().get(vertex.index())?).abs();
    if palette.len() != mesh.joint_count() {
        return None;
    }
    let mut sum = DVec3::ZERO;
    let mut influences = 0.0;
    for (joint, weight) in mesh.influences(vertex) {
        let map = palette[joint.0 as usize].to_f64();
        let linear = map.matrix3;
        let size = linear.x_axis.abs() * p.x
            + linear.y_axis.abs() * p.y
            + linear.z_axis.abs() * p.z
            + map.translation.abs();
        sum += size * f64::from(weight);
        influences += 1.0;
    }
    let relative = (influences + 4.0) * f64::from(f32::EPSILON) * 0.5;
    let underflow = (4.0 * influences + 4.0) * f64::from(f32::from_bits(1));
    Some(sum * relative + DVec3::splat(underflow))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Influence;
    use crate::skin::skin;
    use crate::testing::{bits, influence, separate, skinned_mesh};
    use glam::Vec3;

    /// A soup of vertices on random joints, and a palette with shear, mirrors and translations.
    fn random_case(rng: &mut fastrand::Rng, influences: usize) -> (ColliderMesh, Vec<Affine>) {
        let joints = 24;
        // The smallest are subnormal: there products underflow.
        let size = [1e-42, 1e-36, 1e-3, 1.0, 1e3][rng.usize(0..5)];
        let mut coordinate = || (rng.f32() * 2.0 - 1.0) * size;
        let positions: Vec<Vec3> = (0..60)
            .map(|_| Vec3::new(coordinate(), coordinate(), coordinate()))
            .collect();
        let palette = (0..joints)
            .map(|_| Affine {
                rows: std::array::from_fn(|_| {
                    std::array::from_fn(|c| {
                        let x = rng.f32() * 4.0 - 2.0;
                        if c == 3 { x * size } else { x }
                    })
                }),
            })
            .collect();
        let given: Vec<Influence> = (0..positions.len() * influences)
            .map(|_| influence(rng.u32(0..joints), rng.f32() + 1e-3))
            .collect();
        let mesh = skinned_mesh(&positions, &separate(20), &given, joints as usize);
        (mesh, palette)
    }

    #[test]
    fn kernel_stays_within_the_bound_and_comes_near_it() {
        let mut rng = fastrand::Rng::with_seed(5);
        let mut worst = 0.0f64;
        for case in 0..600 {
            let (mesh, palette) = random_case(&mut rng, 1 + case % 16);
            let skinned = skin(&mesh, &palette).unwrap();
            for (v, position) in skinned.iter().enumerate() {
                let vertex = VertexId(v as u32);
                let exact = skin_vertex_reference(&mesh, &palette, vertex).unwrap();
                let bound = error_bound(&mesh, &palette, vertex).unwrap();
                let share = ((widen(*position) - exact).abs() / bound).max_element();
                assert!(share <= 1.0, "case {case} vertex {v}: {share} of the bound");
                worst = worst.max(share);
            }
        }
        // A bound far above every error would hide a broken kernel.
        assert!(worst > 0.2, "worst share {worst}");
    }

    /// Skins one vertex at (1, 1, 1) on the given joints. The other two corners only complete its triangle.
    fn skin_one(palette: &[Affine], weights: &[f32]) -> Vec3 {
        let count = palette.len() as u32;
        let given: Vec<Influence> = (0..3)
            .flat_map(|_| (0..count).zip(weights))
            .map(|(joint, weight)| influence(joint, *weight))
            .collect();
        let corners = [Vec3::ONE, Vec3::X, Vec3::Y];
        let mesh = skinned_mesh(&corners, &[[0, 1, 2]], &given, palette.len());
        skin(&mesh, palette).unwrap()[0]
    }

    #[test]
    fn rows_and_sums_run_in_the_order_of_the_contract() {
        // Half a unit in the last place of 1: added alone it is lost, two of them make a step.
        let half = f32::EPSILON / 2.0;
        let mut matrix = Affine::IDENTITY;
        matrix.rows[0] = [1.0, 0.0, half, half];
        matrix.rows[1] = [half, half, 1.0, 0.0];
        matrix.rows[2] = [half, 0.0, half, 1.0];
        let p = skin_one(&[matrix], &[1.0]);
        assert_eq!(p.x, 1.0 + f32::EPSILON, "z and translation are added first");
        assert_eq!(p.y, 1.0 + f32::EPSILON, "x and y are added first");
        assert_eq!(p.z, 1.0, "x is added to z plus translation, not to z");
        // By ascending joint: (1 + half) + half is 1, half + (half + 1) would be a step.
        let moved = |x: f32| Affine {
            rows: [[0.0, 0.0, 0.0, x], [0.0; 4], [0.0; 4]],
        };
        let palette = [
            moved(4.0),
            moved(2.0 * f32::EPSILON),
            moved(2.0 * f32::EPSILON),
        ];
        let p = skin_one(&palette, &[0.25, 0.25, 0.5]);
        assert_eq!(p.x, 1.0 + f32::EPSILON);
        let palette = [moved(4.0), moved(2.0 * half), moved(2.0 * half)];
        assert_eq!(skin_one(&palette, &[0.25, 0.5, 0.25]).x, 1.0);
        // From +0: a sum of negative zeros is a positive one.
        let p = skin_one(&[moved(-0.0)], &[1.0]);
        assert_eq!(p.x.to_bits(), 0.0f32.to_bits());
    }

    #[test]
    fn padding_with_joints_of_weight_zero_changes_no_bit() {
        // The sum by hand, over all joints of the palette instead of the vertex's own.
        let mut rng = fastrand::Rng::with_seed(6);
        for case in 0..100 {
            let (mesh, palette) = random_case(&mut rng, 1 + case % 6);
            let skinned = skin(&mesh, &palette).unwrap();
            for (v, position) in skinned.iter().enumerate() {
                let p = mesh.positions()[v];
                let mut sum = Vec3::ZERO;
                for (joint, matrix) in palette.iter().enumerate() {
                    let mut influences = mesh.influences(VertexId(v as u32));
                    let weight = influences.find(|(j, _)| j.0 as usize == joint);
                    let weight = weight.map_or(0.0, |(_, w)| w);
                    sum += matrix.transform_point(p) * weight;
                }
                assert_eq!(bits(&[sum]), bits(&[*position]), "case {case} vertex {v}");
            }
        }
    }

    #[test]
    fn a_palette_of_the_wrong_length_is_refused() {
        let mut rng = fastrand::Rng::with_seed(8);
        let (mesh, palette) = random_case(&mut rng, 2);
        assert!(skin(&mesh, &palette[1..]).is_err());
        assert!(skin_vertex_reference(&mesh, &palette[1..], VertexId(0)).is_none());
        assert!(error_bound(&mesh, &palette, VertexId(u32::MAX)).is_none());
    }
}
