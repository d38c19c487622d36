//! Reads normals, texture coordinates and colours of a primitive's vertices from its accessors.

use glam::{Vec2, Vec3};
use gltf::mesh::Semantic;
use gltf::{Accessor, Primitive};

use crate::GltfErrorKind;
use crate::accessor::Reader;
use crate::vertices::morphed;

/// Normals, texture coordinates and colours; each is empty if the file has none.
#[derive(Clone, Debug, Default)]
pub(crate) struct Looks {
    pub(crate) normals: Vec<Vec3>,
    pub(crate) tex_coords: Vec<Vec<Vec2>>,
    pub(crate) colors: Vec<[f32; 4]>,
}

/// Reads normals, texture coordinates and colours. Their counts must equal `vertices`, the number of positions. Normals
/// are morphed like the positions.
pub(crate) fn looks(
    primitive: &Primitive<'_>,
    vertices: usize,
    morph_weights: &[f32],
    object: &str,
    reader: &Reader<'_>,
) -> Result<Looks, GltfErrorKind> {
    let check = |what: &str, found: usize| {
        let reason = || format!("has {vertices} positions, but {found} {what}");
        (found == vertices)
            .then_some(())
            .ok_or_else(|| GltfErrorKind::invalid(object, reason()))
    };
    let mut looks = Looks::default();
    if let Some(accessor) = primitive.get(&Semantic::Normals) {
        let rest = reader.floats::<3>(&accessor)?;
        check("normals", rest.len())?;
        let deltas = primitive.morph_targets().map(|target| target.normals());
        looks.normals = morphed(rest, deltas, morph_weights, object, reader)?;
        for normal in &mut looks.normals {
            *normal = normal.try_normalize().unwrap_or(Vec3::ZERO);
        }
    }
    for set in 0.. {
        let Some(accessor) = primitive.get(&Semantic::TexCoords(set)) else {
            break;
        };
        let coordinates = reader.floats::<2>(&accessor)?;
        check("texture coordinates", coordinates.len())?;
        looks
            .tex_coords
            .push(coordinates.into_iter().map(Vec2::from_array).collect());
    }
    if let Some(accessor) = primitive.get(&Semantic::Colors(0)) {
        looks.colors = colors(&accessor, reader)?;
        check("colours", looks.colors.len())?;
    }
    Ok(looks)
}

/// Reads colours with opacity. The opacity is 1 if the file has none.
fn colors(accessor: &Accessor<'_>, reader: &Reader<'_>) -> Result<Vec<[f32; 4]>, GltfErrorKind> {
    if accessor.dimensions().multiplicity() == 3 {
        let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
        return Ok(reader
            .floats::<3>(accessor)?
            .into_iter()
            .map(opaque)
            .collect());
    }
    reader.floats::<4>(accessor)
}

/// The names of a primitive's attributes that the importer does not read.
pub(crate) fn ignored(primitive: &Primitive<'_>) -> impl Iterator<Item = String> {
    primitive
        .attributes()
        .filter_map(|(semantic, _)| match semantic {
            Semantic::Positions
            | Semantic::Normals
            | Semantic::TexCoords(_)
            | Semantic::Colors(0)
            | Semantic::Joints(_)
            | Semantic::Weights(_) => None,
            other => Some(other.to_string()),
        })
}
