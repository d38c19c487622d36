//! Edits of a built mesh. Rest data change at once; parts and clusters are updated when an edit ends.
//!
//! When an edit touches a part, the clusters of the part die, and new clusters, cut from the triangles of the part
//! alone, are appended. The clusters of other parts stay as they are. When more clusters are dead than living, all
//! clusters are rebuilt. This bounds the memory that dead clusters take, for any number of edits. On average, the cost
//! of an edit is proportional to the parts that it touches.

use std::collections::BTreeSet;

use glam::Vec3;

use super::build::{check_count, is_usable};
use super::clusters::{Clusters, build_beside};
use super::collider::has_area;
use super::derived::Derived;
use super::hierarchy::{Hierarchy, STACK};
use super::influences::Influences;
use super::joint_balls::JointBalls;
use super::lineage::Lineage;
use super::parts::{Part, Parts};
use super::weights::normalize;
use super::{
    ColliderMesh, Influence, MeshError, PartId, SurfaceTag, SurfaceTags, TriangleId, VertexId,
};
use crate::rig::JointId;

/// A validated vertex that can be added.
pub(crate) struct NewVertex {
    position: Vec3,
    influences: Vec<(JointId, u32)>,
    /// The mesh's radius once the vertex is added.
    pub(crate) radius: f32,
}

/// The clusters that [`ColliderMesh::recluster`] rebuilt.
pub(crate) enum Reclustered {
    /// All clusters.
    All,
    /// The clusters of the touched parts. Lists the clusters that died; others were appended.
    Parts(Vec<u32>),
}

impl ColliderMesh {
    /// Validates a vertex to be added, as a build validates its vertices.
    pub(crate) fn check_vertex(
        &self,
        position: Vec3,
        influences: &[Influence],
    ) -> Result<NewVertex, MeshError> {
        let vertex = self.positions.len();
        let counts = [
            ("vertices", vertex + 1),
            ("influences", self.influences.len() + influences.len()),
        ];
        for (what, found) in counts {
            check_count(what, found)?;
        }
        if !is_usable(position) {
            return Err(MeshError::Position { vertex });
        }
        let beyond = |i: &&Influence| i.joint.0 as usize >= self.joint_count;
        if let Some(influence) = influences.iter().find(beyond) {
            return Err(MeshError::JointOutOfRange {
                vertex,
                joint: influence.joint,
                joints: self.joint_count,
            });
        }
        let influences = normalize(influences).ok_or_else(|| MeshError::Weights {
            vertex,
            weights: influences.iter().map(|i| i.weight).collect(),
        })?;
        Ok(NewVertex {
            position: position + Vec3::ZERO,
            influences,
            radius: self.radius.max(Self::radius_of(&[position])),
        })
    }

    /// Appends a vertex that [`ColliderMesh::check_vertex`] accepted.
    pub(crate) fn add_vertex(&mut self, vertex: NewVertex) -> VertexId {
        let id = VertexId(self.positions.len() as u32);
        self.positions.push(vertex.position);
        self.influences.push(vertex.influences.iter().copied());
        self.radius = vertex.radius;
        self.lineage.add_vertex(vertex.position, &vertex.influences);
        let joints = vertex.influences.iter().map(|(joint, _)| *joint);
        self.joint_balls.hold(vertex.position, joints);
        self.clusters.loose.push(id);
        id
    }

    /// Validates a triangle to be added. Its vertices must exist.
    pub(crate) fn check_triangle(&self, corners: [VertexId; 3]) -> Result<(), MeshError> {
        check_count("triangles", self.triangles.len() + 1)?;
        if !has_area(corners.map(|v| self.positions[v.index()])) {
            let vertices = corners.map(|v| v.0);
            return Err(MeshError::DegenerateTriangle { vertices });
        }
        Ok(())
    }

    /// Appends a triangle that [`ColliderMesh::check_triangle`] accepted to the part of its dominant joint. Adds
    /// the part if the joint has none.
    pub(crate) fn add_triangle(
        &mut self,
        corners: [VertexId; 3],
        tag: SurfaceTag,
    ) -> (TriangleId, PartId) {
        let id = TriangleId(self.triangles.len() as u32);
        let joint = self.dominant_joint(corners);
        self.lineage.add_triangle(corners);
        self.triangles.push(corners);
        self.tags.push(tag);
        let part = self.parts.push(id, joint);
        self.adjacency.forget();
        (id, part)
    }

