mod fingerprint;
mod mode;
mod support;

pub use mode::{ClimberMode, TRANSITIONS};
pub use support::Support;

use glam::DVec3;

use crate::step::{
    FlyingMemory, HangingMemory, HoldingMemory, LedgeHangingMemory, StandingMemory, TumblingMemory,
};
use crate::{ClimberConfig, ClimberError};

/// Everything that a climber remembers between ticks.
///
/// A small plain value: save it, and [`Climber::restore`](crate::Climber::restore) continues the run with the same
/// bits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct ClimberState {
    /// Centre of its ball, in world space, metres. For a capsule, centre of the lower ball.
    pub position: DVec3,
    /// Velocity after the last tick, in world space, metres a second. It excludes corrections of position, such as
    /// steps up, and displacements by other climbers: `own_way` over the tick's length includes both.
    pub velocity: DVec3,
    /// Velocity of the climber's support, in world space, metres a second; in the air, velocity of the last obstacle
    /// that it touched. A climber that has touched nothing for a second takes on the velocity of the air
    /// ([`StepRules::air_velocity`](crate::StepRules::air_velocity)) within the next second. The climber's own motion
    /// is measured against this velocity, so that a fall or a late jump is the same in every frame that moves steadily.
    pub base_velocity: DVec3,
    /// Displacement in the last tick beyond the support's, or beyond the climber's velocity in the air, in world space,
    /// metres. As an obstacle to others, the climber makes this displacement one tick later.
    pub own_way: DVec3,
    /// Direction that the climber faces: a unit vector perpendicular to up, in world space.
    pub heading: DVec3,
    /// The current mode.
    pub mode: ClimberMode,
    /// The ground underfoot, the hold that the climber grips, or the ledge that it hangs from. `None` in the air, while
    /// sliding or tumbling, and optional in a custom mode.
    pub support: Option<Support>,
    /// Velocity of the support over the last tick, in world space, metres a second. `None` without a support, and after
    /// the support was teleported or pushed by the climber's landing.
    pub support_velocity: Option<DVec3>,
    /// Share of the climber's weight that its support got in the last tick: 1 while the support is at rest, 0 while
    /// both fall freely. 0 without a support that can be pushed. Not negative.
    pub load: f64,
    /// Shake: the acceleration of the support, low-pass filtered over
    /// [`ClimberConfig::shake_time`](crate::ClimberConfig::shake_time), in world space, metres a second squared. Decays
    /// while the climber has no support.
    pub shake: DVec3,
    /// Strength left for holding on, 0 (the grip opens) to 1 (rested).
    pub stamina: f64,
    /// Hit points left, 0 to 1 (unhurt).
    pub hit_points: f64,
    /// Time left in which a jump still works without ground, seconds
    /// ([`GroundConfig::coyote_time`](crate::GroundConfig::coyote_time)).
    pub coyote: f64,
    /// Time left in which a jump that came early is remembered, seconds
    /// ([`GroundConfig::jump_buffer`](crate::GroundConfig::jump_buffer)).
    pub jump_buffer: f64,
    /// Time left in which the climber grips nothing after it let go, seconds.
    pub grip_cooldown: f64,
    /// Time since the climber last touched an obstacle, seconds, counted up to 2. 0 while it has a support.
    pub untouched: f64,
    /// True if the body is the ball alone although [`BodyConfig::height`](crate::BodyConfig::height) is not 0: the
    /// climber was asked to crouch ([`ClimberInput::crouch`](crate::ClimberInput::crouch)), holds on, was crushed, or
    /// has no room to stand up.
    pub crouched: bool,
    /// True if obstacles left the body too little room in the last tick.
    pub crushed: bool,
    /// Memory of [`ClimberMode::Standing`].
    pub standing: StandingMemory,
    /// Memory of [`ClimberMode::Falling`] and [`ClimberMode::Sliding`].
    pub flying: FlyingMemory,
    /// Memory of [`ClimberMode::Tumbling`].
    pub tumbling: TumblingMemory,
    /// Memory of [`ClimberMode::Holding`].
    pub holding: HoldingMemory,
    /// Memory of [`ClimberMode::Hanging`].
    pub hanging: HangingMemory,
    /// Memory of [`ClimberMode::LedgeHanging`].
    pub ledge_hanging: LedgeHangingMemory,
    /// Memory of the game's custom modes, such as timers and directions; kept in every mode. Any finite values.
    pub custom_slots: [f64; CUSTOM_SLOTS],
}

/// Number of values that a game's custom modes can remember, together.
pub const CUSTOM_SLOTS: usize = 8;

/// Largest difference of the heading's length from 1, so that a state can be saved with rounded decimals.
const UNIT_TOLERANCE: f64 = 1e-6;

