//! A knockback is recorded with its tick, and a replay passes it to the climber again.

use std::convert::Infallible;

use clamber_climber::{Climber, ClimberConfig, ClimberInput, Knockback, StepReport, StepRules};
use clamber_record::{
    RecordOptions, RecordedTick, Recorder, Recording, RecordingInfo, ReplayError, Replayed,
    TickView, palette_fingerprint, replay,
};
use clamber_scenes::giant::giant;
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use crate::stage::{GROUND, terrain};

const DT: f64 = 1.0 / 60.0;

/// Length of the recording, ticks.
const TICKS: u64 = 90;

/// The tick in which the climber is struck.
const STRUCK: u64 = 40;

fn climber() -> Climber {
    Climber::new(ClimberConfig::colossus_climber(), DVec3::Y).unwrap()
}

fn step(climber: &mut Climber, input: &ClimberInput, knockback: Option<Knockback>) -> StepReport {
    let rules = StepRules {
        knockback,
        ..StepRules::default()
    };
    climber.step_with(input, &terrain(), &rules, DT).unwrap()
}

#[test]
fn a_climber_that_was_struck_is_struck_in_the_replay() {
    let blow = Knockback {
        velocity: DVec3::new(2.0, 1.0, -0.5),
        damage: 0.25,
        by: Some(GROUND),
    };
    let creature = giant().unwrap();
    let skeleton = &creature.rig.skeleton;
    let surface = SkinnedSurface::new(creature.rig.collider.clone());
    let palette = skeleton.palette(&skeleton.rest_pose()).unwrap();
    let info = RecordingInfo {
        creature: creature.name.clone(),
        creature_fingerprint: 0,
        tick_seconds: DT,
        climber: ClimberConfig::colossus_climber(),
        settings: Default::default(),
        version: RecordingInfo::VERSION.to_owned(),
    };
    let options = RecordOptions::waiting();
    let mut recorder = Recorder::new(Vec::new(), &info, skeleton, options).unwrap();
    let mut struck = climber();
    for tick in 1..=TICKS {
        let input = ClimberInput {
            walk: DVec3::X,
            ..ClimberInput::IDLE
        };
        let knockback = (tick == STRUCK).then_some(blow);
        let report = step(&mut struck, &input, knockback);
        let view = TickView {
            tick,
            input: &input,
            knockback,
            state: struck.state(),
            report: &report,
            surface: &surface,
            palette: &palette,
            scene_fingerprint: 0,
        };
        recorder.tick(&view).unwrap();
    }
    let recording = Recording::from_bytes(recorder.finish().unwrap()).unwrap();
    for tick in recording.ticks() {
        let tick = tick.unwrap();
        let expected = (tick.tick == STRUCK).then_some(blow);
        assert_eq!(tick.knockback, expected, "tick {}", tick.tick);
    }

    let replayed = |knockback: fn(&RecordedTick) -> Option<Knockback>| {
        let mut climber = climber();
        replay(recording.ticks(), |recorded| {
            step(&mut climber, &recorded.input, knockback(recorded));
            Ok::<_, Infallible>(Replayed {
                state: *climber.state(),
                palette_fingerprint: palette_fingerprint(&palette),
                scene_fingerprint: None,
            })
        })
    };
    assert_eq!(replayed(|recorded| recorded.knockback).unwrap(), TICKS);
    // With the input alone, the climber is not struck.
    match replayed(|_| None) {
        Err(ReplayError::Differs(difference)) => assert_eq!(difference.recorded.tick, STRUCK),
        other => panic!("no difference: {other:?}"),
    }
}
