//! One frame of a body: what carries it, how it stands, where hands and feet are, and the pose that follows.

use clamber_animation::{RotationSpring, Spring, joint_in_model};
use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_surface::rig::Pose;
use glam::{DQuat, DVec3};

use super::carry::Carry;
use super::climb::{Climb, Schedule};
use super::context::Context;
use super::event::Plant;
use super::frame::BodyFrame;
use super::ground::{Ground, Look};
use super::hold::Surroundings;
use super::legs::Legs;
use super::limb::{Doing, LimbMemory};
use super::memory::Memory;
use super::play::Player;
use super::reach::{self, Tie};
use super::root::{Root, facing_to};
use super::solve::{self, Wanted};
use super::stance::Stance;
use super::walk::Walk;
use super::{feet, goals};
use crate::figure::Place;
use crate::{BodyError, Extremity, Figure};

/// Times for half of a turn of the body, and of a difference between two stances, seconds.
const TURN: f64 = 0.11;
const OFFSET: f64 = 0.09;

/// The fastest difference between two stances that is kept, metres a second: a body that lands from higher goes down as far.
const FASTEST: f64 = 9.0;

/// Time over which a change of velocity is leaned into, seconds; the lean per change, radians for a metre a second, and
/// the most of it.
const LEANS: f64 = 0.18;
const LEAN: f64 = 0.05;
const MOST_LEAN: f64 = 0.16;

/// A climber that is farther from where it was expected than this share of the leg, and this many times its way, was
/// teleported.
const TELEPORT: f64 = 1.0;
const WAYS: f64 = 3.0;

/// How fast a tumbling body rolls at most, radians a second.
const ROLLS: f64 = 8.0;

/// Time for half of a change of the gaze's weight, seconds.
const GAZE: f64 = 0.15;

/// Softness of limbs on their way, and how far from its clip a limb is reached like that, metres.
const SOFT: f64 = 0.03;
const SOFT_WITHIN: f64 = 0.05;

/// A free limb within this distance of its clip is left to it, metres.
const AT_CLIP: f64 = 1e-3;

pub(crate) struct Update<'a> {
    figure: &'a Figure,
    frame: &'a BodyFrame<'a>,
    dt: f64,
    up: DVec3,
    stance: Stance,
    carry: Carry,
    /// Of the last frame; `None` in the first, and after a teleport.
    memory: Option<Memory>,
}

impl<'a> Update<'a> {
    pub(crate) fn new(
        figure: &'a Figure,
        frame: &'a BodyFrame<'a>,
        dt: f64,
        memory: Option<Memory>,
    ) -> Self {
        let state = frame.state;
        let carrier = memory.and_then(|memory| memory.carrier);
        let carry = carrier.and_then(|carrier| Carry::by(&carrier, frame.obstacles, dt));
        let carry = carry.unwrap_or(Carry::along(state.base_velocity * dt));
        let speed = (state.velocity - state.base_velocity).length();
        let is_here = |memory: &Memory| {
            let expected = carry.point(memory.position);
            let most =
                TELEPORT * figure.leg_length() + WAYS * (speed + memory.motion.length()) * dt;
            state.position.distance(expected) <= most
        };
        Self {
            figure,
            frame,
            dt,
            up: frame.config.up(),
            stance: Stance::of(state),
            carry,
            memory: memory.filter(is_here),
        }
    }

