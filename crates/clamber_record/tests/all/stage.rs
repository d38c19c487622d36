//! Ground to stand on, disks to write to, and recorded battles.

use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, Mutex};
use std::time::Duration;

use clamber_record::RecordOptions;
use clamber_scenes::battle::{Battle, BattleOptions, BattleRecorder};
use clamber_scenes::giant::giant;
use clamber_world::{HalfSpace, Obstacle, ObstacleId};

/// The ground's obstacle id.
pub(crate) const GROUND: ObstacleId = ObstacleId(7);

/// The ground at a height of 0.
pub(crate) fn terrain() -> [(ObstacleId, &'static dyn Obstacle); 1] {
    static LEVEL: LazyLock<HalfSpace> = LazyLock::new(|| HalfSpace::below(0.0));
    [(GROUND, &*LEVEL)]
}

/// Records the ticks 0 to `ticks` of a battle. The recorder is still open.
pub(crate) fn recorded<W: Write + Send + 'static>(
    out: W,
    options: &BattleOptions,
    how: RecordOptions,
    ticks: u64,
) -> BattleRecorder<W> {
    let creature = giant().unwrap();
    let mut battle = Battle::new(&creature, options).unwrap();
    let mut recorder = BattleRecorder::new(out, &battle, options, how).unwrap();
    recorder.tick(&battle).unwrap();
    for tick in 0..ticks {
        battle.step(options.input_at(tick)).unwrap();
        recorder.tick(&battle).unwrap();
    }
    recorder
}

/// A file on a disk, whose bytes outlive the recorder.
#[derive(Clone, Default)]
pub(crate) struct Disk {
    bytes: Arc<Mutex<Vec<u8>>>,
    /// Duration of each write of more than 1,000 bytes.
    pause: Duration,
    /// While it is true, writes wait.
    stalls: Arc<AtomicBool>,
    /// While it is true, writes fail.
    full: Arc<AtomicBool>,
}

impl Disk {
    pub(crate) fn slow(pause: Duration) -> Self {
        Self {
            pause,
            ..Self::default()
        }
    }

    pub(crate) fn stalls(&self, stalls: bool) {
        self.stalls.store(stalls, Ordering::Relaxed);
    }

    /// Makes all later writes fail.
    pub(crate) fn fill(&self) {
        self.full.store(true, Ordering::Relaxed);
    }

    pub(crate) fn bytes(&self) -> Vec<u8> {
        self.bytes.lock().unwrap().clone()
    }
}

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        while self.stalls.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(1));
        }
        if self.full.load(Ordering::Relaxed) {
            return Err(std::io::Error::other("the disk is full"));
        }
        if bytes.len() > 1000 {
            std::thread::sleep(self.pause);
        }
        self.bytes.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}
