//! Measures an arena's save, load and rollback, compared with one of its ticks; and ticks with many climbers, giants
//! and arrows.
//!
//! The giant stands in the valley and has its brain. One climber rides it, another one stands in front of it. All
//! operations take turns on one thread. Times are medians, if not said otherwise.
//!
//! - A plain tick, a save, a load, a fingerprint, and a rollback of eight ticks as ggrs asks for it: one load, then
//!   eight times a tick, a save and a fingerprint. The same again where a plate breaks in the fourth of the eight
//!   ticks. Ratios are to a plain tick.
//! - 64 climbers and four giants: the 99th percentile of the ticks, as a share of a sixtieth of a second.
//! - 1,000 climbers that walk on level ground, one on each square metre, and 20 m apart. The ratio of the two.
//! - 500 arrows that stick in the giant: the time that they add to a tick.
//! - 24 rocks that fall on the giant and are saved with the arena: a tick of the rocks, a save and a load of them.
//!
//! Prints a table and writes it to `target/measure/arena.csv`: name, value, bound, holds.
//!
//! Run it with `cargo bench -p clamber_benches --bench arena`; briefly with `-- --test`.

use std::error::Error;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use clamber::climber::ClimberInput;
use clamber::world::{
    Attachment, BodyPoses, DebrisSnapshot, HalfSpace, MaterialPoint, Obstacle, ObstacleId,
    RapierTerrain,
};
use clamber_colossus::{CreatureConfig, CreatureKind};
use clamber_fight::actions::STAB;
use clamber_fight::{
    Arena, ArenaConfig, ArenaEvent, ArenaState, BowConfig, CreatureId, FighterConfig, FighterId,
    Projectile, ProjectileId, ProjectileKind, ProjectileMotion, creature_obstacle,
};
use clamber_scenes::duel::Duel;
use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief, quantile};
use clamber_scenes::rocks::FallingRocks;
use clamber_scenes::valley;
use glam::DVec3;

/// Id of the terrain.
const GROUND: ObstacleId = ObstacleId(0);

/// Number of ticks of a rollback. [`report`] and its row names say eight.
const BACK: usize = 8;

/// The input of a climber that holds on and does nothing else.
const GRIP: ClimberInput = ClimberInput {
    grip: true,
    ..ClimberInput::IDLE
};

type Failure = Box<dyn Error>;

fn main() -> ExitCode {
    exit_code(run(is_brief()))
}

fn run(brief: bool) -> Result<(), Failure> {
    let rounds = if brief { 20 } else { 3000 };
    let kind = Duel::kind()?;
    let world = valley::world();
    let poses = BodyPoses::default();
    let valley = RapierTerrain::of_world(&world, &poses);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &valley)];
    let mut cells = Cells::default();

    let mut riding = riders(&kind)?;
    for _ in 0..60 {
        riding.step(&[GRIP, ClimberInput::IDLE], &terrain)?;
    }
    let times = measure(&mut riding, &terrain, rounds, |_| GRIP)?;
    let tick = times[0];
    report(&mut cells, "", &times, tick);
    let bytes = riding.to_bytes()?.len();
    cells.value("a snapshot as bytes", bytes as f64);

    let mut breaking = before_the_break(&kind, &terrain)?;
    let times = measure_break(&mut breaking, &terrain, rounds / 10 + 2)?;
    report(&mut cells, ", a plate breaks", &times, tick);

    crowd(&kind, &terrain, rounds / 10 + 2, &mut cells)?;
    thousand(rounds / 100 + 2, &mut cells)?;
    arrows(&kind, &terrain, rounds, tick, &mut cells)?;
    rocks(&kind, rounds / 3 + 2, tick, &mut cells)?;
    cells.finish("arena", brief)
}

/// A climber that never tires and whose stabs break any plate.
fn hero() -> FighterConfig {
    let mut config = FighterConfig::hero();
    config.climber.stamina = None;
    if let Some(sword) = &mut config.sword {
        sword.stab_damage = 1000.0;
    }
    config
}

/// An arena with the giant, one climber above its back and another one in front of it.
fn riders(kind: &Arc<CreatureKind>) -> Result<Arena, Failure> {
    let mut arena = giant_alone(kind)?;
    arena.add_fighter(hero(), DVec3::new(0.0, 37.0, -3.0))?;
    arena.add_fighter(hero(), in_front())?;
    Ok(arena)
}

/// An arena with the giant.
fn giant_alone(kind: &Arc<CreatureKind>) -> Result<Arena, Failure> {
    let mut arena = Arena::new(ArenaConfig::default())?;
    let place = CreatureConfig {
        position: DVec3::Y * valley::height(0.0, 0.0),
        ..CreatureConfig::default()
    };
    arena.add_creature(Arc::clone(kind), place)?;
    Ok(arena)
}

