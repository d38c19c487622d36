use glam::{DQuat, DVec3};

use super::arc;
use crate::spring::rotation_from_vector;

/// Sines of the angle between the pole and the line to the target: 8° and 15°. Below the first the pole is ignored,
/// above the second it is followed at [`FASTEST`], and between them the swing speed rises linearly.
const CERTAIN: [f64; 2] = [0.139, 0.259];

/// The fastest swing of an elbow about the line from shoulder to hand, radians per second: half a turn in 0.4 s, and
/// 7.6° in a sixtieth of a second. Without this limit the elbow flips within one call.
const FASTEST: f64 = 8.0;

/// Remembers to which side an elbow pointed last, so that it does not flip when the hand passes the pole.
///
/// A limb in line with its pole has no side to bend to. When the target crosses that line, the pole's side changes by
/// half a turn at once. With a memory the elbow keeps its side there, carried along with the limb. It swings back once
/// the pole gives a clear side again.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PoleMemory {
    /// Unit vectors of the last call: the direction to the target, and the elbow's side.
    last: Option<[DVec3; 2]>,
}

impl PoleMemory {
    /// The side to which the elbow goes: a unit vector perpendicular to the direction to the target. `dt` is the time
    /// since the last call, seconds.
    ///
    /// `direction` is a unit vector, `pole` may have any length. Both are in a space that does not turn with the limb's
    /// root joint.
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
        // Sine and cosine of the angle about `direction` from the carried side to the wanted one.
        let (sine, cosine) = (carried.cross(wanted).dot(direction), carried.dot(wanted));
        let most = FASTEST * dt.max(0.0) * certain;
        // A lower bound of `sin(most)`: if the sine is within it, the angle itself is not needed.
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

    /// Forgets the last side. Call it after a teleport, and before another limb takes over the memory.
    pub fn forget(&mut self) {
        self.last = None;
    }
}
