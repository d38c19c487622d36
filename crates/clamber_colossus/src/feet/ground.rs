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
}
