use super::*;
use crate::mesh::{PartId, TriangleId};
use crate::testing::influence;

/// A unit square of two triangles on two joints. The triangles do not share vertices.
struct Square {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    influences: Vec<Influence>,
    tags: Vec<SurfaceTag>,
}

fn square() -> Square {
    let corner = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
    let order = [0, 1, 2, 0, 2, 3];
    Square {
        positions: order.iter().map(|&c| corner[c]).collect(),
        triangles: vec![[0, 1, 2], [3, 4, 5]],
        influences: order
            .iter()
            .flat_map(|&c| {
                let x = corner[c].x;
                [influence(1, x), influence(0, 1.0 - x)]
            })
            .collect(),
        tags: Vec::new(),
    }
}

impl Square {
    fn source(&self) -> MeshSource<'_> {
        MeshSource {
            positions: &self.positions,
            triangles: &self.triangles,
            influences: &self.influences,
            tags: &self.tags,
            joint_count: 2,
            ..MeshSource::default()
        }
    }

    fn build(&self) -> Result<(ColliderMesh, BuildReport), MeshError> {
        ColliderMesh::build(&self.source(), &ColliderBuildOptions::default())
    }
}

#[test]
fn separate_triangles_are_welded_into_shared_vertices() {
    let (mesh, report) = square().build().unwrap();
    assert_eq!((report.vertices, report.welded, report.cracks), (4, 2, 0));
    assert_eq!(report.max_influences, 1);
    assert_eq!(mesh.triangles()[1], [VertexId(0), VertexId(2), VertexId(3)]);
    // The lower triangle has two corners on joint 1, the upper one two on joint 0.
    let parts: Vec<_> = mesh
        .parts()
        .iter()
        .map(|p| (p.joint.0, &p.triangles[..]))
        .collect();
    assert_eq!(
        parts,
        [(0, &[TriangleId(1)][..]), (1, &[TriangleId(0)][..])]
    );
    assert_eq!(mesh.part_of(TriangleId(0)), Some(PartId(1)));
    assert_eq!(mesh.parts()[0].vertices.len(), 3);
    let (radius, exact) = (f64::from(mesh.radius()), 2f64.sqrt());
    assert!(radius >= exact && radius < exact * (1.0 + 3e-7), "{radius}");
}

#[test]
fn a_joint_that_moves_all_corners_a_little_can_move_the_triangle_most() {
    let mut square = square();
    square.triangles.truncate(1);
    square.positions.truncate(3);
    let shares = [0, 1, 2].map(|corner| [influence(0, 0.4), influence(corner + 1, 0.6)]);
    square.influences = shares.as_flattened().to_vec();
    let source = MeshSource {
        joint_count: 4,
        ..square.source()
    };
    let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default()).unwrap();
    assert_eq!(mesh.parts()[0].joint, JointId(0));
}

#[test]
fn vertices_of_different_rest_spaces_never_coincide() {
    let mut square = square();
    // The upper triangle's lower left corner follows the other joint.
    square.influences[6..8].copy_from_slice(&[influence(1, 1.0), influence(0, 0.0)]);
    let report = square.build().unwrap().1;
    assert_eq!((report.cracks, report.welded), (1, 1));
    let source = MeshSource {
        rest_spaces: &[0, 0, 0, 1, 1, 1],
        ..square.source()
    };
    for cracks in [CrackPolicy::Report, CrackPolicy::Unify] {
        let options = ColliderBuildOptions {
            cracks,
            ..ColliderBuildOptions::default()
        };
        let report = ColliderMesh::build(&source, &options).unwrap().1;
        assert_eq!((report.cracks, report.welded), (0, 0), "{cracks:?}");
    }
    let short = MeshSource {
        rest_spaces: &[0; 5],
        ..square.source()
    };
    let error = ColliderMesh::build(&short, &ColliderBuildOptions::default()).unwrap_err();
    let expected = MeshError::RestSpaceCount {
        expected: 6,
        found: 5,
    };
    assert_eq!(error, expected);
}

#[test]
fn positions_that_differ_in_the_sign_of_zero_are_welded() {
    let mut given = square();
    given.positions[3].y = -0.0;
    assert_eq!(given.build().unwrap().1.vertices, 4);
}

#[test]
fn coincident_vertices_with_other_influences_are_reported_or_unified() {
    let mut given = square();
    // The second triangle's copy of the origin follows both joints.
    given.influences[6] = influence(1, 0.5);
    given.influences[7] = influence(0, 0.5);
    let (mesh, report) = given.build().unwrap();
    assert_eq!((report.vertices, report.cracks), (5, 1));
    assert_eq!(mesh.max_influences(), 2);
    let options = ColliderBuildOptions {
        cracks: CrackPolicy::Unify,
        ..ColliderBuildOptions::default()
    };
    let (mesh, report) = ColliderMesh::build(&given.source(), &options).unwrap();
    assert_eq!((report.vertices, report.cracks), (4, 0));
    let at_origin: Vec<_> = mesh.influences(VertexId(0)).collect();
    assert_eq!(at_origin, [(JointId(0), 0.75), (JointId(1), 0.25)]);
}

