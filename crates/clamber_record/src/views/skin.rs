use clamber_surface::mesh::{ColliderMesh, VertexId};
use foxglove::messages::packed_element_field::NumericType;
use foxglove::messages::{PackedElementField, PointCloud};
use glam::{DQuat, DVec3, Vec3};

use super::{pose, timestamp};

/// Bytes of a point: three f32.
const STRIDE: usize = 12;

/// The view of a skin: at most `at_most` posed vertices (0 means 1), picked at even steps, in the creature's frame,
/// metres. `positions` are the posed positions of all vertices of the mesh, in model space, and `scale` is the
/// creature's.
pub(crate) fn skin(
    nanoseconds: u64,
    (frame, scale): (&str, f64),
    (mesh, positions): (&ColliderMesh, &[Vec3]),
    at_most: usize,
) -> PointCloud {
    let step = positions.len().div_ceil(at_most.max(1)).max(1);
    let mut data = Vec::with_capacity(positions.len() / step * STRIDE + STRIDE);
    for (vertex, position) in positions.iter().enumerate().step_by(step) {
        if mesh.has_vertex(VertexId(vertex as u32)) {
            for x in (*position * scale as f32).to_array() {
                data.extend_from_slice(&x.to_le_bytes());
            }
        }
    }
    cloud(nanoseconds, frame, data)
}

/// A cloud without points, which replaces the one that was drawn in `frame`.
pub(crate) fn no_skin(nanoseconds: u64, frame: &str) -> PointCloud {
    cloud(nanoseconds, frame, Vec::new())
}

fn cloud(nanoseconds: u64, frame: &str, data: Vec<u8>) -> PointCloud {
    let field = |name: &str, offset| PackedElementField {
        name: name.to_owned(),
        offset,
        r#type: NumericType::Float32 as i32,
    };
    PointCloud {
        timestamp: Some(timestamp(nanoseconds)),
        frame_id: frame.to_owned(),
        pose: Some(pose(DVec3::ZERO, DQuat::IDENTITY)),
        point_stride: STRIDE as u32,
        fields: vec![field("x", 0), field("y", 4), field("z", 8)],
        data: data.into(),
    }
}
