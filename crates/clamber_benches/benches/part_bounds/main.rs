//! What does it cost to bound each joint's part each tick, and how tight is it?
//!
//! Spheres and capsules, got in three ways: precomputed over all clips, refitted to skinned
//! vertices, derived from the palette alone. Prints a table and writes it to
//! `target/measure/part_bounds.csv`, then lets criterion measure each way. Fails if a vertex lies
//! outside a refitted or derived bound.
//!
//! `cargo bench -p clamber_benches --bench part_bounds`; brief with `-- --test`. With `CLAMBER_TEST_DATA` also on five
//! third-party models.

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

/// How long the bench may take.
struct Effort {
    brief: bool,
    /// Vertices of the beasts.
    beasts: &'static [usize],
    /// Vertices of giants beside the one from the file.
    giants: &'static [usize],
    /// Poses of each clip that precomputed bounds are made from.
    samples: u32,
    /// For the median of one method on one creature.
    budget: Duration,
}

const FULL: Effort = Effort {
    brief: false,
    beasts: &[1_000, 6_000],
    giants: &[25_000, 100_000],
    samples: 16,
    budget: Duration::from_millis(300),
};

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

/// Gives how many vertices lay outside refitted and derived bounds.
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

/// Criterion's part: one tick of each method, over the poses in turn.
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
