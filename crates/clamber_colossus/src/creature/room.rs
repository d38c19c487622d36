//! Whether there is room: how far the way ahead is free, how far it may turn, and whether a blow would go through rock.
//!
//! Ground is looked for by rays down along three lanes. What stands on it is looked for by sweeps of thin capsules that
//! lie across the body, or along it where it turns, one for each band of its height.

use clamber_surface::geometry::WorldCapsule;
use clamber_surface::surface::TargetMotion;
use clamber_world::{Obstacle, SweepContact};
use glam::DVec3;

use super::ground::GROUND_SPACING;
use super::state::NO_GROUND;
use super::{Creature, Surroundings};
use crate::feet::Ground;
use crate::kind::{BANDS, Band, EDGES, Extent, Strike, Swept};

/// What is no higher above the ground than this share of its height it steps over.
pub(super) const STEPS_OVER: f64 = 0.06;

/// It keeps this far from what stands in its way, as a share of its height.
const MARGIN: f64 = 0.015;

/// How much further it keeps from other creatures, since their skin moves while they stand.
const SWAYS: f64 = 0.05;

/// The ground ahead is looked at in steps of this share of its height, and in at most so many.
const SPACING: f64 = 0.08;
const STATIONS: usize = 64;

/// Lower bands follow the ground in pieces of so many steps. From this band on one straight sweep is enough.
const PIECE: usize = 3;
const STRAIGHT_FROM: usize = 2;

/// Ground that is no higher or lower than this share of its height is about level.
const ABOUT: f64 = 0.04;

/// What a sweep touches does not stop it if it moves along that: the sine of the angle between both.
const ALONG: f64 = 0.01;

/// Arcs of turns are looked along in chords of this angle, radians: they leave the arc by 1.1 % of its radius.
const MOST_TURN: f64 = 0.3;

/// Blows may go into ground: what has a normal that is as upright as this cosine.
const STEEP: f64 = 0.7;

/// What is looked for.
#[derive(Clone, Copy)]
enum Among {
    Terrain,
    Creatures,
}

/// The surroundings of a creature, seen from where it stands, in the direction in which it may go.
pub(super) struct Room<'a> {
    around: &'a Surroundings<'a>,
    extent: &'a Extent,
    pub(super) origin: DVec3,
    forward: DVec3,
    left: DVec3,
    scale: f64,
    height: f64,
    /// Tangent of the steepest ground that it walks onto.
    steepest: f64,
}

impl Creature {
    /// Its surroundings in the direction of its heading.
    pub(super) fn room<'a>(&self, around: &'a Surroundings<'a>, extent: &'a Extent) -> Room<'a> {
        self.room_towards(around, extent, self.state.heading())
    }

    /// Its surroundings in the direction of a level vector.
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
            origin: self.state.position,
            forward,
            left: DVec3::new(forward.z, 0.0, -forward.x),
            scale: self.size.scale,
            height: self.size.height,
            steepest: libm::tan(self.config.most_slope),
        }
    }

    /// False if anything of it would go through rock or another creature in an attack. What it steps over does not count,
    /// nor ground: feet come down on that, and hands may strike it.
    pub(super) fn may_strike(&self, strike: &Strike, around: &Surroundings<'_>) -> bool {
        let world = self.state.world_from_model(self.size.scale);
        let low = self.state.position.y + STEPS_OVER * self.size.height;
        for Swept { radius, aims, way } in &strike.swept {
            let count = way.len().max(2) as f64 - 1.0;
            let places = way.iter().enumerate().map(|(index, place)| {
                // A leg goes to where it aims little by little.
                let share = if *aims { index as f64 / count } else { 0.0 };
                let place = world.transform_point(*place) + self.state.aim * share;
                place.with_y(place.y.max(low + radius * self.size.scale))
            });
            let places: Vec<DVec3> = places.collect();
            for pair in places.windows(2) {
                let ball = WorldCapsule::ball(pair[0], radius * self.size.scale);
                let way = pair[1] - pair[0];
                // What it stands in or leaves is not in its way.
                let mut is_rock = |hit: &SweepContact| {
                    let normal = hit.separation_normal;
                    !hit.started_inside && normal.y < STEEP && normal.dot(way) < 0.0
                };
                for obstacles in [around.terrain, around.creatures] {
                    if first(obstacles, &ball, [way; 2], &mut is_rock).is_some() {
                        return false;
                    }
                }
            }
        }
        true
    }

    /// The gradient of the ground on which it stands, as it knows it.
    pub(super) fn slope(&self) -> DVec3 {
        let heading = self.state.heading();
        let left = DVec3::new(heading.z, 0.0, -heading.x);
        let most = libm::tan(self.config.most_slope).min(1.0);
        let rise = |[from, to]: [usize; 2], steps: f64| {
            let [from, to] = [from, to].map(|index| self.state.ground[index]);
            let known = from < NO_GROUND && to < NO_GROUND;
            let rise = (to - from) / (steps * GROUND_SPACING * self.size.height);
            if known { rise.clamp(-most, most) } else { 0.0 }
        };
        heading * rise([0, 6], 6.0) + left * rise([8, 7], 2.0)
    }
}

