//! What orders do to a fighter.

use clamber_climber::{Blow, Climber, ClimberError, ClimberState};
use glam::DVec3;

use super::{Act, Fighter};

impl Fighter {
    /// Puts it somewhere else, at rest in the air, with the hit points, the stamina and the heading that it has.
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

    /// Puts it somewhere else; it goes aside if somebody is there. What it did with its weapons is over, and so is what
    /// struck or crushed it in the last tick.
    pub(crate) fn place(&mut self, place: DVec3) -> Result<(), ClimberError> {
        self.put(place)?;
        self.state.act = Act::Ready;
        self.state.hit_stop = 0.0;
        self.state.has_begun = false;
        (self.state.blow, self.state.harm) = (None, 0.0);
        Ok(())
    }

    /// Loses hit points. Without any left it dies in this step.
    pub(crate) fn hurt(&mut self, damage: f64) -> Result<(), ClimberError> {
        if self.is_dead() {
            return Ok(());
        }
        let mut state = *self.climber.state();
        state.hit_points = (state.hit_points - damage).max(0.0);
        self.climber.restore(state)
    }

    /// Gives hit points and stamina back, unless it is dead.
    pub(crate) fn heal(&mut self, hit_points: f64, stamina: f64) -> Result<(), ClimberError> {
        if self.is_dead() {
            return Ok(());
        }
        let mut state = *self.climber.state();
        state.hit_points = (state.hit_points + hit_points).min(1.0);
        state.stamina = (state.stamina + stamina).min(1.0);
        self.climber.restore(state)
    }

    /// Takes a blow with the next step of its climber: of several the hardest, with the damage of all.
    pub(crate) fn take_blow(&mut self, mut dealt: Blow) {
        if let Some(other) = self.state.blow {
            if other.velocity.length_squared() >= dealt.velocity.length_squared() {
                (dealt.velocity, dealt.by) = (other.velocity, other.by);
            }
            dealt.damage = (dealt.damage + other.damage).min(1.0);
        }
        self.state.blow = Some(dealt);
    }

    /// Stands up again where it rises, if it is dead; true if it was.
    pub(crate) fn rise(&mut self) -> Result<bool, ClimberError> {
        let is_dead = self.is_dead();
        if is_dead {
            self.stand_up_again(self.state.spawn)?;
            self.state.has_begun = false;
        }
        Ok(is_dead)
    }
}
