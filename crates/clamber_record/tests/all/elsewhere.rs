//! Files as other programs write them: compressed chunks, no checksums; files that are longer than memory, and disks
//! that are slower than the game.

use std::io::{Read, Seek, SeekFrom, Write};
use std::sync::OnceLock;
use std::time::Duration;

use clamber_climber::ClimberInput;
use clamber_fight::{Arena, ArenaConfig, FighterConfig};
use clamber_record::{
    AnyRecording, ArenaInfo, ArenaRecorder, ArenaRecording, Ending, RecordOptions, Recorder,
    Recording, ReplayError, Replayed, SceneryView,
};
use clamber_scenes::battle::{self, Battle, BattleOptions};
use clamber_scenes::giant::giant;
use clamber_surface::geometry::Similarity;
use glam::{DVec3, Vec3};

use crate::figure::{info, view};
use crate::stage::{Disk, recorded, terrain};

/// Length of the recording, ticks.
const TICKS: u64 = 200;

pub(crate) fn arena() -> Arena {
    let mut arena = Arena::new(ArenaConfig::default()).unwrap();
    for x in [0.0, 3.0] {
        arena
            .add_fighter(FighterConfig::hero(), DVec3::new(x, 1.0, 0.0))
            .unwrap();
    }
    arena
}

pub(crate) fn inputs(tick: u64) -> [ClimberInput; 2] {
    [0, 1].map(|player| ClimberInput {
        walk: if (tick / 20 + player).is_multiple_of(2) {
            DVec3::X
        } else {
            DVec3::NEG_Z
        },
        jump: tick % 50 == 7 * player,
        ..ClimberInput::IDLE
    })
}

/// A rock of one triangle.
pub(crate) fn rock<'a>(name: &'a str, points: &'a [Vec3]) -> SceneryView<'a> {
    SceneryView {
        name,
        world_from_own: Similarity::IDENTITY,
        points,
        triangles: &[[0, 1, 2]],
        color: [0.5; 3],
    }
}

pub(crate) fn file() -> &'static [u8] {
    static FILE: OnceLock<Vec<u8>> = OnceLock::new();
    FILE.get_or_init(|| {
        let mut arena = arena();
        let info = ArenaInfo::of(&arena);
        let options = RecordOptions::waiting();
        let mut recorder = ArenaRecorder::new(Vec::new(), &info, &arena, options).unwrap();
        let terrain = terrain();
        for tick in 0..TICKS {
            arena.step(&inputs(tick), &terrain).unwrap();
            recorder.tick(&arena, &inputs(tick), &[], &terrain).unwrap();
        }
        recorder.finish().unwrap()
    })
}

/// Kind of MCAP's chunk record.
pub(crate) const CHUNK: u8 = 0x06;
/// Kind of MCAP's attachment record.
const ATTACHMENT: u8 = 0x09;
/// Kind of MCAP's record at the end of the data.
pub(crate) const DATA_END: u8 = 0x0f;

/// The kinds and bodies of a file's records, up to the end of its data.
pub(crate) fn records(file: &[u8]) -> Vec<(u8, Vec<u8>)> {
    let (mut at, mut all) = (8, Vec::new());
    loop {
        let length = u64::from_le_bytes(file[at + 1..at + 9].try_into().unwrap()) as usize;
        all.push((file[at], file[at + 9..at + 9 + length].to_vec()));
        if file[at] == DATA_END {
            return all;
        }
        at += 9 + length;
    }
}

pub(crate) fn written(records: &[(u8, Vec<u8>)]) -> Vec<u8> {
    let mut file = b"\x89MCAP0\r\n".to_vec();
    for (kind, body) in records {
        file.push(*kind);
        file.extend((body.len() as u64).to_le_bytes());
        file.extend(body);
    }
    file.extend(b"\x89MCAP0\r\n");
    file
}

/// A chunk's body with its data compressed as `how` says, with its checksum or without.
pub(crate) fn compressed(body: &[u8], how: &str, has_checksum: bool) -> Vec<u8> {
    // A chunk's head has the times of its first and last message, the size and the checksum. The name of the
    // compression and the length of the data follow.
    let (head, data) = (&body[..28], &body[40..]);
    let data = match how {
        "zstd" => {
            let level = ruzstd::encoding::CompressionLevel::Fastest;
            ruzstd::encoding::compress_to_vec(data, level)
        }
        "lz4" => {
            let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
            encoder.write_all(data).unwrap();
            encoder.finish().unwrap()
        }
        _ => data.to_vec(),
    };
    let mut new = head.to_vec();
    if !has_checksum {
        new[24..28].fill(0);
    }
    new.extend((how.len() as u32).to_le_bytes());
    new.extend(how.as_bytes());
    new.extend((data.len() as u64).to_le_bytes());
    new.extend(data);
    new
}

