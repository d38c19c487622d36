//! Two bones in a plane, solved by similar triangles instead of angles.
//!
//! The shoulder is at the origin, the target at distance `d` along `u`, and the bones have the lengths `a` and `b`. The
//! elbow is then at `along = (a² - b² + d²) / 2d` on the line to the target and `across = sqrt((a - along)(a + along))`
//! beside it, on the side of the pole. No inverse trigonometry is needed, and the product keeps digits that `a² -
//! along²` loses near a straight arm. (Lander 1998, "Oh My God, I Inverted Kine!", Game Developer, has the same
//! triangle with angles.)

use glam::DVec3;

/// Whether a limb reached its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReachResult {
    /// The limb's end is at the target.
    Reached,
    /// The target is too far, or in the soft part of the limb's reach. The limb's end is this far short of it, metres.
    Short(f64),
    /// The target is nearer than the limb can fold, by this distance, metres.
    TooNear(f64),
}

/// The result of [`bend`]: two bones bent towards a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    /// Elbow or knee, relative to the shoulder or hip.
    pub elbow: DVec3,
    /// Hand or foot, relative to the shoulder or hip.
    pub end: DVec3,
    /// Whether `end` is at the target.
    pub reach: ReachResult,
}

/// Bends two bones so that their end is at `target`. All vectors are relative to the start of the first bone.
///
/// `lengths` are the bones' lengths, not both 0. `pole` is the side to which the elbow goes: a vector of any length.
/// Only its part perpendicular to the line to the target counts. If that part is 0, the side is arbitrary. `soft` is
/// the share of the full length from which the limb approaches a far target softly, more than 0 to 1, where 1 is not
/// soft; see [`soft_distance`]. `least` is the smallest distance to which the limb folds.
///
/// All arguments must be finite. The end is at the target to 1e-6 of the bones' length, or `reach` says by how much it
/// misses.
pub fn bend(lengths: [f64; 2], target: DVec3, pole: DVec3, soft: f64, least: f64) -> Bend {
    let [first, second] = lengths;
    let full = first + second;
    let wanted = target.length();
    // A target on the shoulder gives no direction: the limb folds in an arbitrary direction perpendicular to the pole.
    let direction = if wanted > 1e-12 * full {
        target / wanted
    } else {
        pole.any_orthogonal_vector().normalize_or(DVec3::X)
    };
    let nearest = least.max((first - second).abs()).min(full);
    let distance = soft_distance(wanted, full, soft).max(nearest);
    let along = if distance > 0.0 {
        (first * first - second * second + distance * distance) / (2.0 * distance)
    } else {
        0.0
    };
    let across = ((first - along) * (first + along)).max(0.0).sqrt();
    let side = pole - direction * pole.dot(direction);
    let side = side
        .try_normalize()
        .unwrap_or_else(|| direction.any_orthonormal_vector());
    let gap = wanted - distance;
    Bend {
        elbow: direction * along + side * across,
        end: direction * distance,
        reach: if gap.abs() <= 1e-9 * full {
            ReachResult::Reached
        } else if gap > 0.0 {
            ReachResult::Short(gap)
        } else {
            ReachResult::TooNear(-gap)
        },
    }
}

/// The distance to which a limb of length `full` reaches for a target at `distance`: the distance itself up to `soft *
/// full`, then less and less of it, never more than `full`.
///
/// Without softness, the elbow's angular velocity becomes infinite when a target leaves the limb's reach. The map and
/// its slope are continuous, the slope is at most 1, and the limb misses a target at exactly the full length by `(1 -
/// soft) / e` of that length.
pub fn soft_distance(distance: f64, full: f64, soft: f64) -> f64 {
    let start = soft * full;
    let room = full - start;
    if distance <= start {
        distance
    } else if room > 0.0 {
        start + room * -libm::expm1(-(distance - start) / room)
    } else {
        full
    }
}
