//! Which jumps are worth a try: those to where no short way leads.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, IVec3};

use super::{Aim, ClimbGraph, LONGEST};
use crate::NavigationError;
use crate::graph::Footing;

/// A jump to be tried.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tried {
    pub(super) ends: [u32; 2],
    /// Seconds that it saves.
    saves: f64,
    /// How far it goes, metres.
    apart: f64,
}

/// Of the patches in a cube with a side of so many radii, and those in another one, one jump is tried.
const CELL: f64 = 3.0;

/// A way that takes no longer than so many times the jump is short.
const SHORT: f64 = 3.0;

/// Jumps lead at most so many times as far down as they rise.
const DOWN: f64 = 2.0;

/// Whoever watches is told every so many cubes.
const TELLS: usize = 32;

/// A way through the air is looked along in so many straight pieces.
const PIECES: u32 = 6;

/// Jumps that may be worth it, those first that save most.
pub(super) fn tries(
    graph: &ClimbGraph,
    surface: &SkinnedSurface,
    tell: &mut dyn FnMut(usize, usize) -> Result<(), NavigationError>,
) -> Result<Vec<Tried>, NavigationError> {
    let climber = &graph.config.climber;
    let (ground, gravity) = (&climber.ground, climber.gravity.length());
    let rises = 0.5 * ground.jump_speed * ground.jump_speed / gravity;
    let deepest = DOWN * rises;
    let longest = (ground.jump_speed + libm::sqrt(2.0 * gravity * (rises + deepest))) / gravity;
    let seconds = longest.min(LONGEST);
    let range = ground.walk_speed * seconds;
    let side = CELL * graph.config.radius();
    if !(range > side && 2.0 * ground.jump_speed / gravity <= LONGEST) {
        return Ok(Vec::new());
    }
    let cell = |seat: DVec3| (seat / side).floor().as_ivec3().to_array();
    let mut cells: BTreeMap<[i32; 3], Vec<u32>> = BTreeMap::new();
    for (index, patch) in (0..).zip(&graph.patches) {
        // What lies below a plate is no way while it is there.
        if patch.below.is_none() {
            cells.entry(cell(patch.seat)).or_default().push(index);
        }
    }
    let far = (range / side).ceil().min(MOST_CELLS) as i32;
    let up = climber.up();
    let mut beside = Beside::new(graph);
    let mut tries = Vec::new();
    for (done, (at, here)) in cells.iter().enumerate() {
        if done.is_multiple_of(TELLS) {
            tell(done, cells.len())?;
        }
        let stands = |patch: &&u32| graph.patches[**patch as usize].can_stand;
        let stands: Vec<u32> = here.iter().filter(stands).copied().collect();
        if stands.is_empty() {
            continue;
        }
        beside.look(graph, &stands, SHORT * seconds);
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
                if way > SHORT * aim.seconds {
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

/// Jumps that go farther than so many cubes are not looked at.
const MOST_CELLS: f64 = 6.0;

fn cube(far: i32) -> impl Iterator<Item = IVec3> {
    let range = move || -far..=far;
    range().flat_map(move |x| range().flat_map(move |y| range().map(move |z| IVec3::new(x, y, z))))
}

/// True if no skin lies on the way through the air, and the jump comes to the outside of the skin at its end.
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
    (0..PIECES).all(|piece| {
        let [start, end] = [piece, piece + 1].map(|piece| at(f64::from(piece) / f64::from(PIECES)));
        let length = start.distance(end);
        !surface
            .in_world()
            .intersects_ray(start, end - start, length)
    })
}

/// How long it takes to come to patches from some others, without a jump.
pub(super) struct Beside {
    /// Of each patch that was reached, seconds.
    known: Vec<f64>,
    reached: Vec<u32>,
    open: BinaryHeap<Reverse<(u64, u32)>>,
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

    /// True if there is a short way from one patch to another: shorter than is worth a jump of so many seconds.
    pub(super) fn is_short(&mut self, graph: &ClimbGraph, [from, to]: [u32; 2], jump: f64) -> bool {
        self.look(graph, &[from], SHORT * jump);
        self.seconds(to) <= SHORT * jump
    }

    /// Looks how far it is from the nearest of some patches, up to so many seconds: Dijkstra's search (1959).
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
        // Neither infinite nor not a number.
        let is_near = seconds <= self.most;
        if is_near && seconds < *known {
            if known.is_infinite() {
                self.reached.push(patch);
            }
            *known = seconds;
            self.open.push(Reverse((seconds.to_bits(), patch)));
        }
    }

    /// From the patches that were looked at to another one; twice as long as was looked if it is farther.
    fn seconds(&self, to: u32) -> f64 {
        self.known[to as usize].min(2.0 * self.most)
    }
}
