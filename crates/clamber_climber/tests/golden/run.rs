//! The run: a tube crawls 100 km from the world's origin, with climbers on it and queries all over it.

use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberState, StepRules};
use clamber_surface::SimdLevel;
use clamber_surface::geometry::{Affine, Capsule, Ray, Similarity, rotation_from_axis_angle};
use clamber_surface::mesh::TriangleId;
use clamber_surface::rig::{Palette, Playback};
use clamber_surface::surface::{CastOptions, SkinnedSurface};
use clamber_world::{Obstacle, ObstacleId};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use clamber_verify::golden::GoldenRun;

use crate::bits::Bits;
use crate::creature::{JOINTS, clip, ground, skeleton, tube};

/// Length of the run, ticks.
const TICKS: u32 = 150;

/// Length of a tick, seconds.
const TICK: f64 = 1.0 / 60.0;

/// Number of climbers.
const CLIMBERS: u32 = 24;

/// Number of queries in a tick.
const QUERIES: u64 = 96;

/// Id of the tube as an obstacle.
const TUBE: ObstacleId = ObstacleId(1);

/// The place of the run in the world, metres: far from the origin.
const PLACE: DVec3 = DVec3::new(1e5, 40.0, -3e4);

/// Metres per unit of the model.
const SCALE: f64 = 4.0;

/// Plays the run.
pub(crate) fn play(run: &mut GoldenRun, level: SimdLevel, threads: usize) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let pool = pool.build().unwrap();
    pool.install(|| play_on_these_threads(run, level));
}

fn play_on_these_threads(run: &mut GoldenRun, level: SimdLevel) {
    let (skeleton, clip) = (skeleton(), clip());
    let mut surface = SkinnedSurface::with_simd_level(tube(), level);
    let mut floor = SkinnedSurface::with_simd_level(ground(), level);
    let under = Similarity::from_translation(PLACE - DVec3::Y * 7.0);
    floor
        .teleport(&Palette::from_matrices([Affine::IDENTITY]), under)
        .unwrap();
    let mut climbers: Vec<Climber> = (0..CLIMBERS).map(climber).collect();
    let mut positions = Vec::new();
    let mut carried = 0;
    for tick in 0..TICKS {
        let time = f64::from(tick) * TICK;
        let pose = clip
            .sample(&skeleton.rest_pose(), time, Playback::Loop)
            .unwrap();
        let palette = skeleton.palette(&pose).unwrap();
        if tick == 0 {
            surface.teleport(&palette, place(time)).unwrap();
        } else {
            surface.advance(&palette, place(time)).unwrap();
        }
        let asked: Vec<u64> = (0..QUERIES)
            .into_par_iter()
            .map(|index| ask(&surface, u64::from(tick) * QUERIES + index))
            .collect();
        for (index, bits) in asked.into_iter().enumerate() {
            run.field(&format!("query {index}"), bits);
        }
        let states = climbers.par_iter_mut().enumerate().map(|(index, climber)| {
            let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
                [(ObstacleId(0), &floor), (TUBE, &surface)];
            let input = input(index, tick);
            climber
                .step_with(
                    &input,
                    &obstacles,
                    &StepRules::by(&|query| query.usual().with_grip(true)),
                    TICK,
                )
                .unwrap();
            *climber.state()
        });
        let states: Vec<_> = states.collect();
        for (index, state) in states.iter().enumerate() {
            run.field(&format!("climber {index}"), state.fingerprint());
            run.fields(&format!("climber {index}'s "), state);
        }
        let on_tube =
            |state: &&ClimberState| state.support.is_some_and(|s| s.attachment.obstacle == TUBE);
        carried += states.iter().filter(on_tube).count();
        // Includes the vertices that queries did not touch.
        surface.skin_all(&mut positions);
        let mut bits = Bits::default();
        bits.positions(&positions);
        run.field("vertices", bits.finish());
        run.end_tick();
    }
    // Otherwise the hashes would cover few ticks on the tube.
    assert!(carried > 400, "{carried} ticks of climbers on the tube");
}