    /// Marks a triangle as removed. Its part lists it until [`ColliderMesh::recluster`].
    pub(crate) fn remove_triangle(&mut self, triangle: TriangleId) {
        self.parts.remove(triangle);
        self.adjacency.forget();
    }

    /// Marks a vertex as removed. No triangle may have it as a corner any more.
    pub(crate) fn remove_vertex(&mut self, vertex: VertexId) {
        let count = self.vertex_removed.len().max(vertex.index() + 1);
        self.vertex_removed.resize(count, false);
        self.vertex_removed[vertex.index()] = true;
    }

    pub(crate) fn set_tag(&mut self, triangle: TriangleId, tag: SurfaceTag) {
        self.tags.set(triangle.index(), tag);
    }

    /// The triangles that have `vertex` as a corner. Searches all triangles of the parts in `touched`, because the
    /// vertex lists of these parts are out of date.
    pub(crate) fn triangles_around(
        &self,
        vertex: VertexId,
        touched: &BTreeSet<PartId>,
    ) -> Vec<TriangleId> {
        let parts = (0..).map(PartId).zip(self.parts());
        let parts = parts.filter(|(id, part)| {
            touched.contains(id) || part.vertices.binary_search(&vertex).is_ok()
        });
        let triangles = parts.flat_map(|(_, part)| &part.triangles).copied();
        let around = triangles
            .filter(|t| self.part_of(*t).is_some() && self.triangles[t.index()].contains(&vertex));
        around.collect()
    }

    /// Updates parts whose triangles changed, and their clusters.
    pub(crate) fn recluster(&mut self, touched: &BTreeSet<PartId>) -> Reclustered {
        for part in touched {
            self.parts.renew(*part, &self.triangles);
        }
        self.part_nodes.forget();
        let killed = self.clusters.kill(touched, self.positions.len());
        self.hierarchy.cut_off(touched);
        for part in touched {
            self.append_clusters(*part);
        }
        self.clusters.settle(&killed);
        if self.clusters.dead > self.clusters.living() {
            self.cluster();
            return Reclustered::All;
        }
        Reclustered::Parts(killed.clusters)
    }

    fn append_clusters(&mut self, id: PartId) {
        let part = &self.parts.lists(&self.triangles)[id.index()];
        if part.triangles.is_empty() {
            return;
        }
        let held = self.clusters.held(&part.vertices);
        let (clusters, hierarchy) = build_beside(&self.alone(part), held);
        // `hierarchy::collapse` proves this for every tree that is cut in halves.
        debug_assert!(hierarchy.stack_needed() <= STACK);
        let first = self.clusters.clusters.len() as u32;
        self.hierarchy.append(hierarchy, id, first);
        self.clusters
            .append(clusters, id, &part.vertices, &part.triangles);
    }

    /// A mesh of one part alone, with only the data that clustering needs. The number of a vertex or triangle is
    /// its place in the part's list.
    fn alone(&self, part: &Part) -> Self {
        let number = |v: VertexId| part.vertices.partition_point(|other| *other < v) as u32;
        let corners = part.triangles.iter().map(|t| self.triangles[t.index()]);
        let mut alone = Self {
            lineage: Lineage::default(),
            joint_count: self.joint_count,
            positions: Vec::with_capacity(part.vertices.len()),
            influences: Influences::default(),
            triangles: corners.map(|c| c.map(|v| VertexId(number(v)))).collect(),
            tags: SurfaceTags::default(),
            parts: Parts::of_joints(&vec![part.joint; part.triangles.len()]),
            vertex_removed: Vec::new(),
            radius: self.radius,
            clusters: Clusters::default(),
            hierarchy: Hierarchy::default(),
            joint_balls: JointBalls::default(),
            part_nodes: Derived::default(),
            adjacency: Derived::default(),
        };
        for vertex in &part.vertices {
            let vertex = vertex.index();
            alone.positions.push(self.positions[vertex]);
            alone.influences.push(self.influences.units_of(vertex));
        }
        alone
    }
}
