//! Effects of orders on a fighter.

use clamber_climber::{Climber, ClimberError, ClimberState, Knockback};
use glam::DVec3;

use super::{Fighter, WeaponAction};

impl Fighter {
    /// Moves the climber to a place, at rest in the air. It keeps its hit points, its stamina and its heading.
    pub(super) fn put(&mut self, place: DVec3) -> Result<(), ClimberError> {
        let before = *self.climber.state();
        let fresh = Climber::new(self.config.climber, place)?;
        self.climber.restore(ClimberState {
            hit_points: before.hit_points,
            stamina: before.stamina,
            heading: before.heading,
            ..*fresh.state()
        })
    }

    /// Moves the fighter to a place; the step moves it aside if that is occupied. Its act ends, and blows and harm that
    /// wait for the next tick are dropped.
    pub(crate) fn place(&mut self, place: DVec3) -> Result<(), ClimberError> {
        self.put(place)?;
        self.state.act = WeaponAction::Ready;
        self.state.hit_stop = 0.0;
        self.state.has_begun = false;
        (self.state.knockback, self.state.harm) = (None, 0.0);
        Ok(())
    }

    /// Takes hit points. A fighter without hit points dies in this step.
    pub(crate) fn hurt(&mut self, damage: f64) -> Result<(), ClimberError> {
        if self.is_dead() {
            return Ok(());
        }
        let mut state = *self.climber.state();
        state.hit_points = (state.hit_points - damage).max(0.0);
        self.climber.restore(state)
    }

    /// Gives hit points and stamina to a living fighter, up to 1 each.
    pub(crate) fn heal(&mut self, hit_points: f64, stamina: f64) -> Result<(), ClimberError> {
        if self.is_dead() {
            return Ok(());
        }
        let mut state = *self.climber.state();
        state.hit_points = (state.hit_points + hit_points).min(1.0);
        state.stamina = (state.stamina + stamina).min(1.0);
        self.climber.restore(state)
    }

    /// Stores a blow for the climber's next step. Among several blows, the hardest one's velocity counts, and the
    /// damages add up.
    pub(crate) fn be_struck(&mut self, mut dealt: Knockback) {
        if let Some(other) = self.state.knockback {
            if other.velocity.length_squared() >= dealt.velocity.length_squared() {
                (dealt.velocity, dealt.by) = (other.velocity, other.by);
            }
            dealt.damage = (dealt.damage + other.damage).min(1.0);
        }
        self.state.knockback = Some(dealt);
    }

    /// The knockback for the climber's next step.
    pub(crate) fn take_knockback(&mut self) -> Option<Knockback> {
        self.state.knockback.take()
    }

    /// Revives a dead fighter at its spawn point. Returns true if it was dead.
    pub(crate) fn rise(&mut self) -> Result<bool, ClimberError> {
        let is_dead = self.is_dead();
        if is_dead {
            self.stand_up_again(self.state.spawn)?;
            self.state.has_begun = false;
        }
        Ok(is_dead)
    }
}
