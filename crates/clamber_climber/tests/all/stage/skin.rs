//! A surface whose pose is a function of time.

use std::sync::Arc;

use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, Influence, MeshSource, SurfaceKind, SurfaceTag,
};
use clamber_surface::rig::{JointId, Palette};
use clamber_surface::surface::SkinnedSurface;
use glam::{DAffine3, DVec3};

use super::Shape;
use super::own::Own;

/// Poses of the joints and of the root at a time.
pub(crate) type Pose = Box<dyn Fn(f64) -> (Vec<DAffine3>, Similarity)>;

/// A posed surface and the function that poses it.
pub(crate) struct Skin {
    pub(crate) surface: SkinnedSurface,
    /// Scale of the skin's root on a stage.
    pub(super) scale: f64,
    pose: Pose,
    shape: Shape,
    /// Weights of the joints for each corner.
    weights: Vec<Vec<f64>>,
    tag: SurfaceTag,
}

/// Weights of the joints at a rest position.
pub(crate) type Weights<'a> = &'a dyn Fn(DVec3) -> Vec<f64>;

impl Skin {
    /// A surface of bare skin.
    pub(crate) fn new(shape: &Shape, weights: Weights<'_>, pose: Pose) -> Self {
        Self::of(shape, SurfaceKind::Skin, weights, pose)
    }

    pub(crate) fn of(shape: &Shape, kind: SurfaceKind, weights: Weights<'_>, pose: Pose) -> Self {
        let weights: Vec<_> = shape.positions.iter().map(|p| weights(*p)).collect();
        let tag = SurfaceTag::new(kind);
        Self {
            surface: SkinnedSurface::new(build(shape, tag, &weights)),
            scale: 1.0,
            pose,
            shape: shape.clone(),
            weights,
            tag,
        }
    }

    /// The same skin with a number in its tag.
    pub(super) fn numbered(mut self, user: u32) -> Self {
        self.tag = self.tag.with_user(user);
        self.surface = SkinnedSurface::new(build(&self.shape, self.tag, &self.weights));
        self
    }

    fn at(&self, time: f64, scale: f64, origin: DVec3) -> (Palette, Similarity) {
        let (joints, mut root) = (self.pose)(time);
        let matrices = joints.iter().map(Affine::from_f64);
        root.scale *= scale;
        root.translation = origin + root.translation * scale;
        (Palette::from_matrices(matrices), root)
    }

    pub(super) fn place(&mut self, time: f64, scale: f64, origin: DVec3) {
        let (palette, root) = self.at(time, scale, origin);
        self.surface.teleport(&palette, root).unwrap();
    }

    /// Poses the surface for the next tick. Returns its extent from its root, and the displacement of its root.
    pub(super) fn advance(&mut self, time: f64, scale: f64, origin: DVec3) -> (f64, f64) {
        let (palette, root) = self.at(time, scale, origin);
        let before = self.surface.world_from_model().translation;
        self.surface.advance(&palette, root).unwrap();
        let bounds = self.surface.bounding_ball();
        let extent = bounds.map_or(0.0, |(center, radius)| {
            center.distance(root.translation) + radius
        });
        (extent, root.translation.distance(before))
    }

    /// The same triangles and poses as an obstacle in f64.
    pub(super) fn into_own(self, scale: f64) -> Own {
        let Self {
            pose,
            shape,
            weights,
            tag,
            ..
        } = self;
        let corners = move |time: f64| {
            let (joints, root) = pose(time);
            let skinned = shape.positions.iter().zip(&weights).map(|(p, weights)| {
                let moved = joints.iter().zip(weights);
                moved
                    .map(|(joint, w)| joint.transform_point3(*p) * *w)
                    .sum()
            });
            skinned.map(|p| root.transform_point(p)).collect()
        };
        let triangles = shape.triangles.clone();
        let mut own = Own::new(Box::new(corners), triangles, tag.kind, scale);
        own.tag = tag;
        own
    }
}

fn build(shape: &Shape, tag: SurfaceTag, weights: &[Vec<f64>]) -> Arc<ColliderMesh> {
    let positions: Vec<_> = shape.positions.iter().map(|p| p.as_vec3()).collect();
    let mut influences = Vec::new();
    let mut influence_ends = Vec::new();
    let mut joint_count = 1;
    for weights in weights {
        joint_count = weights.len();
        for (joint, weight) in weights.iter().enumerate() {
            influences.push(Influence {
                joint: JointId(joint as u32),
                weight: *weight as f32,
            });
        }
        influence_ends.push(influences.len() as u32);
    }
    let source = MeshSource {
        positions: &positions,
        triangles: &shape.triangles,
        influences: &influences,
        influence_ends: &influence_ends,
        tags: &vec![tag; shape.triangles.len()],
        joint_count,
        ..MeshSource::default()
    };
    Arc::new(
        ColliderMesh::build(&source, &ColliderBuildOptions::default())
            .unwrap()
            .0,
    )
}
