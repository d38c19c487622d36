use std::fmt;

/// Something in a file that was passed over or mended. `Display` gives it as a sentence.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ImportWarning {
    /// Animation channels that name no node.
    ChannelsWithoutNode {
        /// How many, over all animations.
        channels: usize,
    },
    /// Animation channels that move a property unknown to this importer.
    UnknownChannels {
        /// Index of the animation.
        animation: usize,
        /// How many of its channels.
        channels: usize,
    },
    /// Nodes with a role in their extras, but without a mesh.
    RolesWithoutMesh {
        /// How many.
        nodes: usize,
    },
    /// Node matrices with shear, which a translation, rotation and scale cannot express.
    ShearedNodes {
        /// How many.
        nodes: usize,
        /// The largest error of a column, as a share of its length.
        worst_error: f64,
    },
    /// Materials with textures: only their factors were read.
    Textures {
        /// How many.
        materials: usize,
    },
    /// A weak point that hangs under no joint, passed over.
    WeakPointWithoutJoint {
        /// Name of the node; `"node 3"` for node 3 without a name.
        node: String,
    },
    /// Meshes without a skin that hang under no joint, passed over.
    MeshesWithoutJoint {
        /// How many.
        meshes: usize,
    },
    /// Skins that deform no mesh.
    UnusedSkins {
        /// How many.
        skins: usize,
    },
    /// The file has other creatures than the one that was loaded.
    OtherCreatures {
        /// Indices of the skins of the creature that was loaded.
        skins: Vec<usize>,
        /// How many other creatures there are.
        others: usize,
    },
    /// Inverse bind matrices whose last row is not (0, 0, 0, 1), and was taken as if it were.
    ProjectiveInverseBinds {
        /// Index of the skin.
        skin: usize,
        /// How many of its matrices.
        matrices: usize,
    },
    /// Primitives of a skinned mesh without joints and weights, passed over.
    PrimitivesWithoutWeights {
        /// How many.
        primitives: usize,
    },
    /// Primitives of points or lines, passed over.
    PointsOrLines {
        /// How many.
        primitives: usize,
    },
    /// Primitives without positions, passed over.
    PrimitivesWithoutPositions {
        /// How many.
        primitives: usize,
    },
    /// Vertices without weights, which follow the first joint that they name.
    UnweightedVertices {
        /// How many.
        vertices: usize,
    },
    /// Primitives with morph targets, which stay at their rest weights.
    MorphTargets {
        /// How many.
        primitives: usize,
    },
    /// Vertex attributes that were not read.
    UnreadAttributes {
        /// Their names in the file, sorted.
        names: Vec<String>,
    },
    /// An animation that moves nothing of the skeleton, passed over.
    UnusedAnimation {
        /// Its name; `"clip 3"` for animation 3 without a name.
        animation: String,
    },
    /// Animation channels that move nothing of the skeleton, or morph targets, passed over.
    UnusedChannels {
        /// Name of the animation; `"clip 3"` for animation 3 without a name.
        animation: String,
        /// How many of its channels.
        channels: usize,
    },
}

impl ImportWarning {
    /// Its size in memory, about, in bytes.
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
                write!(
                    f,
                    "passed over animation channels without a node: {channels}"
                )
            }
            Self::UnknownChannels {
                animation,
                channels,
            } => write!(
                f,
                "animation {animation}: passed over channels that move something unknown: {channels}"
            ),
            Self::RolesWithoutMesh { nodes } => {
                write!(f, "nodes with a role, but without a mesh: {nodes}")
            }
            Self::ShearedNodes { nodes, worst_error } => write!(
                f,
                "nodes whose matrix shears, which a translation, rotation and scale cannot: {nodes}; \
                 columns are off by up to {worst_error:.1e} of their length"
            ),
            Self::Textures { materials } => write!(
                f,
                "materials with textures, of which only the factors were taken: {materials}"
            ),
            Self::WeakPointWithoutJoint { node } => write!(
                f,
                "node {node:?} is a weak point, but hangs under no joint; passed over"
            ),
            Self::MeshesWithoutJoint { meshes } => write!(
                f,
                "passed over meshes without a skin that hang under no joint: {meshes}"
            ),
            Self::UnusedSkins { skins } => write!(f, "skins that deform no mesh: {skins}"),
            Self::OtherCreatures { skins, others } => write!(
                f,
                "took the creature of {}; other creatures passed over: {others}",
                creature(skins)
            ),
            Self::ProjectiveInverseBinds { skin, matrices } => write!(
                f,
                "skin {skin}: inverse bind matrices whose last row is not (0, 0, 0, 1), and was \
                 taken as if it were: {matrices}"
            ),
            Self::PrimitivesWithoutWeights { primitives } => write!(
                f,
                "passed over primitives of a skinned mesh, without joints and weights: {primitives}"
            ),
            Self::PointsOrLines { primitives } => {
                write!(f, "passed over primitives of points or lines: {primitives}")
            }
            Self::PrimitivesWithoutPositions { primitives } => {
                write!(f, "passed over primitives without positions: {primitives}")
            }
            Self::UnweightedVertices { vertices } => write!(
                f,
                "vertices without weights, which follow the first joint that they name: {vertices}"
            ),
            Self::MorphTargets { primitives } => write!(
                f,
                "primitives with morph targets, which stay at their rest weights: {primitives}"
            ),
            Self::UnreadAttributes { names } => {
                write!(f, "attributes that were not read: {}", names.join(", "))
            }
            Self::UnusedAnimation { animation } => write!(
                f,
                "animation {animation:?} moves nothing of the skeleton; passed over"
            ),
            Self::UnusedChannels {
                animation,
                channels,
            } => write!(
                f,
                "animation {animation:?}: passed over channels that move nothing of the skeleton, \
                 or morph targets: {channels}"
            ),
        }
    }
}

/// A creature by its skins, for messages.
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
