//! Bodies of avian and of `bevy_rapier3d` that meet climbers.

mod elsewhere;

use bevy_app::{App, TaskPoolPlugin};
use bevy_asset::AssetPlugin;
use bevy_clamber::clamber_climber::ClimberMode;
use bevy_clamber::events::ClimberTumbled;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_mesh::MeshPlugin;
use bevy_rapier3d::prelude::{NoUserData, RapierPhysicsPlugin, TimestepMode};
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use bevy_transform::components::Transform;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Engine {
    Avian,
    Rapier,
}

/// Engines and ticks a second.
fn settings() -> impl Iterator<Item = (Engine, f64)> {
    let rates = [30.0, 64.0, 240.0];
    let engines = [Engine::Avian, Engine::Rapier];
    engines
        .into_iter()
        .flat_map(move |engine| rates.map(|hz| (engine, hz)))
}

#[derive(Resource, Default)]
struct Falls(Vec<Option<Entity>>);

/// A climber that stands on level ground, in the world of an engine.
struct Scene {
    app: App,
    engine: Engine,
    hz: f64,
    climber: Entity,
}

impl Scene {
    fn new(engine: Engine, hz: f64, seen: bool) -> Self {
        let mut app = App::new();
        app.add_plugins((
            TaskPoolPlugin::default(),
            TimePlugin,
            TransformPlugin,
            AssetPlugin::default(),
            MeshPlugin,
        ))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .insert_resource(Time::<Fixed>::from_hz(hz))
        .add_plugins((ClamberPlugins::default(), ClimberPlugin::default()));
        match engine {
            Engine::Avian => app.add_plugins((
                avian3d::prelude::PhysicsPlugins::default(),
                AvianProxyPlugin::default(),
            )),
            Engine::Rapier => app
                .insert_resource(TimestepMode::Fixed {
                    dt: (1.0 / hz) as f32,
                    substeps: 1,
                })
                .add_plugins((
                    RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(),
                    RapierProxyPlugin::default(),
                )),
        };
        app.init_resource::<Falls>();
        let note = |fell: On<ClimberTumbled>, mut all: ResMut<Falls>| all.0.push(fell.by);
        app.add_observer(note);
        app.finish();
        app.cleanup();
        let climber = app.world_mut().spawn((
            Climber::colossus_climber(),
            Transform::from_xyz(0.0, 0.41, 0.0),
        ));
        let climber = climber.id();
        let mut scene = Self {
            app,
            engine,
            hz,
            climber,
        };
        scene.add(Vec3::new(100.0, 1.0, 100.0), Vec3::Y * -0.5, None);
        if seen {
            let mut climber = scene.app.world_mut().entity_mut(climber);
            match engine {
                Engine::Avian => climber.insert(AvianProxy),
                Engine::Rapier => climber.insert(RapierProxy),
            };
        }
        scene
    }

    /// Adds a box without turns that has a mass, or stays where it is.
    fn add(&mut self, size: Vec3, at: Vec3, mass: Option<f32>) -> Entity {
        let mut entity = self.app.world_mut().spawn(Transform::from_translation(at));
        match self.engine {
            Engine::Avian => {
                use avian3d::prelude::{Collider, LockedAxes, Mass, NoAutoMass, RigidBody};
                entity.insert(Collider::cuboid(size.x, size.y, size.z));
                match mass {
                    Some(mass) => entity.insert((
                        RigidBody::Dynamic,
                        LockedAxes::ROTATION_LOCKED,
                        Mass(mass),
                        NoAutoMass,
                    )),
                    None => entity.insert(RigidBody::Static),
                };
            }
            Engine::Rapier => {
                use bevy_rapier3d::prelude::{
                    Collider, ColliderMassProperties, LockedAxes, RigidBody, Velocity,
                };
                let half = size * 0.5;
                entity.insert(Collider::cuboid(half.x, half.y, half.z));
                match mass {
                    Some(mass) => entity.insert((
                        RigidBody::Dynamic,
                        LockedAxes::ROTATION_LOCKED,
                        ColliderMassProperties::Mass(mass),
                        Velocity::default(),
                    )),
                    None => entity.insert(RigidBody::Fixed),
                };
            }
        }
        entity.id()
    }

