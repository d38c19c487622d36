//! Records drawn figures.

use std::collections::HashMap;

use clamber_record::{
    Ending, FigureView, RecordError, RecordOptions, Recorder, Recording, RecordingInfo, TickView,
    creature_fingerprint, topics,
};
use clamber_scenes::battle::{Battle, BattleOptions, TICK};
use clamber_scenes::giant::giant;
use clamber_scenes::hero::Hero;
use clamber_surface::geometry::Similarity;
use clamber_surface::rig::{JointId, Palette};
use foxglove::messages::FrameTransforms;
use glam::{DQuat, DVec3};
use prost::Message;

use crate::stage::Disk;

/// Records `ticks` ticks of a ride with its hero drawn at `scale`. Returns the file, and for each tick the places of
/// the hero's joints in the world.
fn record(ticks: u64, scale: f64) -> (Vec<u8>, Vec<Vec<DVec3>>) {
    let creature = giant().unwrap();
    let options = BattleOptions::ride(0, 1);
    let mut battle = Battle::new(&creature, &options).unwrap();
    let mut hero = Hero::load().unwrap();
    let mut recorder = recorder(&battle);
    let mut places = Vec::new();
    for tick in 0..ticks {
        battle.step(options.input_at(tick)).unwrap();
        hero.watch(&battle, TICK).unwrap();
        recorder.tick(&view(&battle)).unwrap();
        let figure = FigureView {
            world_from_model: Similarity {
                scale,
                ..hero.world_from_model()
            },
            ..figure(&hero)
        };
        recorder.figure(&figure).unwrap();
        let joints = (0..).map_while(|joint| hero.palette().model_from_joint(JointId(joint)));
        let place = &figure.world_from_model;
        places.push(
            joints
                .map(|j| place.transform_point(j.translation))
                .collect(),
        );
    }
    (recorder.finish().unwrap(), places)
}

pub(crate) fn info(battle: &Battle<'_>) -> RecordingInfo {
    let creature = battle.creature;
    RecordingInfo {
        creature: creature.name.clone(),
        creature_fingerprint: creature_fingerprint(
            &creature.rig.skeleton,
            &[],
            &creature.rig.collider,
        ),
        tick_seconds: TICK,
        climber: *battle.climber().config(),
        settings: Default::default(),
        version: RecordingInfo::VERSION.to_owned(),
    }
}

fn recorder(battle: &Battle<'_>) -> Recorder<Vec<u8>> {
    let skeleton = &battle.creature.rig.skeleton;
    let options = RecordOptions::waiting();
    Recorder::new(Vec::new(), &info(battle), skeleton, options).unwrap()
}

pub(crate) fn view<'a>(battle: &'a Battle<'_>) -> TickView<'a> {
    TickView {
        tick: battle.tick(),
        input: &battle.input,
        knockback: None,
        state: battle.climber().state(),
        report: battle.report(),
        surface: battle.surface(),
        palette: battle.palette(),
        scene_fingerprint: 0,
    }
}

fn figure(hero: &Hero) -> FigureView<'_> {
    FigureView {
        name: "hero",
        skeleton: hero.skeleton(),
        palette: hero.palette(),
        world_from_model: hero.world_from_model(),
    }
}

/// The messages about figures in a file.
fn figures(file: &[u8]) -> Vec<FrameTransforms> {
    let messages = mcap::MessageStream::new(file).unwrap().map(Result::unwrap);
    let figures = messages.filter(|message| message.channel.topic == topics::FIGURE);
    figures
        .map(|message| FrameTransforms::decode(&*message.data).unwrap())
        .collect()
}

/// The place of each joint in the world, composed from its transform and its parents' transforms, as in a viewer.
fn composed(message: &FrameTransforms) -> Vec<DVec3> {
    let frames = message.transforms.iter();
    let frames: HashMap<_, _> = frames.map(|f| (f.child_frame_id.as_str(), f)).collect();
    let place = |name: &str| {
        let (mut point, mut at) = (DVec3::ZERO, name);
        while at != "world" {
            let (t, r) = (
                frames[at].translation.unwrap(),
                frames[at].rotation.unwrap(),
            );
            let turn = DQuat::from_xyzw(r.x, r.y, r.z, r.w);
            point = DVec3::new(t.x, t.y, t.z) + turn * point;
            at = &frames[at].parent_frame_id;
        }
        point
    };
    let joints = message.transforms.iter().skip(1);
    joints.map(|frame| place(&frame.child_frame_id)).collect()
}

