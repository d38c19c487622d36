use bytemuck::cast_slice;
use clamber_surface::mesh::{Influence, SurfaceKind};
use glam::Vec3;
use wgpu::{Buffer, BufferDescriptor, BufferUsages};

use crate::{Gpu, RenderError};

/// The id of a mesh in a [`Renderer`](crate::Renderer).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RenderMeshId(pub(crate) u32);

/// The data of a mesh to draw.
#[derive(Clone, Copy, Debug, Default)]
pub struct RenderMesh<'a> {
    /// Rest positions, one for each vertex.
    pub positions: &'a [Vec3],
    /// Normals, one for each vertex; if empty, computed from the triangles around each vertex.
    pub normals: &'a [Vec3],
    /// Linear red, green and blue, one for each vertex; if empty, all white.
    pub colors: &'a [[f32; 3]],
    /// Look of the surface, one for each vertex; if empty, all [`Look::Plain`].
    pub looks: &'a [Look],
    /// Corners as indices of vertices, counter-clockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// The influences of joints; `None` for a rigid mesh.
    pub skin: Option<SkinSource<'a>>,
}

/// The influences of joints on a mesh.
#[derive(Clone, Copy, Debug, Default)]
pub struct SkinSource<'a> {
    /// Influences of the first vertex, then of the second, and so on, each vertex's by ascending joint.
    pub influences: &'a [Influence],
    /// For each vertex, the index in `influences` after its last influence.
    pub ends: &'a [u32],
    /// Number of joints of the palettes that will pose the mesh.
    pub joint_count: usize,
}

/// The shading of a surface, apart from its colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Look {
    /// Smooth.
    #[default]
    Plain,
    /// Rough and bumpy, with lighter and darker patches of the surface's colour.
    Stone,
    /// Strands that catch the light at the rim.
    Fur,
    /// Grass and earth, by the slope.
    Ground,
}

/// [`SurfaceKind::Skin`] becomes [`Look::Plain`].
impl From<SurfaceKind> for Look {
    fn from(kind: SurfaceKind) -> Self {
        match kind {
            SurfaceKind::Skin => Self::Plain,
            SurfaceKind::Fur => Self::Fur,
            SurfaceKind::Stone => Self::Stone,
        }
    }
}

/// Bytes of a vertex's data that are the same in all poses: the position at rest, and the colour with the look. The
/// layout is `Vertex` in `mesh.wgsl`, locations 2 and 3.
pub(crate) const STILL_BYTES: u64 = 32;

/// Bytes of a posed vertex: position and normal, each with a spare number. The layout is `Vertex` in `skin.wgsl`.
pub(crate) const POSED_BYTES: u64 = 32;

/// Bytes of a joint's matrix: three rows of four f32, as in `skin.wgsl`.
pub(crate) const PALETTE_BYTES: u64 = 48;

/// A mesh on the GPU.
#[derive(Debug)]
pub(crate) struct Mesh {
    pub(crate) still: Buffer,
    pub(crate) rest: Buffer,
    pub(crate) indices: Buffer,
    pub(crate) index_count: u32,
    pub(crate) vertex_count: u32,
    pub(crate) skin: Option<Skin>,
}

/// The influences of joints on a mesh, on the GPU.
#[derive(Debug)]
pub(crate) struct Skin {
    pub(crate) ends: Buffer,
    pub(crate) influences: Buffer,
    pub(crate) joint_count: usize,
}

impl Mesh {
    pub(crate) fn new(gpu: &Gpu, source: &RenderMesh<'_>) -> Result<Self, RenderError> {
        check(source)?;
        check_size(gpu, source)?;
        let normals = match source.normals {
            [] => normals(source),
            given => given.to_vec(),
        };
        let mut still = Vec::with_capacity(source.positions.len());
        let mut rest = Vec::with_capacity(source.positions.len());
        for (index, (p, n)) in source.positions.iter().zip(&normals).enumerate() {
            let color = source.colors.get(index).copied().unwrap_or([1.0; 3]);
            let look = source.looks.get(index).copied().unwrap_or_default();
            still.push([
                p.x,
                p.y,
                p.z,
                0.0,
                color[0],
                color[1],
                color[2],
                look as u8 as f32,
            ]);
            rest.push([p.x, p.y, p.z, 1.0, n.x, n.y, n.z, 0.0]);
        }
        let usage = BufferUsages::VERTEX | BufferUsages::STORAGE;
        let skin = source.skin.map(|skin| {
            let influences: Vec<[f32; 2]> = skin
                .influences
                .iter()
                .map(|influence| [f32::from_bits(influence.joint.0), influence.weight])
                .collect();
            Skin {
                ends: buffer(gpu, "ends", cast_slice(skin.ends), BufferUsages::STORAGE),
                influences: buffer(
                    gpu,
                    "influences",
                    cast_slice(&influences),
                    BufferUsages::STORAGE,
                ),
                joint_count: skin.joint_count,
            }
        });
        Ok(Self {
            still: buffer(gpu, "still", cast_slice(&still), usage),
            rest: buffer(gpu, "rest", cast_slice(&rest), usage),
            indices: buffer(
                gpu,
                "indices",
                cast_slice(source.triangles),
                BufferUsages::INDEX,
            ),
            index_count: (source.triangles.len() * 3) as u32,
            vertex_count: source.positions.len() as u32,
            skin,
        })
    }
}

