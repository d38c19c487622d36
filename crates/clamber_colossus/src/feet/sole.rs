use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

use super::Ground;
use crate::kind::SoleShape;

/// Largest slope of a sole along each of its sides, as a tangent: 30 degrees.
const MOST_LEAN: f64 = 0.577;

/// Number of a sole's points that are enough to predict where it will stand.
const FEW_POINTS: usize = 12;

/// The sole of a foot above the ground.
pub(crate) struct Sole<'a> {
    pub(crate) ground: &'a Ground<'a>,
    pub(crate) shape: &'a SoleShape,
    /// Rotation from the model's axes at rest to the foot's heading in the world.
    pub(crate) turn: DQuat,
    /// Metres per unit of the model.
    pub(crate) scale: f64,
    /// Ground higher than this above the foot counts as a wall, metres.
    pub(crate) wall: f64,
}

/// Position and tilt of a standing foot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Footing {
    /// The ball of the foot, in world space.
    pub(crate) ball: DVec3,
    /// Normal of the ground that carries the foot.
    pub(crate) normal: DVec3,
}

impl Sole<'_> {
    /// Height of the ground below a place; `None` if there is no ground, or a wall.
    pub(crate) fn below(&self, place: DVec3) -> Option<f64> {
        let height = self.ground.below(place).map(|(height, _)| height);
        height.filter(|height| height - place.y < self.wall)
    }

    /// Height of the ground that a foot has to clear when its ball is at a place and its sole leans to a normal. It is
    /// the maximum of the ground heights below ball, heel and toe, each less the height of that point above the ball.
    /// `None` if there is no ground.
    pub(crate) fn highest(&self, place: DVec3, normal: DVec3) -> Option<f64> {
        let [back_right, back_left, front_right, front_left] = self.shape.corners;
        let ends = [
            DVec3::ZERO,
            0.5 * (back_right + back_left),
            0.5 * (front_right + front_left),
        ];
        let heights = ends.iter().filter_map(|end| {
            let end = self.in_world(*end);
            let rise = -(normal.x * end.x + normal.z * end.z) / normal.y.max(0.1);
            Some(self.below(place + end)? - rise)
        });
        heights.max_by(f64::total_cmp)
    }

    /// True if there is any terrain. In empty space, feet stand on nothing.
    pub(crate) fn has_ground(&self) -> bool {
        !self.ground.terrain.is_empty()
    }

    /// Predicts how a foot stands with its ball above or below a place; at the place itself if there is no ground. The
    /// foot leans as the ground below the corners of its sole does, and is moved up or down until the sole touches.
    /// Only a few points of the sole are checked.
    pub(crate) fn at(&self, place: DVec3) -> Footing {
        let points = &self.shape.points;
        self.lowered(
            place,
            points
                .iter()
                .step_by(points.len().div_ceil(FEW_POINTS).max(1)),
        )
    }

    /// The same with all points of the sole, for the tick in which the foot comes down.
    pub(crate) fn at_exactly(&self, place: DVec3) -> Footing {
        self.lowered(place, self.shape.points.iter())
    }

    fn lowered<'p>(&self, place: DVec3, points: impl Iterator<Item = &'p DVec3>) -> Footing {
        let Some(middle) = self.below(place) else {
            return Footing {
                ball: place,
                normal: DVec3::Y,
            };
        };
        let corners = self.shape.corners.map(|corner| self.in_world(corner));
        let heights = corners.map(|corner| self.below(place + corner).unwrap_or(middle));
        let normal = lean(&corners, heights);
        let turn = DQuat::from_rotation_arc(DVec3::Y, normal);
        let ball = place.with_y(middle + self.shape.ball_height * self.scale);
        // The point that is deepest in the ground, or nearest to it, decides.
        let rises = points.filter_map(|point| {
            let place = ball + turn * self.in_world(*point);
            Some(self.below(place)? - place.y)
        });
        let rise = rises.fold(f64::NEG_INFINITY, f64::max);
        Footing {
            ball: if rise.is_finite() {
                ball + DVec3::Y * rise
            } else {
                ball
            },
            normal,
        }
    }

    fn in_world(&self, place: DVec3) -> DVec3 {
        self.turn * (place * self.scale)
    }
}

/// Normal of the plane through the ground heights below the corners of a rectangle, by least squares: its slopes are
/// the differences between the mean heights of opposite sides.
fn lean(corners: &[DVec3; 4], heights: [f64; 4]) -> DVec3 {
    let [back_right, back_left, front_right, front_left] = heights;
    let [a, b, c, _] = *corners;
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
    (DVec3::Y - across * lean_across - along * lean_along).normalize_or(DVec3::Y)
}
