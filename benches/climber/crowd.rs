//! A thousand climbers on ten walking giants: the share of two cores that a tick at 60 Hz takes, and its ratio to as
//! many of rapier's characters on giants that stand still.

use std::error::Error;
use std::time::Instant;

use clamber::prelude::*;
use clamber::world::rapier3d::prelude::PhysicsWorld;
use clamber_scenes::climbs::{RATE, long_climber};
use clamber_scenes::giant::giant_of;
use clamber_scenes::measure::{Bound, Cells, quantile};
use clamber_scenes::valley;
use glam::DVec3;
use rayon::prelude::*;

use super::characters::{Character, Characters, still_mesh};
use super::herd::{Giant, Herd, Seat};

/// Length of a tick, seconds.
const DT: f64 = 1.0 / RATE;

/// Distance between giants, metres.
const APART: f64 = 60.0;

/// Number of giants in a row.
const ROW: usize = 5;

/// Smallest Y of a seat's unit normal, so that a climber can stand there while the giant walks.
const LEVEL: f64 = 0.85;

/// Distance from its seat at which a climber is put back, metres: the climber has fallen, or has walked far enough.
const AWAY: f64 = 6.0;

/// Number of ticks at the start that are not timed; also the number of ticks in each turn of rapier's characters.
const SETTLE: usize = 30;

/// Smallest share of ticks that climbers must spend on the giants, and rapier's characters on the ground. Below it the
/// bench fails, since it would measure falling.
const LEAST_BUSY: f64 = 0.7;

/// The largest number of climbers that a thread takes at a time. With rayon's larger pieces one thread waits for the
/// other's last piece.
const GRAIN: usize = 16;

/// The activity of a climber, the same in all ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Stands,
    Walks,
    Climbs,
}

/// The activities of five climbers in a row: two stand, one walks, two climb.
const PARTS: [Part; 5] = [
    Part::Stands,
    Part::Climbs,
    Part::Walks,
    Part::Climbs,
    Part::Stands,
];

struct Rider {
    climber: Climber,
    part: Part,
    seat: Seat,
    /// World-space direction of walking or climbing.
    direction: DVec3,
}

/// Adds rows for `riders` climbers on `giants` giants of about `vertices` vertices each.
pub(crate) fn measure(
    (giants, vertices, riders): (usize, usize, usize),
    ticks: usize,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let creature = giant_of(vertices)?;
    let mut herd = Herd::new(&creature, giants, ROW, APART)?;
    let mut riders = seated(&herd, riders)?;
    let world = valley::world();
    let two = rayon::ThreadPoolBuilder::new().num_threads(2).build()?;
    let mut characters = Characters::new(beside(&herd.giants, riders.len())?, (AWAY, GRAIN));
    let mut times: [Vec<f64>; 3] = Default::default();
    let (mut holding, mut standing, mut hanging) = (0, 0, 0);
    for tick in 0..SETTLE + ticks {
        for rider in &mut riders {
            herd.sit(&mut rider.climber, &rider.seat, AWAY)?;
        }
        let before = BodyPoses::default();
        let terrain = RapierTerrain::of_world(&world, &before);
        let start = Instant::now();
        two.install(|| herd.pose_in_parallel(tick + 1))?;
        let posed = start.elapsed().as_secs_f64();
        let start = Instant::now();
        two.install(|| step(&mut riders, &herd.giants, &terrain))?;
        let stepped = start.elapsed().as_secs_f64();
        // Climbers and characters take turns of many ticks, so that each finds its own data in the caches.
        if (tick + 1).is_multiple_of(SETTLE) {
            for turn in 0..SETTLE {
                let seconds = characters.step(&two);
                if tick >= SETTLE && turn > 0 {
                    times[2].push(seconds * 1e3);
                    characters.count();
                }
            }
        }
        if tick >= SETTLE {
            for (times, seconds) in times.iter_mut().zip([posed, stepped]) {
                times.push(seconds * 1e3);
            }
            let count = |mode| {
                let modes = riders.iter().map(|rider| rider.climber.state().mode);
                modes.filter(|other| *other == mode).count()
            };
            holding += count(ClimberMode::Holding);
            standing += count(ClimberMode::Standing);
            hanging += count(ClimberMode::Hanging);
        }
    }
    let all = (riders.len() * ticks) as f64;
    if ((holding + standing + hanging) as f64) < LEAST_BUSY * all {
        return Err("too many climbers fall".into());
    }
    let grounded = characters.grounded() as f64 / (riders.len() * times[2].len()) as f64;
    if grounded < LEAST_BUSY {
        return Err("too many of rapier's characters fall".into());
    }
    let climbers = riders.len();
    let thing = format!("{climbers} climbers on {giants} giants of {vertices} vertices");
    let mut rows = cells.of(thing);
    rows.value("standing or walking, %", 100.0 * standing as f64 / all);
    rows.value("holding on and climbing, %", 100.0 * holding as f64 / all);
    rows.value("hanging, %", 100.0 * hanging as f64 / all);
    let [mut posed, mut stepped, mut others] = times;
    let mut whole: Vec<f64> = posed.iter().zip(&stepped).map(|(a, b)| a + b).collect();
    rows.value("poses on two cores, ms", quantile(&mut posed, 0.5));
    rows.value("climbers on two cores, ms", quantile(&mut stepped, 0.5));
    let mut of_60_hz = |part: f64| quantile(&mut whole, part) * 1e-3 * RATE;
    let (fastest, share) = (of_60_hz(0.1), of_60_hz(0.5));
    rows.value("share of 60 Hz, the fastest tenth of ticks", fastest);
    rows.push("share of 60 Hz on two cores", share, Bound::Most(0.5));
    let controllers = quantile(&mut others, 0.5);
    let what = "as many of rapier's controllers on still meshes, ms";
    rows.value(what, controllers);
    rows.value("ticks of those on the ground, %", 100.0 * grounded);
    let ratio = quantile(&mut whole, 0.5) / controllers;
    let what = "climbers and poses / rapier's controllers";
    rows.push(what, ratio, Bound::Most(0.15));
    Ok(())
}

