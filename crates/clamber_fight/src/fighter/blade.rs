//! The blade's position, which follows from the fighter's state. The drawn body follows the blade.

use clamber_surface::geometry::rotation_from_axis_angle;
use glam::DVec3;

use super::{Fighter, FighterFrame, StabTarget, SwordConfig, WeaponAction};

/// A blade as a line from hilt to tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blade {
    /// Where the hand holds the blade, in world space, metres.
    pub hilt: DVec3,
    /// Tip of the blade, in world space, metres.
    pub tip: DVec3,
}

/// Angle of a cut below the horizontal, radians.
const CUT_DOWN_ANGLE: f64 = 0.25;

/// Hilt of a raised sword, from the centre of the climber's ball: right, up, and ahead, metres.
const RAISED_HILT: DVec3 = DVec3::new(0.1, 1.5, 0.1);
/// Direction of a raised blade: right, up, and ahead, about a unit vector. It points up and backwards.
const RAISED_DIRECTION: DVec3 = DVec3::new(0.0, 0.94, -0.34);

/// Hilt of a carried sword, from the centre of the climber's ball, beside the hip: right, up, and ahead, metres.
const CARRIED_HILT: DVec3 = DVec3::new(0.35, 0.5, 0.0);
/// Direction of a carried blade: right, up, and ahead, a unit vector. It points down and backwards.
const CARRIED_DIRECTION: DVec3 = DVec3::new(0.0, -0.5, -0.866);

impl SwordConfig {
    /// The blade in a cut. `angle` is 0 at the right and grows to the left, radians.
    pub(super) fn in_cut(&self, frame: &FighterFrame, angle: f64) -> Blade {
        let from_ahead = angle - 0.5 * self.angle;
        let (sin, cos) = libm::sincos(from_ahead);
        let (fall, level) = libm::sincos(CUT_DOWN_ANGLE);
        let along = frame.direction(DVec3::new(-sin * level, -fall, cos * level));
        let shoulder = frame.at(self.shoulder);
        Blade {
            hilt: shoulder + along * self.arm,
            tip: shoulder + along * (self.arm + self.blade),
        }
    }

    /// The blade of a sword that is raised for a stab.
    pub(super) fn raised(&self, frame: &FighterFrame) -> Blade {
        let hilt = frame.at(RAISED_HILT);
        Blade {
            hilt,
            tip: hilt + frame.direction(RAISED_DIRECTION) * self.blade,
        }
    }

    /// The blade below a falling body, pointing down.
    pub(super) fn below(&self, frame: &FighterFrame) -> Blade {
        let hilt = frame.at(DVec3::new(0.0, 0.2, 0.3));
        Blade {
            hilt,
            tip: hilt - frame.direction(DVec3::Y) * self.blade,
        }
    }

    fn carried(&self, frame: &FighterFrame) -> Blade {
        let hilt = frame.at(CARRIED_HILT);
        Blade {
            hilt,
            tip: hilt + frame.direction(CARRIED_DIRECTION) * self.blade,
        }
    }
}

impl Blade {
    /// Interpolates to another blade: the tip moves on a straight line, and the blade turns about its tip. Length is
    /// interpolated as well.
    pub(super) fn to(&self, other: &Self, share: f64) -> Self {
        let tip = self.tip.lerp(other.tip, share);
        let [from, to] = [self.hilt - self.tip, other.hilt - other.tip];
        let length = from.length() + (to.length() - from.length()) * share;
        let axis = from.cross(to).try_normalize();
        let angle = libm::atan2(from.cross(to).length(), from.dot(to)) * share;
        let turned = axis.map_or(from, |axis| rotation_from_axis_angle(axis, angle) * from);
        Self {
            hilt: tip + turned.normalize_or(DVec3::Y) * length,
            tip,
        }
    }

    /// The blade moved so that its tip is at a place and it points along `into`, a unit vector.
    pub(super) fn in_skin(&self, tip: DVec3, into: DVec3) -> Self {
        Self {
            hilt: tip - into * self.tip.distance(self.hilt),
            tip,
        }
    }
}

impl Fighter {
    /// The sword's position after the last tick; `None` without a sword. The drawn hand holds it at the hilt.
    pub fn blade(&self) -> Option<Blade> {
        let sword = self.config.sword.as_ref()?;
        let frame = FighterFrame::of(&self.climber);
        let raised = sword.raised(&frame);
        Some(match &self.state.act {
            WeaponAction::Cut { seconds, .. } => sword.in_cut(&frame, sword.cut_angle(*seconds)),
            WeaponAction::Raise { seconds, .. } => {
                let share = if sword.raise > 0.0 {
                    seconds / sword.raise
                } else {
                    1.0
                };
                sword.carried(&frame).to(&raised, share.clamp(0.0, 1.0))
            }
            WeaponAction::Charge { .. } => raised,
            WeaponAction::Strike {
                seconds, target, ..
            } => {
                let share = (seconds / sword.strike).clamp(0.0, 1.0);
                raised.to(&sword.struck(&frame, target), share)
            }
            WeaponAction::Plunge { .. } => sword.below(&frame),
            WeaponAction::PullOut { target, .. } => {
                let struck = sword.struck(&frame, target);
                let deeper = match target {
                    StabTarget::Skin(_) => (struck.tip - struck.hilt).normalize_or(DVec3::ZERO),
                    StabTarget::Open | StabTarget::Air => DVec3::ZERO,
                };
                let way = deeper * sword.depth.min(sword.blade);
                Blade {
                    hilt: struck.hilt + way,
                    tip: struck.tip + way,
                }
            }
            WeaponAction::Ready | WeaponAction::Draw { .. } | WeaponAction::Throw { .. } => {
                sword.carried(&frame)
            }
        })
    }
}
