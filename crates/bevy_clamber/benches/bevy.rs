//! What does a tick in Bevy cost, compared with the core alone, and what does an idle surface cost?
//!
//! First climbers walk and climb on the walking giant, stepped by `ClimberPlugin` and by the core. Both must be in the
//! same state after each tick, to the bit.
//!
//! Then systems of the app make a climber's queries on its skin: triangles within reach of the body, the first contact
//! on its way, the closest point, a ray, and the motion of the point that it holds. The core alone does the same work:
//! if the app animates in frames it mixes the poses of two frames; it composes the palette, advances, and answers in
//! model space. Both take turns, tick by tick, within one process.
//!
//! Then a hundred giants stand still, without queries. Their cost is compared with reading their joints' `Transform`s
//! alone.
//!
//! Schedules run on one thread: with Bevy's multi-threaded executor, waking the threads costs more than a climber,
//! whatever its systems are. Times are medians. Prints a table and writes it to `target/measure/bevy.csv`: name, value,
//! bound, holds. Fails if states or numbers of hits differ.
//!
//! `cargo bench -p bevy_clamber --bench bevy`; brief with `-- --test`.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

#[path = "bevy/climbers.rs"]
mod climbers;
#[path = "../tests/plugin/common/mod.rs"]
mod common;
#[path = "bevy/giants.rs"]
mod giants;
#[path = "bevy/riders.rs"]
mod riders;

use std::error::Error;
use std::hint::black_box;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use bevy_app::{App, FixedPostUpdate, PostUpdate};
use bevy_clamber::clamber_surface::geometry::Similarity;
use bevy_clamber::clamber_surface::rig::{Palette, Playback, Pose};
use bevy_clamber::clamber_surface::surface::SkinnedSurface;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleLabel, SingleThreadedExecutor};
use bevy_time::{Fixed, Time, Virtual};
use bevy_transform::components::Transform;
use clamber_scenes::Creature;
use clamber_scenes::giant::giant;
use clamber_scenes::measure::{Bound, Cells, is_brief, quantile};
use giants::{Giants, on_one_thread};
use riders::{Answers, Asked, Rider, ask};

/// Ticks a second.
const RATE: f64 = 64.0;

/// Largest cost of a tick in Bevy, relative to the core's.
const OVER: Bound = Bound::Most(1.1);

