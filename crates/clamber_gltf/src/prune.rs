//! Removes the parts of a document that are never read, before the parser sees it.
//!
//! The parser refuses a whole file for a fault in a single object. Textures, images, cameras, other scenes, and all
//! accessors, views and buffers that only these use are never read, so no fault in them may refuse a file. Lists keep
//! their lengths, because objects name each other by index: an object that is not read becomes the smallest one that
//! the parser accepts.

use gltf::json::Value;
use serde_json::{Map, json};

use crate::{GltfErrorKind, ImportWarning, LoadOptions};

/// A document without the parts that are never read.
pub(crate) struct Pruned {
    pub(crate) json: Value,
    /// For each buffer, whether its bytes are read.
    pub(crate) buffers_read: Vec<bool>,
}

/// Lists and members of a document that are read.
const READ: [&str; 12] = [
    "accessors",
    "animations",
    "asset",
    "buffers",
    "bufferViews",
    "extensionsRequired",
    "materials",
    "meshes",
    "nodes",
    "scene",
    "scenes",
    "skins",
];

/// Members of a material that are read.
const READ_OF_MATERIAL: [&str; 7] = [
    "alphaCutoff",
    "alphaMode",
    "doubleSided",
    "emissiveFactor",
    "extras",
    "name",
    "pbrMetallicRoughness",
];

/// Members of a material's metallic-roughness model that are read.
const READ_OF_PBR: [&str; 3] = ["baseColorFactor", "metallicFactor", "roughnessFactor"];

/// Members that a node keeps if its mesh is not shown: the node may still be a joint.
const READ_OF_JOINT: [&str; 6] = [
    "children",
    "matrix",
    "name",
    "rotation",
    "scale",
    "translation",
];

/// Pointer to the extension by which a node shows its mesh many times.
const INSTANCING: &str = "/extensions/EXT_mesh_gpu_instancing";

/// Removes the parts of a document that are never read.
pub(crate) fn prune(
    mut json: Value,
    options: &LoadOptions,
    warnings: &mut Vec<ImportWarning>,
) -> Result<Pruned, GltfErrorKind> {
    let Some(root) = json.as_object_mut() else {
        return Err(GltfErrorKind::format("the JSON is not an object"));
    };
    root.retain(|name, _| READ.contains(&name.as_str()));
    root.values_mut().for_each(whole_numbers);
    for node in list_mut(root, "nodes").filter_map(Value::as_object_mut) {
        node.remove("camera");
    }
    let nodes = list(root, "nodes").iter();
    let instanced = nodes
        .filter(|node| node.pointer(INSTANCING).is_some())
        .count();
    root.values_mut().for_each(drop_extensions);
    if instanced > 0 {
        warnings.push(ImportWarning::Instances { nodes: instanced });
    }
    drop_channels_without_node(root, warnings);
    strip_materials(root, warnings);
    choose_scene(root, options, warnings)?;
    for unread in ["scene", "scenes"] {
        root.remove(unread);
    }
    let buffers_read = keep_what_is_read(root);
    Ok(Pruned { json, buffers_read })
}

/// Writes whole numbers as integers: some exporters write a count as `12.0`, which the parser refuses.
fn whole_numbers(value: &mut Value) {
    match value {
        Value::Number(number) if number.is_f64() => {
            let float = number.as_f64().unwrap_or(f64::NAN);
            // A negative zero keeps its sign, and numbers of 2^53 and more may have been rounded.
            let whole = float > 0.0 && float < 9_007_199_254_740_992.0 && float.fract() == 0.0;
            if whole || float.to_bits() == 0 {
                *value = json!(float as u64);
            }
        }
        Value::Array(items) => items.iter_mut().for_each(whole_numbers),
        Value::Object(members) => members.values_mut().for_each(whole_numbers),
        _ => {}
    }
}

/// Removes the extensions of all objects, because none is read.
fn drop_extensions(value: &mut Value) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(drop_extensions),
        Value::Object(members) => {
            members.remove("extensions");
            members.values_mut().for_each(drop_extensions);
        }
        _ => {}
    }
}

