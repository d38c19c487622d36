//! Tests that the device poses vertices like the collider's skinning.

use crate::common;

use clamber_render::{RenderError, RenderMesh, Renderer, SkinSource};
use clamber_surface::geometry::{Affine, rotation_from_axis_angle};
use clamber_surface::mesh::Influence;
use clamber_surface::rig::{JointId, Palette};
use glam::{DVec3, Vec3};

/// Number of joints of the test body.
const JOINTS: usize = 12;

/// Vertices with one to eight influences each.
struct Body {
    positions: Vec<Vec3>,
    influences: Vec<Influence>,
    ends: Vec<u32>,
}

fn body(count: usize) -> Body {
    let mut rng = fastrand::Rng::with_seed(5);
    let mut body = Body {
        positions: Vec::new(),
        influences: Vec::new(),
        ends: Vec::new(),
    };
    for _ in 0..count {
        let place = Vec3::new(rng.f32(), rng.f32(), rng.f32());
        body.positions.push(place * 20.0 - 10.0);
        let joints = 1 + rng.usize(..8);
        let mut chosen: Vec<u32> = (0..joints).map(|_| rng.u32(..JOINTS as u32)).collect();
        chosen.sort_unstable();
        chosen.dedup();
        let weight = 1.0 / chosen.len() as f32;
        let influences = chosen.iter().map(|joint| Influence {
            joint: JointId(*joint),
            weight,
        });
        body.influences.extend(influences);
        body.ends.push(body.influences.len() as u32);
    }
    body
}

fn source(body: &Body) -> RenderMesh<'_> {
    RenderMesh {
        positions: &body.positions,
        triangles: &[[0, 1, 2]],
        skin: Some(SkinSource {
            influences: &body.influences,
            ends: &body.ends,
            joint_count: JOINTS,
        }),
        ..RenderMesh::default()
    }
}

fn palette(joints: usize) -> Palette {
    let mut rng = fastrand::Rng::with_seed(6);
    Palette::from_matrices((0..joints).map(|_| {
        let axis = DVec3::new(rng.f64() - 0.5, rng.f64() - 0.5, rng.f64() - 0.5);
        let turn = rotation_from_axis_angle(axis.normalize_or(DVec3::X), rng.f64() * 3.0);
        let columns = glam::DMat3::from_quat(turn).transpose().to_cols_array_2d();
        let mut matrix = Affine::IDENTITY;
        for (row, column) in matrix.rows.iter_mut().zip(columns) {
            *row = [
                column[0] as f32,
                column[1] as f32,
                column[2] as f32,
                rng.f32() * 4.0,
            ];
        }
        matrix
    }))
}

/// The posed positions, computed in f64.
fn expected(body: &Body, palette: &Palette) -> Vec<DVec3> {
    let mut first = 0;
    let vertices = body.positions.iter().zip(&body.ends);
    vertices
        .map(|(p, end)| {
            let own = &body.influences[first..*end as usize];
            first = *end as usize;
            own.iter().fold(DVec3::ZERO, |sum, influence| {
                let rows = palette.matrices()[influence.joint.0 as usize].rows;
                let p = p.as_dvec3();
                let moved = rows.map(|row| {
                    let [x, y, z, w] = row.map(f64::from);
                    x * p.x + y * p.y + z * p.z + w
                });
                sum + DVec3::from_array(moved) * f64::from(influence.weight)
            })
        })
        .collect()
}

#[test]
fn posed_positions_are_within_a_hundred_thousandth_of_the_extent() {
    let Some(gpu) = common::gpu("skinning") else {
        return;
    };
    let mut renderer = Renderer::new(gpu, 16, 16).unwrap();
    // Vertices for less than one workgroup, for some, and for more than one row of workgroups.
    for count in [3, 1000, 2_200_000] {
        let body = body(count);
        let mesh = renderer.add_mesh(&source(&body)).unwrap();
        let palette = palette(JOINTS);
        let posed = renderer.posed_positions(mesh, &palette).unwrap();
        let expected = expected(&body, &palette);
        assert_eq!(posed.len(), count);
        let off = posed.iter().zip(&expected);
        let off = off.map(|(a, b)| (a.as_dvec3() - *b).length());
        let worst = off.fold(0.0, f64::max);
        println!("{count} vertices: off by {worst:.2e} of 20");
        assert!(worst <= 20.0 * 1e-5, "{count}: {worst}");
    }
}

#[test]
fn a_palette_of_another_skeleton_is_an_error() {
    let Some(gpu) = common::gpu("palettes") else {
        return;
    };
    let mut renderer = Renderer::new(gpu, 16, 16).unwrap();
    let body = body(10);
    let mesh = renderer.add_mesh(&source(&body)).unwrap();
    let result = renderer.posed_positions(mesh, &palette(JOINTS - 1));
    assert!(matches!(result, Err(RenderError::Frame(_))), "{result:?}");
}
