//! Reads files that were cut, changed or emptied, and files that are not recordings.

use std::sync::OnceLock;
use std::time::Duration;

use clamber_record::{Ending, RecordError, RecordOptions, Recording};
use clamber_scenes::battle::{Battle, BattleOptions, BattleRecorder};
use clamber_scenes::giant::giant;

use crate::stage::{Disk, recorded};

/// Length of the recording, ticks: three seconds, for several chunks.
const TICKS: u64 = 180;

fn file() -> &'static [u8] {
    static FILE: OnceLock<Vec<u8>> = OnceLock::new();
    FILE.get_or_init(|| {
        let how = RecordOptions {
            skin_points: 50,
            ..RecordOptions::waiting()
        };
        let recorder = recorded(Vec::new(), &BattleOptions::ride(0, 1), how, TICKS);
        recorder.finish().unwrap()
    })
}

/// Reads bytes, and asserts that each tick that is found can be read and is as it was recorded. Returns the number of
/// ticks and the ending; `None` if the bytes are refused.
fn check(bytes: Vec<u8>, what: &str) -> Option<(usize, Ending)> {
    static WHOLE: OnceLock<Recording> = OnceLock::new();
    let whole = WHOLE.get_or_init(|| Recording::from_bytes(file().to_vec()).unwrap());
    let recording = match Recording::from_bytes(bytes) {
        Ok(recording) => recording,
        Err(error) => {
            assert!(!error.to_string().is_empty(), "{what}");
            return None;
        }
    };
    for tick in recording.ticks() {
        let tick = tick.unwrap_or_else(|error| panic!("{what}: {error}"));
        let recorded = whole.tick(tick.tick).unwrap();
        assert_eq!(tick, recorded, "{what}");
    }
    for from in 0..=TICKS {
        let _ = recording.snapshot(from);
    }
    Some((recording.len(), recording.ending().clone()))
}

#[test]
fn a_file_cut_anywhere_holds_its_whole_chunks() {
    let whole = file();
    let mut rng = fastrand::Rng::with_seed(5);
    let ends = [0, 1, 7, 8, 9, 16, 17, 18].into_iter();
    let anywhere = (0..400).map(|_| rng.usize(..whole.len()));
    let near_the_end = (1..300).map(|back| whole.len() - back);
    let mut cuts: Vec<usize> = ends.chain(anywhere).chain(near_the_end).collect();
    cuts.sort_unstable();
    let (mut before, mut steps) = (0, 0);
    for cut in cuts {
        let what = format!("cut at {cut} of {}", whole.len());
        let Some((ticks, ending)) = check(whole[..cut].to_vec(), &what) else {
            assert!(cut < 2000, "{what}: nothing is left");
            continue;
        };
        assert_eq!(ending, Ending::Early, "{what}");
        assert!(ticks >= before, "{what}: {ticks} after {before}");
        steps += u32::from(ticks > before);
        before = ticks;
    }
    assert_eq!(before as u64, TICKS + 1, "a cut behind the last chunk");
    assert!(steps >= 3, "{steps} chunks, but one a second was expected");
}

#[test]
fn a_flipped_bit_is_noticed_or_harmless() {
    let whole = file();
    let mut rng = fastrand::Rng::with_seed(6);
    let (mut refused, mut damaged, mut unseen) = (0, 0, 0);
    for round in 0..1500 {
        let mut bytes = whole.to_vec();
        // A third of the flips are at the front, where the lengths and the metadata are, and a third at the end.
        let at = match round % 3 {
            0 => rng.usize(..2500),
            1 => whole.len() - 1 - rng.usize(..4000),
            _ => rng.usize(..whole.len()),
        };
        bytes[at] ^= 1 << rng.u32(..8);
        match check(bytes, &format!("byte {at} changed")) {
            None => refused += 1,
            Some((_, Ending::Whole)) => {
                unseen += 1;
                // Only changes after the data may go unnoticed, because those bytes are not read.
                assert!(at > whole.len() - 20_000, "byte {at} changed unseen");
            }
            Some(_) => damaged += 1,
        }
    }
    assert!(refused > 0 && damaged > 500, "{refused} {damaged} {unseen}");
}

#[test]
fn several_bytes_of_noise_are_noticed_or_harmless() {
    let whole = file();
    let mut rng = fastrand::Rng::with_seed(7);
    for round in 0..500 {
        let mut bytes = whole.to_vec();
        for _ in 0..rng.usize(1..40) {
            let at = rng.usize(..bytes.len());
            bytes[at] = rng.u8(..);
        }
        check(bytes, &format!("round {round} of noise"));
    }
}

