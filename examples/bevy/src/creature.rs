//! Loads the creature, makes its skinned meshes surfaces, and measures it.

use std::path::PathBuf;
use std::time::Duration;

use bevy::asset::{AssetPath, LoadState};
use bevy::gltf::{Gltf, GltfExtras, GltfMaterialExtras};
use bevy::mesh::skinning::SkinnedMesh;
use bevy::prelude::*;
use bevy::world_serialization::WorldInstanceReady;
use bevy_clamber::prelude::*;

use crate::giant;
use crate::trouble::Trouble;

/// Seconds to wait for the creature before the app gives up. The giant of this project takes some seconds in an
/// unoptimised build.
const PATIENCE: u64 = 120;

/// Advice that ends an error message.
const ANOTHER: &str = "give a glTF or GLB file with a skinned mesh";

/// The creature, which stands on the ground when this is inserted: its surfaces are built, and the game begins.
#[derive(Resource, Clone, Debug)]
pub struct Creature {
    /// The root of its scene.
    pub root: Entity,
    /// Its height, metres.
    pub height: f32,
    /// Radius of a circle around it, seen from above, metres.
    pub radius: f32,
    /// How much larger it is than in its file.
    pub scale: f32,
    /// Its clips by their names.
    pub clips: Vec<(String, AnimationNodeIndex)>,
}

/// The file to load, and how high it is made.
#[derive(Resource)]
struct Wanted {
    /// Path relative to the folder that assets are loaded from.
    file: PathBuf,
    height: Option<f32>,
}

/// The file that is being loaded.
#[derive(Resource)]
struct Loading(Handle<Gltf>);

/// The creature's scene.
#[derive(Resource)]
struct Spawned {
    root: Entity,
    clips: Vec<(String, AnimationNodeIndex)>,
}

pub fn plugin(file: PathBuf, height: Option<f32>) -> impl Plugin {
    move |app: &mut App| {
        let file = file.clone();
        app.insert_resource(Wanted { file, height })
            .add_observer(add_colliders)
            .add_systems(Startup, load)
            .add_systems(
                Update,
                (
                    spawn.run_if(resource_exists::<Loading>),
                    (measure, give_up).run_if(not(resource_exists::<Creature>)),
                ),
            );
    }
}

fn load(wanted: Res<Wanted>, assets: Res<AssetServer>, mut commands: Commands) {
    // Not from text, where `#` would begin a label.
    let path = AssetPath::from_path_buf(wanted.file.clone());
    commands.insert_resource(Loading(assets.load(path)));
}

/// Spawns the first scene once the file is loaded.
fn spawn(
    loading: Res<Loading>,
    assets: Res<AssetServer>,
    files: Res<Assets<Gltf>>,
    mut graphs: ResMut<Assets<AnimationGraph>>,
    mut commands: Commands,
    mut trouble: Trouble,
) {
    if let LoadState::Failed(error) = assets.load_state(&loading.0) {
        commands.remove_resource::<Loading>();
        // Only the first line: a backtrace follows it.
        let error = error.to_string();
        let error = error.lines().next().unwrap_or_default();
        trouble.end(format_args!("cannot be loaded: {error}; {ANOTHER}"));
        return;
    }
    let Some(file) = files.get(&loading.0) else {
        return;
    };
    commands.remove_resource::<Loading>();
    let Some(scene) = file.default_scene.as_ref().or(file.scenes.first()) else {
        trouble.end(format_args!("has no scene; {ANOTHER}"));
        return;
    };
    let (graph, nodes) = AnimationGraph::from_clips(file.animations.iter().cloned());
    let graph = AnimationGraphHandle(graphs.add(graph));
    let name = |clip: &Handle<AnimationClip>| {
        let names = &mut file.named_animations.iter();
        let name = names.find(|(_, named)| *named == clip);
        name.map_or(String::new(), |(name, _)| name.to_lowercase())
    };
    let clips = file.animations.iter().map(name).zip(nodes).collect();
    let root = commands
        .spawn((WorldAssetRoot(scene.clone()), Transform::default()))
        .observe(
            move |ready: On<WorldInstanceReady>,
                  children: Query<&Children>,
                  players: Query<(), With<AnimationPlayer>>,
                  mut commands: Commands| {
                for entity in children.iter_descendants(ready.entity) {
                    if players.contains(entity) {
                        let play = (graph.clone(), AnimationTransitions::new());
                        commands.entity(entity).insert(play);
                    }
                }
            },
        )
        .id();
    commands.insert_resource(Spawned { root, clips });
}

