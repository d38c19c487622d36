//! What a player sees coming: wind-ups.

use std::sync::Arc;

use clamber_colossus::Foresight;
use clamber_colossus::brain::StateId;
use clamber_navigation::FutureSkin;
use clamber_surface::rig::Palette;

use super::Performer;
use super::scene::{CREATURE, TICK};

/// It takes so long to see what a creature has begun, seconds.
const REACTION: f64 = 0.25;

/// It looks so far ahead, in steps, and every so many ticks.
const AHEAD: f64 = 0.6;
const STEP: f64 = 0.1;
const EVERY: u32 = 6;

/// The eyes of a skilled player.
#[derive(Clone, Debug)]
pub(super) struct Eyes {
    skin: FutureSkin,
    foresight: Foresight,
    /// What the creature does, and for how many ticks it has been seen doing it.
    state: Option<StateId>,
    seen: u32,
    shake: f64,
}

impl Eyes {
    pub(super) fn new(performer: &Performer<'_>) -> Self {
        Self {
            skin: FutureSkin::new(Arc::clone(&performer.creature().collider)),
            foresight: Foresight::default(),
            state: None,
            seen: 0,
            shake: 0.0,
        }
    }

    /// The hardest shake that is about to come where the climber is, metres a second squared: 0 as long as it has not
    /// been seen coming.
    pub(super) fn shake_ahead(&mut self, performer: &Performer<'_>) -> f64 {
        let Some(life) = performer.life() else {
            return 0.0;
        };
        let state = life.state().current();
        self.seen = if self.state.replace(state) == Some(state) {
            self.seen.saturating_add(1)
        } else {
            0
        };
        if f64::from(self.seen) * TICK < REACTION || performer.climber().state().support.is_none() {
            self.shake = 0.0;
        } else if self.seen.is_multiple_of(EVERY) {
            let foresight = &mut self.foresight;
            let mut future = |seconds: f64, palette: &mut Palette| {
                life.foresee(seconds, foresight, palette).ok()
            };
            let ahead =
                self.skin
                    .shake_ahead(performer.climber(), CREATURE, &mut future, STEP, AHEAD);
            self.shake = ahead.unwrap_or(0.0);
        }
        self.shake
    }
}
