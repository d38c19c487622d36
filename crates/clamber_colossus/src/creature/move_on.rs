//! Walks and turns a creature: it checks its way, and moves along it.

use clamber_animation::AnimationEvent;

use super::course::{Course, Wanted};
use super::state::Playing;
use super::way::Way;
use super::{Creature, CreatureEvent, Surroundings};
use crate::angle::nearest_turn;
use crate::brain::Act;
use crate::error::ColossusError;
use crate::kind::{Extent, Extents, Gait, HUMAN};
use crate::senses::Sense;

/// Interval between checks of the way, in ticks.
pub(super) const LOOKS: u64 = 8;

/// Time in which one clip of the gait fades into another, seconds for a creature of human height. Larger creatures take
/// longer, by the square root of their height (Froude's law).
const FADE: f64 = 0.35;

/// Factor on the interval while there is no obstacle on the way.
pub(super) const SELDOM: u64 = 4;

/// A yaw rate that the angular acceleration produces within this time counts as walking straight on, seconds.
const STEADY: f64 = 0.1;

/// A free distance above this means that the way is free as far as the creature looks, metres.
const FREE: f64 = 1e5;

/// Shortest time between the beginning of an act and the sense `blocked`, seconds for a creature of `GIANT` height.
/// Without it, a brain whose next state leads back to the blocked one would change states in every tick.
const TRIES: f64 = 1.0;

/// A turn on the spot is blocked if its free angle is below this, radians, unless the goal is nearer.
const LEAST_TURN: f64 = 0.05;

