//! The bot's weapons: arrows from the ground, and stabs where it has got to.

use clamber_climber::{ClimberInput, ClimberMode};
use clamber_fight::actions::{BOW, STAB};
use clamber_fight::aim::lead;
use clamber_fight::{Act, FighterId};
use glam::DVec3;

use super::Performer;
use super::performer::Sight;
use super::planner::Aim;
use super::scene::TICK;

/// Arrows that it shoots before it comes near.
const ARROWS: u32 = 2;

/// It shoots from so far, metres.
const RANGE: [f64; 2] = [14.0, 60.0];

/// Ticks for which it draws.
const DRAW: u32 = 66;

/// It does not begin a stab in a shake beyond this, metres a second squared, or with less stamina.
const CALM: f64 = 6.0;
const STRONG: f64 = 0.15;

/// It strikes with this charge.
const FULL: f64 = 0.999;

/// Memory of its weapons.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fencer {
    shot: u32,
    drawn: u32,
    /// It pressed the button in the last tick.
    pressed: bool,
    /// Where its aim was a tick ago.
    target: Option<DVec3>,
}

impl Fencer {
    /// The input of a stab: begins one if the blade would go where it should, and goes on with it. `None` if there is
    /// none.
    pub(super) fn stab(&mut self, performer: &Performer<'_>, aim: Aim) -> Option<ClimberInput> {
        let fighter = performer.fighter()?;
        let state = fighter.climber().state();
        let holds = |actions| ClimberInput {
            grip: true,
            actions,
            ..ClimberInput::default()
        };
        let was_pressed = std::mem::replace(&mut self.pressed, false);
        let mut press = |is_down: bool| {
            self.pressed = is_down;
            Some(holds(if is_down { STAB } else { 0 }))
        };
        match fighter.act() {
            Act::Raise { .. } => press(true),
            // Full: let go, and press again.
            Act::Charge { charge, .. } => press(*charge < FULL || !was_pressed),
            Act::Strike { .. } | Act::Plunge { .. } | Act::PullOut { .. } => press(false),
            Act::Ready => {
                // No terrain is between them while it stands on the creature.
                let aimed = performer.arena()?.stab_aim(FighterId(0), &[])?;
                let is_right = match aim.plate {
                    Some(plate) => aimed.plate == Some(plate),
                    None => aimed.plate.is_none() && aimed.weak_point == aim.weak_point,
                };
                let is_firm = matches!(state.mode, ClimberMode::Standing | ClimberMode::Holding);
                let can = is_right && aim.weak_point.is_some() && is_firm;
                let can = can && state.shake.length() < CALM && state.stamina > STRONG;
                if can { press(!was_pressed) } else { None }
            }
            Act::Cut { .. } | Act::Draw { .. } | Act::Throw { .. } => None,
        }
    }

    /// How far the blade would miss its weak point, and where to: a vector; `None` if there is no skin before it.
    pub(super) fn miss(&self, performer: &Performer<'_>, aim: Aim) -> Option<DVec3> {
        let place = performer.life()?.weak_point(aim.weak_point?)?;
        let aimed = performer.arena()?.stab_aim(FighterId(0), &[])?;
        Some(place - aimed.place)
    }

    /// The input of a shot from the ground; `None` if it does not shoot.
    pub(super) fn shoot(
        &mut self,
        performer: &Performer<'_>,
        sight: Sight,
    ) -> Option<ClimberInput> {
        let fighter = performer.fighter()?;
        let (climber, arena) = (fighter.climber(), performer.arena()?);
        let from = fighter.nock()?;
        let (_, _, place) = arena.next_weak_point(from)?;
        let velocity = self
            .target
            .map_or(DVec3::ZERO, |before| (place - before) / TICK);
        self.target = Some(place);
        let is_far = (RANGE[0]..RANGE[1]).contains(&place.distance(from));
        let stands = climber.state().mode == ClimberMode::Standing;
        if self.shot >= ARROWS || sight.attacks || !stands || !is_far {
            self.drawn = 0;
            return None;
        }
        let bow = fighter.config().bow?;
        let gravity = arena.config().gravity;
        let aim = lead(from, place, velocity, gravity, bow.speed).map(|lead| lead.velocity);
        let lets_go = self.drawn >= DRAW;
        if lets_go {
            (self.shot, self.drawn) = (self.shot + 1, 0);
        } else {
            self.drawn += 1;
        }
        Some(ClimberInput {
            actions: if lets_go { 0 } else { BOW },
            aim: aim.unwrap_or(place - from),
            ..ClimberInput::default()
        })
    }

    /// It is put back to the start: its arrows are shot.
    pub(super) fn begin_again(&mut self) {
        *self = Self {
            shot: self.shot,
            ..Self::default()
        };
    }
}
