//! Measures a whole tick with clamber lazily, clamber eagerly, and parry's refitted mesh.
//!
//! A giant of 3,000 to 500,000 vertices walks. Each rider on its skin asks for two overlaps, a ray and an anchor's
//! motion. All contenders answer the same ticks in turn, on one thread. Prints a table and writes it to
//! `target/measure/tick.csv`: name, value, bound, holds. Fails if clamber's number of hits differs between lazy and
//! eager.
//!
//! Run it with `cargo bench -p clamber_benches --bench tick`; briefly with `-- --test`.

mod contender;
mod kernel;
mod timing;

use std::error::Error;
use std::process::ExitCode;
use std::time::Duration;

use clamber::geometry::{Capsule, Ray};
use clamber::prelude::*;
use clamber_scenes::giant::giant_of;
use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief, median_us};
use clamber_scenes::riders::Workload;
use contender::{Contender, Eager, Lazy, Parry};
use glam::Vec3;
use timing::{Caches, Lap, Stream, race};

/// Sizes of a run of the bench.
struct Effort {
    brief: bool,
    small: usize,
    middle: usize,
    large: usize,
    ticks: usize,
    riders: usize,
}

/// The full run.
const FULL: Effort = Effort {
    brief: false,
    small: 3_000,
    middle: 30_000,
    large: 500_000,
    ticks: 40,
    riders: 100,
};

/// The brief run: with `-- --test`, and outside `cargo bench`.
const BRIEF: Effort = Effort {
    brief: true,
    small: 2_000,
    middle: 3_000,
    large: 6_000,
    ticks: 3,
    riders: 10,
};

fn main() -> ExitCode {
    let effort = if is_brief() { BRIEF } else { FULL };
    exit_code(run(&effort))
}

fn run(effort: &Effort) -> Result<(), Box<dyn Error>> {
    let mut cells = Cells::default();
    let mut stream = Stream::default();
    let mut lazy_warm = Vec::new();
    for vertices in [effort.small, effort.middle, effort.large] {
        let creature = giant_of(vertices)?;
        let label = format!("{}k vertices", vertices / 1000);
        let workload = Workload::new(&creature, 1, effort.ticks)?;
        let mut field = Field::new(&workload)?;
        for caches in [Caches::Cold, Caches::Warm] {
            let laps = field.race(&workload, caches, &mut stream)?;
            let name = format!("one rider, {label}, {caches:?}");
            laps_of(&mut cells, &name, &laps);
            if caches == Caches::Warm {
                lazy_warm.push(laps[0].median_us);
            }
            let (eager, parry) = (laps[1].over(&laps[0]), laps[2].over(&laps[0]));
            let bounds = if vertices == effort.large {
                [Bound::Least(40.0), Bound::Least(500.0)]
            } else if vertices == effort.small {
                [Bound::Least(1.5), Bound::Least(8.0)]
            } else {
                [Bound::None; 2]
            };
            let mut rows = cells.of(name);
            rows.push("eager / lazy", eager, bounds[0]);
            rows.push("parry / lazy", parry, bounds[1]);
        }
        if vertices == effort.large {
            many_riders(effort, &creature, &mut field, &mut stream, &mut cells)?;
            everything(&creature, effort.ticks, &mut stream, &mut cells)?;
            nothing_near(&workload, &mut cells)?;
            memory(&field, &mut cells);
        }
    }
    let growth = lazy_warm[2] / lazy_warm[0];
    cells.push(
        "growth of the lazy tick, small to large, warm",
        growth,
        Bound::Most(2.5),
    );
    kernel::measure(effort.brief, &mut cells)?;
    cells.finish("tick", effort.brief)
}

/// All contenders with their own data.
struct Field {
    lazy: Lazy,
    eager: Eager,
    parry: Parry,
}

impl Field {
    fn new(workload: &Workload) -> Result<Self, Box<dyn Error>> {
        Ok(Self {
            lazy: Lazy::new(&workload.mesh),
            eager: Eager(Lazy::new(&workload.mesh)),
            parry: Parry::new(&workload.mesh)?,
        })
    }

    /// Races clamber lazily, clamber eagerly and parry; returns their laps in this order.
    fn race(
        &mut self,
        workload: &Workload,
        caches: Caches,
        stream: &mut Stream,
    ) -> Result<Vec<Lap>, Box<dyn Error>> {
        let mut contenders: [&mut dyn Contender; 3] =
            [&mut self.lazy, &mut self.eager, &mut self.parry];
        let laps = race(&mut contenders, &workload.ticks, caches, stream);
        if laps[0].hits != laps[1].hits {
            return Err(format!("{} lazy hits, {} eager", laps[0].hits, laps[1].hits).into());
        }
        Ok(laps)
    }
}

