use super::check;
use super::ground::DEGREE;
use super::scale::Scale;
use crate::ClimberError;

/// Settings for gripping and climbing: [`ClimberConfig::grip`](crate::ClimberConfig::grip).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct GripConfig {
    /// Distance from the body's ball up to which the climber can grip, metres, not negative. Default 0.35, an arm.
    /// Raise it to grab more easily in flight. At 0 the climber grips nothing.
    pub reach: f64,
    /// Climbing speed under full input, relative to the hold, metres a second, not negative. Default 1.5.
    pub climb_speed: f64,
    /// Steepest surface that the climber climbs on, radians from level ground: a vertical wall is 90 degrees, a
    /// ceiling 180. From a steeper surface the climber only hangs. Not negative. Default 180 degrees: it climbs along
    /// ceilings. At 120 degrees it hangs from walls that lean over by more than 30.
    pub max_overhang: f64,
    /// Shake above which the climber only hangs, metres a second squared, not negative, may be infinite. Default 15.
    /// The climber climbs again once the shake has stayed below seven tenths of this for `calm_time`.
    pub hang_acceleration: f64,
    /// How long a hold has to stay calm before a climber that hangs from it pulls itself in to climb, seconds, not
    /// negative. Default 0.4. The time starts anew whenever the hold is not calm. A hold is calm if its shake is at
    /// most seven tenths of `hang_acceleration` and it is not steeper than `max_overhang`.
    pub calm_time: f64,
    /// Speed at which a jump leaves a hold or a ledge, away from it and upwards, metres a second, not negative. Default
    /// 4. A faster blow takes the climber off its hold.
    pub jump_speed: f64,
    /// Largest speed relative to a hold at which hands catch it in flight, metres a second, not negative, may be
    /// infinite. Default 15, a fall of 11 m. At a higher speed, the hands slip
    /// ([`ClimberEvent::HandsSlipped`](crate::ClimberEvent)). A slower catch costs
    /// [`StaminaConfig::catch_cost`](crate::StaminaConfig::catch_cost).
    pub catch_speed: f64,
}

impl GripConfig {
    /// Defaults of the fields: a person's arms.
    pub(super) const DEFAULT: Self = Self {
        reach: 0.35,
        climb_speed: 1.5,
        max_overhang: 180.0 * DEGREE,
        hang_acceleration: 15.0,
        calm_time: 0.4,
        jump_speed: 4.0,
        catch_speed: 15.0,
    };

    pub(super) fn scaled(self, scale: Scale) -> Self {
        Self {
            reach: self.reach * scale.length,
            climb_speed: self.climb_speed * scale.speed,
            max_overhang: self.max_overhang,
            hang_acceleration: self.hang_acceleration,
            calm_time: self.calm_time * scale.time,
            jump_speed: self.jump_speed * scale.speed,
            catch_speed: self.catch_speed * scale.speed,
        }
    }

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::not_negative("grip.reach", self.reach)?;
        check::not_negative("grip.climb_speed", self.climb_speed)?;
        let overhang = self.max_overhang;
        let holds = overhang >= 0.0 && overhang.is_finite();
        let range = "in radians, not negative and finite";
        check::check("grip.max_overhang", range, overhang, holds)?;
        check::limit("grip.hang_acceleration", self.hang_acceleration)?;
        check::not_negative("grip.calm_time", self.calm_time)?;
        check::not_negative("grip.jump_speed", self.jump_speed)?;
        check::limit("grip.catch_speed", self.catch_speed)
    }
}
