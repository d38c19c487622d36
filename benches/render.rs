//! Measures rendering: frames a second of the battle, bytes uploaded for each frame, and skinning on the device
//! compared with skinning on the processor.
//!
//! On the processor `skin_all` skins positions, on one thread. The device skins normals as well, and its time includes
//! the palette's upload. Prints a table and writes it to `target/measure/render.csv`: name, value, bound, holds. With
//! Mesa's software Vulkan the processor does the work of a GPU, so the times say little about a real one. Without a
//! graphics adapter the bench prints a message and measures nothing. Fails if a frame's upload grows with the number of
//! vertices.
//!
//! Run it with `cargo bench -p clamber_benches --features render --bench render`; briefly with `-- --test`.

use std::error::Error;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clamber::prelude::*;
use clamber::render::{Frame, Gpu, Overlay, RenderError, Renderer};
use clamber_scenes::Creature;
use clamber_scenes::battle::{Battle, BattleOptions, TICK};
use clamber_scenes::giant::{self, giant, giant_of};
use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief, median_us, quantile};
use clamber_scenes::picture::{Stage, add_collider, add_visual, light, orbit};

/// Width and height of a frame, pixels.
const SIZE: [u32; 2] = [1280, 720];

/// Colour of the colliders. It does not change any result.
const COLOR: [f32; 3] = [0.3; 3];

/// Sizes and times of a run of the bench.
struct Effort {
    brief: bool,
    frames: u32,
    vertices: &'static [usize],
    each: Duration,
}

fn main() -> ExitCode {
    let brief = is_brief();
    let effort = Effort {
        brief,
        frames: if brief { 3 } else { 60 },
        vertices: if brief {
            &[20_000]
        } else {
            &[30_000, 100_000, 500_000]
        },
        each: Duration::from_millis(if brief { 20 } else { 2_000 }),
    };
    exit_code(run(&effort))
}

/// True if a missing graphics adapter is a failure.
fn is_required() -> bool {
    std::env::var_os("CLAMBER_REQUIRE_GPU").is_some()
}

fn run(effort: &Effort) -> Result<(), Box<dyn Error>> {
    let gpu = match Gpu::new() {
        Err(RenderError::NoAdapter { reason }) if !is_required() => {
            eprintln!(
                "SKIPPED render: no graphics adapter, install mesa-vulkan-drivers ({reason})"
            );
            return Ok(());
        }
        gpu => gpu?,
    };
    let mut cells = Cells::default();
    measure_frames(gpu, effort, &mut cells)?;
    let mut creatures = vec![giant()?];
    for vertices in effort.vertices {
        creatures.push(giant_of(*vertices)?);
    }
    let mut bytes = None;
    for creature in &creatures {
        let found = measure_bytes(creature, bytes, &mut cells)?;
        bytes = bytes.or(Some(found));
    }
    for creature in &creatures {
        measure_skinning(creature, effort, &mut cells)?;
    }
    cells.finish("render", effort.brief)
}

/// Measures frames with giant, ground and climber, one per tick. The tick itself is not timed.
fn measure_frames(gpu: Gpu, effort: &Effort, cells: &mut Cells) -> Result<(), Box<dyn Error>> {
    let creature = giant()?;
    let options = BattleOptions::ride(0, 1);
    let height = options.height();
    let [width, rows] = SIZE;
    let what = format!("battle of {width} x {rows} on {}", gpu.name());
    let mut renderer = Renderer::new(gpu, width, rows)?;
    let seen = add_visual(&mut renderer, &giant::model()?)?;
    let mut stage = Stage::new(&mut renderer, seen)?;
    // The first frame is not counted.
    let mut measure = |draw: &dyn Fn(&mut Renderer, &Frame<'_>) -> Result<(), RenderError>| {
        let mut battle = Battle::new(&creature, &options)?;
        let mut times = Vec::new();
        for tick in 0..=effort.frames {
            battle.step(options.input_at(tick.into()))?;
            stage.watch(&battle, TICK)?;
            let frame = Frame {
                camera: orbit(&battle, height, 0.6),
                light: light(&battle, height),
                drawn: stage.drawn(&battle, battle.palette()),
                overlay: Overlay::default(),
            };
            let start = Instant::now();
            draw(&mut renderer, &frame)?;
            times.push(start.elapsed().as_secs_f64());
        }
        let uploaded = renderer.uploaded() as f64;
        Ok::<_, Box<dyn Error>>((1.0 / quantile(&mut times[1..], 0.5), uploaded))
    };
    let (left, uploaded) = measure(&|renderer, frame| {
        renderer.draw_unread(frame)?;
        renderer.gpu().wait()
    })?;
    let (read, _) = measure(&|renderer, frame| renderer.draw(frame).map(drop))?;
    let mut rows = cells.of(what);
    rows.value("frames a second, not read back", left);
    rows.value("frames a second, read back", read);
    cells.value("bytes uploaded for each of these frames", uploaded);
    Ok(())
}

