//! Measures the cost of giants and skin that no query touches.
//!
//! Valleys have 1, 10 and 100 walking giants of 10,000 vertices, each in its own phase of the walk, and 0 to 1,000
//! climbers on up to three of them. The climbers stand or walk, with the valley and all giants as obstacles. The bench
//! measures:
//!
//! - a tick, the same tick with everything skinned, and the share of the skin that a tick touches;
//! - a hundred giants with riders on one of them, compared with that giant alone;
//! - a thousand riders on two cores, compared with one core.
//!
//! The variants take turns, tick by tick, in one process. Times are medians.
//!
//! For two cores the table also has the fastest tenths of ticks. If the host shares its cores with other machines, a
//! tick on both cores waits for the slower one, and its median depends on the host. The best possible ratio is
//! therefore measured too: two scenes that share no written data, run one after the other and at once.
//!
//! Prints a table and writes it to `target/measure/scene.csv`: name, value, bound, holds. Fails if the riders' states
//! differ when everything is skinned, or on two cores.
//!
//! Run it with `cargo bench -p clamber_benches --bench scene`; briefly with `-- --test`.

mod herd;
mod riders;

use std::error::Error;
use std::ops::Range;
use std::process::ExitCode;
use std::time::Instant;

use clamber::world::rapier3d::prelude::PhysicsWorld;
use clamber::world::{BodyPoses, Obstacle, ObstacleId, RapierTerrain};
use clamber_scenes::giant::giant_of;
use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief, quantile};
use clamber_scenes::{Creature, valley};
use herd::Herd;
use riders::Riders;

/// The largest number of giants that have riders.
const FEW: usize = 3;

/// Distance between giants, metres.
const APART: f64 = 31.0;

/// Number of ticks at the start that are not timed: climbers land in them.
const SETTLE: usize = 20;

struct Effort {
    brief: bool,
    vertices: usize,
    giants: &'static [usize],
    riders: &'static [usize],
    ticks: usize,
}

/// The full run.
const FULL: Effort = Effort {
    brief: false,
    vertices: 10_000,
    giants: &[1, 10, 100],
    riders: &[0, 1, 100, 1_000],
    ticks: 120,
};

/// The brief run: with `-- --test`, and outside `cargo bench`.
const BRIEF: Effort = Effort {
    brief: true,
    vertices: 2_000,
    giants: &[1, 4],
    riders: &[0, 5],
    ticks: 3,
};

fn main() -> ExitCode {
    exit_code(run(if is_brief() { &BRIEF } else { &FULL }))
}

fn run(effort: &Effort) -> Result<(), Box<dyn Error>> {
    let mut cells = Cells::default();
    let creature = giant_of(effort.vertices)?;
    let world = valley::world();
    for &giants in effort.giants {
        for &riders in effort.riders {
            valley_of(&creature, &world, giants, riders, effort.ticks, &mut cells)?;
        }
    }
    let most = effort.giants.iter().copied().max().unwrap_or(1);
    for &riders in effort.riders.iter().filter(|riders| **riders > 0) {
        on_one(&creature, &world, most, riders, effort.ticks, &mut cells)?;
    }
    let riders = effort.riders.iter().copied().max().unwrap_or(1);
    on_two_cores(&creature, &world, most, riders, effort.ticks, &mut cells)?;
    cells.finish("scene", effort.brief)
}

/// The obstacles: the valley, then the giants.
fn obstacles<'a>(
    terrain: &'a RapierTerrain<'a>,
    herd: &'a Herd,
) -> Vec<(ObstacleId, &'a (dyn Obstacle + Sync))> {
    let ground = (ObstacleId(0), terrain as &(dyn Obstacle + Sync));
    let giants = herd.giants.iter().enumerate().map(|(index, giant)| {
        let id = ObstacleId(index as u64 + 1);
        (id, &giant.surface as &(dyn Obstacle + Sync))
    });
    std::iter::once(ground).chain(giants).collect()
}

/// Which vertices a tick skins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Skinning {
    /// Only the vertices that queries touch.
    Lazy,
    /// All vertices.
    Everything,
}

/// A herd and its riders, with the times of their ticks.
struct Scene<'a> {
    herd: Herd,
    skinning: Skinning,
    riders: Riders,
    world: &'a PhysicsWorld,
    /// Microseconds of each tick: poses of the `first` giants, poses of the other giants, and the riders.
    times: [Vec<f64>; 3],
}

impl<'a> Scene<'a> {
    fn new(
        creature: &Creature,
        world: &'a PhysicsWorld,
        giants: usize,
        riders: usize,
        mounts: usize,
        skinning: Skinning,
    ) -> Result<Self, Box<dyn Error>> {
        let row = (giants as f64).sqrt().ceil() as usize;
        let herd = Herd::new(creature, giants, row, APART)?;
        Ok(Self {
            skinning,
            riders: Riders::new(&herd, riders, mounts)?,
            herd,
            world,
            times: Default::default(),
        })
    }

