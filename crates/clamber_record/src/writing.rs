use std::collections::BTreeMap;
use std::io::Write;

use clamber_surface::geometry::Affine;
use clamber_surface::mesh::ColliderMesh;
use clamber_surface::skin::skin_into;
use foxglove::messages::{FrameTransform, FrameTransforms, Log, PointCloud, SceneUpdate};
use glam::Vec3;

use crate::chunks::WriteTicks;
use crate::kind::Topics;
use crate::messages::Saved;
use crate::output::{Channel, Output};
use crate::taken::{Taken, TakenState};
use crate::views::{Sceneries, gap_line, skin};
use crate::{RecordError, RecordingInfo, topics};

/// Encodes the data of one kind of ticks.
pub(crate) trait EncodeTick: Send + 'static {
    type Data: Send + 'static;

    /// Sends the messages of a tick, which has a number and a time in nanoseconds. Log lines, meshes and saved states are
    /// sent by [`Writing`].
    fn tick<W: Write>(
        &mut self,
        tick: (u64, u64),
        data: Self::Data,
        sheet: &mut Sheet<W>,
    ) -> Result<(), RecordError>;
}

/// The file of a recording, with the channels that both kinds have.
pub(crate) struct Sheet<W: Write> {
    pub(crate) output: Output<W>,
    pub(crate) scene: Channel,
    transforms: Channel,
    scenery: Channel,
    saved: Channel,
    log: Channel,
    /// Largest number of points of a skin.
    skin_points: usize,
    /// Posed positions of a creature's vertices, kept so that their memory is reused.
    pub(crate) positions: Vec<Vec3>,
}

impl<W: Write> Sheet<W> {
    /// Begins a file with its metadata: the records of the kind and of the caller's settings.
    pub(crate) fn new(
        out: W,
        tick_seconds: f64,
        (topics, own, settings): (&Topics, BTreeMap<String, String>, BTreeMap<String, String>),
        skin_points: usize,
    ) -> Result<Self, RecordError> {
        let metadata = [(topics.metadata, own), (RecordingInfo::SETTINGS, settings)];
        let mut output = Output::new(out, tick_seconds, metadata)?;
        Ok(Self {
            scene: output.channel::<SceneUpdate>(topics::SCENE)?,
            transforms: output.channel::<FrameTransforms>(topics::TRANSFORMS)?,
            scenery: output.channel::<SceneUpdate>(topics::SCENERY)?,
            saved: output.channel::<Saved>(topics.saved)?,
            log: output.channel::<Log>(topics::LOG)?,
            output,
            skin_points,
            positions: Vec::new(),
        })
    }

    pub(crate) fn log(&mut self, line: Log) -> Result<(), RecordError> {
        self.output.log(self.log, line)
    }

    pub(crate) fn transforms(
        &mut self,
        transforms: Vec<FrameTransform>,
    ) -> Result<(), RecordError> {
        let message = FrameTransforms { transforms };
        self.output.send(self.transforms, &message)
    }

    /// Poses the vertices of a mesh into `positions`, and makes the view of the skin in a frame of this name and scale.
    pub(crate) fn skin(
        &mut self,
        now: u64,
        frame: (&str, f64),
        (mesh, matrices): (&ColliderMesh, &[Affine]),
    ) -> Result<PointCloud, RecordError> {
        let posed = skin_into(mesh, matrices, &mut self.positions);
        posed.map_err(|error| RecordError::encode(topics::SKIN, error))?;
        Ok(skin(now, frame, (mesh, &self.positions), self.skin_points))
    }
}

/// Encodes ticks and writes them.
pub(crate) struct Writing<E, W: Write> {
    encoder: E,
    sheet: Sheet<W>,
    meshes: Sceneries,
}

impl<E: EncodeTick, W: Write> Writing<E, W> {
    pub(crate) fn new(encoder: E, sheet: Sheet<W>) -> Self {
        Self {
            encoder,
            sheet,
            meshes: Sceneries::default(),
        }
    }

    /// Calls the functions that make the saved states of a tick.
    fn states(&self, taken: &mut Taken<E::Data>) -> Result<Vec<Saved>, RecordError> {
        let tick = taken.tick;
        let states = taken.saved.drain(..);
        let states = states.map(|TakenState(state)| {
            let state = state().map(|state| Saved {
                tick,
                state: state.into(),
            });
            state.map_err(|reason| RecordError::encode(self.sheet.saved.topic(), reason))
        });
        states.collect()
    }

    fn tick(&mut self, taken: Taken<E::Data>, saved: &[Saved]) -> Result<(), RecordError> {
        let sheet = &mut self.sheet;
        let now = sheet.output.begin(taken.tick);
        self.encoder.tick((taken.tick, now), taken.data, sheet)?;
        for state in saved {
            sheet.output.send_exact(sheet.saved, state)?;
        }
        for line in gap_line(taken.gap).into_iter().chain(taken.lines) {
            sheet.log(line)?;
        }
        let frames = self.meshes.frames(now, &taken.scenery);
        if !frames.is_empty() {
            sheet.transforms(frames)?;
        }
        if let Some(shapes) = self.meshes.shapes(now, taken.scenery) {
            sheet.output.send(sheet.scenery, &shapes)?;
        }
        match self.meshes.take_line() {
            Some(line) => sheet.log(line),
            None => Ok(()),
        }
    }
}

impl<E: EncodeTick, W: Write + Send + 'static> WriteTicks<E::Data, W> for Writing<E, W> {
    fn chunk(&mut self, ticks: Vec<Taken<E::Data>>) -> Result<(), RecordError> {
        for mut taken in ticks {
            let saved = match self.states(&mut taken) {
                Ok(saved) => saved,
                Err(error) => {
                    // The ticks before this one are kept.
                    self.sheet.output.flush()?;
                    return Err(error);
                }
            };
            self.tick(taken, &saved)?;
            self.sheet.output.flush_if_large()?;
        }
        self.sheet.output.flush()
    }

    fn ends_in_gap(&mut self, ticks: u64) -> Result<(), RecordError> {
        if let Some(line) = gap_line(ticks) {
            self.sheet.log(line)?;
        }
        self.sheet.output.ends_in_gap(ticks)
    }

    fn finish(self) -> Result<W, RecordError> {
        self.sheet.output.finish()
    }
}
