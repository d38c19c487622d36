use clamber_world::Obstacle;
use glam::DVec3;

/// The ground, as feet look for it: by rays down.
#[derive(Clone, Copy)]
pub(crate) struct Ground<'a> {
    pub(crate) terrain: &'a [&'a dyn Obstacle],
    /// How far above and below a place the ground is looked for, metres.
    pub(crate) reach: f64,
}

impl Ground<'_> {
    /// Height of the ground below a place, and its normal; `None` if there is none in reach.
    pub(crate) fn below(&self, place: DVec3) -> Option<(f64, DVec3)> {
        let from = place + DVec3::Y * self.reach;
        let hits = self.terrain.iter().filter_map(|obstacle| {
            let hit = obstacle.cast_ray(from, -DVec3::Y, 2.0 * self.reach)?;
            let up = if hit.normal.y < 0.0 {
                -hit.normal
            } else {
                hit.normal
            };
            Some((hit.point.y, up))
        });
        hits.max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The plane that carries a foot with these corners, relative to its ball: the height below the ball, and the plane's
    /// normal. It touches the ground at the highest place and leans as the corners do, by at most `most_lean` (a tangent).
    pub(crate) fn under_foot(
        &self,
        ball: DVec3,
        corners: &[DVec3; 4],
        most_lean: f64,
    ) -> Option<(f64, DVec3)> {
        let middle = self.below(ball)?.0;
        let heights = corners.map(|corner| {
            self.below(ball + corner)
                .map_or(middle, |(height, _)| height)
        });
        let [back_right, back_left, front_right, front_left] = heights;
        // Least squares over a rectangle: differences of the means of its sides.
        let [a, b, c] = [corners[0], corners[1], corners[2]];
        let (across, along) = (b - a, c - a);
        let slope = |rise: f64, side: DVec3| {
            let length = side.length();
            if length > 1e-6 {
                (rise / length).clamp(-most_lean, most_lean)
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
