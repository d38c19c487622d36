//! Ways around obstacles between a creature and its goal: the corners of a path over a grid, found by A*.

use std::collections::BTreeMap;

use glam::DVec3;
use pathfinding::directed::astar::astar;
use serde::{Deserialize, Serialize};

use super::way::Way;
use super::{Creature, Surroundings};
use crate::feet::Carried;
use crate::kind::{Extent, Extents};

/// Width of the grid's cells, as a share of the creature's height.
const CELL_WIDTH: f64 = 0.35;

/// Number of steps between cells that a search tries at most. It bounds the time of a search.
const MOST_STEPS: usize = 500;

/// Straight lines are checked in pieces of this length, as a share of the creature's height.
const LINE_PIECE_LENGTH: f64 = 1.0;

/// Straight lines are checked up to this distance, in heights. The creature knows no obstacles farther away.
const FARTHEST_LINE: f64 = 16.0;

/// A shortcut along the path leads fewer than this many places ahead.
const MOST_SKIPPED: usize = 12;

/// Distance from both ends of a wide way within which it may be narrow, in heights. It is at least the distance of the
/// body's outermost corner from the origin.
const NARROW_END_DISTANCE: f64 = 1.2;

/// Distance within which the creature has passed a corner, as a share of its height.
const PASSED_DISTANCE: f64 = 0.12;

/// Time until the next search after one that found corners, seconds for a creature of `GIANT_HEIGHT`.
const WAIT_AFTER_CORNERS: f64 = 1.0;

/// Time until the next search after one that found the straight line free, seconds for a creature of `GIANT_HEIGHT`.
const WAIT_AFTER_FREE_LINE: f64 = 4.0;

/// Time until the next search after one that found no way, seconds for a creature of `GIANT_HEIGHT`. It doubles with
/// each failure in a row, up to eight times this.
const WAIT_AFTER_FAILURE: f64 = 4.0;

/// Shortest time until the next search, seconds. It applies to small creatures.
const SHORTEST_WAIT: f64 = 0.5;

/// A place on the grid: steps from the creature's place along X and Z, and how much higher the ground is there, in
/// thousandths of the creature's height. The height distinguishes storeys.
type Cell = [i32; 3];

/// Offsets to the four neighbours of a cell, in order around it. A step to one neighbour and a step in the direction of
/// the next one lead to the diagonal cell between both.
const NEIGHBOUR_OFFSETS: [[i32; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];

/// Cost of a step to a neighbour.
const STRAIGHT_STEP_COST: u32 = 10;

/// Cost of a diagonal step: about `STRAIGHT_STEP_COST` times the square root of 2.
const DIAGONAL_STEP_COST: u32 = 14;

/// Largest difference between the ground heights at the end of both ways round to a diagonal cell, in thousandths of
/// the creature's height. With more, the ways lead to different storeys, and there is no diagonal step.
const SAME_STOREY: i32 = 100;

/// Most corners of a way in a restored state.
const MOST_CORNERS: usize = 512;

/// The corners of a way, and when the creature searches for them again.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Corners {
    /// Corners on the way to the goal, the next one first; empty if the way is straight.
    places: Vec<DVec3>,
    /// Ticks until the next search for corners.
    ticks_left: u32,
    /// Number of searches in a row that found no way.
    failed: u32,
}

impl Corners {
    /// The next corner; `None` if the way is straight.
    pub(super) fn next(&self) -> Option<DVec3> {
        self.places.first().copied()
    }

    /// True if the last search found no way.
    pub(super) fn has_failed(&self) -> bool {
        self.failed != 0
    }

    /// No corners, with the same time until the next search.
    pub(super) fn forgotten(&self) -> Self {
        Self {
            places: Vec::new(),
            ..*self
        }
    }

    /// Removes the next corner.
    pub(super) fn skip(&mut self) {
        self.places.remove(0);
    }

    /// Makes a search due now.
    pub(super) fn search_now(&mut self) {
        self.ticks_left = 0;
    }

    /// Counts a tick of the time until the next search.
    pub(super) fn wait(&mut self) {
        self.ticks_left = self.ticks_left.saturating_sub(1);
    }

    /// Moves the corners with the ground that carries the creature.
    pub(super) fn be_carried(&mut self, carried: &Carried) {
        for place in &mut self.places {
            *place = carried.level_place(*place);
        }
    }

    /// True if all numbers are within the range that a creature reaches.
    pub(super) fn is_within(&self, most: f64) -> bool {
        let mut numbers = self.places.iter().flat_map(|corner| corner.to_array());
        self.places.len() <= MOST_CORNERS && numbers.all(|number| number.abs() <= most)
    }
}

