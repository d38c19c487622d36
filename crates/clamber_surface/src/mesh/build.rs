//! Builds a [`ColliderMesh`] from slices: normalises weights, welds vertices, drops unusable triangles, assigns parts.
//! The steps follow the import in the thesis that this library grew from (5.4, "Import and setup").

use std::collections::{BTreeMap, HashMap, HashSet};

use glam::Vec3;

use super::clusters::Clusters;
use super::collider::has_area;
use super::derived::Derived;
use super::hierarchy::{Hierarchy, STACK};
use super::influences::Influences;
use super::joint_balls::JointBalls;
use super::lineage::Lineage;
use super::parts::Parts;
use super::weights::normalize;
use super::{ColliderMesh, Influence, MeshError, SurfaceTag, SurfaceTags, VertexId};
use crate::geometry::{MAX_COORDINATE, widen};
use crate::rig::JointId;

/// The input of [`ColliderMesh::build`]: slices, as importers and engines have them.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeshSource<'a> {
    /// Rest positions in mesh space: finite, at most 2^99 from the origin.
    pub positions: &'a [Vec3],
    /// The three corners of each triangle, as indices into `positions`; counter-clockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// Influences of all vertices, one vertex after the other. A vertex can have any number of them. A single influence
    /// without `influence_ends` applies to every vertex.
    pub influences: &'a [Influence],
    /// For each vertex, the index in `influences` after its last one. Empty if all vertices have the same number of
    /// influences; pad them with zero weights.
    pub influence_ends: &'a [u32],
    /// One tag per triangle. Empty gives every triangle [`SurfaceTag::default`].
    pub tags: &'a [SurfaceTag],
    /// One number per vertex, equal for vertices whose rest positions are in the same space. Empty if all are in
    /// one space. Vertices in different spaces are never welded, even if their rest positions are equal. Needed for
    /// creatures whose pieces each have a space of their own, such as robots.
    pub rest_spaces: &'a [u32],
    /// Number of joints of the skeleton.
    pub joint_count: usize,
}

impl<'a> MeshSource<'a> {
    /// A rigid mesh: joint 0, the only joint, moves every vertex.
    ///
    /// ```
    /// use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource, VertexId};
    /// use clamber_surface::rig::JointId;
    /// use glam::Vec3;
    ///
    /// let source = MeshSource::rigid(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
    /// let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default())?;
    /// assert!(mesh.influences(VertexId(2)).eq([(JointId(0), 1.0)]));
    /// # Ok::<(), clamber_surface::mesh::MeshError>(())
    /// ```
    pub fn rigid(positions: &'a [Vec3], triangles: &'a [[u32; 3]]) -> Self {
        const WHOLE: Influence = Influence {
            joint: JointId(0),
            weight: 1.0,
        };
        Self {
            positions,
            triangles,
            influences: &[WHOLE],
            joint_count: 1,
            ..Self::default()
        }
    }
}

/// Treatment of vertices that coincide at rest but have different influences.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum CrackPolicy {
    /// Keep them apart and count them in [`BuildReport::cracks`]. The surface can open there when it is posed.
    #[default]
    Report,
    /// Give them the mean of their weights and weld them.
    Unify,
}

/// Which side of the triangles is outside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Winding {
    /// The side from which the given corners are counter-clockwise.
    #[default]
    Keep,
    /// The other side: swaps two corners of every triangle.
    Flip,
}

/// Options of [`ColliderMesh::build`]. The default suits a well-made file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ColliderBuildOptions {
    /// Treatment of coincident vertices that have different influences.
    pub cracks: CrackPolicy,
    /// Which side of the triangles is outside.
    pub winding: Winding,
}

