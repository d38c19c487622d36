//! One frame of a body, in this order: the support's motion, rotation, walk, clips, the model's place, hands and feet,
//! the body's displacement for them, the final pose, the gaze. [`Update::run`] reads the same way.

mod displacement;
mod gaze;
mod limbs;
mod reached;
mod turning;

use clamber_climber::ClimberMode;
use clamber_surface::rig::Pose;
use glam::{DQuat, DVec3};

pub(crate) use displacement::Displacement;
pub(crate) use gaze::Gaze;
pub(crate) use turning::Turning;

use super::carry::Carry;
use super::climb::Schedule;
use super::context::Context;
use super::event::Plant;
use super::frame::BodyInput;
use super::ground::{Ground, Look};
use super::hold::Surroundings;
use super::memory::{ClimberMemory, Memory};
use super::play::Player;
use super::root::Root;
use super::stance::Stance;
use super::walk::Walk;
use crate::figure::Place;
use crate::{BodyError, Extremity, Figure};

/// A climber was teleported if it is farther from its expected position than this share of the leg's length plus the
/// distance by [`TELEPORT_STEPS`].
const TELEPORT_DISTANCE: f64 = 1.0;

/// This many times the distance at the last and the current speed together is added to [`TELEPORT_DISTANCE`].
const TELEPORT_STEPS: f64 = 3.0;

/// Largest depth of a step down, as a share of the leg's length.
const STEP_DOWN: f64 = 0.5;

/// Longest time for which a body counts as standing during a step down, seconds.
const STEP_DOWN_TIME: f64 = 0.3;

/// One frame of one body: the data that its phases read.
pub(crate) struct Update<'a> {
    figure: &'a Figure,
    frame: &'a BodyInput<'a>,
    dt: f64,
    up: DVec3,
    stance: Stance,
    /// Seconds since the climber left the ground in a step down; 0 otherwise.
    in_air: f64,
    carry: Carry,
    /// The memory of the last frame; `None` in the first frame and after a teleport.
    memory: Option<Memory>,
}

/// The model's place before hands and feet are in place.
struct Placed {
    ground: Ground,
    displacement: Displacement,
    /// The stance's own place.
    target: Root,
    /// The stance's place with the level part of the displacement.
    stand: Root,
    /// The stance's place with the displacement.
    root: Root,
}

impl<'a> Update<'a> {
    pub(crate) fn new(
        figure: &'a Figure,
        frame: &'a BodyInput<'a>,
        dt: f64,
        memory: Option<Memory>,
    ) -> Self {
        let state = frame.state;
        let carrier = memory.and_then(|memory| memory.climber.carrier);
        let carry = carrier.and_then(|carrier| Carry::by(&carrier, frame.obstacles, dt));
        let carry = carry.unwrap_or(Carry::along(state.base_velocity * dt));
        let speed = (state.velocity - state.base_velocity).length();
        let is_here = |memory: &Memory| {
            let expected = carry.point(memory.climber.position);
            let most = TELEPORT_DISTANCE * figure.leg_length()
                + TELEPORT_STEPS * (speed + memory.climber.motion.length()) * dt;
            state.position.distance(expected) <= most
        };
        let memory = memory.filter(is_here);
        let mut update = Self {
            figure,
            frame,
            dt,
            up: frame.config.up(),
            stance: Stance::of(state),
            in_air: 0.0,
            carry,
            memory,
        };
        update.step_down();
        update
    }

    /// Keeps a body upright that steps down from a low edge, although the climber falls.
    fn step_down(&mut self) {
        let state = self.frame.state;
        let Some(memory) = &self.memory else {
            return;
        };
        let falls = state.mode == ClimberMode::Falling && !state.flying.jumping;
        if !falls || memory.stance != Stance::Upright {
            return;
        }
        self.in_air = memory.in_air + self.dt;
        let below = self.frame.config.body.radius + STEP_DOWN * self.figure.leg_length();
        let ground = self.around().cast(state.position, -self.up, below);
        if self.in_air < STEP_DOWN_TIME && ground.is_some() {
            self.stance = Stance::Upright;
        }
    }

    /// Poses the body and returns the memory of this frame.
    pub(crate) fn run(
        self,
        player: &mut Player,
        pose: &mut Pose,
        plants: &mut Vec<Plant>,
    ) -> Result<Memory, BodyError> {
        let state = self.frame.state;
        if self.memory.is_none() {
            player.restart();
        }
        let motion = self.motion();
        let turning = self.turned(motion);
        let walk = self.walk(turning.rotation(), motion);
        let before = self.memory.map_or(self.stance, |memory| memory.stance);
        let stances = [before, self.stance];
        player.step(self.figure, state, stances, &walk, pose, self.dt)?;
        let context = self.context(pose, motion);
        let placed = self.place(turning.rotation(), motion);
        let mut limbs = self.limbs(&context, &placed);
        let shoulders = self.shoulders(pose, &placed.root);
        let held = self.held();
        let schedule = Schedule {
            context: &context,
            goals: self.goals(&context, &placed.target, player.busy_hands(), &limbs),
            shoulders,
            root: &placed.root,
            motion: self.climbing(motion),
            held: state
                .support
                .map_or(state.position, |support| support.attachment.point),
            since: held,
            hangs: self.stance == Stance::Hang,
        };
        let climb = self.step_limbs(&schedule, &placed.stand, &walk, &mut limbs, plants);
        let reached = self.reach(&schedule, &placed.stand, &walk, &mut limbs);
        let root = reached.root;
        let legs = self.legs(&context, pose, &root);
        self.pose_limbs(&context, pose, &reached, (&legs, &shoulders), &mut limbs)?;
        let gaze = self.look(pose, &root)?;
        Ok(Memory {
            climber: ClimberMemory {
                carrier: state.support.map(|support| support.attachment),
                position: state.position,
                base: state.base_velocity,
                motion,
                full_motion: state.velocity - state.base_velocity,
            },
            stance: self.stance,
            held,
            in_air: self.in_air,
            root,
            velocity: self.velocity(&root),
            turning,
            displacement: placed.displacement,
            ground: placed.ground,
            drop: reached.drop,
            pull: reached.pull,
            walk,
            climb,
            legs,
            gaze,
            limbs,
            scale: self.figure.scale(),
        })
    }

