//! The contents of a file that all its creatures share, read and checked.

use clamber_surface::mesh::SurfaceTag;
use clamber_surface::rig::Transform;
use gltf::Document;

use crate::accessor::Reader;
use crate::extras::{self, NodeExtras};
use crate::readings::Readings;
use crate::tree::Tree;
use crate::visual::{self, Material};
use crate::{GltfErrorKind, ImportWarning, LoadOptions, transforms};

/// A parsed file.
pub(crate) struct Contents<'a> {
    pub(crate) document: &'a Document,
    pub(crate) tree: Tree<'a>,
    /// The extras of every node.
    pub(crate) extras: Vec<NodeExtras>,
    /// `parent_from_node` of every node, at rest.
    pub(crate) transforms: Vec<Transform>,
    pub(crate) materials: Vec<Material>,
    /// The tag of surfaces without a material.
    pub(crate) bare_tag: SurfaceTag,
    pub(crate) reader: Reader<'a>,
    pub(crate) readings: Readings,
    pub(crate) options: &'a LoadOptions,
}

impl<'a> Contents<'a> {
    pub(crate) fn new(
        document: &'a Document,
        reader: Reader<'a>,
        options: &'a LoadOptions,
        warnings: &mut Vec<ImportWarning>,
    ) -> Result<Self, GltfErrorKind> {
        let tree = Tree::new(document)?;
        Ok(Self {
            document,
            extras: extras::of_nodes(&tree.nodes, warnings)?,
            transforms: transforms::of_nodes(&tree.nodes, warnings),
            materials: visual::materials(document, options, warnings)?,
            bare_tag: options.tag(None, SurfaceTag::default()),
            tree,
            reader,
            readings: Readings::default(),
            options,
        })
    }

    /// The tag of a primitive with this material; `None` is no material.
    pub(crate) fn tag(&self, material: Option<usize>) -> SurfaceTag {
        let material = material.and_then(|index| self.materials.get(index));
        material.map_or(self.bare_tag, |material| material.tag)
    }
}
