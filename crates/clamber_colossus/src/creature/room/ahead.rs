//! How far the way ahead is free.

use clamber_surface::geometry::WorldCapsule;
use glam::DVec3;

use super::{Among, MARGIN, Room, STEPS_OVER, STRAIGHT_FROM};
use crate::creature::state::NO_GROUND;
use crate::kind::{BANDS, Band, EDGES};

/// How much further it keeps from other creatures, since their skin moves while they stand.
const SWAYS: f64 = 0.05;

/// The ground ahead is looked at in steps of this share of its height, and in at most so many: it does not see what is
/// farther away than 20 heights.
const SPACING: f64 = 0.08;
const STATIONS: usize = 256;

/// Lower bands follow the ground in pieces of so many steps, those from [`STRAIGHT_FROM`] on go straight.
const PIECE: usize = 3;

/// Ground that is no higher or lower than this share of its height is about level.
const ABOUT: f64 = 0.04;

impl Room<'_> {
    /// How far it may walk straight ahead, metres, up to `far` and as far as it sees. Negative where it stands in
    /// something, or too near.
    pub(in crate::creature) fn ahead(&self, far: f64) -> f64 {
        let margin = MARGIN * self.height;
        let feet = self.band(0);
        let spacing = SPACING * self.height;
        let sees = spacing * STATIONS as f64 - feet.front - margin;
        let far = far.min(sees).max(0.0);
        let reach = feet.front + margin + far;
        let count = ((reach / spacing).ceil() as usize).clamp(1, STATIONS);
        let spacing = reach / count as f64;
        let lanes = [feet.right, 0.0, feet.left];
        let from = (feet.front / spacing) as usize;
        let levels = lanes.map(|aside| self.lane(aside, spacing, [from, count]));
        let mut free = far;
        let ends = (from..=count)
            .find_map(|station| self.last_ground(&levels, &lanes, station, spacing, feet.front));
        if let Some(last) = ends {
            free = free.min(spacing * last as f64 - feet.front - margin);
        }
        for index in 0..BANDS {
            if index == STRAIGHT_FROM && self.is_about_level(&levels) && self.is_high_way_free(free)
            {
                break;
            }
            let band = self.band(index);
            let front = band.front + margin;
            let hit =
                self.sweep_ahead(index, &band, front + free, spacing, &levels, Among::Terrain);
            if let Some(hit) = hit {
                free = free.min(hit - front);
            }
            if self.around.creatures.is_empty() {
                continue;
            }
            // Another creature may come towards it as fast, so each has half of the way; and it sways.
            let front = front + SWAYS * self.height;
            let reach = front + 2.0 * free.max(0.0);
            let hit = self.sweep_ahead(index, &band, reach, spacing, &levels, Among::Creatures);
            if let Some(left) = hit.map(|hit| hit - front) {
                free = free.min(if left > 0.0 { 0.5 * left } else { left });
            }
        }
        free
    }

    /// Where it is after so many metres straight ahead; `None` if it does not get there.
    pub(in crate::creature) fn walked(&self, far: f64) -> Option<DVec3> {
        let is_free = self.ahead(far) >= far;
        let there = self.origin + self.forward * far;
        let level = is_free.then(|| self.below(there)).flatten()?;
        Some(there.with_y(level))
    }

    /// True if certainly nothing is in the way of the higher bands: one fat capsule around them, in place of one sweep
    /// for each.
    fn is_high_way_free(&self, free: f64) -> bool {
        let high = self.box_of(STRAIGHT_FROM..BANDS);
        let (middle, radius) = self.high_middle();
        let way = high.front + (MARGIN + SWAYS) * self.height + 2.0 * free.max(0.0);
        let capsule = WorldCapsule {
            ends: [high.right, high.left].map(|aside| middle + self.left * aside),
            radius,
        };
        self.is_clear(&capsule, self.forward * way)
    }

    /// True if the ground ahead is about as high as that on which it stands.
    fn is_about_level(&self, levels: &[[f64; STATIONS + 1]; 3]) -> bool {
        let known = levels.iter().flatten().filter(|level| **level < NO_GROUND);
        let mut rises = known.map(|level| (level - self.origin.y).abs());
        rises.all(|rise| rise <= ABOUT * self.height)
    }

    /// The middle of the higher bands, and half their height.
    fn high_middle(&self) -> (DVec3, f64) {
        let [low, high] = [EDGES[STRAIGHT_FROM], EDGES[BANDS]].map(|edge| edge * self.height);
        let up = DVec3::Y * (0.5 * (low + high));
        (self.origin + up, 0.5 * (high - low) + ABOUT * self.height)
    }

    /// Heights of the ground along a lane, at the stations of so many steps ahead that count: those that are not under the
    /// body, and ends of pieces.
    fn lane(&self, aside: f64, spacing: f64, [from, count]: [usize; 2]) -> [f64; STATIONS + 1] {
        let mut levels = [NO_GROUND; STATIONS + 1];
        let mut level = self.origin.y;
        let under = (0..from).step_by(PIECE);
        for station in under.chain(from..count + 1) {
            let at = self.forward * (spacing * station as f64) + self.left * aside;
            if let Some(next) = self.below((self.origin + at).with_y(level)) {
                (levels[station], level) = (next, next);
            }
        }
        levels
    }

    /// The last station on whose ground it can walk, if it cannot walk on that of a station: since it is too steep, a
    /// drop, or a wall, counted from where that begins.
    fn last_ground(
        &self,
        levels: &[[f64; STATIONS + 1]; 3],
        lanes: &[f64; 3],
        station: usize,
        spacing: f64,
        front: f64,
    ) -> Option<usize> {
        let over = STEPS_OVER * self.height;
        let is_level = |rise: f64, way: f64| rise.abs() <= self.steepest * way.abs() + over;
        if spacing * station as f64 <= front {
            // There its feet stand already.
            return None;
        }
        let middle = levels[1][station];
        let before = station.saturating_sub(1);
        for (lane, aside) in levels.iter().zip(lanes) {
            let level = lane[station];
            if level == NO_GROUND {
                return Some(before);
            }
            let too_steep = (0..station).rev().find(|index| {
                let way = spacing * (station - index) as f64;
                lane[*index] < NO_GROUND && !is_level(level - lane[*index], way)
            });
            if too_steep.is_some() {
                return too_steep;
            }
            if middle < NO_GROUND && !is_level(level - middle, *aside) {
                return Some(before);
            }
        }
        None
    }

    /// Where a band that lies across the body first touches something ahead: metres from the origin to where its front
    /// would be.
    fn sweep_ahead(
        &self,
        index: usize,
        band: &Band,
        reach: f64,
        spacing: f64,
        levels: &[[f64; STATIONS + 1]; 3],
        among: Among,
    ) -> Option<f64> {
        let thick = self.thick(index);
        // As wide as the body, but for the round ends.
        let [right, left] = [(band.right + thick).min(0.0), (band.left - thick).max(0.0)];
        let way = (reach - thick).max(0.0);
        let last = ((way / spacing).ceil() as usize).clamp(1, STATIONS);
        let step = if index < STRAIGHT_FROM { PIECE } else { last };
        let level = |lane: usize, station: usize| {
            let known = levels[lane][..=station].iter().rev();
            let mut known = known.filter(|level| **level < NO_GROUND);
            known.next().copied().unwrap_or(self.origin.y)
        };
        let ends = |station: usize| {
            let at = if station == last {
                way
            } else {
                spacing * station as f64
            };
            let up = self.middle(index);
            let end = |lane, aside: f64| {
                let level = DVec3::Y * (level(lane, station) + up);
                (self.origin + self.forward * at + self.left * aside).with_y(0.0) + level
            };
            (at, [end(0, right), end(2, left)])
        };
        let goes = |_| self.forward;
        let mut station = 0;
        while station < last {
            let next = (station + step).min(last);
            let ((from, before), (to, after)) = (ends(station), ends(next));
            let capsule = WorldCapsule {
                ends: before,
                radius: thick,
            };
            let ways = [after[0] - before[0], after[1] - before[1]];
            if let Some(time) = self.sweep(&capsule, ways, &goes, &[among]) {
                return Some(from + (to - from) * time + thick);
            }
            station = next;
        }
        None
    }
}
