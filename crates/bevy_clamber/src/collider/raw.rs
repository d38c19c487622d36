use bevy_mesh::{Indices, Mesh, MeshAccessError, PrimitiveTopology, VertexAttributeValues};
use bevy_shape::{Aabb3d, BoundingVolume};
use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, Influence, MeshSource, SurfaceTag,
};
use clamber_surface::rig::JointId;
use glam::Vec3;
use std::sync::Arc;

use super::{BuiltCollider, ColliderError};

/// The data of a mesh asset that a collider needs, copied as it is stored. It is decoded on another thread.
pub(crate) struct RawMesh {
    positions: VertexAttributeValues,
    joints: VertexAttributeValues,
    weights: VertexAttributeValues,
    indices: Option<Indices>,
    topology: PrimitiveTopology,
    bounds: Option<Aabb3d>,
}

impl RawMesh {
    pub(crate) fn copy(mesh: &Mesh) -> Result<Self, ColliderError> {
        let attribute = |attribute, name| match mesh.try_attribute(attribute) {
            Ok(values) => Ok(values.clone()),
            Err(MeshAccessError::ExtractedToRenderWorld) => Err(ColliderError::MovedToRenderWorld),
            Err(MeshAccessError::NotFound) => Err(ColliderError::Missing(name)),
        };
        let indices = mesh.try_indices_option();
        Ok(Self {
            positions: attribute(Mesh::ATTRIBUTE_POSITION, "positions")?,
            joints: attribute(Mesh::ATTRIBUTE_JOINT_INDEX, "joint indices")?,
            weights: attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, "joint weights")?,
            indices: indices
                .map_err(|_| ColliderError::MovedToRenderWorld)?
                .cloned(),
            topology: mesh.primitive_topology(),
            bounds: mesh.final_aabb,
        })
    }

    pub(crate) fn build(
        &self,
        joint_count: usize,
        tag: SurfaceTag,
    ) -> Result<BuiltCollider, ColliderError> {
        let positions = self.positions()?;
        let influences = self.influences(positions.len())?;
        let triangles = self.triangles(positions.len())?;
        let source = MeshSource {
            positions: &positions,
            triangles: &triangles,
            influences: &influences,
            tags: &vec![tag; triangles.len()],
            joint_count,
            ..MeshSource::default()
        };
        let (mesh, report) = ColliderMesh::build(&source, &ColliderBuildOptions::default())?;
        Ok(BuiltCollider {
            mesh: Arc::new(mesh),
            source_triangles: report.source_triangles,
        })
    }

    fn positions(&self) -> Result<Vec<Vec3>, ColliderError> {
        match &self.positions {
            VertexAttributeValues::Float32x3(values) => {
                Ok(values.iter().map(|p| Vec3::from_array(*p)).collect())
            }
            VertexAttributeValues::Snorm16x4(values) => {
                let bounds = self.bounds.ok_or(ColliderError::NoBounds)?;
                let (center, half) = (Vec3::from(bounds.center()), Vec3::from(bounds.half_size()));
                let signed = |x: i16| (f32::from(x) / f32::from(i16::MAX)).max(-1.0);
                let decode = |[x, y, z, _]: &[i16; 4]| {
                    center + half * Vec3::new(signed(*x), signed(*y), signed(*z))
                };
                Ok(values.iter().map(decode).collect())
            }
            other => Err(unknown("positions", other)),
        }
    }

    fn influences(&self, vertices: usize) -> Result<Vec<Influence>, ColliderError> {
        let joints = match &self.joints {
            VertexAttributeValues::Uint16x4(joints) => joints,
            other => return Err(unknown("joint indices", other)),
        };
        let weights: Vec<[f32; 4]> = match &self.weights {
            VertexAttributeValues::Float32x4(weights) => weights.clone(),
            VertexAttributeValues::Unorm16x4(weights) => {
                let unsigned = |x: u16| f32::from(x) / f32::from(u16::MAX);
                weights.iter().map(|w| w.map(unsigned)).collect()
            }
            VertexAttributeValues::Unorm8x4(weights) => {
                let unsigned = |x: u8| f32::from(x) / f32::from(u8::MAX);
                weights.iter().map(|w| w.map(unsigned)).collect()
            }
            other => return Err(unknown("joint weights", other)),
        };
        for (attribute, found) in [
            ("joint indices", joints.len()),
            ("joint weights", weights.len()),
        ] {
            if found != vertices {
                return Err(ColliderError::Length {
                    positions: vertices,
                    attribute,
                    found,
                });
            }
        }
        let pairs = joints.iter().flatten().zip(weights.iter().flatten());
        // Unused influences have weight 0 and any joint index.
        Ok(pairs
            .map(|(joint, weight)| Influence {
                joint: JointId(if *weight == 0.0 { 0 } else { u32::from(*joint) }),
                weight: *weight,
            })
            .collect())
    }

    fn triangles(&self, vertices: usize) -> Result<Vec<[u32; 3]>, ColliderError> {
        let corners: Vec<u32> = match &self.indices {
            Some(Indices::U16(indices)) => indices.iter().map(|i| u32::from(*i)).collect(),
            Some(Indices::U32(indices)) => indices.clone(),
            None => (0..vertices as u32).collect(),
        };
        // The index that starts a new strip.
        let end = match &self.indices {
            Some(Indices::U16(_)) => Some(u32::from(u16::MAX)),
            Some(Indices::U32(_)) => Some(u32::MAX),
            None => None,
        };
        match self.topology {
            PrimitiveTopology::TriangleList => Ok(corners.as_chunks::<3>().0.to_vec()),
            PrimitiveTopology::TriangleStrip => {
                let strips = corners.split(|corner| Some(*corner) == end);
                let triangles = strips.flat_map(|strip| strip.windows(3).enumerate());
                // Every other triangle of a strip is wound the other way.
                Ok(triangles
                    .map(|(index, corners)| match index % 2 {
                        0 => [corners[0], corners[1], corners[2]],
                        _ => [corners[1], corners[0], corners[2]],
                    })
                    .collect())
            }
            other => Err(ColliderError::Topology(other)),
        }
    }
}

fn unknown(attribute: &'static str, values: &VertexAttributeValues) -> ColliderError {
    ColliderError::Format {
        attribute,
        format: values.into(),
    }
}