impl Room<'_> {
    /// How far it may walk straight ahead, metres, up to `far`. Negative where it stands in something, or too near.
    pub(super) fn ahead(&self, far: f64) -> f64 {
        let far = far.max(0.0);
        let margin = MARGIN * self.height;
        let feet = self.band(0);
        let spacing = SPACING * self.height;
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
    pub(super) fn walked(&self, far: f64) -> Option<DVec3> {
        let is_free = self.ahead(far) >= far;
        let there = self.origin + self.forward * far;
        let level = is_free.then(|| self.below(there)).flatten()?;
        Some(there.with_y(level))
    }

    /// How far it may turn on the spot, radians, up to `far` and with its sign: positive to the left.
    pub(super) fn turn(&self, far: f64, slope: DVec3) -> f64 {
        let pieces = (far.abs() / MOST_TURN).ceil().max(1.0);
        let piece = far / pieces;
        let mut free = 0.0;
        for index in 0..pieces as u32 {
            let turned = self.turn_piece(f64::from(index) * piece, piece, slope);
            free += turned;
            if turned.abs() < piece.abs() {
                break;
            }
        }
        free
    }

    /// How far it may turn on from where it has turned by an angle.
    fn turn_piece(&self, from: f64, far: f64, slope: DVec3) -> f64 {
        let margin = MARGIN * self.height;
        let mut free = far.abs();
        let feet = self.band(0);
        let over = STEPS_OVER * self.height;
        for (aside, along) in [
            (feet.right, feet.back),
            (feet.left, feet.back),
            (feet.right, feet.front),
            (feet.left, feet.front),
        ] {
            // Where its feet may come to stand then.
            let corner = turned(self.left * aside + self.forward * along, from + far);
            let below = self.below(self.origin + corner + DVec3::Y * corner.dot(slope));
            let most = self.steepest * corner.length() + over;
            if below.is_none_or(|level| (level - self.origin.y).abs() > most) {
                free = 0.0;
            }
        }
        for index in 1..BANDS {
            if index == STRAIGHT_FROM && self.is_high_turn_free(from, far, slope) {
                break;
            }
            let band = self.band(index);
            let thick = self.thick(index);
            let inner = thick - margin;
            let [back, right] = [band.back, band.right].map(|at| (at + inner).min(0.0));
            let [front, left] = [band.front, band.left].map(|at| (at - inner).max(0.0));
            // Along the body, across it, and from corner to corner of its box.
            let spans = [
                [(0.0, back), (0.0, front)],
                [(right, 0.0), (left, 0.0)],
                [(right, back), (left, front)],
                [(left, back), (right, front)],
            ];
            for span in spans {
                let ends = span
                    .map(|(aside, along)| turned(self.left * aside + self.forward * along, from));
                let turned = ends.map(|end| turned(end, far.signum() * free));
                let place = |level: DVec3| {
                    let up = self.middle(index) + level.dot(slope);
                    self.origin + level + DVec3::Y * up
                };
                let from = ends.map(place);
                let to = turned.map(place);
                let capsule = WorldCapsule {
                    ends: from,
                    radius: thick,
                };
                let ways = [to[0] - from[0], to[1] - from[1]];
                let goes = |contact: DVec3| {
                    let way = DVec3::Y.cross(contact - self.origin) * far.signum();
                    way.normalize_or_zero()
                };
                let all = [Among::Terrain, Among::Creatures];
                if let Some(time) = self.sweep(&capsule, ways, &goes, &all) {
                    free *= time;
                }
            }
        }
        far.signum() * free
    }

    /// True if certainly nothing is in the way of the higher bands: one fat capsule around them, in place of one sweep
    /// for each.
    fn is_high_way_free(&self, free: f64) -> bool {
        let high = self.high_box();
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

    /// The same for a turn from one angle on by another one.
    fn is_high_turn_free(&self, from: f64, by: f64, slope: DVec3) -> bool {
        let high = self.high_box();
        let (middle, radius) = self.high_middle();
        let wide = high.left.max(-high.right);
        let long = high.front.max(-high.back);
        let reach = (wide * wide + long * long).sqrt();
        if slope.length() * reach > ABOUT * self.height {
            return false;
        }
        // Half of the turn to each side, from the middle of it.
        let aside = wide + reach * libm::sin((0.5 * by).abs()) + MARGIN * self.height;
        let axis = turned(self.forward, from + 0.5 * by);
        let capsule = WorldCapsule {
            ends: [high.back, high.front].map(|along| middle + axis * along),
            // As high as the bands are, as far aside as they come.
            radius: (radius * radius + aside * aside).sqrt(),
        };
        self.is_clear(&capsule, DVec3::ZERO)
    }

    /// The box around the higher bands, metres.
    fn high_box(&self) -> Band {
        let bands = (STRAIGHT_FROM..BANDS).map(|index| self.band(index));
        let around = |a: Band, b: Band| Band {
            right: a.right.min(b.right),
            left: a.left.max(b.left),
            back: a.back.min(b.back),
            front: a.front.max(b.front),
        };
        bands.reduce(around).unwrap_or(self.band(0))
    }

    /// The middle of the higher bands, and half their height.
    fn high_middle(&self) -> (DVec3, f64) {
        let [low, high] = [EDGES[STRAIGHT_FROM], EDGES[BANDS]].map(|edge| edge * self.height);
        let up = DVec3::Y * (0.5 * (low + high));
        (self.origin + up, 0.5 * (high - low) + ABOUT * self.height)
    }

    fn is_clear(&self, capsule: &WorldCapsule, way: DVec3) -> bool {
        let all = [self.around.terrain, self.around.creatures];
        let mut any = |_: &SweepContact| true;
        all.into_iter()
            .all(|obstacles| first(obstacles, capsule, [way; 2], &mut any).is_none())
    }

    /// A band's box, metres.
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

    /// Half the thickness of a band, and the height of its middle above the ground, metres.
    fn thick(&self, index: usize) -> f64 {
        0.5 * (EDGES[index + 1] - EDGES[index]) * self.height
    }

    fn middle(&self, index: usize) -> f64 {
        0.5 * (EDGES[index + 1] + EDGES[index]) * self.height
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

    fn below(&self, place: DVec3) -> Option<f64> {
        let ground = Ground {
            terrain: self.around.terrain,
            reach: 0.5 * self.height,
        };
        ground.below(place).map(|(level, _)| level)
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

    /// The time of the first touch of a capsule that is in its way, from 0 to 1.
    fn sweep(
        &self,
        capsule: &WorldCapsule,
        ways: [DVec3; 2],
        goes: &dyn Fn(DVec3) -> DVec3,
        among: &[Among],
    ) -> Option<f64> {
        let mut is_in_the_way =
            |hit: &SweepContact| hit.separation_normal.dot(goes(hit.contact.point)) < -ALONG;
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

/// The time at which a capsule first touches something that counts, from 0 to 1.
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
    hits.map(|hit| hit.time).min_by(f64::total_cmp)
}

/// A level vector, turned about up.
fn turned(level: DVec3, angle: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(angle);
    DVec3::new(
        level.x * cos + level.z * sin,
        level.y,
        level.z * cos - level.x * sin,
    )
}
