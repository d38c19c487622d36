mod fingerprint;
mod mode;
mod support;

pub use mode::{ClimberMode, TRANSITIONS};
pub use support::Support;

use glam::DVec3;

use crate::ClimberError;
use crate::step::{
    FlyingMemory, HangingMemory, LedgeHangingMemory, StandingMemory, TumblingMemory,
};

/// Everything a climber remembers between ticks: a small plain value. Restored, it continues with
/// the same bits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClimberState {
    /// Centre of its ball, in world space, metres.
    pub position: DVec3,
    /// In world space, metres a second: of the last tick.
    pub velocity: DVec3,
    /// Of what supports it, or supported it last, in world space, metres a second: what its own motion is measured
    /// against, so that a fall and a late jump are the same in every frame that moves steadily.
    pub base_velocity: DVec3,
    /// Unit vector, perpendicular to up: where it faces.
    pub heading: DVec3,
    /// What it is doing.
    pub mode: ClimberMode,
    /// The ground underfoot, the hold that it grips, or the ledge it hangs from; `None` in the air.
    pub support: Option<Support>,
    /// Velocity of what supports it over the last tick; `None` when that was just found, or was put elsewhere.
    pub support_velocity: Option<DVec3>,
    /// Acceleration of what supports it as it is felt, metres a second squared: filtered.
    pub shake: DVec3,
    /// 0 to 1.
    pub stamina: f64,
    /// 0 to 1.
    pub hit_points: f64,
    /// For how long a jump still works without ground, seconds.
    pub coyote: f64,
    /// For how long a jump is still remembered, seconds.
    pub jump_buffer: f64,
    /// For how long it grips nothing after it has let go, seconds.
    pub open_handed: f64,
    /// Only its ball stands in the way: there is no room to stand up.
    pub crouched: bool,
    /// What closed in on it left it too little room in the last tick.
    pub crushed: bool,
    /// What it remembers while it stands.
    pub standing: StandingMemory,
    /// What it remembers while it falls or slides.
    pub flying: FlyingMemory,
    /// What it remembers while it lies knocked over.
    pub tumbling: TumblingMemory,
    /// What it remembers while it hangs by its hands.
    pub hanging: HangingMemory,
    /// What it remembers while it hangs from a ledge.
    pub ledge_hanging: LedgeHangingMemory,
    /// Numbers of modes of the game's own, in whatever mode it is: timers, directions. Any finite values.
    pub memory: [f64; MEMORY],
}

/// How many numbers modes of a game's own may remember.
pub const MEMORY: usize = 8;

/// How far from 1 the length of a unit vector may be that was written down and read again.
const UNIT: f64 = 1e-6;

impl ClimberState {
    pub(crate) fn new(position: DVec3, up: DVec3) -> Self {
        Self {
            position,
            velocity: DVec3::ZERO,
            base_velocity: DVec3::ZERO,
            heading: up.any_orthonormal_vector(),
            mode: ClimberMode::Falling,
            support: None,
            support_velocity: None,
            shake: DVec3::ZERO,
            stamina: 1.0,
            hit_points: 1.0,
            coyote: 0.0,
            jump_buffer: 0.0,
            open_handed: 0.0,
            crouched: false,
            crushed: false,
            standing: StandingMemory::default(),
            flying: FlyingMemory::default(),
            tumbling: TumblingMemory::default(),
            hanging: HangingMemory::default(),
            ledge_hanging: LedgeHangingMemory::default(),
            memory: [0.0; MEMORY],
        }
    }

    /// Refuses what no climber can be in.
    pub(crate) fn validate(&self) -> Result<(), ClimberError> {
        if !self.is_finite() {
            return Err(ClimberError::NotFinite("state"));
        }
        let is_consistent = self.mode.is_supported() == self.support.is_some();
        if !is_consistent && !self.mode.is_custom() {
            return Err(ClimberError::Support(self.mode));
        }
        for (name, found) in self.numbers() {
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
        if (length - 1.0).abs() > UNIT {
            return Err(ClimberError::OutOfRange {
                name: "length of heading",
                range: "1",
                found: length,
            });
        }
        Ok(())
    }

    fn vectors(&self) -> [DVec3; 6] {
        [
            self.position,
            self.velocity,
            self.base_velocity,
            self.heading,
            self.shake,
            self.hanging.legs,
        ]
    }

    /// Each with its name.
    fn numbers(&self) -> [(&'static str, f64); 9] {
        [
            ("stamina", self.stamina),
            ("hit_points", self.hit_points),
            ("hanging.arm", self.hanging.arm),
            ("ledge_hanging.pull_up", self.ledge_hanging.pull_up),
            ("hanging.calm", self.hanging.calm),
            ("tumbling.still", self.tumbling.still),
            ("coyote", self.coyote),
            ("jump_buffer", self.jump_buffer),
            ("open_handed", self.open_handed),
        ]
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.vectors().iter().all(|v| v.is_finite())
            && self.memory.iter().all(|x| x.is_finite())
            && self.numbers().iter().all(|(_, x)| x.is_finite())
            && self.support.is_none_or(|support| support.is_finite())
            && self.support_velocity.is_none_or(DVec3::is_finite)
    }
}