/// A place in front of the giant.
fn in_front() -> DVec3 {
    DVec3::new(4.0, valley::height(4.0, 25.0) + 1.0, 25.0)
}

/// Medians, microseconds: of each of [`OPERATIONS`].
type Times = [f64; 5];

/// The operations, each with the bound of its ratio to a plain tick.
const OPERATIONS: [(&str, Option<f64>); 5] = [
    ("a tick", None),
    ("a save", Some(0.1)),
    ("a load", Some(0.3)),
    ("a fingerprint", None),
    ("a rollback of eight ticks", Some(10.0)),
];

fn measure(
    arena: &mut Arena,
    terrain: &[(ObstacleId, &dyn Obstacle)],
    rounds: usize,
    input: impl Fn(usize) -> ClimberInput,
) -> Result<Times, Failure> {
    let mut all: [Vec<f64>; 5] = Default::default();
    let mut saved: Vec<ArenaState> = vec![arena.save(); BACK];
    let inputs = |tick: usize| [input(tick), ClimberInput::IDLE];
    for round in 0..rounds {
        let from = arena.save();
        for (tick, saved) in saved.iter_mut().enumerate() {
            all[0].push(timed(|| {
                Ok(arena.step(&inputs(tick), terrain).map(drop)?)
            })?);
            all[1].push(timed(|| {
                *saved = arena.save();
                Ok(())
            })?);
            all[3].push(timed(|| {
                std::hint::black_box(arena.fingerprint());
                Ok(())
            })?);
        }
        all[4].push(timed(|| {
            arena.restore(&from)?;
            for (tick, saved) in saved.iter_mut().enumerate() {
                arena.step(&inputs(tick), terrain)?;
                *saved = arena.save();
                std::hint::black_box(arena.fingerprint());
            }
            Ok(())
        })?);
        // Loads the old state, then the new one, so that the loaded state always differs from the arena's.
        let now = arena.save();
        all[2].push(timed(|| Ok(arena.restore(&from)?))?);
        all[2].push(timed(|| Ok(arena.restore(&now)?))?);
        if round % 100 == 99 {
            arena.step(&[GRIP, ClimberInput::IDLE], terrain)?;
        }
    }
    Ok(all.map(|mut times| quantile(&mut times, 0.5)))
}

/// Adds the times as rows, and the ratios of save, load and rollback to the plain tick.
fn report(cells: &mut Cells, what: &str, times: &Times, plain: f64) {
    for ((name, _), time) in OPERATIONS.iter().zip(times) {
        cells.value(&format!("{name}{what}, us"), *time);
    }
    for ((name, most), time) in OPERATIONS.iter().zip(times) {
        if let Some(most) = most {
            let name = format!("{name}{what} / a tick");
            cells.push(&name, time / plain, Bound::Most(*most));
        }
    }
}

/// The arena in the state from which the fourth tick breaks the plate over the giant's nape, by a stab.
fn before_the_break(
    kind: &Arc<CreatureKind>,
    terrain: &[(ObstacleId, &dyn Obstacle)],
) -> Result<Arena, Failure> {
    let mut arena = giant_alone(kind)?;
    let nape = kind
        .weak_points()
        .iter()
        .position(|point| point.name.contains("nape"));
    let nape = arena
        .creature(CreatureId(0))
        .and_then(|giant| giant.weak_point(nape?));
    let nape = nape.ok_or("the giant has no weak point on its nape")?;
    let mut config = hero();
    // The giant can neither throw this climber off its feet nor make it tumble.
    config.climber.ground.throw_acceleration = f64::INFINITY;
    config.climber.tumble = None;
    arena.add_fighter(config, nape + DVec3::Y * 2.5)?;
    arena.add_fighter(hero(), in_front())?;
    let mut states = vec![arena.save()];
    for tick in 0..1200 {
        let pressed = if tick % 60 == 50 { STAB } else { 0 };
        let input = ClimberInput {
            actions: pressed,
            ..ClimberInput::IDLE
        };
        arena.step(&[input, ClimberInput::IDLE], terrain)?;
        states.push(arena.save());
        if is_broken(&arena) && states.len() > BACK {
            let state = &states[states.len() - 1 - BACK / 2];
            arena.restore(state)?;
            return Ok(arena);
        }
    }
    let act = arena.fighter(FighterId(0)).map(|one| one.act().clone());
    Err(format!("no stab breaks the plate: {act:?}").into())
}

/// True if the giant's plate is broken.
fn is_broken(arena: &Arena) -> bool {
    let giant = arena.creature(CreatureId(0));
    giant.is_some_and(|giant| giant.state().plate(0) == 0)
}