    fn pose(&mut self, tick: usize, awake: Range<usize>) -> Result<(), Box<dyn Error>> {
        for giant in awake {
            self.herd.pose(tick, giant..giant + 1)?;
            if self.skinning == Skinning::Everything {
                self.herd.giants[giant].surface.skin_ahead();
            }
        }
        Ok(())
    }

    /// Runs one tick with the first `awake` giants posed. The poses of the `first` ones are timed separately.
    fn tick(&mut self, tick: usize, first: usize, awake: usize) -> Result<(), Box<dyn Error>> {
        self.riders.sit(&self.herd)?;
        let before = BodyPoses::default();
        let world = self.world;
        let terrain = RapierTerrain::of_world(world, &before);
        let start = Instant::now();
        self.pose(tick, 0..first)?;
        let ridden = micros(start);
        let start = Instant::now();
        self.pose(tick, first..awake)?;
        let others = micros(start);
        let start = Instant::now();
        let all = obstacles(&terrain, &self.herd);
        let all: Vec<(ObstacleId, &dyn Obstacle)> = all
            .iter()
            .map(|(id, one)| (*id, *one as &dyn Obstacle))
            .collect();
        self.riders.step(&all)?;
        let riders = micros(start);
        if tick >= SETTLE {
            for (times, us) in self.times.iter_mut().zip([ridden, others, riders]) {
                times.push(us);
            }
        }
        Ok(())
    }

    /// The median time of whole ticks, microseconds.
    fn whole(&self) -> f64 {
        let [ridden, others, riders] = &self.times;
        let whole = ridden.iter().zip(others).zip(riders);
        quantile(
            &mut whole.map(|((a, b), c)| a + b + c).collect::<Vec<_>>(),
            0.5,
        )
    }

    /// The median time of one part of a tick, microseconds; `part` is an index of `times`.
    fn part(&self, part: usize) -> f64 {
        quantile(&mut self.times[part].clone(), 0.5)
    }
}

fn valley_of(
    creature: &Creature,
    world: &PhysicsWorld,
    giants: usize,
    riders: usize,
    ticks: usize,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let mounts = giants.min(FEW);
    let scene = |skinning| Scene::new(creature, world, giants, riders, mounts, skinning);
    let (mut lazy, mut eager) = (scene(Skinning::Lazy)?, scene(Skinning::Everything)?);
    for tick in 0..SETTLE + ticks {
        lazy.tick(tick, mounts, giants)?;
        eager.tick(tick, mounts, giants)?;
        same(&lazy.riders, &eager.riders, tick)?;
    }
    let mut rows = cells.of(format!("{giants} giants, {riders} riders"));
    rows.value("poses, us", lazy.part(0) + lazy.part(1));
    rows.value("riders, us", lazy.part(2));
    let (whole, all) = (lazy.whole(), eager.whole());
    rows.value("a tick, us", whole);
    rows.value("everything skinned, us", all);
    rows.value("everything skinned / a tick", all / whole);
    let touched = lazy
        .herd
        .giants
        .iter()
        .map(|giant| giant.surface.diagnostics());
    let touched: Vec<_> = touched.collect();
    let share = |part: usize, of: usize| 100.0 * part as f64 / of as f64;
    let sum = |count: fn(&clamber::surface::Diagnostics) -> usize| touched.iter().map(count).sum();
    let skinned = share(sum(|d| d.vertices_skinned), sum(|d| d.vertices));
    rows.value("vertices skinned, %", skinned);
    rows.value("clusters touched", sum(|d| d.clusters_touched) as f64);
    rows.value("bounds evaluated", sum(|d| d.bounds_evaluated) as f64);
    if riders > 0 {
        rows.value("riders that stand, %", 100.0 * lazy.riders.standing());
    }
    Ok(())
}

/// Measures riders on one of many giants, compared with the same riders on that giant alone.
fn on_one(
    creature: &Creature,
    world: &PhysicsWorld,
    giants: usize,
    riders: usize,
    ticks: usize,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let scene = |giants| Scene::new(creature, world, giants, riders, 1, Skinning::Lazy);
    let (mut many, mut asleep, mut alone) = (scene(giants)?, scene(giants)?, scene(giants)?);
    // The giant keeps its place among the others, which are removed and therefore no obstacles.
    alone.herd.giants.truncate(1);
    for tick in 0..SETTLE + ticks {
        many.tick(tick, 1, giants)?;
        asleep.tick(tick, 1, 1)?;
        alone.tick(tick, 1, 1)?;
    }
    let mut rows = cells.of(format!("{riders} riders on one of {giants} giants"));
    let (whole, one, others) = (many.whole(), alone.whole(), many.part(1));
    rows.value("a tick, us", whole);
    rows.value("poses of the others, us", others);
    rows.value("that one alone, us", one);
    let (all, most) = (one + others, Bound::Most(1.3));
    rows.push(
        "a tick / one alone and the others' poses",
        whole / all,
        most,
    );
    rows.push("the others asleep / one alone", asleep.whole() / one, most);
    Ok(())
}

