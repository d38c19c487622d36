use thiserror::Error;

/// A part of a file that was skipped or repaired. `Display` gives a message of one line. It implements
/// [`Error`](std::error::Error), so that a program can refuse such a file.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ImportWarning {
    /// Animation channels that name no node, skipped.
    #[error("skipped animation channels without a node: {channels}")]
    ChannelsWithoutNode {
        /// Number of channels, over all animations.
        channels: usize,
    },
    /// Animation channels that move a property unknown to this importer, skipped.
    #[error("animation {animation}: skipped channels that move an unknown property: {channels}")]
    UnknownChannels {
        /// Index of the animation.
        animation: usize,
        /// Number of its channels.
        channels: usize,
    },
    /// Nodes with a role in their extras, but without a mesh: the role has no effect.
    #[error("nodes with a role but without a mesh: {nodes}")]
    RolesWithoutMesh {
        /// Number of nodes.
        nodes: usize,
    },
    /// Node matrices with shear, replaced by a translation, rotation and scale, which cannot express it.
    #[error(
        "nodes whose matrix has shear, which was dropped: {nodes}; columns are off by up to \
         {worst_error:.1e} of their length"
    )]
    ShearedNodes {
        /// Number of nodes.
        nodes: usize,
        /// Largest error of a column of a matrix, as a share of the column's length.
        worst_error: f64,
    },
    /// Nodes with a mesh that the loaded scene does not show, left out.
    #[error("loaded scene {scene}; left out meshes that it does not show: {meshes}")]
    HiddenMeshes {
        /// Index of the loaded scene.
        scene: usize,
        /// Number of nodes with a mesh.
        meshes: usize,
    },
    /// Nodes that show their mesh at several places (`EXT_mesh_gpu_instancing`). The mesh was loaded once, at the
    /// node's own place.
    #[error("nodes with EXT_mesh_gpu_instancing, whose mesh was loaded once, at the node: {nodes}")]
    Instances {
        /// Number of nodes.
        nodes: usize,
    },
    /// Materials with textures: only their factors were read.
    #[error("materials with textures, of which only the factors were read: {materials}")]
    Textures {
        /// Number of materials.
        materials: usize,
    },
    /// Materials whose extras have the key `ledge`, with any value but `null`. It is ignored: climbers find ledges by
    /// their shape.
    #[error(
        "ignored the key `ledge` of materials, since climbers find ledges by their shape: {materials}"
    )]
    Ledges {
        /// Number of materials.
        materials: usize,
    },
    /// A weak point that is under no joint, skipped.
    #[error("skipped weak point {node:?}, which is under no joint")]
    WeakPointWithoutJoint {
        /// Name of the node; `"node 3"` for node 3 without a name.
        node: String,
    },
    /// Meshes without a skin that are under no joint, skipped.
    #[error("skipped meshes without a skin that are under no joint: {meshes}")]
    MeshesWithoutJoint {
        /// Number of meshes.
        meshes: usize,
    },
    /// Skins of creatures without a mesh, skipped.
    #[error("skipped skins without a mesh: {skins}")]
    UnusedSkins {
        /// Number of skins.
        skins: usize,
    },
    /// The file has other creatures than the one that was loaded.
    #[error(
        "loaded the creature of {}; skipped other creatures: {others}",
        creature(skins)
    )]
    OtherCreatures {
        /// Indices of the skins of the creature that was loaded.
        skins: Vec<usize>,
        /// Number of other creatures.
        others: usize,
    },
    /// Inverse bind matrices whose last row is not (0, 0, 0, 1); they were read as if it were.
    #[error(
        "skin {skin}: inverse bind matrices whose last row is not (0, 0, 0, 1), but was read as if it were: {matrices}"
    )]
    ProjectiveInverseBinds {
        /// Index of the skin.
        skin: usize,
        /// Number of its matrices.
        matrices: usize,
    },
    /// Primitives of a skinned mesh that lack joints and weights, skipped.
    #[error("skipped primitives of a skinned mesh that lack joints and weights: {primitives}")]
    PrimitivesWithoutWeights {
        /// Number of primitives.
        primitives: usize,
    },
    /// Primitives of points or lines, skipped.
    #[error("skipped primitives of points or lines: {primitives}")]
    PointsOrLines {
        /// Number of primitives.
        primitives: usize,
    },
    /// Primitives without positions, skipped.
    #[error("skipped primitives without positions: {primitives}")]
    PrimitivesWithoutPositions {
        /// Number of primitives.
        primitives: usize,
    },
    /// Vertices whose weights are all zero; they follow the first joint that they name.
    #[error("vertices without weights, bound to the first joint that they name: {vertices}")]
    UnweightedVertices {
        /// Number of vertices.
        vertices: usize,
    },
    /// Primitives with morph targets, which are fixed at their rest weights.
    #[error("primitives with morph targets, fixed at their rest weights: {primitives}")]
    MorphTargets {
        /// Number of primitives.
        primitives: usize,
    },
    /// Vertex attributes that were not read.
    #[error("attributes that were not read: {}", names.join(", "))]
    UnreadAttributes {
        /// Their names in the file, sorted.
        names: Vec<String>,
    },
    /// An animation that moves no joint of the skeleton, skipped.
    #[error("skipped animation {animation:?}, which moves no joint of the skeleton")]
    UnusedAnimation {
        /// Name of the animation; `"clip 3"` for animation 3 without a name.
        animation: String,
    },
    /// Animation channels that move morph targets, or a node that is not in the skeleton, skipped.
    #[error(
        "animation {animation:?}: skipped channels that move morph targets or no joint of the skeleton: {channels}"
    )]
    UnusedChannels {
        /// Name of the animation; `"clip 3"` for animation 3 without a name.
        animation: String,
        /// Number of its channels.
        channels: usize,
    },
}

impl ImportWarning {
    /// Approximate size of the warning in memory, bytes. A variant with a text or a list needs an arm here.
    pub(crate) fn bytes(&self) -> usize {
        let held = match self {
            Self::WeakPointWithoutJoint { node: text }
            | Self::UnusedAnimation { animation: text }
            | Self::UnusedChannels {
                animation: text, ..
            } => text.len(),
            Self::OtherCreatures { skins, .. } => size_of_val(skins.as_slice()),
            Self::UnreadAttributes { names } => {
                let texts: usize = names.iter().map(String::len).sum();
                size_of_val(names.as_slice()) + texts
            }
            _ => 0,
        };
        size_of::<Self>() + held
    }
}

/// Names a creature by its skins, for messages.
pub(crate) fn creature(skins: &[usize]) -> String {
    match skins {
        [] => "a file without skins".into(),
        [one] => format!("skin {one}"),
        many => {
            let list: Vec<String> = many.iter().map(usize::to_string).collect();
            format!("skins {}", list.join(", "))
        }
    }
}