/// As [`measure`], `rounds` times from the same state. Fails if the plate does not break within the eight ticks.
fn measure_break(
    arena: &mut Arena,
    terrain: &[(ObstacleId, &dyn Obstacle)],
    rounds: usize,
) -> Result<Times, Failure> {
    let from = arena.save();
    let mut all: Vec<Times> = Vec::new();
    for _ in 0..rounds {
        arena.restore(&from)?;
        let times = measure(arena, terrain, 1, |_| ClimberInput::IDLE)?;
        if !is_broken(arena) {
            return Err("the plate is whole after the eight ticks".into());
        }
        all.push(times);
    }
    let of = |operation: usize| all.iter().map(|times| times[operation]).collect();
    let all: [Vec<f64>; 5] = std::array::from_fn(of);
    Ok(all.map(|mut times| quantile(&mut times, 0.5)))
}

/// Adds rows for 64 climbers and four giants.
fn crowd(
    kind: &Arc<CreatureKind>,
    terrain: &[(ObstacleId, &dyn Obstacle)],
    rounds: usize,
    cells: &mut Cells,
) -> Result<(), Failure> {
    let mut arena = Arena::new(ArenaConfig::default())?;
    for giant in 0..4u64 {
        let (x, z) = (
            if giant % 2 == 0 { -30.0 } else { 30.0 },
            if giant < 2 { -30.0 } else { 30.0 },
        );
        let config = CreatureConfig {
            position: DVec3::new(x, valley::height(x, z), z),
            seed: giant,
            ..CreatureConfig::default()
        };
        arena.add_creature(Arc::clone(kind), config)?;
        for climber in 0..16 {
            // A quarter of them on the giant's back, the others around it.
            let (aside, along) = (f64::from(climber % 4) - 1.5, f64::from(climber / 4) - 1.5);
            let place = if climber < 4 {
                DVec3::new(x + 2.0 * aside, 38.0, z - 2.0)
            } else {
                let (x, z) = (x + 8.0 * aside, z + 8.0 * along);
                DVec3::new(x, valley::height(x, z) + 1.0, z)
            };
            arena.add_fighter(hero(), place)?;
        }
    }
    let walk = |tick: usize, climber: usize| {
        let turn = tick as f64 / 60.0 + climber as f64;
        let (sin, cos) = libm::sincos(turn);
        ClimberInput {
            walk: DVec3::new(sin, 0.0, cos),
            ..GRIP
        }
    };
    let mut times = Vec::new();
    for tick in 0..60 + rounds {
        let inputs: Vec<ClimberInput> = (0..64).map(|climber| walk(tick, climber)).collect();
        let time = timed(|| Ok(arena.step(&inputs, terrain).map(drop)?))?;
        if tick >= 60 {
            times.push(time);
        }
    }
    let [usual, slow] = [0.5, 0.99].map(|part| quantile(&mut times, part));
    cells.value("64 climbers and 4 giants, a tick, us", usual);
    cells.value("64 climbers and 4 giants, 99 % of ticks within, us", slow);
    let name = "64 climbers and 4 giants, 99 % of ticks / 60th of a second";
    cells.push(name, slow * 60e-6, Bound::Most(0.5));
    Ok(())
}

/// Adds rows for 1,000 climbers that walk in circles on level ground, close together and far apart.
fn thousand(rounds: usize, cells: &mut Cells) -> Result<(), Failure> {
    /// Climbers in a row.
    const ROW: u32 = 32;
    let ground = HalfSpace::below(0.0);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ground)];
    let config = FighterConfig {
        sword: None,
        bow: None,
        stones: None,
        ..FighterConfig::hero()
    };
    let mut means = Vec::new();
    for apart in [1.0, 20.0] {
        let mut arena = Arena::new(ArenaConfig::default())?;
        for climber in 0..1000 {
            let (x, z) = (f64::from(climber % ROW), f64::from(climber / ROW));
            arena.add_fighter(config, DVec3::new(apart * x, 0.4, apart * z))?;
        }
        let mut times = Vec::new();
        for tick in 0..60 + rounds {
            let input = |climber: usize| {
                let (sin, cos) = libm::sincos(tick as f64 / 60.0 + climber as f64);
                ClimberInput {
                    walk: DVec3::new(sin, 0.0, cos),
                    ..ClimberInput::IDLE
                }
            };
            let inputs: Vec<ClimberInput> = (0..1000).map(input).collect();
            let time = timed(|| Ok(arena.step(&inputs, &terrain).map(drop)?))?;
            if tick >= 60 {
                times.push(time);
            }
        }
        means.push(quantile(&mut times, 0.5));
    }
    let [close, far] = means[..] else {
        return Err("two means".into());
    };
    cells.value("1,000 climbers, one a square metre, a tick, us", close);
    cells.value("1,000 climbers, 20 m apart, a tick, us", far);
    cells.value(
        "1,000 climbers, one a square metre / 20 m apart",
        close / far,
    );
    Ok(())
}

