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

#[path = "../../examples/rocks/scene.rs"]
mod scene;
mod whole;

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use clamber_scenes::giant::{giant, giant_of};
use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief, quantile};

use scene::{CREATURE, Rocks, TICK};
use whole::Whole;

/// Number of rocks in each world.
const ROCKS: usize = 200;

/// Number of ticks at the start that are not counted: the rocks fall on the giant.
const FALL: u32 = 200;

/// Number of counted ticks.
const COUNTED: u32 = 200;

fn main() -> ExitCode {
    exit_code(run(is_brief()))
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
        let skin = [(CREATURE, &ours.surface)];
        let (debris, world) = (&mut ours.rocks.debris, &mut ours.world);
        debris.before_step(&skin, &mut world.bodies, &mut world.colliders, TICK)?;
        let brought = since(start);
        world.step_with_events(&*debris, &());
        let stepped = since(start);
        let (broad_phase, narrow_phase) = (&world.broad_phase, &world.narrow_phase);
        let (bodies, colliders) = (&mut world.bodies, &world.colliders);
        let report =
            debris.after_step(&skin, bodies, colliders, broad_phase, narrow_phase, TICK)?;
        let by_patches = since(start);
        let start = Instant::now();
        let skin = whole.step()?;
        let by_whole = start.elapsed().as_secs_f64() * 1e6;
        let start = Instant::now();
        alone.world.step_with_events(&alone.rocks.debris, &());
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
    let mut rows = cells.of(name);
    rows.value(&format!("debris, us a tick of {TICK:.4} s"), by_patches);
    rows.value("of that, adding skin to rapier", brought);
    rows.value("of that, rapier's step", stepped);
    rows.value("of that, putting rocks back", kept);
    rows.value("whole mesh, us a tick", by_whole);
    rows.value("of that, setting the mesh", skin);
    rows.value("rocks without a giant, us a tick", alone);
    rows.value("debris / whole mesh", by_patches / by_whole);
    let what = "debris / whole mesh, rocks without a giant taken off both";
    let most = if size.is_none() { 0.4 } else { 0.15 };
    let ratio = (by_patches - alone) / (by_whole - alone);
    rows.push(what, ratio, Bound::Most(most));
    Ok(())
}
