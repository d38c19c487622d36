//! Plates stagger the creature, break, and drop the climbers on them. Weak points open in their order. Scene B47.

use std::sync::Arc;

use clamber_animation::rig::{Joint, JointId, Skeleton, Transform, WeakPoint};
use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberMode};
use clamber_colossus::{
    Brain, Creature, CreatureConfig, CreatureEvent, CreatureKind, CreatureState, Sense,
    Surroundings,
};
use clamber_surface::geometry::Affine;
use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, MeshSource, Rig, SurfaceKind, SurfaceTag, TriangleId,
};
use clamber_world::{MaterialPoint, Obstacle, ObstacleId};
use glam::{DVec3, Vec3};

/// Tick length, seconds.
const TICK: f64 = 1.0 / 60.0;

/// Cells of the plate along each side: it has 2 * 32 * 32 triangles.
const CELLS: u32 = 32;

/// A brain whose plate staggers the creature at a damage of 2 and breaks after three staggers, as JSON.
const BRAIN: &str = r#"{
  "body": { "plates": [{ "name": "shell", "user": 7, "stagger": 2, "count": 3 }] },
  "senses": ["storm"],
  "start": "lies",
  "states": {
    "lies": { "transitions": [{ "to": "reels", "when": ["staggered"] }] },
    "reels": { "transitions": [{ "to": "lies", "after": 0.5 }] }
  }
}"#;

/// A level slab of fur, and a plate of stone half a metre above it, on one joint, with two weak points.
fn slab() -> Creature {
    slab_with_plate(CELLS)
}

/// The same; only the first rows of its stone belong to the plate.
fn slab_with_plate(rows: u32) -> Creature {
    let (mut positions, mut triangles, mut tags) = (Vec::new(), Vec::new(), Vec::new());
    for (height, kind, user) in [(0.0, SurfaceKind::Fur, 0), (0.5, SurfaceKind::Stone, 7)] {
        let first = positions.len() as u32;
        for row in 0..=CELLS {
            for column in 0..=CELLS {
                let place = |index: u32| (index as f32 / CELLS as f32 - 0.5) * 8.0;
                positions.push(Vec3::new(place(column), height, place(row)));
            }
        }
        for row in 0..CELLS {
            for column in 0..CELLS {
                let a = first + row * (CELLS + 1) + column;
                let (b, c, d) = (a + 1, a + CELLS + 1, a + CELLS + 2);
                triangles.extend([[a, c, d], [a, d, b]]);
                let user = if row < rows { user } else { 0 };
                tags.extend([SurfaceTag::new(kind).with_user(user); 2]);
            }
        }
    }
    let source = MeshSource {
        tags: &tags,
        ..MeshSource::rigid(&positions, &triangles)
    };
    let mesh = ColliderMesh::build(&source, &ColliderBuildOptions::default())
        .unwrap()
        .0;
    let root = Joint {
        name: "root".into(),
        parent: None,
        rest: Transform::IDENTITY,
        inverse_bind: Affine::IDENTITY,
    };
    let point = |name: &str, x: f32, order: u32| {
        let mut point = WeakPoint::new(name, JointId(0), Vec3::new(x, 0.0, 0.0));
        (point.radius, point.hit_points, point.order) = (0.5, 2.0, order);
        point
    };
    let mut rig = Rig::new(Skeleton::new(vec![root]).unwrap(), Arc::new(mesh));
    rig.weak_points = vec![point("first", -3.0, 0), point("second", 3.0, 1)];
    let kind = CreatureKind::new(&rig, Brain::from_json(BRAIN, TICK).unwrap()).unwrap();
    Creature::new(Arc::new(kind), CreatureConfig::default()).unwrap()
}

/// Strikes the middle of a triangle.
fn strike(slab: &mut Creature, triangle: u32, place: DVec3, damage: f64) -> f64 {
    let at = MaterialPoint::on_triangle(TriangleId(triangle), [1.0 / 3.0; 3]);
    slab.hurt(&at, place, damage)
}

/// Index of the plate's first triangle: the triangles of the slab come before it.
const PLATE: u32 = 2 * CELLS * CELLS;

