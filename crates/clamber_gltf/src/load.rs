use std::path::Path;
use std::sync::Arc;

use clamber_surface::mesh::{BuildOptions, BuildReport, ColliderMesh, SurfaceTag};
use clamber_surface::rig::{Clip, Skeleton};

use crate::accessor::Reader;
use crate::{GltfError, buffers, clip, document, mesh, skeleton};

/// A creature as a file describes it.
#[derive(Clone, Debug)]
pub struct Rig {
    /// The skin's joints first, in the skin's order; then the nodes that they hang under.
    pub skeleton: Skeleton,
    /// In the order of the file.
    pub clips: Vec<Clip>,
    /// All primitives that the skin deforms.
    pub collider: Arc<ColliderMesh>,
    /// What the import found.
    pub report: ImportReport,
}

impl Rig {
    /// The first clip of this name.
    pub fn clip(&self, name: &str) -> Option<&Clip> {
        self.clips.iter().find(|clip| clip.name == name)
    }
}

/// What an import found, changed and passed over.
#[derive(Clone, Debug, Default)]
pub struct ImportReport {
    /// About the collider mesh.
    pub build: BuildReport,
    /// What was passed over or mended, a sentence each.
    pub warnings: Vec<String>,
}

/// The tag for a material's name; `None` for what the file itself says.
pub type TagOfMaterial<'a> = dyn Fn(&str) -> Option<SurfaceTag> + 'a;

/// Choices of an import.
#[derive(Clone, Copy, Default)]
pub struct LoadOptions<'a> {
    /// Index of the skin to load; `None` for the one that deforms the most triangles.
    pub skin: Option<usize>,
    /// Passed on to [`ColliderMesh::build`].
    pub build: BuildOptions,
    /// The tag of a material by its name, for files whose extras do not say. Where it gives one it
    /// wins over the extras.
    pub tag_of_material: Option<&'a TagOfMaterial<'a>>,
}

impl std::fmt::Debug for LoadOptions<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("LoadOptions")
            .field("skin", &self.skin)
            .field("build", &self.build)
            .field("tag_of_material", &self.tag_of_material.is_some())
            .finish()
    }
}

/// Loads the skin that deforms the most triangles of a `.glb` or `.gltf` file.
///
/// # Errors
/// [`GltfError`], naming the object of the file and what is wrong with it.
pub fn load(path: impl AsRef<Path>) -> Result<Rig, GltfError> {
    load_with(path, &LoadOptions::default())
}

/// [`load`] with choices.
///
/// # Errors
/// As [`load`].
pub fn load_with(path: impl AsRef<Path>, options: &LoadOptions<'_>) -> Result<Rig, GltfError> {
    let path = path.as_ref();
    let bytes = std::fs::read(path).map_err(|source| GltfError::Read {
        path: path.to_owned(),
        source,
    })?;
    from_bytes(&bytes, path.parent(), options)
}

/// Loads from the bytes of a `.glb` or `.gltf` file that has its buffers inside.
///
/// # Errors
/// As [`load`].
pub fn load_slice(bytes: &[u8], options: &LoadOptions<'_>) -> Result<Rig, GltfError> {
    from_bytes(bytes, None, options)
}

fn from_bytes(
    bytes: &[u8],
    base: Option<&Path>,
    options: &LoadOptions<'_>,
) -> Result<Rig, GltfError> {
    let mut warnings = Vec::new();
    let (document, blob) = document::parse(bytes, &mut warnings)?;
    let buffers = buffers::load(&document, blob, base)?;
    let reader = Reader::new(&buffers, bytes.len());
    let skin = mesh::choose_skin(&document, options.skin, &mut warnings)?;
    let joints = skeleton::load(&document, &skin, &reader, &mut warnings)?;
    let joint_count = joints.skeleton.joints().len();
    let (collider, build) = mesh::load(
        &document,
        &skin,
        joint_count,
        &reader,
        options,
        &mut warnings,
    )?;
    let clips = clip::load(&document, &joints.of_node, &reader, &mut warnings)?;
    Ok(Rig {
        skeleton: joints.skeleton,
        clips,
        collider,
        report: ImportReport { build, warnings },
    })
}