pub(crate) fn buffer(gpu: &Gpu, label: &str, contents: &[u8], usage: BufferUsages) -> Buffer {
    // A bound buffer must not be shorter than one element of the shader's array.
    let contents = if contents.is_empty() {
        &[0; 64]
    } else {
        contents
    };
    let buffer = gpu.device.create_buffer(&BufferDescriptor {
        label: Some(label),
        size: contents.len() as u64,
        usage,
        mapped_at_creation: true,
    });
    // The buffer is not mapped if the device is out of memory or lost, which `Gpu::checked` reports.
    if let Ok(mut view) = buffer.get_mapped_range_mut(..) {
        view.copy_from_slice(contents);
    }
    buffer.unmap();
    buffer
}

/// Refuses a mesh that is too large for the device.
fn check_size(gpu: &Gpu, source: &RenderMesh<'_>) -> Result<(), RenderError> {
    let limits = gpu.device.limits();
    let skin = source.skin.unwrap_or_default();
    let bound = limits
        .max_buffer_size
        .min(limits.max_storage_buffer_binding_size);
    for (what, count, bytes, most) in [
        ("vertices", source.positions.len(), POSED_BYTES, bound),
        ("influences", skin.influences.len(), 8, bound),
        ("joints", skin.joint_count, PALETTE_BYTES, bound),
        (
            "triangles",
            source.triangles.len(),
            12,
            limits.max_buffer_size.min(u64::from(u32::MAX / 3) * 12),
        ),
    ] {
        if count as u64 > most / bytes {
            return Err(RenderError::Mesh(format!(
                "{count} {what}, but this device takes at most {}: split it into smaller meshes",
                most / bytes
            )));
        }
    }
    Ok(())
}

fn check(source: &RenderMesh<'_>) -> Result<(), RenderError> {
    let count = source.positions.len();
    let wrong = |what: String| Err(RenderError::Mesh(what));
    for (what, found) in [
        ("normals", source.normals.len()),
        ("colours", source.colors.len()),
        ("looks", source.looks.len()),
    ] {
        if found != 0 && found != count {
            return wrong(format!("{found} {what} for {count} positions"));
        }
    }
    if !source.positions.iter().all(|p| p.is_finite()) {
        return wrong("a position is not finite".into());
    }
    let corners = source.triangles.iter().flatten();
    if let Some(corner) = corners.copied().find(|corner| *corner as usize >= count) {
        return wrong(format!("a triangle names vertex {corner} of {count}"));
    }
    let Some(skin) = &source.skin else {
        return Ok(());
    };
    if skin.ends.len() != count {
        return wrong(format!(
            "{} ends of influences for {count} positions",
            skin.ends.len()
        ));
    }
    let ascending = skin.ends.windows(2).all(|pair| pair[0] <= pair[1]);
    let last = skin.ends.last().map_or(0, |end| *end as usize);
    if !ascending || last != skin.influences.len() {
        return wrong("the ends of influences must ascend to their count".into());
    }
    let joints = skin
        .influences
        .iter()
        .map(|influence| influence.joint.0 as usize);
    if let Some(joint) = joints.max().filter(|joint| *joint >= skin.joint_count) {
        return wrong(format!(
            "an influence names joint {joint} of {}",
            skin.joint_count
        ));
    }
    Ok(())
}

/// The normal of each vertex: the mean of its triangles' normals, weighted by area.
fn normals(source: &RenderMesh<'_>) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; source.positions.len()];
    for corners in source.triangles {
        let [a, b, c] = corners.map(|corner| source.positions[corner as usize]);
        let normal = (b - a).cross(c - a);
        for corner in corners {
            normals[*corner as usize] += normal;
        }
    }
    for normal in &mut normals {
        *normal = normal.normalize_or(Vec3::Y);
    }
    normals
}
