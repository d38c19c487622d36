//! What a file holds, read and checked as far as all its creatures share it.

use clamber_surface::rig::Transform;
use gltf::Document;

use crate::accessor::Reader;
use crate::extras::{self, NodeExtras};
use crate::tree::Tree;
use crate::visual::{self, Material};
use crate::{GltfErrorKind, LoadOptions, transforms};

/// A parsed file.
pub(crate) struct Contents<'a> {
    pub(crate) document: &'a Document,
    pub(crate) tree: Tree<'a>,
    /// Of every node.
    pub(crate) extras: Vec<NodeExtras>,
    /// Of every node, from its own space to its parent's, at rest.
    pub(crate) transforms: Vec<Transform>,
    pub(crate) materials: Vec<Material>,
    pub(crate) reader: Reader<'a>,
    pub(crate) options: &'a LoadOptions<'a>,
}

impl<'a> Contents<'a> {
    pub(crate) fn new(
        document: &'a Document,
        reader: Reader<'a>,
        options: &'a LoadOptions<'a>,
        warnings: &mut Vec<String>,
    ) -> Result<Self, GltfErrorKind> {
        let tree = Tree::new(document)?;
        Ok(Self {
            document,
            extras: extras::of_nodes(&tree.nodes, warnings)?,
            transforms: transforms::of_nodes(&tree.nodes, warnings),
            materials: visual::materials(document, options, warnings)?,
            tree,
            reader,
            options,
        })
    }
}
