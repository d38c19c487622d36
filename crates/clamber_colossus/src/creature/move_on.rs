//! Lets a creature walk and turn: it looks where it goes, and moves there.

use clamber_animation::AnimationEvent;

use super::course::{Course, Wanted};
use super::state::Playing;
use super::way::Way;
use super::{Creature, CreatureEvent, Surroundings};
use crate::angle::nearest_turn;
use crate::brain::Act;
use crate::error::ColossusError;
use crate::kind::{Gait, HUMAN};
use crate::senses::Sense;

/// It looks for what is in its way in one of so many ticks.
pub(super) const LOOKS: u64 = 8;

/// Seconds in which one clip of the gait fades into another, for a creature of a human's height. Larger ones take
/// longer, by the square root of their height (Froude's law).
const FADE: f64 = 0.35;

/// Stands for a way that is free as far as it looks, metres.
const FREE: f64 = 1e6;

/// Less than this is no turn, radians.
const LEAST_TURN: f64 = 0.05;

impl Creature {
    /// Lets clips and the creature's place move on by a tick, and says whether the act is done.
    pub(super) fn move_on(
        &mut self,
        around: &Surroundings<'_>,
        dt: f64,
    ) -> Result<(), ColossusError> {
        let state = self.state.brain.current();
        let way = self.way(state);
        let begun = self.state.acting == Some(state);
        let mut done = false;
        let kind = std::sync::Arc::clone(&self.kind);
        if let Some(gait) = kind.gait() {
            let way = way.filter(|_| begun);
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
        self.state.walked.turn -= (self.state.yaw_rate * dt).abs();
        self.state.walked.ticks_left = self.state.walked.ticks_left.saturating_sub(1);
        self.follow_ground(around, dt);
        let is_over = match kind.brain().act(state) {
            Some(Act::Walk(_) | Act::Turn(_)) => done,
            Some(Act::Once(_) | Act::Attack(_)) => {
                begun && (self.state.playing != Playing::Act(state) || self.clip_is_over())
            }
            Some(Act::Play(_) | Act::Sleep) => false,
            None => true,
        };
        self.state
            .senses
            .set(Sense::Done, f64::from(u8::from(is_over)));
        let is_blocked = self.state.walked.is_blocked && self.state.acting == Some(state);
        self.state
            .senses
            .set(Sense::Blocked, f64::from(u8::from(is_blocked)));
        Ok(())
    }

    /// Looks where it goes: for corners of its way, how far the next piece of it is free, and how far it may turn.
    fn look(&mut self, gait: &Gait, way: &Way, around: &Surroundings<'_>) {
        let kind = std::sync::Arc::clone(&self.kind);
        let Some(extent) = kind.extent() else { return };
        self.state.walked.is_blocked = false;
        let mut course = Course::of(&self.state);
        if way.walks && !self.wanted(gait, Some(way), &course).arrived {
            self.find_corners(around, extent, way);
        }
        let room = self.room(around, extent, 0.0);
        let goes = self.wanted(gait, Some(way), &course);
        let ahead = if way.walks && !goes.arrived {
            let sight = self.sight(gait);
            let far = sight.min(goes.distance + sight / 2.0);
            let free = room.ahead(far);
            if free >= far { FREE } else { free }
        } else {
            0.0
        };
        self.state.walked.ahead = ahead;
        self.state.walked.is_known = true;
        course.ahead = ahead;
        let goes = self.wanted(gait, Some(way), &course);
        if goes.turns_on_spot {
            let room = self.room(around, extent, 0.0);
            let most = self.turning_room(gait).max(2.0 * LEAST_TURN);
            let most = most.min(goes.aside.abs() + LEAST_TURN);
            let far = most.copysign(goes.aside);
            let free = room.turn(far).abs();
            let other = || room.turn(-most.copysign(goes.aside)).abs();
            let walked = &mut self.state.walked;
            walked.turn = free;
            if free < LEAST_TURN && free < goes.aside.abs() {
                if walked.round == 0 && other() >= LEAST_TURN {
                    walked.round = if goes.aside > 0.0 { -1 } else { 1 };
                } else {
                    walked.is_blocked = true;
                }
            }
        } else if goes.is_stopped && self.state.speed == 0.0 {
            self.state.walked.is_blocked = true;
        }
    }

    fn clip_is_over(&self) -> bool {
        let layer = self.state.animator.layers().first();
        layer.is_none_or(|layer| {
            let clip = self.kind.clips().clip(layer.clip);
            clip.is_ok_and(|clip| layer.time >= clip.duration())
        })
    }

    /// Walks or turns towards a goal, or comes to a stand without one. Returns true if it is there.
    fn walk(
        &mut self,
        gait: &Gait,
        way: Option<&Way>,
        around: &Surroundings<'_>,
        dt: f64,
    ) -> Result<bool, ColossusError> {
        let mut course = Course::of(&self.state);
        let looks = !self.state.walked.is_known || self.state.ticks.is_multiple_of(LOOKS);
        if let Some(way) = way.filter(|_| looks) {
            self.look(gait, way, around);
        }
        course.ahead = self.state.walked.ahead;
        let wanted = self.wanted(gait, way, &course);
        let Wanted {
            turn,
            arrived,
            turns_on_spot,
            ..
        } = wanted;
        let moved = self.moved(gait, &wanted, course, dt);
        (self.state.speed, self.state.yaw_rate) = (moved.speed, moved.yaw_rate);
        self.state.halts = moved.halts;
        let (rate, stride) = (self.size.rate, self.stride());
        let full = self.full_speed(gait);
        let moves = self.state.speed > 0.0 && !self.state.halts;
        let acts = matches!(self.state.playing, Playing::Act(_)) && way.is_none();
        let playing = if moves {
            Playing::Walk
        } else if turns_on_spot && gait.turn.is_some() {
            Playing::Turn(u8::from(turn < 0.0))
        } else if acts {
            self.state.playing
        } else {
            Playing::Idle
        };
        let clip_speed = match playing {
            Playing::Walk => self.state.speed / (full * stride),
            Playing::Turn(_) => (self.state.yaw_rate.abs() / (gait.turn_rate * rate)).min(1.0),
            Playing::Idle | Playing::Act(_) => 1.0,
        };
        let size = (self.size.height / HUMAN).max(1e-4).sqrt();
        self.play(playing, clip_speed, FADE * size)?;
        if let Some(layer) = self.state.animator.layers_mut().first_mut()
            && !matches!(playing, Playing::Act(_))
        {
            layer.speed = clip_speed;
        }
        let slow = 0.3 * self.size.pace * self.turns();
        let stands = self.state.speed == 0.0 && self.state.yaw_rate.abs() < slow;
        Ok(arrived && stands)
    }
}
