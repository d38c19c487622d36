//! Records battles and replays them.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use clamber_record::{
    Difference, Ending, RecordError, RecordOptions, RecordedTick, Recorder, Recording, Replayed,
    TickView, palette_fingerprint, replay, topics,
};
use clamber_scenes::battle::{self, Battle, BattleOptions, BattleRecorder, Story};
use clamber_scenes::giant::giant;
use clamber_surface::rig::Palette;
use glam::DVec3;

use crate::stage::recorded;

/// Length of a climb, seconds: the giant has to strike the climber within it for one of 99 seeds.
const CLIMB: f64 = 90.0;

/// Length of a battle, ticks: long enough for a landing and a jump.
const TICKS: u64 = 300;

fn options(rocks: u32, seed: u64) -> BattleOptions {
    BattleOptions {
        seconds: Some(5.0),
        ..BattleOptions::ride(rocks, seed)
    }
}

fn record(options: &BattleOptions) -> Vec<u8> {
    record_ticks(options, TICKS)
}

fn record_ticks(options: &BattleOptions, ticks: u64) -> Vec<u8> {
    let recorder = recorded(Vec::new(), options, RecordOptions::waiting(), ticks);
    recorder.finish().unwrap()
}

#[test]
fn a_battle_replays_bit_for_bit() {
    let recording = Recording::from_bytes(record(&options(8, 1))).unwrap();
    assert_eq!(*recording.ending(), Ending::Whole);
    assert_eq!(recording.len() as u64, TICKS + 1);
    let replay = battle::replay(&recording, None).unwrap();
    assert_eq!(replay.difference, None);
    assert_eq!(replay.agreed, TICKS + 1);
    assert!(replay.with_rocks);
    // The battle was not empty: the climber jumped.
    let inputs = recording.ticks().map(|tick| tick.unwrap().input);
    assert!(inputs.filter(|input| input.jump).count() == 1);
}

/// A climb from the outcrop onto the giant, with the first seed with which the climber gets onto the giant and is
/// struck.
static CLIMBS: LazyLock<BattleOptions> = LazyLock::new(|| {
    let creature = giant().unwrap();
    let options = |seed| BattleOptions {
        story: Some(Story::Climb),
        seconds: Some(CLIMB),
        ..BattleOptions::ride(0, seed)
    };
    let is_struck = |options: &BattleOptions| {
        let mut battle = Battle::new(&creature, options).unwrap();
        let mut rode = false;
        for tick in 0..options.ticks() {
            battle.step(options.input_at(tick)).unwrap();
            let support = battle.climber().state().support;
            rode |= support.is_some_and(|on| on.attachment.obstacle == battle::CREATURE);
        }
        battle.counts.blows > 0 && rode
    };
    let mut all = (1..100).map(options);
    all.find(is_struck).unwrap()
});

#[test]
fn a_climb_replays_bit_for_bit() {
    let options = CLIMBS.clone();
    let recording = Recording::from_bytes(record_ticks(&options, options.ticks())).unwrap();
    let replay = battle::replay(&recording, None).unwrap();
    assert_eq!(replay.difference, None);
    assert_eq!(replay.agreed, options.ticks() + 1);
    let agrees_from = &|from| {
        let replay = battle::replay(&recording, Some(from)).unwrap();
        assert_eq!((replay.difference, replay.from), (None, from));
    };
    std::thread::scope(|scope| {
        for from in [120, 600, 900, 1_500] {
            scope.spawn(move || agrees_from(from));
        }
    });
    let ticks: Vec<_> = recording.ticks().map(|tick| tick.unwrap()).collect();
    // A replay needs no blows: the arena deals them itself, as a result of the inputs.
    assert!(ticks.iter().all(|tick| tick.knockback.is_none()));
    let is_struck = |tick: &RecordedTick| tick.state.hit_points < 1.0;
    assert!(ticks.iter().any(is_struck));
    assert!(ticks.iter().any(|tick| tick.input.climb != DVec3::ZERO));
}

/// The fields of a brain's message that a test reads.
#[derive(Clone, PartialEq, prost::Message)]
struct Brain {
    #[prost(string, tag = "1")]
    state: String,
    #[prost(double, tag = "2")]
    seconds: f64,
    #[prost(message, repeated, tag = "4")]
    senses: Vec<Named>,
    #[prost(bool, repeated, tag = "6")]
    planted: Vec<bool>,
}

