//! One frame of a body: the support's motion, the stance, the places of hands and feet, and the final pose.

use clamber_animation::{RotationSpring, Spring, damp, joint_in_model};
use clamber_climber::ClimberMode;
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
use super::limb::{Doing, LimbMemory, soft_half};
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

/// Half time of the body's turn to its stance's rotation, seconds.
const TURN: f64 = 0.11;

/// [`TURN`] on a wall and while hanging, seconds: longer, since hands and feet have to follow around corners.
const TURN_ON_WALL: f64 = 0.22;

/// Least half time in which a displacement between two stances decays, seconds.
const OFFSET: f64 = 0.09;

/// Growth of that half time with the displacement's initial speed, seconds per metre a second.
const OFFSET_PER_SPEED: f64 = 0.0233;

/// Limit of a new displacement's speed, metres a second: a body that lands faster does not go deeper.
const FASTEST: f64 = 9.0;

/// Half time of the low-pass filter on the velocity that a body leans by, seconds.
const LEANS: f64 = 0.18;

/// Lean per change of velocity, radians per metre a second.
const LEAN: f64 = 0.05;

/// Largest lean, radians.
const MOST_LEAN: f64 = 0.16;

/// A climber was teleported if it is farther from its expected position than this share of the leg's length plus the
/// distance by [`WAYS`].
const TELEPORT: f64 = 1.0;

/// This many times the distance at the last and the current speed together is added to [`TELEPORT`].
const WAYS: f64 = 3.0;

/// Largest speed at which a tumbling body rolls, radians a second.
const ROLLS: f64 = 8.0;

/// Half time of a change of that speed, seconds.
const ROLL_TIME: f64 = 0.1;

/// Half time of a change of the gaze's weight, seconds.
const GAZE: f64 = 0.15;

/// Half time of the body's displacement to where all limbs reach, seconds.
const PULLS: f64 = 0.06;

/// Least cosine between up and the normal of level skin.
const FLAT: f64 = 0.94;

/// Largest depth of a step down, as a share of the leg's length.
const STEP_DOWN: f64 = 0.5;

/// Longest time for which a body counts as standing during a step down, seconds.
const STEP_DOWN_TIME: f64 = 0.3;

/// Share of a limb's length over which a limb on its way slows down near its full stretch.
const SOFT: f64 = 0.03;

/// Distance from the clips' pose at which a free limb has all of [`SOFT`], metres.
const SOFT_WITHIN: f64 = 0.05;

/// Distance from the clips' pose within which a free limb follows the clips without inverse kinematics, metres.
const AT_CLIP: f64 = 1e-3;

