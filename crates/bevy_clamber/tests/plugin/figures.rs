//! A climber is drawn as a humanoid: its feet are on what it stands on, as the frame draws it.

use std::sync::Arc;

use bevy_app::{App, PostUpdate};
use bevy_asset::Assets;
use bevy_clamber::clamber_body::{Extremity, Figure, Humanoid, Side};
use bevy_clamber::clamber_world::HalfSpace;
use bevy_clamber::prelude::*;
use bevy_clamber::{FigureOf, WrongJoints};
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_mesh::Mesh;
use bevy_mesh::skinning::SkinnedMeshInverseBindposes;
use bevy_transform::components::Transform;

use super::common::{self, LYING, app_with, limb};

const HERO: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/hero.glb");

/// What frames have shown.
#[derive(Resource, Default)]
struct Seen {
    plants: Vec<ClimberPlant>,
    triggered: usize,
    /// Largest distance of a sole that stands from the drawn skin.
    gap: f32,
    frames: usize,
}

fn watch(
    figures: Query<&ClimberFigure>,
    surfaces: DrawnSurfaceQuery,
    mut plants: MessageReader<ClimberPlant>,
    mut seen: ResMut<Seen>,
) {
    seen.plants.extend(plants.read());
    seen.frames += 1;
    for figure in &figures {
        for side in Side::BOTH {
            let stands = figure.body().hold(Extremity::Foot(side)).is_some();
            let sole = figure.body().sole(figure.figure(), side);
            let Some(sole) = sole.filter(|_| stands && seen.frames > 144) else {
                continue;
            };
            for point in sole {
                let near = surfaces.closest_point(point.as_vec3(), 1.0, &SurfaceFilter::default());
                let off = near.map_or(0.0, |near| near.distance);
                seen.gap = seen.gap.max(off);
            }
        }
    }
}

/// An app in which a climber is drawn as the hero.
fn hero(place: Vec3) -> (App, Entity, SpawnedRig) {
    let plugins = (
        ClamberPlugins::default(),
        ClimberPlugin::default(),
        ClimberFigurePlugin,
        ClimberCameraPlugin,
    );
    let mut app = app_with(144.0, plugins);
    app.init_resource::<Seen>()
        .add_systems(PostUpdate, watch.after(ClamberSystems::Anchor));
    let model = clamber_gltf::load(HERO).unwrap();
    let rig = &model.rig;
    let humanoid = Humanoid::find(&rig.skeleton).unwrap();
    let figure = Figure::new(rig.skeleton.clone(), humanoid, rig.clips.clone()).unwrap();
    let world = app.world_mut();
    let assets = world.resource_scope(|world, mut meshes: Mut<'_, Assets<Mesh>>| {
        let mut bindposes = world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
        RigAssets::new(model, &mut meshes, &mut bindposes).unwrap()
    });
    let spawned = assets.spawn(&mut world.commands(), Transform::IDENTITY);
    world.flush();
    let figure = ClimberFigure::new(Arc::new(figure), &spawned).unwrap();
    let climber = (
        Climber::colossus_climber(),
        Transform::from_translation(place),
        figure,
    );
    let climber = world.spawn(climber).id();
    world.add_observer(|_: On<ClimberPlant>, mut seen: ResMut<Seen>| seen.triggered += 1);
    (app, climber, spawned)
}

#[test]
fn a_climber_walks_on_its_feet() {
    let (mut app, climber, rig) = hero(Vec3::Y);
    app.world_mut()
        .spawn(CustomObstacle::new(HalfSpace::below(0.0)));
    for frame in 0..432 {
        if frame == 144 {
            let mut input = app.world_mut().get_mut::<ClimberInput>(climber).unwrap();
            input.walk = Vec3::X * 0.5;
        }
        app.update();
    }
    let world = app.world();
    let place = world.get::<Transform>(climber).unwrap().translation;
    let root = world.get::<Transform>(rig.root).unwrap();
    // The figure stands below the ball's centre, and faces where the climber walks.
    let off = root.translation - place;
    assert!(off.length() < 0.5 && off.y < -0.3, "{off}");
    assert!((root.rotation * Vec3::Z).dot(Vec3::X) > 0.97);
    let seen = world.resource::<Seen>();
    assert!(seen.plants.len() >= 5, "{:?}", seen.plants);
    assert_eq!(seen.triggered, seen.plants.len());
    for plant in &seen.plants {
        assert_eq!(plant.entity, climber);
        assert!(plant.plant.point.y.abs() < 1e-3);
    }
    // Joints have been posed: no longer at rest.
    let hips = rig.joints[1];
    assert!(world.get::<Transform>(hips).is_some());
}

#[test]
fn feet_stand_on_skin_as_it_is_drawn() {
    let (mut app, climber, _) = hero(Vec3::new(10.0, 2.5, 0.0));
    let lying = Transform::from_rotation(LYING).with_scale(Vec3::splat(10.0));
    let floor = limb(&mut app, lying, SkinnedCollider::default());
    let mut joint = app.world_mut().entity_mut(floor.joints[1]);
    joint.remove::<common::Bending>();
    // It goes up and down.
    app.add_systems(
        bevy_app::Update,
        move |time: Res<bevy_time::Time>, mut roots: Query<&mut Transform>| {
            let mut root = roots.get_mut(floor.root).unwrap();
            root.translation.y = libm::sin(2.0 * time.elapsed().as_secs_f64()) as f32;
        },
    );
    for _ in 0..576 {
        app.update();
    }
    let state = app.world().get::<ClimberState>(climber).unwrap();
    assert!(state.support.is_some(), "{state:?}");
    let seen = app.world().resource::<Seen>();
    assert!(seen.gap > 0.0 && seen.gap < 0.02, "{} m", seen.gap);
}

#[test]
fn a_rig_of_another_figure_is_refused() {
    let (mut app, climber, rig) = hero(Vec3::Y);
    let figure = app
        .world()
        .get::<ClimberFigure>(climber)
        .unwrap()
        .figure()
        .clone();
    let joints = rig.joints[1..].to_vec();
    let count = rig.joints.len();
    let wrong = ClimberFigure::with_joints(figure, rig.root, joints);
    let expected = WrongJoints {
        figure: count,
        joints: count - 1,
    };
    assert_eq!(wrong.err(), Some(expected));
    // Without ground, and after its rig is gone, nothing panics.
    for frame in 0..30 {
        if frame == 10 {
            app.world_mut().despawn(rig.root);
        }
        app.update();
    }
    let fallen = app.world().get::<ClimberState>(climber).unwrap();
    assert!(fallen.position.y < 1.0 && fallen.position != DVec3::ZERO);
}

#[test]
fn a_figure_is_despawned_with_its_climber() {
    let (mut app, climber, rig) = hero(Vec3::Y);
    app.update();
    let world = app.world_mut();
    assert_eq!(world.get::<FigureOf>(rig.root), Some(&FigureOf(climber)));
    // Without its figure, the rig stays for something else.
    let figure = world.entity_mut(climber).take::<ClimberFigure>().unwrap();
    world.flush();
    assert_eq!(world.get::<FigureOf>(rig.root), None);
    world.entity_mut(climber).insert(figure);
    world.flush();
    world.despawn(climber);
    world.flush();
    for entity in rig.joints.iter().chain(&rig.meshes).chain([&rig.root]) {
        assert!(world.get_entity(*entity).is_err(), "{entity}");
    }
    app.update();
}