fn many_riders(
    effort: &Effort,
    creature: &clamber_scenes::Creature,
    field: &mut Field,
    stream: &mut Stream,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let workload = Workload::new(creature, effort.riders, effort.ticks / 2 + 1)?;
    for caches in [Caches::Cold, Caches::Warm] {
        let laps = field.race(&workload, caches, stream)?;
        let name = format!("{} riders, {caches:?}", effort.riders);
        laps_of(cells, &name, &laps);
        let (eager, parry) = (laps[1].over(&laps[0]), laps[2].over(&laps[0]));
        let mut rows = cells.of(name);
        rows.push("eager / lazy", eager, Bound::Least(1.0));
        rows.push("parry / lazy", parry, Bound::Least(15.0));
    }
    Ok(())
}

/// Measures with so many riders that they touch almost every cluster.
fn everything(
    creature: &clamber_scenes::Creature,
    ticks: usize,
    stream: &mut Stream,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let riders = creature.rig.collider.triangles().len() / 20;
    let workload = Workload::new(creature, riders, ticks / 8 + 2)?;
    let (mut lazy, mut eager) = (Lazy::new(&workload.mesh), Eager(Lazy::new(&workload.mesh)));
    let mut contenders: [&mut dyn Contender; 2] = [&mut lazy, &mut eager];
    let laps = race(&mut contenders, &workload.ticks, Caches::Cold, stream);
    let touched = lazy.surface.diagnostics();
    let share = touched.clusters_touched as f64 / touched.clusters as f64;
    cells.value("everything touched: share of clusters", share);
    laps_of(cells, "everything touched", &laps);
    let ratio = laps[0].over(&laps[1]);
    cells.push("everything touched: lazy / eager", ratio, Bound::Most(1.15));
    Ok(())
}

/// Measures queries far from the skin.
fn nothing_near(workload: &Workload, cells: &mut Cells) -> Result<(), Box<dyn Error>> {
    let mut surface = SkinnedSurface::new(workload.mesh.clone());
    surface.advance(&workload.ticks[0].palette, Similarity::IDENTITY)?;
    let place = Vec3::splat(100.0 * workload.mesh.radius());
    let ball = Capsule::ball(place, 1.0).ok_or("no ball")?;
    let ray = Ray::new(place, Vec3::X).ok_or("no direction")?;
    let mut hits = Vec::new();
    /// Number of repetitions in a sample: one repetition is too short to time.
    const TIMES: u32 = 1_000;
    let far = median_us(Duration::from_millis(50), || {
        for _ in 0..TIMES {
            let space = std::hint::black_box(&surface).in_model();
            space.overlap_capsule(&ball, &mut hits);
            assert!(hits.is_empty() && space.cast_ray(&ray, 5.0).is_none());
        }
    });
    cells.push(
        "nothing near: overlap and ray, beyond advance, us",
        far / f64::from(TIMES),
        Bound::Most(1.0),
    );
    let mut turn = workload.ticks.iter().cycle();
    let advance = median_us(Duration::from_millis(50), || {
        if let Some(tick) = turn.next() {
            assert!(surface.advance(&tick.palette, Similarity::IDENTITY).is_ok());
        }
    });
    cells.value("advance, us", advance);
    Ok(())
}

/// Adds the median of each contender of a race, and prints the quartiles.
fn laps_of(cells: &mut Cells, name: &str, laps: &[Lap]) {
    for (lap, who) in laps.iter().zip(["lazy", "eager", "parry"]) {
        let [low, high] = lap.quartiles_us;
        println!(
            "{name}: {who}: quartiles {low:.1} to {high:.1} us, {} hits",
            lap.hits
        );
        cells.value(&format!("{name}: {who}, us"), lap.median_us);
    }
}

fn memory(field: &Field, cells: &mut Cells) {
    let ours = field.lazy.surface.memory() as f64;
    let theirs = field.parry.shape.total_memory_size() as f64;
    cells.value("memory of ours, MB", ours / 1e6);
    cells.value("memory of parry's, MB", theirs / 1e6);
    cells.push("memory: ours / parry's", ours / theirs, Bound::Most(0.7));
}
