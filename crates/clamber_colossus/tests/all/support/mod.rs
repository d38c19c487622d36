//! The giant of `assets/` with a brain, ground to walk on, and measurements of its skin.

#![allow(
    dead_code,
    clippy::unwrap_used,
    reason = "helpers of tests, of which each file uses some"
)]

pub(crate) mod life;

use std::io::Write;
use std::path::PathBuf;
use std::sync::{Arc, LazyLock};

use clamber_animation::rig::JointId;
use clamber_colossus::{
    Brain, ColossusError, Creature, CreatureConfig, CreatureKind, Noise, Person, Riding,
    Surroundings,
};
use clamber_surface::geometry::WorldCapsule;
use clamber_surface::mesh::{Rig, TriangleId, VertexId};
use clamber_world::rapier3d::parry::utils::Array2;
use clamber_world::rapier3d::prelude::{
    ColliderBuilder, ColliderHandle, PhysicsWorld, Pose, Real, SharedShape, Vector,
};
use clamber_world::{BodyPoses, HalfSpace, MaterialPoint, Obstacle, RapierTerrain};
use glam::DVec3;

/// Tick length, seconds.
pub(crate) const TICK: f64 = 1.0 / 60.0;

/// True if tests that have short forms run all of their cases, as `cargo xtask nightly` does.
pub(crate) fn all_cases() -> bool {
    std::env::var_os("CLAMBER_ALL_CASES").is_some()
}

/// The giant's own brain.
pub(crate) fn brain_file() -> String {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../assets/colossus.brain.json"
    );
    std::fs::read_to_string(path).unwrap()
}

/// The giant's own brain with another start and other states.
pub(crate) fn brain_with(start: &str, states: &str) -> String {
    let mut file: serde_json::Value = serde_json::from_str(&brain_file()).unwrap();
    file["start"] = start.into();
    file["states"] = serde_json::from_str(states).unwrap();
    file.to_string()
}

/// The giant with this brain.
pub(crate) fn kind(brain: &str) -> Arc<CreatureKind> {
    Arc::new(try_kind(brain).unwrap())
}

/// The giant with this brain, and with this tick length.
pub(crate) fn kind_at(brain: &str, tick: f64) -> Arc<CreatureKind> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb");
    let rig = clamber_gltf::load(path).unwrap().rig;
    let brain = Brain::from_json(brain, tick).unwrap();
    Arc::new(CreatureKind::new(&rig, brain).unwrap())
}

/// The giant with this brain; an error if the brain does not fit it.
pub(crate) fn try_kind(brain: &str) -> Result<CreatureKind, ColossusError> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb");
    kind_of(&clamber_gltf::load(path).unwrap().rig, brain)
}

/// A creature of an imported file with this brain; an error if the brain does not fit it.
pub(crate) fn kind_of(rig: &Rig, brain: &str) -> Result<CreatureKind, ColossusError> {
    let brain = Brain::from_json(brain, TICK).unwrap();
    CreatureKind::new(rig, brain)
}

pub(crate) fn creature(kind: &Arc<CreatureKind>, config: CreatureConfig) -> Creature {
    Creature::new(Arc::clone(kind), config).unwrap()
}

/// Ground whose height is a function of x and z, 400 m wide, with cells of 1 m.
pub(crate) fn ground(height: impl Fn(f64, f64) -> f64) -> PhysicsWorld {
    /// Number of cells along each side.
    const CELLS: usize = 400;
    let samples = CELLS + 1;
    let place = |index: usize| index as f64 - 0.5 * CELLS as f64;
    let heights: Vec<Real> = (0..samples * samples)
        .map(|index| height(place(index / samples), place(index % samples)) as Real)
        .collect();
    let scale = Vector::new(CELLS as Real, 1.0, CELLS as Real);
    let mut world = PhysicsWorld::default();
    let field = ColliderBuilder::heightfield(Array2::new(samples, samples, heights), scale);
    world.insert_collider(field, None);
    world.detect_collisions(&(), &());
    world
}

