//! The bot's weapons: arrows from the ground, and stabs where it has got to.

use clamber_climber::{ClimberInput, ClimberMode};
use clamber_fight::actions::{BOW, STAB};
use clamber_fight::aim::lead;
use clamber_fight::{Arena, FighterId, WeaponAction};
use glam::DVec3;

use super::bot::{Target, giant};
use super::{GRIP, TICK};

/// Arrows that the bot shoots before it comes near.
const ARROWS: u32 = 2;

/// Least and largest distance of a shot, metres.
const RANGE: [f64; 2] = [14.0, 60.0];

/// Ticks for which the bot draws its bow.
const DRAW: u32 = 66;

/// Shake up to which the bot begins a stab, metres a second squared.
const CALM: f64 = 6.0;
/// Least stamina with which the bot begins a stab.
const STRONG: f64 = 0.15;

/// Charge at which the bot strikes.
const FULL: f64 = 0.999;

/// The fighter that the bot plays.
const HERO: FighterId = FighterId(0);

/// What the bot remembers of its weapons.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fencer {
    /// Arrows that were shot.
    shot: u32,
    /// Ticks for which the bow has been drawn.
    drawn: u32,
    /// The button was down in the last tick.
    pressed: bool,
    /// Position of the target a tick ago.
    target: Option<DVec3>,
}

impl Fencer {
    /// The input of a stab, which begins if the blade would hit the target, and is continued; `None` without a stab.
    pub(super) fn stab(&mut self, arena: &Arena, target: &Target) -> Option<ClimberInput> {
        let fighter = arena.fighter(HERO)?;
        let state = fighter.climber().state();
        let was_pressed = std::mem::replace(&mut self.pressed, false);
        let mut press = |is_down: bool| {
            self.pressed = is_down;
            let actions = if is_down { STAB } else { 0 };
            Some(ClimberInput { actions, ..GRIP })
        };
        match fighter.act() {
            WeaponAction::Raise { .. } => press(true),
            // Full: let go, and press again.
            WeaponAction::Charge { charge, .. } => press(*charge < FULL || !was_pressed),
            WeaponAction::Strike { .. }
            | WeaponAction::Plunge { .. }
            | WeaponAction::PullOut { .. } => press(false),
            WeaponAction::Ready => {
                // No terrain is between them while it stands on the creature.
                let aimed = arena.stab_aim(HERO, &[])?;
                let is_right = aimed.plate == target.plate
                    && (target.plate.is_some() || aimed.weak_point == Some(target.weak_point));
                let is_firm = matches!(state.mode, ClimberMode::Standing | ClimberMode::Holding);
                let is_able = state.shake.length() < CALM && state.stamina > STRONG;
                let can = is_right && is_firm && is_able;
                if can { press(!was_pressed) } else { None }
            }
            WeaponAction::Cut { .. } | WeaponAction::Draw { .. } | WeaponAction::Throw { .. } => {
                None
            }
        }
    }

    /// The vector from the point that the blade would hit to the weak point; `None` if there is no skin before the
    /// blade.
    pub(super) fn miss(&self, arena: &Arena, target: &Target) -> Option<DVec3> {
        let place = giant(arena).weak_point(target.weak_point)?;
        let aimed = arena.stab_aim(HERO, &[])?;
        Some(place - aimed.place)
    }

    /// The input of a shot from the ground; `None` without a shot.
    pub(super) fn shoot(&mut self, arena: &Arena, is_attacked: bool) -> Option<ClimberInput> {
        let fighter = arena.fighter(HERO)?;
        let climber = fighter.climber();
        let from = fighter.nock()?;
        let (_, _, place) = arena.next_weak_point(from)?;
        let velocity = self
            .target
            .map_or(DVec3::ZERO, |before| (place - before) / TICK);
        self.target = Some(place);
        let is_far = (RANGE[0]..RANGE[1]).contains(&place.distance(from));
        let stands = climber.state().mode == ClimberMode::Standing;
        if self.shot >= ARROWS || is_attacked || !stands || !is_far {
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

    /// The climber was put back to the start; the arrows that it shot are gone.
    pub(super) fn begin_again(&mut self) {
        *self = Self {
            shot: self.shot,
            ..Self::default()
        };
    }
}
