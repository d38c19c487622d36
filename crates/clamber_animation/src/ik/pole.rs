use glam::{DQuat, DVec3};

use super::arc;
use crate::spring::rotation_from_vector;

/// Sines of the angle between a pole and the line to the target: below the first the pole says nothing, above the
/// second it is followed. Between them it is followed by degrees. 8° and 15°.
const CERTAIN: [f64; 2] = [0.139, 0.259];

/// How fast an elbow swings about the line from shoulder to hand, radians a second: half a turn in 0.4 s, and 7.6° in a
/// sixtieth.
const FASTEST: f64 = 8.0;

/// Where an elbow pointed last, so that it does not flip when the hand passes the pole.
///
/// A limb in line with its pole has no side to bend to; when the target crosses that line, the side changes by half a
/// turn at once. With a memory the elbow keeps its side there, carried along with the limb, and swings back once the
/// pole is clear again.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PoleMemory {
    /// Unit vectors: to the target, and to the side.
    last: Option<[DVec3; 2]>,
}

impl PoleMemory {
    /// The side to which the elbow goes: a unit vector across the direction to the target. `dt` is the time since the
    /// last call, seconds.
    ///
    /// `direction` is a unit vector, `pole` may have any length; both in a space that the limb's root does not turn in.
    pub fn side(&mut self, direction: DVec3, pole: DVec3, dt: f64) -> DVec3 {
        let across = pole - direction * pole.dot(direction);
        let sine = across.length() / pole.length().max(f64::MIN_POSITIVE);
        let Some([was, side]) = self.last else {
            let side = across
                .try_normalize()
                .unwrap_or_else(|| direction.any_orthonormal_vector());
            self.last = Some([direction, side]);
            return side;
        };
        let carried = arc(was, direction) * side;
        let carried = (carried - direction * carried.dot(direction))
            .try_normalize()
            .unwrap_or_else(|| direction.any_orthonormal_vector());
        let wanted = across.try_normalize().unwrap_or(carried);
        let [none, all] = CERTAIN;
        let certain = ((sine - none) / (all - none)).clamp(0.0, 1.0);
        // About the direction, from where it is to where it should be.
        let (sine, cosine) = (carried.cross(wanted).dot(direction), carried.dot(wanted));
        let most = FASTEST * dt.max(0.0) * certain;
        // A lower bound of the sine of that: within it, no angle has to be known.
        let near = most * (1.0 - most * most / 6.0);
        if cosine > 0.0 && most < 1.0 && sine.abs() <= near {
            self.last = Some([direction, wanted]);
            return wanted;
        }
        let angle = libm::atan2(sine, cosine);
        let turn: DQuat = rotation_from_vector(direction * angle.clamp(-most, most));
        let side = (turn * carried).normalize();
        self.last = Some([direction, side]);
        side
    }

    /// Forgets the last side: after a teleport, and where another limb takes over the memory.
    pub fn forget(&mut self) {
        self.last = None;
    }
}
