//! Parses bytes into a validated document.
//!
//! The parser's own validation trusts some indices, so they are checked here before it runs. The validation also
//! refuses whole files for faults that do not matter to a collider. Most of these faults are in objects that are never
//! read, which [`prune()`] takes out before the validation; the others are dropped from its list of errors.

use gltf::Document;
use gltf::json::Root;
use gltf::json::validation::{Checked, Error, Validate};

use crate::prune::prune;
use crate::{GltfErrorKind, ImportWarning, LoadOptions};

/// The first bytes of a GLB.
const MAGIC: &[u8] = b"glTF";

/// Bytes that some exporters write before JSON, against the specification.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// Size of a GLB's header, bytes.
const GLB_HEADER: usize = 12;

/// Size of a GLB's header and its first chunk's header, bytes.
const GLB_HEADERS: usize = 20;

/// Extensions that a file may require although this importer does not implement them.
///
/// The extensions change how the file looks, allow integers where this importer accepts them anyway, or animate
/// properties that belong to no node. Channels of such properties are skipped and reported.
const HARMLESS: [&str; 12] = [
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_texture_astc",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
];

/// A parsed document.
pub(crate) struct Parsed {
    pub(crate) document: Document,
    /// The bytes of a GLB's binary chunk.
    pub(crate) blob: Option<Vec<u8>>,
    /// For each buffer, whether its bytes are read.
    pub(crate) buffers_read: Vec<bool>,
}

/// Parses a file into a document that shows one scene.
pub(crate) fn parse(
    bytes: &[u8],
    options: &LoadOptions,
    warnings: &mut Vec<ImportWarning>,
) -> Result<Parsed, GltfErrorKind> {
    let ((mut root, buffers_read), blob) = match kind(bytes)? {
        Kind::Glb => {
            check_glb_length(bytes)?;
            let glb = gltf::Glb::from_slice(bytes).map_err(GltfErrorKind::format)?;
            let parsed = parse_json(&glb.json, options, warnings)?;
            (parsed, glb.bin.map(|bin| bin.into_owned()))
        }
        Kind::Json => (parse_json(bytes, options, warnings)?, None),
    };
    root.extensions_required
        .retain(|name| !HARMLESS.contains(&name.as_str()) && !name.starts_with("KHR_materials_"));
    check_attributes(&root)?;
    check_channels(&mut root, warnings)?;
    validate(&root)?;
    Ok(Parsed {
        document: Document::from_json_without_validation(root),
        blob,
        buffers_read,
    })
}

/// The two file formats.
enum Kind {
    Glb,
    Json,
}

/// The format of a file, by its first bytes.
fn kind(bytes: &[u8]) -> Result<Kind, GltfErrorKind> {
    if bytes.is_empty() {
        return Err(GltfErrorKind::Empty);
    }
    let magic = &bytes[..bytes.len().min(MAGIC.len())];
    if MAGIC.starts_with(magic) {
        return Ok(Kind::Glb);
    }
    let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
    match text.trim_ascii_start().first() {
        Some(b'{') => Ok(Kind::Json),
        _ => Err(GltfErrorKind::NotGltf),
    }
}

/// Checks that a GLB is at least as long as its header claims, and that the claimed length includes the headers,
/// because the parser subtracts the headers' length from it.
fn check_glb_length(bytes: &[u8]) -> Result<(), GltfErrorKind> {
    let found = bytes.len();
    let claimed = bytes.get(8..GLB_HEADER).map_or(GLB_HEADER, |b| {
        u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize
    });
    if found < claimed.max(GLB_HEADER) {
        let claimed = claimed.max(GLB_HEADER);
        return Err(GltfErrorKind::CutShort { found, claimed });
    }
    if claimed < GLB_HEADERS {
        let reason = format!("claims a length of {claimed} bytes, less than its own headers have");
        return Err(GltfErrorKind::invalid("GLB header", reason));
    }
    Ok(())
}

/// Parses the JSON of a document. Also returns, for each buffer, whether its bytes are read.
fn parse_json(
    json: &[u8],
    options: &LoadOptions,
    warnings: &mut Vec<ImportWarning>,
) -> Result<(Root, Vec<bool>), GltfErrorKind> {
    let json = json.strip_prefix(BYTE_ORDER_MARK).unwrap_or(json);
    let value = serde_json::from_slice(json).map_err(GltfErrorKind::format)?;
    let pruned = prune(value, options, warnings)?;
    let root = serde_json::from_value::<Root>(pruned.json).map_err(|error| {
        // The value has no line numbers. If the parser refuses the text for the same reason, that error has the line.
        let without_line = error.to_string();
        let of_text = serde_json::from_slice::<Root>(json)
            .err()
            .map(|error| error.to_string());
        let same = of_text.filter(|text| text.starts_with(&without_line));
        GltfErrorKind::format(same.unwrap_or(without_line))
    })?;
    Ok((root, pruned.buffers_read))
}

/// Checks that every attribute names an existing accessor.
fn check_attributes(root: &Root) -> Result<(), GltfErrorKind> {
    let count = root.accessors.len();
    for (mesh, object) in root.meshes.iter().enumerate() {
        for primitive in &object.primitives {
            if let Some(bad) = primitive.attributes.values().find(|a| a.value() >= count) {
                let reason = format!("an attribute names accessor {} of {count}", bad.value());
                return Err(GltfErrorKind::invalid(format!("mesh {mesh}"), reason));
            }
        }
    }
    Ok(())
}

/// Runs the parser's checks, and ignores harmless errors: positions without their range, primitives without positions,
/// and accessors without data, whose elements are all zeros.
fn validate(root: &Root) -> Result<(), GltfErrorKind> {
    let mut errors = Vec::new();
    root.validate(root, gltf::json::Path::new, &mut |path, error| {
        let path = path();
        let place = path.as_str();
        let harmless = error == Error::Missing
            && (place.contains("attributes[\"POSITION\"]")
                || place.starts_with("accessors[") && place.ends_with("].bufferView"));
        if !harmless {
            errors.push((path, error));
        }
    });
    if errors.is_empty() {
        Ok(())
    } else {
        let list = errors
            .iter()
            .map(|(path, error)| format!("{path}: {error}"));
        let list: Vec<String> = list.collect();
        Err(GltfErrorKind::format(list.join("; ")))
    }
}

/// Checks that every channel names an existing node, and drops channels that move an unknown property.
fn check_channels(root: &mut Root, warnings: &mut Vec<ImportWarning>) -> Result<(), GltfErrorKind> {
    let nodes = root.nodes.len();
    for (animation, object) in root.animations.iter_mut().enumerate() {
        if let Some(bad) = object
            .channels
            .iter()
            .find(|c| c.target.node.value() >= nodes)
        {
            let reason = format!(
                "a channel names node {} of {nodes}",
                bad.target.node.value()
            );
            return Err(GltfErrorKind::invalid(
                format!("animation {animation}"),
                reason,
            ));
        }
        let before = object.channels.len();
        let known = |path: &Checked<_>| matches!(path, Checked::Valid(_));
        object
            .channels
            .retain(|channel| known(&channel.target.path));
        let dropped = before - object.channels.len();
        if dropped > 0 {
            warnings.push(ImportWarning::UnknownChannels {
                animation,
                channels: dropped,
            });
        }
    }
    Ok(())
}
