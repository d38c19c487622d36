use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

use clamber_climber::ClimberInput;
use clamber_fight::{Arena, CreatureId, Order, creature_obstacle, fighter_obstacle};
use clamber_world::{Obstacle, ObstacleId};

use super::ArenaInfo;
use super::info::next;
use super::lines::Words;
use super::tick::{ArenaEncoder, ArenaView, TakenArena};
use crate::chunks::Taken;
use crate::recorder::create;
use crate::views::FigureJoints;
use crate::{OfArena, RecordError, RecordOptions, RecorderOf};

/// Writes a recording of an arena.
///
/// Each tick has its inputs, orders and fingerprints, which [`ArenaRecording::replay`](super::ArenaRecording::replay)
/// plays again and compares. Each chunk begins with a saved state, from which a replay can start. Creatures, climbers,
/// arrows, brains, and log lines of the events are for people to look at.
///
/// Like [`Recorder`](crate::Recorder), it writes chunk by chunk on a thread of its own, and a file that was cut is
/// readable up to its last whole chunk.
pub type ArenaRecorder<W> = RecorderOf<OfArena, W>;

/// Data that an arena's recorder keeps from tick to tick.
#[derive(Debug)]
pub struct ArenaMemory {
    info: ArenaInfo,
    /// Joints of the creatures that were seen.
    joints: BTreeMap<CreatureId, Arc<FigureJoints>>,
    /// Fighters at the end of the tick recorded last.
    fighters: usize,
    /// The numbers of the next creature and the next fighter at the end of that tick. All lower numbers have names.
    named: [u32; 2],
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
    /// [`RecordError::OtherArena`] if `info` is of another arena, [`RecordError::Names`] if its names do not fit the
    /// arena, [`RecordError::TickSeconds`] if its duration of a tick is not positive or not finite,
    /// [`RecordError::Write`] if `out` fails, [`RecordError::Io`] if the thread cannot be started.
    pub fn new(
        out: W,
        info: &ArenaInfo,
        arena: &Arena,
        options: RecordOptions,
    ) -> Result<Self, RecordError> {
        info.check_names(arena)?;
        let (mut encoder, output) = ArenaEncoder::begin(out, info, options.skin_points)?;
        let memory = ArenaMemory {
            info: info.clone(),
            joints: BTreeMap::new(),
            fighters: 0,
            named: [0; 2],
        };
        let mut recorder = Self::start(output, memory, options, move |data, output| {
            encoder.tick(data, output)
        })?;
        recorder.check(arena)?;
        recorder.take(arena, (&[], &[]), &[])?;
        Ok(recorder)
    }
}

impl<W: Write> ArenaRecorder<W> {
    /// Records the arena after a step, with the inputs, the orders and the terrain of that step.
    ///
    /// # Errors
    /// [`RecordError::Order`] unless the arena was stepped exactly once since the last call, [`RecordError::Inputs`]
    /// for a wrong number of inputs, [`RecordError::OtherArena`] if it is another arena. Such a tick is not recorded,
    /// but recording can go on. [`RecordError::Joined`] if creatures or fighters were added between two ticks, or
    /// before the first step, other than by an order: recording cannot go on then. [`RecordError::Write`] or another
    /// error if an earlier chunk could not be written, and [`RecordError::Ended`] at every call after that.
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
        self.check(arena)?;
        let joins = |is: fn(&Order) -> bool| orders.iter().filter(|order| is(order)).count();
        let joined = [
            joins(|order| matches!(order, Order::AddCreature { .. })),
            joins(|order| matches!(order, Order::AddFighter { .. })),
        ];
        let known = self.memory.named.iter().zip(joined);
        let known = known.map(|(known, joined)| u64::from(*known) + joined as u64);
        if !known.eq(next(arena).map(u64::from)) {
            return Err(RecordError::Joined);
        }
        let (fighters, found) = (self.memory.fighters, inputs.len());
        if fighters != found {
            return Err(RecordError::Inputs { fighters, found });
        }
        self.take(arena, (inputs, orders), terrain)
    }

    /// Refuses another arena, a tick that does not follow the last one, and every tick once writing has failed.
    fn check(&self, arena: &Arena) -> Result<(), RecordError> {
        let (recorded, found) = (self.memory.info.config, arena.config_hash());
        if recorded != found {
            return Err(RecordError::OtherArena { recorded, found });
        }
        self.chunks.check(arena.tick())
    }

    /// Names the creatures and fighters that have joined.
    fn name_all(&mut self, arena: &Arena) {
        let memory = &mut self.memory;
        // Only creatures and fighters that are present get names: the next number of a state may be so high that the
        // names of all lower numbers do not fit in memory.
        for (id, creature) in arena.creatures() {
            let name = || memory.info.creature(id.0 as usize);
            if id.0 >= memory.named[0] {
                self.names.entry(creature_obstacle(id)).or_insert_with(name);
            }
            let new = || Arc::new(FigureJoints::new(&name(), creature.kind().skeleton()));
            memory.joints.entry(id).or_insert_with(new);
        }
        for id in arena.fighters().iter().map(|fighter| fighter.id()) {
            if id.0 >= memory.named[1] {
                let name = || memory.info.fighter(id.0 as usize);
                self.names.entry(fighter_obstacle(id)).or_insert_with(name);
            }
        }
        memory.named = next(arena);
    }

    fn take(
        &mut self,
        arena: &Arena,
        inputs: (&[ClimberInput], &[Order]),
        terrain: &[(ObstacleId, &dyn Obstacle)],
    ) -> Result<(), RecordError> {
        let tick = arena.tick();
        self.name_all(arena);
        self.memory.fighters = arena.fighters().len();
        let is_due = self.options.is_due(self.options.transforms_every, tick);
        let has_skin = self.options.is_due(self.options.skin_every, tick);
        let mut data = TakenArena::new(arena, inputs)?;
        let joints = &self.memory.joints;
        data.view = is_due.then(|| ArenaView::new(arena, terrain, joints, has_skin));
        let mut taken = Taken::new(tick, data, is_due);
        let words = Words {
            arena,
            orders: inputs.1,
            info: &self.memory.info,
            names: &self.names,
        };
        taken.lines = words.lines();
        if self.chunks.begins() {
            let state = arena.to_bytes()?;
            taken.saved.push(Box::new(move || Ok(state)));
        }
        self.chunks.push(taken)
    }
}
