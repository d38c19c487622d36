//! Skins a whole mesh on all cores.

use glam::Vec3;
use rayon::prelude::*;

use super::cluster::{ClusterPositions, skin_owned};
use super::whole;
use crate::geometry::Affine;
use crate::mesh::clusters::{Cluster, Clusters};
use crate::simd::SimdLevel;

/// Number of clusters that one task skins: some ten microseconds of work.
const CLUSTERS: usize = 256;
/// Minimum number of vertices that one task puts in order.
const VERTICES: usize = 16_384;

/// [`whole::skin_owned_vertices`] on all cores, with the same bits. Meshes of up to [`CLUSTERS`] clusters stay on
/// one thread. Larger ones are first skinned in the order of clusters, so that every task writes to a piece of its
/// own. Then each vertex is copied to its place. This takes memory for the positions a second time.
pub(super) fn skin_owned_vertices(
    clusters: &Clusters,
    palette: &[Affine],
    level: SimdLevel,
    positions: &mut [Vec3],
) {
    if clusters.clusters.len() <= CLUSTERS {
        return whole::skin_owned_vertices(clusters, palette, level, positions);
    }
    let ranks = clusters.ranks(positions.len());
    let skinned = skin_by_rank(clusters, palette, level);
    positions
        .par_iter_mut()
        .zip(ranks)
        .with_min_len(VERTICES)
        .for_each(|(position, rank)| {
            if let Some(found) = skinned.get(*rank as usize) {
                *position = *found;
            }
        });
}

/// The positions of all owned vertices, cluster by cluster.
fn skin_by_rank(clusters: &Clusters, palette: &[Affine], level: SimdLevel) -> Vec<Vec3> {
    let count = |all: &[Cluster]| -> usize { all.iter().map(|c| usize::from(c.owned)).sum() };
    let mut positions = vec![Vec3::ZERO; count(&clusters.clusters)];
    let mut rest = &mut positions[..];
    let mut tasks = Vec::new();
    for all in clusters.clusters.chunks(CLUSTERS) {
        let (out, after) = rest.split_at_mut(count(all));
        tasks.push((all, out));
        rest = after;
    }
    tasks.into_par_iter().for_each(|(all, mut out)| {
        let mut skinned = ClusterPositions::ZERO;
        for cluster in all {
            skin_owned(level, clusters, cluster, palette, &mut skinned);
            let (own, after) = out.split_at_mut(usize::from(cluster.owned));
            let [x, y, z] = &skinned.0;
            for (((own, x), y), z) in own.iter_mut().zip(x).zip(y).zip(z) {
                *own = Vec3::new(*x, *y, *z);
            }
            out = after;
        }
    });
    positions
}
