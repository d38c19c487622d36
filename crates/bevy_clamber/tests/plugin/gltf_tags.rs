//! The giant's file, as `bevy_gltf` loads it: the extras of its materials tag its skin.

use std::collections::BTreeMap;

use bevy_app::{App, TaskPoolPlugin};
use bevy_asset::{AssetPlugin, AssetServer, Handle, LoadState};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_gltf::{GltfMaterialName, GltfPlugin};
use bevy_mesh::MeshPlugin;
use bevy_mesh::skinning::SkinnedMesh;
use bevy_time::TimePlugin;
use bevy_transform::TransformPlugin;
use bevy_world_serialization::{WorldAsset, WorldAssetRoot, WorldSerializationPlugin};

#[test]
fn extras_of_materials_tag_the_giant() {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        AssetPlugin {
            file_path: concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets").into(),
            ..AssetPlugin::default()
        },
        MeshPlugin,
        bevy_image::ImagePlugin::default(),
        WorldSerializationPlugin,
        GltfPlugin::default(),
        ClamberPlugins::default(),
    ))
    .add_observer(|skin: On<Add<SkinnedMesh>>, mut commands: Commands| {
        commands
            .entity(skin.entity)
            .insert(SkinnedCollider::default());
    });
    app.finish();
    app.cleanup();
    let registry = app.world().resource::<AppTypeRegistry>();
    registry.write().register_derived_types();
    let scene: Handle<WorldAsset> = app
        .world()
        .resource::<AssetServer>()
        .load("colossus.glb#Scene0");
    app.world_mut().spawn(WorldAssetRoot(scene.clone()));
    let mut colliders = app
        .world_mut()
        .query::<(&ColliderStatus, &ColliderTag, &GltfMaterialName)>();
    let start = std::time::Instant::now();
    let tags = loop {
        app.update();
        if let LoadState::Failed(error) = app.world().resource::<AssetServer>().load_state(&scene) {
            panic!("{error}");
        }
        let all: Vec<_> = colliders.iter(app.world()).collect();
        if !all.is_empty()
            && all
                .iter()
                .all(|(status, ..)| **status == ColliderStatus::Ready)
        {
            let tags = all.iter().map(|(_, tag, name)| (name.0.clone(), tag.0));
            break tags.collect::<BTreeMap<_, _>>();
        }
        assert!(
            start.elapsed().as_secs() < 100,
            "nothing was loaded: {all:?}"
        );
        std::thread::sleep(std::time::Duration::from_millis(2));
    };
    let stone = SurfaceTag::new(SurfaceKind::Stone);
    for (material, tag) in [
        ("fur", SurfaceTag::new(SurfaceKind::Fur)),
        ("hide", SurfaceTag::new(SurfaceKind::Skin)),
        ("stone", stone),
        ("stone_ledge", stone.with_user(2)),
        ("shell", stone.with_user(1)),
        ("glow", stone),
    ] {
        assert_eq!(tags.get(material), Some(&tag), "{material}");
    }
    assert_eq!(tags.len(), 6);
    let surfaces = app
        .world_mut()
        .query::<&PosedSurface>()
        .iter(app.world())
        .count();
    assert_eq!(surfaces, 5 + 6);
}
