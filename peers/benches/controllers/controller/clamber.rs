//! clamber's climber, on rapier bodies and on skin.

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberMode, GroundConfig};
use clamber_scenes::controllers::{
    Controller, HEIGHT, Input, Mesh, Motion, PADDING, RADIUS, SNAP, STEP, Set,
};
use clamber_surface::geometry::Affine;
use clamber_surface::mesh::{BuildOptions, ColliderMesh, Influence, MeshSource, SurfaceTag};
use clamber_surface::rig::{JointId, Palette};
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
        make: |set| Ok(Box::new(OnBodies::new(set)?)),
    },
    Entry {
        name: "clamber on skin",
        is_ours: true,
        make: |set| Ok(Box::new(OnSkin::new(set)?)),
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

fn stands(climber: &Climber) -> bool {
    climber.state().mode == ClimberMode::Standing
}

struct OnBodies {
    bodies: Bodies,
    before: BodyPoses,
    climber: Climber,
    dt: f64,
}

impl OnBodies {
    fn new(set: &Set) -> Result<Self, Box<dyn Error>> {
        Ok(Self {
            bodies: Bodies::new(set, RigidBodyBuilder::kinematic_position_based)?,
            before: BodyPoses::new(),
            climber: climber(set)?,
            dt: set.dt,
        })
    }
}

impl Controller for OnBodies {
    fn step(&mut self, time: f64, input: &Input) -> Result<f64, Box<dyn Error>> {
        let Bodies { world, moving } = &mut self.bodies;
        self.before.record(&world.bodies);
        for (handle, motion) in moving {
            if let Some(body) = world.bodies.get_mut(*handle) {
                body.set_next_kinematic_position(pose(&motion(time)));
            }
        }
        world.step();
        let terrain = RapierTerrain::of_world(world, &self.before);
        let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &terrain)];
        timed(&mut self.climber, &obstacles, input, self.dt)
    }

    fn position(&self) -> DVec3 {
        self.climber.state().position
    }

    fn stands(&self) -> bool {
        stands(&self.climber)
    }
}

struct OnSkin {
    surfaces: Vec<(SkinnedSurface, Motion)>,
    rest: Palette,
    climber: Climber,
    dt: f64,
}

impl OnSkin {
    fn new(set: &Set) -> Result<Self, Box<dyn Error>> {
        let rest = Palette::from_matrices([Affine::from_f64(&DAffine3::IDENTITY)]);
        let mut surfaces = Vec::new();
        for piece in &set.pieces {
            let mut surface = SkinnedSurface::new(collider(&piece.solid.mesh())?);
            surface.place(&rest, (piece.motion)(0.0))?;
            surfaces.push((surface, piece.motion.clone()));
        }
        Ok(Self {
            surfaces,
            rest,
            climber: climber(set)?,
            dt: set.dt,
        })
    }
}

/// A collider on one joint.
fn collider(mesh: &Mesh) -> Result<Arc<ColliderMesh>, Box<dyn Error>> {
    let positions: Vec<_> = mesh.positions.iter().map(|p| p.as_vec3()).collect();
    let influence = Influence {
        joint: JointId(0),
        weight: 1.0,
    };
    let source = MeshSource {
        positions: &positions,
        triangles: &mesh.triangles,
        influences: &vec![influence; positions.len()],
        influence_ends: &(1..=positions.len() as u32).collect::<Vec<_>>(),
        tags: &vec![SurfaceTag::default(); mesh.triangles.len()],
        joint_count: 1,
        ..MeshSource::default()
    };
    let (collider, _) = ColliderMesh::build(&source, &BuildOptions::default())?;
    Ok(Arc::new(collider))
}

impl Controller for OnSkin {
    fn step(&mut self, time: f64, input: &Input) -> Result<f64, Box<dyn Error>> {
        for (surface, motion) in &mut self.surfaces {
            surface.advance(&self.rest, motion(time))?;
        }
        let obstacles = self.surfaces.iter().enumerate();
        let obstacles: Vec<(ObstacleId, &dyn Obstacle)> = obstacles
            .map(|(index, (surface, _))| (ObstacleId(index as u64), surface as &dyn Obstacle))
            .collect();
        timed(&mut self.climber, &obstacles, input, self.dt)
    }

    fn position(&self) -> DVec3 {
        self.climber.state().position
    }

    fn stands(&self) -> bool {
        stands(&self.climber)
    }
}
