//! The collider mesh under construction.

use std::collections::BTreeMap;
use std::ops::Range;

use clamber_surface::mesh::{
    BuildReport, ColliderBuildOptions, ColliderMesh, Influence, MeshError, MeshSource, SurfaceTag,
    TriangleId,
};
use glam::Vec3;

use crate::GltfErrorKind;
use crate::vertices::Vertices;
use crate::visual::Material;

/// All collision primitives of a creature, merged.
#[derive(Default)]
pub(crate) struct Collision {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) influences: Vec<Influence>,
    pub(crate) influence_ends: Vec<u32>,
    /// The rest space of each vertex. Each skin and each rigid mesh has its own rest space.
    pub(crate) spaces: Vec<u32>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) tags: Vec<SurfaceTag>,
    /// For each primitive with a material, the index of the material and the range of the primitive's triangles.
    /// Ascending.
    pub(crate) materials: Vec<(usize, Range<usize>)>,
}

impl Collision {
    /// Appends vertices; returns the index of the first.
    pub(crate) fn append(
        &mut self,
        vertices: &Vertices,
        space: u32,
        object: &str,
    ) -> Result<u32, GltfErrorKind> {
        let too_many = || GltfErrorKind::invalid(object, "the file has more than 2^32 vertices");
        let base = u32::try_from(self.positions.len()).map_err(|_| too_many())?;
        let before = u32::try_from(self.influences.len()).map_err(|_| too_many())?;
        let ends = vertices
            .influence_ends
            .iter()
            .map(|end| before.checked_add(*end));
        let ends: Option<Vec<u32>> = ends.collect();
        self.influence_ends.extend(ends.ok_or_else(too_many)?);
        self.influences.extend_from_slice(&vertices.influences);
        self.positions.extend_from_slice(&vertices.positions);
        self.spaces.resize(self.positions.len(), space);
        Ok(base)
    }

    pub(crate) fn build(
        &self,
        joint_count: usize,
        options: &ColliderBuildOptions,
    ) -> Result<(ColliderMesh, BuildReport), MeshError> {
        let source = MeshSource {
            positions: &self.positions,
            triangles: &self.triangles,
            influences: &self.influences,
            influence_ends: &self.influence_ends,
            tags: &self.tags,
            rest_spaces: &self.spaces,
            joint_count,
        };
        ColliderMesh::build(&source, options)
    }

    /// The triangles of the built mesh, by the name of their material. Triangles without a named material are left out.
    pub(crate) fn named_materials(
        &self,
        report: &BuildReport,
        all: &[Material],
    ) -> BTreeMap<String, Vec<TriangleId>> {
        let mut named: BTreeMap<String, Vec<TriangleId>> = BTreeMap::new();
        let built = &report.source_triangles;
        for (material, Range { start, end }) in &self.materials {
            let name = all.get(*material).and_then(|one| one.name.as_ref());
            let [first, after] = [*start, *end]
                .map(|bound| built.partition_point(|source| (*source as usize) < bound));
            let Some(name) = name.filter(|_| first < after) else {
                continue;
            };
            let triangles = (first..after).map(|index| TriangleId(index as u32));
            match named.get_mut(name) {
                Some(known) => known.extend(triangles),
                None => {
                    named.insert(name.clone(), triangles.collect());
                }
            }
        }
        named
    }
}
