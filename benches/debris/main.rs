//! Measures collisions of 200 rocks with a giant's skin, compared with the whole skin as one deformable mesh in rapier.
//!
//! Two worlds have the same rocks on the same shaking giant, and take turns. One world uses clamber's debris, which
//! adds pieces of skin near the rocks. The other has one kinematic body with all triangles, skinned by the same kernel
//! and updated each tick. A tick consists of posing the skin, adding it to rapier, rapier's step, and the work after
//! the step. A third world has the rocks without a giant. Its time is about the share of rapier's own step in the other
//! two, although its rocks lie elsewhere. It is subtracted from both for the ratio that has a bound.
//!
//! Prints a table and writes it to `target/measure/debris.csv`: name, value, bound, holds.
//!
//! Run it with `cargo bench -p clamber_benches --bench debris`; briefly with `-- --test`.

mod whole;

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use clamber_scenes::giant::{giant, giant_of};
use clamber_scenes::measure::{Bound, Cells, is_brief, quantile};
use clamber_scenes::rocks::{Rocks, TICK};

use whole::Whole;

/// Number of rocks in each world.
const ROCKS: usize = 200;

/// Number of ticks at the start that are not counted: the rocks fall on the giant.
const FALL: u32 = 200;

/// Number of counted ticks.
const COUNTED: u32 = 200;

fn main() -> ExitCode {
    let brief = is_brief();
    match run(brief) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let mut cells = Cells::default();
    let sizes: &[Option<usize>] = if brief {
        &[None]
    } else {
        &[None, Some(50_000), Some(200_000)]
    };
    for size in sizes {
        measure(*size, brief, &mut cells)?;
    }
    cells.finish("debris", brief)
}

/// Measures with the giant from its file, or with one of about `size` vertices.
fn measure(size: Option<usize>, brief: bool, cells: &mut Cells) -> Result<(), Box<dyn Error>> {
    let creature = size.map_or_else(giant, giant_of)?;
    let name = format!("{} vertices", creature.rig.collider.positions().len());
    let mut ours = Rocks::new(&creature, ROCKS, 3)?;
    let mut whole = Whole::new(Rocks::new(&creature, ROCKS, 3)?)?;
    let mut alone = Rocks::new(&creature, ROCKS, 3)?;
    let (fall, counted) = if brief { (20, 10) } else { (FALL, COUNTED) };
    let mut times: [Vec<f64>; 7] = Default::default();
    let mut near = 0;
    for tick in 0..fall + counted {
        let clip = Some(if tick < fall / 2 { "idle" } else { "shake" });
        ours.play(clip);
        whole.play(clip);
        let start = Instant::now();
        let since = |start: Instant| start.elapsed().as_secs_f64() * 1e6;
        ours.pose()?;
        ours.bring_skin()?;
        let brought = since(start);
        ours.step_world();
        let stepped = since(start);
        let report = ours.keep_out()?;
        let by_patches = since(start);
        let start = Instant::now();
        let skin = whole.step()?;
        let by_whole = start.elapsed().as_secs_f64() * 1e6;
        let start = Instant::now();
        alone.step_world();
        let by_none = start.elapsed().as_secs_f64() * 1e6;
        if tick >= fall {
            times[0].push(by_patches);
            times[1].push(by_whole);
            times[2].push(skin);
            times[3].push(brought);
            times[4].push(stepped - brought);
            times[5].push(by_patches - stepped);
            times[6].push(by_none);
            near += report.near;
        }
    }
    println!("{name}: {} rocks near the skin", near / counted);
    let [by_patches, by_whole, skin, brought, stepped, kept, alone] =
        times.map(|mut times| quantile(&mut times, 0.5));
    cells.value(
        &format!("{name}: debris, us a tick of {TICK:.4} s"),
        by_patches,
    );
    cells.value(&format!("{name}: of that, adding skin to rapier"), brought);
    cells.value(&format!("{name}: of that, rapier's step"), stepped);
    cells.value(&format!("{name}: of that, putting rocks back"), kept);
    cells.value(&format!("{name}: whole mesh, us a tick"), by_whole);
    cells.value(&format!("{name}: of that, setting the mesh"), skin);
    cells.value(&format!("{name}: rocks without a giant, us a tick"), alone);
    cells.value(
        &format!("{name}: debris / whole mesh"),
        by_patches / by_whole,
    );
    let most = match size {
        None => Bound::Most(0.4),
        Some(_) => Bound::Most(0.15),
    };
    cells.push(
        &format!("{name}: debris / whole mesh, rocks without a giant taken off both"),
        (by_patches - alone) / (by_whole - alone),
        most,
    );
    Ok(())
}
