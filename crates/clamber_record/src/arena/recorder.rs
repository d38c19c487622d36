use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

use clamber_climber::ClimberInput;
use clamber_fight::{Arena, CreatureId, Order, creature_obstacle, fighter_obstacle};
use clamber_world::{Obstacle, ObstacleId};

use super::ArenaInfo;
use super::lines::Words;
use super::taken::{Due, TakenArena};
use super::writing::ArenaWriting;
use crate::chunks::Chunks;
use crate::names::ObstacleNames;
use crate::recorder::create;
use crate::views::{FigureJoints, SceneryNames, SceneryView};
use crate::{RecordError, RecordOptions};

/// Writes a recording of an arena: its inputs and fingerprints in each tick, so that
/// [`ArenaRecording::replay`](super::ArenaRecording::replay) can play it again and compare; a saved state at the
/// beginning of each chunk, to start from; and for people to look at, creatures, climbers, arrows, brains, and all
/// events in words.
///
/// It writes on a thread of its own, chunk by chunk, as [`Recorder`](crate::Recorder) does, and what is said there of
/// files that were cut holds here too.
pub struct ArenaRecorder<W: Write> {
    options: RecordOptions,
    info: ArenaInfo,
    names: ObstacleNames,
    /// Of the creatures that were seen.
    joints: BTreeMap<CreatureId, Arc<FigureJoints>>,
    /// Fighters at the end of the tick recorded last.
    fighters: usize,
    /// The numbers that the next creature and the next fighter got then: those below have names.
    named: [u32; 2],
    scenery: SceneryNames,
    chunks: Chunks<TakenArena, W>,
}

impl ArenaRecorder<BufWriter<File>> {
    /// A recorder that writes to a new file. An existing file at that path is overwritten.
    ///
    /// # Errors
    /// [`RecordError::Io`] if the file cannot be created, and as [`ArenaRecorder::new`].
    pub fn create(
        path: impl AsRef<Path>,
        info: &ArenaInfo,
        arena: &Arena,
        options: RecordOptions,
    ) -> Result<Self, RecordError> {
        Self::new(create(path.as_ref())?, info, arena, options)
    }
}

impl<W: Write + Send + 'static> ArenaRecorder<W> {
    /// A recorder that writes to `out`, which it owns. The recording begins with the arena as it is now.
    ///
    /// # Errors
    /// [`RecordError::OtherArena`] if `info` is of another arena, [`RecordError::Names`] if its names are not one each,
    /// [`RecordError::TickSeconds`], [`RecordError::Write`] if `out` fails, [`RecordError::Io`] if the thread cannot be
    /// started.
    pub fn new(
        out: W,
        info: &ArenaInfo,
        arena: &Arena,
        options: RecordOptions,
    ) -> Result<Self, RecordError> {
        info.check_names(arena)?;
        let writing = ArenaWriting::new(out, info, options.skin_points)?;
        let mut recorder = Self {
            options,
            names: ObstacleNames::default(),
            info: info.clone(),
            joints: BTreeMap::new(),
            fighters: 0,
            named: [0; 2],
            scenery: SceneryNames::default(),
            chunks: Chunks::start(writing, (options.chunk_ticks, options.waits))?,
        };
        recorder.take(arena, (&[], &[]), &[])?;
        Ok(recorder)
    }
}

impl<W: Write> ArenaRecorder<W> {
    /// Records the arena after a step, with the inputs, the orders and the terrain of that step.
    ///
    /// # Errors
    /// [`RecordError::Order`] unless it was stepped once since the last call, [`RecordError::Inputs`] for a wrong number of
    /// inputs, [`RecordError::OtherArena`] if it is another arena. Such a tick is not recorded, but recording can go
    /// on. [`RecordError::Write`] or another error if an earlier chunk could not be written, and [`RecordError::Ended`]
    /// at every call after that.
    ///
    /// # Panics
    /// If `out` panicked while an earlier chunk was written: that panic is resumed here.
    pub fn tick(
        &mut self,
        arena: &Arena,
        inputs: &[ClimberInput],
        orders: &[Order],
        terrain: &[(ObstacleId, &dyn Obstacle)],
    ) -> Result<(), RecordError> {
        let (fighters, found) = (self.fighters, inputs.len());
        if fighters != found {
            return Err(RecordError::Inputs { fighters, found });
        }
        self.take(arena, (inputs, orders), terrain)
    }