/// Names of the state's numbers, in the order of [`ClimberState::numbers`].
const NUMBER_NAMES: [&str; 13] = [
    "stamina",
    "hit_points",
    "hanging.arm",
    "ledge_hanging.pull_up",
    "ledge_hanging.blocked",
    "hanging.calm",
    "tumbling.still",
    "tumbling.down",
    "coyote",
    "jump_buffer",
    "grip_cooldown",
    "untouched",
    "load",
];

impl ClimberState {
    pub(crate) fn new(position: DVec3, up: DVec3) -> Self {
        Self {
            position,
            velocity: DVec3::ZERO,
            base_velocity: DVec3::ZERO,
            own_way: DVec3::ZERO,
            heading: up.any_orthonormal_vector(),
            mode: ClimberMode::Falling,
            support: None,
            support_velocity: None,
            load: 0.0,
            shake: DVec3::ZERO,
            stamina: 1.0,
            hit_points: 1.0,
            coyote: 0.0,
            jump_buffer: 0.0,
            grip_cooldown: 0.0,
            untouched: 0.0,
            crouched: false,
            crushed: false,
            standing: StandingMemory::default(),
            flying: FlyingMemory::default(),
            tumbling: TumblingMemory::default(),
            holding: HoldingMemory::default(),
            hanging: HangingMemory::default(),
            ledge_hanging: LedgeHangingMemory::default(),
            custom_slots: [0.0; CUSTOM_SLOTS],
        }
    }

    /// Refuses states that no climber can be in.
    pub(crate) fn validate(&self) -> Result<(), ClimberError> {
        if !self.is_finite() {
            return Err(ClimberError::NotFinite("state"));
        }
        let is_consistent = self.mode.is_supported() == self.support.is_some();
        if !is_consistent && !self.mode.is_custom() {
            return Err(ClimberError::Support(self.mode));
        }
        for (name, found) in NUMBER_NAMES.into_iter().zip(self.numbers()) {
            let is_share = matches!(name, "stamina" | "hit_points" | "ledge_hanging.pull_up");
            let (range, most) = if is_share {
                ("from 0 to 1", 1.0)
            } else {
                ("not negative", f64::INFINITY)
            };
            if !(0.0..=most).contains(&found) {
                return Err(ClimberError::OutOfRange { name, range, found });
            }
        }
        let length = self.heading.length();
        if (length - 1.0).abs() > UNIT_TOLERANCE {
            return Err(ClimberError::OutOfRange {
                name: "length of heading",
                range: "1",
                found: length,
            });
        }
        Ok(())
    }

    /// The climber's acceleration by gravity, metres a second squared; zero while it has a support or is in a custom
    /// mode.
    pub(crate) fn fall(&self, config: &ClimberConfig) -> DVec3 {
        let falls = self.support.is_none() && !self.mode.is_custom();
        if falls { config.gravity } else { DVec3::ZERO }
    }

    /// The climber's displacement over the next tick if no support carries it and it meets no obstacle.
    pub(crate) fn own_displacement(&self, config: &ClimberConfig, dt: f64) -> DVec3 {
        (self.velocity + self.fall(config) * (0.5 * dt)) * dt
    }

    fn vectors(&self) -> [DVec3; 11] {
        [
            self.position,
            self.velocity,
            self.base_velocity,
            self.own_way,
            self.heading,
            self.shake,
            self.hanging.legs,
            self.holding.stick,
            self.holding.along,
            self.holding.normal,
            self.ledge_hanging.right,
        ]
    }

    /// Every number, in the order of [`NUMBER_NAMES`].
    fn numbers(&self) -> [f64; NUMBER_NAMES.len()] {
        [
            self.stamina,
            self.hit_points,
            self.hanging.arm,
            self.ledge_hanging.pull_up,
            self.ledge_hanging.blocked,
            self.hanging.calm,
            self.tumbling.still,
            self.tumbling.down,
            self.coyote,
            self.jump_buffer,
            self.grip_cooldown,
            self.untouched,
            self.load,
        ]
    }

    pub(crate) fn is_finite(&self) -> bool {
        // Zero times a number is zero, unless the number is infinite or NaN: one test for all of them.
        let vectors = self.vectors();
        let vectors = vectors.iter().fold(DVec3::ZERO, |sum, v| sum + *v * 0.0);
        let numbers = self.custom_slots.iter().fold(0.0, |sum, x| sum + x * 0.0);
        let numbers = self.numbers().iter().fold(numbers, |sum, x| sum + x * 0.0);
        vectors == DVec3::ZERO
            && numbers == 0.0
            && self.support.is_none_or(|support| support.is_finite())
            && self.support_velocity.is_none_or(DVec3::is_finite)
    }
}
