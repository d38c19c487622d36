//! What does a tick on an animated skin cost? The bench compares clamber with other methods.
//!
//! A giant of 3,000 to 500,000 vertices walks. Each of 1 to 1,000 riders on its skin makes two overlaps, casts a ray,
//! and reads the motion of its footing. A whole tick includes skinning and refitting. Each kind of query, and closest
//! points and sphere casts, are also timed alone, as the first queries of a tick. All methods answer the same ticks in
//! turn, in one process, on one thread, so that each finds the caches full of the others' data. Times are medians;
//! whole ticks also have quartiles. Prints a table and writes it to `target/measure/peers.csv`, with plots beside it.
//! Fails if clamber's numbers of hits differ between lazy and eager skinning.
//!
//! Run it with `cargo bench --manifest-path peers/Cargo.toml --bench peers`, and `--features bullet,embree,fcl,physx`
//! for the installed libraries; briefly with `-- --test`.

mod race;
mod report;

use std::error::Error;
use std::process::ExitCode;
use std::time::Duration;

use clamber_scenes::giant::giant_of;
use clamber_scenes::measure::{exit_code, is_brief};
use clamber_scenes::riders::Workload;
use race::{Entrant, race};
use report::Report;

/// Sizes and times of a run.
struct Effort {
    vertices: &'static [usize],
    riders: &'static [usize],
    /// Number of ticks of the walk. If they take longer than `each`, fewer are run, but at least `least_ticks`.
    ticks: usize,
    least_ticks: usize,
    each: Duration,
}

/// The usual run.
const FULL: Effort = Effort {
    vertices: &[3_000, 30_000, 100_000, 500_000],
    riders: &[1, 10, 100, 1_000],
    ticks: 40,
    least_ticks: 3,
    each: Duration::from_secs(20),
};

/// A brief run, for `-- --test`.
const BRIEF: Effort = Effort {
    vertices: &[2_000],
    riders: &[1, 10],
    ticks: 2,
    least_ticks: 2,
    each: Duration::from_secs(1),
};

fn main() -> ExitCode {
    let brief = is_brief();
    exit_code(run(if brief { &BRIEF } else { &FULL }, brief))
}

fn run(effort: &Effort, brief: bool) -> Result<(), Box<dyn Error>> {
    let mut report = Report::default();
    for &vertices in effort.vertices {
        let creature = giant_of(vertices)?;
        let entrants = clamber_peers::all().into_iter();
        let entrants = entrants.map(|entry| Entrant::new(entry, &creature.rig.collider));
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
            report.add(&creature.rig.collider, riders, &entrants, laps)?;
        }
    }
    report.finish(brief)
}
