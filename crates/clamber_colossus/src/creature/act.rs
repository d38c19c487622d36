//! The act of the brain's state: it begins once the creature stands, unless the game has sent the creature somewhere.

use clamber_animation::rig::Playback;
use serde::{Deserialize, Serialize};

use super::clips::Playing;
use super::move_on::Progress;
use super::ordered::Errand;
use super::{Creature, Surroundings};
use crate::brain::{StateAction, StateId};
use crate::error::ColossusError;

/// Share of the walking speed below which the creature has come to a stand, so that an act of another kind can begin.
const STANDING_SPEED_SHARE: f64 = 0.12;

/// The errand or the act that a creature carries out. An errand of the game comes before the act of the brain's state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Acting {
    /// State whose act has begun. It differs from the brain's state while the creature still comes to a stop.
    state: Option<StateId>,
    /// Where the game has sent the creature. Acts wait for the end of the errand.
    errand: Option<Errand>,
    /// True while the creature stops abruptly.
    halts: bool,
}

impl Acting {
    /// State whose act has begun.
    pub(super) fn state(&self) -> Option<StateId> {
        self.state
    }

    /// True if the act of a state has begun.
    pub(super) fn has_begun(&self, state: StateId) -> bool {
        self.state == Some(state)
    }

    /// Ends the act.
    pub(super) fn end(&mut self) {
        self.state = None;
    }

    /// True while the creature stops abruptly.
    pub(super) fn halts(&self) -> bool {
        self.halts
    }

    /// Sets whether the creature stops abruptly.
    pub(super) fn halt(&mut self, halts: bool) {
        self.halts = halts;
    }

    /// Where the game has sent the creature.
    pub(super) fn errand(&self) -> Option<Errand> {
        self.errand
    }

    /// Replaces the errand, and returns the one before.
    pub(super) fn replace_errand(&mut self, errand: Option<Errand>) -> Option<Errand> {
        std::mem::replace(&mut self.errand, errand)
    }

    /// The same for a creature with another brain. `same` converts a state. A creature that cannot walk has no errand.
    pub(super) fn carry_over(
        &self,
        same: impl Fn(StateId) -> Option<StateId>,
        can_walk: bool,
    ) -> Self {
        Self {
            state: self.state.and_then(same),
            errand: self.errand.filter(|_| can_walk),
            halts: self.halts,
        }
    }

    /// True if a brain with `states` states can have this act.
    pub(super) fn fits(&self, states: usize) -> bool {
        self.state.is_none_or(|state| state.index() < states)
    }
}

impl Creature {
    /// Begins the act of the current state once the creature stands, or continues it. A walk begins at once, and so
    /// does an act after an interrupting transition, for which the creature stops abruptly.
    pub(super) fn act(&mut self, around: &Surroundings<'_>) -> Result<(), ColossusError> {
        let acting = &mut self.state.acting;
        if let Some(errand) = &mut acting.errand {
            errand.begin();
            acting.halts = false;
            return Ok(());
        }
        let state = self.state.brain.current();
        if self.state.acting.has_begun(state) {
            return Ok(());
        }
        let kind = std::sync::Arc::clone(&self.kind);
        let act = kind.brain().act(state);
        let walks = matches!(act, Some(StateAction::Walk(_)));
        let speed = kind.gait().map_or(0.0, |gait| self.full_speed(gait));
        let is_moving = self.state.speed().abs() > STANDING_SPEED_SHARE * speed;
        // An attack aims once, and would strike elsewhere if the creature turned on.
        let turns = matches!(act, Some(StateAction::Attack(_))) && self.is_turning();
        if !walks && !self.state.acting.halts && (is_moving || turns) {
            return Ok(());
        }
        self.state.acting.state = Some(state);
        // The creature stops abruptly while the act already plays.
        self.state.acting.halts = !walks && self.state.speed() != 0.0;
        self.state.striking.begin();
        self.state.ranged.begin();
        self.state.walked.progress = Progress::default();
        match act {
            Some(StateAction::Walk(_) | StateAction::Turn(_)) => self.begin_way(),
            Some(StateAction::Play(_)) => self.begin(state, Playback::Loop)?,
            Some(StateAction::Once(_)) => self.begin(state, Playback::Clamp)?,
            Some(StateAction::Attack(_)) => self.begin_attack(state, around)?,
            Some(StateAction::Sleep) => self.state.clips.stop(),
            None => self.play(Playing::Idle, 1.0, kind.brain().fade(state))?,
        }
        // Clips that sleep has stopped go on only now, so that the fade to the new clip begins without motion.
        let is_way = matches!(act, Some(StateAction::Walk(_) | StateAction::Turn(_)))
            && kind.gait().is_some();
        if !is_way && !matches!(act, Some(StateAction::Sleep)) {
            self.state.clips.go_on();
        }
        Ok(())
    }

    /// Begins an attack, unless a part of the creature would go through rock or another creature in it.
    fn begin_attack(
        &mut self,
        state: StateId,
        around: &Surroundings<'_>,
    ) -> Result<(), ColossusError> {
        let kind = std::sync::Arc::clone(&self.kind);
        if let Some(strike) = &kind.act(state).strike {
            self.aim(strike);
            self.mark_prey();
            if !self.may_strike(strike, around) {
                self.state.walked.progress.set_blocked(true);
                if kind.gait().is_none() {
                    self.state.clips.stand();
                }
                return self.play(Playing::Idle, 1.0, kind.brain().fade(state));
            }
        }
        self.begin(state, Playback::Clamp)
    }
}