/// A walking creature turns to a goal up to this angle without a check, radians.
const LEAST_STEER: f64 = 0.02;

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
        let is_sent = self.state.errand.is_some();
        let begun = self.state.acting == Some(state);
        let mut done = false;
        let kind = std::sync::Arc::clone(&self.kind);
        if let Some(gait) = kind.gait() {
            done = self.walk(gait, way.as_ref(), around, dt)?;
        }
        self.events.clear();
        let moved = self
            .state
            .animator
            .advance(kind.clips(), dt, &mut self.events)?;
        self.state.passed.clear();
        for event in &self.events {
            if let AnimationEvent::Marker {
                layer: 0,
                clip,
                marker,
            } = event
            {
                self.state.passed.push([clip.0, *marker as u32]);
                let name = kind.clips().clip(*clip)?.markers()[*marker].name.clone();
                self.report.events.push(CreatureEvent::Marker { name });
            }
        }
        let scale = self.size.scale;
        let rotation = self.state.world_from_model(scale).rotation;
        self.state.position += rotation * moved.translation * scale;
        self.state.yaw = nearest_turn(self.state.yaw + moved.yaw + self.state.yaw_rate * dt);
        self.state.position += self.state.heading() * (self.state.speed * dt);
        self.state.walked.ahead -= self.state.speed * dt;
        self.state.walked.turn -= self.state.yaw_rate * dt;
        let back = -self.state.speed.min(0.0) * dt;
        self.state.walked.back = (self.state.walked.back - back).max(0.0);
        self.state.walked.gone_back += back;
        self.state.walked.ticks_left = self.state.walked.ticks_left.saturating_sub(1);
        self.follow_ground(around, dt);
        let walked = &mut self.state.walked;
        walked.tried = walked.tried.saturating_add(1);
        let tries = walked.is_blocked && f64::from(walked.tried) * dt < TRIES * self.size.pace;
        let is_blocked = walked.is_blocked && !tries;
        let is_over = !tries
            && match kind.brain().act(state) {
                Some(Act::Walk(_) | Act::Turn(_)) => done && !is_sent,
                Some(Act::Once(_) | Act::Attack(_)) => {
                    begun && (self.state.playing != Playing::Act(state) || self.clip_is_over())
                }
                Some(Act::Play(_) | Act::Sleep) => false,
                None => true,
            };
        self.state
            .senses
            .set(Sense::Done, f64::from(u8::from(is_over)));
        let is_act = self.state.acting == Some(state);
        self.state
            .senses
            .set(Sense::Blocked, f64::from(u8::from(is_blocked && is_act)));
        self.end_errand(done, is_blocked);
        Ok(())
    }

    /// Checks the way: searches for its corners, and measures how far its next piece is free and how far the creature
    /// may turn.
    fn look(&mut self, gait: &Gait, way: &Way, around: &Surroundings<'_>) {
        let kind = std::sync::Arc::clone(&self.kind);
        let Some(Extents { on_spot, walking }) = kind.extents() else {
            return;
        };
        self.state.walked.is_blocked = false;
        let mut course = Course::of(&self.state);
        if self.state.walked.back > 0.0 {
            let goes = self.wanted(gait, Some(way), &course);
            self.look_back(around, on_spot, goes.aside);
            return;
        }
        if way.walks && !self.wanted(gait, Some(way), &course).arrived {
            self.find_corners(around, way);
        }
        let goes = self.wanted(gait, Some(way), &course);
        self.state.walked.ahead = if goes.faces {
            let sight = self.sight(gait);
            let far = sight.min(goes.distance + sight / 2.0);
            let free = self.room(around, walking).ahead(far);
            if free >= far {
                2.0 * FREE
            } else {
                self.doubt_corners();
                free
            }
        } else {
            0.0
        };
        self.state.walked.is_known = true;
        self.state.walked.faces = goes.faces;
        course.ahead = self.state.walked.ahead;
        let goes = self.wanted(gait, Some(way), &course);
        let walked = &mut self.state.walked;
        // With the goal less than a quarter turn away, the creature turns the short way again. The next turn may go the
        // long way round.
        if !goes.turns_on_spot || goes.aside.abs() < core::f64::consts::FRAC_PI_2 {
            walked.round = 0;
        }
        walked.has_gone_round &= goes.turns_on_spot;
        walked.has_gone_back &= goes.turns_on_spot;
        walked.has_looked_round &= goes.turns_on_spot;
        if goes.turns_on_spot {
            self.look_aside(gait, &goes, around, on_spot);
        } else if goes.walks && !goes.is_stopped {
            // Head and tail move sideways when the creature steers.
            let far = self.turning_room(gait, true).copysign(goes.aside);
            self.state.walked.turn = if goes.aside.abs() > LEAST_STEER {
                self.room(around, walking).turn(far, self.slope())
            } else {
                far
            };
        } else if goes.is_stopped && self.state.speed == 0.0 {
            self.stop(around, on_spot);
        }
    }

    /// Measures how far the creature may turn on the spot. If neither turn to the goal is free, the creature begins a
    /// retreat if it can.
    fn look_aside(
        &mut self,
        gait: &Gait,
        goes: &Wanted,
        around: &Surroundings<'_>,
        on_spot: &Extent,
    ) {
        let most = (2.0 * self.turning_room(gait, false)).max(2.0 * LEAST_TURN);
        let most = most.min(goes.aside.abs() + LEAST_TURN);
        let room = self.room(around, on_spot);
        self.state.walked.turn = room.turn(most.copysign(goes.aside), self.slope());
        if self.state.speed > 0.0 {
            // The creature still walks.
            return;
        }
        let is_first = !std::mem::replace(&mut self.state.walked.has_looked_round, true);
        let free = self.state.walked.turn.abs();
        let is_blocked = free < LEAST_TURN && free < goes.aside.abs();
        if !is_first && !is_blocked {
            return;
        }
        let gets_on = self.finds_turn(around, on_spot, goes.aside)
            || self.begin_back(around, on_spot)
            || !is_blocked;
        self.state.walked.is_blocked = !gets_on;
    }

    /// True in ticks in which the creature checks its way: in one of every [`LOOKS`] ticks. It checks less often while
    /// it walks straight on along a free way, or while it turns on the spot with room to turn.
    fn looks(&self, gait: &Gait, wanted: &Wanted) -> bool {
        let (state, walked) = (&self.state, &self.state.walked);
        let is_new = !walked.is_known || wanted.faces && !walked.faces;
        if is_new || state.ticks.is_multiple_of(SELDOM * LOOKS) {
            return true;
        }
        let walks_free = walked.ahead > FREE && state.yaw_rate.abs() < STEADY * self.turns();
        let room = walked.turn * wanted.aside.signum();
        let turns_free = wanted.turns_on_spot && room > self.turning_room(gait, false);
        state.ticks.is_multiple_of(LOOKS) && !walks_free && !turns_free
    }

    fn clip_is_over(&self) -> bool {
        let layer = self.state.animator.layers().first();
        layer.is_none_or(|layer| {
            let clip = self.kind.clips().clip(layer.clip);
            clip.is_ok_and(|clip| layer.time >= clip.duration())
        })
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
            course.ahead = self.state.walked.ahead;
            course.turn = Some(self.state.walked.turn);
            course.back = self.state.walked.back;
            wanted = self.wanted(gait, Some(way), &course);
        }
        let Wanted {
            turn,
            aside,
            arrived,
            turns_on_spot,
            ..
        } = wanted;
        let moved = self.moved(gait, &wanted, course, dt);
        (self.state.speed, self.state.yaw_rate) = (moved.speed, moved.yaw_rate);
        self.state.halts = moved.halts;
        let moves = self.state.speed > 0.0 && !self.state.halts;
        let acts = matches!(self.state.playing, Playing::Act(_)) && way.is_none();
        let playing = if moves {
            Playing::Walk
        } else if turns_on_spot && gait.turn.is_some() && self.state.speed >= 0.0 {
            // The turn is 0 until the creature stands.
            let side = if turn == 0.0 { aside } else { turn };
            Playing::Turn(u8::from(side < 0.0))
        } else if acts {
            self.state.playing
        } else {
            Playing::Idle
        };
        let clip_speed = self.clip_speed(gait, playing, &moved);
        let size = (self.size.height / HUMAN).max(1e-4).sqrt();
        self.play(playing, clip_speed, FADE * size)?;
        let sleeps = self.is_put_to_sleep();
        if sleeps && playing == Playing::Idle {
            self.fall_asleep();
        } else if way.is_some() {
            self.wake();
        }
        if let Some(layer) = self.state.animator.layers_mut().first_mut()
            && !matches!(playing, Playing::Act(_))
            && !(sleeps && playing == Playing::Idle)
        {
            layer.speed = clip_speed;
        }
        let stands = self.state.speed == 0.0 && !self.is_turning();
        Ok(arrived && stands)
    }

    /// True while the creature turns too fast to count as standing.
    pub(super) fn is_turning(&self) -> bool {
        self.state.yaw_rate.abs() >= 0.3 * self.size.pace * self.turns()
    }
}