    pub(crate) fn run(
        self,
        player: &mut Player,
        pose: &mut Pose,
        plants: &mut Vec<Plant>,
    ) -> Result<Memory, BodyError> {
        let state = self.frame.state;
        let motion = self.motion();
        if self.memory.is_none() {
            player.restart();
        }
        let before = self.memory.map_or(self.stance, |memory| memory.stance);
        let (turn, slow) = self.turned(motion);
        let walk = self.walk(turn.rotation, motion);
        player.step(
            self.figure,
            state,
            [before, self.stance],
            &walk,
            pose,
            self.dt,
        )?;
        let context = self.context(pose, motion);
        let ground = self.ground(motion);
        let target = self.stance.root(
            self.figure,
            state,
            self.frame.config,
            turn.rotation,
            ground.height(),
        );
        let offset = self.offset(&target, motion);
        let level = offset.value - self.up * offset.value.dot(self.up);
        let stand = Root {
            position: target.position + level,
            ..target
        };
        let mut root = Root {
            position: target.position + offset.value,
            ..target
        };
        let mut limbs = self.limbs(&context, &root);
        self.leave(&context, &root, &mut limbs);
        let shoulders = self.shoulders(pose, &root);
        let mut climb = self.memory.map_or(Climb::default(), |memory| memory.climb);
        let since = self.memory.map_or(0.0, |memory| memory.since + self.dt);
        let since = if before == self.stance { since } else { 0.0 };
        if self.stance.is_held() {
            let mut goals = goals::goals(&context, self.stance, &target);
            for (goal, busy) in goals.iter_mut().zip(player.busy_hands()) {
                *goal = goal.filter(|_| !busy);
            }
            let held_since = if before.is_held() && before != self.stance {
                ENTERED
            } else {
                since
            };
            let schedule = Schedule {
                context: &context,
                goals,
                shoulders,
                root: &root,
                since: held_since,
            };
            climb.step(&schedule, &mut limbs, plants);
        } else if self.stance == Stance::Upright {
            feet::step(&context, &stand, &walk, &mut limbs, plants);
        }
        // Where hands and feet have to be, whatever the body does.
        let mut ends: [Option<Place>; 4] = [None; 4];
        for extremity in Extremity::ALL {
            let limb = &limbs[extremity.index()];
            ends[extremity.index()] = match (&limb.doing, extremity) {
                (_, Extremity::Foot(side)) if self.stance == Stance::Upright => {
                    Some(feet::place(&context, &stand, limb, side))
                }
                (Doing::Free, _) => None,
                (Doing::Planted(hold), _) => Some(limb.kept(&hold.place())),
                (Doing::Swinging(swing), _) => Some(swing.place()),
            };
        }
        let tie = |index: usize, share: f64| {
            let end = ends[index]?;
            let is_on = !matches!(limbs[index].doing, Doing::Free);
            let reach = share * self.figure.limb(Extremity::ALL[index]).length;
            is_on.then_some(Tie {
                root: shoulders[index],
                end: end.position,
                reach,
            })
        };
        let size = context.size();
        let mut drop = 0.0;
        if self.stance == Stance::Upright {
            let was = self
                .memory
                .filter(|_| before == self.stance)
                .map_or(0.0, |memory| memory.drop);
            let needed = reach::needed_drop(&[tie(2, reach::LEG), tie(3, reach::LEG)], self.up);
            drop = if context.is_fresh {
                needed
            } else {
                reach::dropped(was, needed, size, self.dt)
            };
            root.position -= self.up * drop;
        } else if self.stance.is_held() {
            let ties = [
                tie(0, reach::ARM),
                tie(1, reach::ARM),
                tie(2, reach::LEG),
                tie(3, reach::LEG),
            ];
            root.position += reach::pulled(&ties, size);
        }
        let legs = self.legs(&context, pose, &root, before);
        let down = root.rotation * DVec3::NEG_Y;
        let swings = matches!(self.stance, Stance::Hang | Stance::Ledge);
        for extremity in Extremity::ALL {
            let index = extremity.index();
            let limb = &mut limbs[index];
            let shape = self.figure.limb(extremity);
            let place = match ends[index] {
                Some(place) => place,
                None => {
                    let mut clip = context.clip_in_world(&root, extremity);
                    if swings && !extremity.is_hand() {
                        let hip =
                            shoulders[index] + (root.position - (target.position + offset.value));
                        let turn = legs.turn(down);
                        clip.position = hip + turn * (clip.position - hip);
                        clip.rotation = turn * clip.rotation;
                    }
                    limb.kept(&clip)
                }
            };
            let is_free = matches!(limb.doing, Doing::Free);
            let far = limb.kept_distance();
            let as_clip = is_free
                && ends[index].is_none()
                && far < AT_CLIP
                && !(swings && !extremity.is_hand());
            let shown = if as_clip {
                limb.pole.forget();
                context.clip_in_world(&root, extremity)
            } else {
                let soft = match limb.doing {
                    Doing::Planted(_) => 1.0,
                    Doing::Swinging(_) => 1.0 - SOFT,
                    Doing::Free => 1.0 - SOFT * (far / (SOFT_WITHIN * size)).min(1.0),
                };
                let wanted = Wanted { place, soft };
                solve::limb(
                    self.figure,
                    pose,
                    &root,
                    shape,
                    &wanted,
                    (&mut limb.pole, self.dt),
                )?
            };
            if context.is_fresh {
                limb.shown = shown;
            } else {
                limb.show(shown, self.dt);
            }
        }
        let mut memory = Memory {
            carrier: state.support.map(|support| support.attachment),
            position: state.position,
            stance: self.stance,
            since,
            velocity: self.velocity(&root),
            base: state.base_velocity,
            root,
            turn,
            offset,
            ground,
            drop,
            slow,
            motion,
            walk,
            climb,
            legs,
            look: self
                .memory
                .map_or_else(Default::default, |memory| memory.look),
            look_weight: self
                .memory
                .map_or(Spring::at(0.0), |memory| memory.look_weight),
            look_at: self.memory.map_or(DVec3::ZERO, |memory| memory.look_at),
            limbs,
            scale: self.figure.scale(),
        };
        self.look(pose, &mut memory)?;
        Ok(memory)
    }

