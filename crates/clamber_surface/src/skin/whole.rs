use glam::Vec3;

use super::cluster::{ClusterPositions, skin_cluster, skin_owned};
use super::scalar::skin_vertex;
use crate::geometry::Affine;
use crate::mesh::clusters::{Clusters, ROW};
use crate::mesh::{ColliderMesh, PaletteError};
use crate::simd::SimdLevel;

/// Skins every vertex of a mesh, including removed vertices. The positions are in model space, by vertex id.
///
/// # Errors
/// As [`skin_into`].
pub fn skin(mesh: &ColliderMesh, palette: &[Affine]) -> Result<Vec<Vec3>, PaletteError> {
    let mut positions = Vec::new();
    skin_into(mesh, palette, &mut positions)?;
    Ok(positions)
}

/// [`skin`] into an existing vector, which keeps its memory.
///
/// # Errors
/// [`PaletteError::JointCount`] if the number of matrices differs from the number of joints of the mesh. Matrices
/// that are not finite give positions that are not finite.
pub fn skin_into(
    mesh: &ColliderMesh,
    palette: &[Affine],
    positions: &mut Vec<Vec3>,
) -> Result<(), PaletteError> {
    mesh.check_joint_count(palette.len())?;
    skin_checked(mesh, palette, SimdLevel::best(), positions);
    Ok(())
}

/// [`skin_into`] for a palette that has as many matrices as the mesh has joints.
pub(crate) fn skin_checked(
    mesh: &ColliderMesh,
    palette: &[Affine],
    level: SimdLevel,
    positions: &mut Vec<Vec3>,
) {
    positions.resize(mesh.positions().len(), Vec3::ZERO);
    let clusters = mesh.clusters();
    #[cfg(feature = "rayon")]
    super::parallel::skin_owned_vertices(clusters, palette, level, positions);
    #[cfg(not(feature = "rayon"))]
    skin_owned_vertices(clusters, palette, level, positions);
    for vertex in &clusters.loose {
        positions[vertex.index()] = skin_vertex(mesh, palette, vertex.index());
    }
}

/// Skins every vertex that a cluster owns.
pub(super) fn skin_owned_vertices(
    clusters: &Clusters,
    palette: &[Affine],
    level: SimdLevel,
    positions: &mut [Vec3],
) {
    let mut skinned = ClusterPositions::ZERO;
    for cluster in &clusters.clusters {
        skin_owned(level, clusters, cluster, palette, &mut skinned);
        let own = &cluster.vertices(clusters)[..usize::from(cluster.owned)];
        let [x, y, z] = &skinned.0;
        for (((vertex, x), y), z) in own.iter().zip(x).zip(y).zip(z) {
            positions[vertex.index()] = Vec3::new(*x, *y, *z);
        }
    }
}

/// Skins cluster by cluster with the fast kernel, and leaves the positions in the order of clusters; for measuring.
///
/// For each cluster, `numbers` gets the x of all its slots, then y, then z. The slots are padded to a multiple of
/// sixteen. A vertex on the border of several clusters is in each of them. `numbers` keeps its memory.
///
/// # Errors
/// As [`skin_into`].
pub fn skin_clusters(
    mesh: &ColliderMesh,
    palette: &[Affine],
    level: SimdLevel,
    numbers: &mut Vec<f32>,
) -> Result<(), PaletteError> {
    mesh.check_joint_count(palette.len())?;
    let clusters = mesh.clusters();
    let rows: usize = clusters.clusters.iter().map(|c| c.rows()).sum();
    numbers.resize(rows * ROW * 3, 0.0);
    let mut rest = &mut numbers[..];
    let mut skinned = ClusterPositions::ZERO;
    for cluster in &clusters.clusters {
        skin_cluster(level, clusters, cluster, palette, &mut skinned);
        for axis in &skinned.0 {
            let (out, after) = rest.split_at_mut(cluster.rows() * ROW);
            out.copy_from_slice(&axis[..out.len()]);
            rest = after;
        }
    }
    Ok(())
}

/// [`skin`], vertex by vertex in plain scalar code. Tests compare the bits of the fast kernel with it.
///
/// # Errors
/// As [`skin_into`].
pub fn skin_scalar(mesh: &ColliderMesh, palette: &[Affine]) -> Result<Vec<Vec3>, PaletteError> {
    mesh.check_joint_count(palette.len())?;
    let vertices = 0..mesh.positions().len();
    Ok(vertices.map(|v| skin_vertex(mesh, palette, v)).collect())
}
