//! A copy of the creature's skin for the camera, in the same pose: its queries do not change the battle's own
//! measurements.

use clamber::prelude::*;
use clamber_scenes::battle::Battle;
use glam::DVec3;

/// Distance that the eye keeps from the skin, metres. Visible fur reaches 0.8 m beyond the skin on a giant of 40 m.
pub(super) const KEPT: f64 = 1.4;
/// Least distance of the eye from the skin for a few ticks, if skin comes from two sides, metres.
pub(super) const LEAST: f64 = 0.9;

/// Largest number of times that the eye is pushed away from skin on several sides.
const ROUNDS: usize = 8;

/// The creature's skin.
#[derive(Debug)]
pub(super) struct Skin {
    surface: SkinnedSurface,
    /// Number of plates that were broken when the skin was copied: their triangles are hidden.
    broken: usize,
}

impl Skin {
    pub(super) fn new(battle: &Battle<'_>) -> Self {
        Self {
            surface: battle.surface().clone(),
            broken: broken(battle),
        }
    }

    /// Takes the battle's current pose. If the pose is refused, the last one stays.
    pub(super) fn pose(&mut self, battle: &Battle<'_>) {
        if self.broken != broken(battle) {
            *self = Self::new(battle);
        }
        let place = *battle.surface().world_from_model();
        let _ = self.surface.place(battle.palette(), place);
    }

    /// Distance along a direction up to the skin, at most `far`.
    pub(super) fn free(&self, from: DVec3, toward: DVec3, far: f64) -> f64 {
        let hit = self.surface.in_world().cast_ray(from, toward, far);
        hit.map_or(far, |hit| hit.distance)
    }

    /// Distance of a place from the skin up to `far`; negative inside.
    pub(super) fn room(&self, place: DVec3, far: f64) -> f64 {
        let Some(hit) = self.surface.in_world().closest_point(place, far) else {
            return far;
        };
        if (place - hit.point).dot(hit.normal) < 0.0 {
            -hit.distance
        } else {
            hit.distance
        }
    }

    /// The place moved out of the skin, and away from it by [`KEPT`].
    pub(super) fn keep_out(&self, mut place: DVec3) -> DVec3 {
        for _ in 0..ROUNDS {
            let Some(hit) = self.surface.in_world().closest_point(place, KEPT) else {
                break;
            };
            let way = (place - hit.point).normalize_or(hit.normal);
            let out = if way.dot(hit.normal) < 0.0 {
                hit.normal
            } else {
                way
            };
            place = hit.point + out * (KEPT + 1e-3);
        }
        place
    }
}

fn broken(battle: &Battle<'_>) -> usize {
    let Some(life) = battle.life() else {
        return 0;
    };
    let plates = 0..life.kind().plates().len();
    plates
        .filter(|plate| life.state().plate(*plate) == 0)
        .count()
}