    /// Gives names to who has joined.
    fn name_all(&mut self, arena: &Arena) {
        let next = [arena.next_creature().0, arena.next_fighter().0];
        // Only those who are there: a state may count further than there is memory for names.
        let creatures = arena.creatures().map(|(id, _)| id);
        let creatures = creatures.filter(|id| id.0 >= self.named[0]);
        let creatures = creatures.map(|id| {
            let name = self.info.creature(id.0 as usize);
            (creature_obstacle(id), name)
        });
        let fighters = arena.fighters().iter().map(|fighter| fighter.id());
        let fighters = fighters.filter(|id| id.0 >= self.named[1]);
        let fighters = fighters.map(|id| {
            let name = self.info.fighter(id.0 as usize);
            (fighter_obstacle(id), name)
        });
        let new: Vec<(ObstacleId, String)> = creatures.chain(fighters).collect();
        if !new.is_empty() {
            Arc::make_mut(&mut self.names).extend(new);
        }
        self.named = next;
        for (id, creature) in arena.creatures() {
            let joints = || {
                let name = self.info.creature(id.0 as usize);
                Arc::new(FigureJoints::new(&name, creature.kind().skeleton()))
            };
            self.joints.entry(id).or_insert_with(joints);
        }
    }

    fn take(
        &mut self,
        arena: &Arena,
        inputs: (&[ClimberInput], &[Order]),
        terrain: &[(ObstacleId, &dyn Obstacle)],
    ) -> Result<(), RecordError> {
        let (recorded, found) = (self.info.config, arena.config_hash());
        if recorded != found {
            return Err(RecordError::OtherArena { recorded, found });
        }
        let tick = arena.tick();
        self.chunks.check(tick)?;
        self.name_all(arena);
        self.fighters = arena.fighters().len();
        let is_due = |every: u32| every > 0 && tick.is_multiple_of(u64::from(every));
        let due = Due {
            views: is_due(self.options.transforms_every),
            skin: is_due(self.options.skin_every),
        };
        let mut taken = TakenArena::new(arena, inputs, terrain, &self.joints, due)?;
        let words = Words {
            arena,
            orders: inputs.1,
            info: &self.info,
            names: &self.names,
        };
        taken.lines = words.lines(crate::output::time(tick, self.info.tick_seconds));
        if self.chunks.begins() {
            taken.saved = Some(arena.to_bytes()?);
        }
        self.chunks.push(tick, |place| match place {
            Some(place) => {
                *place = taken;
                None
            }
            None => Some(taken),
        })
    }

    /// Gives terrain a name, by which the log calls it from the next tick on. Creatures and fighters have those of
    /// [`ArenaInfo`].
    pub fn name(&mut self, obstacle: ObstacleId, name: &str) {
        let names = Arc::make_mut(&mut self.names);
        names.retain(|(id, _)| *id != obstacle);
        names.push((obstacle, name.to_owned()));
    }

    /// Ticks that were left out so far, since the disk was too slow: [`RecordOptions::waits`].
    pub fn dropped(&self) -> u64 {
        self.chunks.dropped()
    }

    /// [`Recorder::is_due`](crate::Recorder::is_due).
    ///
    /// # Errors
    /// [`RecordError::NoTick`] before the first tick; [`RecordError::Ended`] after writing failed.
    pub fn is_due(&mut self) -> Result<bool, RecordError> {
        Ok(self.chunks.last()?.is_due)
    }

    /// Records a mesh at the tick recorded last, for people to look at, such as the ground or a rock: its shape the
    /// first time, its place whenever [`RecordOptions::transforms_every`] lets transforms be due. What stands still is
    /// recorded once.
    ///
    /// # Errors
    /// [`RecordError::Ended`] after writing failed.
    pub fn scenery(&mut self, view: &SceneryView<'_>) -> Result<(), RecordError> {
        let last = self.chunks.last()?;
        let taken = self.scenery.take(view, last.is_due);
        last.scenery.extend(taken);
        Ok(())
    }

    /// Writes the remaining ticks and the index, and gives back `out`.
    ///
    /// # Errors
    /// [`RecordError::Write`] or another error if a chunk or the index could not be written;
    /// [`RecordError::Ended`] if [`ArenaRecorder::tick`] has returned that error already.
    ///
    /// # Panics
    /// If `out` panicked: that panic is resumed here.
    pub fn finish(mut self) -> Result<W, RecordError> {
        self.chunks.finish()
    }
}