#[derive(Clone, PartialEq, prost::Message)]
struct Named {
    #[prost(string, tag = "1")]
    name: String,
    #[prost(double, tag = "2")]
    value: f64,
}

#[test]
fn a_climb_of_a_giant_with_another_brain_is_not_replayed() {
    let brain = std::env::temp_dir().join(format!("clamber-{}.brain.json", std::process::id()));
    std::fs::copy(clamber_scenes::giant::brain_path(), &brain).unwrap();
    let options = BattleOptions {
        brain: Some(brain.clone()),
        story: Some(Story::Climb),
        seconds: Some(2.0),
        ..BattleOptions::ride(0, 1)
    };
    let recording = Recording::from_bytes(record_ticks(&options, options.ticks())).unwrap();
    assert_eq!(battle::replay(&recording, None).unwrap().difference, None);
    let text = std::fs::read_to_string(&brain).unwrap();
    assert!(text.contains("\"fades\": 12"));
    std::fs::write(&brain, text.replace("\"fades\": 12", "\"fades\": 13")).unwrap();
    let error = battle::replay(&recording, None).unwrap_err();
    std::fs::remove_file(&brain).unwrap();
    assert!(error.to_string().contains("brain"), "{error}");
    let missing = battle::replay(&recording, None).unwrap_err();
    assert!(
        missing.to_string().contains("cannot read the brain"),
        "{missing}"
    );
}

#[test]
fn a_climb_has_the_brain_of_its_giant() {
    let options = CLIMBS.clone();
    let creature = giant().unwrap();
    let mut battle = Battle::new(&creature, &options).unwrap();
    let how = RecordOptions {
        transforms_every: 4,
        ..RecordOptions::waiting()
    };
    let mut recorder = BattleRecorder::new(Vec::new(), &battle, &options, how).unwrap();
    recorder.tick(&battle).unwrap();
    let (mut lived, mut changes) = (Vec::new(), 0);
    for tick in 0..options.ticks() {
        let before = battle.life().unwrap().state().current();
        battle.step(options.input_at(tick)).unwrap();
        recorder.tick(&battle).unwrap();
        let life = battle.life().unwrap();
        let state = life.kind().brain().path(life.state().current());
        let changed = before != life.state().current();
        changes += usize::from(changed);
        if changed || battle.tick().is_multiple_of(4) {
            let sense = life.state().senses().get(clamber_colossus::Sense::Riders);
            lived.push((state.to_owned(), sense, life.state().is_planted(0)));
        }
    }
    let file = recorder.finish().unwrap();
    let messages = |topic: &str| -> Vec<Vec<u8>> {
        let all = mcap::MessageStream::new(&file).unwrap();
        let all = all.map(Result::unwrap);
        all.filter(|message| message.channel.topic == topic)
            .map(|message| message.data.into_owned())
            .collect()
    };
    let read = messages(topics::BRAIN).into_iter();
    let read: Vec<_> = read
        .map(|bytes| {
            let brain = <Brain as prost::Message>::decode(&bytes[..]).unwrap();
            assert!((0.0..=CLIMB).contains(&brain.seconds));
            let riders = brain.senses.iter().find(|sense| sense.name == "riders");
            (
                brain.state,
                riders.map_or(0.0, |riders| riders.value),
                brain.planted[0],
            )
        })
        .collect();
    // The first message is from before the first step.
    assert_eq!(read[1..], lived);
    let log = messages(topics::LOG).concat();
    let log = String::from_utf8_lossy(&log);
    let entered = log.matches(" to alive/").count();
    assert!(
        entered >= changes && changes > 4,
        "{entered} lines, {changes} changes"
    );
    assert!(log.contains("struck person 0 with alive/alert/"), "no blow");
}

#[test]
fn a_battle_replays_from_any_snapshot() {
    let recording = Recording::from_bytes(record(&options(8, 1))).unwrap();
    for (from, snapshot) in [
        (0, 0),
        (59, 0),
        (60, 60),
        (200, 180),
        (299, 240),
        (300, 300),
    ] {
        let replay = battle::replay(&recording, Some(from)).unwrap();
        assert_eq!(replay.difference, None, "from {from}");
        assert_eq!(replay.from, snapshot, "from {from}");
        assert_eq!(replay.agreed, TICKS + 1 - snapshot, "from {from}");
        assert!(!replay.with_rocks);
    }
    let missing = battle::replay(&recording, Some(301)).unwrap_err();
    assert!(missing.to_string().contains("ticks 0 to 300"), "{missing}");
}

