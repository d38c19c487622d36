use glam::DVec3;

use crate::ClimberError;

/// The player's input to a climber for one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct ClimberInput {
    /// Direction to walk or climb in, in world space. Its length is the share of full speed; more than 1 counts as 1.
    /// The component along up is ignored. On a hold, the climbing direction is found when the stick is pressed, or
    /// turned by more than 20 degrees: towards a wall means up, away from it means down, and under a ceiling `walk`
    /// itself is the direction. While the stick is held, the climber goes on in one direction, over bumps, round edges,
    /// and from a wall onto its ceiling ([`HoldingMemory`](crate::HoldingMemory)).
    pub walk: DVec3,
    /// Direction to climb in, in world space, on holds and ledges. Only its component along the hold counts. Zero:
    /// `walk` is used instead. For bots, and for cameras that look at the wall.
    pub climb: DVec3,
    /// True in the tick in which the player asks for a jump, off the ground or off a hold. A jump that comes a little
    /// early or late still counts ([`GroundConfig::jump_buffer`](crate::GroundConfig::jump_buffer),
    /// [`GroundConfig::coyote_time`](crate::GroundConfig::coyote_time)).
    pub jump: bool,
    /// True as long as the jump button is down. Used only with
    /// [`GroundConfig::jump_release_gravity`](crate::GroundConfig::jump_release_gravity) above 1.
    pub jump_held: bool,
    /// True as long as the grip button is down: the climber grips a hold in reach and holds on. False lets go.
    pub grip: bool,
    /// True as long as the crouch button is down. In every mode, a body with a height
    /// ([`BodyConfig::height`](crate::BodyConfig::height)) is then its lower ball alone. After the button is released,
    /// it is the whole capsule again where there is room. A body without a height does not change.
    pub crouch: bool,
    /// The game's own buttons, one bit each, for its custom modes. This crate ignores them; `clamber_fight` reads the
    /// lower 16 bits.
    pub actions: u32,
    /// Where the player aims: a direction in world space, of any length, for the game's custom modes. This crate
    /// ignores it; `clamber_fight` shoots there.
    pub aim: DVec3,
}

impl ClimberInput {
    /// No input.
    pub const IDLE: Self = Self {
        walk: DVec3::ZERO,
        climb: DVec3::ZERO,
        jump: false,
        jump_held: false,
        grip: false,
        crouch: false,
        actions: 0,
        aim: DVec3::ZERO,
    };

    pub(crate) fn validate(&self) -> Result<(), ClimberError> {
        let vectors = [self.walk, self.climb, self.aim];
        if vectors.iter().all(|v| v.is_finite()) {
            Ok(())
        } else {
            Err(ClimberError::NotFinite("input"))
        }
    }
}