    /// The climber's velocity relative to what carries it, along the ground or the skin.
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

    fn level(&self, vector: DVec3) -> DVec3 {
        vector - self.up * vector.dot(self.up)
    }

    /// How the body is turned, and the velocity that it has settled to.
    fn turned(&self, motion: DVec3) -> (RotationSpring, Spring<DVec3>) {
        let state = self.frame.state;
        let facing = self.figure.humanoid().facing;
        let [ahead, above] = self.stance.directions(state, self.up);
        let mut wanted = facing_to(facing, ahead, above);
        let level = self.level(motion);
        let Some(memory) = &self.memory else {
            return (RotationSpring::at(wanted), Spring::at(level));
        };
        let mut slow = memory.slow;
        slow.value = self.carry.vector(slow.value);
        slow.velocity = self.carry.vector(slow.velocity);
        slow.step(level, LEANS, self.dt);
        let mut turn = memory.turn;
        turn.rotation = self.carry.rotation(turn.rotation);
        turn.velocity = self.carry.vector(turn.velocity);
        if self.stance == Stance::Upright {
            let change = level - slow.value;
            let angle = (LEAN * change.length()).min(MOST_LEAN);
            let axis = self.up.cross(change).try_normalize();
            wanted = axis.map_or(wanted, |axis| {
                rotation_from_axis_angle(axis, angle) * wanted
            });
        }
        if self.stance == Stance::Tumble {
            // Over, in the direction of motion.
            let rate = (level.length() / self.frame.config.body.radius).min(ROLLS);
            let axis = self.up.cross(level).normalize_or(turn.rotation * DVec3::X);
            turn.rotation =
                (rotation_from_axis_angle(axis, rate * self.dt) * turn.rotation).normalize();
            turn.velocity = DVec3::ZERO;
        } else {
            turn.step(wanted, TURN, self.dt);
        }
        (turn, slow)
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
                walk.step(self.figure, level, directions, self.dt);
                walk
            }
            None => {
                let mut walk = Walk::standing(self.figure);
                // Long enough for every mix.
                walk.step(self.figure, level, directions, 10.0);
                walk.phase = 0.0;
                walk
            }
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

