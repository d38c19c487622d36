//! Measures the cost of a climber's body in a frame, and the distances of its hands and feet from their holds.
//!
//! The project's hero walks, goes up and down stairs, stands with a foot on a block, climbs a wall, hangs from shaking
//! skin, and climbs a walking giant. There is one frame for each tick of 60 Hz, on one thread. Times are medians. The
//! body's times include its queries, but not the climber's own step. In the same run, one clip of the hero is sampled
//! and its palette is composed, for comparison.
//!
//! Then the same climbs run with inverse kinematics alone: the model is fixed to the climber, and its limbs reach for
//! the same places, either as far as the bones do (hard) or with a soft limit. See [`compare`].
//!
//! Prints a table and writes it to `target/measure/body.csv`: name, value, bound, holds.
//!
//! Run it with `cargo bench -p clamber_benches --bench body`; briefly with `-- --test`.

mod compare;

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use clamber::body::{Body, BodyInput, Extremity, Figure, Humanoid, Side};
use clamber::rig::{Palette, Playback};
use clamber_scenes::bodies::{self, Mount, Scene, Stage};
use clamber_scenes::giant;
use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief, mean_us, quantile};
use glam::DVec3;

/// Length of a tick and of a frame, seconds.
const DT: f64 = 1.0 / 60.0;

fn main() -> ExitCode {
    exit_code(run(is_brief()))
}

fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/hero.glb");
    let rig = clamber::gltf::load(file)?.rig;
    let humanoid = Humanoid::find(&rig.skeleton)?;
    let figure = Figure::new(rig.skeleton, humanoid, rig.clips)?;
    let giant = giant::giant()?;
    let mount = Mount {
        clip: "walk",
        height: 0.35,
        from: DVec3::Z,
    };
    let scenes = [
        bodies::flat(0.0)?,
        bodies::flat(1.4)?,
        bodies::stairs(true, 1.0)?,
        bodies::stairs(false, 1.0)?,
        bodies::block()?,
        bodies::wall(DVec3::Y * 0.5)?,
        bodies::hang(3.0, 0.25)?,
        bodies::climb(&giant, &mount, 1.0)?,
    ];
    let mut cells = Cells::default();
    let sampling = clip_and_palette(&figure, brief)?;
    cells.value("one clip sampled and its palette composed, us", sampling);
    for scene in &scenes {
        let mut seen = play(scene, &figure, if brief { 120 } else { 3600 })?;
        let mut rows = cells.of(&scene.name);
        rows.value("a frame of the body, us", quantile(&mut seen.micros, 0.5));
        if !seen.slips.is_empty() {
            let p99 = quantile(&mut seen.slips, 0.99) * 100.0;
            let what = "feet slide, 99th percentile, cm/s";
            rows.push(what, p99, Bound::Most(5.0));
        }
        if !seen.palms.is_empty() {
            let [p99, most] = [0.99, 1.0].map(|part| quantile(&mut seen.palms, part) * 1000.0);
            let what = "palms from their holds, 99th percentile, mm";
            rows.push(what, p99, Bound::Most(2.0));
            rows.push("palms from their holds, most, mm", most, Bound::Most(10.0));
        }
    }
    let climbs = [
        bodies::wall(DVec3::Y * 0.5)?,
        bodies::hang(3.0, 0.25)?,
        bodies::climb(&giant, &mount, 1.0)?,
        bodies::climb(&giant, &mount, 1.5)?,
    ];
    compare::compare(&climbs, &figure, if brief { 120 } else { 3600 }, &mut cells)?;
    cells.finish("body", brief)
}

/// The median time to sample one clip and compose its palette, microseconds. Each sample is a mean over 100 frames.
fn clip_and_palette(figure: &Figure, brief: bool) -> Result<f64, Box<dyn Error>> {
    let set = figure.animations();
    let clip = set.clip(set.find("walk").ok_or("no walk")?)?;
    let (mut pose, mut palette) = (set.rest().clone(), Palette::default());
    let mut times = Vec::new();
    for round in 0..if brief { 3 } else { 300 } {
        times.push(mean_us(100, |frame| {
            let time = f64::from(round * 100 + frame) * DT;
            clip.sample_into(time, Playback::Loop, &mut pose)?;
            Ok(figure.skeleton().palette_into(&pose, &mut palette)?)
        })?);
    }
    Ok(quantile(&mut times, 0.5))
}

#[derive(Default)]
struct Seen {
    micros: Vec<f64>,
    /// Speeds at which planted soles slide along their supports, metres a second.
    slips: Vec<f64>,
    /// Distances of palms from their holds, metres.
    palms: Vec<f64>,
}

fn play(scene: &Scene, figure: &Figure, most: u32) -> Result<Seen, Box<dyn Error>> {
    let mut seen = Seen::default();
    let mut stage = Stage::new(scene)?;
    let mut body = Body::new(figure);
    let mut soles: [Option<(u64, [DVec3; 2])>; 2] = [None; 2];
    let ticks = ((scene.seconds / DT) as u32).min(most);
    for _ in 0..ticks {
        stage.tick(DT)?;
        let obstacles = stage.obstacles();
        let frame = BodyInput::new(&stage.climber, &obstacles);
        let start = Instant::now();
        body.update(figure, &frame, DT)?;
        seen.micros.push(start.elapsed().as_secs_f64() * 1e6);
        if stage.time < 1.5 {
            continue;
        }
        for side in Side::BOTH {
            if let (Some(hold), Some(palm)) = (
                body.hold(Extremity::Hand(side)),
                body.touching_point(figure, Extremity::Hand(side)),
            ) {
                seen.palms.push(palm.distance(hold.point));
            }
            let was = &mut soles[side.index()];
            let (Some(hold), Some(sole)) =
                (body.hold(Extremity::Foot(side)), body.sole(figure, side))
            else {
                *was = None;
                continue;
            };
            if stage.climber.state().mode.is_holding() {
                continue;
            }
            let local = sole.map(|p| hold.frame.conjugate() * (p - hold.point));
            let low = usize::from(sole[1].y < sole[0].y);
            if let Some((key, before)) = was
                && *key == hold.material.key
            {
                let moved = (local[low] - before[low]) * DVec3::new(1.0, 0.0, 1.0);
                seen.slips.push(moved.length() / DT);
            }
            *was = Some((hold.material.key, local));
        }
    }
    Ok(seen)
}
