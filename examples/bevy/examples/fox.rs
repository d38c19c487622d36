use bevy::mesh::skinning::SkinnedMesh;
use bevy::prelude::*;
use bevy_clamber::clamber_world::HalfSpace;
use bevy_clamber::prelude::*;

/// The fox of the file is 78 units high, this one is 10 m.
const SCALE: f32 = 10.0 / 78.0;

/// A real fox is 0.5 m high, and large animals move more slowly: by the root of how much larger they are.
const SPEED: f32 = 0.22;

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, ClamberPlugins::default()))
        .add_plugins((
            ClimberPlugin::default(),
            ClimberControlsPlugin,
            ClimberCameraPlugin,
        ))
        .add_observer(make_furry)
        .add_observer(run)
        .add_observer(enter)
        .add_systems(Startup, spawn)
        .run();
}

/// Climbers grip fur alone, and files that were not made for clamber have none.
fn make_furry(skin: On<Add<SkinnedMesh>>, mut commands: Commands) {
    let fur = ColliderTag(SurfaceTag::new(SurfaceKind::Fur));
    commands
        .entity(skin.entity)
        .insert((SkinnedCollider::default(), fur));
}

#[derive(Resource)]
struct Running {
    graph: Handle<AnimationGraph>,
    clip: AnimationNodeIndex,
}

fn spawn(
    mut commands: Commands,
    assets: Res<AssetServer>,
    mut graphs: ResMut<Assets<AnimationGraph>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    // The third clip of the file: it runs.
    let clip = assets.load(GltfAssetLabel::Animation(2).from_asset("Fox.glb"));
    let (graph, clip) = AnimationGraph::from_clip(clip);
    let graph = graphs.add(graph);
    commands.insert_resource(Running { graph, clip });
    let fox = assets.load(GltfAssetLabel::Scene(0).from_asset("Fox.glb"));
    let small = Transform::from_scale(Vec3::splat(SCALE));
    commands.spawn((WorldAssetRoot(fox), small));

    // Level ground, to stand on and to see.
    let plane = Mesh3d(meshes.add(Plane3d::default().mesh().size(200.0, 200.0)));
    let green = MeshMaterial3d(materials.add(Color::srgb(0.3, 0.5, 0.2)));
    commands.spawn((CustomObstacle::new(HalfSpace::below(0.0)), plane, green));
    let down = Transform::default().looking_to(Vec3::new(0.3, -1.0, -0.6), Vec3::Y);
    commands.spawn((DirectionalLight::default(), down));
}

/// Drops the hero on the fox's back when its surface is ready.
fn enter(
    _: On<Add<PosedSurface>>,
    heroes: Query<(), With<Climber>>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    if !heroes.is_empty() {
        return;
    }
    let look = Mesh3d(meshes.add(Sphere::new(0.4))); // the ball of a climber's body
    let blue = MeshMaterial3d(materials.add(Color::srgb(0.2, 0.4, 0.9)));
    let hero = (
        Climber::colossus_climber(),
        ClimberControls::default(),
        look,
        blue,
    );
    let place = Transform::from_xyz(0.0, 12.0, 0.0);
    let hero = commands.spawn((hero, place)).id();
    commands.spawn((Camera3d::default(), ClimberCamera::new(hero)));
}

/// Bevy adds a player to a creature that it loads; this starts it.
fn run(
    added: On<Add<AnimationPlayer>>,
    mut players: Query<&mut AnimationPlayer>,
    running: Res<Running>,
    mut commands: Commands,
) {
    let graph = AnimationGraphHandle(running.graph.clone());
    commands.entity(added.entity).insert(graph);
    if let Ok(mut player) = players.get_mut(added.entity) {
        player.play(running.clip).repeat().set_speed(SPEED);
    }
}
