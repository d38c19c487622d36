//! Ways round what stands between a creature and its goal: the corners of a path over a grid, found by A*.

use std::collections::BTreeMap;

use glam::DVec3;
use pathfinding::directed::astar::astar;

use super::state::Wide;
use super::way::Way;
use super::{Creature, Surroundings};
use crate::kind::{Extent, Extents};

/// Width of the grid's cells, as a share of the creature's height.
const CELL: f64 = 0.35;

/// So many steps from cell to cell are tried before it gives up.
const MOST_STEPS: usize = 500;

/// Straight lines are looked along in pieces of this share of its height.
const PIECE: f64 = 1.0;

/// It looks along straight lines as far as this, in heights. What is further away it does not know.
const FARTHEST: f64 = 16.0;

/// So many places of a way are left out at a time, if it is straight.
const SKIPPED: usize = 12;

/// So near to where it is and to where it goes, in heights, a way may be as narrow as it can walk: as near as its corner
/// that is furthest out is, at least.
const NEAR: f64 = 1.2;

/// A corner is passed when it is this near, as a share of the creature's height.
const PASSED: f64 = 0.12;

/// A way is looked for anew after so many seconds, for a giant: with something in its way, and without; and after so many
/// if there was none, twice as many the next time, up to eight times as many.
const ANEW: f64 = 1.0;
const FAR: f64 = 4.0;
const AGAIN: f64 = 4.0;

/// Small creatures look no sooner than after so many seconds.
const LEAST: f64 = 0.5;

/// A place on the grid: steps from where the creature is along X and Z, and how high above it the ground is there, in
/// thousandths of its height, since there may be several storeys.
type Cell = [i32; 3];

/// The four neighbours of a cell, around it. A step between two of them leads to the corner that both have in common.
const SIDES: [[i32; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];

/// What steps to a neighbour and across a corner cost.
const STEP: u32 = 10;
const ACROSS: u32 = 14;

/// A step across a corner leads to the same storey on both ways, to so many thousandths of the height.
const SAME_STOREY: i32 = 100;

impl Creature {
    /// Finds the corners of the way to a goal, if it is time for that.
    pub(super) fn find_corners(&mut self, around: &Surroundings<'_>, way: &Way) {
        if self.state.walked.ticks_left > 0 {
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
        if self.state.walked.wide == Wide::Looks {
            let stout = on_spot.stout().and(&slim);
            let wide = Width {
                stout: Some(&stout),
                near: (NEAR * self.size.height).max(on_spot.farthest() * self.size.scale),
                ..narrow
            };
            found = self.corners(around, &wide, way);
            if found.is_none() {
                self.state.walked.wide = Wide::Failed;
            }
        }
        let found = found.or_else(|| self.corners(around, &narrow, way));
        let walked = &mut self.state.walked;
        walked.failed = match found {
            Some(_) => 0,
            None => walked.failed.saturating_add(1),
        };
        // Longer and longer: a search that finds nothing looks at all there is.
        walked.corners = found.unwrap_or_default();
        let seconds = match (walked.failed, walked.corners.is_empty()) {
            (0, true) => FAR,
            (0, false) => ANEW,
            (failed, _) => AGAIN * f64::from(1u32 << (failed - 1).min(3)),
        };
        self.state.walked.ticks_left = self.ticks_of(seconds);
    }

    /// Corners that it has reached are behind it.
    pub(super) fn pass_corners(&mut self) {
        let passed = PASSED * self.size.height;
        let position = self.state.position;
        let is_there = |corner: &DVec3| (*corner - position).with_y(0.0).length() < passed;
        let corners = &mut self.state.walked.corners;
        let count = corners.iter().take_while(|corner| is_there(corner)).count();
        corners.drain(..count);
    }

    /// Something is ahead: it looks for another way soon, unless it has found none.
    pub(super) fn doubt_corners(&mut self) {
        if self.state.walked.failed == 0 {
            self.look_soon();
        }
    }

    /// It looks for a way before long.
    pub(super) fn look_soon(&mut self) {
        let soon = self.ticks_of(ANEW);
        let walked = &mut self.state.walked;
        walked.ticks_left = walked.ticks_left.min(soon);
    }

    /// Ticks of seconds that are told for a giant.
    fn ticks_of(&self, seconds: f64) -> u32 {
        let seconds = (seconds * self.size.pace).max(LEAST);
        (seconds / self.kind.brain().tick()).clamp(1.0, 1e6) as u32
    }

    /// The corners of a way; `None` if there is none, or it is too long.
    fn corners(
        &self,
        around: &Surroundings<'_>,
        width: &Width<'_>,
        way: &Way,
    ) -> Option<Vec<DVec3>> {
        let start = self.state.position;
        let end = |from: DVec3| {
            let to = (way.goal - from).with_y(0.0);
            let left = (to.length() - way.within).clamp(0.0, FARTHEST * self.size.height);
            from + to.normalize_or_zero() * left
        };
        if self.passes(around, width, start, end(start)).is_some() {
            return Some(Vec::new());
        }
        // Those that it has are as good as new ones, as long as they lead there.
        let known = &self.state.walked.corners;
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
            cell: CELL * self.size.height,
        };
        let places = grid.search(way)?;
        // Straight on wherever nothing stands in between.
        let mut corners = Vec::new();
        let mut index = 0;
        while index + 1 < places.len() {
            let passes = |next: &usize| {
                let [from, to] = [places[index], places[*next]];
                self.passes(around, width, from, to).is_some()
            };
            let far = places.len().min(index + SKIPPED);
            let far = (index + 2..far).rev().find(passes);
            index = far.unwrap_or(index + 1);
            corners.push(places[index]);
        }
        Some(corners)
    }

    /// The height of the ground at a place, if it can walk there straight from another one.
    fn passes(
        &self,
        around: &Surroundings<'_>,
        width: &Width<'_>,
        from: DVec3,
        to: DVec3,
    ) -> Option<f64> {
        let way = (to - from).with_y(0.0);
        let heights = way.length() / self.size.height;
        if heights.is_nan() || heights > 2.0 * FARTHEST {
            return None;
        }
        let pieces = (heights / PIECE).ceil().max(1.0);
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

    /// The room that it takes up at a place on its way.
    fn takes_up<'a>(&self, width: &Width<'a>, place: DVec3) -> &'a Extent {
        let is_far = |from: DVec3| (place - from).with_y(0.0).length() > width.near;
        let stout = width
            .stout
            .filter(|_| is_far(self.state.position) && is_far(width.goal));
        stout.unwrap_or(width.slim)
    }
}

