//! One step of a creature, in the order in which it happens.

use clamber_animation::rig::Playback;
use clamber_animation::{Animator, ClipId};
use glam::DVec3;

use super::report::CreatureEvent;
use super::state::{Felt, Playing};
use super::{Creature, Surroundings, Wound};
use crate::brain::{Act, StateId};
use crate::error::ColossusError;
use crate::feet::Ground;
use crate::senses::Sense;

/// An act of another kind begins when the creature has come to a stand: below this share of its walking speed.
const STANDS: f64 = 0.12;

impl Creature {
    /// Lets a tick pass, of the length that its brain was made for.
    ///
    /// In this order: senses of what was around it at the end of the last tick; the brain; the act that it chose begins or
    /// goes on; clips; the place in the world; the pose, with feet on the ground and the head turned; the skin; whom the
    /// limbs strike. Step the creature before the climbers on it.
    ///
    /// # Errors
    /// [`ColossusError::Surface`] if the skin cannot be posed, for example since the creature has left the range of numbers.
    pub fn step(&mut self, around: &Surroundings<'_>) -> Result<&CreatureReport, ColossusError> {
        let dt = self.kind.brain().tick();
        self.report.events.clear();
        self.report.blows.clear();
        self.state.ticks += 1;
        self.feel(around);
        self.think();
        self.act()?;
        self.move_on(around, dt)?;
        self.take_pose(around, dt)?;
        let world_from_model = self.state.world_from_model(self.config.scale);
        self.surface.advance(&self.palette, world_from_model)?;
        self.strike(around, dt);
        Ok(&self.report)
    }

    /// Tells the creature that something struck it. Returns the damage that was done to a weak point: none if there is no open one
    /// there. The brain knows in the next step.
    pub fn hurt(&mut self, wound: &Wound) -> f64 {
        if !wound.place.is_finite() || !(0.0..=f64::MAX).contains(&wound.damage) {
            return 0.0;
        }
        let triangle = u32::try_from(wound.at.key)
            .ok()
            .map(clamber_surface::mesh::TriangleId);
        let joint = triangle.and_then(|triangle| self.surface.mesh().joint_of(triangle));
        let Some(joint) = joint else { return 0.0 };
        let mut done = 0.0;
        for index in 0..self.kind.weak_points().len() {
            let point = &self.kind.weak_points()[index];
            let Some(frame) = self.palette.model_from_joint(point.joint) else {
                continue;
            };
            let place = frame.transform_point3(point.position.as_dvec3());
            let place = self.surface.world_from_model().transform_point(place);
            let radius = f64::from(point.radius) * self.config.scale;
            if place.distance(wound.place) > radius || !self.is_open(index) {
                continue;
            }
            let left = &mut self.state.hit_points[index];
            let damage = wound.damage.min(*left);
            *left -= damage;
            done += damage;
            let (weak_point, used_up) = (index, *left <= 0.0);
            self.report.events.push(CreatureEvent::Hurt {
                weak_point,
                damage,
                used_up,
            });
            // What is too much for this one is not passed on.
            break;
        }
        self.state.wounds.push(Felt {
            joint: joint.0,
            damage: done,
        });
        done
    }

    /// True if a weak point can be hurt now: it is not used up, and it is exposed or a minor one, or all minor ones are used up.
    pub fn is_open(&self, weak_point: usize) -> bool {
        let points = self.kind.weak_points();
        let (Some(point), Some(left)) = (
            points.get(weak_point),
            self.state.hit_points.get(weak_point),
        ) else {
            return false;
        };
        let mut minor = points
            .iter()
            .zip(&self.state.hit_points)
            .filter(|(point, _)| !point.major);
        let exposed = self.kind.brain().exposes(self.state.current());
        *left > 0.0
            && (!point.major
                || exposed.contains(&point.name)
                || minor.all(|(_, left)| *left <= 0.0))
    }

    /// Sets one of the game's own senses, by its name in the file. Returns false if there is no such sense.
    pub fn set_sense(&mut self, name: &str, value: f64) -> bool {
        let index = self
            .kind
            .brain()
            .own_senses()
            .iter()
            .position(|known| known == name);
        if let Some(index) = index {
            self.state.senses.set_own(index, value);
        }
        index.is_some()
    }

