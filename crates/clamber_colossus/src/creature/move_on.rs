//! Moves a creature on by a tick: its speeds change, its clips go on, its place follows, and it senses whether its act
//! is done or blocked.

use clamber_animation::{AnimationEvent, RootDelta};
use serde::{Deserialize, Serialize};

use super::clips::Playing;
use super::course::{Course, Wanted};
use super::state::is_fast;
use super::way::Way;
use super::{Creature, CreatureEvent, Surroundings};
use crate::angle::nearest_turn;
use crate::brain::{StateAction, StateId};
use crate::error::ColossusError;
use crate::kind::{Gait, HUMAN_HEIGHT};
use crate::senses::Sense;

/// Time in which one clip of the gait fades into another, seconds for a creature of human height. Larger creatures take
/// longer, by the square root of their height (Froude's law).
const GAIT_FADE_TIME: f64 = 0.35;

/// Shortest time between the beginning of an act and the sense `blocked`, seconds for a creature of `GIANT_HEIGHT`.
/// Without it, a brain whose next state leads back to the blocked one would change states in every tick.
const SHORTEST_TRY: f64 = 1.0;

/// Heading and speeds of a creature.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Motion {
    /// Steepness of the ground ahead, as a tangent.
    steepness: f64,
    /// Heading, radians about Y.
    yaw: f64,
    /// Speed along the heading, metres a second.
    speed: f64,
    /// Radians a second, positive to the left.
    yaw_rate: f64,
}

impl Motion {
    /// At rest on level ground.
    pub(super) fn at_rest(yaw: f64) -> Self {
        Self {
            steepness: 0.0,
            yaw,
            speed: 0.0,
            yaw_rate: 0.0,
        }
    }

    /// Steepness of the ground ahead, as a tangent.
    pub(super) fn steepness(&self) -> f64 {
        self.steepness
    }

    pub(super) fn set_steepness(&mut self, steepness: f64) {
        self.steepness = steepness;
    }

    /// Heading, radians about Y.
    pub(super) fn yaw(&self) -> f64 {
        self.yaw
    }

    /// Turns the heading by an angle, radians.
    pub(super) fn turn_by(&mut self, angle: f64) {
        self.yaw = nearest_turn(self.yaw + angle);
    }

    /// Speed along the heading, metres a second.
    pub(super) fn speed(&self) -> f64 {
        self.speed
    }

    /// Radians a second, positive to the left.
    pub(super) fn yaw_rate(&self) -> f64 {
        self.yaw_rate
    }

    /// True if the creature neither walks nor turns.
    pub(super) fn is_at_rest(&self) -> bool {
        self.speed == 0.0 && self.yaw_rate == 0.0
    }

    /// True if all numbers are in the range that a creature reaches.
    pub(super) fn is_within_range(&self) -> bool {
        let numbers = [self.yaw, self.speed, self.yaw_rate, self.steepness];
        !numbers.into_iter().any(is_fast)
    }
}

/// Whether a creature gets on with its act or errand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Progress {
    /// True if the creature cannot get on.
    is_blocked: bool,
    /// Ticks since the act or the errand began.
    tried: u32,
}

impl Progress {
    /// True if the creature cannot get on.
    pub(super) fn is_blocked(&self) -> bool {
        self.is_blocked
    }

    pub(super) fn set_blocked(&mut self, is_blocked: bool) {
        self.is_blocked = is_blocked;
    }

    /// The same time of trying, with the way no longer blocked.
    pub(super) fn unblocked(&self) -> Self {
        Self {
            is_blocked: false,
            ..*self
        }
    }
}

impl Creature {
    /// Advances the clips and the place of the creature by a tick, and sets the senses that tell whether the act is
    /// done or blocked.
    pub(super) fn move_on(
        &mut self,
        around: &Surroundings<'_>,
        dt: f64,
    ) -> Result<(), ColossusError> {
        let state = self.state.brain.current();
        let way = self.current_way();
        let is_sent = self.state.acting.errand().is_some();
        let begun = self.state.acting.has_begun(state);
        let kind = std::sync::Arc::clone(&self.kind);
        let is_there = match kind.gait() {
            Some(gait) => self.walk(gait, way.as_ref(), around, dt)?,
            None => false,
        };
        let moved = self.advance_clips(dt)?;
        self.advance_place(&moved, dt);
        self.follow_ground(around, dt);
        let is_blocked = self.sense_progress(state, begun, is_there && !is_sent, dt);
        self.end_errand(is_there, is_blocked);
        Ok(())
    }

