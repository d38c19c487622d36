//! The fuzz target of mesh building: any source is rejected with a reason, or gives a mesh that keeps the promises of
//! [`ColliderMesh::build`].

use std::collections::BTreeSet;

use clamber_surface::mesh::{
    BuildReport, ColliderBuildOptions, ColliderMesh, CrackPolicy, Influence, MeshError, MeshSource,
    TriangleId, VertexId, Winding,
};
use glam::Vec3;

use super::bits::bits;
use super::bytes::Bytes;
use super::mesh::{Source, options};

/// Builds a mesh from any bytes; returns true if it was accepted.
///
/// # Panics
/// If the mesh breaks a promise, or a valid source is rejected.
pub fn builder(data: &[u8]) -> bool {
    let mut bytes = Bytes::new(data);
    let (source, spoilt) = Source::any(&mut bytes);
    let options = options(&mut bytes);
    match ColliderMesh::build(&source.source(), &options) {
        Ok((mesh, report)) => {
            check_weights(&mesh);
            check_parts(&mesh);
            check_triangles(&mesh, &report, &source, options);
            check_again(&mesh, &source, &options);
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            let expected = spoilt || matches!(error, MeshError::NoTriangles { .. });
            assert!(expected, "a valid mesh was rejected: {error}");
            false
        }
    }
}

/// Checks that weights are positive multiples of 2^-24 that add up to 1, by ascending joint, and that no position is
/// outside the mesh's radius.
fn check_weights(mesh: &ColliderMesh) {
    for v in 0..mesh.positions().len() as u32 {
        let given: Vec<_> = mesh.influences(VertexId(v)).collect();
        let sum: f64 = given.iter().map(|(_, w)| f64::from(*w)).sum();
        assert_eq!(sum, 1.0, "vertex {v}: {given:?}");
        let whole = |w: f32| w > 0.0 && (w * (1 << 24) as f32).fract() == 0.0;
        assert!(given.iter().all(|(_, w)| whole(*w)), "{v}: {given:?}");
        assert!(given.is_sorted_by(|a, b| a.0 < b.0), "{v}: {given:?}");
        let last = given.last().map_or(0, |(joint, _)| joint.0 as usize);
        assert!(last < mesh.joint_count(), "{v}: {given:?}");
        let length = mesh.positions()[v as usize].as_dvec3().length();
        assert!(length <= f64::from(mesh.radius()), "vertex {v}");
    }
}

/// Checks that every triangle is in exactly one part, that a part's joint moves its triangles, and that a part's
/// vertices are its triangles' corners.
fn check_parts(mesh: &ColliderMesh) {
    let mut seen = 0;
    for (index, part) in mesh.parts().iter().enumerate() {
        assert!(part.triangles.is_sorted_by(|a, b| a < b), "part {index}");
        seen += part.triangles.len();
        let mut corners = BTreeSet::new();
        for triangle in &part.triangles {
            assert_eq!(mesh.part_of(*triangle).map(|p| p.index()), Some(index));
            let vertices = mesh.triangles()[triangle.index()];
            corners.extend(vertices);
            let mut influences = vertices.into_iter().flat_map(|v| mesh.influences(v));
            assert!(influences.any(|(joint, _)| joint == part.joint));
        }
        assert!(corners.iter().eq(&part.vertices), "part {index}");
    }
    assert_eq!(seen, mesh.triangles().len());
    let beyond = TriangleId(mesh.triangles().len() as u32);
    assert_eq!(mesh.part_of(beyond), None);
}

/// Checks that the remaining triangles keep their corners, their order and their tags, and that the report counts the
/// dropped ones.
fn check_triangles(
    mesh: &ColliderMesh,
    report: &BuildReport,
    source: &Source,
    options: ColliderBuildOptions,
) {
    assert_eq!(report.vertices, mesh.positions().len());
    assert_eq!(report.welded + report.vertices, source.positions.len());
    assert_eq!(report.triangles, mesh.triangles().len());
    let dropped = report.degenerate_triangles + report.duplicate_triangles;
    assert_eq!(report.triangles + dropped, source.triangles.len());
    assert_eq!(report.max_influences, mesh.max_influences());
    let mut given = source.triangles.iter().enumerate();
    for (triangle, tag) in mesh.triangles().iter().zip(mesh.tags().iter()) {
        let found = triangle.map(|v| bits(mesh.positions()[v.index()]));
        let stays = given.any(|(index, corners)| {
            let mut corners = *corners;
            if options.winding == Winding::Flip {
                corners.swap(1, 2);
            }
            let at = |v: u32| bits(source.positions[v as usize] + Vec3::ZERO);
            let tagged = source.tags.get(index).copied().unwrap_or_default();
            corners.map(at) == found && tagged == *tag
        });
        assert!(stays, "{triangle:?} is not in the source");
    }
}

/// Checks that a second build of the source, and a build from the mesh itself, give the same mesh.
fn check_again(mesh: &ColliderMesh, source: &Source, options: &ColliderBuildOptions) {
    let again = ColliderMesh::build(&source.source(), options);
    assert!(again.is_ok_and(|(again, _)| again == *mesh));
    if !source.rest_spaces.is_empty() {
        // Without the rest spaces, equal vertices of different spaces would be welded.
        return;
    }
    let mut influences = Vec::new();
    let mut influence_ends = Vec::new();
    for v in 0..mesh.positions().len() as u32 {
        let given = mesh.influences(VertexId(v));
        influences.extend(given.map(|(joint, weight)| Influence { joint, weight }));
        influence_ends.push(influences.len() as u32);
    }
    let triangles: Vec<[u32; 3]> = mesh.triangles().iter().map(|t| t.map(|v| v.0)).collect();
    let built = MeshSource {
        positions: mesh.positions(),
        triangles: &triangles,
        influences: &influences,
        influence_ends: &influence_ends,
        tags: &mesh.tags().to_vec(),
        rest_spaces: &[],
        joint_count: mesh.joint_count(),
    };
    let keep = ColliderBuildOptions {
        cracks: CrackPolicy::Report,
        winding: Winding::Keep,
    };
    let again = ColliderMesh::build(&built, &keep);
    assert!(again.is_ok_and(|(again, _)| again == *mesh));
}
