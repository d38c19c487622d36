//! Where scenarios are played: meshes that move as functions of time, on supports of three kinds.

mod bodies;
mod config;
mod reached;
mod run;
mod shape;
mod skin;

pub(crate) use bodies::Bodies;
pub(crate) use config::{jolt, radians, walker_at};
pub(crate) use reached::{demand, within};
pub(crate) use run::{IDLE, JUMP, Run, Trace, every, walk};
pub(crate) use shape::Shape;
pub(crate) use skin::{Pose, Skin};

use std::rc::Rc;

use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use clamber_world::{Obstacle, ObstacleId};
use glam::{DAffine3, DVec3};

/// A rigid pose as a function of time.
pub(crate) type Motion = Rc<dyn Fn(f64) -> Similarity>;

/// How a mesh is made to move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Played {
    /// A surface whose root moves.
    Root,
    /// A surface whose joint moves, with its root at rest.
    Joint,
    /// A kinematic body of a rapier world.
    Body,
}

/// Everything that a climber can touch, at a time.
pub(crate) struct Stage {
    played: Played,
    pub(crate) dt: f64,
    /// Of the stage in the world.
    pub(crate) origin: DVec3,
    ticks: u32,
    skins: Vec<Skin>,
    bodies: Bodies,
}

/// Ticks at 60 Hz.
pub(crate) const TICK: f64 = 1.0 / 60.0;

impl Stage {
    pub(crate) fn new(played: Played) -> Self {
        Self::at(played, TICK, DVec3::ZERO)
    }

    pub(crate) fn at(played: Played, dt: f64, origin: DVec3) -> Self {
        Self {
            played,
            dt,
            origin,
            ticks: 0,
            skins: Vec::new(),
            bodies: Bodies::new(dt, origin),
        }
    }

    #[must_use]
    pub(crate) fn with_still(self, shape: &Shape) -> Self {
        self.with(shape, |_| Similarity::IDENTITY)
    }

    #[must_use]
    pub(crate) fn with(
        mut self,
        shape: &Shape,
        motion: impl Fn(f64) -> Similarity + 'static,
    ) -> Self {
        let origin = self.origin;
        match self.played {
            Played::Root => {
                let root = move |time: f64| {
                    let mut root = motion(time);
                    root.translation += origin;
                    (vec![DAffine3::IDENTITY], root)
                };
                self.skins
                    .push(Skin::new(shape, &|_| vec![1.0], Box::new(root)));
            }
            Played::Joint => {
                let root = Similarity::from_translation(origin);
                let joint = move |time: f64| (vec![motion(time).to_affine()], root);
                self.skins
                    .push(Skin::new(shape, &|_| vec![1.0], Box::new(joint)));
            }
            Played::Body => self.bodies.add(shape, Rc::new(motion)),
        }
        self
    }

    #[must_use]
    pub(crate) fn with_skin(mut self, skin: Skin) -> Self {
        self.skins.push(skin);
        self
    }

    #[must_use]
    pub(crate) fn with_bodies(mut self, change: impl FnOnce(&mut Bodies)) -> Self {
        change(&mut self.bodies);
        self
    }

    pub(crate) fn time(&self) -> f64 {
        f64::from(self.ticks) * self.dt
    }

    /// Poses everything for the next tick.
    pub(crate) fn advance(&mut self) {
        self.ticks += 1;
        self.hold();
    }

    /// A tick that takes no time.
    pub(crate) fn hold(&mut self) {
        let time = self.time();
        for skin in &mut self.skins {
            skin.advance(time);
        }
        if !self.bodies.is_empty() {
            self.bodies.advance(time);
        }
    }

    pub(crate) fn surface(&self, index: usize) -> &clamber_surface::surface::SkinnedSurface {
        &self.skins[index].surface
    }

    /// What there is to touch: surfaces from 1 on, the rapier world as 0.
    pub(crate) fn obstacles<T>(&self, ask: impl FnOnce(&[(ObstacleId, &dyn Obstacle)]) -> T) -> T {
        let terrain = self.bodies.terrain();
        let mut obstacles: Vec<(ObstacleId, &dyn Obstacle)> = Vec::new();
        if !self.bodies.is_empty() {
            obstacles.push((ObstacleId(0), &terrain));
        }
        for (index, skin) in self.skins.iter().enumerate() {
            obstacles.push((ObstacleId(index as u64 + 1), &skin.surface));
        }
        ask(&obstacles)
    }
}

/// Moves without turning.
pub(crate) fn shifted(by: DVec3) -> Similarity {
    Similarity::from_translation(by)
}

/// Turns about an axis through the origin.
pub(crate) fn turned(axis: DVec3, angle: f64) -> Similarity {
    Similarity {
        rotation: rotation_from_axis_angle(axis, angle),
        ..Similarity::IDENTITY
    }
}