/// Removes channels without a node. They are legal and must be skipped, but the parser requires a node.
fn drop_channels_without_node(root: &mut Map<String, Value>, warnings: &mut Vec<ImportWarning>) {
    let mut dropped = 0;
    for animation in list_mut(root, "animations") {
        if let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) {
            let before = channels.len();
            channels.retain(|channel| channel.pointer("/target/node").is_some());
            dropped += before - channels.len();
        }
    }
    if dropped > 0 {
        warnings.push(ImportWarning::ChannelsWithoutNode { channels: dropped });
    }
}

/// Reduces materials to the factors that are read.
fn strip_materials(root: &mut Map<String, Value>, warnings: &mut Vec<ImportWarning>) {
    let mut textured = 0;
    for material in list_mut(root, "materials").filter_map(Value::as_object_mut) {
        let is_texture = |name: &String| name.ends_with("Texture");
        let pbr = material
            .get("pbrMetallicRoughness")
            .and_then(Value::as_object);
        let of_pbr = pbr.is_some_and(|pbr| pbr.keys().any(is_texture));
        textured += usize::from(of_pbr || material.keys().any(is_texture));
        material.retain(|name, _| READ_OF_MATERIAL.contains(&name.as_str()));
        let pbr = material.get_mut("pbrMetallicRoughness");
        if let Some(pbr) = pbr.and_then(Value::as_object_mut) {
            pbr.retain(|name, _| READ_OF_PBR.contains(&name.as_str()));
        }
    }
    if textured > 0 {
        warnings.push(ImportWarning::Textures {
            materials: textured,
        });
    }
}

/// Removes the meshes from all nodes that the loaded scene does not show, and the joints from skins that only such
/// nodes use.
fn choose_scene(
    root: &mut Map<String, Value>,
    options: &LoadOptions,
    warnings: &mut Vec<ImportWarning>,
) -> Result<(), GltfErrorKind> {
    let (nodes, scenes) = (list(root, "nodes"), list(root, "scenes"));
    let leads = lead_to_mesh(nodes);
    let shows_a_mesh = |scene: &Value| {
        let mut roots = roots(scene).flatten();
        roots.any(|node| leads.get(node) == Some(&true))
    };
    let Some(scene) = scene(scenes, root.get("scene"), options.scene, shows_a_mesh)? else {
        return Ok(());
    };
    let strange = |node: &Option<usize>| node.is_none_or(|node| node >= nodes.len());
    if let Some(bad) = roots(&scenes[scene]).find(strange) {
        let named = bad.map_or("what is no index".into(), |bad| format!("node {bad}"));
        let reason = format!("names {named}, but the file has {} nodes", nodes.len());
        return Err(GltfErrorKind::invalid(format!("scene {scene}"), reason));
    }
    let visible = shown(nodes, &scenes[scene]);
    let meshes = mesh_count(nodes, &visible);
    let hidden = nodes.iter().filter(|node| has_mesh(node)).count() - meshes;
    if meshes == 0 && hidden > 0 {
        let other = scenes.iter().position(shows_a_mesh);
        return Err(GltfErrorKind::EmptyScene { scene, other });
    }
    if hidden > 0 {
        warnings.push(ImportWarning::HiddenMeshes {
            scene,
            meshes: hidden,
        });
    }
    let mut skins = Marks::new(list(root, "skins"));
    let mut hidden = Marks::new(list(root, "skins"));
    for (node, shown) in list_mut(root, "nodes").zip(visible) {
        if shown {
            skins.mark(node.get("skin"));
        } else if has_mesh(node)
            && let Some(node) = node.as_object_mut()
        {
            hidden.mark(node.get("skin"));
            node.retain(|name, _| READ_OF_JOINT.contains(&name.as_str()));
        }
    }
    // A skin that only hidden meshes use makes no creature. A skin that no mesh uses is reported later.
    for (skin, hidden) in skins.0.iter_mut().zip(hidden.0) {
        *skin |= !hidden;
    }
    skins.replace_others(root, "skins", || json!({"joints": []}));
    Ok(())
}

