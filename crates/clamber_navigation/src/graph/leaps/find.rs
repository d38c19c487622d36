//! Finds the jumps that are worth a try: to patches to which no short way leads.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, IVec3};

use super::{Aim, ClimbGraph, LONGEST_FLIGHT};
use crate::NavigationError;
use crate::graph::Footing;

/// A jump that is worth a try.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tried {
    /// The patches from which and at which it is aimed.
    pub(super) ends: [u32; 2],
    /// Seconds that it saves against the fastest way.
    saves: f64,
    /// Distance between the seats of both patches, metres.
    apart: f64,
}

/// Side of a cube of space, radii of the climber. For each ordered pair of cubes one jump is tried, the shortest one.
const CUBE_SIDE: f64 = 3.0;

/// A way is short if it takes no longer than this many times the jump. No jump is tried where a short way leads.
const SHORT_WAY_FACTOR: f64 = 3.0;

/// Jumps lead down by at most this many times the height to which they rise.
const MOST_DROP_FACTOR: f64 = 2.0;

/// Progress is reported once in this many cubes.
const CUBES_PER_REPORT: usize = 32;

/// Number of straight segments that stand in for the parabola when the path of a jump is tested for skin.
const PATH_SEGMENTS: u32 = 6;

/// The jumps that may be worth it, sorted by the time that they save, most first.
pub(super) fn tries(
    graph: &ClimbGraph,
    surface: &SkinnedSurface,
    tell: &mut dyn FnMut(usize, usize) -> Result<(), NavigationError>,
) -> Result<Vec<Tried>, NavigationError> {
    let climber = &graph.config.climber;
    let (ground, gravity) = (&climber.ground, climber.gravity.length());
    let rises = 0.5 * ground.jump_speed * ground.jump_speed / gravity;
    let deepest = MOST_DROP_FACTOR * rises;
    let longest = (ground.jump_speed + libm::sqrt(2.0 * gravity * (rises + deepest))) / gravity;
    let seconds = longest.min(LONGEST_FLIGHT);
    let range = ground.walk_speed * seconds;
    let side = CUBE_SIDE * graph.config.radius();
    if !(range > side && 2.0 * ground.jump_speed / gravity <= LONGEST_FLIGHT) {
        return Ok(Vec::new());
    }
    let cell = |seat: DVec3| (seat / side).floor().as_ivec3().to_array();
    let mut cells: BTreeMap<[i32; 3], Vec<u32>> = BTreeMap::new();
    for (index, patch) in (0..).zip(&graph.patches) {
        // Patches below a plate are left out, because no way leads there while the plate is in place.
        if patch.below.is_none() {
            cells.entry(cell(patch.seat)).or_default().push(index);
        }
    }
    let far = (range / side).ceil().min(MOST_CELLS) as i32;
    let up = climber.up();
    let mut beside = Beside::new(graph);
    let mut tries = Vec::new();
    for (done, (at, here)) in cells.iter().enumerate() {
        if done.is_multiple_of(CUBES_PER_REPORT) {
            tell(done, cells.len())?;
        }
        let stands = |patch: &&u32| graph.patches[**patch as usize].can_stand;
        let stands: Vec<u32> = here.iter().filter(stands).copied().collect();
        if stands.is_empty() {
            continue;
        }
        beside.look(graph, &stands, SHORT_WAY_FACTOR * seconds);
        let middle = IVec3::from_array(*at);
        for away in cube(far) {
            let Some(there) = cells.get(&(middle + away).to_array()) else {
                continue;
            };
            let mut best: Option<Tried> = None;
            for (from, to) in stands
                .iter()
                .flat_map(|from| there.iter().map(move |to| (*from, *to)))
            {
                let [a, b] = [from, to].map(|patch| graph.patches[patch as usize].seat);
                let apart = a.distance(b);
                if best.is_some_and(|best| best.apart <= apart) || (a - b).dot(up) > deepest {
                    continue;
                }
                let Some(aim) = Aim::at(climber, a, b) else {
                    continue;
                };
                let way = beside.seconds(to);
                if way > SHORT_WAY_FACTOR * aim.seconds {
                    best = Some(Tried {
                        ends: [from, to],
                        saves: way - aim.seconds,
                        apart,
                    });
                }
            }
            tries.extend(best.filter(|tried| is_free(graph, surface, tried.ends)));
        }
    }
    tries.sort_by(|a, b| {
        let saves = b.saves.total_cmp(&a.saves);
        saves
            .then(a.apart.total_cmp(&b.apart))
            .then(a.ends.cmp(&b.ends))
    });
    Ok(tries)
}

