use bevy::mesh::skinning::SkinnedMesh;
use bevy::prelude::*;
use bevy_clamber::prelude::*;

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, ClamberPlugins::default()))
        .add_plugins((
            ClimberPlugin::default(),
            ClimberControlsPlugin,
            ClimberCameraPlugin,
        ))
        .add_observer(add_surface)
        .add_observer(enter)
        .add_systems(Startup, load)
        .run();
}

/// Loads the creature from `assets/colossus.glb` of your project: a copy of the file in clamber's `assets`.
fn load(mut commands: Commands, assets: Res<AssetServer>) {
    let scene = GltfAssetLabel::Scene(0).from_asset("colossus.glb");
    commands.spawn(WorldAssetRoot(assets.load(scene)));
    let down = Transform::default().looking_to(Vec3::new(0.3, -1.0, -0.6), Vec3::Y);
    commands.spawn((DirectionalLight::default(), down));
}

/// Makes every skinned mesh a surface when it is spawned.
fn add_surface(skin: On<Add<SkinnedMesh>>, mut commands: Commands) {
    commands
        .entity(skin.entity)
        .insert(SkinnedCollider::default());
}

/// Drops the hero on the creature's shoulders when the first surface is ready.
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
    let place = Transform::from_xyz(-1.5, 39.5, 7.0);
    let hero = commands.spawn((hero, place)).id();
    commands.spawn((Camera3d::default(), ClimberCamera::new(hero)));
}
