use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::sync::Arc;

use clamber_surface::mesh::{BuildReport, ColliderMesh, Rig, TriangleId};
use clamber_surface::rig::Skeleton;

use crate::accessor::Reader;
use crate::buffers::{Buffers, Files};
use crate::collision::Collision;
use crate::contents::Contents;
use crate::members::{self, Members};
use crate::mesh::{self, Meshes};
use crate::{
    GltfError, GltfErrorKind, ImportReport, ImportWarning, LoadOptions, Model, clip, document,
    scale, skeleton, weak_point,
};

/// Loads the creature with the most triangles of the default scene of a `.glb` or `.gltf` file.
///
/// Skins that share joints are one creature, and so are skins where a joint of one is a descendant of a joint of the
/// other. Meshes without a skin under these joints belong to the creature too. A file without skins is one creature of
/// rigid pieces.
///
/// # Errors
/// [`GltfError`] with the file, the object in it and the reason.
pub fn load(path: impl AsRef<Path>) -> Result<Model, GltfError> {
    load_with(path, &LoadOptions::default())
}

/// Loads a creature from a file like [`load`], with options.
///
/// # Errors
/// As [`load`]. Also [`GltfErrorKind::NoSuchScene`] and [`GltfErrorKind::NoSuchSkin`] if the file lacks the scene or
/// the skin in the options, [`GltfErrorKind::BadHeight`] for a height that is not finite or not greater than 0, and
/// [`GltfErrorKind::NoHeight`] if a height is set but the collider has no height in the rest pose.
pub fn load_with(path: impl AsRef<Path>, options: &LoadOptions) -> Result<Model, GltfError> {
    from_path(path.as_ref(), |bytes, files| one(bytes, files, options))
}

/// Loads all creatures of a scene of a file, in the order of their first skins.
///
/// [`LoadOptions::height`] scales each of them to that height. [`LoadOptions::skin`] is ignored.
///
/// # Errors
/// As [`load_with`], for the first creature that cannot be loaded.
pub fn load_all(path: impl AsRef<Path>, options: &LoadOptions) -> Result<Vec<Model>, GltfError> {
    let all = |creatures: Vec<Members>, _: &Contents<'_>, _: &mut Vec<ImportWarning>| Ok(creatures);
    from_path(path.as_ref(), |bytes, files| {
        from_bytes(bytes, files, options, all)
    })
}

/// Loads a creature from the bytes of a `.glb` or `.gltf` file that contains its buffers.
///
/// # Errors
/// As [`load_with`]. Also [`GltfErrorKind::Invalid`] if a buffer is in another file.
pub fn load_slice(bytes: &[u8], options: &LoadOptions) -> Result<Model, GltfError> {
    let model = one(bytes, Files::None, options);
    model.map_err(|kind| GltfError { path: None, kind })
}

/// Loads a creature from the bytes of a `.glb` or `.gltf` file, with a function that provides its buffer files.
///
/// Use it for files in an archive, from the web, or embedded in the program. `resolve` is called with a path relative
/// to the document, percent-decoded, with `/` between its parts. It returns the contents of the whole file. It is
/// called in the order of the buffers, once for each file even if several buffers name it, and only for buffers that
/// are read. Their paths must not be absolute or lead out of the document's folder, which is checked before the first
/// call.
///
/// ```
/// use std::io;
///
/// use clamber_gltf::{LoadOptions, load_slice_with};
///
/// let document = br#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
///     "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
///     "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
///     "bufferViews": [{"buffer": 0, "byteLength": 36}],
///     "buffers": [{"byteLength": 36, "uri": "my%20data.bin"}]}"#;
/// let load = |data: &[u8]| {
///     load_slice_with(document, &LoadOptions::default(), |path| match path {
///         "my data.bin" => Ok(data.to_vec()),
///         _ => Err(io::ErrorKind::NotFound.into()),
///     })
/// };
/// let corners: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0];
/// let data: Vec<u8> = corners.iter().flat_map(|number| number.to_le_bytes()).collect();
/// assert_eq!(load(&data)?.rig.collider.triangles().len(), 1);
/// let error = load(&data[1..]).map(|_| ()).unwrap_err();
/// assert_eq!(error.to_string(), "buffer 0: claims 36 bytes, but holds 35");
/// # Ok::<(), clamber_gltf::GltfError>(())
/// ```
///
/// # Errors
/// As [`load_with`]. An error of `resolve` becomes [`GltfErrorKind::Read`].
pub fn load_slice_with(
    bytes: &[u8],
    options: &LoadOptions,
    mut resolve: impl FnMut(&str) -> io::Result<Vec<u8>>,
) -> Result<Model, GltfError> {
    let model = one(bytes, Files::Resolver(&mut resolve), options);
    model.map_err(|kind| GltfError { path: None, kind })
}