/// The file with its chunks compressed as `how` says, and without the checksum of all data.
fn rewritten(how: &str, has_checksum: bool) -> Vec<u8> {
    let mut all = records(file());
    for (kind, body) in &mut all {
        match *kind {
            CHUNK => *body = compressed(body, how, has_checksum),
            DATA_END => body.fill(0),
            _ => {}
        }
    }
    written(&all)
}

fn replays(recording: &ArenaRecording, what: &str) {
    assert_eq!(*recording.ending(), Ending::Whole, "{what}");
    assert_eq!(recording.len() as u64, TICKS + 1, "{what}");
    let terrain = terrain();
    // Backwards, so that chunks are read again.
    for from in [TICKS, 130, 61, 0] {
        let replay = recording.replay(&mut arena(), Some(from), |arena, inputs, _| {
            arena.step(inputs, &terrain).map(drop)
        });
        let replay = replay.unwrap();
        assert_eq!(replay.difference, None, "{what} from {from}");
        assert_eq!(replay.from + replay.agreed, TICKS + 1, "{what}");
    }
}

#[test]
fn compressed_chunks_and_files_without_checksums_are_read() {
    for how in ["", "zstd", "lz4"] {
        for has_checksum in [true, false] {
            let file = rewritten(how, has_checksum);
            let what = format!("{how:?}, checksums {has_checksum}");
            replays(&ArenaRecording::from_bytes(file).unwrap(), &what);
        }
    }
}

/// Compressed files that were changed or cut are read up to the damage, whatever their headers claim.
#[test]
fn damaged_compressed_files_give_what_is_whole() {
    let mut rng = fastrand::Rng::with_seed(11);
    for how in ["zstd", "lz4", "brotli"] {
        let whole = rewritten(if how == "brotli" { "" } else { how }, true);
        let mut shorter = 0;
        for round in 0..150 {
            let mut file = whole.clone();
            if how == "brotli" {
                // A compression that the reader does not know.
                let mut all = records(&file);
                let chunk = all.iter_mut().find(|(kind, _)| *kind == CHUNK).unwrap();
                chunk.1 = [&chunk.1[..28], &[6, 0, 0, 0], b"brotli", &chunk.1[32..]].concat();
                file = written(&all);
            } else if round % 3 == 0 {
                file.truncate(rng.usize(..file.len()));
            } else {
                let at = rng.usize(..file.len());
                file[at] ^= 1 << rng.u8(..8);
            }
            if let Ok(recording) = ArenaRecording::from_bytes(file) {
                shorter += u64::from((recording.len() as u64) < TICKS + 1);
                for tick in recording.ticks_from(0) {
                    tick.unwrap();
                }
            }
        }
        assert!(shorter > 50, "{how}: {shorter}");
    }
    // A chunk that claims to be small, and one that claims to be large.
    for size in [100u64, 1 << 40] {
        let mut all = records(&rewritten("zstd", false));
        let chunk = all.iter_mut().find(|(kind, _)| *kind == CHUNK).unwrap();
        chunk.1[16..24].copy_from_slice(&size.to_le_bytes());
        let recording = ArenaRecording::from_bytes(written(&all)).unwrap();
        assert!(matches!(recording.ending(), Ending::Damaged { .. }));
        assert!(recording.is_empty());
    }
}

/// A file of more than 4 GiB is read in little memory. Most of it is an attachment, which takes no disk space, because
/// the file is sparse.
#[test]
#[cfg(target_os = "linux")]
fn a_file_of_any_length_is_read() {
    /// Length of the attachment, bytes: it does not fit in 32 bits.
    const LONG: u64 = (1 << 32) + 12_345;
    let path = format!("{}/long.mcap", env!("CARGO_TARGET_TMPDIR"));
    let all = records(&rewritten("zstd", true));
    let first = all.iter().position(|(kind, _)| *kind == CHUNK).unwrap();
    let mut file = std::fs::File::create(&path).unwrap();
    let before = written(&all[..first]);
    file.write_all(&before[..before.len() - 8]).unwrap();
    file.write_all(&[ATTACHMENT]).unwrap();
    file.write_all(&LONG.to_le_bytes()).unwrap();
    file.seek(SeekFrom::Current(LONG as i64)).unwrap();
    file.write_all(&written(&all[first..])[8..]).unwrap();
    drop(file);
    let peak = |what: &str| -> u64 {
        let mut status = String::new();
        let mut file = std::fs::File::open("/proc/self/status").unwrap();
        file.read_to_string(&mut status).unwrap();
        let line = status.lines().find(|line| line.starts_with(what)).unwrap();
        let number = line.split_whitespace().nth(1).unwrap();
        number.parse().unwrap()
    };
    let resident = peak("VmRSS:");
    let AnyRecording::Arena(recording) = AnyRecording::open(&path).unwrap() else {
        unreachable!("it is an arena's");
    };
    // Other tests run at the same time.
    let most = peak("VmHWM:").saturating_sub(resident);
    assert!(most < 1 << 20, "{most} kB more");
    replays(&recording, "a long file");
    std::fs::remove_file(&path).unwrap();
}

