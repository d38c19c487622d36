//! Skinning with less data: fewer influences, and weights and positions of fewer bits. The bench measures the error and
//! the savings of each format.
//!
//! All variants use one plain kernel, which differs only in the types that it reads. Like clamber's kernel it has
//! clusters of 64 vertices that share a list of joints, with a row of weights for each joint, but no dispatch to wider
//! instructions. The error is the distance of a vertex from its position in f64 with all influences, over the walk.

use std::error::Error;
use std::hint::black_box;
use std::time::Duration;

use clamber_scenes::giant::giant_of;
use clamber_scenes::measure::{Table, median_us, quantile};
use clamber_surface::geometry::Affine;
use clamber_surface::measure::skin_vertex_reference;
use clamber_surface::mesh::{ColliderMesh, VertexId};
use clamber_surface::rig::Palette;
use glam::{DVec3, Vec3};

/// Number of vertices in a cluster.
const SLOTS: usize = 64;

/// Number of poses of the walk in which errors are measured.
const POSES: usize = 8;

/// Columns of the table.
const COLUMNS: [&str; 8] = [
    "vertices",
    "influences",
    "weights",
    "positions",
    "us",
    "bytes a vertex",
    "99 % error, m",
    "worst error, m",
];

/// A type in which a number of a vertex is stored.
trait Stored: Copy + Default {
    /// The name in the table.
    const NAME: &'static str;
    /// The stored value of 1.
    const ONE: f32;

    /// Stores a number from -1 to 1, or from 0 to 1 for weights.
    fn store(value: f32) -> Self;

    fn load(self) -> f32;
}

impl Stored for f32 {
    const NAME: &'static str = "f32";
    const ONE: f32 = 1.0;

    fn store(value: f32) -> Self {
        value
    }

    fn load(self) -> f32 {
        self
    }
}

macro_rules! stored {
    ($number:ty, $name:literal) => {
        impl Stored for $number {
            const NAME: &'static str = $name;
            const ONE: f32 = <$number>::MAX as f32;

            fn store(value: f32) -> Self {
                (value * Self::ONE).round() as $number
            }

            fn load(self) -> f32 {
                f32::from(self)
            }
        }
    };
}

stored!(u8, "8 bits");
stored!(u16, "16 bits");
stored!(i16, "16 bits");

/// A mesh to be skinned, with weights of type `W` and positions of type `P`.
struct Mesh<W, P> {
    clusters: Vec<Cluster>,
    positions: Vec<[P; 3 * SLOTS]>,
    weights: Vec<[W; SLOTS]>,
    /// The vertex of each slot. The last cluster repeats its last vertex.
    vertices: Vec<u32>,
}

struct Cluster {
    /// The joints, with a row of weights each.
    joints: Vec<u32>,
    /// Index of the first row.
    row: usize,
    center: [f32; 3],
    /// Size of one step of a stored position.
    step: f32,
}

/// The joints and weights of each vertex, the heaviest first, cut to at most `most` and normalised.
fn influences(mesh: &ColliderMesh, most: usize) -> Vec<Vec<(u32, f32)>> {
    let of = |v: usize| {
        let all = mesh.influences(VertexId(v as u32));
        let mut all: Vec<(u32, f32)> = all.map(|(joint, weight)| (joint.0, weight)).collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        all.truncate(most);
        let sum: f32 = all.iter().map(|(_, weight)| weight).sum();
        all.iter()
            .map(|(joint, weight)| (*joint, weight / sum))
            .collect()
    };
    (0..mesh.positions().len()).map(of).collect()
}

impl<W: Stored, P: Stored> Mesh<W, P> {
    fn new(mesh: &ColliderMesh, influences: &[Vec<(u32, f32)>]) -> Self {
        let mut order: Vec<u32> = (0..mesh.positions().len() as u32).collect();
        // Vertices with the same joints come together, in the order of the file, so that neighbours are close.
        let joints = |v: u32| -> Vec<u32> {
            let mut joints: Vec<u32> = influences[v as usize].iter().map(|(j, _)| *j).collect();
            joints.sort_unstable();
            joints
        };
        order.sort_by_cached_key(|v| (joints(*v), *v));
        let mut new = Self {
            clusters: Vec::new(),
            positions: Vec::new(),
            weights: Vec::new(),
            vertices: Vec::new(),
        };
        for members in order.chunks(SLOTS) {
            new.add(mesh, influences, members);
        }
        new
    }