    /// The memory of the last frame, unless the stance has changed since.
    fn kept(&self) -> Option<&Memory> {
        self.memory
            .as_ref()
            .filter(|memory| memory.stance == self.stance)
    }

    /// Seconds since the hands took hold.
    fn held(&self) -> f64 {
        let held = self.memory.filter(|memory| memory.stance.is_held());
        held.map_or(0.0, |memory| memory.held + self.dt)
    }

    /// The climber's velocity relative to its support; on a wall, its part along the skin.
    fn motion(&self) -> DVec3 {
        let state = self.frame.state;
        let motion = state.velocity - state.base_velocity;
        match (&state.support, self.stance) {
            (Some(support), Stance::Wall) => {
                let normal = support.normal_in_world();
                motion - normal * motion.dot(normal)
            }
            _ => motion,
        }
    }

    /// The climbing velocity along the held wall or ledge. 0 while hanging or pulling up: the hands stay on their
    /// holds.
    fn climbing(&self, motion: DVec3) -> DVec3 {
        let state = self.frame.state;
        let aside = self.up.cross(state.heading);
        match self.stance {
            Stance::Wall => motion,
            Stance::Ledge if state.ledge_hanging.pull_up == 0.0 => aside * aside.dot(motion),
            _ => DVec3::ZERO,
        }
    }

    fn level(&self, vector: DVec3) -> DVec3 {
        vector - self.up * vector.dot(self.up)
    }

    fn walk(&self, rotation: DQuat, motion: DVec3) -> Walk {
        let facing = self.figure.humanoid().facing;
        let directions = [facing, DVec3::Y.cross(facing)].map(|axis| rotation * axis);
        let level = if self.stance == Stance::Upright {
            self.level(motion)
        } else {
            DVec3::ZERO
        };
        match &self.memory {
            Some(memory) => {
                let mut walk = memory.walk;
                let slope = memory.ground.slope(memory.climber.motion.length());
                walk.step(self.figure, level, directions, slope, self.dt);
                walk
            }
            None => {
                let mut walk = Walk::standing(self.figure);
                // After 10 s all mixes have settled.
                walk.step(self.figure, level, directions, 0.0, 10.0);
                walk.phase = 0.0;
                walk
            }
        }
    }

    /// The model's place in its stance, turned by `rotation`.
    fn place(&self, rotation: DQuat, motion: DVec3) -> Placed {
        let kept = self.kept_displacement();
        let aside = kept.map_or(DVec3::ZERO, |kept| self.level(kept.value()));
        let ground = self.ground(motion, aside);
        let target = self.stance.root(
            self.figure,
            self.frame.state,
            self.frame.config,
            rotation,
            ground.height(),
        );
        let displacement = kept.unwrap_or_else(|| self.new_displacement(&target, motion));
        let at = |offset: DVec3| Root {
            position: target.position + offset,
            ..target
        };
        Placed {
            ground,
            displacement,
            target,
            stand: at(self.level(displacement.value())),
            root: at(displacement.value()),
        }
    }

    fn context(&self, pose: &Pose, motion: DVec3) -> Context<'a> {
        let (skeleton, scale) = (self.figure.skeleton(), self.figure.scale());
        let clip = Extremity::ALL.map(|extremity| {
            let place = self.figure.limb(extremity).place(skeleton, pose, scale);
            place.unwrap_or(Place {
                position: DVec3::ZERO,
                rotation: DQuat::IDENTITY,
            })
        });
        Context {
            figure: self.figure,
            state: self.frame.state,
            around: self.around(),
            up: self.up,
            motion,
            is_fresh: self.memory.is_none(),
            dt: self.dt,
            clip,
        }
    }

    fn around(&self) -> Surroundings<'a> {
        Surroundings {
            obstacles: self.frame.obstacles,
            dt: self.dt,
        }
    }

    fn ground(&self, motion: DVec3, aside: DVec3) -> Ground {
        let state = self.frame.state;
        let bottom = state.position + aside - self.up * self.frame.config.body.radius;
        let around = self.around();
        let look = Look {
            around: &around,
            up: self.up,
            bottom,
            velocity: self.level(motion),
            leg: self.figure.leg_length(),
        };
        match &self.memory {
            _ if self.stance != Stance::Upright => Ground::default(),
            Some(memory) if memory.stance == Stance::Upright => {
                let mut ground = memory.ground;
                let was = memory.root.position;
                ground.step(&look, (self.carry.point(was) - was).dot(self.up), self.dt);
                ground
            }
            _ => Ground::at(&look),
        }
    }

    fn velocity(&self, root: &Root) -> DVec3 {
        match &self.memory {
            Some(memory) if self.dt > 0.0 => {
                (root.position - self.carry.point(memory.root.position)) / self.dt
            }
            Some(memory) => memory.velocity,
            None => self.frame.state.velocity - self.frame.state.base_velocity,
        }
    }
}
