//! Measures a creature's step, compared with sampling one clip and composing its palette.
//!
//! The giant is in the valley, with one person in front of it and another one on its back. All giants take turns, a
//! hundred ticks each, on one thread; a time is the median of the means over a hundred ticks. A step's time does not
//! include posing the skin: that is measured separately with the same palettes, and subtracted.
//!
//! - One giant walks about, one stands, one attacks again and again, and one is asleep.
//!
//! Prints a table and writes it to `target/measure/colossus.csv`: name, value, bound, holds.
//!
//! Run it with `cargo bench -p clamber_benches --bench colossus`; briefly with `-- --test`.

use std::error::Error;
use std::process::ExitCode;
use std::sync::Arc;

use clamber::mesh::TriangleId;
use clamber::rig::{Palette, Playback};
use clamber::surface::SkinnedSurface;
use clamber::world::{BodyPoses, MaterialPoint, Obstacle, RapierTerrain, WorldCapsule};
use clamber_colossus::{
    Brain, Creature, CreatureConfig, CreatureKind, Person, Riding, Surroundings,
};
use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief, mean_us, quantile};
use clamber_scenes::{giant, valley};
use glam::DVec3;

/// Ticks over which a time is averaged.
const TICKS: u32 = 100;

/// Length of a tick, seconds.
const DT: f64 = 1.0 / 60.0;

/// The measured giants: the name in the table, and the states of the giant's brain as JSON.
const LIVES: [(&str, &str); 4] = [
    (
        "walks",
        r#"{ "start": { "act": { "walk": { "to": "patrol", "within": 10 } }, "transitions": [
            { "to": "start", "when": ["done"] }] } }"#,
    ),
    (
        "stands",
        r#"{ "start": { "act": { "play": "idle" }, "gaze": "prey" } }"#,
    ),
    (
        "attacks",
        r#"{ "start": { "act": { "attack": { "clip": "stomp", "limb": ["foot.R", "toe.R"], "damage": 0.5, "throw": 9,
            "aim": 5 } }, "gaze": "prey", "transitions": [{ "to": "rests" }] },
            "rests": { "transitions": [{ "to": "start", "after": 0.5 }] } }"#,
    ),
    ("sleeps", r#"{ "start": { "act": "sleep" } }"#),
];

fn main() -> ExitCode {
    exit_code(run(is_brief()))
}

fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let rig = giant::model()?;
    let walk = rig.rig.clip("walk").ok_or("no walk")?;
    let (mut pose, mut palette, mut time) = (rig.rig.skeleton.rest_pose(), Palette::default(), 0.0);
    let mut sampling = || -> Result<(), Box<dyn Error>> {
        time += DT;
        walk.sample_into(time, Playback::Loop, &mut pose)?;
        rig.rig.skeleton.palette_into(&pose, &mut palette)?;
        Ok(())
    };
    let world = valley::world();
    let poses = BodyPoses::default();
    let terrain = RapierTerrain::of_world(&world, &poses);
    let terrain: [&dyn Obstacle; 1] = [&terrain];
    let mut lives = Vec::new();
    for (name, states) in LIVES {
        lives.push((name, Life::new(states)?, Vec::new(), Vec::new()));
    }
    let mut samplings = Vec::new();
    for _ in 0..if brief { 3 } else { 120 } {
        samplings.push(mean_us(TICKS, |_| sampling())?);
        for (_, life, steps, skins) in &mut lives {
            steps.push(mean_us(TICKS, |_| life.step(&terrain))?);
            skins.push(mean_us(TICKS, |_| life.pose_skin())?);
        }
    }
    let sampling = quantile(&mut samplings, 0.5);
    let mut cells = Cells::default();
    cells.value("one clip sampled and its palette composed, us", sampling);
    for (name, _, mut steps, mut skins) in lives {
        let skin = if name == "sleeps" {
            0.0
        } else {
            quantile(&mut skins, 0.5)
        };
        let step = quantile(&mut steps, 0.5) - skin;
        cells.value(&format!("a giant that {name}, us"), step);
        // The walking giant's bound is 4 instead of 3, since it also looks where it walks.
        let most = match name {
            "sleeps" => 0.1,
            "walks" => 4.0,
            _ => 3.0,
        };
        let ratio = format!("a giant that {name} / one clip and its palette");
        cells.push(&ratio, step / sampling, Bound::Most(most));
    }
    cells.finish("colossus", brief)
}

/// A giant, the people around it, and a second skin that is posed with its palettes.
struct Life {
    giant: Creature,
    skin: SkinnedSurface,
    people: [Person; 2],
}

impl Life {
    fn new(states: &str) -> Result<Self, Box<dyn Error>> {
        let text = std::fs::read_to_string(giant::brain_path())?;
        let mut file: serde_json::Value = serde_json::from_str(&text)?;
        file["start"] = "start".into();
        file["states"] = serde_json::from_str(states)?;
        let kind = CreatureKind::new(
            &giant::model()?.rig,
            Brain::from_json(&file.to_string(), DT)?,
        )?;
        let config = CreatureConfig {
            position: DVec3::Y * valley::height(0.0, 0.0),
            arena: 60.0,
            ..CreatureConfig::default()
        };
        let giant = Creature::new(Arc::new(kind), config)?;
        let body = |at: DVec3| WorldCapsule {
            ends: [at + DVec3::Y * 0.3, at + DVec3::Y * 1.45],
            radius: 0.3,
        };
        let back = MaterialPoint::on_triangle(TriangleId(0), [1.0 / 3.0; 3]);
        let people = [
            Person {
                id: 0,
                body: body(DVec3::new(-6.0, 0.0, 8.0)),
                riding: None,
            },
            Person {
                id: 1,
                body: body(DVec3::new(0.0, 30.0, 0.0)),
                riding: Some(Riding {
                    at: back,
                    hangs: false,
                }),
            },
        ];
        let skin = SkinnedSurface::new(Arc::clone(giant.kind().mesh()));
        Ok(Self {
            giant,
            skin,
            people,
        })
    }

    fn step(&mut self, terrain: &[&dyn Obstacle]) -> Result<(), Box<dyn Error>> {
        let around = Surroundings {
            terrain,
            people: &self.people,
            ..Surroundings::default()
        };
        self.giant.step(&around)?;
        Ok(())
    }

    fn pose_skin(&mut self) -> Result<(), Box<dyn Error>> {
        let world_from_model = *self.giant.surface().world_from_model();
        self.skin.advance(self.giant.palette(), world_from_model)?;
        Ok(())
    }
}