/// The scene to load: the wanted one, else the default one, else the first that shows a mesh, else the first; `None` in
/// a file without scenes.
fn scene(
    scenes: &[Value],
    default: Option<&Value>,
    wanted: Option<usize>,
    shows_a_mesh: impl Fn(&Value) -> bool,
) -> Result<Option<usize>, GltfErrorKind> {
    let found = scenes.len();
    match (wanted, default) {
        (Some(wanted), _) if wanted >= found => Err(GltfErrorKind::NoSuchScene { wanted, found }),
        (Some(wanted), _) => Ok(Some(wanted)),
        (None, Some(default)) => match index(default).filter(|scene| *scene < found) {
            Some(scene) => Ok(Some(scene)),
            None => {
                let reason = format!("is {default}, but the file has {found} scenes");
                Err(GltfErrorKind::invalid("the default scene", reason))
            }
        },
        (None, None) if found == 0 => Ok(None),
        (None, None) => Ok(Some(scenes.iter().position(shows_a_mesh).unwrap_or(0))),
    }
}

fn has_mesh(node: &Value) -> bool {
    node.get("mesh").is_some()
}

/// The number of shown nodes with a mesh.
fn mesh_count(nodes: &[Value], shown: &[bool]) -> usize {
    let nodes = nodes.iter().zip(shown);
    nodes
        .filter(|(node, shown)| **shown && has_mesh(node))
        .count()
}

/// The nodes that a scene names; `None` for an entry that is no index.
fn roots(scene: &Value) -> impl Iterator<Item = Option<usize>> {
    items(scene.get("nodes")).map(index)
}

/// For each node, whether it or a node below it has a mesh. Takes one pass for all scenes, because a file may have
/// many.
fn lead_to_mesh(nodes: &[Value]) -> Vec<bool> {
    let mut parents = vec![Vec::new(); nodes.len()];
    for (parent, node) in nodes.iter().enumerate() {
        for child in items(node.get("children")).filter_map(index) {
            if let Some(parents) = parents.get_mut(child) {
                parents.push(parent);
            }
        }
    }
    let mut leads = vec![false; nodes.len()];
    let mut open: Vec<usize> = (0..nodes.len()).filter(|n| has_mesh(&nodes[*n])).collect();
    while let Some(node) = open.pop() {
        if !std::mem::replace(&mut leads[node], true) {
            open.append(&mut parents[node]);
        }
    }
    leads
}

/// For each node, whether a scene shows it.
fn shown(nodes: &[Value], scene: &Value) -> Vec<bool> {
    let mut shown = vec![false; nodes.len()];
    let mut open: Vec<usize> = roots(scene).flatten().collect();
    while let Some(node) = open.pop() {
        let known = shown.get_mut(node);
        if known.is_some_and(|known| !std::mem::replace(known, true)) {
            open.extend(items(nodes[node].get("children")).filter_map(index));
        }
    }
    shown
}

