use std::fmt;

/// A part of a file that was skipped or repaired. `Display` gives a message of one line.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ImportWarning {
    /// Animation channels that name no node, skipped.
    ChannelsWithoutNode {
        /// Number of channels, over all animations.
        channels: usize,
    },
    /// Animation channels that move a property unknown to this importer, skipped.
    UnknownChannels {
        /// Index of the animation.
        animation: usize,
        /// Number of its channels.
        channels: usize,
    },
    /// Nodes with a role in their extras, but without a mesh: the role has no effect.
    RolesWithoutMesh {
        /// Number of nodes.
        nodes: usize,
    },
    /// Node matrices with shear, replaced by a translation, rotation and scale, which cannot express it.
    ShearedNodes {
        /// Number of nodes.
        nodes: usize,
        /// Largest error of a column of a matrix, as a share of the column's length.
        worst_error: f64,
    },
    /// Nodes with a mesh that the loaded scene does not show, left out.
    HiddenMeshes {
        /// Index of the loaded scene.
        scene: usize,
        /// Number of nodes with a mesh.
        meshes: usize,
    },
    /// Nodes that show their mesh at several places (`EXT_mesh_gpu_instancing`). The mesh was loaded once, at the
    /// node's own place.
    Instances {
        /// Number of nodes.
        nodes: usize,
    },
    /// Materials with textures: only their factors were read.
    Textures {
        /// Number of materials.
        materials: usize,
    },
    /// Materials whose extras mark ledges. The mark is ignored: climbers find ledges by their shape.
    Ledges {
        /// Number of materials.
        materials: usize,
    },
    /// A weak point that is under no joint, skipped.
    WeakPointWithoutJoint {
        /// Name of the node; `"node 3"` for node 3 without a name.
        node: String,
    },
    /// Meshes without a skin that are under no joint, skipped.
    MeshesWithoutJoint {
        /// Number of meshes.
        meshes: usize,
    },
    /// Skins of creatures without a mesh, skipped.
    UnusedSkins {
        /// Number of skins.
        skins: usize,
    },
    /// The file has other creatures than the one that was loaded.
    OtherCreatures {
        /// Indices of the skins of the creature that was loaded.
        skins: Vec<usize>,
        /// Number of other creatures.
        others: usize,
    },
    /// Inverse bind matrices whose last row is not (0, 0, 0, 1); they were read as if it were.
    ProjectiveInverseBinds {
        /// Index of the skin.
        skin: usize,
        /// Number of its matrices.
        matrices: usize,
    },
    /// Primitives of a skinned mesh that lack joints and weights, skipped.
    PrimitivesWithoutWeights {
        /// Number of primitives.
        primitives: usize,
    },
    /// Primitives of points or lines, skipped.
    PointsOrLines {
        /// Number of primitives.
        primitives: usize,
    },
    /// Primitives without positions, skipped.
    PrimitivesWithoutPositions {
        /// Number of primitives.
        primitives: usize,
    },
    /// Vertices whose weights are all zero; they follow the first joint that they name.
    UnweightedVertices {
        /// Number of vertices.
        vertices: usize,
    },
    /// Primitives with morph targets, which are fixed at their rest weights.
    MorphTargets {
        /// Number of primitives.
        primitives: usize,
    },
    /// Vertex attributes that were not read.
    UnreadAttributes {
        /// Their names in the file, sorted.
        names: Vec<String>,
    },
    /// An animation that moves no joint of the skeleton, skipped.
    UnusedAnimation {
        /// Name of the animation; `"clip 3"` for animation 3 without a name.
        animation: String,
    },
    /// Animation channels that move morph targets, or a node that is not in the skeleton, skipped.
    UnusedChannels {
        /// Name of the animation; `"clip 3"` for animation 3 without a name.
        animation: String,
        /// Number of its channels.
        channels: usize,
    },
}

impl ImportWarning {
    /// Approximate size of the warning in memory, bytes.
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

impl fmt::Display for ImportWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ChannelsWithoutNode { channels } => {
                write!(f, "skipped animation channels without a node: {channels}")
            }
            Self::UnknownChannels {
                animation,
                channels,
            } => write!(
                f,
                "animation {animation}: skipped channels that move an unknown property: {channels}"
            ),
            Self::RolesWithoutMesh { nodes } => {
                write!(f, "nodes with a role but without a mesh: {nodes}")
            }
            Self::ShearedNodes { nodes, worst_error } => write!(
                f,
                "nodes whose matrix has shear, which was dropped: {nodes}; columns are off by up to \
                 {worst_error:.1e} of their length"
            ),
            Self::HiddenMeshes { scene, meshes } => write!(
                f,
                "loaded scene {scene}; left out meshes that it does not show: {meshes}"
            ),
            Self::Instances { nodes } => write!(
                f,
                "nodes with EXT_mesh_gpu_instancing, whose mesh was loaded once, at the node: {nodes}"
            ),
            Self::Textures { materials } => write!(
                f,
                "materials with textures, of which only the factors were read: {materials}"
            ),
            Self::Ledges { materials } => write!(
                f,
                "ignored the key `ledge` of materials, since climbers find ledges by their shape: {materials}"
            ),
            Self::WeakPointWithoutJoint { node } => {
                write!(f, "skipped weak point {node:?}, which is under no joint")
            }
            Self::MeshesWithoutJoint { meshes } => write!(
                f,
                "skipped meshes without a skin that are under no joint: {meshes}"
            ),
            Self::UnusedSkins { skins } => write!(f, "skipped skins without a mesh: {skins}"),
            Self::OtherCreatures { skins, others } => write!(
                f,
                "loaded the creature of {}; skipped other creatures: {others}",
                creature(skins)
            ),
            Self::ProjectiveInverseBinds { skin, matrices } => write!(
                f,
                "skin {skin}: inverse bind matrices whose last row is not (0, 0, 0, 1), but was \
                 read as if it were: {matrices}"
            ),
            Self::PrimitivesWithoutWeights { primitives } => write!(
                f,
                "skipped primitives of a skinned mesh that lack joints and weights: {primitives}"
            ),
            Self::PointsOrLines { primitives } => {
                write!(f, "skipped primitives of points or lines: {primitives}")
            }
            Self::PrimitivesWithoutPositions { primitives } => {
                write!(f, "skipped primitives without positions: {primitives}")
            }
            Self::UnweightedVertices { vertices } => write!(
                f,
                "vertices without weights, bound to the first joint that they name: {vertices}"
            ),
            Self::MorphTargets { primitives } => write!(
                f,
                "primitives with morph targets, fixed at their rest weights: {primitives}"
            ),
            Self::UnreadAttributes { names } => {
                write!(f, "attributes that were not read: {}", names.join(", "))
            }
            Self::UnusedAnimation { animation } => write!(
                f,
                "skipped animation {animation:?}, which moves no joint of the skeleton"
            ),
            Self::UnusedChannels {
                animation,
                channels,
            } => write!(
                f,
                "animation {animation:?}: skipped channels that move morph targets or no joint of \
                 the skeleton: {channels}"
            ),
        }
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
