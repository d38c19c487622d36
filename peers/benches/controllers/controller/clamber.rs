//! clamber's climber, on rapier bodies and on skin.

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberMode, GroundConfig};
use clamber_scenes::controllers::{
    Controller, HEIGHT, Input, Mesh, Motion, PADDING, RADIUS, SNAP, STEP, Set,
};
use clamber_surface::geometry::Affine;
use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource};
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::rapier3d::prelude::RigidBodyBuilder;
use clamber_world::{BodyPoses, Obstacle, ObstacleId, RapierTerrain};
use glam::{DAffine3, DVec3};

use super::Entry;
use super::bodies::{Bodies, pose};

/// The climber on bodies and on skin.
pub(super) const ENTRIES: [Entry; 2] = [
    Entry {
        name: "clamber on bodies",
        is_ours: true,
        make: |set| Ours::new(set, Solids::bodies(set)?),
    },
    Entry {
        name: "clamber on skin",
        is_ours: true,
        make: |set| Ours::new(set, Solids::skin(set)?),
    },
];

fn climber(set: &Set) -> Result<Climber, Box<dyn Error>> {
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
        // Feet stick to any ground, as with the other controllers.
        throw_acceleration: f64::INFINITY,
        ..config.ground
    };
    Ok(Climber::new(config, set.feet + DVec3::Y * RADIUS)?)
}

/// Steps the climber; returns the time, microseconds.
fn timed(
    climber: &mut Climber,
    obstacles: &[(ObstacleId, &dyn Obstacle)],
    input: &Input,
    dt: f64,
) -> Result<f64, Box<dyn Error>> {
    let speed = climber.config().ground.walk_speed;
    let walk = if speed > 0.0 {
        input.walk / speed
    } else {
        DVec3::ZERO
    };
    let input = ClimberInput {
        walk,
        jump: input.jump,
        ..ClimberInput::default()
    };
    let start = Instant::now();
    climber.step(&input, obstacles, dt)?;
    Ok(start.elapsed().as_secs_f64() * 1e6)
}

/// The solids of a set.
enum Solids {
    Bodies(Box<Bodies>, BodyPoses),
    /// Surfaces, which are at rest but for their motion.
    Skin(Vec<(SkinnedSurface, Motion)>, Palette),
}

struct Ours {
    solids: Solids,
    climber: Climber,
    dt: f64,
}

impl Ours {
    fn new(set: &Set, solids: Solids) -> Result<Box<dyn Controller>, Box<dyn Error>> {
        Ok(Box::new(Self {
            solids,
            climber: climber(set)?,
            dt: set.dt,
        }))
    }
}

impl Solids {
    fn bodies(set: &Set) -> Result<Self, Box<dyn Error>> {
        let bodies = Bodies::new(set, RigidBodyBuilder::kinematic_position_based)?;
        Ok(Self::Bodies(Box::new(bodies), BodyPoses::new()))
    }

    fn skin(set: &Set) -> Result<Self, Box<dyn Error>> {
        let rest = Palette::from_matrices([Affine::from_f64(&DAffine3::IDENTITY)]);
        let mut surfaces = Vec::new();
        for piece in &set.pieces {
            let mut surface = SkinnedSurface::new(collider(&piece.solid.mesh())?);
            surface.teleport(&rest, (piece.motion)(0.0))?;
            surfaces.push((surface, piece.motion.clone()));
        }
        Ok(Self::Skin(surfaces, rest))
    }
}

/// A collider on one joint.
fn collider(mesh: &Mesh) -> Result<Arc<ColliderMesh>, Box<dyn Error>> {
    let positions: Vec<_> = mesh.positions.iter().map(|p| p.as_vec3()).collect();
    let source = MeshSource::rigid(&positions, &mesh.triangles);
    let (collider, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default())?;
    Ok(Arc::new(collider))
}

impl Controller for Ours {
    fn step(&mut self, time: f64, input: &Input) -> Result<f64, Box<dyn Error>> {
        match &mut self.solids {
            Solids::Bodies(bodies, before) => {
                let Bodies { world, moving } = &mut **bodies;
                before.record(&world.bodies);
                for (handle, motion) in moving {
                    if let Some(body) = world.bodies.get_mut(*handle) {
                        body.set_next_kinematic_position(pose(&motion(time)));
                    }
                }
                world.step();
                let terrain = RapierTerrain::of_world(world, before);
                let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &terrain)];
                timed(&mut self.climber, &obstacles, input, self.dt)
            }
            Solids::Skin(surfaces, rest) => {
                for (surface, motion) in &mut *surfaces {
                    surface.advance(rest, motion(time))?;
                }
                let surfaces = surfaces.iter().map(|(surface, _)| surface as &dyn Obstacle);
                let obstacles: Vec<_> = (0..).map(ObstacleId).zip(surfaces).collect();
                timed(&mut self.climber, &obstacles, input, self.dt)
            }
        }
    }

    fn position(&self) -> DVec3 {
        self.climber.state().position
    }

    fn stands(&self) -> bool {
        self.climber.state().mode == ClimberMode::Standing
    }
}