/// Replaces meshes, accessors, views and buffers that are not read by the smallest ones that the parser accepts.
/// Returns, for each buffer, whether it is read.
fn keep_what_is_read(root: &mut Map<String, Value>) -> Vec<bool> {
    let mut meshes = Marks::new(list(root, "meshes"));
    list(root, "nodes")
        .iter()
        .for_each(|node| meshes.mark(node.get("mesh")));
    let mut accessors = Marks::new(list(root, "accessors"));
    for mesh in meshes.marked(list(root, "meshes")) {
        for primitive in items(mesh.get("primitives")) {
            accessors.mark(primitive.get("indices"));
            accessors.mark_attributes(primitive.get("attributes"));
            items(primitive.get("targets"))
                .for_each(|target| accessors.mark_attributes(Some(target)));
        }
    }
    for skin in list(root, "skins") {
        accessors.mark(skin.get("inverseBindMatrices"));
    }
    for animation in list(root, "animations") {
        let samplers = animation.get("samplers").and_then(Value::as_array);
        for channel in items(animation.get("channels")) {
            let path = channel.pointer("/target/path").and_then(Value::as_str);
            let sampler = channel.get("sampler").and_then(index);
            let sampler = sampler.and_then(|sampler| samplers?.get(sampler));
            if let (Some("translation" | "rotation" | "scale"), Some(sampler)) = (path, sampler) {
                accessors.mark(sampler.get("input"));
                accessors.mark(sampler.get("output"));
            }
        }
    }
    let mut views = Marks::new(list(root, "bufferViews"));
    for accessor in accessors.marked(list(root, "accessors")) {
        views.mark(accessor.get("bufferView"));
        views.mark(accessor.pointer("/sparse/indices/bufferView"));
        views.mark(accessor.pointer("/sparse/values/bufferView"));
    }
    let mut buffers = Marks::new(list(root, "buffers"));
    for view in views.marked(list(root, "bufferViews")) {
        buffers.mark(view.get("buffer"));
    }
    meshes.replace_others(root, "meshes", || json!({"primitives": []}));
    accessors.replace_others(
        root,
        "accessors",
        || json!({"componentType": 5121, "count": 1, "type": "SCALAR"}),
    );
    views.replace_others(
        root,
        "bufferViews",
        || json!({"buffer": 0, "byteLength": 1}),
    );
    buffers.replace_others(root, "buffers", || json!({"byteLength": 1}));
    buffers.0
}

/// Which objects of a list are read.
struct Marks(Vec<bool>);

impl Marks {
    fn new(objects: &[Value]) -> Self {
        Self(vec![false; objects.len()])
    }

    /// Marks the object with this index. The parser refuses an index that is not in the list.
    fn mark(&mut self, named: Option<&Value>) {
        if let Some(mark) = named
            .and_then(index)
            .and_then(|index| self.0.get_mut(index))
        {
            *mark = true;
        }
    }

    /// Marks the accessors of the attributes that are read.
    fn mark_attributes(&mut self, attributes: Option<&Value>) {
        for (name, accessor) in attributes.and_then(Value::as_object).into_iter().flatten() {
            let set = name.split('_').next().unwrap_or_default();
            if [
                "POSITION", "NORMAL", "TEXCOORD", "COLOR", "JOINTS", "WEIGHTS",
            ]
            .contains(&set)
            {
                self.mark(Some(accessor));
            }
        }
    }

    /// The marked objects of a list.
    fn marked<'a>(&self, objects: &'a [Value]) -> impl Iterator<Item = &'a Value> {
        let all = objects.iter().zip(&self.0);
        all.filter(|(_, read)| **read).map(|(object, _)| object)
    }

    fn replace_others(&self, root: &mut Map<String, Value>, name: &str, least: impl Fn() -> Value) {
        for (object, read) in list_mut(root, name).zip(&self.0) {
            if !read {
                *object = least();
            }
        }
    }
}

/// A value as an index; `None` if it is no index.
fn index(value: &Value) -> Option<usize> {
    usize::try_from(value.as_u64()?).ok()
}

/// The items of a list; none if it is missing or not a list.
fn items(value: Option<&Value>) -> impl Iterator<Item = &Value> {
    value.and_then(Value::as_array).into_iter().flatten()
}

/// A list of the document; empty if it is missing.
fn list<'a>(root: &'a Map<String, Value>, name: &str) -> &'a [Value] {
    root.get(name)
        .and_then(Value::as_array)
        .map_or(&[], Vec::as_slice)
}

/// A list of the document, to change.
fn list_mut<'a>(
    root: &'a mut Map<String, Value>,
    name: &str,
) -> impl Iterator<Item = &'a mut Value> {
    root.get_mut(name)
        .and_then(Value::as_array_mut)
        .into_iter()
        .flatten()
}
