use clamber_gltf::{Model, VisualMesh};

use crate::{Paint, RenderMesh, SkinSource};

/// A visual mesh of a model, prepared for a renderer.
#[derive(Clone, Debug)]
pub struct VisualSource<'a> {
    mesh: &'a VisualMesh,
    paint: Paint,
    joint_count: usize,
}

impl VisualSource<'_> {
    /// The data for [`Renderer::add_mesh`](crate::Renderer::add_mesh).
    pub fn source(&self) -> RenderMesh<'_> {
        RenderMesh {
            positions: &self.mesh.positions,
            normals: &self.mesh.normals,
            colors: &self.paint.colors,
            looks: &self.paint.looks,
            triangles: &self.paint.triangles,
            skin: Some(SkinSource {
                influences: &self.mesh.influences,
                ends: &self.mesh.influence_ends,
                joint_count: self.joint_count,
            }),
        }
    }
}

/// Prepares the visual meshes of a rig for a renderer, in the rig's order.
///
/// The colour of a vertex is its own colour times the base colour of its material. The look of a vertex follows from
/// the surface kind of the material's tag. If several materials share a vertex, the last one sets its colour and look.
///
/// ```no_run
/// use clamber_render::{Gpu, Renderer, visual_meshes};
///
/// let model = clamber_gltf::load("creature.glb")?;
/// let mut renderer = Renderer::new(Gpu::new()?, 640, 360)?;
/// let mut meshes = Vec::new();
/// for visual in visual_meshes(&model) {
///     meshes.push(renderer.add_mesh(&visual.source())?);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn visual_meshes(model: &Model) -> impl Iterator<Item = VisualSource<'_>> {
    model.visual.iter().map(|mesh| {
        let mut paint = Paint::new(mesh.positions.len());
        for primitive in &mesh.primitives {
            let material = primitive
                .material
                .and_then(|index| model.materials.get(index));
            let [r, g, b, _] = material.map_or([1.0; 4], |material| material.base_color);
            let look = primitive.tag.kind.into();
            paint.add(&primitive.triangles, [r, g, b], &mesh.colors, look);
        }
        VisualSource {
            mesh,
            paint,
            joint_count: model.rig.skeleton.joints().len(),
        }
    })
}