    fn add(&mut self, mesh: &ColliderMesh, influences: &[Vec<(u32, f32)>], members: &[u32]) {
        let place = |v: u32| mesh.positions()[v as usize];
        let places = members.iter().map(|v| place(*v));
        let low = places.clone().fold(Vec3::INFINITY, Vec3::min);
        let high = places.fold(Vec3::NEG_INFINITY, Vec3::max);
        // Full precision needs no centre.
        let (center, half) = if P::ONE == 1.0 {
            (Vec3::ZERO, 1.0)
        } else {
            let half = ((high - low) * 0.5).max_element().max(1e-6);
            ((low + high) * 0.5, half)
        };
        let mut joints: Vec<u32> = members
            .iter()
            .flat_map(|v| influences[*v as usize].iter().map(|(joint, _)| *joint))
            .collect();
        joints.sort_unstable();
        joints.dedup();
        let row = self.weights.len();
        let mut positions = [P::default(); 3 * SLOTS];
        let mut rows = vec![[W::default(); SLOTS]; joints.len()];
        for slot in 0..SLOTS {
            let v = members[slot.min(members.len() - 1)];
            let at = ((place(v) - center) / half).to_array();
            for axis in 0..3 {
                positions[axis * SLOTS + slot] = P::store(at[axis]);
            }
            // The heaviest weight gets the rounding of the others, so that the weights sum to 1.
            let mut left = W::ONE;
            for (joint, weight) in influences[v as usize].iter().skip(1) {
                let stored = W::store(*weight);
                left -= stored.load();
                let index = joints.binary_search(joint).unwrap_or_default();
                rows[index][slot] = stored;
            }
            let heaviest = influences[v as usize]
                .first()
                .map_or(0, |(joint, _)| *joint);
            let index = joints.binary_search(&heaviest).unwrap_or_default();
            rows[index][slot] = W::store(left / W::ONE);
            self.vertices.push(v);
        }
        self.positions.push(positions);
        self.weights.extend(rows);
        self.clusters.push(Cluster {
            joints,
            row,
            center: center.to_array(),
            step: half / P::ONE,
        });
    }

    fn skin(&self, palette: &[Affine], out: &mut Vec<[f32; 3 * SLOTS]>) {
        out.resize(self.clusters.len(), [0.0; 3 * SLOTS]);
        for (index, cluster) in self.clusters.iter().enumerate() {
            let mut p = [[0.0; SLOTS]; 3];
            let (stored, into) = (&self.positions[index], &mut out[index]);
            for (axis, p) in p.iter_mut().enumerate() {
                let stored = &stored[axis * SLOTS..][..SLOTS];
                for (p, stored) in p.iter_mut().zip(stored) {
                    *p = cluster.center[axis] + stored.load() * cluster.step;
                }
            }
            let mut sum = [[0.0; SLOTS]; 3];
            let rows = &self.weights[cluster.row..];
            for (joint, weights) in cluster.joints.iter().zip(rows) {
                let matrix = &palette[*joint as usize].rows;
                let mut shares = [0.0; SLOTS];
                for (share, weight) in shares.iter_mut().zip(weights) {
                    *share = weight.load() * (1.0 / W::ONE);
                }
                for (sum, m) in sum.iter_mut().zip(matrix) {
                    for slot in 0..SLOTS {
                        let moved =
                            (m[0] * p[0][slot] + m[1] * p[1][slot]) + (m[2] * p[2][slot] + m[3]);
                        sum[slot] += shares[slot] * moved;
                    }
                }
            }
            for (axis, sum) in sum.iter().enumerate() {
                into[axis * SLOTS..][..SLOTS].copy_from_slice(sum);
            }
        }
    }

