//! Bodies of known area, on one joint that does not move or on two.

#![allow(
    dead_code,
    clippy::unwrap_used,
    reason = "helpers of tests, of which each file uses some"
)]

use std::ops::ControlFlow;
use std::sync::Arc;

use clamber_climber::ClimberConfig;
use clamber_navigation::{ClimbGraph, ClimbReport, GraphConfig};
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, Influence, MeshSource, Rig, SurfaceKind, SurfaceTag,
};
use clamber_surface::rig::{Clip, Joint, JointId, Skeleton, Transform, WeakPoint};
use clamber_surface::surface::SkinnedSurface;
use glam::Vec3;

/// A body: vertices, triangles and their materials.
#[derive(Clone, Debug, Default)]
pub(crate) struct Body {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) tags: Vec<SurfaceTag>,
    pub(crate) weak_points: Vec<WeakPoint>,
    /// Vertices from this index on belong to the second joint; `None` if all belong to the first.
    pub(crate) second_joint: Option<usize>,
}

impl Body {
    /// A grid over a surface, which `place` gives as a function of two shares from 0 to 1. `kind` gives the material at
    /// the middle of each cell.
    pub(crate) fn grid(
        cells: [u32; 2],
        place: impl Fn(f32, f32) -> Vec3,
        kind: impl Fn(f32, f32) -> SurfaceKind,
    ) -> Self {
        let [columns, rows] = cells;
        let share = |i: u32, n: u32| i as f32 / n as f32;
        let mut body = Self::default();
        for row in 0..=rows {
            for column in 0..=columns {
                let at = place(share(column, columns), share(row, rows));
                body.positions.push(at);
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let a = row * (columns + 1) + column;
                let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
                body.triangles.extend([[a, b, c], [a, c, d]]);
                let middle = |i: u32, n: u32| (i as f32 + 0.5) / n as f32;
                let tag = SurfaceTag::new(kind(middle(column, columns), middle(row, rows)));
                body.tags.extend([tag, tag]);
            }
        }
        body
    }

    /// The union of both bodies.
    pub(crate) fn and(mut self, other: &Self) -> Self {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        let moved = other.triangles.iter().map(|t| t.map(|v| v + first));
        self.triangles.extend(moved);
        self.tags.extend(&other.tags);
        self
    }

    /// The union of both bodies, with the other one on a second joint.
    pub(crate) fn and_on_its_own(self, other: &Self) -> Self {
        Self {
            second_joint: Some(self.positions.len()),
            ..self.and(other)
        }
    }

    /// The same body with its triangles in another order.
    pub(crate) fn shuffled(&self, seed: u64) -> Self {
        let mut order: Vec<usize> = (0..self.triangles.len()).collect();
        fastrand::Rng::with_seed(seed).shuffle(&mut order);
        Self {
            triangles: order.iter().map(|i| self.triangles[*i]).collect(),
            tags: order.iter().map(|i| self.tags[*i]).collect(),
            ..self.clone()
        }
    }

    pub(crate) fn mesh(&self) -> Arc<ColliderMesh> {
        let second = self.second_joint.unwrap_or(usize::MAX);
        let influence = |corner: usize| Influence {
            joint: JointId(u32::from(corner >= second)),
            weight: 1.0,
        };
        let influences: Vec<Influence> = (0..self.positions.len()).map(influence).collect();
        let source = MeshSource {
            positions: &self.positions,
            triangles: &self.triangles,
            influences: &influences,
            tags: &self.tags,
            joint_count: 1 + usize::from(self.second_joint.is_some()),
            ..MeshSource::default()
        };
        Arc::new(
            ColliderMesh::build(&source, &ColliderBuildOptions::default())
                .unwrap()
                .0,
        )
    }

    /// The body's skin at rest.
    pub(crate) fn surface(&self) -> SkinnedSurface {
        let skeleton = skeleton();
        let palette = skeleton.palette(&skeleton.rest_pose()).unwrap();
        let mut surface = SkinnedSurface::new(self.mesh());
        surface.teleport(&palette, Similarity::IDENTITY).unwrap();
        surface
    }

    /// The graph for a climber and its report, with the ground at height 0.
    pub(crate) fn report(&self, config: &GraphConfig) -> (ClimbGraph, ClimbReport) {
        let go_on = |_| ControlFlow::Continue(());
        let (report, graph) = ClimbReport::new(&self.rig(), config, go_on).unwrap();
        (graph, report)
    }

    /// The body as a creature without clips.
    pub(crate) fn rig(&self) -> Rig {
        let mut rig = Rig::new(skeleton(), self.mesh());
        rig.weak_points.clone_from(&self.weak_points);
        rig
    }
}

/// The graph of a body with clips, with the ground at height 0.
pub(crate) fn graph_of(
    body: &Body,
    config: &GraphConfig,
    clips: &[Clip],
    world_from_model: Similarity,
) -> Arc<ClimbGraph> {
    let skeleton = if body.second_joint.is_some() {
        two_joints()
    } else {
        skeleton()
    };
    let mut rig = Rig::new(skeleton, body.mesh());
    rig.clips = clips.to_vec();
    let config = GraphConfig {
        world_from_model,
        ..config.clone()
    };
    let go_on = |_| ControlFlow::Continue(());
    Arc::new(ClimbGraph::build(&rig, &config, go_on).unwrap())
}

pub(crate) fn skeleton() -> Skeleton {
    Skeleton::new(vec![joint("root", None)]).unwrap()
}

/// A root and a joint below it.
pub(crate) fn two_joints() -> Skeleton {
    let joints = vec![joint("root", None), joint("second", Some(JointId(0)))];
    Skeleton::new(joints).unwrap()
}

fn joint(name: &str, parent: Option<JointId>) -> Joint {
    Joint {
        name: name.to_owned(),
        parent,
        rest: Transform::default(),
        inverse_bind: Affine::IDENTITY,
    }
}

pub(crate) fn climber() -> GraphConfig {
    GraphConfig::new(ClimberConfig::colossus_climber())
}

/// A ball with the materials of `kind`.
pub(crate) fn ball(center: Vec3, radius: f32, kind: impl Fn(f32, f32) -> SurfaceKind) -> Body {
    let place = |u: f32, v: f32| {
        let (around, down) = (u * std::f32::consts::TAU, v * std::f32::consts::PI);
        let level = libm::sinf(down);
        center
            + Vec3::new(
                level * libm::cosf(around),
                libm::cosf(down),
                level * libm::sinf(around),
            ) * radius
    };
    Body::grid([64, 32], place, kind)
}