/// The findings and changes of [`ColliderMesh::build`].
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BuildReport {
    /// Number of vertices of the built mesh.
    pub vertices: usize,
    /// Number of source vertices that were merged into another vertex with equal position and influences.
    pub welded: usize,
    /// Number of vertices that coincide at rest with another vertex but were kept apart, because their influences
    /// differ; of each group of coincident vertices, one is not counted. The surface can crack there. 0 under
    /// [`CrackPolicy::Unify`].
    pub cracks: usize,
    /// Number of triangles of the built mesh.
    pub triangles: usize,
    /// Number of triangles dropped because they have no area at rest.
    pub degenerate_triangles: usize,
    /// Number of triangles dropped because an earlier one has the same corners in the same orientation.
    pub duplicate_triangles: usize,
    /// For each triangle of the mesh, its index among the source's triangles; ascending.
    pub source_triangles: Vec<u32>,
    /// The most influences of one vertex, after those of the same joint were merged.
    pub max_influences: usize,
    /// The largest difference from 1 of the sum of a source vertex's weights.
    pub worst_weight_error: f64,
}

/// Rest position of a vertex (its bits, with -0 replaced by +0), and the space that it is in.
type Place = ([u32; 3], u32);

/// Place and influences. Vertices with equal keys are welded.
type VertexKey = (Place, Vec<(JointId, u32)>);

impl ColliderMesh {
    /// Builds a mesh. Normalises weights to exact sums, welds vertices that are equal in position and influences,
    /// drops duplicate triangles and triangles without area, and assigns every triangle to the part of the joint
    /// that moves it most.
    ///
    /// ```
    /// use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource};
    /// use glam::Vec3;
    ///
    /// let source = MeshSource::rigid(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2], [2, 0, 1]]);
    /// let (mesh, report) = ColliderMesh::build(&source, &ColliderBuildOptions::default())?;
    /// assert_eq!(mesh.triangles().len(), 1);
    /// assert_eq!(report.duplicate_triangles, 1);
    /// assert_eq!(report.source_triangles, [0]);
    /// # Ok::<(), clamber_surface::mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// [`MeshError`] if the input is not finite, out of range or inconsistent, or if no triangle is left. The error
    /// names what is wrong, and where.
    pub fn build(
        source: &MeshSource<'_>,
        options: &ColliderBuildOptions,
    ) -> Result<(Self, BuildReport), MeshError> {
        validate(source)?;
        let mut report = BuildReport::default();
        let mut keys = vertex_keys(source, &mut report)?;
        let split = coincident_groups(&keys);
        match options.cracks {
            CrackPolicy::Report => report.cracks = split.iter().map(|g| g.kinds - 1).sum(),
            CrackPolicy::Unify => unify(&mut keys, &split),
        }
        let (mut mesh, vertex_of) = weld(source, &keys);
        report.vertices = mesh.positions.len();
        report.welded = source.positions.len() - report.vertices;
        report.max_influences = mesh.max_influences();
        mesh.keep_triangles(source, &vertex_of, options.winding, &mut report);
        if mesh.triangles.is_empty() {
            return Err(MeshError::NoTriangles {
                triangles: source.triangles.len(),
            });
        }
        mesh.lineage = Lineage::of(&mesh);
        mesh.assign_parts();
        mesh.cluster();
        mesh.shrink();
        let needed = mesh.hierarchy.stack_needed();
        if needed > STACK {
            return Err(MeshError::TooDeep {
                needed,
                most: STACK,
            });
        }
        report.triangles = mesh.triangles.len();
        Ok((mesh, report))
    }

    /// Drops memory that a build needs and a mesh does not.
    fn shrink(&mut self) {
        self.positions.shrink_to_fit();
        self.triangles.shrink_to_fit();
        self.influences.shrink();
        self.parts.shrink();
    }

    /// Appends the triangles that have an area, without duplicates.
    fn keep_triangles(
        &mut self,
        source: &MeshSource<'_>,
        vertex_of: &[u32],
        winding: Winding,
        report: &mut BuildReport,
    ) {
        let mut seen = HashSet::new();
        for (index, triangle) in source.triangles.iter().enumerate() {
            let mut corners = triangle.map(|v| VertexId(vertex_of[v as usize]));
            if winding == Winding::Flip {
                corners.swap(1, 2);
            }
            if !has_area(corners.map(|v| self.positions[v.index()])) {
                report.degenerate_triangles += 1;
                continue;
            }
            // Smallest corner first, in the same cyclic order: the three ways to write a triangle become one.
            let mut canonical = corners;
            while canonical[0] > canonical[1] || canonical[0] > canonical[2] {
                canonical.rotate_left(1);
            }
            if !seen.insert(canonical) {
                report.duplicate_triangles += 1;
                continue;
            }
            self.triangles.push(corners);
            report.source_triangles.push(index as u32);
            self.tags
                .push(source.tags.get(index).copied().unwrap_or_default());
        }
    }

