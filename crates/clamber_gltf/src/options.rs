use std::fmt;
use std::sync::Arc;

use clamber_surface::mesh::{ColliderBuildOptions, SurfaceTag};

/// Options for loading a creature.
///
/// The default loads the creature with the most triangles of the default scene, with the size and the tags that the
/// file gives it.
///
/// ```
/// use clamber_gltf::LoadOptions;
/// use clamber_surface::mesh::{SurfaceKind, SurfaceTag};
///
/// let fur = SurfaceTag::new(SurfaceKind::Fur);
/// let options = LoadOptions::default().with_height(12.0).with_tag(fur);
/// assert_eq!(options.height, Some(12.0));
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LoadOptions {
    /// Index of the scene to load. `None` for the file's default scene; without a default scene, the first one that
    /// shows a mesh; in a file without scenes, everything. Meshes that the scene does not show are left out.
    pub scene: Option<usize>,
    /// Index of a skin of the creature to load; `None` for the creature with the most triangles.
    /// [`load_all`](crate::load_all) ignores it.
    pub skin: Option<usize>,
    /// Options for [`ColliderMesh::build`](clamber_surface::mesh::ColliderMesh::build).
    pub build: ColliderBuildOptions,
    /// Height to scale the creature to, metres, as in [`LoadOptions::with_height`]; `None` keeps the file's size.
    pub height: Option<f32>,
    /// Function that chooses the tags of surfaces; `None` keeps the file's tags.
    pub tagger: Option<Tagger>,
    /// Largest number of vertices that a file may make by showing meshes more than once: each showing after the first
    /// counts all vertices of its mesh. The limit for triangles is twice this number. 2^20 by default.
    ///
    /// The limit bounds the memory that a small file can take: half a gigabyte by default. The size of the file limits
    /// the vertices that are shown once.
    pub max_repeated_vertices: usize,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            scene: None,
            skin: None,
            build: ColliderBuildOptions::default(),
            height: None,
            tagger: None,
            max_repeated_vertices: 1 << 20,
        }
    }
}

impl LoadOptions {
    /// Loads the scene with this index.
    #[must_use]
    pub fn with_scene(self, scene: usize) -> Self {
        Self {
            scene: Some(scene),
            ..self
        }
    }

    /// Sets [`LoadOptions::max_repeated_vertices`].
    #[must_use]
    pub fn with_max_repeated_vertices(self, max_repeated_vertices: usize) -> Self {
        Self {
            max_repeated_vertices,
            ..self
        }
    }

    /// Loads the creature that the skin with this index belongs to.
    #[must_use]
    pub fn with_skin(self, skin: usize) -> Self {
        Self {
            skin: Some(skin),
            ..self
        }
    }

    /// Builds the collider with these options.
    #[must_use]
    pub fn with_build(self, build: ColliderBuildOptions) -> Self {
        Self { build, ..self }
    }

    /// Scales the creature to this height, in metres.
    ///
    /// The scaling is uniform, about the origin of model space. It gives the collider this height along Y in the rest
    /// pose. Clips, visual meshes and weak points are scaled too;
    /// [`ImportReport::scale`](crate::ImportReport::scale) is the factor.
    ///
    /// Loading fails for a height that is not finite or not greater than 0, and for a creature without height.
    #[must_use]
    pub fn with_height(self, metres: f32) -> Self {
        Self {
            height: Some(metres),
            ..self
        }
    }

    /// Chooses the tags of surfaces with a function, which [`Tagger::new`] describes.
    #[must_use]
    pub fn with_tags(
        self,
        tag: impl Fn(Option<&str>, SurfaceTag) -> SurfaceTag + Send + Sync + 'static,
    ) -> Self {
        Self {
            tagger: Some(Tagger::new(tag)),
            ..self
        }
    }

    /// Gives all surfaces the same tag and ignores the file's tags.
    #[must_use]
    pub fn with_tag(self, tag: SurfaceTag) -> Self {
        self.with_tags(move |_, _| tag)
    }

    /// The tag of a material whose tag in the file is `of_file`.
    pub(crate) fn tag(&self, material: Option<&str>, of_file: SurfaceTag) -> SurfaceTag {
        match &self.tagger {
            Some(tagger) => tagger.tag(material, of_file),
            None => of_file,
        }
    }
}

/// A function that chooses the tag of a material, by the material's name and its tag in the file.
#[derive(Clone)]
pub struct Tagger(Arc<TagFn>);

type TagFn = dyn Fn(Option<&str>, SurfaceTag) -> SurfaceTag + Send + Sync;

impl Tagger {
    /// Wraps a function from a material's name and its tag in the file to the tag to use.
    ///
    /// The name is `None` for a material without a name, and for surfaces without a material. The tag in the file comes
    /// from the material's extras; without them it is [`SurfaceTag::default`]. The returned tag replaces all of it,
    /// [`SurfaceTag::user`] included.
    ///
    /// The function is called once for each material of the file, in the file's order, then once for surfaces without
    /// a material. It is called whether or not a surface uses the material.
    pub fn new(
        tag: impl Fn(Option<&str>, SurfaceTag) -> SurfaceTag + Send + Sync + 'static,
    ) -> Self {
        Self(Arc::new(tag))
    }

    /// Calls the function with a material's name and `of_file`, the tag in the file.
    pub fn tag(&self, material: Option<&str>, of_file: SurfaceTag) -> SurfaceTag {
        (self.0)(material, of_file)
    }
}

impl fmt::Debug for Tagger {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tagger").finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_can_be_kept_and_sent_to_another_thread() {
        fn is_owned<T: Clone + fmt::Debug + Default + Send + Sync + 'static>() {}
        is_owned::<LoadOptions>();
        let options = LoadOptions::default().with_tag(SurfaceTag::default());
        assert!(format!("{options:?}").contains("Tagger"), "{options:?}");
    }
}