/// Reads a file, passes its bytes and its folder to `load`, and adds its path to errors.
fn from_path<T>(
    path: &Path,
    load: impl FnOnce(&[u8], Files<'_>) -> Result<T, GltfErrorKind>,
) -> Result<T, GltfError> {
    let read = std::fs::read(path).map_err(|error| GltfErrorKind::Read {
        path: path.to_owned(),
        error,
    });
    let folder = path.parent().unwrap_or(Path::new(""));
    read.and_then(|bytes| load(&bytes, Files::Folder(folder)))
        .map_err(|kind| GltfError {
            path: Some(path.to_owned()),
            kind,
        })
}

/// Loads the creature that the options select.
fn one(bytes: &[u8], files: Files<'_>, options: &LoadOptions) -> Result<Model, GltfErrorKind> {
    let choose =
        |creatures: Vec<Members>, contents: &Contents<'_>, warnings: &mut Vec<ImportWarning>| {
            let chosen = members::choose(&contents.tree, &creatures, options.skin, warnings)?;
            Ok(vec![chosen])
        };
    let mut models = from_bytes(bytes, files, options, choose)?;
    let object = "the file".to_owned();
    models.pop().ok_or(GltfErrorKind::NoTriangles { object })
}

/// Loads the creatures of a file that `choose` selects, at least one.
fn from_bytes(
    bytes: &[u8],
    files: Files<'_>,
    options: &LoadOptions,
    choose: impl Fn(
        Vec<Members>,
        &Contents<'_>,
        &mut Vec<ImportWarning>,
    ) -> Result<Vec<Members>, GltfErrorKind>,
) -> Result<Vec<Model>, GltfErrorKind> {
    scale::check(options.height)?;
    let mut warnings = Vec::new();
    let parsed = document::parse(bytes, options, &mut warnings)?;
    let document = &parsed.document;
    let buffers = Buffers::load(document, parsed.blob, &parsed.buffers_read, files)?;
    let reader = Reader::new(&buffers, bytes.len(), options);
    let contents = Contents::new(document, reader, options, &mut warnings)?;
    let creatures = members::all(&contents.tree, &contents.extras, &mut warnings);
    if creatures.is_empty() {
        let object = "the file".into();
        return Err(GltfErrorKind::NoTriangles { object });
    }
    let chosen = choose(creatures, &contents, &mut warnings)?;
    let models = chosen
        .iter()
        .map(|members| model(&contents, members, warnings.clone()));
    models.collect()
}

fn model(
    contents: &Contents<'_>,
    members: &Members,
    mut warnings: Vec<ImportWarning>,
) -> Result<Model, GltfErrorKind> {
    let object = members.object();
    // Every model has its own copy of the materials and warnings.
    let lines: usize = warnings.iter().map(ImportWarning::bytes).sum();
    let bytes = size_of_val(contents.materials.as_slice()) + lines;
    contents.reader.charge(&object, bytes)?;
    let joints = skeleton::load(contents, members, &mut warnings)?;
    let Meshes { collision, visual } = mesh::load(contents, members, &joints, &mut warnings)?;
    let collider = collider(collision, &joints.skeleton, contents, &object)?;
    let clips = clip::load(contents, &joints.of_node, &mut warnings)?;
    let weak_points = weak_point::load(contents, members, &joints, &mut warnings)?;
    let mut rig = Rig::new(joints.skeleton, Arc::new(collider.mesh));
    rig.clips = clips;
    rig.collider_materials = collider.materials;
    rig.weak_points = weak_points;
    let mut model = Model {
        rig,
        visual,
        materials: contents.materials.clone(),
        report: ImportReport {
            build: collider.report,
            scale: collider.scale,
            warnings,
        },
    };
    if let Some(factor) = collider.scale {
        scale::all_but_collider(&mut model, factor, &object)?;
    }
    Ok(model)
}

/// A collider mesh, scaled if a height was set.
struct Collider {
    mesh: ColliderMesh,
    report: BuildReport,
    materials: BTreeMap<String, Vec<TriangleId>>,
    /// The factor that it was scaled by; `None` if no height was set.
    scale: Option<f64>,
}

/// Builds the collider, and scales it if a height is set. A scaled collider is built twice: the first mesh shows which
/// vertices count for the height, and the second is welded and bounded at the final size.
fn collider(
    mut collision: Collision,
    skeleton: &Skeleton,
    contents: &Contents<'_>,
    object: &str,
) -> Result<Collider, GltfErrorKind> {
    let options = contents.options;
    let build = |collision: &Collision| {
        let built = collision.build(skeleton.joints().len(), &options.build);
        built.map_err(|error| GltfErrorKind::Collider {
            object: object.to_owned(),
            error,
        })
    };
    let (mesh, report) = build(&collision)?;
    let Some(height) = options.height else {
        return Ok(Collider {
            materials: collision.named_materials(&report, &contents.materials),
            mesh,
            report,
            scale: None,
        });
    };
    let factor = scale::factor(height, skeleton, &mesh, object)?;
    // Freed before the second mesh, which takes as much memory.
    drop((mesh, report));
    scale::points(&mut collision.positions, factor);
    let (mesh, report) = build(&collision)?;
    Ok(Collider {
        materials: collision.named_materials(&report, &contents.materials),
        mesh,
        report,
        scale: Some(factor),
    })
}
