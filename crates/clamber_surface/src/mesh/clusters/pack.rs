//! Lays clusters out for the skinning kernel.

use super::super::{ColliderMesh, TriangleId, VertexId};
use super::tree::{Leaf, Tree};
use super::{BLOCK, Cluster, Clusters, CornerBlock, ROW, Row};

/// Packs one leaf after the other. Arrays by vertex or joint are reused from leaf to leaf.
struct Packer<'a> {
    mesh: &'a ColliderMesh,
    packed: Clusters,
    /// Per vertex, whether a cluster holds it.
    held: Vec<bool>,
    /// Per vertex, its slot in the last cluster that holds it.
    slot: Vec<u8>,
    /// Per joint, its place in the joint list of the cluster that is being packed.
    place: Vec<u32>,
    vertices: Vec<VertexId>,
    joints: Vec<u32>,
}

impl Clusters {
    /// Packs one cluster for each leaf. A leaf has at most [`super::MAX_SLOTS`] vertices and
    /// [`super::MAX_TRIANGLES`] triangles. `held` tells for each vertex whether it already has an owner.
    pub(super) fn pack(mesh: &ColliderMesh, tree: &Tree, held: Vec<bool>) -> Self {
        let vertices = mesh.positions().len();
        let mut packer = Packer {
            mesh,
            packed: Self::default(),
            held,
            slot: vec![0; vertices],
            place: vec![0; mesh.joint_count()],
            vertices: Vec::new(),
            joints: Vec::new(),
        };
        for leaf in &tree.leaves {
            packer.push(leaf);
        }
        let held = packer.held.iter().enumerate();
        let loose = held.filter(|(_, held)| !**held);
        packer.packed.loose = loose.map(|(v, _)| VertexId(v as u32)).collect();
        packer.packed
    }
}

impl Packer<'_> {
    fn push(&mut self, leaf: &Leaf) {
        let owned = self.collect_vertices(leaf);
        self.collect_joints();
        let packed = &self.packed;
        let cluster = Cluster {
            part: leaf.part,
            first_row: (packed.vertices.len() / ROW) as u32,
            first_rest: packed.rest.len() as u32,
            first_joint: packed.joints.len() as u32,
            first_block: packed.corners.len() as u32,
            joints: self.joints.len() as u32,
            slots: self.vertices.len() as u8,
            owned: owned as u8,
            triangles: leaf.triangles.len() as u8,
        };
        self.push_rest(&cluster);
        self.push_triangles(leaf);
        self.packed.joints.extend(&self.joints);
        self.packed.vertices.extend(&self.vertices);
        let padded = self.packed.vertices.len().next_multiple_of(ROW);
        self.packed.vertices.resize(padded, VertexId(u32::MAX));
        self.packed.clusters.push(cluster);
    }

    /// Assigns a slot to every vertex of the leaf. Returns the number of vertices that no cluster held before.
    fn collect_vertices(&mut self, leaf: &Leaf) -> usize {
        let corners = leaf.triangles.iter();
        let corners = corners.flat_map(|t| self.mesh.triangles()[t.index()]);
        self.vertices.clear();
        self.vertices.extend(corners);
        let held = &mut self.held;
        self.vertices
            .sort_unstable_by_key(|v| (held[v.index()], *v));
        self.vertices.dedup();
        let owned = self.vertices.partition_point(|v| !held[v.index()]);
        for (slot, vertex) in self.vertices.iter().enumerate() {
            held[vertex.index()] = true;
            self.slot[vertex.index()] = slot as u8;
        }
        owned
    }

    fn collect_joints(&mut self) {
        self.joints.clear();
        for vertex in &self.vertices {
            let influences = self.mesh.influences(*vertex);
            self.joints.extend(influences.map(|(joint, _)| joint.0));
        }
        self.joints.sort_unstable();
        self.joints.dedup();
        for (place, joint) in self.joints.iter().enumerate() {
            self.place[*joint as usize] = place as u32;
        }
    }

    fn push_rest(&mut self, cluster: &Cluster) {
        let rows = cluster.rows();
        let rest = &mut self.packed.rest;
        let first = rest.len();
        rest.resize(first + (3 + self.joints.len()) * rows, Row::default());
        let rest = &mut rest[first..];
        let of_row = 3 + self.joints.len();
        for slot in 0..rows * ROW {
            // Unused slots repeat the first, so that the kernel needs no special case.
            let vertex = self.vertices.get(slot).unwrap_or(&self.vertices[0]);
            let (rest, lane) = (&mut rest[slot / ROW * of_row..][..of_row], slot % ROW);
            let position = self.mesh.positions()[vertex.index()].to_array();
            for (row, coordinate) in rest.iter_mut().zip(position) {
                row.0[lane] = coordinate;
            }
            for (joint, weight) in self.mesh.influences(*vertex) {
                rest[3 + self.place[joint.index()] as usize].0[lane] = weight;
            }
        }
    }

    fn push_triangles(&mut self, leaf: &Leaf) {
        for triangles in leaf.triangles.chunks(BLOCK) {
            let mut block = CornerBlock([[0; BLOCK]; 3]);
            for (lane, triangle) in triangles.iter().enumerate() {
                let corners = self.mesh.triangles()[triangle.index()];
                for (corner, vertex) in corners.into_iter().enumerate() {
                    block.0[corner][lane] = self.slot[vertex.index()];
                }
            }
            self.packed.corners.push(block);
            self.packed.triangles.extend(triangles);
        }
        let padded = self.packed.triangles.len().next_multiple_of(BLOCK);
        self.packed.triangles.resize(padded, TriangleId(u32::MAX));
    }
}