/// Adds rows for 500 arrows that stick in the giant. Fails if an arrow comes loose.
fn arrows(
    kind: &Arc<CreatureKind>,
    terrain: &[(ObstacleId, &dyn Obstacle)],
    rounds: usize,
    tick: f64,
    cells: &mut Cells,
) -> Result<(), Failure> {
    let (mut bare, mut full) = (riders(kind)?, riders(kind)?);
    let mut state = full.save();
    let creature = full.creature(CreatureId(0)).ok_or("no giant")?;
    let surface = creature.surface();
    let count = surface.mesh().triangles().len() as u64;
    for arrow in 0..500 {
        let triangle = clamber::mesh::TriangleId((arrow * count / 500) as u32);
        let material = MaterialPoint::on_triangle(triangle, [1.0 / 3.0; 3]);
        let motion = surface
            .motion(&material, 1.0 / 60.0)
            .ok_or("a triangle without motion")?;
        let contact = clamber::world::Contact {
            point: motion.position,
            normal: DVec3::Y,
            distance: 0.0,
            material,
            tag: Default::default(),
        };
        state.projectiles.push(Projectile {
            id: ProjectileId(arrow),
            kind: ProjectileKind::Arrow,
            by: FighterId(0),
            body: BowConfig::default().arrow(),
            seconds: 0.0,
            motion: ProjectileMotion::Stuck {
                at: Attachment::new(
                    creature_obstacle(CreatureId(0)),
                    surface,
                    &contact,
                    contact.point,
                ),
                direction: DVec3::NEG_Y,
            },
        });
    }
    state.next_projectile = 500;
    full.restore(&state)?;
    let mut times: [Vec<f64>; 2] = Default::default();
    for _ in 0..rounds {
        for (arena, times) in [&mut bare, &mut full].into_iter().zip(&mut times) {
            times.push(timed(|| {
                Ok(arena.step(&[GRIP, ClimberInput::IDLE], terrain).map(drop)?)
            })?);
        }
    }
    let [without, with] = times.map(|mut times| quantile(&mut times, 0.5));
    let (name, more) = ("500 arrows that stick, a tick more", with - without);
    cells.push(&format!("{name}, us"), more, Bound::Most(100.0));
    cells.value(&format!("{name} / a tick"), more / tick);
    let lost = full
        .events()
        .iter()
        .any(|one| matches!(one, ArenaEvent::CameLoose { .. }));
    if full.projectiles().len() != 500 || lost {
        return Err("arrows are lost".into());
    }
    Ok(())
}

/// Adds rows for 24 rocks that fall on the giant, and are saved and loaded with the arena.
fn rocks(
    kind: &Arc<CreatureKind>,
    rounds: usize,
    tick: f64,
    cells: &mut Cells,
) -> Result<(), Failure> {
    let (mut arena, mut world) = (riders(kind)?, valley::world());
    let above = DVec3::new(0.0, 40.0, 0.0);
    let mut rocks = FallingRocks::new(&mut world, 24, 1, above, 1.0)?;
    let dt = arena.config().tick;
    let mut saved = DebrisSnapshot::save(&world, &rocks.debris);
    let mut all: [Vec<f64>; 3] = Default::default();
    for round in 0..60 + rounds {
        let poses = BodyPoses::default();
        let among = RapierTerrain::of_world(&world, &poses);
        let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &among)];
        arena.step(&[GRIP, ClimberInput::IDLE], &terrain)?;
        let skin = arena.creature(CreatureId(0)).ok_or("no giant")?.surface();
        let skin = (creature_obstacle(CreatureId(0)), skin);
        let stepped = timed(|| Ok(rocks.step(skin, &mut world, dt).map(drop)?))?;
        let save = timed(|| {
            saved = DebrisSnapshot::save(&world, &rocks.debris);
            Ok(())
        })?;
        let load = timed(|| {
            saved.restore(&mut world, &mut rocks.debris);
            Ok(())
        })?;
        if round >= 60 {
            for (times, time) in all.iter_mut().zip([stepped, save, load]) {
                times.push(time);
            }
        }
    }
    let names = ["a tick", "a save", "a load"];
    for (name, mut times) in names.into_iter().zip(all) {
        let time = quantile(&mut times, 0.5);
        cells.value(&format!("24 rocks, {name}, us"), time);
        cells.value(&format!("24 rocks, {name} / a tick"), time / tick);
    }
    Ok(())
}

/// Runs `work` once; returns the microseconds.
fn timed(work: impl FnOnce() -> Result<(), Failure>) -> Result<f64, Failure> {
    let start = Instant::now();
    work()?;
    Ok(start.elapsed().as_secs_f64() * 1e6)
}
