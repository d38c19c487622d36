//! The meshes to draw of a creature, moved by the same joints as its collider, and their materials.

use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, Influence, MeshError, MeshSource, SurfaceTag,
    normalize_influences,
};
use glam::{Vec2, Vec3};
use gltf::material::AlphaMode;
use gltf::{Document, Primitive};

use crate::extras::tag_of;
use crate::looks::Looks;
use crate::vertices::Vertices;
use crate::{GltfErrorKind, ImportWarning, LoadOptions};

/// A mesh to draw.
///
/// The vertices are as in the file: they are not welded, but split where normals or texture coordinates differ. The
/// triangles are grouped by material.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct VisualMesh {
    /// Name of the node that shows it, else of its mesh; empty if both have none.
    pub name: String,
    /// Rest positions in mesh space, with morph targets at their rest weights.
    pub positions: Vec<Vec3>,
    /// Unit vectors in mesh space, one for each vertex. Zero where the file's normal cannot be normalised; empty if the
    /// file has no normals.
    pub normals: Vec<Vec3>,
    /// For each `TEXCOORD_n`, from 0 on, the texture coordinates of every vertex.
    pub tex_coords: Vec<Vec<Vec2>>,
    /// `COLOR_0`: linear red, green, blue and opacity, one for each vertex; empty if the file has none.
    pub colors: Vec<[f32; 4]>,
    /// Influences of the first vertex, then of the second, and so on. The influences of a vertex are sorted by joint,
    /// and their weights are normalised as in a collider.
    pub influences: Vec<Influence>,
    /// For each vertex, where its influences end in `influences`.
    pub influence_ends: Vec<u32>,
    /// The triangles, grouped by material.
    pub primitives: Vec<VisualPrimitive>,
}

/// Triangles of a visual mesh that share a material.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct VisualPrimitive {
    /// Index into [`Model::materials`](crate::Model::materials); `None` for glTF's default material.
    pub material: Option<usize>,
    /// The tag of the material. Without a material, the tagger's tag for surfaces without one, or the default without a
    /// tagger.
    pub tag: SurfaceTag,
    /// Corners, counter-clockwise seen from outside, as indices into the mesh's vertices.
    pub triangles: Vec<[u32; 3]>,
}

/// A material: the factors of glTF's metallic-roughness model, and a surface tag.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// The name in the file; `None` without one.
    pub name: Option<String>,
    /// Base colour: linear red, green, blue and opacity.
    pub base_color: [f32; 4],
    /// Metallic factor, 0 to 1.
    pub metallic: f32,
    /// Roughness factor, 0 to 1.
    pub roughness: f32,
    /// Emitted light: linear red, green and blue.
    pub emissive: [f32; 3],
    /// How the opacity in `base_color` is used.
    pub alpha: Alpha,
    /// True if back faces are drawn too.
    pub double_sided: bool,
    /// The surface tag, from the file's extras and the tagger.
    pub tag: SurfaceTag,
}

/// How a material's opacity is used: glTF's alpha mode.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Alpha {
    /// The opacity is ignored: the surface is opaque.
    #[default]
    Opaque,
    /// Points with at least this opacity are opaque; the others are not drawn.
    Mask(f32),
    /// The surface is blended with the background by its opacity.
    Blend,
}

impl VisualMesh {
    /// A mesh without triangles. Refuses positions that are not finite, and weights that cannot be normalised.
    pub(crate) fn new(
        name: String,
        vertices: &Vertices,
        looks: Looks,
        object: &str,
    ) -> Result<Self, GltfErrorKind> {
        if let Some(vertex) = vertices.positions.iter().position(|p| !p.is_finite()) {
            let reason = format!("vertex {vertex} has a position that is not finite");
            return Err(GltfErrorKind::invalid(object, reason));
        }
        let mut influences = Vec::with_capacity(vertices.influences.len());
        let mut influence_ends = Vec::with_capacity(vertices.influence_ends.len());
        let mut start = 0;
        for (vertex, end) in vertices.influence_ends.iter().enumerate() {
            let given = &vertices.influences[start..*end as usize];
            let normalized = normalize_influences(given).ok_or_else(|| {
                let weights: Vec<f32> = given.iter().map(|i| i.weight).collect();
                let reason = format!("weights {weights:?} of vertex {vertex} cannot be normalised");
                GltfErrorKind::invalid(object, reason)
            })?;
            influences.extend(normalized);
            influence_ends.push(influences.len() as u32);
            start = *end as usize;
        }
        Ok(Self {
            name,
            positions: vertices.positions.clone(),
            normals: looks.normals,
            tex_coords: looks.tex_coords,
            colors: looks.colors,
            influences,
            influence_ends,
            primitives: Vec::new(),
        })
    }

    pub(crate) fn push(
        &mut self,
        primitive: &Primitive<'_>,
        tag: SurfaceTag,
        triangles: Vec<[u32; 3]>,
    ) {
        self.primitives.push(VisualPrimitive {
            material: primitive.material().index(),
            tag,
            triangles,
        });
    }
}

/// Merges visual meshes into one collider mesh, with the tags of their primitives.
pub(crate) fn merged(visual: &[VisualMesh], joint_count: usize) -> Result<ColliderMesh, MeshError> {
    let (mut positions, mut influences, mut influence_ends) = (vec![], vec![], vec![]);
    let (mut triangles, mut tags) = (vec![], vec![]);
    for seen in visual {
        let (vertices, before) = (positions.len() as u32, influences.len() as u32);
        positions.extend_from_slice(&seen.positions);
        influences.extend_from_slice(&seen.influences);
        influence_ends.extend(seen.influence_ends.iter().map(|end| end + before));
        for primitive in &seen.primitives {
            let corners = primitive.triangles.iter();
            triangles.extend(corners.map(|t| t.map(|v| v + vertices)));
            tags.resize(triangles.len(), primitive.tag);
        }
    }
    let source = MeshSource {
        positions: &positions,
        triangles: &triangles,
        influences: &influences,
        influence_ends: &influence_ends,
        tags: &tags,
        joint_count,
        ..MeshSource::default()
    };
    Ok(ColliderMesh::build(&source, &ColliderBuildOptions::default())?.0)
}

/// Reads all materials of a file, in its order.
pub(crate) fn materials(
    document: &Document,
    options: &LoadOptions,
    warnings: &mut Vec<ImportWarning>,
) -> Result<Vec<Material>, GltfErrorKind> {
    let mut materials = Vec::new();
    let mut ledges = 0;
    for material in document.materials() {
        let (tag, has_ledge) = tag_of(&material)?;
        ledges += usize::from(has_ledge);
        let pbr = material.pbr_metallic_roughness();
        materials.push(Material {
            name: material.name().map(str::to_owned),
            base_color: pbr.base_color_factor(),
            metallic: pbr.metallic_factor(),
            roughness: pbr.roughness_factor(),
            emissive: material.emissive_factor(),
            alpha: match material.alpha_mode() {
                AlphaMode::Opaque => Alpha::Opaque,
                // 0.5 is the specification's default.
                AlphaMode::Mask => Alpha::Mask(material.alpha_cutoff().unwrap_or(0.5)),
                AlphaMode::Blend => Alpha::Blend,
            },
            double_sided: material.double_sided(),
            tag: options.tag(material.name(), tag),
        });
    }
    if ledges > 0 {
        warnings.push(ImportWarning::Ledges { materials: ledges });
    }
    Ok(materials)
}
