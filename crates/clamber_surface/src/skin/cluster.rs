//! The fast kernel: skins one cluster at a time, as many vertices at once as fit a SIMD vector.

use fearless_simd::{Select, Simd, SimdBase, dispatch};

use crate::geometry::Affine;
use crate::mesh::clusters::{Cluster, Clusters, MAX_SLOTS, ROW, Row};
use crate::simd::SimdLevel;

/// Positions of a cluster's slots: all x, all y, all z. Slots beyond the cluster's rows keep their old values.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ClusterPositions(pub(crate) [[f32; MAX_SLOTS]; 3]);

impl ClusterPositions {
    /// All positions at the origin.
    pub(crate) const ZERO: Self = Self([[0.0; MAX_SLOTS]; 3]);
}

impl Default for ClusterPositions {
    fn default() -> Self {
        Self::ZERO
    }
}

/// A cluster that was skinned: the positions of its slots, and a box around them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SkinnedCluster {
    pub(crate) positions: ClusterPositions,
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
}

impl SkinnedCluster {
    /// Skins a cluster. The palette must have a matrix for every joint of the mesh.
    pub(crate) fn skin(
        &mut self,
        level: SimdLevel,
        clusters: &Clusters,
        cluster: &Cluster,
        palette: &[Affine],
    ) {
        let joints = cluster.joints(clusters);
        let rest = cluster.rest(clusters);
        dispatch!(level.level(), simd => {
            skin_rows(simd, rest, joints, palette, &mut self.positions);
            [self.low, self.high] = box_around(simd, &self.positions, cluster.rows());
        });
    }
}

/// The lowest and the highest coordinates in the first `rows` rows of slots.
#[cfg_attr(not(unoptimized), inline(always))]
fn box_around<S: Simd>(simd: S, positions: &ClusterPositions, rows: usize) -> [[f32; 3]; 2] {
    let mut sides = [[0.0; 3]; 2];
    for (axis, numbers) in positions.0.iter().enumerate() {
        let first = S::f32s::from_slice(simd, &numbers[..S::f32s::LEN]);
        let (mut low, mut high) = (first, first);
        for slot in (S::f32s::LEN..rows * ROW).step_by(S::f32s::LEN) {
            let x = S::f32s::from_slice(simd, &numbers[slot..slot + S::f32s::LEN]);
            low = x.simd_lt(low).select(x, low);
            high = x.simd_gt(high).select(x, high);
        }
        let least = |a: f32, b: &f32| if *b < a { *b } else { a };
        let most = |a: f32, b: &f32| if *b > a { *b } else { a };
        sides[0][axis] = low.as_slice().iter().fold(f32::INFINITY, least);
        sides[1][axis] = high.as_slice().iter().fold(f32::NEG_INFINITY, most);
    }
    sides
}

/// Skins all slots of a cluster, with the bits of [`super::skin_vertex`]. The palette must have a matrix for every
/// joint of the mesh.
pub(crate) fn skin_cluster(
    level: SimdLevel,
    clusters: &Clusters,
    cluster: &Cluster,
    palette: &[Affine],
    positions: &mut ClusterPositions,
) {
    let joints = cluster.joints(clusters);
    let rest = cluster.rest(clusters);
    dispatch!(level.level(), simd => skin_rows(simd, rest, joints, palette, positions));
}

/// [`skin_cluster`] for only those rows that hold vertices owned by the cluster.
pub(crate) fn skin_owned(
    level: SimdLevel,
    clusters: &Clusters,
    cluster: &Cluster,
    palette: &[Affine],
    positions: &mut ClusterPositions,
) {
    let joints = cluster.joints(clusters);
    let rows = usize::from(cluster.owned).div_ceil(ROW);
    let rest = &cluster.rest(clusters)[..rows * (3 + joints.len())];
    dispatch!(level.level(), simd => skin_rows(simd, rest, joints, palette, positions));
}

#[cfg_attr(not(unoptimized), inline(always))]
fn skin_rows<S: Simd>(
    simd: S,
    rest: &[Row],
    joints: &[u32],
    palette: &[Affine],
    positions: &mut ClusterPositions,
) {
    for (row, rest) in rest.chunks_exact(3 + joints.len()).enumerate() {
        let (place, weights) = rest.split_at(3);
        let influences = joints.iter().zip(weights);
        let from = row * ROW;
        // Two vectors share the broadcast matrix elements, where there are enough registers for two.
        if S::f32s::LEN == ROW {
            skin_vectors::<S, 1>(simd, place, 0, influences, palette, from, positions);
        } else {
            for lane in (0..ROW).step_by(2 * S::f32s::LEN) {
                let influences = influences.clone();
                skin_vectors::<S, 2>(
                    simd,
                    place,
                    lane,
                    influences,
                    palette,
                    from + lane,
                    positions,
                );
            }
        }
    }
}

/// Skins `N` vectors of slots: reads from `lane` of a row on, writes to `positions` from slot `to` on.
#[cfg_attr(not(unoptimized), inline(always))]
fn skin_vectors<'a, S: Simd, const N: usize>(
    simd: S,
    place: &[Row],
    lane: usize,
    influences: impl Iterator<Item = (&'a u32, &'a Row)>,
    palette: &[Affine],
    to: usize,
    positions: &mut ClusterPositions,
) {
    let vector = |row: &Row, n: usize| {
        let start = lane + n * S::f32s::LEN;
        S::f32s::from_slice(simd, &row.0[start..start + S::f32s::LEN])
    };
    let zero = S::f32s::splat(simd, 0.0);
    let p: [[S::f32s; 3]; N] =
        std::array::from_fn(|n| std::array::from_fn(|axis| vector(&place[axis], n)));
    let mut sum = [[zero; 3]; N];
    for (joint, weights) in influences {
        let rows = &palette[*joint as usize].rows;
        let weight: [S::f32s; N] = std::array::from_fn(|n| vector(weights, n));
        for (axis, row) in rows.iter().enumerate() {
            let m = row.map(|element| S::f32s::splat(simd, element));
            for ((sum, [x, y, z]), weight) in sum.iter_mut().zip(p).zip(weight) {
                let moved = (m[0] * x + m[1] * y) + (m[2] * z + m[3]);
                sum[axis] += weight * moved;
            }
        }
    }
    for (n, sum) in sum.into_iter().enumerate() {
        let start = to + n * S::f32s::LEN;
        for (vector, axis) in sum.into_iter().zip(&mut positions.0) {
            vector.store_slice(&mut axis[start..start + S::f32s::LEN]);
        }
    }
}
