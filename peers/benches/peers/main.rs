//! What does a tick on an animated skin cost, ours and other ways side by side?
//!
//! A giant of 3,000 to 500,000 vertices walks; 1 to 1,000 riders on its skin each ask for two overlaps, a ray and how
//! their footing moves: a whole tick, with skinning and refitting. Closest points and sphere casts are timed by
//! themselves, as are the kinds of a tick's queries, each the first of its tick. All ways answer the same ticks in turn,
//! in one process, on one thread, so that each finds its caches full of the others' data. Times are medians, and of whole
//! ticks quartiles too. Prints a table and writes it to `target/measure/peers.csv`, with plots beside it. Fails if ours
//! differs between lazy and eager.
//!
//! `cargo bench --manifest-path peers/Cargo.toml --bench peers`, with `--features bullet,embree,fcl,physx` for those that are installed;
//! brief with `-- --test`.

mod race;
mod report;

use std::error::Error;
use std::process::ExitCode;
use std::time::Duration;

use clamber_scenes::giant::giant_of;
use clamber_scenes::measure::is_brief;
use clamber_scenes::riders::Workload;
use race::{Entrant, race};
use report::Report;

/// How long the bench may take.
struct Effort {
    vertices: &'static [usize],
    riders: &'static [usize],
    /// Ticks of the walk; fewer are run where they would take longer than `each`.
    ticks: usize,
    least_ticks: usize,
    each: Duration,
}

const FULL: Effort = Effort {
    vertices: &[3_000, 30_000, 100_000, 500_000],
    riders: &[1, 10, 100, 1_000],
    ticks: 40,
    least_ticks: 3,
    each: Duration::from_secs(20),
};

const BRIEF: Effort = Effort {
    vertices: &[2_000],
    riders: &[1, 10],
    ticks: 2,
    least_ticks: 2,
    each: Duration::from_secs(1),
};

fn main() -> ExitCode {
    let brief = is_brief();
    match run(if brief { &BRIEF } else { &FULL }, brief) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(effort: &Effort, brief: bool) -> Result<(), Box<dyn Error>> {
    let mut report = Report::default();
    for &vertices in effort.vertices {
        let creature = giant_of(vertices)?;
        let entrants = clamber_peers::all().into_iter();
        let entrants = entrants.map(|entry| Entrant::new(entry, &creature.collider));
        let mut entrants: Vec<Entrant> = entrants.collect::<Result<_, _>>()?;
        for &riders in effort.riders {
            eprintln!("{vertices} vertices, {riders} riders ...");
            let workload = Workload::new(&creature, riders, effort.ticks)?;
            let laps = race(
                &mut entrants,
                &workload.ticks,
                effort.least_ticks,
                effort.each,
            )?;
            report.add(&creature.collider, riders, &entrants, laps)?;
        }
    }
    report.finish(brief)
}