    fn ground(&self, motion: DVec3) -> Ground {
        let state = self.frame.state;
        let bottom = state.position - self.up * self.frame.config.body.radius;
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

    /// The difference between where the model is shown and where its stance has it.
    fn offset(&self, target: &Root, motion: DVec3) -> Spring<DVec3> {
        let Some(memory) = &self.memory else {
            return Spring::default();
        };
        if memory.stance == self.stance {
            let mut offset = memory.offset;
            offset.value = self.carry.vector(offset.value);
            offset.velocity = self.carry.vector(offset.velocity);
            offset.step(DVec3::ZERO, OFFSET, self.dt);
            return offset;
        }
        // It goes on as it did, and comes to rest at its new place.
        let velocity =
            self.carry.vector(memory.velocity) + memory.base - self.frame.state.base_velocity;
        let expected = self.carry.point(memory.root.position) + velocity * self.dt;
        Spring {
            value: expected - target.position,
            velocity: (velocity - motion).clamp_length_max(FASTEST),
        }
    }

    fn limbs(&self, context: &Context<'_>, root: &Root) -> [LimbMemory; 4] {
        let Some(memory) = &self.memory else {
            return Extremity::ALL
                .map(|extremity| LimbMemory::at(context.clip_in_world(root, extremity)));
        };
        let mut limbs = memory.limbs;
        for limb in &mut limbs {
            limb.carry(&self.carry);
            limb.advance(self.dt);
        }
        limbs
    }

    /// Takes hands and feet from what another stance had them on.
    fn leave(&self, context: &Context<'_>, root: &Root, limbs: &mut [LimbMemory; 4]) {
        let Some(memory) = &self.memory else {
            return;
        };
        let has_changed = memory.stance != self.stance;
        for extremity in Extremity::ALL {
            let keeps = match extremity {
                Extremity::Hand(_) => self.stance.is_held(),
                Extremity::Foot(_) if has_changed => {
                    self.stance.is_held() && memory.stance.is_held()
                }
                Extremity::Foot(_) => self.stance.is_held() || self.stance == Stance::Upright,
            };
            let limb = &mut limbs[extremity.index()];
            let clip = context.clip_in_world(root, extremity);
            if has_changed && matches!(limb.doing, Doing::Free) {
                limb.keep(&clip);
            }
            if !keeps && !matches!(limb.doing, Doing::Free) {
                limb.let_go(&clip);
            }
        }
    }

    /// Where shoulders and hips are in the clip's pose.
    fn shoulders(&self, pose: &Pose, root: &Root) -> [DVec3; 4] {
        Extremity::ALL.map(|extremity| {
            let joint = self.figure.limb(extremity).upper;
            let model = joint_in_model(self.figure.skeleton(), pose, joint).unwrap_or_default();
            root.point(model.translation * self.figure.scale())
        })
    }

    fn legs(&self, context: &Context<'_>, pose: &Pose, root: &Root, before: Stance) -> Legs {
        let hips = joint_in_model(self.figure.skeleton(), pose, self.figure.humanoid().hips);
        let hips = root.point(hips.unwrap_or_default().translation * self.figure.scale());
        let down = root.rotation * DVec3::NEG_Y;
        let leg = self.figure.leg_length();
        match &self.memory {
            Some(memory) if matches!(before, Stance::Hang | Stance::Ledge) => {
                let mut legs = memory.legs;
                legs.step(hips, down, self.frame.config.gravity, leg, self.dt);
                legs
            }
            Some(memory) => Legs::at_rest(hips, down, memory.velocity + memory.base, leg),
            None => Legs::at_rest(hips, down, context.state.velocity, leg),
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

    /// Turns the head to what it looks at.
    fn look(&self, pose: &mut Pose, memory: &mut Memory) -> Result<(), BodyError> {
        let goal = if self.frame.look_at.is_some() {
            1.0
        } else {
            0.0
        };
        if let Some(target) = self.frame.look_at {
            memory.look_at = target;
        } else {
            memory.look_at = self.carry.point(memory.look_at);
        }
        if self.memory.is_none() {
            memory.look_weight = Spring::at(goal);
        } else {
            memory.look_weight.step(goal, GAZE, self.dt);
        }
        let weight = memory.look_weight.value.clamp(0.0, 1.0);
        if weight > 1e-3 {
            let target = memory.root.inverse_point(memory.look_at) / self.figure.scale();
            let skeleton = self.figure.skeleton();
            self.figure
                .look()
                .solve(skeleton, pose, target, weight, &mut memory.look, self.dt)?;
        }
        Ok(())
    }
}

/// Seconds after which a hold counts as taken: a climber that holds already keeps its rules in another mode.
const ENTERED: f64 = 1.0;
