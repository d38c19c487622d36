use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{FootGoal, Ground};

/// The most that a foot leans on the ground, as a tangent: 30 degrees.
const MOST_LEAN: f64 = 0.577;

/// The sole of a foot above the ground.
pub(crate) struct Sole<'a> {
    pub(crate) ground: &'a Ground<'a>,
    /// Heel and toe, right and left, relative to the ball, level, in world space.
    pub(crate) corners: [DVec3; 4],
}

/// Where a foot stands.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Footing {
    /// The ball of the foot.
    pub(crate) ball: DVec3,
    /// Normal of the ground that carries it.
    pub(crate) normal: DVec3,
}

impl Sole<'_> {
    /// Height of the ground below a place; `None` if there is none.
    pub(crate) fn below(&self, place: DVec3) -> Option<f64> {
        self.ground.below(place).map(|(height, _)| height)
    }

    /// False in empty space, where feet stand on nothing.
    pub(crate) fn has_ground(&self) -> bool {
        !self.ground.terrain.is_empty()
    }

    /// Where a foot stands with its ball above or below a place; at that place if there is no ground.
    pub(crate) fn at(&self, place: DVec3, goal: &FootGoal) -> Footing {
        let (height, normal) = self
            .plane(place)
            .unwrap_or((place.y - goal.ball_height, DVec3::Y));
        Footing {
            ball: DVec3::new(place.x, height + goal.ball_height, place.z),
            normal,
        }
    }

    /// The plane that carries the foot: its height below the ball, and its normal. It touches the ground at the highest
    /// place and leans as the corners do.
    fn plane(&self, ball: DVec3) -> Option<(f64, DVec3)> {
        let middle = self.below(ball)?;
        let corners = &self.corners;
        let heights = corners.map(|corner| self.below(ball + corner).unwrap_or(middle));
        let [back_right, back_left, front_right, front_left] = heights;
        // Least squares over a rectangle: differences of the means of its sides.
        let [a, b, c] = [corners[0], corners[1], corners[2]];
        let (across, along) = (b - a, c - a);
        let slope = |rise: f64, side: DVec3| {
            let length = side.length();
            if length > 1e-6 {
                (rise / length).clamp(-MOST_LEAN, MOST_LEAN)
            } else {
                0.0
            }
        };
        let lean_across = slope(
            0.5 * (back_left + front_left - back_right - front_right),
            across,
        );
        let lean_along = slope(
            0.5 * (front_right + front_left - back_right - back_left),
            along,
        );
        let (across, along) = (across.normalize_or(DVec3::X), along.normalize_or(DVec3::Z));
        let rise =
            |corner: DVec3| lean_across * corner.dot(across) + lean_along * corner.dot(along);
        let above = corners
            .iter()
            .zip(heights)
            .map(|(corner, height)| height - rise(*corner));
        let height = above.fold(middle, f64::max);
        let normal = (DVec3::Y - across * lean_across - along * lean_along).normalize_or(DVec3::Y);
        Some((height, normal))
    }
}