#[test]
fn degenerate_and_duplicate_triangles_are_dropped_and_tags_follow() {
    let stone = SurfaceTag::new(crate::mesh::SurfaceKind::Stone).with_user(1);
    let mut given = square();
    given.triangles = vec![[0, 0, 1], [2, 0, 1], [0, 1, 2], [3, 4, 5], [5, 4, 3]];
    given.tags = vec![SurfaceTag::default(); 5];
    given.tags[3] = stone;
    let (mesh, report) = given.build().unwrap();
    assert_eq!(report.degenerate_triangles, 1);
    assert_eq!(report.duplicate_triangles, 1);
    // The back side of a triangle is no duplicate of its front.
    assert_eq!(report.triangles, 3);
    assert_eq!(mesh.tags()[1], stone);
}

#[test]
fn winding_can_be_flipped() {
    let options = ColliderBuildOptions {
        winding: Winding::Flip,
        ..ColliderBuildOptions::default()
    };
    let (mesh, _) = ColliderMesh::build(&square().source(), &options).unwrap();
    assert_eq!(mesh.triangles()[0], [VertexId(0), VertexId(2), VertexId(1)]);
}

#[test]
fn weights_that_do_not_add_up_to_one_are_measured_and_normalised() {
    let mut given = square();
    for influence in &mut given.influences {
        influence.weight *= 0.9;
    }
    let (mesh, report) = given.build().unwrap();
    assert!((report.worst_weight_error - 0.1).abs() < 1e-6);
    for v in 0..mesh.positions().len() {
        let sum: f32 = mesh.influences(VertexId(v as u32)).map(|(_, w)| w).sum();
        assert_eq!(sum, 1.0);
    }
}

#[test]
fn one_influence_is_that_of_every_vertex() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let triangles = [[0, 1, 2], [0, 3, 1]];
    let rigid = MeshSource::rigid(&positions, &triangles);
    let each = MeshSource {
        influences: &[influence(0, 1.0); 4],
        ..rigid
    };
    let build = |source| ColliderMesh::build(source, &ColliderBuildOptions::default()).unwrap();
    let ((rigid, report), each) = (build(&rigid), build(&each));
    assert_eq!((rigid.id(), &report), (each.0.id(), &each.1));
    assert_eq!(report.max_influences, 1);
    let none = ColliderMesh::build(
        &MeshSource::rigid(&[], &[]),
        &ColliderBuildOptions::default(),
    );
    assert!(
        matches!(none, Err(MeshError::InfluenceCount { .. })),
        "{none:?}"
    );
}

#[test]
fn each_kind_of_bad_input_has_its_error() {
    let refused = |change: &dyn Fn(&mut Square)| {
        let mut given = square();
        change(&mut given);
        given.build().unwrap_err()
    };
    use MeshError as E;
    assert!(matches!(
        refused(&|s| s.positions[2].x = f32::NAN),
        E::Position { vertex: 2 }
    ));
    assert!(matches!(
        refused(&|s| s.triangles[1][0] = 6),
        E::VertexOutOfRange {
            triangle: 1,
            vertex: 6,
            vertices: 6
        }
    ));
    assert!(matches!(
        refused(&|s| s.influences[4].joint = JointId(2)),
        E::JointOutOfRange { vertex: 2, .. }
    ));
    assert!(matches!(
        refused(&|s| s.influences[5].weight = -1.0),
        E::Weights { vertex: 2, .. }
    ));
    assert!(matches!(
        refused(&|s| {
            s.influences.pop();
        }),
        E::InfluenceCount {
            influences: 11,
            vertices: 6
        }
    ));
    assert!(matches!(
        refused(&|s| s.influences.clear()),
        E::InfluenceCount { .. }
    ));
    assert!(matches!(
        refused(&|s| s.tags = vec![SurfaceTag::default()]),
        E::TagCount {
            expected: 2,
            found: 1
        }
    ));
    assert!(matches!(
        refused(&|s| s.triangles = vec![[0, 0, 0]]),
        E::NoTriangles { triangles: 1 }
    ));
}

#[test]
fn a_mesh_has_at_most_as_many_joints_as_gltf_can_name() {
    let mut given = square();
    for influence in &mut given.influences {
        if influence.joint == JointId(1) {
            influence.joint = JointId(65_535);
        }
    }
    let of = |joint_count| MeshSource {
        joint_count,
        ..given.source()
    };
    let options = ColliderBuildOptions::default();
    let (mesh, _) = ColliderMesh::build(&of(65_536), &options).unwrap();
    let joints = mesh.influences(VertexId(1)).map(|(joint, _)| joint);
    assert!(joints.eq([JointId(65_535)]));
    let refused = ColliderMesh::build(&of(65_537), &options);
    let Err(MeshError::TooLarge { what, found, most }) = refused else {
        panic!("{refused:?}");
    };
    assert_eq!((what, found, most), ("joints", 65_537, 65_536));
}