/// Measures riders on all giants, on rayon's threads, with one core and with two. Also measures the best possible gain
/// of this machine's second core: two such scenes that share no written data, run at once and one after the other.
fn on_two_cores(
    creature: &Creature,
    world: &PhysicsWorld,
    giants: usize,
    riders: usize,
    ticks: usize,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let threads = |count| rayon::ThreadPoolBuilder::new().num_threads(count).build();
    let pools = [threads(1)?, threads(2)?];
    let alone = [threads(1)?, threads(1)?];
    let scene = || Scene::new(creature, world, giants, riders, giants, Skinning::Lazy);
    let mut scenes = [scene()?, scene()?];
    let mut apart = [scene()?, scene()?];
    let (mut in_turn, mut at_once) = (Vec::new(), Vec::new());
    for tick in 0..SETTLE + ticks {
        for (scene, pool) in scenes.iter_mut().zip(&pools) {
            let us = in_parallel(scene, tick, pool)?;
            if tick >= SETTLE {
                scene.times[0].push(us);
            }
        }
        let [one, two] = &scenes;
        same(&one.riders, &two.riders, tick)?;
        // Even ticks run one scene after the other, odd ticks run both at once.
        let us = both(&mut apart, tick, &alone, tick % 2 == 0)?;
        if tick >= SETTLE {
            if tick % 2 == 0 {
                &mut in_turn
            } else {
                &mut at_once
            }
            .push(us);
        }
    }
    let [mut one, mut two] = scenes.map(|scene| scene.times[0].clone());
    for (which, share) in [("medians", 0.5), ("fastest tenths", 0.1)] {
        let mut rows = cells.of(format!("{riders} riders on {giants} giants, {which}"));
        let (one, two) = (quantile(&mut one, share), quantile(&mut two, share));
        rows.value("a tick on one core, us", one);
        rows.value("a tick on two cores, us", two);
        let bound = if share < 0.5 {
            Bound::Least(1.7)
        } else {
            Bound::None
        };
        rows.push("one core / two", one / two, bound);
        let best = quantile(&mut in_turn, share) / quantile(&mut at_once, share);
        rows.value("two scenes in turn / at once", best);
    }
    Ok(())
}

/// Runs a tick of both scenes, each on its own pool. Returns microseconds: the sum of the two times if they run in
/// turn, the longer one if they run at once.
fn both(
    scenes: &mut [Scene<'_>; 2],
    tick: usize,
    pools: &[rayon::ThreadPool; 2],
    in_turn: bool,
) -> Result<f64, Box<dyn Error>> {
    let [first, second] = scenes;
    if in_turn {
        return Ok(in_parallel(first, tick, &pools[0])? + in_parallel(second, tick, &pools[1])?);
    }
    let times = std::thread::scope(|scope| {
        let text = |error: Box<dyn Error>| error.to_string();
        let other = scope.spawn(move || in_parallel(second, tick, &pools[1]).map_err(text));
        let one = in_parallel(first, tick, &pools[0]).map_err(text);
        let other = other.join().map_err(|_| "a thread panicked".to_owned());
        Ok::<_, String>([one?, other??])
    });
    Ok(times?.into_iter().fold(0.0, f64::max))
}

/// Runs a tick on the threads of a pool; returns the microseconds.
fn in_parallel(
    scene: &mut Scene<'_>,
    tick: usize,
    pool: &rayon::ThreadPool,
) -> Result<f64, Box<dyn Error>> {
    scene.riders.sit(&scene.herd)?;
    let before = BodyPoses::default();
    let terrain = RapierTerrain::of_world(scene.world, &before);
    let timed = pool.install(|| {
        let start = Instant::now();
        let mut tick = || -> Result<(), Box<dyn Error>> {
            scene.herd.pose_in_parallel(tick)?;
            let all = obstacles(&terrain, &scene.herd);
            scene.riders.step_in_parallel(&all)
        };
        tick().map_err(|error| error.to_string())?;
        Ok::<_, String>(micros(start))
    });
    Ok(timed?)
}

/// Fails if the riders' states differ.
fn same(one: &Riders, other: &Riders, tick: usize) -> Result<(), Box<dyn Error>> {
    if one.states() == other.states() {
        Ok(())
    } else {
        Err(format!("tick {tick}: the riders' states differ").into())
    }
}

fn micros(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e6
}
