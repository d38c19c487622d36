//! Free room: how far the way ahead is free, how far the creature may turn, and whether a blow would go through rock.
//!
//! Rays down find the ground along three lanes. Sweeps of thin capsules, one for each band of the body's height, find
//! obstacles on the ground. The capsules lie across the body when it walks, and along, across and diagonally when it
//! turns.

mod ahead;
mod strike;
mod turn;

use core::ops::Range;

use clamber_surface::geometry::WorldCapsule;
use clamber_surface::surface::TargetMotion;
use clamber_world::{Obstacle, SweepContact};
use glam::DVec3;

use super::{Creature, Surroundings};
use crate::feet::Ground;
use crate::kind::{BAND_EDGES, Band, Extent};

/// Height above the ground up to which the creature steps over obstacles, as a share of its height.
pub(super) const STEP_OVER_HEIGHT: f64 = 0.06;

/// Smallest vertical component of a unit normal that counts as ground for blows, which may go into ground.
pub(super) const LEAST_GROUND_NORMAL: f64 = 0.7;

/// Distance that the creature keeps from obstacles, as a share of its height.
const OBSTACLE_MARGIN: f64 = 0.015;

/// Index of the first of the higher bands. One straight sweep of all higher bands together replaces their own sweeps if
/// it finds no obstacle.
const STRAIGHT_FROM: usize = 2;

/// Sine of the largest angle between a motion and a surface at which the motion goes along the surface. A sweep does
/// not stop at such a surface.
const ALONG_SURFACE_SINE: f64 = 0.01;

/// The obstacles that a sweep checks.
#[derive(Clone, Copy)]
enum Among {
    Terrain,
    Creatures,
}

/// The surroundings of a creature, seen from its position in a direction in which it may go.
pub(super) struct Room<'a> {
    around: &'a Surroundings<'a>,
    extent: &'a Extent,
    pub(super) origin: DVec3,
    forward: DVec3,
    left: DVec3,
    scale: f64,
    height: f64,
    /// Tangent of the steepest slope that the creature walks onto.
    steepest: f64,
}

impl Creature {
    /// The surroundings in the direction of the creature's heading.
    pub(super) fn room<'a>(&self, around: &'a Surroundings<'a>, extent: &'a Extent) -> Room<'a> {
        self.room_towards(around, extent, self.state.heading())
    }

    /// The surroundings in the direction of a horizontal vector.
    pub(super) fn room_towards<'a>(
        &self,
        around: &'a Surroundings<'a>,
        extent: &'a Extent,
        way: DVec3,
    ) -> Room<'a> {
        let forward = way.try_normalize().unwrap_or(DVec3::Z);
        Room {
            around,
            extent,
            origin: self.state.position(),
            forward,
            left: DVec3::new(forward.z, 0.0, -forward.x),
            scale: self.size.scale,
            height: self.size.height,
            steepest: libm::tan(self.config.most_slope),
        }
    }

    /// Gradient of the ground below the creature, from the stored ground heights.
    pub(super) fn slope(&self) -> DVec3 {
        let heading = self.state.heading();
        let left = DVec3::new(heading.z, 0.0, -heading.x);
        let most = libm::tan(self.config.most_slope).min(1.0);
        let [ahead, aside] = self.state.on_ground.slopes(self.size.height, most);
        heading * ahead + left * aside
    }
}

impl Room<'_> {
    /// The box around several bands, metres.
    fn box_of(&self, bands: Range<usize>) -> Band {
        let bands = bands.map(|index| self.band(index));
        bands.reduce(Band::and).unwrap_or(self.band(0))
    }

    /// True if a capsule that moves by `way` meets no obstacle.
    fn is_clear(&self, capsule: &WorldCapsule, way: DVec3) -> bool {
        let all = [self.around.terrain, self.around.creatures];
        let mut any = |_: &SweepContact| true;
        all.into_iter()
            .all(|obstacles| first(obstacles, capsule, [way; 2], &mut any).is_none())
    }

    /// The box of a band, metres.
    fn band(&self, index: usize) -> Band {
        let Band {
            right,
            left,
            back,
            front,
        } = self.extent.bands[index];
        Band {
            right: right * self.scale,
            left: left * self.scale,
            back: back * self.scale,
            front: front * self.scale,
        }
    }

    /// Half the thickness of a band, metres.
    fn thick(&self, index: usize) -> f64 {
        0.5 * (BAND_EDGES[index + 1] - BAND_EDGES[index]) * self.height
    }

    /// Height of a band's middle above the ground, metres.
    fn middle(&self, index: usize) -> f64 {
        0.5 * (BAND_EDGES[index + 1] + BAND_EDGES[index]) * self.height
    }

    /// Height of the ground below a place.
    fn below(&self, place: DVec3) -> Option<f64> {
        let ground = Ground {
            terrain: self.around.terrain,
            reach: 0.5 * self.height,
        };
        ground.below(place).map(|(level, _)| level)
    }

    /// Time of a capsule's first contact with an obstacle in its way, from 0 to 1.
    fn sweep(
        &self,
        capsule: &WorldCapsule,
        ways: [DVec3; 2],
        goes: &dyn Fn(DVec3) -> DVec3,
        among: &[Among],
    ) -> Option<f64> {
        let mut is_in_the_way = |hit: &SweepContact| {
            hit.separation_normal.dot(goes(hit.contact.point)) < -ALONG_SURFACE_SINE
        };
        let times = among.iter().filter_map(|among| {
            let obstacles = match among {
                Among::Terrain => self.around.terrain,
                Among::Creatures => self.around.creatures,
            };
            first(obstacles, capsule, ways, &mut is_in_the_way)
        });
        times.min_by(f64::total_cmp)
    }
}

/// Time of a capsule's first contact that `counts` accepts, from 0 to 1.
fn first(
    obstacles: &[&dyn Obstacle],
    capsule: &WorldCapsule,
    ways: [DVec3; 2],
    counts: &mut dyn FnMut(&SweepContact) -> bool,
) -> Option<f64> {
    let reach = ways[0].length().max(ways[1].length()) + capsule.radius;
    let middle = 0.5 * (capsule.ends[0] + capsule.ends[1]);
    let reach = reach + 0.5 * capsule.ends[0].distance(capsule.ends[1]);
    let near = obstacles.iter().filter(|obstacle| {
        let bounds = obstacle.bounds();
        bounds.is_none_or(|(center, radius)| center.distance(middle) <= radius + reach)
    });
    let hits = near.filter_map(|obstacle| {
        let still = TargetMotion::Still;
        obstacle.cast_capsule_where(capsule, ways, still, counts)
    });
    hits.map(|hit| hit.fraction).min_by(f64::total_cmp)
}