pub(crate) struct Update<'a> {
    figure: &'a Figure,
    frame: &'a BodyFrame<'a>,
    dt: f64,
    up: DVec3,
    stance: Stance,
    /// Seconds since the climber left the ground in a step down; 0 otherwise.
    in_air: f64,
    carry: Carry,
    /// The memory of the last frame; `None` in the first frame and after a teleport.
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
        let kept = self.kept_offset();
        let aside = kept.map_or(DVec3::ZERO, |offset| self.level(offset.value));
        let ground = self.ground(motion, aside);
        let target = self.stance.root(
            self.figure,
            state,
            self.frame.config,
            turn.rotation,
            ground.height(),
        );
        let offset = kept.unwrap_or_else(|| self.new_offset(&target, motion));
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
        self.leave(&context, [&root, &stand], &mut limbs);
        let shoulders = self.shoulders(pose, &root);
        let mut climb = self.memory.map_or(Climb::default(), |memory| memory.climb);
        let held = self.memory.filter(|_| before.is_held());
        let held = held.map_or(0.0, |memory| memory.held + self.dt);
        let mut goals = goals::goals(&context, self.stance, &target);
        let busy = player.busy_hands();
        for hand in 0..2 {
            // For an act, a hand leaves its hold only when the other hand holds.
            let other_holds = busy[1 - hand] || limbs[1 - hand].is_planted();
            goals[hand] =
                goals[hand].filter(|_| !busy[hand] || !other_holds && limbs[hand].is_planted());
        }
        let shown_before = root;
        let schedule = Schedule {
            context: &context,
            goals,
            shoulders,
            root: &shown_before,
            motion: self.climbing(motion),
            held: state
                .support
                .map_or(state.position, |support| support.attachment.point),
            since: held,
            hangs: self.stance == Stance::Hang,
        };
        if self.stance.is_held() {
            climb.step(&schedule, &mut limbs, plants);
            for limb in &mut limbs {
                if let Doing::Swinging(swing) = &limb.doing {
                    let touching = swing.place().point(swing.to.touching);
                    limb.detour.step(&context, touching);
                }
            }
        } else if self.stance == Stance::Upright {
            let hips = [shoulders[2], shoulders[3]];
            feet::step(&context, &stand, &walk, hips, &mut limbs, plants);
        }
        let mut ends = self.ends(&context, &stand, &limbs);
        let size = context.size();
        let mut drop = 0.0;
        let mut pull = Spring::default();
        if self.stance == Stance::Upright {
            let was = self.memory.filter(|_| before == self.stance);
            let ties = self.ties(&ends, &shoulders);
            let needed = reach::needed_drop(&[ties[2], ties[3]], self.up);
            let was = was.map_or(0.0, |memory| memory.drop);
            drop = if context.is_fresh {
                needed
            } else {
                reach::dropped(was, needed, walk.is_going(), size, self.dt)
            };
            root.position -= self.up * drop;
        } else if self.stance.is_held() {
            pull = self.pull(&context, &stand, &schedule, &mut limbs, &mut ends);
            root.position += pull.value;
            let moved = root.position - shown_before.position;
            for hand in (0..2).filter(|&hand| goals[hand].is_some()) {
                let shoulder = shoulders[hand] + moved;
                ends[hand] = ends[hand]
                    .or_else(|| self.free_hand(&context, &root, hand, shoulder, &mut limbs[hand]));
            }
        }
        let legs = self.legs(&context, pose, &root, before);
        let moved = root.position - shown_before.position;
        let swung = matches!(self.stance, Stance::Hang | Stance::Ledge);
        let swung = swung.then(|| legs.turn(root.rotation * DVec3::NEG_Y));
        let hips = [shoulders[2], shoulders[3]].map(|hip| hip + moved);
        self.pose_limbs(&context, pose, &root, &ends, (swung, hips), &mut limbs)?;
        let mut memory = Memory {
            carrier: state.support.map(|support| support.attachment),
            position: state.position,
            stance: self.stance,
            held,
            in_air: self.in_air,
            velocity: self.velocity(&root),
            base: state.base_velocity,
            root,
            turn,
            offset,
            offset_half: self.offset_half(&offset),
            ground,
            drop,
            pull,
            slow,
            motion,
            full_motion: state.velocity - state.base_velocity,
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

    /// Bends the limbs towards their places. Free limbs follow the clips. Hanging legs are turned by `swung` about
    /// their hips.
    fn pose_limbs(
        &self,
        context: &Context<'_>,
        pose: &mut Pose,
        root: &Root,
        ends: &[Option<Place>; 4],
        (swung, hips): (Option<DQuat>, [DVec3; 2]),
        limbs: &mut [LimbMemory; 4],
    ) -> Result<(), BodyError> {
        for extremity in Extremity::ALL {
            let index = extremity.index();
            let limb = &mut limbs[index];
            let clip = context.clip_in_world(root, extremity);
            let turn = match extremity {
                Extremity::Foot(side) => swung.map(|turn| (turn, hips[side.index()])),
                Extremity::Hand(_) => None,
            };
            let place = ends[index].unwrap_or_else(|| {
                let swung = turn.map_or(clip, |(turn, hip)| Place {
                    position: hip + turn * (clip.position - hip),
                    rotation: (turn * clip.rotation).normalize(),
                });
                limb.kept(&swung)
            });
            let far = limb.kept_distance();
            let shown = if ends[index].is_none() && turn.is_none() && far < AT_CLIP {
                limb.pole.forget();
                clip
            } else {
                let soft = match limb.doing {
                    Doing::Planted(_) => 1.0,
                    // The softness grows gradually, since a limb may be straight when its step begins.
                    Doing::Swinging(swing) => {
                        1.0 - SOFT * (2.0 * swing.time / swing.duration).min(1.0)
                    }
                    Doing::Free => 1.0 - SOFT * (far / (SOFT_WITHIN * context.size())).min(1.0),
                };
                let wanted = Wanted { place, soft };
                let shape = self.figure.limb(extremity);
                let pole = (&mut limb.pole, self.dt);
                solve::limb(self.figure, pose, root, shape, &wanted, pole)?
            };
            if context.is_fresh {
                limb.shown = shown;
            } else {
                limb.show(shown, self.dt);
            }
        }
        Ok(())
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

    /// The body's rotation, and the low-pass filtered level velocity.
    fn turned(&self, motion: DVec3) -> (RotationSpring, Spring<DVec3>) {
        let state = self.frame.state;
        let facing = self.figure.humanoid().facing;
        let [ahead, mut above] = self.stance.directions(state, self.up);
        above = self.crawls().unwrap_or(above);
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
            // The body rolls over in the direction of motion.
            let rate = (level.length() / self.frame.config.body.radius).min(ROLLS);
            let wanted = self.up.cross(level).normalize_or_zero() * rate;
            let roll = damp(turn.velocity, wanted, ROLL_TIME, self.dt);
            let angle = roll.length() * self.dt;
            if angle > 0.0 {
                let turned = rotation_from_axis_angle(roll.normalize(), angle);
                turn.rotation = (turned * turn.rotation).normalize();
            }
            turn.velocity = roll;
        } else {
            let half = match self.stance {
                Stance::Wall | Stance::Hang => TURN_ON_WALL,
                _ => TURN,
            };
            turn.step(wanted, half, self.dt);
        }
        (turn, slow)
    }

    /// Direction of the head on level skin, where no direction along the skin points up: as in the last frame.
    fn crawls(&self) -> Option<DVec3> {
        let support = self.frame.state.support.as_ref()?;
        let normal = support.normal_in_world();
        if self.stance != Stance::Wall || normal.dot(self.up) < FLAT {
            return None;
        }
        let before = self.memory.filter(|memory| memory.stance == Stance::Wall)?;
        let head = self.carry.rotation(before.turn.rotation) * DVec3::Y;
        (head - normal * head.dot(normal)).try_normalize()
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
                let slope = memory.ground.slope(memory.motion.length());
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

    /// The rest of the displacement between the model's shown place and its stance's place; `None` in a new stance and
    /// in the first frame.
    fn kept_offset(&self) -> Option<Spring<DVec3>> {
        let memory = self.memory.filter(|memory| memory.stance == self.stance)?;
        let mut offset = memory.offset;
        offset.value = self.carry.vector(offset.value);
        offset.velocity = self.carry.vector(offset.velocity);
        let state = self.frame.state;
        let motion = state.velocity - state.base_velocity;
        // The model lags behind changes of the climber's velocity, except those by gravity.
        let falls = matches!(self.stance, Stance::Air | Stance::Tumble);
        let gravity = if falls {
            self.frame.config.gravity
        } else {
            DVec3::ZERO
        };
        let expected = self.carry.vector(memory.full_motion) + gravity * self.dt;
        let change = expected - motion;
        if self.stance == Stance::Upright {
            offset.velocity += self.level(change);
            // A step up or a push displaces the climber at once. The model follows softly.
            let expected = self.carry.point(memory.position) + self.level(motion) * self.dt;
            offset.value += self.level(expected - state.position);
        } else {
            offset.velocity += change;
        }
        offset.step(DVec3::ZERO, memory.offset_half, self.dt);
        Some(offset)
    }

    /// The displacement at the start of a stance. It lets the model's motion continue.
    fn new_offset(&self, target: &Root, motion: DVec3) -> Spring<DVec3> {
        let Some(memory) = &self.memory else {
            return Spring::default();
        };
        // The model keeps its velocity at first, and the spring brings it to rest at its new place.
        let velocity =
            self.carry.vector(memory.velocity) + memory.base - self.frame.state.base_velocity;
        let expected = self.carry.point(memory.root.position) + velocity * self.dt;
        Spring {
            value: expected - target.position,
            velocity: (velocity - motion).clamp_length_max(FASTEST),
        }
    }

    /// Half time of the displacement, seconds. It is longer after a hard change of velocity, so that the body gives way
    /// softly.
    fn offset_half(&self, offset: &Spring<DVec3>) -> f64 {
        match &self.memory {
            Some(memory) if memory.stance == self.stance => memory.offset_half,
            _ => OFFSET
                .max(OFFSET_PER_SPEED * offset.velocity.length())
                .max(soft_half(offset.value.length())),
        }
    }

    fn limbs(&self, context: &Context<'_>, root: &Root) -> [LimbMemory; 4] {
        let Some(memory) = &self.memory else {
            return Extremity::ALL
                .map(|extremity| LimbMemory::at(context.clip_in_world(root, extremity)));
        };
        let mut limbs = memory.limbs;
        for limb in &mut limbs {
            limb.carry(&self.carry, memory.velocity);
            limb.advance(self.dt);
        }
        limbs
    }

    /// Takes hands and feet off the holds of another stance.
    fn leave(&self, context: &Context<'_>, [root, stand]: [&Root; 2], limbs: &mut [LimbMemory; 4]) {
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
            let mut clip = context.clip_in_world(root, extremity);
            if has_changed && !extremity.is_hand() {
                if self.stance == Stance::Upright {
                    clip = context.clip_in_world(stand, extremity);
                    limb.ground = Spring::default();
                    limb.tilt = Spring::at(self.up);
                }
                limb.keep(&clip);
            }
            if !keeps && !matches!(limb.doing, Doing::Free) {
                limb.let_go(&clip);
            }
        }
    }

    /// The displacement of the body by which hands and feet reach their holds. While limbs are out of reach, the one
    /// that is farthest out of reach is let go. The last hand stays longer: limbs on their way are let go before it,
    /// then feet.
    fn pull(
        &self,
        context: &Context<'_>,
        stand: &Root,
        schedule: &Schedule<'_, '_>,
        limbs: &mut [LimbMemory; 4],
        ends: &mut [Option<Place>; 4],
    ) -> Spring<DVec3> {
        let size = context.size();
        let mut ties = self.ties(ends, &schedule.shoulders);
        let mut wanted = DVec3::ZERO;
        // Each limb is let go at most twice: once on its way, and once from its hold.
        for _ in 0..2 * Extremity::ALL.len() {
            wanted = reach::pulled(DVec3::ZERO, &ties, size);
            let Some(worst) = reach::out_of_reach(&ties, wanted) else {
                break;
            };
            let is_last_hand = worst < 2 && !limbs[1 - worst].is_planted();
            let on_its_way =
                (0..4).find(|index| ties[*index].is_some() && !limbs[*index].is_planted());
            let foot = (2..4).find(|index| ties[*index].is_some());
            let dropped = match (on_its_way, foot) {
                (Some(index), _) if is_last_hand || index == worst => index,
                (None, Some(foot)) if is_last_hand => foot,
                _ => worst,
            };
            if limbs[dropped].is_planted() {
                schedule.replace(dropped, limbs);
                *ends = self.ends(context, stand, limbs);
            }
            ties[dropped] = None;
        }
        if context.is_fresh {
            return Spring::at(wanted);
        }
        // The pull changes softly, since limbs come and go, but planted limbs stay within reach in each frame. In a new
        // stance the pull starts at 0: the displacement between the stances contains the rest of it.
        let kept = self.memory.filter(|memory| memory.stance == self.stance);
        let mut pull = kept.map_or(Spring::default(), |memory| memory.pull);
        pull.value = self.carry.vector(pull.value);
        pull.velocity = self.carry.vector(pull.velocity);
        pull.step(wanted, PULLS * size.sqrt(), self.dt);
        for (tie, limb) in ties.iter_mut().zip(limbs.iter()) {
            *tie = tie.filter(|_| limb.is_planted());
        }
        pull.value = reach::pulled(pull.value, &ties, size);
        pull
    }

    /// The places of hands and feet that do not move with the body. `None` for limbs that follow the clips.
    fn ends(
        &self,
        context: &Context<'_>,
        stand: &Root,
        limbs: &[LimbMemory; 4],
    ) -> [Option<Place>; 4] {
        Extremity::ALL.map(|extremity| {
            let limb = &limbs[extremity.index()];
            match (&limb.doing, extremity) {
                (_, Extremity::Foot(side)) if self.stance == Stance::Upright => {
                    Some(feet::place(context, stand, limb, side))
                }
                (Doing::Free, _) => None,
                (Doing::Planted(hold), _) => Some(limb.kept(&hold.place())),
                (Doing::Swinging(swing), _) => Some(limb.detour.lead(swing)),
            }
        })
    }

    /// The place of a hand without a hold that is led out of an obstacle. `None` if the hand needs no displacement.
    fn free_hand(
        &self,
        context: &Context<'_>,
        root: &Root,
        hand: usize,
        shoulder: DVec3,
        limb: &mut LimbMemory,
    ) -> Option<Place> {
        let extremity = Extremity::ALL[hand];
        let shape = self.figure.limb(extremity);
        let mut place = limb.kept(&context.clip_in_world(root, extremity));
        let way = place.position - shoulder;
        place.position = shoulder + way.clamp_length_max(shape.length);
        limb.detour.step(context, place.point(shape.contact));
        limb.detour.lead_free(&place)
    }

    /// The limbs that the body has to stay within reach of.
    fn ties(&self, ends: &[Option<Place>; 4], shoulders: &[DVec3; 4]) -> [Option<Tie>; 4] {
        Extremity::ALL.map(|extremity| {
            let index = extremity.index();
            let end = ends[index]?;
            let length = self.figure.limb(extremity).length;
            let share = if extremity.is_hand() {
                reach::ARM
            } else {
                reach::LEG
            };
            Some(Tie {
                root: shoulders[index],
                end: end.position,
                reach: share * length,
                length,
            })
        })
    }

    /// Positions of shoulders and hips in the clips' pose, in world space.
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

    /// Turns the head and the neck to the point that the climber looks at.
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
