//! Measures a climber's tick, compared with rapier's character controller on a mesh that does not move.
//!
//! - A giant of 6,258 vertices walks. One climber stands on it, another one climbs from its foot to its head. Their
//!   queries skin only the clusters that they touch. rapier's `KinematicCharacterController` stands on the same mesh in
//!   the giant's first pose. That mesh is never posed again, so rapier sees no motion, and no vertex is skinned for it.
//!   All take turns, tick by tick, on one thread. Times are medians. A contact rule lets the climbing climber grip
//!   everything. The standing climber needs no rule, and is measured without and with it.
//! - A thousand climbers are on ten giants of 10,000 vertices in a valley: of every five climbers two stand, one walks
//!   and two climb. The bench measures the share of two cores that they take, and the time of as many of rapier's
//!   controllers on the same giants as meshes that never move. rapier's controllers cannot climb, so they stand and
//!   walk.
//! - Walls close in on a climber and crush it. The bench compares ticks that crush with ticks in which it has room.
//! - Up to 512 climbers walk side by side. The bench measures the time of a tick per climber, with and without the
//!   others as obstacles.
//!
//! Prints a table and writes it to `target/measure/climber.csv`: name, value, bound, holds.
//!
//! Run it with `cargo bench -p clamber_benches --bench climber`; briefly with `-- --test`.

mod characters;
mod crowd;
mod crushed;
mod friends;
#[path = "../scene/herd.rs"]
mod herd;

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use clamber::prelude::*;
use clamber::world::rapier3d::math::Vector;
use clamber::world::rapier3d::prelude::PhysicsWorld;
use clamber_scenes::climbs::{Motion as Walks, RATE, Stage, Ways, long_climber};
use clamber_scenes::giant;
use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief, quantile};
use glam::DVec3;

use characters::{Character, queries, still_mesh};

/// Length of a tick, seconds.
const DT: f64 = 1.0 / RATE;

/// Height of the giant in metres, and the playback rate of its clips; the same as in the climbing tours.
const HEIGHT: (f64, f64) = (20.0, 1.0);

/// Obstacle id of the giant.
const GIANT: ObstacleId = ObstacleId(1);

/// Number of ticks within which a climber, and rapier's controller, must land.
const SETTLE: u32 = 600;

fn main() -> ExitCode {
    exit_code(run(is_brief()))
}

fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let mut cells = Cells::default();
    let ticks = if brief { 30 } else { 1_800 };
    let creature = giant::giant()?;
    let mut stage = Stage::new(&creature, HEIGHT, Walks::Walk)?;
    let mut still = Still::new(&stage)?;
    let mut times: [Vec<f64>; 4] = Default::default();
    let grips_all = |query: &ContactQuery<'_>| query.usual().with_grip(true);
    let ruled = StepRules::by(&grips_all);

    for (index, rules) in [(0, StepRules::default()), (3, ruled)] {
        stage.place(0.0)?;
        let mut stands = landed(&mut stage)?;
        for tick in 1..=ticks {
            let input = ClimberInput::default();
            times[index].push(timed(&mut stage, tick, &mut stands, &input, &rules)?);
            times[1].push(still.step());
        }
        if stands.state().mode != ClimberMode::Standing {
            return Err("the climber does not stand at the end".into());
        }
    }
    let ways = Ways::new(&creature)?;
    let route = ways.climb(16).ok_or("found no way up the giant")?;
    stage.place(0.0)?;
    let (foot, normal) = stage.vertex(route[0]);
    let mut climbs = Climber::new(long_climber(), foot + normal * 0.45)?;
    let (mut next, mut made, mut climbed) = (0, 0.0, 0);
    for tick in 1..=ticks {
        if next >= route.len() {
            break;
        }
        climbed = tick;
        let position = climbs.state().position;
        let target = stage.vertex(route[next]).0;
        let toward = target - position;
        next += usize::from(toward.length() < 0.9 || tick % 240 == 0);
        let input = ClimberInput {
            climb: toward.normalize_or(DVec3::Y),
            grip: true,
            ..ClimberInput::default()
        };
        let time = timed(&mut stage, tick, &mut climbs, &input, &ruled)?;
        if climbs.state().mode == ClimberMode::Holding {
            times[2].push(time);
            made += climbs.state().position.distance(position);
        }
        times[1].push(still.step());
    }
    if !still.character.is_grounded {
        return Err("rapier's character does not stand".into());
    }
    let share = 100.0 * times[2].len() as f64 / f64::from(climbed);
    cells.value("climbing: ticks of holding on and climbing, %", share);
    cells.value("climbing: distance moved, carrying included, m", made);
    let [standing, controller, climbing, ruled] = times.map(|mut times| quantile(&mut times, 0.5));
    cells.value("standing on the walking giant, us", standing);
    cells.value("standing there, with a rule for contacts, us", ruled);
    cells.value("climbing on it, us", climbing);
    cells.value(
        "rapier's controller standing on the giant's first pose, us",
        controller,
    );
    let name = "standing / rapier's controller";
    cells.push(name, standing / controller, Bound::Most(0.08));
    let name = "climbing / rapier's controller";
    cells.push(name, climbing / controller, Bound::Most(0.18));
    crushed::measure(if brief { 1 } else { 10 }, &mut cells)?;
    friends::measure(if brief { 2 } else { 120 }, &mut cells)?;
    if brief {
        crowd::measure((2, 2_000, 10), 30, &mut cells)?;
    } else {
        crowd::measure((10, 10_000, 1_000), 300, &mut cells)?;
    }
    cells.finish("climber", brief)
}