    /// Adds a level deck of 60 m that moves at a velocity, and puts the climber onto it.
    fn add_deck(&mut self, top: f32, velocity: Vec3) {
        let at = Transform::from_xyz(0.0, top - 0.5, 0.0);
        let mut deck = self.app.world_mut().spawn(at);
        match self.engine {
            Engine::Avian => {
                use avian3d::prelude::{Collider, LinearVelocity, RigidBody};
                let deck_collider = Collider::cuboid(60.0, 1.0, 60.0);
                deck.insert((
                    RigidBody::Kinematic,
                    deck_collider,
                    LinearVelocity(velocity),
                ));
            }
            Engine::Rapier => {
                use bevy_rapier3d::prelude::{Collider, RigidBody, Velocity};
                let kind = RigidBody::KinematicVelocityBased;
                deck.insert((
                    kind,
                    Collider::cuboid(3.0, 0.5, 3.0),
                    Velocity::linear(velocity),
                ));
            }
        }
        let (climber, place) = (self.climber, Transform::from_xyz(0.0, top + 0.42, 0.0));
        self.app.world_mut().entity_mut(climber).insert(place);
        self.run(3.5 / self.hz);
        // It comes along with the deck.
        let world = self.app.world_mut();
        let config = *world.get::<ClimberBody>(climber).unwrap().config();
        let above = DVec3::Y * (f64::from(top) + 0.42);
        let fresh = bevy_clamber::clamber_climber::Climber::new(config, above).unwrap();
        let mut state = *fresh.state();
        (state.velocity, state.base_velocity) = (velocity.as_dvec3(), velocity.as_dvec3());
        world.get_mut::<ClimberState>(climber).unwrap().0 = state;
        world.resource_mut::<Falls>().0.clear();
    }

    /// Adds a crate of 0.6 m whose middle is above the climber's.
    fn add_above(&mut self, height: f32, mass: f32) -> Entity {
        self.add(Vec3::splat(0.6), Vec3::Y * (0.4 + height), Some(mass))
    }

    fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds * self.hz) as u32 {
            self.app.update();
        }
    }

    /// Walks along X.
    fn walk(&mut self) {
        let mut input = self.app.world_mut().get_mut::<ClimberInput>(self.climber);
        input.as_mut().unwrap().walk = Vec3::X;
    }

    fn send(&mut self, body: Entity, velocity: Vec3) {
        let mut body = self.app.world_mut().entity_mut(body);
        match self.engine {
            Engine::Avian => body.insert(avian3d::prelude::LinearVelocity(velocity)),
            Engine::Rapier => body.insert(bevy_rapier3d::prelude::Velocity::linear(velocity)),
        };
    }

    fn velocity(&self, body: Entity) -> Vec3 {
        let world = self.app.world();
        match self.engine {
            Engine::Avian => {
                world
                    .get::<avian3d::prelude::LinearVelocity>(body)
                    .unwrap()
                    .0
            }
            Engine::Rapier => {
                world
                    .get::<bevy_rapier3d::prelude::Velocity>(body)
                    .unwrap()
                    .linear
            }
        }
    }

    fn at(&self, entity: Entity) -> Vec3 {
        self.app
            .world()
            .get::<Transform>(entity)
            .unwrap()
            .translation
    }

    fn state(&self) -> ClimberState {
        *self.app.world().get::<ClimberState>(self.climber).unwrap()
    }

    /// How high a body is above the climber.
    fn above(&self, body: Entity) -> f32 {
        self.at(body).y - self.at(self.climber).y
    }
}

#[test]
fn a_light_crate_rests_on_a_climber_and_falls_when_it_leaves() {
    for (engine, hz) in settings() {
        for leaves in ["walks", "despawned"] {
            let told = format!("{engine:?}, {hz} Hz, {leaves}");
            let mut scene = Scene::new(engine, hz, true);
            let load = scene.add_above(1.5, 10.0);
            // Long enough for it to fall asleep.
            scene.run(4.0);
            assert_eq!(scene.state().mode, ClimberMode::Standing, "{told}");
            let above = scene.above(load);
            assert!((above - 0.71).abs() < 0.015, "{told}: {above}");
            assert!(scene.app.world().resource::<Falls>().0.is_empty());
            if leaves == "walks" {
                scene.walk();
            } else {
                let climber = scene.climber;
                scene.app.world_mut().despawn(climber);
            }
            scene.run(1.5);
            let height = scene.at(load).y;
            assert!((height - 0.3).abs() < 0.02, "{told}: {height}");
        }
    }
}

#[test]
fn a_heavy_crate_knocks_the_climber_down_and_is_named() {
    for (engine, hz) in settings() {
        let mut scene = Scene::new(engine, hz, true);
        let load = scene.add_above(2.5, 200.0);
        scene.run(1.5);
        let falls = &scene.app.world().resource::<Falls>().0;
        assert_eq!(falls.first(), Some(&Some(load)), "{engine:?}, {hz} Hz");
    }
}