/// Jumps over more than this many cubes along an axis are not tried. It bounds the search for fast climbers.
const MOST_CELLS: f64 = 6.0;

fn cube(far: i32) -> impl Iterator<Item = IVec3> {
    let range = move || -far..=far;
    range().flat_map(move |x| range().flat_map(move |y| range().map(move |z| IVec3::new(x, y, z))))
}

/// True if no skin lies on the path through the air, and the jump arrives on the outside of the skin.
fn is_free(graph: &ClimbGraph, surface: &SkinnedSurface, ends: [u32; 2]) -> bool {
    let climber = &graph.config.climber;
    let [from, to] = ends.map(|patch| &graph.patches[patch as usize]);
    let Some(aim) = Aim::at(climber, from.seat, to.seat) else {
        return false;
    };
    let at = |share: f64| {
        let time = share * aim.seconds;
        let walk = aim.walk * climber.ground.walk_speed;
        from.seat
            + (walk + climber.up() * climber.ground.jump_speed) * time
            + climber.gravity * (0.5 * time * time)
    };
    let arrives = at(1.0) - at(0.9);
    let catches = at(1.0).distance(to.seat) > graph.config.radius();
    if !catches && arrives.dot(to.normal) > 0.0 {
        return false;
    }
    (0..PATH_SEGMENTS).all(|piece| {
        let [start, end] =
            [piece, piece + 1].map(|piece| at(f64::from(piece) / f64::from(PATH_SEGMENTS)));
        let length = start.distance(end);
        !surface
            .in_world()
            .intersects_ray(start, end - start, length)
    })
}

/// The times from some patches to others without a jump.
pub(super) struct Beside {
    /// For each patch, the time to it, seconds; infinite if it was not reached.
    known: Vec<f64>,
    /// The patches that were reached; used to reset `known`.
    reached: Vec<u32>,
    /// Patches whose ways are not followed yet, by their time.
    open: BinaryHeap<Reverse<(u64, u32)>>,
    /// Ways up to this time are followed, seconds.
    most: f64,
}

impl Beside {
    pub(super) fn new(graph: &ClimbGraph) -> Self {
        Self {
            known: vec![f64::INFINITY; graph.patches.len()],
            reached: Vec::new(),
            open: BinaryHeap::new(),
            most: 0.0,
        }
    }

    /// True if a short way leads from one patch to another, so that a jump of `jump` seconds is not worth it.
    pub(super) fn is_short(&mut self, graph: &ClimbGraph, [from, to]: [u32; 2], jump: f64) -> bool {
        self.look(graph, &[from], SHORT_WAY_FACTOR * jump);
        self.seconds(to) <= SHORT_WAY_FACTOR * jump
    }

    /// Finds the times from the nearest of some patches to all others, up to `most` seconds: Dijkstra's search (1959).
    fn look(&mut self, graph: &ClimbGraph, from: &[u32], most: f64) {
        for patch in self.reached.drain(..) {
            self.known[patch as usize] = f64::INFINITY;
        }
        self.most = most;
        for patch in from {
            self.offer(*patch, 0.0);
        }
        let [walks, climbs] = [Footing::Stands, Footing::Holds].map(|footing| graph.speed(footing));
        while let Some(Reverse((bits, patch))) = self.open.pop() {
            let seconds = f64::from_bits(bits);
            if seconds > self.known[patch as usize] {
                continue;
            }
            for (to, way, length) in graph.ways.of(patch as usize) {
                let walks = if way.walks {
                    length / walks
                } else {
                    f64::INFINITY
                };
                let climbs = if way.climbs {
                    length / climbs
                } else {
                    f64::INFINITY
                };
                self.offer(to as u32, seconds + walks.min(climbs));
            }
        }
    }

    fn offer(&mut self, patch: u32, seconds: f64) {
        let known = &mut self.known[patch as usize];
        // False for infinity and NaN.
        let is_near = seconds <= self.most;
        if is_near && seconds < *known {
            if known.is_infinite() {
                self.reached.push(patch);
            }
            *known = seconds;
            self.open.push(Reverse((seconds.to_bits(), patch)));
        }
    }

    /// Seconds from the patches of the last [`Beside::look`] to another one. If it was not reached, twice that search's
    /// limit.
    fn seconds(&self, to: u32) -> f64 {
        self.known[to as usize].min(2.0 * self.most)
    }
}