/// On a slow disk the game is not held up, ticks that are lost are counted and logged, and a replay works from any
/// recorded tick.
#[test]
fn a_slow_disk_leaves_gaps_and_never_holds_up_the_game() {
    /// Length of the run, ticks: 100 chunks of 20, more than the disk can take in that time.
    const TICKS: u64 = 2000;
    let terrain = terrain();
    let mut arena = arena();
    let options = RecordOptions {
        chunk_ticks: 20,
        ..RecordOptions::default()
    };
    let disk = Disk::slow(Duration::from_millis(30));
    let info = ArenaInfo::of(&arena);
    let mut recorder = ArenaRecorder::new(disk, &info, &arena, options).unwrap();
    let mut waits = 0;
    for tick in 0..TICKS {
        arena.step(&inputs(tick), &terrain).unwrap();
        let began = std::time::Instant::now();
        recorder.tick(&arena, &inputs(tick), &[], &terrain).unwrap();
        waits += u32::from(began.elapsed().as_millis() >= 25);
    }
    let dropped = recorder.dropped();
    let file = recorder.finish().unwrap().bytes();
    // A game that waits would do so for most of its 100 chunks. A busy machine may hold it up a few times.
    assert!(waits < 20, "{waits} waits");
    let recording = ArenaRecording::from_bytes(file.clone()).unwrap();
    assert_eq!(*recording.ending(), Ending::Whole);
    let runs: Vec<_> = recording.runs().collect();
    assert!(runs.len() > 1 && dropped > 100, "{runs:?}, {dropped} lost");
    let lost = TICKS + 1 - recording.len() as u64;
    assert!(
        (dropped..dropped + 20).contains(&lost),
        "{lost}, {dropped} told"
    );
    assert!(String::from_utf8_lossy(&file).contains("the disk was too slow"));
    let from = runs.iter().flat_map(|run| [*run.start(), *run.end()]);
    for from in from {
        let replay = recording.replay(&mut self::arena(), Some(from), |arena, inputs, _| {
            arena.step(inputs, &terrain).map(drop)
        });
        let replay = replay.unwrap();
        assert_eq!(replay.difference, None, "from {from}");
        let ticks = recording.ticks_from(replay.from).count() as u64;
        assert_eq!(replay.agreed, ticks, "from {from}");
    }
    // A replay from a tick in a gap is refused.
    let gap = runs[0].end() + 1;
    let none = recording.replay(&mut self::arena(), Some(gap), |_, _, _| Ok(()));
    assert!(none.is_err());
}

/// A rock that is recorded first in a tick that is left out is drawn all the same.
#[test]
fn what_appears_in_a_gap_is_drawn() {
    /// Length of the run, ticks: 60 chunks of 20, more than the disk can take in that time.
    const TICKS: u64 = 1200;
    let terrain = terrain();
    let mut arena = arena();
    let options = RecordOptions {
        chunk_ticks: 20,
        ..RecordOptions::default()
    };
    let disk = Disk::slow(Duration::from_millis(30));
    let info = ArenaInfo::of(&arena);
    let mut recorder = ArenaRecorder::new(disk, &info, &arena, options).unwrap();
    let points = [Vec3::ZERO, Vec3::X, Vec3::Z];
    let mut names = Vec::new();
    for tick in 0..TICKS {
        arena.step(&inputs(tick), &terrain).unwrap();
        recorder.tick(&arena, &inputs(tick), &[], &terrain).unwrap();
        if tick % 7 == 0 {
            names.push(format!("rock of tick {tick}"));
            let rock = rock(names.last().unwrap(), &points);
            recorder.scenery(&rock).unwrap();
        }
    }
    assert!(recorder.dropped() > 100, "{}", recorder.dropped());
    let file = recorder.finish().unwrap().bytes();
    let all = mcap::MessageStream::new(&file).unwrap().map(Result::unwrap);
    let last = all
        .filter(|message| message.channel.topic == "/scenery")
        .last()
        .unwrap();
    let scene =
        <foxglove::messages::SceneUpdate as foxglove::Decode>::decode(&last.data[..]).unwrap();
    let drawn: Vec<&str> = scene
        .entities
        .iter()
        .map(|entity| entity.id.as_str())
        .collect();
    assert_eq!(drawn, names);
}

