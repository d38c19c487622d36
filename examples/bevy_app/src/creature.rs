//! Loads the creature, makes its skinned meshes surfaces, plays a clip, and measures the creature.

use std::path::PathBuf;
use std::time::Duration;

use bevy::asset::{AssetPath, LoadState};
use bevy::gltf::{Gltf, GltfExtras};
use bevy::mesh::skinning::SkinnedMesh;
use bevy::prelude::*;
use bevy::world_serialization::WorldInstanceReady;
use bevy_clamber::prelude::*;

use crate::trouble::Trouble;

/// Seconds to wait for the creature before the app gives up. The giant of this project takes some seconds in an
/// unoptimised build.
const PATIENCE: u64 = 120;

/// Advice that ends an error message.
const ANOTHER: &str = "give a glTF or GLB file with a skinned mesh";

/// Size and place of the creature; inserted when its surfaces are built.
#[derive(Resource, Clone, Copy, Debug)]
pub struct Creature {
    /// Middle of its bounds in the world.
    pub center: Vec3,
    /// Half of the extents of its bounds, metres.
    pub half_size: Vec3,
}

impl Creature {
    /// Height of the floor that it stands on.
    pub fn floor(&self) -> f32 {
        self.center.y - self.half_size.y
    }

    /// Radius of a ball around it.
    pub fn radius(&self) -> f32 {
        self.half_size.length()
    }
}

/// The file and clip to show.
#[derive(Resource)]
struct Wanted {
    /// Path relative to the folder that assets are loaded from.
    file: PathBuf,
    clip: String,
}

/// The file that is being loaded.
#[derive(Resource)]
struct Loading(Handle<Gltf>);

pub fn plugin(file: PathBuf, clip: String) -> impl Plugin {
    move |app: &mut App| {
        app.insert_resource(Wanted {
            file: file.clone(),
            clip: clip.clone(),
        })
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
    wanted: Res<Wanted>,
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
    let mut creature = commands.spawn(WorldAssetRoot(scene.clone()));
    let clip = file.named_animations.get(wanted.clip.as_str());
    let Some(clip) = clip.or(file.animations.first()) else {
        return;
    };
    let (graph, clip) = AnimationGraph::from_clip(clip.clone());
    let graph = AnimationGraphHandle(graphs.add(graph));
    let play = move |ready: On<WorldInstanceReady>,
                     children: Query<&Children>,
                     mut players: Query<&mut AnimationPlayer>,
                     mut commands: Commands| {
        for entity in children.iter_descendants(ready.entity) {
            if let Ok(mut player) = players.get_mut(entity) {
                player.play(clip).repeat();
                commands.entity(entity).insert(graph.clone());
            }
        }
    };
    creature.observe(play);
}

/// Makes visible skinned meshes surfaces, and hides meshes that are for collision only, as in `assets/colossus.glb`:
/// arrows stick to the visible meshes.
fn add_colliders(
    ready: On<WorldInstanceReady>,
    children: Query<&Children>,
    skins: Query<&ChildOf, With<SkinnedMesh>>,
    extras: Query<&GltfExtras>,
    mut commands: Commands,
    mut trouble: Trouble,
) {
    let mut surfaces = 0;
    for entity in children.iter_descendants(ready.entity) {
        let Ok(child_of) = skins.get(entity) else {
            continue;
        };
        if extras.get(child_of.parent()).is_ok_and(for_collision_only) {
            commands.entity(entity).insert(Visibility::Hidden);
        } else {
            commands.entity(entity).insert(SkinnedCollider::default());
            surfaces += 1;
        }
    }
    if surfaces == 0 {
        trouble.end(format_args!("its scene shows no skinned mesh; {ANOTHER}"));
    }
}

fn for_collision_only(extras: &GltfExtras) -> bool {
    let extras: serde_json::Value = serde_json::from_str(&extras.value).unwrap_or_default();
    extras["clamber"]["role"] == "collision"
}

/// Waits for all surfaces, then takes their bounds.
fn measure(
    colliders: Query<(NameOrEntity, &ColliderStatus, Option<&PosedSurface>)>,
    mut commands: Commands,
    mut trouble: Trouble,
) {
    let done = |status: &ColliderStatus| {
        matches!(status, ColliderStatus::Ready | ColliderStatus::Failed(_))
    };
    if colliders.is_empty() || !colliders.iter().all(|(_, status, _)| done(status)) {
        return;
    }
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let mut positions = Vec::new();
    let mut failed = Vec::new();
    for (mesh, status, surface) in &colliders {
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
    let creature = Creature {
        center: 0.5 * (low + high),
        half_size: 0.5 * (high - low),
    };
    let why = failed.join("; ");
    if failed.len() == colliders.iter().count() {
        trouble.end(format_args!("no mesh can be a surface ({why}); {ANOTHER}"));
    } else if !(creature.radius().is_finite() && creature.radius() > 0.0) {
        trouble.end(format_args!("its skin has no size; {ANOTHER}"));
    } else {
        if !failed.is_empty() {
            trouble.go_on(format_args!("arrows do not stick to some meshes ({why})"));
        }
        commands.insert_resource(creature);
    }
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
