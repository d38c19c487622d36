//! The giant of `assets/` on level ground: it walks where it means to, its feet stand, and it strikes by touch.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::sync::Arc;

use clamber_colossus::{
    Brain, Creature, CreatureConfig, CreatureKind, CreatureParts, CreatureState, Surroundings,
};
use clamber_world::{HalfSpace, Obstacle};

const TICK: f64 = 1.0 / 60.0;

const BRAIN: &str = r#"{
  "body": {
    "legs": [
      { "joints": ["thigh.L", "shin.L", "foot.L"], "toe": "toe.L" },
      { "joints": ["thigh.R", "shin.R", "foot.R"], "toe": "toe.R" }
    ],
    "gait": { "idle": "idle", "walk": "walk", "speed": 5, "turn_deg": 15, "steer_deg": 8 },
    "head": { "joints": [["head", 0.4], ["neck.2", 0.4], ["neck.1", 1]] }
  },
  "start": "rests",
  "states": {
    "rests": { "act": { "play": "idle" }, "gaze": "around", "transitions": [{ "to": "roams", "after": 2 }] },
    "roams": { "act": { "walk": { "to": "patrol", "within": 10 } }, "transitions": [
      { "to": "rests", "when": ["done"] }
    ] }
  }
}"#;

fn giant() -> Creature {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb");
    let rig = clamber_gltf::load(path).unwrap();
    let parts = CreatureParts {
        skeleton: rig.skeleton,
        clips: rig.clips,
        mesh: rig.collider,
        weak_points: rig.weak_points,
    };
    let kind = CreatureKind::new(parts, Brain::from_json(BRAIN, TICK).unwrap()).unwrap();
    Creature::new(
        Arc::new(kind),
        CreatureConfig {
            seed: 3,
            ..CreatureConfig::default()
        },
    )
    .unwrap()
}

#[test]
fn it_walks_and_its_feet_stand() {
    let ground = HalfSpace::below(0.0);
    let terrain: [&dyn Obstacle; 1] = [&ground];
    let around = Surroundings {
        terrain: &terrain,
        ..Surroundings::default()
    };
    let mut giant = giant();
    let (mut walked, mut plants, mut fastest, mut slides) = (0.0, 0, 0f64, Vec::new());
    let balls = ["toe.L", "toe.R"].map(|name| giant.kind().skeleton().find(name).unwrap());
    let mut before: Option<[glam::DVec3; 2]> = None;
    for _ in 0..60 * 60 {
        let from = giant.state().position();
        let report = giant.step(&around).unwrap();
        plants += report
            .events
            .iter()
            .filter(|event| matches!(event, clamber_colossus::CreatureEvent::Plant { .. }))
            .count();
        let way = giant.state().position() - from;
        walked += way.length();
        fastest = fastest.max(way.length() / TICK);
        let world = giant.surface().world_from_model();
        let now = balls.map(|ball| {
            world.transform_point(giant.palette().model_from_joint(ball).unwrap().translation)
        });
        if let Some(before) = before {
            for foot in 0..2 {
                // The lower foot stands.
                if now[foot].y <= now[1 - foot].y {
                    slides.push((now[foot] - before[foot]).length() / TICK);
                }
            }
        }
        before = Some(now);
    }
    slides.sort_by(f64::total_cmp);
    let median = slides[slides.len() / 2];
    assert!(
        walked > 60.0 && fastest < 5.2 && plants > 10,
        "{walked} m, {fastest} m/s, {plants} plants"
    );
    assert!(
        median < 0.02,
        "planted balls slide at a median of {median} m/s"
    );
    assert!(
        giant.state().position().y.abs() < 0.05,
        "{}",
        giant.state().position()
    );
}

/// Scene B48, for a whole creature: saved and loaded, it goes on with the same bits.
#[test]
fn a_saved_creature_goes_on_with_the_same_bits() {
    let ground = HalfSpace::below(0.0);
    let terrain: [&dyn Obstacle; 1] = [&ground];
    let around = Surroundings {
        terrain: &terrain,
        ..Surroundings::default()
    };
    let (mut giant, mut other) = (giant(), giant());
    for tick in 0..600 {
        giant.step(&around).unwrap();
        if tick % 97 == 0 {
            let text = serde_json::to_string(giant.state()).unwrap();
            let state: CreatureState = serde_json::from_str(&text).unwrap();
            assert_eq!(&state, giant.state(), "tick {tick}");
            other.restore(state).unwrap();
        } else if tick > 97 {
            other.step(&around).unwrap();
            assert_eq!(other.state(), giant.state(), "tick {tick}");
            assert_eq!(other.palette(), giant.palette(), "tick {tick}");
        }
    }
}