fn main() -> ExitCode {
    match run(is_brief()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let mut cells = Cells::default();
    let creature = giant()?;
    let ticks = if brief { 20 } else { 2_000 };
    cells.value(
        "an empty world's tick in Bevy, us",
        climbers::nothing(ticks),
    );
    for (count, bound) in [(1, 1.08), (24, 1.05)] {
        climbers::measure(&creature, count, Bound::Most(bound), ticks, &mut cells)?;
    }
    for timing in [PoseTiming::EachTick, PoseTiming::EachFrame] {
        for riders in [1, 24] {
            walking(&creature, timing, riders, brief, &mut cells)?;
        }
    }
    for timing in [PoseTiming::EachTick, PoseTiming::EachFrame] {
        idle(&creature, timing, brief, &mut cells)?;
    }
    cells.finish("bevy", brief)
}

/// Poses of the walk, one for each tick.
fn walk(creature: &Creature, ticks: usize) -> Result<Vec<Pose>, Box<dyn Error>> {
    let rest = creature.rig.skeleton.rest_pose();
    let walk = creature.clip_like(&["walk"]).ok_or("it cannot walk")?;
    let poses = (0..ticks).map(|tick| walk.sample(&rest, tick as f64 / RATE, Playback::Loop));
    Ok(poses.collect::<Result<_, _>>()?)
}

/// Runs a schedule of an app, and returns its duration in microseconds.
fn time(app: &mut App, schedule: impl ScheduleLabel) -> f64 {
    let start = Instant::now();
    app.world_mut().run_schedule(schedule);
    start.elapsed().as_secs_f64() * 1e6
}

/// Advances the clocks by a frame, with the next tick in its middle.
fn pass_frame(app: &mut App) {
    let frame = Duration::from_secs_f64(1.0 / RATE);
    let world = app.world_mut();
    world.resource_mut::<Time<Virtual>>().advance_by(frame);
    let mut fixed = world.resource_mut::<Time<Fixed>>();
    let overstep = fixed.overstep();
    fixed.discard_overstep(overstep);
    fixed.accumulate_overstep(frame / 2);
}

fn walking(
    creature: &Creature,
    timing: PoseTiming,
    riders: usize,
    brief: bool,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let ticks = if brief { 20 } else { 2_000 };
    let drawn = walk(creature, 50)?;
    let last = drawn.last().ok_or("no poses")?;
    let posed: Vec<Pose> = match timing {
        PoseTiming::EachTick => drawn.clone(),
        // A tick is in the middle between two frames.
        PoseTiming::EachFrame => {
            let before = std::iter::once(last).chain(&drawn);
            let between = before.zip(&drawn).map(|(a, b)| a.blend(b, 0.5));
            between.collect::<Result<_, _>>()?
        }
    };
    let mut giants = Giants::new(on_one_thread(common::app(RATE)), creature, 1, timing);
    giants.app.init_resource::<Asked>();
    giants.app.init_resource::<Answers>();
    giants
        .app
        .add_systems(FixedPostUpdate, ask.after(ClamberSystems::Pose));
    let entity = giants.surfaces[0];
    let mesh = giants.mesh();
    let mut surface = SkinnedSurface::new(mesh.clone());
    let (mut mixed, mut palette) = (Pose::default(), Palette::default());
    let mut hits = Vec::new();
    let asked: Vec<Vec<Rider>> = riders::over(&mesh, creature, &posed, riders)?;
    let (mut core, mut bevy) = (Vec::new(), Vec::new());
    giants.pose(last);
    let _ = time(&mut giants.app, PostUpdate);
    for tick in 0..ticks {
        let now = &asked[tick % posed.len()];
        let (before, now_drawn) = (
            &drawn[(tick + drawn.len() - 1) % drawn.len()],
            &drawn[tick % drawn.len()],
        );
        giants.pose(now_drawn);
        let _ = time(&mut giants.app, PostUpdate);
        pass_frame(&mut giants.app);
        let mut in_bevy = |giants: &mut Giants| {
            let surface = giants.app.world().get::<PosedSurface>(entity);
            let asked = surface.map(|surface| Asked::new(entity, surface, now));
            giants.app.insert_resource(asked.unwrap_or_default());
            bevy.push(time(&mut giants.app, FixedPostUpdate));
        };
        let mut in_core = || -> Result<usize, Box<dyn Error>> {
            let start = Instant::now();
            if timing == PoseTiming::EachFrame {
                mixed.clone_from(before);
                mixed.blend_in(now_drawn, 0.5)?;
            } else {
                mixed.clone_from(now_drawn);
            }
            creature.rig.skeleton.palette_into(&mixed, &mut palette)?;
            surface.advance(&palette, Similarity::IDENTITY)?;
            let found = riders::answer(&surface, now, &mut hits);
            core.push(start.elapsed().as_secs_f64() * 1e6);
            Ok(found)
        };
        // They take turns at being first, since the second finds warm caches.
        let found = if tick.is_multiple_of(2) {
            in_bevy(&mut giants);
            in_core()?
        } else {
            let found = in_core()?;
            in_bevy(&mut giants);
            found
        };
        let answers = giants.app.world().resource::<Answers>().0;
        // In its first tick the core has no previous pose.
        if tick > 0 && answers != found {
            return Err(format!("tick {tick}: {answers} hits in Bevy, {found} in the core").into());
        }
        black_box(found);
    }
    let what = match timing {
        PoseTiming::EachTick => "animated in ticks",
        PoseTiming::EachFrame => "animated in frames",
    };
    let name = |rest: &str| format!("{riders} riders, {what}: {rest}");
    let (core, bevy) = (quantile(&mut core, 0.5), quantile(&mut bevy, 0.5));
    cells.value(&name("the core's tick, us"), core);
    cells.value(&name("a tick in Bevy, us"), bevy);
    cells.push(&name("Bevy / core"), bevy / core, OVER);
    Ok(())
}

/// Start and duration, microseconds, of the measured part of a frame.
#[derive(Resource, Default)]
struct Moments {
    start: Option<Instant>,
    taken: f64,
}

fn begin(mut moments: ResMut<Moments>) {
    moments.start = Some(Instant::now());
}

fn end(mut moments: ResMut<Moments>) {
    moments.taken = moments
        .start
        .map_or(0.0, |start| start.elapsed().as_secs_f64() * 1e6);
}

/// The joints to read, and a buffer for their transforms.
#[derive(Resource)]
struct Joints(Vec<Entity>, Vec<Transform>);

fn read(mut joints: ResMut<Joints>, transforms: Query<&Transform>) {
    let Joints(joints, into) = &mut *joints;
    into.clear();
    into.extend(
        joints
            .iter()
            .filter_map(|joint| transforms.get(*joint).ok()),
    );
    black_box(into);
}

#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
struct Reading;

fn idle(
    creature: &Creature,
    timing: PoseTiming,
    brief: bool,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let (count, ticks) = if brief { (5, 10) } else { (100, 1_000) };
    let mut giants = Giants::new(on_one_thread(common::app(RATE)), creature, count, timing);
    giants.pose(&creature.rig.skeleton.rest_pose());
    let joints = giants.joints.concat();
    giants.app.insert_resource(Joints(joints, Vec::new()));
    giants.app.init_resource::<Moments>();
    giants.app.init_schedule(Reading).add_systems(Reading, read);
    giants.app.edit_schedule(Reading, |schedule| {
        schedule.set_executor(SingleThreadedExecutor::new());
    });
    giants.app.add_systems(
        PostUpdate,
        (
            begin.before(ClamberSystems::Sample),
            end.after(ClamberSystems::Sample)
                .before(ClamberSystems::Anchor),
        ),
    );
    let (mut tick, mut frame, mut reading) = (Vec::new(), Vec::new(), Vec::new());
    for turn in 0..ticks + 5 {
        pass_frame(&mut giants.app);
        let ticked = time(&mut giants.app, FixedPostUpdate);
        let _ = time(&mut giants.app, PostUpdate);
        let framed = giants.app.world().resource::<Moments>().taken;
        let read = time(&mut giants.app, Reading);
        // In the first turns the surfaces come to rest.
        if turn >= 5 {
            tick.push(ticked);
            frame.push(framed);
            reading.push(read);
        }
    }
    let what = match timing {
        PoseTiming::EachTick => "animated in ticks",
        PoseTiming::EachFrame => "animated in frames",
    };
    let each = |values: &mut [f64]| quantile(values, 0.5) / count as f64;
    let (tick, frame, reading) = (each(&mut tick), each(&mut frame), each(&mut reading));
    let name = |rest: &str| format!("{count} idle giants, {what}: {rest}");
    cells.value(&name("a tick of one, us"), tick);
    cells.value(&name("a frame of one, us"), frame);
    cells.value(&name("reading the joints of one, us"), reading);
    let beyond = tick + frame - reading;
    cells.push(
        &name("tick and frame beyond that, us"),
        beyond,
        Bound::Most(1.0),
    );
    Ok(())
}