impl Creature {
    /// Searches for the corners of the way to the goal, if a search is due.
    pub(super) fn find_corners(&mut self, around: &Surroundings<'_>, way: &Way) {
        if self.state.walked.corners.ticks_left > 0 {
            return;
        }
        let kind = std::sync::Arc::clone(&self.kind);
        let Some(Extents { on_spot, walking }) = kind.extents() else {
            return;
        };
        let slim = walking.slim();
        let narrow = Width {
            slim: &slim,
            stout: None,
            goal: way.goal,
            near: 0.0,
        };
        let mut found = None;
        if self.state.walked.retreats.looks_for_wide_way() {
            let stout = on_spot.stout().and(&slim);
            let wide = Width {
                stout: Some(&stout),
                near: (NARROW_END_DISTANCE * self.size.height)
                    .max(on_spot.farthest() * self.size.scale),
                ..narrow
            };
            found = self.corners(around, &wide, way);
            if found.is_none() {
                self.state.walked.retreats.fail_wide_way();
            }
        }
        let found = found.or_else(|| self.corners(around, &narrow, way));
        let corners = &mut self.state.walked.corners;
        corners.failed = match found {
            Some(_) => 0,
            None => corners.failed.saturating_add(1),
        };
        // Wait longer after each failure: a failed search is expensive, since it has tried all cells that it can reach.
        corners.places = found.unwrap_or_default();
        let seconds = match (corners.failed, corners.places.is_empty()) {
            (0, true) => WAIT_AFTER_FREE_LINE,
            (0, false) => WAIT_AFTER_CORNERS,
            (failed, _) => WAIT_AFTER_FAILURE * f64::from(1u32 << (failed - 1).min(3)),
        };
        self.state.walked.corners.ticks_left = self.ticks_of(seconds);
    }

    /// Removes the next corners that the creature has reached.
    pub(super) fn pass_corners(&mut self) {
        let passed = PASSED_DISTANCE * self.size.height;
        let position = self.state.position();
        let is_there = |corner: &DVec3| (*corner - position).with_y(0.0).length() < passed;
        let corners = &mut self.state.walked.corners.places;
        let count = corners.iter().take_while(|corner| is_there(corner)).count();
        corners.drain(..count);
    }

    /// Brings the next search forward because of an obstacle ahead, unless the last search found no way.
    pub(super) fn doubt_corners(&mut self) {
        if !self.state.walked.corners.has_failed() {
            self.look_soon();
        }
    }

    /// Brings the next search forward to `WAIT_AFTER_CORNERS` from now, if it is not due sooner.
    pub(super) fn look_soon(&mut self) {
        let soon = self.ticks_of(WAIT_AFTER_CORNERS);
        let corners = &mut self.state.walked.corners;
        corners.ticks_left = corners.ticks_left.min(soon);
    }

    /// Converts seconds for a creature of `GIANT_HEIGHT` to ticks of this one.
    fn ticks_of(&self, seconds: f64) -> u32 {
        let seconds = (seconds * self.size.pace).max(SHORTEST_WAIT);
        (seconds / self.kind.brain().tick()).clamp(1.0, 1e6) as u32
    }

    /// The corners of a way; empty if the straight line to the goal is free. `None` if the search finds no way.
    fn corners(
        &self,
        around: &Surroundings<'_>,
        width: &Width<'_>,
        way: &Way,
    ) -> Option<Vec<DVec3>> {
        let start = self.state.position();
        let end = |from: DVec3| {
            let to = (way.goal - from).with_y(0.0);
            let left = (to.length() - way.within).clamp(0.0, FARTHEST_LINE * self.size.height);
            from + to.normalize_or_zero() * left
        };
        if self.passes(around, width, start, end(start)).is_some() {
            return Some(Vec::new());
        }
        // The known corners are kept as long as the way along them is free.
        let known = &self.state.walked.corners.places;
        if let Some(last) = known.last() {
            let from = core::iter::once(start).chain(known.iter().copied());
            let to = known.iter().copied().chain([end(*last)]);
            let mut pieces = from.zip(to);
            if pieces.all(|(from, to)| self.passes(around, width, from, to).is_some()) {
                return Some(known.clone());
            }
        }
        let grid = Grid {
            creature: self,
            around,
            width,
            start,
            cell: CELL_WIDTH * self.size.height,
        };
        let places = grid.search(way)?;
        // Leave out places wherever the straight line past them is free.
        let mut corners = Vec::new();
        let mut index = 0;
        while index + 1 < places.len() {
            let passes = |next: &usize| {
                let [from, to] = [places[index], places[*next]];
                self.passes(around, width, from, to).is_some()
            };
            let far = places.len().min(index + MOST_SKIPPED);
            let far = (index + 2..far).rev().find(passes);
            index = far.unwrap_or(index + 1);
            corners.push(places[index]);
        }
        Some(corners)
    }

    /// The ground height at `to`, if the creature can walk there from `from` in a straight line.
    fn passes(
        &self,
        around: &Surroundings<'_>,
        width: &Width<'_>,
        from: DVec3,
        to: DVec3,
    ) -> Option<f64> {
        let way = (to - from).with_y(0.0);
        let heights = way.length() / self.size.height;
        if heights.is_nan() || heights > 2.0 * FARTHEST_LINE {
            return None;
        }
        let pieces = (heights / LINE_PIECE_LENGTH).ceil().max(1.0);
        let step = way / pieces;
        let mut origin = from;
        for _ in 0..pieces as u32 {
            let extent = self.takes_up(width, origin + 0.5 * step);
            let mut room = self.room_towards(around, extent, step);
            room.origin = origin;
            origin = room.walked(step.length())?;
        }
        Some(origin.y)
    }