#[test]
fn without_the_component_the_crate_falls_through() {
    for (engine, hz) in settings() {
        let mut scene = Scene::new(engine, hz, false);
        let load = scene.add_above(1.5, 10.0);
        scene.run(2.5);
        let above = scene.above(load);
        assert!(above < 0.65, "{engine:?}, {hz} Hz: {above}");
    }
}

/// In the air, the momentum of both is that of an inelastic impact.
#[test]
fn a_body_and_a_falling_climber_share_their_momentum() {
    for (engine, hz) in settings() {
        for mass in [8.0, 80.0, 800.0] {
            let mut scene = Scene::new(engine, hz, true);
            let climber = scene.climber;
            let place = Transform::from_xyz(0.0, 40.0, 0.0);
            scene.app.world_mut().entity_mut(climber).insert(place);
            let load = scene.add(Vec3::splat(0.6), Vec3::new(-1.5, 40.0, 0.0), Some(mass));
            scene.send(load, Vec3::X * 2.0);
            scene.run(1.0);
            let together = 2.0 * mass / (mass + 80.0);
            let own = scene.state().velocity.x as f32;
            let other = scene.velocity(load).x;
            let told = format!("{engine:?}, {hz} Hz, {mass} kg: {own} {other} of {together}");
            assert!((own / together - 1.0).abs() < 0.04, "{told}");
            assert!((other / together - 1.0).abs() < 0.04, "{told}");
        }
    }
}

#[test]
fn a_walker_pushes_a_crate_no_harder_with_a_proxy() {
    for (engine, hz) in settings() {
        let pushed = |seen| {
            let mut scene = Scene::new(engine, hz, seen);
            let load = scene.add(
                Vec3::new(1.0, 1.0, 1.0),
                Vec3::new(1.5, 0.5, 0.0),
                Some(40.0),
            );
            scene.run(0.5);
            scene.walk();
            scene.run(2.0);
            scene.at(load).x - 1.5
        };
        let (with, without) = (pushed(true), pushed(false));
        assert!(without > 4.0, "{engine:?}, {hz} Hz: {without}");
        let told = format!("{engine:?}, {hz} Hz: {with} {without}");
        assert!((with / without - 1.0).abs() < 0.05, "{told}");
    }
}

/// A platform that is thrown up and caught by nothing carries the climber as if the engine did not know it.
#[test]
fn what_carries_a_climber_does_not_collide_with_it() {
    for (engine, hz) in settings() {
        let thrown = |seen| {
            let mut scene = Scene::new(engine, hz, seen);
            let raft = scene.add(
                Vec3::new(6.0, 1.0, 6.0),
                Vec3::new(0.0, 5.0, 0.0),
                Some(2e3),
            );
            let climber = scene.climber;
            let place = Transform::from_xyz(0.0, 5.91, 0.0);
            scene.app.world_mut().entity_mut(climber).insert(place);
            let mut heights = Vec::new();
            for throw in 0..3 {
                // Slower than what avian sweeps, which then loses the rest of its way in a tick.
                scene.send(raft, Vec3::new(0.5, 4.0, -0.5) * (1.0 + 0.3 * throw as f32));
                for _ in 0..(0.3 * hz) as u32 {
                    scene.app.update();
                    heights.push(scene.at(raft));
                    heights.push(scene.at(climber));
                }
            }
            heights
        };
        let (with, without) = (thrown(true), thrown(false));
        for (tick, (a, b)) in with.iter().zip(&without).enumerate() {
            let told = format!("{engine:?}, {hz} Hz, {tick}: {a} {b}");
            assert!((*a - *b).length() < 0.02, "{told}");
        }
    }
}

/// Wherever in a tick an impact falls, the climber gets it as a whole.
#[test]
fn every_drop_that_is_fast_and_heavy_enough_knocks_the_climber_down() {
    for (engine, hz) in settings() {
        for mass in [60.0, 120.0] {
            for step in 0..12 {
                let height = 1.7 + 0.16 * step as f32;
                let mut scene = Scene::new(engine, hz, true);
                scene.add_above(height, mass);
                scene.run(1.2);
                // It falls to 0.7 m above the climber's centre.
                let speed = (2.0 * 9.81 * (height - 0.71)).sqrt();
                let blow = speed * (mass / 80.0).min(1.0);
                let falls = scene.app.world().resource::<Falls>().0.len();
                let told = format!("{engine:?}, {hz} Hz, {mass} kg, {height} m: {blow} m/s");
                if blow > 3.4 {
                    assert!(falls > 0, "{told}");
                } else if blow < 2.7 {
                    assert_eq!(falls, 0, "{told}");
                }
            }
        }
    }
}
