//! Orders of the game: it puts a creature somewhere, sends it to a place, forces a state of its brain, or harms it.

use clamber_surface::geometry::rotation_from_axis_angle;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::report::CreatureEvent;
use super::walked::Walked;
use super::way::Way;
use super::{Creature, CreatureConfig, CreatureState};
use crate::error::ColossusError;

/// Distance within which a sent creature has arrived, as a share of its height.
const ARRIVAL_DISTANCE: f64 = 0.1;

/// The place to which the game has sent a creature.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Errand {
    to: DVec3,
    has_begun: bool,
}

impl Errand {
    pub(super) fn to(&self) -> DVec3 {
        self.to
    }

    /// Lets the creature go.
    pub(super) fn begin(&mut self) {
        self.has_begun = true;
    }
}

/// Largest coordinate of a place to which a creature can be sent, metres.
const MOST_SENT: f64 = 1e12;

impl Creature {
    /// Puts the creature somewhere else, at rest, as if it had begun there; its home moves there, too. Its brain, clips
    /// and wounds stay as they are, and its waves and shots stay where they are. The skin is teleported there, so that
    /// riders are left behind.
    ///
    /// # Errors
    /// [`ColossusError::OutOfRange`] if the place is not finite or beyond 1e12 m, or the heading is beyond 1e6 radians;
    /// also the errors of posing the skin. The creature is unchanged then.
    pub fn put(&mut self, position: DVec3, yaw: f64) -> Result<(), ColossusError> {
        let config = CreatureConfig {
            position,
            yaw,
            ..self.config
        };
        config.check()?;
        let fresh = CreatureState::new(&self.kind, &config, self.size.rate);
        let mut ranged = self.state.ranged.clone();
        ranged.be_put(position + fresh.heading() * self.size.height);
        let turn = rotation_from_axis_angle(DVec3::Y, fresh.yaw() - self.state.yaw());
        let mut state = CreatureState {
            on_ground: fresh.on_ground,
            moving_ground: fresh.moving_ground,
            walked: fresh.walked,
            motion: fresh.motion,
            feet: fresh.feet,
            hips: fresh.hips,
            head: fresh.head,
            territory: fresh.territory,
            perceived: self.state.perceived.elsewhere(),
            striking: self.state.striking.elsewhere(turn),
            ranged,
            clock: fresh.clock,
            ..self.state.clone()
        };
        self.swap_state(&mut state)
    }

    /// Sends the creature to a place, regardless of its brain. Its current act ends at once. It walks around obstacles
    /// and may leave its arena; the height of the place does not count. Its brain still changes states on the way, but
    /// their acts begin only after the errand, whose end [`CreatureEvent::Arrived`] or [`CreatureEvent::Stopped`]
    /// reports. `None` ends the errand where the creature is, and gives it back to its brain without an event; it
    /// always succeeds.
    ///
    /// A creature on its way may be sent elsewhere in each tick: it goes on, and searches for a way as often as on a
    /// single errand. Returns false and changes nothing if the creature cannot walk, if its brain is in a final state,
    /// or if a coordinate of the place is not finite or beyond 1e12 m.
    pub fn send(&mut self, to: Option<DVec3>) -> bool {
        let is_far = |place: DVec3| !place.is_finite() || place.abs().max_element() > MOST_SENT;
        let is_over = self.kind.brain().is_final(self.state.brain.current());
        let cannot = (self.kind.gait().is_none() || is_over) && to.is_some();
        if cannot || to.is_some_and(is_far) {
            return false;
        }
        match (self.state.acting.errand(), to) {
            (None, None) => {}
            (Some(errand), Some(to)) => self.send_elsewhere(errand, to),
            _ => {
                self.state.acting.replace_errand(None);
                self.leave_act();
                let errand = to.map(|to| Errand {
                    to,
                    has_begun: false,
                });
                self.state.acting.replace_errand(errand);
            }
        }
        true
    }