    /// Walks or turns towards a goal, or comes to a stop without one. Returns true if the creature is at its goal and
    /// stands.
    fn walk(
        &mut self,
        gait: &Gait,
        way: Option<&Way>,
        around: &Surroundings<'_>,
        dt: f64,
    ) -> Result<bool, ColossusError> {
        let mut course = Course::of(&self.state);
        self.pass_corners();
        let mut wanted = self.wanted(gait, way, &course);
        if let Some(way) = way.filter(|_| self.looks(gait, &wanted)) {
            self.look(gait, way, around);
            course.ahead = self.state.walked.free.ahead();
            course.turn = Some(self.state.walked.free.turn());
            course.back = self.state.walked.retreats.left();
            wanted = self.wanted(gait, Some(way), &course);
        }
        let moved = self.moved(gait, &wanted, course, dt);
        let motion = &mut self.state.motion;
        (motion.speed, motion.yaw_rate) = (moved.speed, moved.yaw_rate);
        self.state.acting.halt(moved.halts);
        let playing = self.gait_clip(gait, way, &wanted);
        let clip_speed = self.clip_speed(gait, playing, &moved);
        let size = (self.size.height / HUMAN_HEIGHT).max(1e-4).sqrt();
        self.play(playing, clip_speed, GAIT_FADE_TIME * size)?;
        let sleeps = self.is_put_to_sleep();
        if sleeps && playing == Playing::Idle {
            self.state.clips.stop();
        } else if way.is_some() {
            self.state.clips.go_on();
        }
        if !(matches!(playing, Playing::Act(_)) || sleeps && playing == Playing::Idle) {
            self.state.clips.set_speed(clip_speed);
        }
        let stands = self.state.speed() == 0.0 && !self.is_turning();
        Ok(wanted.arrived && stands)
    }

    /// The clip that fits the motion that the creature has, and wants.
    fn gait_clip(&self, gait: &Gait, way: Option<&Way>, wanted: &Wanted) -> Playing {
        let Wanted {
            turn,
            aside,
            turns_on_spot,
            ..
        } = *wanted;
        let moves = self.state.speed() > 0.0 && !self.state.acting.halts();
        let playing = self.state.clips.playing();
        let acts = matches!(playing, Playing::Act(_)) && way.is_none();
        if moves {
            Playing::Walk
        } else if turns_on_spot && gait.turn.is_some() && self.state.speed() >= 0.0 {
            // The turn is 0 until the creature stands.
            let side = if turn == 0.0 { aside } else { turn };
            Playing::Turn(u8::from(side < 0.0))
        } else if acts {
            playing
        } else {
            Playing::Idle
        }
    }

    /// Advances the clips by a tick, and reports the markers that they pass. Returns the motion of the clips' root.
    fn advance_clips(&mut self, dt: f64) -> Result<RootDelta, ColossusError> {
        self.events.clear();
        let moved = self.state.clips.advance(&self.kind, dt, &mut self.events)?;
        self.state.passed.clear();
        for event in &self.events {
            if let AnimationEvent::Marker {
                layer: 0,
                clip,
                marker,
            } = event
            {
                self.state.passed.push(*clip, *marker);
                let clip = self.kind.clips().clip(*clip)?;
                let name = clip.markers()[*marker].name.clone();
                self.report.events.push(CreatureEvent::Marker { name });
            }
        }
        Ok(moved)
    }

    /// Moves and turns the creature by its clips' root and by its speeds, and subtracts that from the free way.
    fn advance_place(&mut self, moved: &RootDelta, dt: f64) {
        let scale = self.size.scale;
        let state = &mut self.state;
        let rotation = state.world_from_model(scale).rotation;
        state
            .on_ground
            .advance(rotation * moved.translation * scale);
        let motion = &mut state.motion;
        motion.yaw = nearest_turn(motion.yaw + moved.yaw + motion.yaw_rate * dt);
        let (speed, yaw_rate) = (motion.speed, motion.yaw_rate);
        let way = state.heading() * (speed * dt);
        state.on_ground.advance(way);
        state.walked.free.use_up(speed * dt, yaw_rate * dt);
        state.walked.retreats.walk(-speed.min(0.0) * dt);
        state.walked.corners.wait();
    }

    /// Sets the senses `done` and `blocked` of the act of a state. Returns true if the creature is blocked.
    fn sense_progress(&mut self, state: StateId, begun: bool, is_there: bool, dt: f64) -> bool {
        let progress = &mut self.state.walked.progress;
        progress.tried = progress.tried.saturating_add(1);
        let tried = f64::from(progress.tried) * dt;
        let tries = progress.is_blocked && tried < SHORTEST_TRY * self.size.pace;
        let is_blocked = progress.is_blocked && !tries;
        let is_over = !tries
            && match self.kind.brain().act(state) {
                Some(StateAction::Walk(_) | StateAction::Turn(_)) => is_there,
                Some(StateAction::Once(_) | StateAction::Attack(_)) => {
                    begun && self.is_played(state)
                }
                Some(StateAction::Play(_) | StateAction::Sleep) => false,
                None => true,
            };
        let is_act = self.state.acting.has_begun(state);
        let senses = &mut self.state.senses;
        senses.set(Sense::Done, f64::from(u8::from(is_over)));
        senses.set(Sense::Blocked, f64::from(u8::from(is_blocked && is_act)));
        is_blocked
    }

    /// True while the creature turns too fast to count as standing.
    pub(super) fn is_turning(&self) -> bool {
        self.state.motion.yaw_rate.abs() >= 0.3 * self.size.pace * self.turns()
    }
}
