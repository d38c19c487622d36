//! A third-party creature lives at 20 m by a brain of some fifty lines.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::support::{TICK, level_ground, person, rider, test_rig, with_people};
use clamber_colossus::{Brain, Creature, CreatureConfig, CreatureKind, Person};
use clamber_surface::mesh::TriangleId;
use glam::DVec3;

/// Height to which the Trex is scaled, metres.
const HEIGHT: f64 = 20.0;

fn kind() -> Option<Arc<CreatureKind>> {
    let rig = test_rig("Trex.glb")?;
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/trex.brain.json");
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.lines().count() <= 60);
    let brain = Brain::from_json(&text, TICK).unwrap();
    Some(Arc::new(CreatureKind::new(&rig, brain).unwrap()))
}

#[test]
fn it_strolls_hunts_bites_and_shakes_its_rider() {
    let Some(kind) = kind() else {
        return;
    };
    let config = CreatureConfig {
        scale: HEIGHT / kind.height(),
        ..CreatureConfig::default()
    };
    let mut trex = Creature::new(Arc::clone(&kind), config).unwrap();
    let terrain = level_ground();
    let mut seen = BTreeSet::new();
    let mut far = 0f64;
    let mut live = |trex: &mut Creature, people: &[Person], seconds: f64| {
        for _ in 0..(seconds / TICK) as u32 {
            trex.step(&with_people(&terrain, people)).unwrap();
            let state = trex.state();
            assert!(state.position().is_finite() && state.position().y.abs() < 1.0);
            far = far.max(state.position().length());
            seen.insert(kind.brain().path(state.current()).to_owned());
        }
    };
    live(&mut trex, &[], 40.0);
    // The prey is in the view of the Trex.
    let yaw = trex.state().yaw() + 0.4;
    let ahead = DVec3::new(libm::sin(yaw), 0.0, libm::cos(yaw));
    let prey = trex.state().position() + ahead * 45.0;
    live(&mut trex, &[person(prey)], 60.0);
    let reached = trex.state().position().distance(prey);
    let rider = rider(trex.state().position() + DVec3::Y * HEIGHT, TriangleId(0));
    live(&mut trex, &[rider], 10.0);
    for state in [
        "calm/idle",
        "calm/patrol",
        "hunt/notice",
        "hunt/chase",
        "hunt/bite",
        "shake",
    ] {
        let path = format!("alive/{state}");
        assert!(seen.contains(&path), "{path} not in {seen:?}");
    }
    assert!(far > 10.0, "it went {far} m");
    assert!(reached < 20.0, "{reached} m from its prey");
}