    fn bytes(&self) -> usize {
        let joints = self
            .clusters
            .iter()
            .map(|cluster| cluster.joints.len() * 4 + 24);
        size_of_val(&self.positions[..]) + size_of_val(&self.weights[..]) + joints.sum::<usize>()
    }

    /// Distances of all vertices from their true positions.
    fn errors(&self, palette: &[Affine], truth: &[DVec3], into: &mut Vec<f64>) {
        let mut out = Vec::new();
        self.skin(palette, &mut out);
        for (slot, v) in self.vertices.iter().enumerate() {
            let (cluster, slot) = (&out[slot / SLOTS], slot % SLOTS);
            let at = [0, 1, 2].map(|axis| f64::from(cluster[axis * SLOTS + slot]));
            into.push(DVec3::from_array(at).distance(truth[*v as usize]));
        }
    }
}

/// The true positions: skinned with all influences, in f64.
fn truth(mesh: &ColliderMesh, palette: &Palette) -> Vec<DVec3> {
    let vertices = (0..mesh.positions().len() as u32).map(VertexId);
    let place = |vertex| skin_vertex_reference(mesh, palette.matrices(), vertex);
    vertices.filter_map(place).collect()
}

/// Measures all variants.
pub(crate) fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let mut table = Table::new(&COLUMNS);
    let sizes: &[usize] = if brief { &[2_000] } else { &[10_000, 500_000] };
    for &vertices in sizes {
        let giant = giant_of(vertices)?;
        let mesh = &giant.rig.collider;
        let walk = giant.rig.clip("walk").ok_or("the giant cannot walk")?;
        let mut poses = Vec::new();
        for pose in 0..POSES {
            let time = walk.duration() * pose as f64 / POSES as f64;
            let palette = giant.palette("walk", time)?;
            let truth = truth(mesh, &palette);
            poses.push((palette, truth));
        }
        let all = mesh.max_influences();
        let fewer = [4, 2, 1].into_iter().filter(|fewer| *fewer < all);
        for most in std::iter::once(all).chain(fewer) {
            way::<f32, f32>(mesh, most, &poses, brief, &mut table);
        }
        way::<u16, f32>(mesh, all, &poses, brief, &mut table);
        way::<u8, f32>(mesh, all, &poses, brief, &mut table);
        way::<f32, i16>(mesh, all, &poses, brief, &mut table);
        way::<u16, i16>(mesh, all, &poses, brief, &mut table);
        way::<u8, i16>(mesh, all, &poses, brief, &mut table);
    }
    println!("\n{table}");
    Ok(table.write("accuracy_skinning", brief)?)
}

fn way<W: Stored, P: Stored>(
    mesh: &ColliderMesh,
    most: usize,
    poses: &[(Palette, Vec<DVec3>)],
    brief: bool,
    table: &mut Table,
) {
    let made = Mesh::<W, P>::new(mesh, &influences(mesh, most));
    let mut errors = Vec::new();
    for (palette, truth) in poses {
        made.errors(palette.matrices(), truth, &mut errors);
    }
    let mut out = Vec::new();
    let budget = Duration::from_millis(if brief { 1 } else { 500 });
    let mut turn = poses.iter().cycle();
    let us = median_us(budget, || {
        if let Some((palette, _)) = turn.next() {
            made.skin(black_box(palette.matrices()), &mut out);
            black_box(&out);
        }
    });
    let vertices = mesh.positions().len();
    let row = vec![
        vertices.to_string(),
        most.to_string(),
        W::NAME.to_owned(),
        P::NAME.to_owned(),
        format!("{us:.0}"),
        format!("{:.1}", made.bytes() as f64 / vertices as f64),
        format!("{:.1e}", quantile(&mut errors, 0.99)),
        format!("{:.1e}", quantile(&mut errors, 1.0)),
    ];
    println!("{}", row.join(", "));
    table.push(row);
}