/// A world of rapier as terrain. Nothing in it moves.
pub(crate) fn terrain_of(world: &PhysicsWorld) -> RapierTerrain<'_> {
    static STILL: BodyPoses = BodyPoses::new();
    RapierTerrain::of_world(world, &STILL)
}

/// Adds a block of rock with its centre at `at` and the half extents `half`.
pub(crate) fn add_block(world: &mut PhysicsWorld, at: DVec3, half: DVec3) -> ColliderHandle {
    let [x, y, z] = half.as_vec3().to_array();
    let place = Pose::from_translation(at.as_vec3());
    let block = world.insert_collider(ColliderBuilder::cuboid(x, y, z).position(place), None);
    world.detect_collisions(&(), &());
    block
}

/// The place of a joint of a creature in the world.
pub(crate) fn joint_place(creature: &Creature, joint: JointId) -> DVec3 {
    let frame = creature.palette().model_from_joint(joint).unwrap();
    let world = creature.surface().world_from_model();
    world.transform_point(frame.translation)
}

/// Adds balls of rock. Each has a place on the ground, a radius, and a height by which it stands out of the ground,
/// metres.
pub(crate) fn add_boulders(world: &mut PhysicsWorld, places: &[(DVec3, f64, f64)]) {
    for (place, radius, out) in places {
        let center = *place + DVec3::Y * (out - radius);
        let ball = ColliderBuilder::new(SharedShape::ball(*radius as Real))
            .position(Pose::from_translation(center.as_vec3()));
        world.insert_collider(ball, None);
    }
    world.detect_collisions(&(), &());
}

/// Strews 600 boulders over a square of 250 m. They stand out by 0.5 to 2 m.
pub(crate) fn strew_boulders(world: &mut PhysicsWorld, seed: u64) {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut lot = |from: f64, to: f64| from + (to - from) * random.f64();
    let places: Vec<_> = (0..600)
        .map(|_| {
            let place = DVec3::new(lot(-125.0, 125.0), 0.0, lot(-125.0, 125.0));
            (place, lot(3.0, 4.5), lot(0.5, 2.0))
        })
        .collect();
    add_boulders(world, &places);
}

/// The sole of a foot: the triangles of its rigid skin that are near the ground at rest, and their length along Z,
/// metres.
pub(crate) struct Sole {
    pub(crate) triangles: Vec<[VertexId; 3]>,
    pub(crate) length: f64,
}

pub(crate) fn sole(kind: &CreatureKind, ankle: &str) -> Sole {
    let skeleton = kind.skeleton();
    let ankle = skeleton.find(ankle).unwrap();
    let mesh = kind.mesh();
    let place = |vertex: VertexId| mesh.positions()[vertex.0 as usize].as_dvec3();
    let is_rigid = |vertex: VertexId| {
        let influences = mesh.influences(vertex);
        let ours = influences.filter(|(joint, _)| skeleton.is_descendant_or_self(*joint, ankle));
        ours.map(|(_, weight)| weight).sum::<f32>() > 0.99
    };
    let all = (0..mesh.positions().len() as u32).map(VertexId);
    let foot: Vec<VertexId> = all.filter(|vertex| is_rigid(*vertex)).collect();
    let lowest = foot
        .iter()
        .map(|v| place(*v).y)
        .fold(f64::INFINITY, f64::min);
    let is_sole = |vertex: &VertexId| is_rigid(*vertex) && place(*vertex).y < lowest + 0.36;
    let triangles = mesh.triangles().iter().copied();
    let triangles: Vec<[VertexId; 3]> = triangles
        .filter(|corners| corners.iter().all(is_sole))
        .collect();
    let along = || triangles.iter().flatten().map(|vertex| place(*vertex).z);
    let length = along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min);
    Sole { triangles, length }
}

