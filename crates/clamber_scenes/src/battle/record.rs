//! A battle recorded, and fought again from what was recorded.

use std::io::Write;
use std::path::Path;

use clamber_record::{
    Difference, Ending, RecordError, RecordOptions, RecordedTick, Recorder, Recording,
    RecordingInfo, ReplayError, Replayed, TickView, creature_fingerprint, palette_fingerprint,
};

use super::options::Progress;
use super::{Battle, BattleError, BattleOptions, BattleSnapshot, Summary, TICK, fight};
use crate::Creature;

/// Ticks from one snapshot to the next: a second.
const SNAPSHOT_EVERY: u64 = 60;

impl From<RecordError> for BattleError {
    fn from(error: RecordError) -> Self {
        Self::Watching(Box::new(error))
    }
}

/// Records a battle as it is fought.
pub struct BattleRecorder<W: Write>(Recorder<W>);

impl<W: Write + Send + 'static> BattleRecorder<W> {
    /// A recorder for a battle that was made from these options, into anything that takes bytes.
    ///
    /// # Errors
    /// [`BattleError::Settings`], and as [`Recorder::new`].
    pub fn new(
        out: W,
        battle: &Battle<'_>,
        options: &BattleOptions,
        how: RecordOptions,
    ) -> Result<Self, BattleError> {
        let creature = battle.creature();
        let info = RecordingInfo {
            creature: creature.name.clone(),
            creature_fingerprint: fingerprint(creature),
            tick_seconds: TICK,
            climber: *battle.climber().config(),
            settings: options.to_settings()?,
            version: RecordingInfo::VERSION.to_owned(),
        };
        Ok(Self(Recorder::new(out, &info, &creature.skeleton, how)?))
    }

    /// Records where the battle stands: before its first tick, and after each.
    ///
    /// # Errors
    /// As [`Recorder::tick`].
    pub fn tick(&mut self, battle: &Battle<'_>) -> Result<(), BattleError> {
        self.0.tick(&TickView {
            tick: battle.tick(),
            input: battle.input(),
            state: battle.climber().state(),
            report: battle.report(),
            surface: battle.surface(),
            palette: battle.palette(),
            scene_fingerprint: battle.rocks_fingerprint(),
        })?;
        if battle.tick().is_multiple_of(SNAPSHOT_EVERY) {
            self.0.snapshot(&battle.snapshot().to_json()?)?;
        }
        Ok(())
    }

    /// Ends the recording.
    ///
    /// # Errors
    /// As [`Recorder::finish`].
    pub fn finish(self) -> Result<W, BattleError> {
        Ok(self.0.finish()?)
    }
}

/// Fights a battle, watched as it is, and records it to a file. What was recorded stays if the battle fails on
/// the way.
pub(super) fn run(
    options: &BattleOptions,
    path: &Path,
    mut watch: impl FnMut(&Battle<'_>) -> Result<(), BattleError>,
) -> Result<Summary, BattleError> {
    let failed = |error: std::io::Error| BattleError::Write {
        path: path.to_owned(),
        reason: error.to_string(),
    };
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    folder
        .map_or(Ok(()), std::fs::create_dir_all)
        .map_err(failed)?;
    let file = std::fs::File::create(path).map_err(failed)?;
    let mut out = Some(std::io::BufWriter::new(file));
    let mut recorder = None;
    let progress = Progress::new(options.ticks());
    let summary = fight(options, &progress, |battle| {
        watch(battle)?;
        if let Some(out) = out.take() {
            let how = RecordOptions::default();
            recorder = Some(BattleRecorder::new(out, battle, options, how)?);
        }
        recorder
            .as_mut()
            .map_or(Ok(()), |recorder| recorder.tick(battle))
    })?;
    if let Some(recorder) = recorder {
        recorder.finish()?;
    }
    Ok(summary)
}

fn fingerprint(creature: &Creature) -> u64 {
    creature_fingerprint(&creature.skeleton, &creature.clips, &creature.collider)
}

/// What came of a replay.
#[derive(Clone, Debug, PartialEq)]
pub struct Replay {
    /// The tick that it started from: the first one, or that of a snapshot.
    pub from: u64,
    /// Ticks that agreed, the one that it started from among them.
    pub agreed: u64,
    /// True if the rocks were compared, false from a snapshot, which has none.
    pub with_rocks: bool,
    /// The first tick that differs, if one does.
    pub difference: Option<Box<Difference>>,
    /// How the file ends.
    pub ending: Ending,
}

/// Fights a recorded battle again, with the recorded inputs, as far as it was recorded or until a tick
/// differs; from the nearest snapshot at or before a tick, if one is given.
///
/// # Errors
/// [`BattleError`] if the battle cannot be made again: its creature's file is gone or another one now, the
/// tick is not there.
pub fn replay(recording: &Recording, from: Option<u64>) -> Result<Replay, BattleError> {
    let info = recording.info();
    let options = BattleOptions::from_settings(&info.settings)?;
    let creature = options.load_creature()?;
    if fingerprint(&creature) != info.creature_fingerprint {
        return Err(BattleError::Settings(format!(
            "{} is not the creature that was recorded; bring back the file it was loaded from",
            creature.name
        )));
    }
    let rocks = if from.is_some() { 0 } else { options.rocks };
    let mut battle = Battle::new(&creature, &BattleOptions { rocks, ..options })?;
    let start = match from {
        Some(from) => {
            let snapshot = recording.snapshot(from)?;
            let scene = BattleSnapshot::from_json(&snapshot.scene)?;
            battle.restore(&scene, snapshot.tick.state)?;
            snapshot.tick.tick
        }
        None => battle.tick(),
    };
    let step = |recorded: &RecordedTick| {
        if recorded.tick > start {
            battle.step_with(recorded.input)?;
        }
        Ok::<_, BattleError>(Replayed {
            state: *battle.climber().state(),
            palette_fingerprint: palette_fingerprint(battle.palette()),
            scene_fingerprint: from.is_none().then(|| battle.rocks_fingerprint()),
        })
    };
    let mut agreed = 0;
    let counted = recording.ticks_from(start).inspect(|_| agreed += 1);
    let difference = match clamber_record::replay(counted, step) {
        Ok(_) => None,
        Err(ReplayError::Differs(difference)) => Some(difference),
        Err(ReplayError::Scene { error, .. }) => return Err(error),
        Err(ReplayError::Record(error)) => return Err(error.into()),
        Err(error) => return Err(BattleError::Watching(error.to_string().into())),
    };
    Ok(Replay {
        from: start,
        agreed: agreed - u64::from(difference.is_some()),
        with_rocks: from.is_none(),
        difference,
        ending: recording.ending().clone(),
    })
}
