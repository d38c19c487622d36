//! Where the blade is: a function of the fighter's state, which the drawn body follows.

use clamber_surface::geometry::rotation_from_axis_angle;
use glam::DVec3;

use super::{Act, BodyFrame, Fighter, SwordConfig, Target};

/// A blade, or an arm with a blade, as a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blade {
    /// Where the hand holds it, in world space.
    pub hilt: DVec3,
    /// Its tip.
    pub tip: DVec3,
}

/// How far below the level the blade cuts, radians.
const DOWN: f64 = 0.25;

/// Where a raised sword's hilt is, from the centre of the climber's ball: right, up, and ahead, metres; and where it
/// points.
const RAISED: DVec3 = DVec3::new(0.1, 1.5, 0.1);
const POINTS: DVec3 = DVec3::new(0.0, 0.94, -0.34);

/// Where a blade that is carried is: beside the hip, backwards.
const CARRIED: DVec3 = DVec3::new(0.35, 0.5, 0.0);
const HANGS: DVec3 = DVec3::new(0.0, -0.5, -0.866);

impl SwordConfig {
    /// The blade in a cut, at an angle from the right (0) to the left.
    pub(super) fn in_cut(&self, frame: &BodyFrame, angle: f64) -> Blade {
        let from_ahead = angle - 0.5 * self.angle;
        let (sin, cos) = libm::sincos(from_ahead);
        let (fall, level) = libm::sincos(DOWN);
        let along = frame.direction(DVec3::new(-sin * level, -fall, cos * level));
        let shoulder = frame.at(self.shoulder);
        Blade {
            hilt: shoulder + along * self.arm,
            tip: shoulder + along * (self.arm + self.blade),
        }
    }

    /// The blade raised for a stab.
    pub(super) fn raised(&self, frame: &BodyFrame) -> Blade {
        let hilt = frame.at(RAISED);
        Blade {
            hilt,
            tip: hilt + frame.direction(POINTS) * self.blade,
        }
    }

    /// The blade below a falling body.
    pub(super) fn below(&self, frame: &BodyFrame) -> Blade {
        let hilt = frame.at(DVec3::new(0.0, 0.2, 0.3));
        Blade {
            hilt,
            tip: hilt - frame.direction(DVec3::Y) * self.blade,
        }
    }

    fn carried(&self, frame: &BodyFrame) -> Blade {
        let hilt = frame.at(CARRIED);
        Blade {
            hilt,
            tip: hilt + frame.direction(HANGS) * self.blade,
        }
    }
}

impl Blade {
    /// The blade at a share of the way to another one; its length stays.
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

    /// The blade with its tip at a place, towards which it goes along a direction.
    pub(super) fn in_skin(&self, tip: DVec3, into: DVec3) -> Self {
        Self {
            hilt: tip - into * self.tip.distance(self.hilt),
            tip,
        }
    }
}

impl Fighter {
    /// Where its sword is after the last tick, in world space; `None` without a sword. The drawn hand holds it at the
    /// hilt.
    pub fn blade(&self) -> Option<Blade> {
        let sword = self.config.sword.as_ref()?;
        let frame = BodyFrame::of(&self.climber);
        let raised = sword.raised(&frame);
        Some(match &self.state.act {
            Act::Cut { seconds, .. } => sword.in_cut(&frame, sword.cut_angle(*seconds)),
            Act::Raise { seconds, .. } => {
                let share = if sword.raise > 0.0 {
                    seconds / sword.raise
                } else {
                    1.0
                };
                sword.carried(&frame).to(&raised, share.clamp(0.0, 1.0))
            }
            Act::Charge { .. } => raised,
            Act::Strike {
                seconds, target, ..
            } => {
                let share = (seconds / sword.strike).clamp(0.0, 1.0);
                raised.to(&sword.struck(&frame, target), share)
            }
            Act::Plunge { .. } => sword.below(&frame),
            Act::PullOut { target, .. } => {
                let struck = sword.struck(&frame, target);
                let deeper = match target {
                    Target::Skin(_) => (struck.tip - struck.hilt).normalize_or(DVec3::ZERO),
                    Target::Open | Target::Air => DVec3::ZERO,
                };
                let way = deeper * sword.depth.min(sword.blade);
                Blade {
                    hilt: struck.hilt + way,
                    tip: struck.tip + way,
                }
            }
            Act::Ready | Act::Draw { .. } | Act::Throw { .. } => sword.carried(&frame),
        })
    }
}
