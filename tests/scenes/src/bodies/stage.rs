use std::sync::Arc;

use clamber_climber::{
    Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberState, Knockback, StepRules,
};
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, MeshSource, SurfaceKind, SurfaceTag,
};
use clamber_surface::rig::{Clip, Palette, Playback, Skeleton};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

use crate::SceneError;
use crate::controllers::Solid;

/// A pose as a function of time, seconds.
pub type Motion = Box<dyn Fn(f64) -> Similarity>;

/// Something to stand on or hold.
pub struct Thing {
    pub(super) mesh: Arc<ColliderMesh>,
    pub(super) motion: Motion,
    /// The clip that a creature plays, and how much of its seconds pass in a second.
    pub(super) animation: Option<(Skeleton, Clip, f64)>,
}

impl Thing {
    /// A solid that moves. Fur can be gripped, stone has ledges.
    pub fn solid(
        solid: &Solid,
        kind: SurfaceKind,
        motion: impl Fn(f64) -> Similarity + 'static,
    ) -> Result<Self, SceneError> {
        let mesh = solid.mesh();
        let positions: Vec<_> = mesh.positions.iter().map(|p| p.as_vec3()).collect();
        let source = MeshSource {
            tags: &vec![SurfaceTag::new(kind); mesh.triangles.len()],
            ..MeshSource::rigid(&positions, &mesh.triangles)
        };
        Ok(Self {
            mesh: Arc::new(ColliderMesh::build(&source, &ColliderBuildOptions::default())?.0),
            motion: Box::new(motion),
            animation: None,
        })
    }

    pub(super) fn palette(&self, time: f64) -> Result<Palette, SceneError> {
        let Some((skeleton, clip, rate)) = &self.animation else {
            return Ok(Palette::from_matrices([Affine::IDENTITY]));
        };
        let pose = clip.sample(&skeleton.rest_pose(), time * rate, Playback::Loop)?;
        Ok(skeleton.palette(&pose)?)
    }
}

/// The player's view before a tick.
pub struct Moment<'a> {
    /// Seconds since the start.
    pub time: f64,
    /// The climber.
    pub state: &'a ClimberState,
}

/// The ground and creatures, the climber, and the player's input.
pub struct Scene {
    /// Its name.
    pub name: String,
    /// Its length.
    pub seconds: f64,
    /// The climber.
    pub config: ClimberConfig,
    /// Where the climber's ball starts.
    pub start: DVec3,
    /// What there is; the index is the obstacle's id.
    pub things: Vec<Thing>,
    /// True if all of it can be gripped, and not only fur.
    pub grips_all: bool,
    /// What the player does.
    pub input: Box<dyn Fn(&Moment<'_>) -> ClimberInput>,
    /// A blow that strikes the climber after half a second.
    pub knockback: Option<Knockback>,
}

impl Scene {
    /// A scene of a climber without stamina that can grip fur alone.
    pub(super) fn new(
        name: impl Into<String>,
        seconds: f64,
        start: DVec3,
        things: Vec<Thing>,
        input: impl Fn(&Moment<'_>) -> ClimberInput + 'static,
    ) -> Self {
        let mut config = ClimberConfig::colossus_climber();
        config.stamina = None;
        config.body.height = 0.9;
        Self {
            name: name.into(),
            seconds,
            config,
            start,
            things,
            grips_all: false,
            input: Box::new(input),
            knockback: None,
        }
    }
}

pub(super) fn still(_: f64) -> Similarity {
    Similarity::IDENTITY
}

/// A floor of stone that moves.
pub(super) fn floor(motion: impl Fn(f64) -> Similarity + 'static) -> Result<Thing, SceneError> {
    Thing::solid(&Solid::floor(60.0), SurfaceKind::Stone, motion)
}

/// The direction if the condition holds, or else zero.
pub(super) fn when(condition: bool, direction: DVec3) -> DVec3 {
    if condition { direction } else { DVec3::ZERO }
}

pub(super) fn holding(walk: DVec3, climb: DVec3) -> ClimberInput {
    ClimberInput {
        grip: true,
        walk,
        climb,
        ..ClimberInput::IDLE
    }
}

pub(super) fn walking(walk: DVec3) -> ClimberInput {
    ClimberInput {
        walk,
        ..ClimberInput::IDLE
    }
}

/// A scene that is played.
pub struct Stage<'s> {
    scene: &'s Scene,
    /// What there is, as it is now.
    pub surfaces: Vec<SkinnedSurface>,
    /// The climber.
    pub climber: Climber,
    /// What happened to it in the last tick.
    pub events: Vec<ClimberEvent>,
    /// Seconds since the start.
    pub time: f64,
}

impl<'s> Stage<'s> {
    /// At the start.
    pub fn new(scene: &'s Scene) -> Result<Self, SceneError> {
        let mut surfaces = Vec::new();
        for thing in &scene.things {
            let mut surface = SkinnedSurface::new(thing.mesh.clone());
            surface.teleport(&thing.palette(0.0)?, (thing.motion)(0.0))?;
            surfaces.push(surface);
        }
        Ok(Self {
            scene,
            surfaces,
            climber: Climber::new(scene.config, scene.start)?,
            events: Vec::new(),
            time: 0.0,
        })
    }

    /// What there is, for bodies.
    pub fn obstacles(&self) -> Vec<(ObstacleId, &dyn Obstacle)> {
        obstacles(&self.surfaces)
    }

    /// The palette of a thing now.
    pub fn palette(&self, thing: usize) -> Result<Palette, SceneError> {
        self.scene.things[thing].palette(self.time)
    }

    /// Lets a tick pass: everything moves, then the climber steps. Everything can be gripped that is fur.
    pub fn tick(&mut self, dt: f64) -> Result<(), SceneError> {
        let input = (self.scene.input)(&Moment {
            time: self.time,
            state: self.climber.state(),
        });
        let before = self.time;
        self.time += dt;
        for (thing, surface) in self.scene.things.iter().zip(&mut self.surfaces) {
            surface.advance(&thing.palette(self.time)?, (thing.motion)(self.time))?;
        }
        let obstacles = obstacles(&self.surfaces);
        let mut rules = if self.scene.grips_all {
            StepRules::by(&|query| query.usual().with_grip(true))
        } else {
            StepRules::default()
        };
        if (0.499..0.512).contains(&before) {
            rules.knockback = self.scene.knockback;
        }
        let report = self.climber.step_with(&input, &obstacles, &rules, dt)?;
        self.events = report.events;
        Ok(())
    }
}

fn obstacles(surfaces: &[SkinnedSurface]) -> Vec<(ObstacleId, &dyn Obstacle)> {
    let ids = (0..).map(ObstacleId);
    ids.zip(surfaces.iter().map(|surface| surface as &dyn Obstacle))
        .collect()
}