/// Makes skinned meshes surfaces: those that are for collision only, if the file has any, as `assets/colossus.glb`,
/// else all. The former are not drawn, but pointers see them.
fn add_colliders(
    ready: On<WorldInstanceReady>,
    children: Query<&Children>,
    skins: Query<(&ChildOf, Option<&GltfMaterialExtras>), With<SkinnedMesh>>,
    extras: Query<&GltfExtras>,
    mut commands: Commands,
    mut trouble: Trouble,
) {
    let (mut all, mut for_collision) = (Vec::new(), Vec::new());
    for entity in children.iter_descendants(ready.entity) {
        if let Ok((child_of, material)) = skins.get(entity) {
            all.push((entity, material));
            if extras.get(child_of.parent()).is_ok_and(is_for_collision) {
                for_collision.push((entity, material));
                commands
                    .entity(entity)
                    .remove::<MeshMaterial3d<StandardMaterial>>();
            }
        }
    }
    if all.is_empty() {
        trouble.end(format_args!("its scene shows no skinned mesh; {ANOTHER}"));
        return;
    }
    let are_tagged = all.iter().any(|(_, material)| material.is_some());
    let surfaces = if for_collision.is_empty() {
        all
    } else {
        for_collision
    };
    for (entity, _) in surfaces {
        let mut surface = commands.entity(entity);
        surface.insert(SkinnedCollider::default());
        if !are_tagged {
            // A file that says nothing of its materials: everything can be gripped.
            surface.insert(ColliderTag(SurfaceTag::new(SurfaceKind::Fur)));
        }
    }
}

fn is_for_collision(extras: &GltfExtras) -> bool {
    let extras: serde_json::Value = serde_json::from_str(&extras.value).unwrap_or_default();
    extras["clamber"]["role"] == "collision"
}

/// Waits for all surfaces, takes their bounds, and puts the creature on the ground at the size that is wanted.
fn measure(
    colliders: Query<(NameOrEntity, &ColliderStatus, Option<&mut PosedSurface>)>,
    spawned: Option<Res<Spawned>>,
    wanted: Res<Wanted>,
    mut roots: Query<&mut Transform>,
    mut commands: Commands,
    mut trouble: Trouble,
) {
    let done = |status: &ColliderStatus| {
        matches!(status, ColliderStatus::Ready | ColliderStatus::Failed(_))
    };
    let Some(spawned) = spawned else {
        return;
    };
    if colliders.is_empty() || !colliders.iter().all(|(_, status, _)| done(status)) {
        return;
    }
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let mut positions = Vec::new();
    let (mut failed, mut meshes) = (Vec::new(), 0);
    for (mesh, status, surface) in &colliders {
        meshes += 1;
        if let ColliderStatus::Failed(error) = status {
            failed.push(format!("{mesh}: {error}"));
        }
        let Some(surface) = surface else {
            continue;
        };
        surface.skin_all(&mut positions);
        for position in &positions {
            let place = surface.world_from_model();
            let in_world = place.transform_point_f32(*position).as_vec3();
            (low, high) = (low.min(in_world), high.max(in_world));
        }
    }
    let size = high - low;
    if failed.len() == meshes {
        let why = failed.join("; ");
        trouble.end(format_args!("no mesh can be a surface ({why}); {ANOTHER}"));
        return;
    }
    if !(size.is_finite() && size.min_element() > 0.0) {
        trouble.end(format_args!("its skin has no size; {ANOTHER}"));
        return;
    }
    if !failed.is_empty() {
        let why = failed.join("; ");
        trouble.go_on(format_args!("some meshes cannot be climbed ({why})"));
    }
    let scale = wanted.height.map_or(1.0, |height| height / size.y);
    if let Ok(mut root) = roots.get_mut(spawned.root) {
        root.scale *= scale;
        root.translation.y = (root.translation.y - low.y) * scale;
        root.translation += giant::start(size.y * scale);
    }
    for (.., surface) in colliders {
        if let Some(mut surface) = surface {
            surface.forget_motion();
        }
    }
    commands.insert_resource(Creature {
        root: spawned.root,
        height: size.y * scale,
        radius: 0.5 * size.xz().length() * scale,
        scale,
        clips: spawned.clips.clone(),
    });
}

fn give_up(
    time: Res<Time<Real>>,
    colliders: Query<(NameOrEntity, &ColliderStatus)>,
    mut trouble: Trouble,
) {
    if time.elapsed() < Duration::from_secs(PATIENCE) {
        return;
    }
    let stages: Vec<_> = colliders
        .iter()
        .map(|(mesh, status)| format!("{mesh}: {status:?}"))
        .collect();
    let stages = stages.join(", ");
    trouble.end(format_args!(
        "not ready after {PATIENCE} s [{stages}]; {ANOTHER}"
    ));
}