    /// Creates the parts, in ascending joint order.
    fn assign_parts(&mut self) {
        let corners = self.triangles.iter();
        let joints: Vec<JointId> = corners.map(|c| self.dominant_joint(*c)).collect();
        self.parts = Parts::of_joints(&joints);
    }
}

/// Most joints of a mesh: as many as glTF's joint indices can tell apart.
const MAX_JOINTS: usize = 1 << 16;

/// Refuses more vertices, influences or triangles than ids can number.
pub(super) fn check_count(what: &'static str, found: usize) -> Result<(), MeshError> {
    let most = u32::MAX as usize - 1;
    if found > most {
        return Err(MeshError::TooLarge { what, found, most });
    }
    Ok(())
}

/// Checks counts, index ranges, and that positions are usable.
fn validate(source: &MeshSource<'_>) -> Result<(), MeshError> {
    let vertices = source.positions.len();
    let counts = [
        ("vertices", vertices),
        ("influences", source.influences.len()),
        ("triangles", source.triangles.len()),
    ];
    for (what, found) in counts {
        check_count(what, found)?;
    }
    if source.joint_count > MAX_JOINTS {
        return Err(MeshError::TooLarge {
            what: "joints",
            found: source.joint_count,
            most: MAX_JOINTS,
        });
    }
    let influences = source.influences.len();
    let ends = source.influence_ends;
    let divided = if ends.is_empty() {
        let shared = influences == 1;
        vertices > 0 && influences > 0 && (shared || influences.is_multiple_of(vertices))
    } else {
        let last = ends.last().is_some_and(|end| *end as usize == influences);
        ends.len() == vertices && ends.is_sorted() && last
    };
    if !divided {
        return Err(MeshError::InfluenceCount {
            influences,
            vertices,
        });
    }
    if !source.rest_spaces.is_empty() && source.rest_spaces.len() != vertices {
        return Err(MeshError::RestSpaceCount {
            expected: vertices,
            found: source.rest_spaces.len(),
        });
    }
    if !source.tags.is_empty() && source.tags.len() != source.triangles.len() {
        return Err(MeshError::TagCount {
            expected: source.triangles.len(),
            found: source.tags.len(),
        });
    }
    if let Some(vertex) = source.positions.iter().position(|p| !is_usable(*p)) {
        return Err(MeshError::Position { vertex });
    }
    for (triangle, corners) in source.triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|v| **v as usize >= vertices) {
            return Err(MeshError::VertexOutOfRange {
                triangle,
                vertex,
                vertices,
            });
        }
    }
    for (vertex, influences) in source.influences_by_vertex().enumerate() {
        let beyond = |i: &&Influence| i.joint.0 as usize >= source.joint_count;
        if let Some(influence) = influences.iter().find(beyond) {
            return Err(MeshError::JointOutOfRange {
                vertex,
                joint: influence.joint,
                joints: source.joint_count,
            });
        }
    }
    Ok(())
}

/// True for a position within 2^99 of the origin; false if it is not finite. The bound is half of the bound on skinned
/// positions: the identity, whose Frobenius norm is sqrt(3), then passes [`ColliderMesh::check_palette`].
pub(super) fn is_usable(position: Vec3) -> bool {
    // This comparison is false for NaN.
    widen(position).length() <= MAX_COORDINATE * 0.5
}

impl<'a> MeshSource<'a> {
    /// The influences of each vertex. Call it only after their counts have been validated.
    fn influences_by_vertex(&self) -> impl Iterator<Item = &'a [Influence]> + use<'a> {
        let (influences, ends) = (self.influences, self.influence_ends);
        let vertices = self.positions.len();
        let shared = ends.is_empty() && influences.len() == 1;
        let each = influences.len() / vertices.max(1);
        let end = move |v: usize| ends.get(v).map_or((v + 1) * each, |end| *end as usize);
        (0..vertices).map(move |v| {
            if shared {
                return influences;
            }
            let start = if v == 0 { 0 } else { end(v - 1) };
            &influences[start..end(v)]
        })
    }
}

