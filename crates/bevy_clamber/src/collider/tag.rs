//! Surface tags of meshes, set by a component or by the file.

use bevy_ecs::prelude::*;
#[cfg(feature = "gltf")]
use bevy_gltf::GltfMaterialExtras;
use bevy_mesh::Mesh3d;
use bevy_mesh::skinning::SkinnedMesh;
use bevy_reflect::prelude::*;
use clamber_surface::mesh::SurfaceTag;

use super::SkinnedCollider;

/// The surface tag of all triangles of a mesh. Changing it rebuilds the collider.
///
/// A [`SkinnedCollider`] without a tag gets one: with the feature `gltf` from the extras of its glTF material, else the
/// default. To tag meshes by a rule of your own, insert the tag where you insert the collider, or in an observer:
///
/// ```
/// # use bevy_app::App;
/// # use bevy_ecs::prelude::*;
/// # use bevy_clamber::prelude::*;
/// # let mut app = App::new();
/// // On meshes that `bevy_gltf` spawns, `GltfMaterialName` holds the material's name alone.
/// app.add_observer(
///     |added: On<Add<SkinnedCollider>>, names: Query<&Name>, mut commands: Commands| {
///         if names.get(added.entity).is_ok_and(|name| name.contains("fur")) {
///             let fur = SurfaceTag::new(SurfaceKind::Fur);
///             commands.entity(added.entity).insert(ColliderTag(fur));
///         }
///     },
/// );
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct ColliderTag(pub SurfaceTag);

type Untagged = (
    With<SkinnedCollider>,
    Without<ColliderTag>,
    With<Mesh3d>,
    With<SkinnedMesh>,
);

/// Gives every collider a tag.
pub(crate) fn tag_colliders(
    #[cfg(feature = "gltf")] untagged: Query<(Entity, Option<&GltfMaterialExtras>), Untagged>,
    #[cfg(not(feature = "gltf"))] untagged: Query<(Entity, ()), Untagged>,
    mut commands: Commands,
) {
    for (mesh, extras) in &untagged {
        #[cfg(feature = "gltf")]
        let tag = extras.and_then(|extras| super::gltf_tag::tag_in(mesh, extras));
        #[cfg(not(feature = "gltf"))]
        let tag = {
            let () = extras;
            None
        };
        let tag = ColliderTag(tag.unwrap_or_default());
        commands.entity(mesh).try_insert_if_new(tag);
    }
}