/// Measures the bytes uploaded for one frame of a creature. Fails if they are more than `most`, the bytes of the
/// creature with the fewest vertices.
fn measure_bytes(
    creature: &Creature,
    most: Option<f64>,
    cells: &mut Cells,
) -> Result<f64, Box<dyn Error>> {
    let options = BattleOptions::ride(0, 1);
    let height = options.height();
    let battle = Battle::new(creature, &options)?;
    let mut renderer = Renderer::new(Gpu::new()?, 64, 64)?;
    let mesh = add_collider(&mut renderer, &creature.rig.collider, COLOR)?;
    let stage = Stage::new(&mut renderer, vec![mesh])?;
    renderer.draw(&Frame {
        camera: orbit(&battle, height, 0.6),
        light: light(&battle, height),
        drawn: stage.drawn(&battle, battle.palette()),
        overlay: Overlay::default(),
    })?;
    let uploaded = renderer.uploaded() as f64;
    let vertices = creature.rig.collider.positions().len();
    let bound = most.map_or(Bound::None, Bound::Most);
    let name = format!("bytes uploaded for a frame, {vertices} vertices");
    cells.push(&name, uploaded, bound);
    if most.is_some_and(|most| uploaded > most) {
        return Err("the upload of a frame grows with the number of vertices".into());
    }
    Ok(uploaded)
}

fn measure_skinning(
    creature: &Creature,
    effort: &Effort,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let mesh = &creature.rig.collider;
    let name = format!("skinning {} vertices", mesh.positions().len());
    // One second of the walk, tick by tick.
    let palettes = (0..60).map(|tick| creature.palette("walk", f64::from(tick) / 60.0));
    let palettes = palettes.collect::<Result<Vec<_>, _>>()?;
    let mut turn = palettes.iter().cycle();
    let mut next = || turn.next().unwrap_or(&palettes[0]);

    let mut surface = SkinnedSurface::new(mesh.clone());
    let mut positions = Vec::new();
    let mut failure: Result<(), Box<dyn Error>> = Ok(());
    let mut keep = |result: Result<(), Box<dyn Error>>| {
        if result.is_err() {
            failure = result;
        }
    };
    let here = median_us(effort.each, || {
        let advanced = surface.advance(next(), Similarity::IDENTITY);
        keep(advanced.map_err(Into::into));
        surface.skin_all(&mut positions);
    });

    let mut renderer = Renderer::new(Gpu::new()?, 16, 16)?;
    let id = add_collider(&mut renderer, mesh, COLOR)?;
    let there = median_us(effort.each, || {
        let posed = renderer.pose_unread(id, next());
        keep(
            posed
                .and_then(|()| renderer.gpu().wait())
                .map_err(Into::into),
        );
    });
    let read = median_us(effort.each, || {
        let posed = renderer.posed_positions(id, next());
        keep(posed.map(drop).map_err(Into::into));
    });
    failure?;
    let mut rows = cells.of(name);
    rows.value("skin_all, us", here);
    rows.value("on the device, us", there);
    rows.value("on the device and read back, us", read);
    rows.value("skin_all / on the device", here / there);
    Ok(())
}