/// Acceleration as riders feel it: filtered over 0.1 s, like the shake of a climber.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Feel {
    before: Option<[DVec3; 2]>,
    felt: DVec3,
}

impl Feel {
    /// Takes the next place. Returns the acceleration that is felt there, m/s^2.
    pub(crate) fn step(&mut self, place: DVec3) -> f64 {
        let acceleration = self.raw(place);
        self.filter(acceleration)
    }

    /// Takes the next place. Returns its acceleration without a filter, m/s^2.
    pub(crate) fn raw(&mut self, place: DVec3) -> DVec3 {
        let Some([from, velocity]) = self.before else {
            self.before = Some([place, DVec3::NAN]);
            return DVec3::ZERO;
        };
        let now = (place - from) / TICK;
        self.before = Some([place, now]);
        if velocity.is_nan() {
            DVec3::ZERO
        } else {
            (now - velocity) / TICK
        }
    }

    /// Takes the next acceleration. Returns the felt one, m/s^2.
    pub(crate) fn filter(&mut self, acceleration: DVec3) -> f64 {
        let keep = libm::exp(-TICK / 0.1);
        self.felt = self.felt * keep + acceleration * (1.0 - keep);
        self.felt.length()
    }
}

/// A person of 1.75 m that stands at a place.
pub(crate) fn person(at: DVec3) -> Person {
    Person {
        id: 1,
        body: WorldCapsule {
            ends: [at + DVec3::Y * 0.3, at + DVec3::Y * 1.45],
            radius: 0.3,
        },
        riding: None,
    }
}

/// The folder of the models of the test data. Without the data, prints that a test was skipped, and returns `None`.
pub(crate) fn test_models(test: &str) -> Option<PathBuf> {
    let Some(root) = std::env::var_os("CLAMBER_TEST_DATA") else {
        let folder = "the folder that holds models/Trex.glb";
        // Not by `eprintln`: the test harness hides its output when the test passes.
        let line = format!("SKIPPED {test}: set CLAMBER_TEST_DATA to {folder}\n");
        let _ = std::io::stderr().write_all(line.as_bytes());
        return None;
    };
    Some(PathBuf::from(root).join("models"))
}

/// A skeleton, clips and a skin of the test data; `None`, with a note, without the data.
pub(crate) fn test_rig(file: &str) -> Option<Rig> {
    let path = test_models(file)?.join(file);
    Some(clamber_gltf::load(path).unwrap().rig)
}

/// A person that rides a creature, on one of the skin's triangles.
pub(crate) fn rider(at: DVec3, triangle: TriangleId) -> Person {
    Person {
        riding: Some(Riding {
            at: MaterialPoint::on_triangle(triangle, [1.0 / 3.0; 3]),
            hangs: false,
        }),
        ..person(at)
    }
}

/// A noise that is heard from afar.
pub(crate) fn noise(place: DVec3) -> Noise {
    Noise {
        place,
        loudness: 5.0,
    }
}

/// Level ground at a height of 0.
pub(crate) fn level_ground() -> [&'static dyn Obstacle; 1] {
    static GROUND: LazyLock<HalfSpace> = LazyLock::new(|| HalfSpace::below(0.0));
    [&*GROUND]
}

/// Terrain alone.
pub(crate) fn on_terrain<'a>(terrain: &'a [&'a dyn Obstacle]) -> Surroundings<'a> {
    with_people(terrain, &[])
}

/// Terrain and people.
pub(crate) fn with_people<'a>(
    terrain: &'a [&'a dyn Obstacle],
    people: &'a [Person],
) -> Surroundings<'a> {
    Surroundings {
        terrain,
        people,
        ..Surroundings::default()
    }
}

/// Terrain and noises.
pub(crate) fn with_noises<'a>(
    terrain: &'a [&'a dyn Obstacle],
    noises: &'a [Noise],
) -> Surroundings<'a> {
    Surroundings {
        noises,
        ..on_terrain(terrain)
    }
}
