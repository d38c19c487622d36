//! How far the way ahead is free.

use clamber_surface::geometry::WorldCapsule;
use glam::DVec3;

use super::{Among, OBSTACLE_MARGIN, Room, STEP_OVER_HEIGHT, STRAIGHT_FROM};
use crate::creature::ground::NO_GROUND;
use crate::kind::{BAND_COUNT, BAND_EDGES, Band};

/// Additional distance from other creatures, as a share of the creature's height, because their skin moves while they
/// stand.
const SWAYING_DISTANCE: f64 = 0.05;

/// Spacing of the stations where the ground ahead is measured, as a share of the creature's height.
const STATION_SPACING: f64 = 0.08;

/// Most stations ahead. With `STATION_SPACING`, the creature sees 20 heights ahead at most.
const MOST_STATIONS: usize = 256;

/// Sweeps of the lower bands follow the ground in pieces of this many stations. Sweeps of the bands from
/// [`STRAIGHT_FROM`] on go straight.
const STATIONS_PER_SWEEP: usize = 3;

/// Largest height difference of ground that is about level, as a share of the creature's height.
const LEVEL_TOLERANCE: f64 = 0.04;

impl Room<'_> {
    /// How far the creature may walk straight ahead, metres: at most `far`, and at most as far as it sees. Negative if
    /// the creature is in an obstacle or too near to it.
    pub(in crate::creature) fn ahead(&self, far: f64) -> f64 {
        let margin = OBSTACLE_MARGIN * self.height;
        let feet = self.band(0);
        let spacing = STATION_SPACING * self.height;
        let sees = spacing * MOST_STATIONS as f64 - feet.front - margin;
        let far = far.min(sees).max(0.0);
        let reach = feet.front + margin + far;
        let count = ((reach / spacing).ceil() as usize).clamp(1, MOST_STATIONS);
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
        for index in 0..BAND_COUNT {
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
            // Another creature may approach at the same speed, so each of them has half of the distance. Its skin also
            // sways.
            let front = front + SWAYING_DISTANCE * self.height;
            let reach = front + 2.0 * free.max(0.0);
            let hit = self.sweep_ahead(index, &band, reach, spacing, &levels, Among::Creatures);
            if let Some(left) = hit.map(|hit| hit - front) {
                free = free.min(if left > 0.0 { 0.5 * left } else { left });
            }
        }
        free
    }

    /// Position of the creature after `far` metres straight ahead; `None` if the way is not free.
    pub(in crate::creature) fn walked(&self, far: f64) -> Option<DVec3> {
        let is_free = self.ahead(far) >= far;
        let there = self.origin + self.forward * far;
        let level = is_free.then(|| self.below(there)).flatten()?;
        Some(there.with_y(level))
    }

    /// True if certainly nothing is in the way of the higher bands. One fat capsule around them replaces a sweep for
    /// each.
    fn is_high_way_free(&self, free: f64) -> bool {
        let high = self.box_of(STRAIGHT_FROM..BAND_COUNT);
        let (middle, radius) = self.high_middle();
        let way =
            high.front + (OBSTACLE_MARGIN + SWAYING_DISTANCE) * self.height + 2.0 * free.max(0.0);
        let capsule = WorldCapsule {
            ends: [high.right, high.left].map(|aside| middle + self.left * aside),
            radius,
        };
        self.is_clear(&capsule, self.forward * way)
    }

    /// True if the ground ahead is about as high as the ground where the creature stands.
    fn is_about_level(&self, levels: &[[f64; MOST_STATIONS + 1]; 3]) -> bool {
        let known = levels.iter().flatten().filter(|level| **level < NO_GROUND);
        let mut rises = known.map(|level| (level - self.origin.y).abs());
        rises.all(|rise| rise <= LEVEL_TOLERANCE * self.height)
    }

    /// Middle of the higher bands, and half their height; the latter includes the tolerance `LEVEL_TOLERANCE`.
    fn high_middle(&self) -> (DVec3, f64) {
        let [low, high] =
            [BAND_EDGES[STRAIGHT_FROM], BAND_EDGES[BAND_COUNT]].map(|edge| edge * self.height);
        let up = DVec3::Y * (0.5 * (low + high));
        (
            self.origin + up,
            0.5 * (high - low) + LEVEL_TOLERANCE * self.height,
        )
    }

    /// Heights of the ground along a lane, per station. Under the body, only the ends of pieces are measured.
    fn lane(
        &self,
        aside: f64,
        spacing: f64,
        [from, count]: [usize; 2],
    ) -> [f64; MOST_STATIONS + 1] {
        let mut levels = [NO_GROUND; MOST_STATIONS + 1];
        let mut level = self.origin.y;
        let under = (0..from).step_by(STATIONS_PER_SWEEP);
        for station in under.chain(from..count + 1) {
            let at = self.forward * (spacing * station as f64) + self.left * aside;
            if let Some(next) = self.below((self.origin + at).with_y(level)) {
                (levels[station], level) = (next, next);
            }
        }
        levels
    }

    /// If the creature cannot walk onto the ground of a station, returns the last station before the obstacle. The
    /// obstacle is a slope that is too steep, a drop, or a wall; a slope counts from its beginning.
    fn last_ground(
        &self,
        levels: &[[f64; MOST_STATIONS + 1]; 3],
        lanes: &[f64; 3],
        station: usize,
        spacing: f64,
        front: f64,
    ) -> Option<usize> {
        let over = STEP_OVER_HEIGHT * self.height;
        let is_level = |rise: f64, way: f64| rise.abs() <= self.steepest * way.abs() + over;
        if spacing * station as f64 <= front {
            // The feet already stand there.
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

    /// Distance from the origin at which the front of a band first touches an obstacle ahead, metres. The band's
    /// capsule lies across the body.
    fn sweep_ahead(
        &self,
        index: usize,
        band: &Band,
        reach: f64,
        spacing: f64,
        levels: &[[f64; MOST_STATIONS + 1]; 3],
        among: Among,
    ) -> Option<f64> {
        let thick = self.thick(index);
        // The capsule with its round ends is as wide as the body.
        let [right, left] = [(band.right + thick).min(0.0), (band.left - thick).max(0.0)];
        let way = (reach - thick).max(0.0);
        let last = ((way / spacing).ceil() as usize).clamp(1, MOST_STATIONS);
        let step = if index < STRAIGHT_FROM {
            STATIONS_PER_SWEEP
        } else {
            last
        };
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
