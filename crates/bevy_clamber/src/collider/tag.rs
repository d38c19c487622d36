//! Surface tags of meshes, set by a component, by a function, or by the file.

use bevy_ecs::prelude::*;
use bevy_mesh::Mesh3d;
use bevy_mesh::skinning::SkinnedMesh;
use bevy_reflect::prelude::*;
use clamber_surface::mesh::SurfaceTag;

use super::SkinnedCollider;

/// The surface tag of all triangles of a mesh. Changing it rebuilds the collider.
///
/// A [`SkinnedCollider`] without a tag gets one: from the [`SurfaceTagger`], else, with the feature `gltf`, from the
/// extras of its glTF material, else the default.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct ColliderTag(pub SurfaceTag);

/// A resource with a function that tags meshes from the components of their entity.
///
/// It is called once for each entity with a [`SkinnedCollider`] and no [`ColliderTag`], as soon as the entity has
/// `Mesh3d` and `SkinnedMesh`. If it returns `None`, the file's tag or the default is used.
///
/// ```
/// # use bevy_app::App;
/// # use bevy_ecs::prelude::*;
/// # use bevy_clamber::prelude::*;
/// # let mut app = App::new();
/// // On meshes that `bevy_gltf` spawns, `GltfMaterialName` holds the material's name alone.
/// app.insert_resource(SurfaceTagger::new(|mesh| {
///     let name = mesh.get::<Name>()?;
///     let fur = SurfaceTag::new(SurfaceKind::Fur);
///     name.contains("fur").then_some(fur)
/// }));
/// ```
#[derive(Resource)]
pub struct SurfaceTagger(Box<dyn Fn(EntityRef<'_>) -> Option<SurfaceTag> + Send + Sync>);

impl SurfaceTagger {
    /// Tags meshes by a function of their entity.
    pub fn new(
        tag_of: impl Fn(EntityRef<'_>) -> Option<SurfaceTag> + Send + Sync + 'static,
    ) -> Self {
        Self(Box::new(tag_of))
    }
}

type Untagged = (With<SkinnedCollider>, Without<ColliderTag>);

/// Gives every collider a tag.
pub(crate) fn tag_colliders(
    untagged: Query<EntityRef, (Untagged, With<Mesh3d>, With<SkinnedMesh>)>,
    tagger: Option<Res<SurfaceTagger>>,
    mut commands: Commands,
) {
    for mesh in &untagged {
        let said = tagger.as_ref().and_then(|tagger| (tagger.0)(mesh));
        #[cfg(feature = "gltf")]
        let said = said.or_else(|| super::gltf_tag::tag_of(mesh));
        let tag = ColliderTag(said.unwrap_or_default());
        commands.entity(mesh.id()).try_insert_if_new(tag);
    }
}
