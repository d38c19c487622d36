//! A surface that plays what a function of time says.

use std::sync::Arc;

use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{
    BuildOptions, ColliderMesh, Influence, MeshSource, SurfaceKind, SurfaceTag,
};
use clamber_surface::rig::{JointId, Palette};
use clamber_surface::surface::SkinnedSurface;
use glam::{DAffine3, DVec3};

use super::Shape;

/// Where its joints and its root are at a time.
pub(crate) type Pose = Box<dyn Fn(f64) -> (Vec<DAffine3>, Similarity)>;

/// A posed surface and what poses it.
pub(crate) struct Skin {
    pub(crate) surface: SkinnedSurface,
    pose: Pose,
}

/// Weights of each joint at a rest position.
pub(crate) type Weights<'a> = &'a dyn Fn(DVec3) -> Vec<f64>;

impl Skin {
    /// Of bare skin.
    pub(crate) fn new(shape: &Shape, weights: Weights<'_>, pose: Pose) -> Self {
        Self::of(shape, SurfaceKind::Skin, weights, pose)
    }

    pub(crate) fn of(shape: &Shape, kind: SurfaceKind, weights: Weights<'_>, pose: Pose) -> Self {
        let mesh = build(shape, kind, weights);
        let mut skin = Self {
            surface: SkinnedSurface::new(mesh),
            pose,
        };
        skin.place(0.0);
        skin
    }

    fn at(&self, time: f64) -> (Palette, Similarity) {
        let (joints, root) = (self.pose)(time);
        let matrices = joints.iter().map(Affine::from_f64);
        (Palette::from_matrices(matrices), root)
    }

    pub(crate) fn place(&mut self, time: f64) {
        let (palette, root) = self.at(time);
        self.surface.place(&palette, root).unwrap();
    }

    pub(crate) fn advance(&mut self, time: f64) {
        let (palette, root) = self.at(time);
        self.surface.advance(&palette, root).unwrap();
    }
}

fn build(shape: &Shape, kind: SurfaceKind, weights: Weights<'_>) -> Arc<ColliderMesh> {
    let positions: Vec<_> = shape.positions.iter().map(|p| p.as_vec3()).collect();
    let mut influences = Vec::new();
    let mut influence_ends = Vec::new();
    let mut joint_count = 1;
    for position in &shape.positions {
        let weights = weights(*position);
        joint_count = weights.len();
        for (joint, weight) in weights.into_iter().enumerate() {
            influences.push(Influence {
                joint: JointId(joint as u32),
                weight: weight as f32,
            });
        }
        influence_ends.push(influences.len() as u32);
    }
    let source = MeshSource {
        positions: &positions,
        triangles: &shape.triangles,
        influences: &influences,
        influence_ends: &influence_ends,
        tags: &vec![SurfaceTag::new(kind); shape.triangles.len()],
        joint_count,
        ..MeshSource::default()
    };
    Arc::new(
        ColliderMesh::build(&source, &BuildOptions::default())
            .unwrap()
            .0,
    )
}