#[test]
fn a_viewer_finds_every_joint_where_it_was_drawn() {
    for scale in [1.0, 2.5] {
        let (file, drawn) = record(40, scale);
        let messages = figures(&file);
        // One message in four ticks, as the default options say. The first recorded tick has the number 1.
        assert_eq!(messages.len(), 10);
        for (message, drawn) in messages.iter().zip(drawn.iter().skip(3).step_by(4)) {
            let found = composed(message);
            assert_eq!(found.len(), drawn.len());
            for (found, drawn) in found.iter().zip(drawn) {
                assert!(
                    found.distance(*drawn) < 1e-9 * drawn.length(),
                    "{found} {drawn}"
                );
            }
        }
    }
}

#[test]
fn a_figure_that_does_not_fit_is_refused() {
    let creature = giant().unwrap();
    let battle = Battle::new(&creature, &BattleOptions::ride(0, 1)).unwrap();
    let hero = Hero::load().unwrap();
    let mut recorder = recorder(&battle);
    let early = recorder.figure(&figure(&hero)).unwrap_err();
    assert!(matches!(early, RecordError::NoTick { ticks: None, .. }));
    recorder.tick(&view(&battle)).unwrap();
    let stranger = FigureView {
        palette: &Palette::default(),
        ..figure(&hero)
    };
    let refused = recorder.figure(&stranger).unwrap_err();
    assert!(
        matches!(refused, RecordError::FigureJoints { palette: 0, .. }),
        "{refused}"
    );
    recorder.figure(&figure(&hero)).unwrap();
    let another = FigureView {
        skeleton: &creature.rig.skeleton,
        palette: battle.palette(),
        ..figure(&hero)
    };
    let refused = recorder.figure(&another).unwrap_err();
    assert!(
        matches!(refused, RecordError::FigureJoints { .. }),
        "{refused}"
    );
    assert_eq!(figures(&recorder.finish().unwrap()).len(), 1);
}

#[test]
fn a_snapshot_whose_text_cannot_be_made_fails_the_recording() {
    let creature = giant().unwrap();
    let battle = Battle::new(&creature, &BattleOptions::ride(0, 1)).unwrap();
    let mut recorder = recorder(&battle);
    let late = || Err::<String, _>("nothing to say");
    assert!(matches!(
        recorder.snapshot_with(late),
        Err(RecordError::NoTick { .. })
    ));
    recorder.tick(&view(&battle)).unwrap();
    recorder.snapshot_with(late).unwrap();
    let Err(RecordError::Encode { topic, reason }) = recorder.finish() else {
        panic!("the snapshot is written");
    };
    assert_eq!(
        (topic, reason.as_str()),
        (topics::SNAPSHOT, "nothing to say")
    );
}

/// A snapshot that fails or panics ends the recording before its tick, and the file does not look whole. After a
/// failure, the ticks before it are there.
#[test]
fn a_recording_that_fails_ends_before_the_tick_that_fails() {
    let creature = giant().unwrap();
    let options = BattleOptions::ride(0, 1);
    for panics in [false, true] {
        let mut battle = Battle::new(&creature, &options).unwrap();
        let out = Disk::default();
        let how = RecordOptions {
            chunk_ticks: 1000,
            ..RecordOptions::waiting()
        };
        let skeleton = &creature.rig.skeleton;
        let mut recorder = Recorder::new(out.clone(), &info(&battle), skeleton, how).unwrap();
        for tick in 0..40 {
            if tick > 0 {
                battle.step(options.input_at(tick)).unwrap();
            }
            recorder.tick(&view(&battle)).unwrap();
            if tick == 30 {
                let fails = move || {
                    assert!(!panics, "it panics");
                    Err::<String, _>("it fails")
                };
                recorder.snapshot_with(fails).unwrap();
            }
        }
        let finish = std::panic::AssertUnwindSafe(|| recorder.finish().map(drop));
        let ended = std::panic::catch_unwind(finish);
        assert!(matches!(ended, Err(_) | Ok(Err(_))));
        let recording = Recording::from_bytes(out.bytes()).unwrap();
        assert_eq!(*recording.ending(), Ending::Early, "panics: {panics}");
        // A panic loses the whole chunk.
        let last = if panics { None } else { Some(29) };
        assert_eq!(recording.last(), last, "panics: {panics}");
    }
}