/// The valley and the giants as meshes that never move, and `count` of rapier's characters at places where climbers
/// could stand. rapier's characters cannot climb: one in five walks, as among the climbers, and the others stand.
fn beside(
    giants: &[Giant],
    count: usize,
) -> Result<(PhysicsWorld, Vec<Character>), Box<dyn Error>> {
    let mut world = valley::world();
    for giant in giants {
        world.insert_collider(still_mesh(&giant.surface)?, None);
    }
    world.detect_collisions(&(), &());
    let mut rng = fastrand::Rng::with_seed(10);
    let speed = long_climber().ground.walk_speed;
    let mut all = Vec::with_capacity(count);
    while all.len() < count {
        let surface = &giants[all.len() * giants.len() / count].surface;
        let triangle = TriangleId(rng.u32(0..surface.mesh().triangles().len() as u32));
        let seat = surface.anchor(triangle, [0.5, 0.25, 0.25])?;
        let skin = surface.in_world().motion(&seat, DT)?;
        let aside = DVec3::new(rng.f64() - 0.5, 0.0, rng.f64() - 0.5);
        if skin.normal.y > LEVEL {
            let above = skin.position + skin.normal * 0.45;
            let walks = PARTS[all.len() % PARTS.len()] == Part::Walks;
            let walk = aside.normalize_or(DVec3::X) * if walks { speed } else { 0.0 };
            all.push(Character::new(above.as_vec3(), walk.as_vec3()));
        }
    }
    Ok((world, all))
}

fn seated(herd: &Herd, count: usize) -> Result<Vec<Rider>, Box<dyn Error>> {
    let mut rng = fastrand::Rng::with_seed(9);
    let mut riders = Vec::with_capacity(count);
    while riders.len() < count {
        // The riders of a giant are side by side in the list, so that threads share few giants.
        let giant = riders.len() * herd.giants.len() / count;
        let part = PARTS[riders.len() % PARTS.len()];
        let (seat, up) = herd.seat(giant, &mut rng)?;
        let direction = DVec3::new(rng.f64() - 0.5, rng.f64() - 0.5, rng.f64() - 0.5);
        if part == Part::Climbs || f64::from(up) > LEVEL {
            riders.push(Rider {
                climber: Climber::new(long_climber(), DVec3::Y * 1e4)?,
                part,
                seat,
                direction: direction.normalize_or(DVec3::Y),
            });
        }
    }
    Ok(riders)
}

fn step(riders: &mut [Rider], giants: &[Giant], terrain: &RapierTerrain<'_>) -> Result<(), String> {
    riders.par_iter_mut().with_max_len(GRAIN).try_for_each_init(
        || {
            let ground = (ObstacleId(0), terrain as &dyn Obstacle);
            let ids = (1..).map(ObstacleId);
            let giants = giants.iter().map(|giant| &giant.surface as &dyn Obstacle);
            std::iter::once(ground)
                .chain(ids.zip(giants))
                .collect::<Vec<_>>()
        },
        |obstacles, rider| {
            let input = match rider.part {
                Part::Stands => ClimberInput::default(),
                Part::Walks => ClimberInput {
                    walk: rider.direction,
                    ..ClimberInput::default()
                },
                Part::Climbs => ClimberInput {
                    climb: rider.direction,
                    grip: true,
                    ..ClimberInput::default()
                },
            };
            let climber = &mut rider.climber;
            let stepped = climber.step_with(
                &input,
                obstacles,
                &StepRules::by(&|query| query.usual().with_grip(true)),
                DT,
            );
            stepped.map(drop).map_err(|error| error.to_string())
        },
    )
}
