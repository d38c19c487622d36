//! The thirty scenes for character controllers, played through Bevy: they pass, and every state has the bits of the
//! core's climber on the same surfaces.

use std::error::Error;
use std::time::Duration;

use bevy_app::App;
use bevy_asset::{Assets, RenderAssetUsages};
use bevy_clamber::clamber_climber::{self, ClimberConfig, ClimberMode, GroundConfig};
use bevy_clamber::clamber_world::{Obstacle, ObstacleId};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::DVec3;
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Indices, Mesh, Mesh3d, PrimitiveTopology, VertexAttributeValues};
use bevy_time::{Fixed, Time, TimeUpdateStrategy};
use bevy_transform::components::Transform;
use clamber_scenes::controllers::{
    Controller, HEIGHT, Input, Motion, PADDING, RADIUS, SNAP, STEP, Set, Solid, all, play,
};

use super::common::{app_with, wait};

/// A world of Bevy with a climber, and the same climber of the core.
struct InBevy {
    app: App,
    pieces: Vec<(Entity, Entity, Motion)>,
    climber: Entity,
    core: clamber_climber::Climber,
    /// The length of a tick, as Bevy rounds it.
    dt: f64,
}

fn mesh(solid: &Solid) -> Mesh {
    let mesh = solid.mesh();
    let positions: Vec<[f32; 3]> = mesh
        .positions
        .iter()
        .map(|p| p.as_vec3().to_array())
        .collect();
    let count = positions.len();
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_JOINT_INDEX,
        VertexAttributeValues::Uint16x4(vec![[0; 4]; count]),
    )
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_JOINT_WEIGHT,
        vec![[1.0, 0.0, 0.0, 0.0]; count],
    )
    .with_inserted_indices(Indices::U32(mesh.triangles.into_flattened()))
}

fn config(set: &Set) -> ClimberConfig {
    let mut config = ClimberConfig::walker();
    config.gravity = DVec3::Y * -set.gravity;
    config.body.radius = RADIUS;
    config.body.height = HEIGHT;
    config.body.margin = PADDING;
    config.ground = GroundConfig {
        max_slope: set.max_slope,
        walk_speed: set.speed,
        jump_speed: set.jump,
        snap_distance: SNAP,
        step_height: STEP,
        throw_acceleration: f64::INFINITY,
        ..config.ground
    };
    config
}

impl InBevy {
    fn new(set: &Set) -> Self {
        let mut app = app_with(60.0, (ClamberPlugins::default(), ClimberPlugin::default()));
        app.insert_resource(Time::<Fixed>::from_seconds(set.dt))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
        let mut pieces = Vec::new();
        for piece in &set.pieces {
            let world = app.world_mut();
            let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh(&piece.solid));
            let mut bindposes = world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
            let inverse_bindposes = bindposes.add(vec![Transform::IDENTITY.to_matrix()]);
            let root = world.spawn(Transform::IDENTITY).id();
            let joint = world.spawn((Transform::IDENTITY, ChildOf(root))).id();
            let skin = SkinnedMesh {
                inverse_bindposes,
                joints: vec![joint],
            };
            let collider = SkinnedCollider::each_tick();
            let mesh = world
                .spawn((Mesh3d(mesh), skin, collider, ChildOf(root)))
                .id();
            pieces.push((root, mesh, piece.motion.clone()));
        }
        for (_, mesh, _) in &pieces {
            wait(&mut app, *mesh);
        }
        let start = set.feet + DVec3::Y * RADIUS;
        let core = clamber_climber::Climber::new(config(set), start).unwrap();
        let climber = (Climber::new(config(set)), ClimberState(*core.state()));
        let climber = app.world_mut().spawn(climber).id();
        Self {
            app,
            pieces,
            climber,
            core,
            dt: Duration::from_secs_f64(set.dt).as_secs_f64(),
        }
    }
}

impl Controller for InBevy {
    fn step(&mut self, time: f64, input: &Input) -> Result<f64, Box<dyn Error>> {
        let world = self.app.world_mut();
        for (root, _, motion) in &self.pieces {
            let pose = motion(time);
            *world.get_mut::<Transform>(*root).unwrap() = Transform {
                translation: pose.translation.as_vec3(),
                rotation: pose.rotation.as_quat(),
                ..Transform::IDENTITY
            };
        }
        let speed = self.core.config().ground.walk_speed;
        let walk = if speed > 0.0 {
            input.walk / speed
        } else {
            DVec3::ZERO
        };
        let mut told = world.get_mut::<ClimberInput>(self.climber).unwrap();
        told.walk = walk.as_vec3();
        told.jump = input.jump;
        let asked = clamber_climber::ClimberInput {
            walk: told.walk.as_dvec3(),
            jump: told.jump,
            ..clamber_climber::ClimberInput::default()
        };
        self.app.update();
        // The core's climber, on the surfaces that Bevy has posed, in another order.
        let surfaces = self.pieces.iter().rev().map(|(_, mesh, _)| {
            let surface = self.app.world().get::<PosedSurface>(*mesh).unwrap();
            (ObstacleId(mesh.to_bits()), &**surface as &dyn Obstacle)
        });
        let surfaces: Vec<(ObstacleId, &dyn Obstacle)> = surfaces.collect();
        self.core.step(&asked, &surfaces, self.dt)?;
        let state = self.app.world().get::<ClimberState>(self.climber).unwrap();
        assert_eq!(
            state.0.fingerprint(),
            self.core.state().fingerprint(),
            "at {time} s"
        );
        assert_eq!(state.0, *self.core.state(), "at {time} s");
        Ok(0.0)
    }

    fn position(&self) -> DVec3 {
        self.core.state().position
    }

    fn stands(&self) -> bool {
        self.core.state().mode == ClimberMode::Standing
    }
}

#[test]
fn thirty_scenes_pass_in_bevy_with_the_bits_of_the_core() {
    let mut failed = Vec::new();
    let mut played = 0;
    for scene in all() {
        let mut in_bevy = InBevy::new(&scene.set);
        let outcome = play(&scene, &mut in_bevy, u32::MAX).unwrap();
        played += 1;
        println!(
            "{:2} {}: {} of {} m",
            scene.number, scene.name, outcome.error, scene.asked
        );
        if !outcome.passes {
            failed.push(format!(
                "{} {}: {} m, asked {}, {} ticks in the air",
                scene.number, scene.name, outcome.error, scene.asked, outcome.in_air
            ));
        }
    }
    assert_eq!(played, 30);
    assert!(failed.is_empty(), "{failed:#?}");
}
