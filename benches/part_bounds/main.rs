//! Measures the cost and the tightness of bounds of each joint's part, computed in each tick.
//!
//! Spheres and capsules are made in three ways: precomputed over all clips, refitted to skinned vertices, and derived
//! from the palette alone. Criterion measures each method. Then the bench prints a table and writes it to
//! `target/measure/part_bounds.csv`. It fails if a vertex lies outside a refitted or derived bound.
//!
//! Run it with `cargo bench -p clamber_benches --bench part_bounds`; briefly with `-- --test`. If `CLAMBER_TEST_DATA`
//! is set, it also measures five third-party models.

mod method;
mod poses;
mod precomputed;
mod report;

use std::error::Error;
use std::process::ExitCode;
use std::time::Duration;

use clamber_scenes::giant::{giant, giant_of};
use clamber_scenes::measure::{is_brief, measure_folder};
use clamber_scenes::{Creature, beast::beast, test_data};
use criterion::Criterion;
use method::{METHODS, Workspace};
use poses::Subject;
use report::Report;

/// Sizes and times of a run of the bench.
struct Effort {
    brief: bool,
    /// Numbers of vertices of the beasts.
    beasts: &'static [usize],
    /// Numbers of vertices of the giants besides the one from the file.
    giants: &'static [usize],
    /// Number of poses of each clip from which bounds are precomputed.
    samples: u32,
    /// Time budget for the median of one method on one creature.
    budget: Duration,
}

/// The full run.
const FULL: Effort = Effort {
    brief: false,
    beasts: &[1_000, 6_000],
    giants: &[25_000, 100_000],
    samples: 16,
    budget: Duration::from_millis(300),
};

/// The brief run: with `-- --test`, and outside `cargo bench`.
const BRIEF: Effort = Effort {
    brief: true,
    beasts: &[1_000],
    giants: &[],
    samples: 8,
    budget: Duration::ZERO,
};

fn main() -> ExitCode {
    let effort = if is_brief() { BRIEF } else { FULL };
    match run(&effort) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(escapes) => {
            eprintln!("{escapes} vertices lie outside bounds that must hold them");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Measures all creatures; returns the number of vertices outside refitted and derived bounds.
fn run(effort: &Effort) -> Result<usize, Box<dyn Error>> {
    let mut report = Report::default();
    let mut criterion = Criterion::default()
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(800))
        .sample_size(20)
        .configure_from_args();
    for creature in creatures(effort)? {
        let subject = Subject::new(creature, effort.samples)?;
        report.add(&subject, effort.budget)?;
        measure(&mut criterion, &subject)?;
    }
    criterion.final_summary();
    println!("\n{}", report.table);
    let name = if effort.brief {
        "part_bounds_brief.csv"
    } else {
        "part_bounds.csv"
    };
    let path = measure_folder().join(name);
    report.table.write_csv(&path)?;
    println!("written to {}", path.display());
    Ok(report.escapes)
}

fn creatures(effort: &Effort) -> Result<Vec<Creature>, Box<dyn Error>> {
    let mut creatures: Vec<Creature> = effort.beasts.iter().map(|n| beast(*n)).collect();
    creatures.push(giant()?);
    for vertices in effort.giants {
        creatures.push(giant_of(*vertices)?);
    }
    creatures.extend(test_data::five_creatures("bounds of five models")?);
    Ok(creatures)
}

/// Lets criterion measure one tick of each method, which goes through the poses in turn.
fn measure(criterion: &mut Criterion, subject: &Subject) -> Result<(), Box<dyn Error>> {
    let mut group = criterion.benchmark_group(subject.label());
    let mut workspace = Workspace::new(subject);
    let poses = subject.between()?;
    for method in METHODS {
        let mut turn = poses.iter().cycle();
        group.bench_function(method.to_string(), |bencher| {
            bencher.iter(|| {
                if let Some(palette) = turn.next() {
                    method.bound(subject, palette, &mut workspace);
                }
            });
        });
    }
    group.finish();
    Ok(())
}
