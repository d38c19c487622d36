//! The stage of a scenario: meshes whose motions are functions of time, as obstacles of four kinds.

mod alike;
mod bodies;
mod config;
mod own;
mod place;
mod reached;
mod run;
mod setting;
mod shape;
mod skin;

pub(crate) use alike::{Allowed, assert_alike};
pub(crate) use bodies::Bodies;
pub(crate) use config::{jolt, radians, tireless, walker_at};
pub(crate) use reached::{demand, within};
pub(crate) use run::{Run, Trace, every};
pub(crate) use setting::{Setting, kinds, one_kind, play};
pub(crate) use shape::Shape;
pub(crate) use skin::{Pose, Skin};

use std::rc::Rc;

use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use clamber_world::{Obstacle, ObstacleId};
use glam::{DAffine3, DVec3};

use own::Own;
use place::{Elsewhere, Place};
use setting::setting;

/// A rigid pose as a function of time.
pub(crate) type Motion = Rc<dyn Fn(f64) -> Similarity>;

/// The kind of obstacle that a mesh becomes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Played {
    /// A surface whose root moves and has the setting's scale.
    #[default]
    Root,
    /// A surface whose joint moves, in a mesh of the setting's scale, with its root at rest in the setting's frame.
    Joint,
    /// A kinematic body of a rapier world.
    Body,
    /// An obstacle of triangles in f64, without any f32.
    Own,
}

/// All obstacles of a scenario at a time.
pub(crate) struct Stage {
    played: Played,
    setting: Setting,
    pub(crate) dt: f64,
    /// Origin of the stage in the world.
    origin: DVec3,
    /// Ticks of the scenario's time, which may be held.
    ticks: u32,
    /// Ticks of the frame's time, which is never held.
    clock: u32,
    skins: Vec<Skin>,
    owns: Vec<Own>,
    bodies: Bodies,
    /// The number in the tag of the shapes that are added next.
    number: u32,
    /// Largest lengths so far.
    reach: Reach,
}

/// Largest lengths that numbers had to hold, metres in the world; in f32 unless stated.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Reach {
    /// Distance of a skin's vertices from its root.
    pub(crate) extent: f64,
    /// Displacement of a root in a tick.
    pub(crate) step: f64,
    /// Distance of a body from rapier's origin.
    pub(crate) place: f64,
    /// Distance of the frame's origin from the world's, in f64.
    pub(crate) far: f64,
}

/// Length of a tick at 60 Hz, seconds.
pub(crate) const TICK: f64 = 1.0 / 60.0;

impl Stage {
    pub(crate) fn new(played: Played) -> Self {
        Self::at(played, TICK, DVec3::ZERO)
    }

    pub(crate) fn at_rate(played: Played, rate: f64) -> Self {
        Self::at(played, 1.0 / rate, DVec3::ZERO)
    }

    pub(crate) fn at(played: Played, dt: f64, origin: DVec3) -> Self {
        let setting = setting();
        Self {
            played,
            setting,
            dt,
            origin,
            ticks: 0,
            clock: 0,
            skins: Vec::new(),
            owns: Vec::new(),
            bodies: Bodies::new(dt, origin, &setting),
            number: 0,
            reach: Reach::default(),
        }
    }

    /// Tags the shapes that are added next with a number.
    #[must_use]
    pub(crate) fn numbered(mut self, number: u32) -> Self {
        self.number = number;
        self.bodies.number = number;
        self
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
        match self.played {
            Played::Root => {
                let root = move |time: f64| (vec![DAffine3::IDENTITY], motion(time));
                self.with_skin(Skin::new(shape, &|_| vec![1.0], Box::new(root)))
            }
            Played::Joint => {
                let scale = self.setting.scale;
                let joint = move |time: f64| {
                    let mut joint = motion(time);
                    joint.translation *= scale;
                    (vec![joint.to_affine()], Similarity::IDENTITY)
                };
                let size = Similarity {
                    scale,
                    ..Similarity::IDENTITY
                };
                let shape = shape.clone().placed(&size);
                self.put(Skin::new(&shape, &|_| vec![1.0], Box::new(joint)), 1.0)
            }
            Played::Body => {
                self.bodies.add(shape, Rc::new(motion));
                self
            }
            Played::Own => {
                let rest = shape.positions.clone();
                let corners = move |time: f64| {
                    let pose = motion(time);
                    rest.iter().map(|p| pose.transform_point(*p)).collect()
                };
                let kind = clamber_world::SurfaceKind::Skin;
                let triangles = shape.triangles.clone();
                let scale = self.setting.scale;
                self.put_own(Own::new(Box::new(corners), triangles, kind, scale))
            }
        }
    }

    /// Adds a skin that deforms, as own triangles where the kind is [`Played::Own`].
    #[must_use]
    pub(crate) fn with_skin(mut self, skin: Skin) -> Self {
        let scale = self.setting.scale;
        if self.played == Played::Body {
            // Bodies cannot deform.
            self.played = Played::Root;
        }
        if self.played == Played::Own {
            self.put_own(skin.into_own(scale))
        } else {
            self.put(skin, scale)
        }
    }

