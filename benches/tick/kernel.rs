//! The skinning kernel with four joints per vertex, compared with scalar loops and with copying memory.

use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Duration;

use clamber::SimdLevel;
use clamber::measure::skin_clusters;
use clamber::prelude::*;
use clamber_scenes::measure::median_us;
use glam::{DAffine3, DQuat, DVec3, Vec3};

use clamber_scenes::measure::{Bound, Cells};

/// Number of joints that influence every vertex.
const JOINTS: usize = 4;

/// Bytes that skinning one vertex reads (position 12, weights 16) and writes (position 12).
const BYTES: f64 = 40.0;

pub(crate) fn measure(brief: bool, cells: &mut Cells) -> Result<(), Box<dyn Error>> {
    let budget = Duration::from_millis(if brief { 1 } else { 300 });
    let (small, large) = if brief { (16, 32) } else { (64, 1_000) };
    in_cache(&Sheet::new(small)?, budget, cells)?;
    in_memory(&Sheet::new(large)?, budget, cells)
}

/// A square sheet whose vertices all follow the same four joints.
struct Sheet {
    mesh: Arc<ColliderMesh>,
    palette: Palette,
}

impl Sheet {
    fn new(side: u32) -> Result<Self, Box<dyn Error>> {
        let mut positions = Vec::new();
        let mut influences = Vec::new();
        let mut rng = fastrand::Rng::with_seed(6);
        for v in 0..side * side {
            let place = Vec3::new((v % side) as f32, rng.f32(), (v / side) as f32);
            positions.push(place);
            influences.extend((0..JOINTS as u32).map(|joint| Influence {
                joint: JointId(joint),
                weight: 0.1 + rng.f32(),
            }));
        }
        let mut triangles = Vec::new();
        for v in 0..side * (side - 1) {
            if v % side + 1 < side {
                triangles.push([v, v + side, v + 1]);
                triangles.push([v + 1, v + side, v + side + 1]);
            }
        }
        let source = MeshSource {
            positions: &positions,
            triangles: &triangles,
            influences: &influences,
            joint_count: JOINTS,
            ..MeshSource::default()
        };
        let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default())?;
        let matrix = |k: usize| {
            let turn = DQuat::from_xyzw(0.0, 0.0, 0.1 * k as f64, 1.0).normalize();
            Affine::from_f64(&DAffine3::from_rotation_translation(
                turn,
                DVec3::Y * k as f64,
            ))
        };
        Ok(Self {
            mesh: Arc::new(mesh),
            palette: Palette::from_matrices((0..JOINTS).map(matrix)),
        })
    }

    /// Speed of clamber's kernel in million slots a second. A slot is one copy of a vertex in a cluster.
    fn ours(&self, level: SimdLevel, budget: Duration) -> Result<f64, Box<dyn Error>> {
        let mut numbers = Vec::new();
        let matrices = self.palette.matrices();
        skin_clusters(&self.mesh, matrices, level, &mut numbers)?;
        let us = median_us(budget, || {
            let skinned = skin_clusters(black_box(&self.mesh), matrices, level, &mut numbers);
            assert_eq!(skinned, Ok(()));
            black_box(&numbers);
        });
        Ok((numbers.len() / 3) as f64 / us)
    }
}

fn in_cache(sheet: &Sheet, budget: Duration, cells: &mut Cells) -> Result<(), Box<dyn Error>> {
    let scalar = fastest_scalar(sheet, budget);
    cells.value("kernel: fastest scalar loop, Mvertices/s", scalar);
    for level in SimdLevel::available() {
        let ours = sheet.ours(level, budget)?;
        cells.value(&format!("kernel: {level}, Mslots/s"), ours);
        let bound = match level.name() {
            "AVX2" => Bound::Least(4.0),
            "SSE2" => Bound::Least(2.5),
            _ => Bound::None,
        };
        cells.push(
            &format!("kernel: {level} / fastest scalar loop"),
            ours / scalar,
            bound,
        );
    }
    Ok(())
}

/// Speed of the faster of two usual loops over an array of structures, in million vertices a second.
fn fastest_scalar(sheet: &Sheet, budget: Duration) -> f64 {
    #[derive(Clone, Copy)]
    struct Vertex {
        position: [f32; 3],
        joints: [u16; JOINTS],
        weights: [f32; JOINTS],
    }
    let mesh = &sheet.mesh;
    let vertices: Vec<Vertex> = (0..mesh.positions().len())
        .map(|v| {
            let influences = mesh.influences(clamber::mesh::VertexId(v as u32));
            let (mut joints, mut weights) = ([0; JOINTS], [0.0; JOINTS]);
            for (k, (joint, weight)) in influences.enumerate() {
                (joints[k], weights[k]) = (joint.0 as u16, weight);
            }
            Vertex {
                position: mesh.positions()[v].to_array(),
                joints,
                weights,
            }
        })
        .collect();
    let palette: Vec<[[f32; 4]; 3]> = sheet.palette.matrices().iter().map(|m| m.rows).collect();
    let mut out = vec![[0.0f32; 3]; vertices.len()];
    // Each matrix transforms the point, and the weighted results are added.
    let points = median_us(budget, || {
        for (out, v) in out.iter_mut().zip(black_box(&vertices)) {
            let [x, y, z] = v.position;
            let mut sum = [0.0; 3];
            for (joint, weight) in v.joints.iter().zip(v.weights) {
                let rows = &palette[usize::from(*joint)];
                for (sum, m) in sum.iter_mut().zip(rows) {
                    *sum += weight * ((m[0] * x + m[1] * y) + (m[2] * z + m[3]));
                }
            }
            *out = sum;
        }
        black_box(&out);
    });
    // The weighted sum of the matrices transforms the point.
    let matrices = median_us(budget, || {
        for (out, v) in out.iter_mut().zip(black_box(&vertices)) {
            let mut blend = [[0.0; 4]; 3];
            for (joint, weight) in v.joints.iter().zip(v.weights) {
                let rows = &palette[usize::from(*joint)];
                for (blend, row) in blend.iter_mut().zip(rows) {
                    for (b, m) in blend.iter_mut().zip(row) {
                        *b += weight * m;
                    }
                }
            }
            let [x, y, z] = v.position;
            *out = blend.map(|m| (m[0] * x + m[1] * y) + (m[2] * z + m[3]));
        }
        black_box(&out);
    });
    vertices.len() as f64 / points.min(matrices)
}

fn in_memory(sheet: &Sheet, budget: Duration, cells: &mut Cells) -> Result<(), Box<dyn Error>> {
    // Copying reads and writes every byte, so it counts twice. The data exceeds every cache.
    let bytes = 256e6;
    let from = vec![1u64; (bytes / 16.0) as usize];
    let mut to = vec![0u64; from.len()];
    let copy = median_us(budget, || {
        to.copy_from_slice(black_box(&from));
        black_box(&to);
    });
    let ours = sheet.ours(SimdLevel::best(), budget)?;
    cells.value("1M vertices: Mslots/s", ours);
    cells.value("1M vertices: copying, GB/s", bytes / copy / 1e3);
    let share = ours * BYTES / (bytes / copy);
    cells.push(
        "1M vertices: share of copy bandwidth",
        share,
        Bound::Least(0.6),
    );
    Ok(())
}
