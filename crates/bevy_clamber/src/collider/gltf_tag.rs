//! Surface tags from the material extras of glTF files that Bevy loads.

use bevy_ecs::prelude::*;
use bevy_gltf::GltfMaterialExtras;
use clamber_surface::mesh::SurfaceTag;

/// The tag in the extras of a mesh's material, with the keys and words that `clamber_gltf` reads. A misspelt tag is
/// logged as an error and ignored.
pub(super) fn tag_in(mesh: Entity, extras: &GltfMaterialExtras) -> Option<SurfaceTag> {
    clamber_gltf::tag_in_extras(&extras.value).unwrap_or_else(|error| {
        tracing::error!("no tag for {mesh}: {error}");
        None
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collider::{ColliderTag, SkinnedCollider, tag_colliders};
    use bevy_ecs::system::RunSystemOnce;
    use bevy_gltf::GltfExtras;
    use bevy_mesh::Mesh3d;
    use bevy_mesh::skinning::SkinnedMesh;
    use clamber_surface::mesh::SurfaceKind;

    const STONE: SurfaceTag = SurfaceTag::new(SurfaceKind::Stone).with_user(3);

    /// The tag that a mesh with these components is given.
    fn tag(world: &mut World, components: impl Bundle) -> SurfaceTag {
        let skinned = (Mesh3d::default(), SkinnedMesh::default());
        let mesh = world.spawn((skinned, SkinnedCollider::default(), components));
        let mesh = mesh.id();
        world.run_system_once(tag_colliders).unwrap();
        world.get::<ColliderTag>(mesh).unwrap().0
    }

    fn extras(value: &str) -> GltfMaterialExtras {
        let value = value.to_owned();
        GltfMaterialExtras { value }
    }

    #[test]
    fn extras_of_a_material_tag_its_meshes() {
        let mut world = World::new();
        let stone = r#"{"clamber": {"surface": "stone", "user": 3}}"#;
        assert_eq!(tag(&mut world, extras(stone)), STONE);
        // Extras of a node or a primitive do not tag the surface, as in `clamber_gltf`.
        let value = stone.to_owned();
        let other = tag(&mut world, GltfExtras { value });
        assert_eq!(other, SurfaceTag::default());
        for text in ["{}", "7", "{", r#"{"clamber": {"surface": "stony"}}"#] {
            let other = tag(&mut world, extras(text));
            assert_eq!(other, SurfaceTag::default(), "{text}");
        }
    }
}