/// Runs a climber's tick; returns the microseconds.
fn timed(
    stage: &mut Stage<'_>,
    tick: u32,
    climber: &mut Climber,
    input: &ClimberInput,
    rules: &StepRules<'_>,
) -> Result<f64, Box<dyn Error>> {
    stage.advance(f64::from(tick) * DT)?;
    let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(GIANT, stage.surface())];
    let start = Instant::now();
    climber.step_with(input, &obstacles, rules, DT)?;
    Ok(start.elapsed().as_secs_f64() * 1e6)
}

/// A climber that has landed on the giant's top.
fn landed(stage: &mut Stage<'_>) -> Result<Climber, Box<dyn Error>> {
    let mut climber = Climber::new(ClimberConfig::walker(), above(stage)?)?;
    for _ in 0..SETTLE {
        stage.place(0.0)?;
        let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(GIANT, stage.surface())];
        climber.step(&ClimberInput::default(), &obstacles, DT)?;
        if climber.state().mode == ClimberMode::Standing {
            return Ok(climber);
        }
    }
    Err("the climber does not land on the giant".into())
}

/// A point half a metre above the giant's skin, straight below the top of its bounding ball.
fn above(stage: &Stage<'_>) -> Result<DVec3, Box<dyn Error>> {
    let (middle, radius) = stage
        .surface()
        .bounding_ball()
        .ok_or("the giant has no bounding ball")?;
    let top = middle + DVec3::Y * radius;
    let ray = stage.surface().cast_ray(top, -DVec3::Y, 2.0 * radius);
    Ok(ray.ok_or("no skin below the giant's top")?.point + DVec3::Y * 0.5)
}

/// rapier's controller on a mesh of the giant's first pose.
struct Still {
    world: PhysicsWorld,
    character: Character,
}

impl Still {
    fn new(stage: &Stage<'_>) -> Result<Self, Box<dyn Error>> {
        let mut world = PhysicsWorld::default();
        world.colliders.insert(still_mesh(stage.surface())?);
        world.step();
        let mut still = Self {
            world,
            character: Character::new(above(stage)?.as_vec3(), Vector::ZERO),
        };
        for _ in 0..SETTLE {
            still.step();
        }
        Ok(still)
    }

    /// Runs a tick of the character, which does not walk; returns the microseconds.
    fn step(&mut self) -> f64 {
        let queries = queries(&self.world);
        let start = Instant::now();
        self.character.step(&queries);
        start.elapsed().as_secs_f64() * 1e6
    }
}
