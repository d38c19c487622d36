use clamber_world::ObstacleId;
use glam::DVec3;

use crate::ClimberError;

/// What a player wants of a climber this tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClimberInput {
    /// Direction to go in, in world space; its length, at most 1, is the share of full speed. The part along up does not
    /// count. On a hold it is tilted as the hold is from level ground: pushing against a wall climbs it, pulling away
    /// climbs down.
    pub walk: DVec3,
    /// Direction to climb in, in world space, of which the part along the hold counts; if it is zero, `walk` does. For
    /// those who know where they want to go: bots, and cameras that look at the wall.
    pub climb: DVec3,
    /// True to jump, off the ground or off a hold. Once is enough: what comes a little early or late counts.
    pub jump: bool,
    /// True as long as the jump button is down. Matters only with
    /// [`GroundConfig::jump_release_gravity`](crate::GroundConfig::jump_release_gravity) above 1.
    pub jump_held: bool,
    /// True as long as it grips, or wants to.
    pub grip: bool,
    /// What struck it.
    pub blow: Option<Blow>,
    /// Buttons of the game's own, one a bit, for modes of its own.
    pub actions: u32,
    /// Where the player aims: a direction in world space of any length, for modes of the game's own.
    pub aim: DVec3,
}

/// A blow that strikes a climber.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Blow {
    /// By how much it changes the climber's velocity, in world space, metres a second.
    pub velocity: DVec3,
    /// Hit points that it costs, 0 to 1.
    pub damage: f64,
    /// Which obstacle dealt it, if one did.
    pub by: Option<ObstacleId>,
}

impl ClimberInput {
    /// Wants nothing.
    pub const IDLE: Self = Self {
        walk: DVec3::ZERO,
        climb: DVec3::ZERO,
        jump: false,
        jump_held: false,
        grip: false,
        blow: None,
        actions: 0,
        aim: DVec3::ZERO,
    };

    pub(crate) fn validate(&self) -> Result<(), ClimberError> {
        let vectors = [self.walk, self.climb, self.aim];
        if !vectors.iter().all(|v| v.is_finite()) {
            return Err(ClimberError::NotFinite("input"));
        }
        let Some(blow) = &self.blow else {
            return Ok(());
        };
        if !blow.velocity.is_finite() || !blow.damage.is_finite() {
            return Err(ClimberError::NotFinite("input"));
        }
        if !(0.0..=1.0).contains(&blow.damage) {
            return Err(ClimberError::OutOfRange {
                name: "blow.damage",
                range: "from 0 to 1",
                found: blow.damage,
            });
        }
        Ok(())
    }
}