/// Pose of the tube's root, which crawls, turns and rolls.
fn place(time: f64) -> Similarity {
    let turn = rotation_from_axis_angle(DVec3::Y, 0.2 * time);
    let roll = rotation_from_axis_angle(DVec3::X, 0.1 * libm::sin(3.0 * time));
    Similarity {
        rotation: turn * roll,
        scale: SCALE,
        translation: PLACE + DVec3::X * (2.0 * time),
    }
}

/// A climber above the tube.
fn climber(index: u32) -> Climber {
    let along = (f64::from(index) + 0.5) / f64::from(CLIMBERS) * f64::from(JOINTS - 1);
    let above = DVec3::new(SCALE * along, 7.0, 0.1 * f64::from(index % 5));
    let config = if grips(index) {
        ClimberConfig::colossus_climber()
    } else {
        ClimberConfig::walker()
    };
    Climber::new(config, PLACE + above).unwrap()
}

/// True for every third climber, which grips and climbs.
fn grips(index: u32) -> bool {
    index.is_multiple_of(3)
}

/// Half of the climbers stand or hold still; the others move about and sometimes jump.
fn input(index: usize, tick: u32) -> ClimberInput {
    let index = index as u32;
    let grip = grips(index);
    if index.is_multiple_of(2) {
        return ClimberInput {
            grip,
            ..ClimberInput::default()
        };
    }
    let angle = f64::from(index + tick / 40);
    ClimberInput {
        walk: DVec3::new(libm::cos(angle), 0.0, libm::sin(angle)),
        jump: (tick + 7 * index).is_multiple_of(50),
        grip,
        ..ClimberInput::default()
    }
}

/// One query of each kind, generated from its number. Returns the hash of the results.
fn ask(surface: &SkinnedSurface, number: u64) -> u64 {
    let mut rng = fastrand::Rng::with_seed(number);
    let mut point = |size: f32| {
        let mut share = || size * (2.0 * rng.f32() - 1.0);
        Vec3::new(7.5 + 7.0 * share(), share(), share())
    };
    let (from, to) = (point(3.0), point(1.2));
    let space = surface.in_model();
    let mut bits = Bits::default();
    let ray = Ray::new(from, to - from).unwrap();
    bits.hits(&space.cast_ray(&ray, 20.0));
    let (mut hits, mut sweeps) = (Vec::new(), Vec::new());
    space.cast_ray_all(&ray, 20.0, &mut hits);
    bits.hits(&hits);
    bits.hits(&space.closest_point(from, 5.0));
    let sphere = Capsule::ball(to, 0.2).unwrap();
    space.overlap_capsule(&sphere, &mut hits);
    bits.hits(&hits);
    let capsule = Capsule::new(to, to + Vec3::Y * 0.3, 0.1).unwrap();
    space.overlap_capsule(&capsule, &mut hits);
    bits.hits(&hits);
    let sphere = Capsule::ball(from, 0.1).unwrap();
    let (still, moving) = (
        CastOptions::STILL.with_tolerance(1e-4),
        CastOptions::MOVING.with_tolerance(1e-4),
    );
    bits.sweeps(&space.cast_capsule(&sphere, [to - from; 2], &still));
    space.cast_capsule_all(&sphere, [to - from; 2], &moving, &mut sweeps);
    bits.sweeps(&sweeps);
    let capsule = Capsule::new(from, from + Vec3::Y * 0.3, 0.1).unwrap();
    bits.sweeps(&space.cast_capsule(&capsule, [to - from, Vec3::Y], &moving));
    let triangle = TriangleId((number % surface.mesh().triangles().len() as u64) as u32);
    let anchor = surface.anchor(triangle, [0.5, 0.25, 0.25]).unwrap();
    bits.motion(&surface.in_model().motion(&anchor, TICK).unwrap());
    bits.finish()
}