    /// Changes the goal of a creature on its way.
    fn send_elsewhere(&mut self, errand: Errand, to: DVec3) {
        let moved = (to - errand.to).with_y(0.0).length();
        let errand = Errand { to, ..errand };
        self.state.acting.replace_errand(Some(errand));
        self.state.walked.progress.set_blocked(false);
        if moved > ARRIVAL_DISTANCE * self.size.height {
            self.state.walked = self.state.walked.to_another_goal();
            self.look_soon();
        }
    }

    /// The place to which the creature was sent; `None` once it has arrived or given up.
    pub fn sent_to(&self) -> Option<DVec3> {
        self.state.acting.errand().map(|errand| errand.to)
    }

    /// Puts the brain into a state, by the state's name in the file, as an interrupting transition would. Returns false
    /// and changes nothing if there is no such state.
    pub fn enter(&mut self, state: &str) -> bool {
        let brain = self.kind.brain();
        let Some(to) = brain.find(state) else {
            return false;
        };
        let from = self.state.brain.current();
        brain.go_to(&mut self.state.brain, to);
        let to = self.state.brain.current();
        self.leave_act();
        self.state.acting.halt(true);
        let (acting, damage) = (&mut self.state.acting, &mut self.state.damage);
        damage.tell(CreatureEvent::Entered { from, to });
        if self.kind.brain().is_final(to)
            && let Some(errand) = acting.replace_errand(None)
        {
            let place = errand.to;
            damage.tell(CreatureEvent::Stopped { place });
        }
        true
    }

    /// Damages a weak point, open or not, by its index in
    /// [`CreatureKind::weak_points`](crate::CreatureKind::weak_points): for example by a fall onto a rock, or by fire.
    /// Returns the damage done, which is at most the hit points that were left. Returns `None` and changes nothing if
    /// there is no such weak point, or if the damage is negative or not finite.
    pub fn harm(&mut self, weak_point: usize, damage: f64) -> Option<f64> {
        let left = *self.state.hit_points().get(weak_point)?;
        if !(0.0..=f64::MAX).contains(&damage) {
            return None;
        }
        Some(if left > 0.0 {
            self.wound(weak_point, damage)
        } else {
            0.0
        })
    }

    fn leave_act(&mut self) {
        self.state.acting.end();
        self.state.striking.begin();
        self.state.ranged.begin();
        // An errand keeps its way.
        if self.state.acting.errand().is_none() {
            self.state.walked = Walked::default();
        }
        self.state.senses.begin_act();
    }

    /// The way that the creature goes: to the place where it was sent, or as its act leads it.
    pub(super) fn current_way(&self) -> Option<Way> {
        if let Some(errand) = self.state.acting.errand() {
            return errand.has_begun.then_some(Way {
                goal: errand.to,
                bearing: None,
                within: ARRIVAL_DISTANCE * self.size.height,
                within_angle: 0.0,
                walks: true,
            });
        }
        let state = self.state.brain.current();
        self.way(state)
            .filter(|_| self.state.acting.has_begun(state))
    }

    /// Ends the errand if the creature has arrived or is blocked.
    pub(super) fn end_errand(&mut self, is_there: bool, is_blocked: bool) {
        let errand = self.state.acting.errand();
        let Some(errand) = errand.filter(|errand| errand.has_begun) else {
            return;
        };
        let place = errand.to;
        if is_blocked {
            self.drop_errand();
        } else if is_there && !self.state.walked.progress.is_blocked() {
            self.state.acting.replace_errand(None);
            self.state.walked = Walked::default();
            self.report.events.push(CreatureEvent::Arrived { place });
        }
    }

    /// Gives the errand up, if there is one.
    pub(super) fn drop_errand(&mut self) {
        if let Some(errand) = self.state.acting.replace_errand(None) {
            let place = errand.to;
            self.state.walked = Walked::default();
            self.report.events.push(CreatureEvent::Stopped { place });
        }
    }
}
