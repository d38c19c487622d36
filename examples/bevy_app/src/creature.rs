//! Loads the creature, makes its skin a surface, plays a clip, and measures it.

use bevy::gltf::{Gltf, GltfExtras};
use bevy::mesh::skinning::SkinnedMesh;
use bevy::prelude::*;
use bevy::world_serialization::WorldInstanceReady;
use bevy_clamber::prelude::*;

/// How large the creature is and where it stands; there once its surfaces are.
#[derive(Resource, Clone, Copy, Debug)]
pub struct Creature {
    /// Middle of its bounds in the world.
    pub center: Vec3,
    /// Half of the extents of its bounds, metres.
    pub half_size: Vec3,
}

impl Creature {
    /// Height of what it stands on.
    pub fn floor(&self) -> f32 {
        self.center.y - self.half_size.y
    }

    /// Radius of a ball around it.
    pub fn radius(&self) -> f32 {
        self.half_size.length()
    }
}

/// What to show.
#[derive(Resource)]
struct Wanted {
    file: String,
    clip: String,
}

/// What is being loaded.
#[derive(Resource)]
struct Loading(Handle<Gltf>);

pub fn plugin(file: String, clip: String) -> impl Plugin {
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
                measure.run_if(not(resource_exists::<Creature>)),
            ),
        );
    }
}

fn load(wanted: Res<Wanted>, assets: Res<AssetServer>, mut commands: Commands) {
    commands.insert_resource(Loading(assets.load(wanted.file.clone())));
}

/// Spawns the first scene once the file is loaded.
fn spawn(
    loading: Res<Loading>,
    wanted: Res<Wanted>,
    assets: Res<AssetServer>,
    files: Res<Assets<Gltf>>,
    mut graphs: ResMut<Assets<AnimationGraph>>,
    mut commands: Commands,
    mut exit: MessageWriter<AppExit>,
) {
    if assets.load_state(&loading.0).is_failed() {
        // Bevy has said why.
        exit.write(AppExit::error());
        return;
    }
    let Some(file) = files.get(&loading.0) else {
        return;
    };
    commands.remove_resource::<Loading>();
    let Some(scene) = file.default_scene.as_ref().or(file.scenes.first()) else {
        error!("{} has no scene", wanted.file);
        exit.write(AppExit::error());
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

/// Whatever has a skinned mesh and is to be seen becomes a surface. What a file says is for collision only, as
/// `assets/colossus.glb` does, is hidden: arrows stick to what one sees.
fn add_colliders(
    ready: On<WorldInstanceReady>,
    children: Query<&Children>,
    skins: Query<&ChildOf, With<SkinnedMesh>>,
    extras: Query<&GltfExtras>,
    mut commands: Commands,
) {
    for entity in children.iter_descendants(ready.entity) {
        let Ok(child_of) = skins.get(entity) else {
            continue;
        };
        if extras.get(child_of.parent()).is_ok_and(for_collision_only) {
            commands.entity(entity).insert(Visibility::Hidden);
        } else {
            commands.entity(entity).insert(SkinnedCollider::default());
        }
    }
}

fn for_collision_only(extras: &GltfExtras) -> bool {
    let extras: serde_json::Value = serde_json::from_str(&extras.value).unwrap_or_default();
    extras["clamber"]["role"] == "collision"
}

/// Waits for all surfaces, then takes their bounds.
fn measure(
    colliders: Query<(&ColliderStatus, Option<&PosedSurface>)>,
    mut commands: Commands,
    mut exit: MessageWriter<AppExit>,
) {
    let done = |status: &ColliderStatus| {
        matches!(status, ColliderStatus::Ready | ColliderStatus::Failed(_))
    };
    if colliders.is_empty() || !colliders.iter().all(|(status, _)| done(status)) {
        return;
    }
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let mut positions = Vec::new();
    for surface in colliders.iter().filter_map(|(_, surface)| surface) {
        surface.skin_all(&mut positions);
        for position in &positions {
            let place = surface.world_from_model();
            let in_world = place.transform_point_f32(*position).as_vec3();
            (low, high) = (low.min(in_world), high.max(in_world));
        }
    }
    if low.x > high.x {
        error!("nothing of the creature can be a surface");
        exit.write(AppExit::error());
        return;
    }
    commands.insert_resource(Creature {
        center: 0.5 * (low + high),
        half_size: 0.5 * (high - low),
    });
}