#[test]
fn a_plate_breaks_after_three_staggers_and_drops_who_stands_on_it() {
    let mut slab = slab();
    let around = Surroundings::default();
    let mut climber =
        Climber::new(ClimberConfig::colossus_climber(), DVec3::new(0.1, 1.2, 0.1)).unwrap();
    let mut step = |slab: &mut Creature, grip: bool| {
        let events = slab.step(&around).unwrap().events.clone();
        let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(1), slab.surface())];
        let input = ClimberInput {
            grip,
            ..ClimberInput::default()
        };
        climber.step(&input, &obstacles, TICK).unwrap();
        (events, climber.state().mode, climber.state().position.y)
    };
    for _ in 0..60 {
        step(&mut slab, false);
    }
    assert_eq!(step(&mut slab, false).1, ClimberMode::Standing);
    for stagger in 1..=3 {
        // A damage of 1.5 is too little for a stagger, and damage beyond a stagger is not kept for the next one.
        assert_eq!(strike(&mut slab, PLATE, DVec3::Y * 0.5, 1.5), 0.0);
        let (events, ..) = step(&mut slab, false);
        assert!(events.is_empty(), "{events:?}");
        strike(&mut slab, PLATE, DVec3::Y * 0.5, 9.0);
        assert_eq!(slab.state().plate(0), 3 - stagger);
        let (events, mode, _) = step(&mut slab, false);
        let breaks = stagger == 3;
        assert!(
            events.contains(&CreatureEvent::Staggered { plate: 0, breaks }),
            "{events:?}"
        );
        assert_eq!(slab.state().senses().get(Sense::Staggered), 1.0);
        if !breaks {
            assert_eq!(mode, ClimberMode::Standing);
        }
    }
    // The climber falls within two ticks. It lands on the fur below, which it can grip.
    let (_, mode, _) = step(&mut slab, true);
    assert_ne!(
        mode,
        ClimberMode::Standing,
        "stands on a plate that is gone"
    );
    let mut modes = Vec::new();
    for _ in 0..40 {
        modes.push(step(&mut slab, true).1);
    }
    assert!(modes.contains(&ClimberMode::Holding), "{modes:?}");
    assert_eq!(slab.state().senses().get(Sense::Plates), 0.0);
}

#[test]
fn a_restored_plate_is_whole_again() {
    let mut slab = slab();
    let whole: CreatureState = slab.state().clone();
    for _ in 0..3 {
        strike(&mut slab, PLATE, DVec3::Y * 0.5, 2.0);
    }
    let is_there = |slab: &Creature| slab.surface().is_enabled(TriangleId(PLATE));
    assert!(!is_there(&slab));
    let broken = slab.state().clone();
    slab.restore(whole).unwrap();
    assert!(is_there(&slab));
    slab.restore(broken).unwrap();
    assert!(!is_there(&slab));
}

#[test]
fn kinds_with_other_plates_are_told_apart() {
    let kind = |rows| slab_with_plate(rows).kind().fingerprint();
    assert_eq!(kind(CELLS), kind(CELLS));
    assert_ne!(kind(CELLS), kind(CELLS - 1));
}

#[test]
fn a_sense_that_is_not_finite_is_refused_and_changes_nothing() {
    let mut slab = slab();
    assert!(slab.set_sense("storm", 3.0));
    let before = slab.state().clone();
    for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(!slab.set_sense("storm", wrong));
    }
    assert!(!slab.set_sense("rain", 1.0));
    assert_eq!(*slab.state(), before);
    slab.restore(before).unwrap();
}

#[test]
fn weak_points_open_in_their_order() {
    let mut slab = slab();
    let [first, second] = [-3.0, 3.0].map(|x| DVec3::new(x, 0.0, 0.0));
    // Strikes the point of the skin that is nearest to a place.
    let hurt = |slab: &mut Creature, place: DVec3, damage: f64| {
        let hit = slab.surface().in_world().closest_point(place, 1.0).unwrap();
        let at = MaterialPoint::on_triangle(hit.triangle, hit.barycentric);
        slab.hurt(&at, place, damage)
    };
    assert!(slab.is_open(0) && !slab.is_open(1));
    assert_eq!(hurt(&mut slab, second, 1.0), 0.0);
    // Damage beyond the hit points of one weak point is not passed on to the next.
    assert_eq!(hurt(&mut slab, first, 5.0), 2.0);
    assert!(!slab.is_open(0) && slab.is_open(1));
    assert_eq!(hurt(&mut slab, second, 1.0), 1.0);
    assert_eq!(slab.state().hit_points(), [0.0, 1.0]);
    // Invalid damage changes nothing.
    for damage in [f64::NAN, f64::INFINITY, -1.0] {
        assert_eq!(hurt(&mut slab, second, damage), 0.0);
    }
    assert_eq!(strike(&mut slab, u32::MAX, second, 1.0), 0.0);
    assert_eq!(slab.state().hit_points(), [0.0, 1.0]);
}