    /// The brain takes its step, with the markers that the clips passed in the last one.
    fn think(&mut self) {
        let kind = &self.kind;
        let passed: Vec<&str> = self
            .state
            .passed
            .iter()
            .filter_map(|[clip, marker]| {
                let clip = kind.clips().clip(ClipId(*clip)).ok()?;
                clip.markers()
                    .get(*marker as usize)
                    .map(|marker| marker.name.as_str())
            })
            .collect();
        let events = &mut self.report.events;
        let (mut changed, mut interrupts) = (false, false);
        kind.brain().step(
            &mut self.state.brain,
            &self.state.senses,
            &passed,
            |entered| {
                changed = true;
                interrupts |= entered.interrupts;
                events.push(CreatureEvent::Entered {
                    from: entered.from,
                    to: entered.to,
                });
            },
        );
        if changed {
            self.state.acting = None;
            self.state.halts = interrupts;
            self.state.senses.set(Sense::Done, 0.0);
        }
    }

    /// Begins the current state's act, as soon as the creature stands, or goes on with it. An act that interrupts another
    /// one begins at once: giants may stop abruptly.
    fn act(&mut self) -> Result<(), ColossusError> {
        let state = self.state.brain.current();
        if self.state.acting == Some(state) {
            return Ok(());
        }
        let kind = std::sync::Arc::clone(&self.kind);
        let act = kind.brain().act(state);
        let walks = matches!(act, Some(Act::Walk(_)));
        let speed = kind.gait().map_or(0.0, |gait| {
            gait.speed * self.config.scale * self.config.rate()
        });
        if !walks && !self.state.halts && self.state.speed > STANDS * speed {
            return Ok(());
        }
        self.state.acting = Some(state);
        self.state.struck.clear();
        self.state.aim = DVec3::ZERO;
        match act {
            Some(Act::Walk(_) | Act::Turn(_)) => self.begin_way(),
            Some(Act::Play(_)) => self.begin(state, Playback::Loop)?,
            Some(Act::Once(_) | Act::Attack(_)) => self.begin(state, Playback::Clamp)?,
            None => self.play(Playing::Idle, kind.brain().fade(state))?,
        }
        if let (Some(Act::Attack(_)), Some(strike)) = (act, &kind.act(state).strike) {
            self.aim(strike);
        }
        Ok(())
    }

    fn begin(&mut self, state: StateId, playback: Playback) -> Result<(), ColossusError> {
        let Some(clip) = self.kind.act(state).clip else {
            return Ok(());
        };
        self.state.playing = Playing::Act(state);
        let fade = self.kind.brain().fade(state);
        change(&mut self.state.animator, &self.kind, clip, playback, fade)
    }

    /// Plays a clip of the gait, unless it is being played.
    pub(super) fn play(&mut self, playing: Playing, fade: f64) -> Result<(), ColossusError> {
        let Some(gait) = self.kind.gait().filter(|_| self.state.playing != playing) else {
            return Ok(());
        };
        let clip = match (playing, gait.turn) {
            (Playing::Walk, _) => gait.walk,
            (Playing::Turn(side), Some(turn)) => turn[usize::from(side.min(1))],
            _ => gait.idle,
        };
        self.state.playing = playing;
        change(
            &mut self.state.animator,
            &self.kind,
            clip,
            Playback::Loop,
            fade,
        )
    }

    /// Poses the creature where it is, without motion.
    pub(super) fn place(&mut self) -> Result<(), ColossusError> {
        let (skeleton, pose) = (self.kind.skeleton(), &self.state.pose);
        skeleton.palette_into(pose, &mut self.palette)?;
        let world_from_model = self.state.world_from_model(self.config.scale);
        self.surface.place(&self.palette, world_from_model)?;
        Ok(())
    }

    fn take_pose(&mut self, around: &Surroundings<'_>, dt: f64) -> Result<(), ColossusError> {
        self.state.animator.pose_into(
            self.kind.clips(),
            &mut self.state.pose,
            &mut self.buffers,
        )?;
        let ground = Ground {
            terrain: around.terrain,
            reach: 0.5 * self.kind.height() * self.config.scale,
        };
        self.put_feet(&ground, dt);
        self.turn_head(around, dt);
        self.kind
            .skeleton()
            .palette_into(&self.state.pose, &mut self.palette)?;
        Ok(())
    }
}

use super::CreatureReport;

/// Plays a clip on the lowest layer.
fn change(
    animator: &mut Animator,
    kind: &crate::kind::CreatureKind,
    clip: ClipId,
    playback: Playback,
    fade: f64,
) -> Result<(), ColossusError> {
    animator.change(kind.clips(), fade, |layers| {
        if let Some(layer) = layers.first_mut() {
            (layer.clip, layer.time, layer.speed, layer.playback) = (clip, 0.0, 1.0, playback);
        }
    })?;
    Ok(())
}
