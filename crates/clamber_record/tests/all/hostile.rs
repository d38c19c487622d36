//! Files that were made to do harm, or that other programs have cut. They have no checksums, so that the reader has to
//! check their contents.

use clamber_climber::{ClimberInput, Knockback};
use clamber_fight::{ArenaConfig, FighterConfig, FighterId, Order};
use clamber_record::{
    ArenaInfo, ArenaRecorder, ArenaRecording, Ending, RecordError, RecordOptions, topics,
};
use glam::{DVec3, Vec3};

use crate::elsewhere::{CHUNK, DATA_END, arena, compressed, file, inputs, records, rock, written};
use crate::stage::{Disk, terrain};

/// Kind of MCAP's channel record.
const CHANNEL: u8 = 0x04;
/// Kind of MCAP's message record.
const MESSAGE: u8 = 0x05;

/// The kinds and bodies of the records of a chunk that is not compressed.
fn inner(chunk: &[u8]) -> Vec<(u8, Vec<u8>)> {
    let (mut data, mut all) = (&chunk[40..], Vec::new());
    while !data.is_empty() {
        let length = u64::from_le_bytes(data[1..9].try_into().unwrap()) as usize;
        all.push((data[0], data[9..9 + length].to_vec()));
        data = &data[9 + length..];
    }
    all
}

/// A chunk of the given records, compressed and without a checksum.
fn chunk(records: &[(u8, Vec<u8>)]) -> Vec<u8> {
    let mut data = Vec::new();
    for (kind, body) in records {
        data.push(*kind);
        data.extend((body.len() as u64).to_le_bytes());
        data.extend(body);
    }
    let mut plain = vec![0; 40];
    plain[16..24].copy_from_slice(&(data.len() as u64).to_le_bytes());
    plain.extend(data);
    compressed(&plain, "zstd", false)
}

/// The recording with its chunks changed, without checksums.
fn with_chunks(change: impl Fn(&mut Vec<Vec<(u8, Vec<u8>)>>)) -> ArenaRecording {
    let mut all = records(file());
    let mut chunks = Vec::new();
    all.retain(|(kind, body)| {
        if *kind == CHUNK {
            chunks.push(inner(body));
        }
        ![CHUNK, DATA_END].contains(kind)
    });
    change(&mut chunks);
    all.extend(chunks.iter().map(|records| (CHUNK, chunk(records))));
    all.push((DATA_END, vec![0; 4]));
    ArenaRecording::from_bytes(written(&all)).unwrap()
}

/// The id of a topic's channel.
fn channel(records: &[(u8, Vec<u8>)], topic: &str) -> [u8; 2] {
    let named = [&(topic.len() as u32).to_le_bytes()[..], topic.as_bytes()].concat();
    let is_it = |(kind, body): &&(u8, Vec<u8>)| *kind == CHANNEL && body[4..].starts_with(&named);
    let (_, body) = records.iter().find(is_it).unwrap();
    [body[0], body[1]]
}

/// A message record.
fn message(channel: [u8; 2], data: &[u8]) -> (u8, Vec<u8>) {
    (MESSAGE, [&channel, &[0; 20][..], data].concat())
}

fn is_on(record: &(u8, Vec<u8>), channel: [u8; 2]) -> bool {
    record.0 == MESSAGE && record.1[..2] == channel
}

/// Two bytes of a tick's message can take more than a hundred bytes in memory, and next to none in a compressed file.
/// So messages that are larger than a tick can be are refused.
#[test]
fn ticks_that_take_much_more_memory_than_the_file_are_refused() {
    for pattern in [&[0x12, 0][..], &[0x22, 0], &[0x1a, 0], &[0x08, 1]] {
        let recording = with_chunks(|chunks| {
            let first = &mut chunks[0];
            let ticks = channel(first, topics::ARENA);
            first.push(message(ticks, &pattern.repeat(4 << 20)));
        });
        let Ending::Damaged { reason, .. } = recording.ending() else {
            unreachable!("{pattern:?}: {:?}", recording.ending());
        };
        assert!(reason.contains("2 MiB"), "{reason}");
    }
}

/// A tick may have any number of saved states; the last one counts.
#[test]
fn saved_states_of_one_tick_are_kept_once() {
    let recording = with_chunks(|chunks| {
        let first = &mut chunks[0];
        let saved = channel(first, topics::ARENA_SNAPSHOT);
        let at = first.iter().position(|one| is_on(one, saved)).unwrap();
        let empty = message(saved, &[]);
        first.splice(at..at, vec![empty; 300_000]);
    });
    assert_eq!(*recording.ending(), Ending::Whole);
    assert!(recording.saved(0).unwrap().1.len() > 100);
}

/// Bits that are flipped anywhere in a chunk without a checksum give an error or other ticks, but no panic.
#[test]
fn changed_messages_are_read_or_refused() {
    let mut random = fastrand::Rng::with_seed(3);
    let seeds: Vec<u64> = (0..400).map(|_| random.u64(..)).collect();
    let (mut whole, mut damaged) = (0, 0);
    for seed in seeds {
        let recording = with_chunks(|chunks| {
            let mut random = fastrand::Rng::with_seed(seed);
            for _ in 0..random.usize(1..4) {
                let chunk = random.usize(..chunks.len());
                let chunk = &mut chunks[chunk];
                let index = random.usize(..chunk.len());
                let body = &mut chunk[index].1;
                if !body.is_empty() {
                    let at = random.usize(..body.len());
                    body[at] ^= 1 << random.u8(..8);
                }
            }
        });
        match recording.ending() {
            Ending::Whole => whole += 1,
            _ => damaged += 1,
        }
        for tick in recording.ticks_from(0) {
            let _ = tick.unwrap();
        }
        let terrain = terrain();
        // A state that can be restored can be stepped.
        let _ = recording.replay(&mut arena(), None, |arena, inputs, orders| {
            let rules = clamber_climber::StepRules::default();
            arena.step_with(inputs, orders, &terrain, &rules).map(drop)
        });
    }
    println!("{whole} whole, {damaged} damaged");
    assert!(whole > 20 && damaged > 20, "{whole} {damaged}");
}