/// Every recording can be read: chunks end before they are too large, and metadata that are too large are refused.
#[test]
fn what_is_recorded_is_never_too_large_to_be_read() {
    let terrain = terrain();
    let mut arena = arena();
    let mut info = ArenaInfo::of(&arena);
    let options = RecordOptions {
        chunk_ticks: u32::MAX,
        ..RecordOptions::waiting()
    };
    let mut recorder = ArenaRecorder::new(Vec::new(), &info, &arena, options).unwrap();
    // Each mesh takes 2 MB. A viewer that seeks back shows only the last message, so each message has all meshes.
    let points = vec![Vec3::ONE; 80_000];
    for tick in 0..12 {
        arena.step(&inputs(tick), &terrain).unwrap();
        recorder.tick(&arena, &inputs(tick), &[], &terrain).unwrap();
        let name = format!("rock {tick}");
        recorder.scenery(&rock(&name, &points)).unwrap();
    }
    let file = recorder.finish().unwrap();
    let summary = mcap::Summary::read(&file).unwrap().unwrap();
    let sizes = summary.chunk_indexes.iter();
    let sizes: Vec<u64> = sizes.map(|chunk| chunk.uncompressed_size >> 20).collect();
    println!("chunks of {sizes:?} MB");
    assert!(file.len() > 100 << 20);
    assert!(sizes.iter().all(|size| *size < 64 + 30), "{sizes:?}");
    let recording = ArenaRecording::from_bytes(file).unwrap();
    assert_eq!(*recording.ending(), Ending::Whole);
    assert_eq!(recording.len(), 13);
    info.settings = [("notes".to_owned(), "x".repeat(17 << 20))].into();
    let error = ArenaRecorder::new(Vec::new(), &info, &arena, options)
        .map(drop)
        .unwrap_err();
    assert!(error.to_string().contains("16 MiB"), "{error}");
}

/// In a climber's recording with gaps, each run is replayed from the snapshot at its beginning. A replay of all ticks
/// as one run returns an error.
#[test]
fn a_climbers_recording_with_gaps_is_replayed_run_by_run() {
    let options = BattleOptions::ride(0, 1);
    let disk = Disk::slow(Duration::from_millis(60));
    let how = RecordOptions {
        chunk_ticks: 20,
        ..RecordOptions::default()
    };
    let recorder = recorded(disk, &options, how, 1200);
    let file = recorder.finish().unwrap().bytes();
    let recording = Recording::from_bytes(file).unwrap();
    let runs: Vec<_> = recording.runs().collect();
    assert!(runs.len() > 1, "{runs:?}");
    let from = runs.iter().skip(1).map(|run| Some(*run.start()));
    for from in [None].into_iter().chain(from) {
        let replay = battle::replay(&recording, from).unwrap();
        assert!(replay.difference.is_none(), "from {from:?}");
        let ticks = recording.ticks_from(replay.from).count() as u64;
        assert_eq!(replay.agreed, ticks, "from {from:?}");
    }
    let as_one = clamber_record::replay(recording.ticks(), |tick| {
        Ok::<_, std::convert::Infallible>(Replayed {
            state: tick.state,
            palette_fingerprint: tick.palette_fingerprint,
            scene_fingerprint: None,
        })
    });
    let error = as_one.unwrap_err();
    let last = *runs[0].end();
    assert!(
        matches!(error, ReplayError::Gap { last: found, .. } if found == last),
        "{error}"
    );
}

/// A recording with snapshots only before its disk stalls ends at the stall, and reports how many ticks are missing at
/// the end.
#[test]
fn what_is_lost_at_the_end_is_told() {
    let creature = giant().unwrap();
    let options = BattleOptions::ride(0, 1);
    for stalls in [false, true] {
        let mut battle = Battle::new(&creature, &options).unwrap();
        let how = RecordOptions {
            chunk_ticks: 10,
            ..RecordOptions::default()
        };
        let disk = Disk::default();
        let skeleton = &creature.rig.skeleton;
        let mut recorder = Recorder::new(disk.clone(), &info(&battle), skeleton, how).unwrap();
        for tick in 0..=600 {
            if tick > 0 {
                battle.step(options.input_at(tick)).unwrap();
            }
            recorder.tick(&view(&battle)).unwrap();
            if tick == 0 || tick == 30 {
                recorder.snapshot("here").unwrap();
            }
            if tick == 60 || tick == 400 {
                disk.stalls(stalls && tick == 60);
            }
            if !stalls {
                // The pause lets the recorder keep up on a busy machine.
                std::thread::sleep(Duration::from_millis(2));
            }
        }
        drop(recorder.finish().unwrap());
        let recording = Recording::from_bytes(disk.bytes()).unwrap();
        assert_eq!(*recording.ending(), Ending::Whole);
        let last = recording.last().unwrap();
        assert_eq!(last + recording.lost_at_end(), 600);
        assert_eq!(last == 600, !stalls, "{last}");
    }
}
