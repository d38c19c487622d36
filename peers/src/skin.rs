use std::error::Error;
use std::sync::Arc;

use clamber_surface::geometry::Affine;
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::Palette;
use clamber_surface::skin::skin_into;
use glam::{DVec3, Vec3};

/// All positions of a pose and of the previous pose, skinned by clamber's kernel: the input of every peer that skins
/// the whole mesh.
pub struct Skin {
    mesh: Arc<ColliderMesh>,
    pub(crate) positions: Vec<Vec3>,
    before: Vec<Vec3>,
}

impl Skin {
    /// The positions at rest.
    pub(crate) fn new(mesh: &Arc<ColliderMesh>) -> Self {
        Self {
            mesh: Arc::clone(mesh),
            positions: mesh.positions().to_vec(),
            before: mesh.positions().to_vec(),
        }
    }

    pub(crate) fn update(&mut self, palette: &Palette, place: DVec3) -> Result<(), Box<dyn Error>> {
        std::mem::swap(&mut self.positions, &mut self.before);
        if place == DVec3::ZERO {
            skin_into(&self.mesh, palette.matrices(), &mut self.positions)?;
        } else {
            let moved: Vec<Affine> = palette.matrices().iter().map(|m| moved(m, place)).collect();
            skin_into(&self.mesh, &moved, &mut self.positions)?;
        }
        Ok(())
    }

    /// The vertex indices of every triangle.
    pub(crate) fn triangles(&self) -> Vec<[u32; 3]> {
        let triangles = self.mesh.triangles().iter();
        triangles.map(|corners| corners.map(|v| v.0)).collect()
    }

    pub(crate) fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.mesh.triangles()[triangle].map(|v| self.positions[v.index()])
    }

    /// Bytes that skinning reads: the rest position of each vertex, and four joints with weights.
    pub(crate) fn bytes_at_rest(&self) -> usize {
        /// Bytes of a vertex: a position of three f32, and four joints of two bytes with weights of four.
        const VERTEX: usize = 12 + 4 * (2 + 4);
        self.positions.len() * VERTEX
    }

    pub(crate) fn motion(&self, triangle: TriangleId, barycentric: [f32; 3]) -> (Vec3, Vec3) {
        let corners = self.mesh.triangles()[triangle.index()];
        let at = |positions: &[Vec3]| {
            let weighted = corners.iter().zip(barycentric);
            weighted.fold(Vec3::ZERO, |sum, (v, w)| sum + positions[v.index()] * w)
        };
        let now = at(&self.positions);
        (now, now - at(&self.before))
    }
}

fn moved(matrix: &Affine, place: DVec3) -> Affine {
    let mut moved = *matrix;
    for (row, by) in moved.rows.iter_mut().zip(place.to_array()) {
        row[3] = (f64::from(row[3]) + by) as f32;
    }
    moved
}