/// How wide a way has to be.
#[derive(Clone, Copy)]
struct Width<'a> {
    /// As wide as the creature is that walks.
    slim: &'a Extent,
    /// As wide as it is while it turns, on a way of which no place is too narrow for that but near its ends.
    stout: Option<&'a Extent>,
    goal: DVec3,
    /// So near to its ends it may be narrow, metres.
    near: f64,
}

/// A grid around a creature.
struct Grid<'a> {
    creature: &'a Creature,
    around: &'a Surroundings<'a>,
    width: &'a Width<'a>,
    start: DVec3,
    /// Width of its cells, metres.
    cell: f64,
}

impl Grid<'_> {
    /// Places on the shortest way to a goal, from the start on.
    fn search(&self, way: &Way) -> Option<Vec<DVec3>> {
        let to_goal = |at: &Cell| (way.goal - self.place(*at)).with_y(0.0).length();
        let is_there = |at: &Cell| to_goal(at) <= way.within.max(0.75 * self.cell);
        let guess = |at: &Cell| {
            let left = (to_goal(at) - way.within).max(0.0) / self.cell;
            (f64::from(STEP) * left).min(1e9) as u32
        };
        let mut known = Known::default();
        let next = |at: &Cell| {
            let mut reached = Vec::new();
            let sides: [Option<Cell>; 4] =
                core::array::from_fn(|side| self.beside(*at, side, &mut known));
            for side in 0..4 {
                reached.extend(sides[side].map(|to| (to, STEP)));
                let other = (side + 1) % 4;
                if let (Some(a), Some(b)) = (sides[side], sides[other])
                    && let Some(to) = self.beside(a, other, &mut known)
                    && let Some(same) = self.beside(b, side, &mut known)
                    && (to[2] - same[2]).abs() <= SAME_STOREY
                {
                    reached.push((to, ACROSS));
                }
            }
            reached
        };
        let (cells, _) = astar(&[0; 3], next, guess, is_there)?;
        Some(cells.into_iter().map(|at| self.place(at)).collect())
    }

    /// The neighbour of a cell, if it can walk there.
    fn beside(&self, at: Cell, side: usize, known: &mut Known) -> Option<Cell> {
        if let Some(known) = known.steps.get(&(at, side)) {
            return *known;
        }
        if known.tried >= MOST_STEPS {
            return None;
        }
        known.tried += 1;
        let [x, z] = SIDES[side];
        let to = self.place([at[0] + x, at[1] + z, 0]);
        let (home, is_sent) = (self.creature.state.home, self.creature.sent_to().is_some());
        let far = |place: DVec3| (place - home).with_y(0.0).length();
        // Where it is sent, its arena does not matter.
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
            // What it can walk, it can walk back.
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

/// Steps of a grid that were tried.
#[derive(Default)]
struct Known {
    /// From a cell to a side: where that leads.
    steps: BTreeMap<(Cell, usize), Option<Cell>>,
    tried: usize,
}
