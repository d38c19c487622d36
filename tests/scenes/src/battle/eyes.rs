//! A skilled player's view of wind-ups.

use std::sync::Arc;

use clamber_climber::Climber;
use clamber_colossus::brain::StateId;
use clamber_colossus::{Creature, Foresight};
use clamber_navigation::FutureSkin;
use clamber_surface::mesh::ColliderMesh;
use clamber_surface::rig::Palette;

use super::{CREATURE, TICK};

/// Time that a player needs to see what a creature has begun, seconds.
const REACTION: f64 = 0.25;

/// Time that a player looks ahead, seconds.
const AHEAD: f64 = 0.6;
/// Steps in which the future is looked at, seconds.
const STEP: f64 = 0.1;
/// Ticks between two looks ahead.
const EVERY: u32 = 6;

/// What the bot knows of the creature's future.
#[derive(Clone, Debug)]
pub(super) struct Eyes {
    skin: FutureSkin,
    foresight: Foresight,
    /// The state of the creature's brain.
    state: Option<StateId>,
    /// Ticks for which it has been in that state.
    seen: u32,
    shake: f64,
}

impl Eyes {
    pub(super) fn new(mesh: &Arc<ColliderMesh>) -> Self {
        Self {
            skin: FutureSkin::new(Arc::clone(mesh)),
            foresight: Foresight::default(),
            state: None,
            seen: 0,
            shake: 0.0,
        }
    }

    /// The hardest shake in the near future where the climber is, metres a second squared; 0 until it is seen coming.
    pub(super) fn shake_ahead(&mut self, life: &Creature, climber: &Climber) -> f64 {
        let state = life.state().current();
        let is_same = self.state.replace(state) == Some(state);
        self.seen = if is_same { self.seen + 1 } else { 0 };
        if f64::from(self.seen) * TICK < REACTION || climber.state().support.is_none() {
            self.shake = 0.0;
        } else if self.seen.is_multiple_of(EVERY) {
            let foresight = &mut self.foresight;
            let mut future = |seconds: f64, palette: &mut Palette| {
                life.foresee(seconds, foresight, palette).ok()
            };
            let skin = &mut self.skin;
            let ahead = skin.shake_ahead(climber, CREATURE, &mut future, STEP, AHEAD);
            self.shake = ahead.unwrap_or(0.0);
        }
        self.shake
    }
}