    /// Adds ground at rest: in the rapier world, or as own triangles where the kind is [`Played::Own`].
    #[must_use]
    pub(crate) fn with_ground(self, shape: &Shape) -> Self {
        if self.played == Played::Own {
            self.with_still(shape)
        } else {
            self.with_bodies(|bodies| bodies.add_still(shape))
        }
    }

    #[must_use]
    pub(crate) fn with_bodies(mut self, change: impl FnOnce(&mut Bodies)) -> Self {
        change(&mut self.bodies);
        self
    }

    /// Adds a skin whose root scales by `scale`. In a moving frame it starts with the frame's motion.
    fn put(mut self, skin: Skin, scale: f64) -> Self {
        let mut skin = match self.number {
            0 => skin,
            number => skin.numbered(number),
        };
        let place = self.place();
        skin.place(0.0, scale, place.before);
        if self.setting.frame != DVec3::ZERO {
            skin.advance(0.0, scale, place.now);
        }
        skin.scale = scale;
        self.skins.push(skin);
        self
    }

    fn put_own(mut self, mut own: Own) -> Self {
        own.tag = own.tag.with_user(self.number);
        let place = self.place();
        own.advance(0.0, |p| place.before + p * place.scale);
        own.advance(0.0, |p| place.point(p));
        self.owns.push(own);
        self
    }

    pub(crate) fn time(&self) -> f64 {
        f64::from(self.ticks) * self.dt
    }

    /// The scenario's position in the world, over the tick that ends now.
    pub(crate) fn place(&self) -> Place {
        let at = |tick: f64| self.origin + self.setting.frame * (tick * self.dt);
        let clock = f64::from(self.clock);
        Place {
            scale: self.setting.scale,
            now: at(clock),
            before: at(clock - 1.0),
            velocity: self.setting.frame,
        }
    }

    /// Poses all obstacles for the next tick.
    pub(crate) fn advance(&mut self) {
        self.ticks += 1;
        self.hold();
    }

    /// Poses all obstacles for a tick without advancing the scenario's time.
    pub(crate) fn hold(&mut self) {
        self.clock += 1;
        let (time, place) = (self.time(), self.place());
        self.reach.far = self.reach.far.max(place.now.length());
        for skin in &mut self.skins {
            let (extent, step) = skin.advance(time, skin.scale, place.now);
            self.reach.extent = self.reach.extent.max(extent);
            self.reach.step = self.reach.step.max(step);
        }
        for own in &mut self.owns {
            own.advance(time, |p| place.point(p));
        }
        if !self.bodies.is_empty() {
            self.bodies.advance(time, self.clock);
            self.reach.place = self.reach.place.max(self.bodies.reach());
        }
    }

    pub(crate) fn played(&self) -> Played {
        self.played
    }

    pub(crate) fn reach(&self) -> Reach {
        self.reach
    }

    /// All obstacles, which are queried in the scenario's units and frame.
    pub(crate) fn obstacles<T>(&self, ask: impl FnOnce(&[(ObstacleId, &dyn Obstacle)]) -> T) -> T {
        let there = self.place();
        self.in_world(|obstacles| {
            let mut seen = Vec::new();
            for &(id, inner) in obstacles {
                seen.push((id, Elsewhere { inner, there }));
            }
            ask(&listed(&seen))
        })
    }

    /// All obstacles in the world: the rapier world has id 0, surfaces have ids from 1 on.
    pub(crate) fn in_world<T>(&self, ask: impl FnOnce(&[(ObstacleId, &dyn Obstacle)]) -> T) -> T {
        let terrain = self.bodies.terrain().with_tags(&bodies::tag);
        let mut obstacles: Vec<(ObstacleId, &dyn Obstacle)> = Vec::new();
        if !self.bodies.is_empty() {
            obstacles.push((ObstacleId(0), &terrain));
        }
        let skins = self.skins.iter().map(|skin| &skin.surface as &dyn Obstacle);
        let owns = self.owns.iter().map(|own| own as &dyn Obstacle);
        for (index, obstacle) in skins.chain(owns).enumerate() {
            obstacles.push((ObstacleId(index as u64 + 1), obstacle));
        }
        ask(&obstacles)
    }
}

/// A list of obstacles in the form that a climber takes.
pub(crate) fn listed<T: Obstacle>(owned: &[(ObstacleId, T)]) -> Vec<(ObstacleId, &dyn Obstacle)> {
    let each = owned.iter();
    each.map(|(id, obstacle)| (*id, obstacle as &dyn Obstacle))
        .collect()
}

/// A pure translation.
pub(crate) fn shifted(by: DVec3) -> Similarity {
    Similarity::from_translation(by)
}

/// A rotation about an axis through the origin.
pub(crate) fn turned(axis: DVec3, angle: f64) -> Similarity {
    Similarity {
        rotation: rotation_from_axis_angle(axis, angle),
        ..Similarity::IDENTITY
    }
}
