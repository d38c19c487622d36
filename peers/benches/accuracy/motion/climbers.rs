//! Climbers in the way of a limb, or on a limb.

use std::error::Error;

use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberMode, StepRules};
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource};
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::{DVec3, Vec3};

/// Distance of the ground below the limb's axis, along -Z, metres: the limb swings 5 cm above it.
pub(crate) const GROUND: f64 = 0.55;

/// Number of ticks in which a climber comes to rest.
const SETTLE: usize = 60;

/// Place and support of a climber.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Stance {
    /// The climber floats without gravity, and flies off when the limb strikes it.
    InAir,
    /// The climber stands on the ground below the limb, without input.
    OnGround,
    /// The climber stands on the limb. No acceleration throws it off.
    OnLimb,
    /// The climber grips the limb. No acceleration shakes it off.
    Holding,
}

/// A climber, and the ground below it, if its stance has any.
pub(crate) struct Walker {
    pub(crate) climber: Climber,
    ground: Option<SkinnedSurface>,
    input: ClimberInput,
}

impl Walker {
    pub(crate) fn new(stance: Stance, center: DVec3) -> Result<Self, Box<dyn Error>> {
        let mut config = ClimberConfig::walker();
        match stance {
            Stance::InAir => config.gravity = DVec3::ZERO,
            Stance::OnGround => config.gravity = DVec3::Z * -9.81,
            Stance::OnLimb => config.ground.throw_acceleration = f64::INFINITY,
            Stance::Holding => {
                config = ClimberConfig::colossus_climber();
                config.stamina = None;
                config.tumble = None;
                if let Some(grip) = &mut config.grip {
                    grip.hang_acceleration = f64::INFINITY;
                }
            }
        }
        let ground = match stance {
            Stance::OnGround => Some(ground()?),
            _ => None,
        };
        Ok(Self {
            climber: Climber::new(config, center)?,
            ground,
            input: ClimberInput {
                grip: stance == Stance::Holding,
                ..ClimberInput::default()
            },
        })
    }

    pub(crate) fn tick(&mut self, limb: &SkinnedSurface, dt: f64) -> Result<(), Box<dyn Error>> {
        let limb = (ObstacleId(0), limb as &dyn Obstacle);
        let ground = self.ground.as_ref().map(|ground| ground as &dyn Obstacle);
        let both = [limb, (ObstacleId(1), ground.unwrap_or(limb.1))];
        let there = &both[..1 + usize::from(ground.is_some())];
        self.climber.step_with(
            &self.input,
            there,
            &StepRules::by(&|query| query.usual().with_grip(true)),
            dt,
        )?;
        Ok(())
    }

    /// Steps the climber while the limb does not move. Fails if the climber does not stand or hold on then.
    pub(crate) fn settle(&mut self, limb: &SkinnedSurface, dt: f64) -> Result<(), Box<dyn Error>> {
        let wanted = if self.input.grip {
            ClimberMode::Holding
        } else {
            ClimberMode::Standing
        };
        for _ in 0..SETTLE {
            self.tick(limb, dt)?;
        }
        let state = self.climber.state();
        if state.mode == wanted {
            Ok(())
        } else {
            Err(format!("a climber is not {wanted:?}: {state:?}").into())
        }
    }
}

/// The ground: a square of 60 m, perpendicular to Z.
fn ground() -> Result<SkinnedSurface, Box<dyn Error>> {
    let corners = [(-30.0, -30.0), (30.0, -30.0), (30.0, 30.0), (-30.0, 30.0)];
    let positions = corners.map(|(x, y)| Vec3::new(x, y, -GROUND as f32));
    let source = MeshSource::rigid(&positions, &[[0, 1, 2], [0, 2, 3]]);
    let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default())?;
    let mut ground = SkinnedSurface::new(std::sync::Arc::new(mesh));
    let rest = Palette::from_matrices([Affine::IDENTITY]);
    ground.teleport(&rest, Similarity::IDENTITY)?;
    Ok(ground)
}