    /// The room that the creature takes up at a place on its way: the wide extent only if there is one and the place is
    /// far from both ends.
    fn takes_up<'a>(&self, width: &Width<'a>, place: DVec3) -> &'a Extent {
        let is_far = |from: DVec3| (place - from).with_y(0.0).length() > width.near;
        let stout = width
            .stout
            .filter(|_| is_far(self.state.position()) && is_far(width.goal));
        stout.unwrap_or(width.slim)
    }
}

/// How wide a way has to be.
#[derive(Clone, Copy)]
struct Width<'a> {
    /// Extent of the creature while it walks along the way.
    slim: &'a Extent,
    /// Extent of the creature while it turns, for a way on which it can turn everywhere but near the ends. `None` for a
    /// way that need only be wide enough to walk.
    stout: Option<&'a Extent>,
    goal: DVec3,
    /// Distance from both ends within which the way may be narrow, metres.
    near: f64,
}

/// A grid around a creature.
struct Grid<'a> {
    creature: &'a Creature,
    around: &'a Surroundings<'a>,
    width: &'a Width<'a>,
    start: DVec3,
    /// Width of the cells, metres.
    cell: f64,
}

impl Grid<'_> {
    /// Places on the shortest way to a goal, beginning with the start. `None` if the search finds none.
    fn search(&self, way: &Way) -> Option<Vec<DVec3>> {
        let to_goal = |at: &Cell| (way.goal - self.place(*at)).with_y(0.0).length();
        let is_there = |at: &Cell| to_goal(at) <= way.within.max(0.75 * self.cell);
        let guess = |at: &Cell| {
            let left = (to_goal(at) - way.within).max(0.0) / self.cell;
            (f64::from(STRAIGHT_STEP_COST) * left).min(1e9) as u32
        };
        let mut known = Known::default();
        let next = |at: &Cell| {
            let mut reached = Vec::new();
            let sides: [Option<Cell>; 4] =
                core::array::from_fn(|side| self.beside(*at, side, &mut known));
            for side in 0..4 {
                reached.extend(sides[side].map(|to| (to, STRAIGHT_STEP_COST)));
                let other = (side + 1) % 4;
                if let (Some(a), Some(b)) = (sides[side], sides[other])
                    && let Some(to) = self.beside(a, other, &mut known)
                    && let Some(same) = self.beside(b, side, &mut known)
                    && (to[2] - same[2]).abs() <= SAME_STOREY
                {
                    reached.push((to, DIAGONAL_STEP_COST));
                }
            }
            reached
        };
        let (cells, _) = astar(&[0; 3], next, guess, is_there)?;
        Some(cells.into_iter().map(|at| self.place(at)).collect())
    }

    /// The neighbour of a cell on one side, if the creature can walk there.
    fn beside(&self, at: Cell, side: usize, known: &mut Known) -> Option<Cell> {
        if let Some(known) = known.steps.get(&(at, side)) {
            return *known;
        }
        if known.tried >= MOST_STEPS {
            return None;
        }
        known.tried += 1;
        let [x, z] = NEIGHBOUR_OFFSETS[side];
        let to = self.place([at[0] + x, at[1] + z, 0]);
        let (home, is_sent) = (
            self.creature.state.territory.home(),
            self.creature.sent_to().is_some(),
        );
        let far = |place: DVec3| (place - home).with_y(0.0).length();
        // A creature that was sent may leave its arena.
        let is_inside = is_sent || far(to) <= self.creature.config.arena.max(far(self.start));
        let passes = || {
            let from = self.place(at);
            self.creature.passes(self.around, self.width, from, to)
        };
        let level = is_inside.then(passes).flatten();
        let to = level.map(|level| {
            let storey = (level - self.start.y) / self.unit();
            [at[0] + x, at[1] + z, storey.round() as i32]
        });
        known.steps.insert((at, side), to);
        if let Some(to) = to.filter(|_| self.width.stout.is_none()) {
            // A step is also free in reverse if the way has the same width everywhere.
            known.steps.insert((to, (side + 2) % 4), Some(at));
        }
        to
    }

    fn place(&self, [x, z, storey]: Cell) -> DVec3 {
        let level = DVec3::new(f64::from(x), 0.0, f64::from(z)) * self.cell;
        self.start + level + DVec3::Y * (f64::from(storey) * self.unit())
    }

    fn unit(&self) -> f64 {
        1e-3 * self.creature.size.height
    }
}

/// The steps of a grid that were tried.
#[derive(Default)]
struct Known {
    /// For a cell and a side: the cell to which the step leads, `None` if the creature cannot walk there.
    steps: BTreeMap<(Cell, usize), Option<Cell>>,
    tried: usize,
}
