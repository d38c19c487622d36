//! Times the ticks of all peers in turn, so that all see the machine in the same state.

use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use clamber_peers::{Answer, Entry, Kind, Peer, taken_from_heap};
use clamber_scenes::measure::quantile;
use clamber_scenes::riders::{Rider, Tick};
use clamber_surface::geometry::Sphere;
use clamber_surface::mesh::ColliderMesh;
use glam::{DVec3, Vec3};

/// A peer that takes part in a race.
pub(crate) struct Entrant {
    pub(crate) name: &'static str,
    pub(crate) bytes: usize,
    peer: Box<dyn Peer>,
}

impl Entrant {
    pub(crate) fn new(entry: Entry, mesh: &Arc<ColliderMesh>) -> Result<Self, Box<dyn Error>> {
        let (peer, from_heap) = taken_from_heap(|| (entry.make)(mesh));
        let peer = peer?;
        Ok(Self {
            name: entry.name,
            bytes: peer.bytes(from_heap),
            peer,
        })
    }
}

/// An entrant's median times, microseconds.
pub(crate) struct Lap {
    pub(crate) update: f64,
    /// Time of one query, by kind; `None` if the peer has no such query.
    pub(crate) queries: [Option<f64>; 4],
    /// Times of whole ticks; `None` if the peer lacks one of a tick's queries.
    pub(crate) tick: Option<Whole>,
}

/// Times of whole ticks, microseconds.
pub(crate) struct Whole {
    pub(crate) median: f64,
    pub(crate) quartiles: [f64; 2],
    /// Mean number of hits in a tick.
    pub(crate) hits: f64,
}

/// Times of one entrant.
#[derive(Default)]
struct Times {
    update: Vec<f64>,
    tick: Vec<f64>,
    queries: [Vec<f64>; 4],
    hits: usize,
}

/// Times all entrants on at least `least` ticks, and on as many as fit into `budget`.
pub(crate) fn race(
    entrants: &mut [Entrant],
    ticks: &[Tick],
    least: usize,
    budget: Duration,
) -> Result<Vec<Lap>, Box<dyn Error>> {
    let mut times: Vec<Times> = entrants.iter().map(|_| Times::default()).collect();
    let begin = Instant::now();
    let mut run = 0;
    for tick in ticks {
        if run >= least && begin.elapsed() > budget {
            break;
        }
        run += 1;
        for (entrant, times) in entrants.iter_mut().zip(&mut times) {
            whole(entrant.peer.as_mut(), tick, times)?;
            for ((kind, _), times) in Kind::ALL.iter().zip(&mut times.queries) {
                alone(entrant.peer.as_mut(), tick, *kind, times)?;
            }
        }
    }
    let lap = |times: &mut Times| Lap {
        update: quantile(&mut times.update, 0.5),
        queries: times
            .queries
            .each_mut()
            .map(|times| (!times.is_empty()).then(|| quantile(times, 0.5))),
        tick: (!times.tick.is_empty()).then(|| Whole {
            median: quantile(&mut times.tick, 0.5),
            quartiles: [0.25, 0.75].map(|part| quantile(&mut times.tick, part)),
            hits: times.hits as f64 / run as f64,
        }),
    };
    Ok(times.iter_mut().map(lap).collect())
}

/// Times a whole tick, as in a game: the update and all riders' queries.
fn whole(peer: &mut dyn Peer, tick: &Tick, times: &mut Times) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    peer.update(&tick.palette, DVec3::ZERO)?;
    times.update.push(micros(start));
    for rider in &tick.riders {
        for sphere in [&rider.body, &rider.foot] {
            let Ok(hits) = peer.overlap_sphere(sphere) else {
                return Ok(());
            };
            times.hits += hits;
        }
        let Ok(hit) = peer.cast_ray(&rider.ray, rider.reach) else {
            return Ok(());
        };
        times.hits += usize::from(hit.is_some());
        let (_, motion) = peer.motion(rider.anchor.triangle, rider.anchor.barycentric);
        times.hits += usize::from(motion.is_finite());
    }
    times.tick.push(micros(start));
    Ok(())
}

/// Times one kind of query for all riders, as the first queries of a tick.
fn alone(
    peer: &mut dyn Peer,
    tick: &Tick,
    kind: Kind,
    times: &mut Vec<f64>,
) -> Result<(), Box<dyn Error>> {
    if ask(peer, kind, &tick.riders[0]).is_err() {
        return Ok(());
    }
    peer.update(&tick.palette, DVec3::ZERO)?;
    let start = Instant::now();
    for rider in &tick.riders {
        let _ = black_box(ask(peer, kind, rider));
    }
    times.push(micros(start) / tick.riders.len() as f64);
    Ok(())
}

fn ask(peer: &mut dyn Peer, kind: Kind, rider: &Rider) -> Answer<usize> {
    let body = &rider.body;
    match kind {
        Kind::Ray => peer
            .cast_ray(&rider.ray, rider.reach)
            .map(|hit| usize::from(hit.is_some())),
        Kind::Overlap => peer.overlap_sphere(body),
        Kind::Closest => {
            let found = peer.closest_point(body.center, rider.reach);
            found.map(|found| usize::from(found.is_some()))
        }
        Kind::Cast => {
            let (from, motion) = fall(rider);
            let found = peer.cast_sphere(&from, motion);
            found.map(|found| usize::from(found.is_some()))
        }
    }
}

/// A sphere cast for a rider: the body starts three radii above its place, and moves down to one radius below it.
fn fall(rider: &Rider) -> (Sphere, Vec3) {
    let (radius, down) = (rider.body.radius, rider.ray.direction());
    let from = Sphere {
        center: rider.body.center - down * (3.0 * radius),
        radius,
    };
    (from, down * (4.0 * radius))
}

fn micros(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e6
}
