use std::fmt;
use std::sync::Arc;

use clamber_surface::mesh::{BuildOptions, SurfaceTag};

/// Choices of an import. The default takes everything as the file has it.
///
/// ```
/// use clamber_gltf::LoadOptions;
/// use clamber_surface::mesh::{SurfaceKind, SurfaceTag};
///
/// let fur = SurfaceTag::new(SurfaceKind::Fur);
/// let options = LoadOptions::default().with_height(12.0).with_tag(fur);
/// assert_eq!(options.height, Some(12.0));
/// ```
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct LoadOptions {
    /// Index of a skin of the creature to load; `None` for the creature with the most triangles.
    /// [`load_all`](crate::load_all) ignores it.
    pub skin: Option<usize>,
    /// Passed on to [`ColliderMesh::build`](clamber_surface::mesh::ColliderMesh::build).
    pub build: BuildOptions,
    /// Metres that the creature is to be tall; `None` for the file's own size.
    pub height: Option<f32>,
    /// What changes the tags of surfaces; `None` for the file's own tags.
    pub tagger: Option<Tagger>,
}

impl LoadOptions {
    /// Loads the creature that this skin belongs to.
    #[must_use]
    pub fn with_skin(self, skin: usize) -> Self {
        Self {
            skin: Some(skin),
            ..self
        }
    }

    /// Builds the collider with these options.
    #[must_use]
    pub fn with_build(self, build: BuildOptions) -> Self {
        Self { build, ..self }
    }

    /// Scales the creature uniformly, about the origin of model space, so that its collider is this tall along Y in
    /// the rest pose. Clips, visual meshes and weak points are scaled with it;
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

    /// Passes every surface through a function, as [`Tagger::new`] describes.
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

    /// Tags every surface alike, whatever the file says.
    #[must_use]
    pub fn with_tag(self, tag: SurfaceTag) -> Self {
        self.with_tags(move |_, _| tag)
    }

    /// The tag of a material that the file tags like this.
    pub(crate) fn tag(&self, material: Option<&str>, of_file: SurfaceTag) -> SurfaceTag {
        match &self.tagger {
            Some(tagger) => tagger.tag(material, of_file),
            None => of_file,
        }
    }
}

/// A function from a material's name, and the tag that the file gives it, to the tag that it gets.
#[derive(Clone)]
pub struct Tagger(Arc<TagFn>);

type TagFn = dyn Fn(Option<&str>, SurfaceTag) -> SurfaceTag + Send + Sync;

impl Tagger {
    /// The function gets the material's name and the tag from its extras ([`SurfaceTag::default`] where they give
    /// none). The name is `None` for a material without a name, and for surfaces without a material. All of the tag
    /// that it gives is used, its [`SurfaceTag::user`] included.
    ///
    /// It is called once for each material of the file, in the file's order, then once for no material, whether or
    /// not a surface uses them.
    pub fn new(
        tag: impl Fn(Option<&str>, SurfaceTag) -> SurfaceTag + Send + Sync + 'static,
    ) -> Self {
        Self(Arc::new(tag))
    }

    /// The tag for a material of this name that the file tags like this.
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