#[test]
fn two_recordings_of_a_battle_have_the_same_bytes_but_not_with_another_seed() {
    let first = record(&options(4, 1));
    assert!(first == record(&options(4, 1)), "the bytes differ");
    assert!(
        first != record(&options(4, 2)),
        "the seed makes no difference"
    );
}

/// Replays a battle with recorded ticks that `change` has modified. Returns the first tick that differs.
fn first_difference(
    recording: &Recording,
    options: &BattleOptions,
    change: impl Fn(&mut RecordedTick),
) -> Option<u64> {
    let creature = giant().unwrap();
    let mut battle = Battle::new(&creature, options).unwrap();
    let ticks = recording.ticks().map(|tick| {
        let mut tick = tick?;
        change(&mut tick);
        Ok(tick)
    });
    let step = |recorded: &RecordedTick| {
        if recorded.tick > 0 {
            battle.step_with(recorded.input)?;
        }
        Ok::<_, battle::SceneError>(Replayed {
            state: *battle.climber().state(),
            palette_fingerprint: palette_fingerprint(battle.palette()),
            scene_fingerprint: Some(battle.scene_fingerprint()),
        })
    };
    match replay(ticks, step) {
        Ok(_) => None,
        Err(clamber_record::ReplayError::Differs(difference)) => {
            let Difference { recorded, .. } = *difference;
            Some(recorded.tick)
        }
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn a_changed_tick_is_the_first_difference() {
    let options = options(2, 1);
    let recording = Recording::from_bytes(record(&options)).unwrap();
    assert_eq!(first_difference(&recording, &options, |_| {}), None);
    // Bit 20 of one input is flipped, in the first tick in which the climber walks.
    let walking = |tick: &RecordedTick| tick.input.walk.x != 0.0;
    let ticks: Vec<RecordedTick> = recording.ticks().map(Result::unwrap).collect();
    let at = ticks.iter().find(|tick| walking(tick)).unwrap().tick;
    let nudge = |tick: &mut RecordedTick| {
        if tick.tick == at {
            tick.input.walk.x = f64::from_bits(tick.input.walk.x.to_bits() ^ (1 << 20));
        }
    };
    assert_eq!(first_difference(&recording, &options, nudge), Some(at));
    let no_jump = |tick: &mut RecordedTick| tick.input.jump = false;
    let jump = ticks.iter().find(|tick| tick.input.jump).unwrap().tick;
    assert_eq!(first_difference(&recording, &options, no_jump), Some(jump));
    // The creature's pose, the rocks, and the start.
    let palette = |tick: &mut RecordedTick| {
        tick.palette_fingerprint ^= u64::from(tick.tick == 77);
    };
    assert_eq!(first_difference(&recording, &options, palette), Some(77));
    let rocks = |tick: &mut RecordedTick| tick.scene_fingerprint ^= u64::from(tick.tick == 78);
    assert_eq!(first_difference(&recording, &options, rocks), Some(78));
    let other_seed = BattleOptions {
        seed: 2,
        ..options.clone()
    };
    assert_eq!(first_difference(&recording, &other_seed, |_| {}), Some(0));
}

/// The constant is the creature's height, from the recording's own settings.
#[test]
fn a_changed_constant_shows_as_a_difference() {
    let options = options(0, 1);
    let recording = Recording::from_bytes(record(&options)).unwrap();
    let taller = BattleOptions {
        height: Some(options.height() * (1.0 + 1e-12)),
        ..options
    };
    assert_eq!(first_difference(&recording, &taller, |_| {}), Some(0));
}

#[test]
fn a_third_party_reader_finds_every_tick_in_order_and_the_metadata() {
    let file = record(&options(2, 1));
    let summary = mcap::Summary::read(&file).unwrap().unwrap();
    let stats = summary.stats.as_ref().unwrap();
    assert_eq!(stats.metadata_count, 2);
    assert!(stats.chunk_count >= 5, "{} chunks", stats.chunk_count);
    assert_eq!(stats.message_start_time, 0);
    assert_eq!(stats.message_end_time, TICKS * 1_000_000_000 / 60);
    let mut counts: BTreeMap<String, u64> = BTreeMap::new();
    let mut last = 0;
    for message in mcap::MessageStream::new(&file).unwrap() {
        let message = message.unwrap();
        assert!(
            message.log_time >= last,
            "{} after {last}",
            message.log_time
        );
        last = message.log_time;
        let schema = message.channel.schema.as_ref().unwrap();
        assert_eq!(schema.encoding, "protobuf");
        assert_eq!(message.channel.message_encoding, "protobuf");
        *counts.entry(message.channel.topic.clone()).or_default() += 1;
    }
    assert_eq!(counts[topics::TICK], TICKS + 1);
    // Each view has a message for the joints and one for the rocks; the first message for the rocks also places the
    // ground.
    assert_eq!(counts[topics::TRANSFORMS], 2 * (TICKS / 4 + 1));
    assert_eq!(counts[topics::SCENERY], 1);
    assert_eq!(counts[topics::SKIN], TICKS / 4 + 1);
    assert_eq!(counts[topics::SCENE], TICKS / 4 + 1);
    assert_eq!(counts[topics::TOUCHED], TICKS / 4 + 1);
    assert_eq!(counts[topics::SNAPSHOT], TICKS / 60 + 1);
    assert!(counts[topics::LOG] >= 2, "{counts:?}");
    let metadata = summary.metadata_indexes.iter().map(|index| {
        let metadata = mcap::read::metadata(&file, index).unwrap();
        (metadata.name, metadata.metadata)
    });
    let metadata: BTreeMap<_, _> = metadata.collect();
    assert_eq!(metadata["settings"]["seed"], "1");
    assert_eq!(metadata["settings"]["rocks"], "2");
    assert_eq!(metadata["clamber"]["creature"], "giant");
    assert_eq!(metadata["clamber"]["version"], env!("CARGO_PKG_VERSION"));
}

#[test]
fn recording_does_not_change_the_battle() {
    let creature = giant().unwrap();
    let options = options(8, 3);
    let battle = || Battle::new(&creature, &options).unwrap();
    let (mut plain, mut recorded) = (battle(), battle());
    // All views are due each tick: they skin the whole creature and read what was touched.
    let how = RecordOptions {
        transforms_every: 1,
        skin_every: 1,
        touched_every: 1,
        ..RecordOptions::waiting()
    };
    let mut recorder = BattleRecorder::new(Vec::new(), &recorded, &options, how).unwrap();
    for tick in 0..TICKS {
        plain.step(options.input_at(tick)).unwrap();
        recorded.step(options.input_at(tick)).unwrap();
        recorder.tick(&recorded).unwrap();
        let touched = |battle: &Battle<'_>| battle.surface().diagnostics();
        assert_eq!(touched(&plain), touched(&recorded), "tick {tick}");
    }
    assert_eq!(plain.hash(), recorded.hash());
}

#[test]
fn a_tick_that_is_refused_changes_nothing() {
    let creature = giant().unwrap();
    let options = options(0, 1);
    let battle = Battle::new(&creature, &options).unwrap();
    let whole = Recording::from_bytes(record(&options)).unwrap();
    let out = Vec::new();
    let how = RecordOptions::waiting();
    let mut recorder = Recorder::new(out, whole.info(), &creature.rig.skeleton, how).unwrap();
    let stranger = Palette::default();
    let view = |tick, palette| TickView {
        tick,
        input: &battle.input,
        knockback: None,
        state: battle.climber().state(),
        report: battle.report(),
        surface: battle.surface(),
        palette,
        scene_fingerprint: 0,
    };
    let refused = recorder.tick(&view(7, &stranger)).unwrap_err();
    assert!(matches!(
        refused,
        RecordError::JointCount { palette: 0, .. }
    ));
    recorder.tick(&view(7, battle.palette())).unwrap();
    let refused = recorder.tick(&view(9, battle.palette())).unwrap_err();
    assert!(matches!(refused, RecordError::Order { last: 7, found: 9 }));
    recorder.tick(&view(8, battle.palette())).unwrap();
    let recording = Recording::from_bytes(recorder.finish().unwrap()).unwrap();
    assert_eq!(recording.len(), 2);
}
