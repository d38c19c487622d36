use std::path::Path;
use std::sync::Arc;

use clamber_surface::mesh::{BuildOptions, BuildReport, ColliderMesh, MeshError, SurfaceTag};
use clamber_surface::rig::{Clip, Skeleton};

use crate::accessor::Reader;
use crate::buffers::Buffers;
use crate::contents::Contents;
use crate::members::{self, Members};
use crate::visual;
use crate::{
    GltfError, GltfErrorKind, Material, VisualMesh, WeakPoint, clip, document, mesh, skeleton,
    weak_point,
};

/// A creature as a file describes it.
#[derive(Clone, Debug)]
pub struct Rig {
    /// The joints of the skins first, in the skins' order, then the nodes of rigid meshes, then the
    /// other nodes that all these hang under.
    pub skeleton: Skeleton,
    /// Those that move the skeleton, in the order of the file.
    pub clips: Vec<Clip>,
    /// What a climber touches: all meshes that are for collision, as one.
    pub collider: Arc<ColliderMesh>,
    /// What is to be seen, each mesh by itself.
    pub visual: Vec<VisualMesh>,
    /// All materials of the file, in its order.
    pub materials: Vec<Material>,
    /// Where the creature can be wounded, in the order of the file's nodes.
    pub weak_points: Vec<WeakPoint>,
    /// What the import found.
    pub report: ImportReport,
}

impl Rig {
    /// The first clip of this name.
    pub fn clip(&self, name: &str) -> Option<&Clip> {
        self.clips.iter().find(|clip| clip.name == name)
    }

    /// What is to be seen, as one mesh that can be queried like the collider.
    ///
    /// # Errors
    /// [`MeshError`] if nothing is to be seen.
    pub fn visual_collider(&self) -> Result<ColliderMesh, MeshError> {
        let joints = self.skeleton.joints().len();
        visual::merged(&self.visual, &self.materials, joints)
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
    /// Index of a skin of the creature to load; `None` for the creature with the most triangles.
    /// [`load_all`] does not ask.
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

/// Loads the creature with the most triangles of a `.glb` or `.gltf` file: all skins that move the
/// same joints or hang under each other's, and the meshes without a skin under these joints. A file
/// without skins is one creature of rigid pieces.
///
/// # Errors
/// [`GltfError`], naming the file, the object in it and what is wrong with that.
pub fn load(path: impl AsRef<Path>) -> Result<Rig, GltfError> {
    load_with(path, &LoadOptions::default())
}

/// [`load`] with choices.
///
/// # Errors
/// As [`load`].
pub fn load_with(path: impl AsRef<Path>, options: &LoadOptions<'_>) -> Result<Rig, GltfError> {
    from_path(path.as_ref(), |bytes, base| one(bytes, base, options))
}

/// Loads every creature of a file, in the order of their first skins.
///
/// # Errors
/// As [`load`], for the first that cannot be loaded.
pub fn load_all(path: impl AsRef<Path>, options: &LoadOptions<'_>) -> Result<Vec<Rig>, GltfError> {
    let all = |creatures: Vec<Members>, _: &Contents<'_>, _: &mut Vec<String>| Ok(creatures);
    from_path(path.as_ref(), |bytes, base| {
        from_bytes(bytes, base, options, all)
    })
}

/// Loads from the bytes of a `.glb` or `.gltf` file that has its buffers inside.
///
/// # Errors
/// As [`load`].
pub fn load_slice(bytes: &[u8], options: &LoadOptions<'_>) -> Result<Rig, GltfError> {
    one(bytes, None, options).map_err(|kind| GltfError { path: None, kind })
}

/// Hands the bytes of a file and its folder on, and names it in errors.
fn from_path<T>(
    path: &Path,
    load: impl Fn(&[u8], Option<&Path>) -> Result<T, GltfErrorKind>,
) -> Result<T, GltfError> {
    let read = std::fs::read(path).map_err(|source| GltfErrorKind::Read {
        path: path.to_owned(),
        source,
    });
    read.and_then(|bytes| load(&bytes, path.parent()))
        .map_err(|kind| GltfError {
            path: Some(path.to_owned()),
            kind,
        })
}

/// The creature that the options ask for.
fn one(bytes: &[u8], base: Option<&Path>, options: &LoadOptions<'_>) -> Result<Rig, GltfErrorKind> {
    let choose = |creatures: Vec<Members>, contents: &Contents<'_>, warnings: &mut Vec<String>| {
        let chosen = members::choose(&contents.tree, &creatures, options.skin, warnings)?;
        Ok(vec![chosen])
    };
    let mut rigs = from_bytes(bytes, base, options, choose)?;
    let object = "the file".to_owned();
    rigs.pop().ok_or(GltfErrorKind::NoTriangles { object })
}

/// Those of a file's creatures that `choose` picks; at least one.
fn from_bytes(
    bytes: &[u8],
    base: Option<&Path>,
    options: &LoadOptions<'_>,
    choose: impl Fn(
        Vec<Members>,
        &Contents<'_>,
        &mut Vec<String>,
    ) -> Result<Vec<Members>, GltfErrorKind>,
) -> Result<Vec<Rig>, GltfErrorKind> {
    let mut warnings = Vec::new();
    let (document, blob) = document::parse(bytes, &mut warnings)?;
    let buffers = Buffers::load(&document, blob, base)?;
    let reader = Reader::new(&buffers, bytes.len());
    let contents = Contents::new(&document, reader, options, &mut warnings)?;
    let creatures = members::all(&contents.tree, &contents.extras, &mut warnings);
    if creatures.is_empty() {
        let object = "the file".into();
        return Err(GltfErrorKind::NoTriangles { object });
    }
    let chosen = choose(creatures, &contents, &mut warnings)?;
    let rigs = chosen
        .iter()
        .map(|members| rig(&contents, members, warnings.clone()));
    rigs.collect()
}

fn rig(
    contents: &Contents<'_>,
    members: &Members,
    mut warnings: Vec<String>,
) -> Result<Rig, GltfErrorKind> {
    // Every creature has these to itself.
    let lines: usize = warnings.iter().map(String::len).sum();
    let bytes = size_of_val(contents.materials.as_slice()) + lines;
    contents.reader.charge(&members.object(), bytes)?;
    let joints = skeleton::load(contents, members, &mut warnings)?;
    let meshes = mesh::load(contents, members, &joints, &mut warnings)?;
    let clips = clip::load(contents, &joints.of_node, &mut warnings)?;
    let weak_points = weak_point::load(contents, members, &joints, &mut warnings)?;
    Ok(Rig {
        skeleton: joints.skeleton,
        clips,
        collider: meshes.collider,
        visual: meshes.visual,
        materials: contents.materials.clone(),
        weak_points,
        report: ImportReport {
            build: meshes.build,
            warnings,
        },
    })
}