#[test]
fn files_that_are_no_recordings_are_refused() {
    let no_mcap = |bytes: &[u8]| {
        let error = Recording::from_bytes(bytes.to_vec()).unwrap_err();
        assert!(matches!(error, RecordError::NotMcap), "{error}");
    };
    no_mcap(b"");
    no_mcap(b"glTF\x02\x00\x00\x00");
    no_mcap(&file()[..7]);
    let no_recording = |bytes: Vec<u8>| {
        let error = Recording::from_bytes(bytes).unwrap_err();
        assert!(matches!(error, RecordError::NotARecording(_)), "{error}");
    };
    no_recording(mcap::MAGIC.to_vec());
    // A file of another program.
    let mut foreign = mcap::Writer::new(std::io::Cursor::new(Vec::new())).unwrap();
    foreign
        .add_channel(0, "/imu", "json", &Default::default())
        .unwrap();
    foreign.finish().unwrap();
    no_recording(foreign.into_inner().into_inner());
    // A file that claims a record longer than any memory.
    let mut endless = mcap::MAGIC.to_vec();
    endless.push(6);
    endless.extend(u64::MAX.to_le_bytes());
    endless.extend([0; 100]);
    no_recording(endless);
    let mut rng = fastrand::Rng::with_seed(8);
    for _ in 0..2000 {
        let mut noise = mcap::MAGIC.to_vec();
        noise.extend((0..rng.usize(..200)).map(|_| rng.u8(..16)));
        assert!(Recording::from_bytes(noise).is_err());
    }
}

#[test]
fn a_missing_file_is_named() {
    let error = Recording::open("no/such/file.mcap").unwrap_err();
    assert!(error.to_string().contains("no/such/file.mcap"), "{error}");
}

#[test]
fn a_writer_that_fails_gives_its_error() {
    struct Full(usize);
    impl std::io::Write for Full {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            if self.0 < bytes.len() {
                return Err(std::io::Error::other("the disk is full"));
            }
            self.0 -= bytes.len();
            Ok(bytes.len())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let creature = giant().unwrap();
    let options = BattleOptions::ride(0, 1);
    // The first run goes on long after the disk is full; the second ends before a tick can return the error.
    for ticks in [600, 50] {
        let mut battle = Battle::new(&creature, &options).unwrap();
        let (how, out) = (RecordOptions::waiting(), Full(50_000));
        let mut recorder = BattleRecorder::new(out, &battle, &options, how).unwrap();
        let mut told = Vec::new();
        for tick in 0..ticks {
            battle.step(options.input_at(tick)).unwrap();
            told.extend(recorder.tick(&battle).err());
        }
        told.extend(recorder.finish().err());
        let told: Vec<String> = told.iter().map(ToString::to_string).collect();
        // The cause is returned once. Later errors only say that the recording has ended.
        let ended = |text: &String| text.contains("has ended");
        assert!(told[0].contains("the disk is full"), "{}", told[0]);
        assert_eq!(told.len() > 1, ticks > 50, "{}", told.len());
        assert_eq!(told.iter().skip(1).find(|text| !ended(text)), None);
    }
}

#[test]
fn a_run_that_is_killed_leaves_its_whole_chunks() {
    let options = BattleOptions::ride(0, 1);
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("killed.mcap");
    let file = std::io::BufWriter::new(std::fs::File::create(&path).unwrap());
    std::mem::forget(recorded(file, &options, RecordOptions::waiting(), 150));
    // The thread may still be writing.
    let start = std::time::Instant::now();
    let mut recording = Recording::open(&path);
    while recording.as_ref().map_or(0, Recording::len) < 120 && start.elapsed().as_secs() < 30 {
        std::thread::yield_now();
        recording = Recording::open(&path);
    }
    let recording = recording.unwrap();
    assert_eq!(*recording.ending(), Ending::Early);
    assert_eq!(recording.len(), 120);
}

/// Records a battle of 70 ticks in chunks of `chunk_ticks`, and passes the recorder to `end`.
fn record_into<W: std::io::Write + Send + 'static>(
    out: W,
    chunk_ticks: u32,
    end: impl FnOnce(BattleRecorder<W>),
) {
    let how = RecordOptions {
        chunk_ticks,
        skin_points: 50,
        ..RecordOptions::waiting()
    };
    end(recorded(out, &BattleOptions::ride(0, 1), how, 69));
}

#[test]
fn a_slow_disk_a_drop_and_a_panic_lose_nothing() {
    for chunk_ticks in [2, 60] {
        let whole = Disk::default();
        record_into(whole.clone(), chunk_ticks, |recorder| {
            recorder.finish().unwrap();
        });
        let whole = whole.bytes();
        assert_eq!(Recording::from_bytes(whole.clone()).unwrap().len(), 70);
        let [slow, dropped] = [0; 2].map(|_| Disk::slow(Duration::from_micros(300)));
        record_into(slow.clone(), chunk_ticks, |recorder| {
            recorder.finish().unwrap();
        });
        record_into(dropped.clone(), chunk_ticks, drop);
        let unwound = Disk::default();
        let panicked = std::panic::catch_unwind(|| {
            record_into(unwound.clone(), chunk_ticks, |_recorder| {
                panic!("on purpose")
            });
        });
        assert!(panicked.is_err());
        for other in [slow, dropped, unwound] {
            assert!(other.bytes() == whole, "{chunk_ticks}");
        }
    }
}

#[test]
fn a_panic_of_the_writer_is_resumed_by_finish_but_not_by_drop() {
    struct Bug(usize);
    impl std::io::Write for Bug {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0 += bytes.len();
            assert!(self.0 < 50_000, "a bug of the caller's");
            Ok(bytes.len())
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let panicked = std::panic::catch_unwind(|| {
        record_into(Bug(0), 60, |recorder| drop(recorder.finish()));
    });
    let panic = panicked.unwrap_err();
    assert_eq!(panic.downcast_ref::<&str>(), Some(&"a bug of the caller's"));
    // A drop ignores the panic.
    record_into(Bug(0), 60, drop);
}