/// A file from which a chunk was taken has a gap. A replay continues after it from the state that is saved there, and
/// fails if there is no saved state.
#[test]
fn a_gap_that_somebody_made_is_a_gap() {
    let terrain = terrain();
    let play = |recording: &ArenaRecording| {
        recording.replay(&mut arena(), None, |arena, inputs, _| {
            arena.step(inputs, &terrain).map(drop)
        })
    };
    let recording = with_chunks(|chunks| drop(chunks.remove(1)));
    assert_eq!(recording.runs().count(), 2);
    let replay = play(&recording).unwrap();
    assert_eq!(replay.difference, None);
    assert_eq!(replay.agreed, recording.len() as u64);
    // The same file, but after the gap there is a single tick, without a saved state.
    let recording = with_chunks(|chunks| {
        drop(chunks.remove(1));
        chunks.truncate(2);
        let [ticks, saved] =
            [topics::ARENA, topics::ARENA_SNAPSHOT].map(|topic| channel(&chunks[0], topic));
        let mut is_first = true;
        chunks[1].retain(|one| {
            let keeps = !is_on(one, ticks) || std::mem::take(&mut is_first);
            keeps && !is_on(one, saved)
        });
    });
    let error = play(&recording).unwrap_err();
    assert!(matches!(error, RecordError::NoSnapshot(_)), "{error}");
}

/// A fighter that was added to the arena without an order is reported at the next tick that is recorded.
#[test]
fn who_joins_without_an_order_is_told() {
    let mut arena = clamber_fight::Arena::new(ArenaConfig::default()).unwrap();
    let options = RecordOptions::waiting();
    let info = ArenaInfo::of(&arena);
    let mut recorder = ArenaRecorder::new(Vec::new(), &info, &arena, options).unwrap();
    arena.add_fighter(FighterConfig::hero(), DVec3::Y).unwrap();
    let terrain = terrain();
    let inputs = [ClimberInput::IDLE];
    arena.step(&inputs, &terrain).unwrap();
    let error = recorder.tick(&arena, &inputs, &[], &terrain).unwrap_err();
    assert!(matches!(error, RecordError::Joined), "{error}");
}

/// Records 30 ticks in one chunk, of which tick 21 is larger than a reader takes. `before` is called at the end of tick
/// 20. Returns the disk, and the error with which the recording ends.
fn with_a_tick_too_large(before: impl Fn(&Disk)) -> (Disk, RecordError) {
    let mut arena = arena();
    let info = ArenaInfo::of(&arena);
    let options = RecordOptions {
        chunk_ticks: 1000,
        ..RecordOptions::waiting()
    };
    let disk = Disk::default();
    let mut recorder = ArenaRecorder::new(disk.clone(), &info, &arena, options).unwrap();
    let terrain = terrain();
    let order = Order::Strike {
        fighter: FighterId(9),
        knockback: Knockback::default(),
    };
    let size = Order::to_bytes(std::slice::from_ref(&order)).unwrap().len();
    let many = vec![order; (2 << 20) / (size - 1).max(1) * 2];
    for tick in 0..30 {
        if tick == 20 {
            before(&disk);
        }
        arena.step(&inputs(tick), &terrain).unwrap();
        // The step of index 20 leads to tick 21.
        let orders = if tick == 20 { &many[..] } else { &[] };
        recorder
            .tick(&arena, &inputs(tick), orders, &terrain)
            .unwrap();
    }
    let error = recorder.finish().map(drop).unwrap_err();
    (disk, error)
}

/// A tick that is larger than a reader takes ends the recording with an error. The ticks before it are kept, also those
/// of its chunk.
#[test]
fn the_ticks_before_one_that_is_too_large_are_kept() {
    let (disk, error) = with_a_tick_too_large(|_| {});
    assert!(error.to_string().contains("2 MiB"), "{error}");
    let recording = ArenaRecording::from_bytes(disk.bytes()).unwrap();
    assert_eq!(*recording.ending(), Ending::Early);
    assert_eq!(recording.last(), Some(20));
}

/// If the ticks before it cannot be written, the error still tells what ended the recording.
#[test]
fn a_tick_that_is_too_large_is_told_though_the_disk_is_full() {
    let (_, error) = with_a_tick_too_large(Disk::fill);
    assert!(error.to_string().contains("2 MiB"), "{error}");
}

/// Meshes beyond the limit are left out, and the recording goes on.
#[test]
fn meshes_without_end_do_not_end_the_recording() {
    let mut arena = arena();
    let info = ArenaInfo::of(&arena);
    let options = RecordOptions {
        chunk_ticks: 1,
        ..RecordOptions::waiting()
    };
    let mut recorder = ArenaRecorder::new(std::io::sink(), &info, &arena, options).unwrap();
    let terrain = terrain();
    // Each mesh takes 20 MB, so that all of them together are larger than a chunk may be.
    let points = vec![Vec3::ONE; 800_000];
    for tick in 0..30 {
        arena.step(&inputs(tick), &terrain).unwrap();
        recorder.tick(&arena, &inputs(tick), &[], &terrain).unwrap();
        let name = format!("rock {tick}");
        recorder.scenery(&rock(&name, &points)).unwrap();
    }
    recorder.finish().unwrap();
}