/// The key of every source vertex, with normalised weights.
fn vertex_keys(
    source: &MeshSource<'_>,
    report: &mut BuildReport,
) -> Result<Vec<VertexKey>, MeshError> {
    let mut keys = Vec::with_capacity(source.positions.len());
    let given = source.influences_by_vertex();
    for (vertex, (position, influences)) in source.positions.iter().zip(given).enumerate() {
        let weights = normalize(influences).ok_or_else(|| MeshError::Weights {
            vertex,
            weights: influences.iter().map(|i| i.weight).collect(),
        })?;
        let sum: f64 = influences.iter().map(|i| f64::from(i.weight)).sum();
        report.worst_weight_error = report.worst_weight_error.max((sum - 1.0).abs());
        // Adding +0 turns -0 into +0 and keeps every other number.
        let bits = position.to_array().map(|x| (x + 0.0).to_bits());
        let space = source.rest_spaces.get(vertex).copied().unwrap_or_default();
        keys.push(((bits, space), weights));
    }
    Ok(keys)
}

/// Vertices at one place that have more than one distinct set of influences.
struct CoincidentGroup {
    vertices: Vec<u32>,
    /// How many distinct sets there are.
    kinds: usize,
}

fn coincident_groups(keys: &[VertexKey]) -> Vec<CoincidentGroup> {
    let mut at: BTreeMap<Place, Vec<u32>> = BTreeMap::new();
    for (vertex, (place, _)) in keys.iter().enumerate() {
        at.entry(*place).or_default().push(vertex as u32);
    }
    let groups = at.into_values().filter_map(|vertices| {
        let mut kinds: Vec<_> = vertices.iter().map(|v| &keys[*v as usize].1).collect();
        kinds.sort();
        kinds.dedup();
        let kinds = kinds.len();
        (kinds > 1).then_some(CoincidentGroup { vertices, kinds })
    });
    groups.collect()
}

/// Gives every vertex of a group the mean of the group's weights.
fn unify(keys: &mut [VertexKey], groups: &[CoincidentGroup]) {
    for group in groups {
        let all: Vec<Influence> = group
            .vertices
            .iter()
            .flat_map(|v| &keys[*v as usize].1)
            .map(|(joint, units)| Influence {
                joint: *joint,
                weight: *units as f32,
            })
            .collect();
        if let Some(mean) = normalize(&all) {
            for vertex in &group.vertices {
                keys[*vertex as usize].1.clone_from(&mean);
            }
        }
    }
}

/// A mesh of the distinct vertices without triangles, and for each source vertex its number in the mesh. Vertices
/// are numbered by first appearance.
fn weld(source: &MeshSource<'_>, keys: &[VertexKey]) -> (ColliderMesh, Vec<u32>) {
    let mut mesh = ColliderMesh {
        lineage: Lineage::default(),
        joint_count: source.joint_count,
        positions: Vec::new(),
        influences: Influences::default(),
        triangles: Vec::new(),
        tags: SurfaceTags::default(),
        parts: Parts::default(),
        vertex_removed: Vec::new(),
        radius: 0.0,
        clusters: Clusters::default(),
        hierarchy: Hierarchy::default(),
        joint_balls: JointBalls::default(),
        part_nodes: Derived::default(),
        adjacency: Derived::default(),
    };
    let mut number_of: HashMap<&VertexKey, u32> = HashMap::new();
    let mut vertex_of = Vec::with_capacity(keys.len());
    for (key, position) in keys.iter().zip(source.positions) {
        let number = *number_of.entry(key).or_insert_with(|| {
            mesh.positions.push(*position + Vec3::ZERO);
            mesh.influences.push(key.1.iter().copied());
            (mesh.positions.len() - 1) as u32
        });
        vertex_of.push(number);
    }
    mesh.radius = ColliderMesh::radius_of(&mesh.positions);
    (mesh, vertex_of)
}

#[cfg(test)]
mod tests;
