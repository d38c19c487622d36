//! The copy of a climber's tick that is made on the game's thread, and the messages that are made from it.

use std::io::Write;
use std::sync::Arc;
use std::sync::mpsc::SyncSender;

use clamber_climber::{ClimberInput, ClimberState, Knockback};
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::surface::{Diagnostics, matrices_fingerprint};
use foxglove::messages::{FrameTransforms, PointCloud};

use super::{RecordingInfo, TickView};
use crate::messages::{Brain, Mirror, Report, Tick, Touched};
use crate::output::{Channel, Output};
use crate::views::{CLIMBER, CREATURE, FigureJoints, Scene, TakenFigure, frame_of_climber, z_up};
use crate::{OfClimber, RecordError, RecordOptions, RecordingKind, topics};

/// The copy of a climber's tick that is made on the game's thread.
#[derive(Debug)]
pub struct ClimberTick {
    pub(crate) tick: u64,
    pub(crate) input: ClimberInput,
    pub(crate) knockback: Option<Knockback>,
    pub(crate) state: ClimberState,
    pub(crate) report: Report,
    pub(crate) scene_fingerprint: u64,
    pub(crate) world_from_model: Similarity,
    pub(crate) matrices: Vec<Affine>,
    /// The creature's joints; `None` if transforms are not due.
    pub(crate) creature: Option<TakenFigure>,
    /// Data for the views of the skin; `None` if they are not due.
    pub(crate) skin: Option<TakenSkin>,
    /// Figures drawn at the end of this tick.
    pub(crate) figures: Vec<TakenFigure>,
    /// The creature's brain, if it was recorded and is due.
    pub(crate) brain: Option<Brain>,
}

/// Data for the views of the skin, besides the palette.
#[derive(Debug)]
pub(crate) struct TakenSkin {
    pub(crate) mesh: Arc<ColliderMesh>,
    pub(crate) touched: Diagnostics,
    /// Triangles that queries touched; `None` if they are not due.
    pub(crate) triangles: Option<Vec<TriangleId>>,
    /// Ticks until the next view.
    pub(crate) every: u32,
}

impl ClimberTick {
    /// Copies a tick. `matrices` is memory for the palette, whose content does not matter.
    pub(super) fn new(
        view: &TickView<'_>,
        options: &RecordOptions,
        creature: &Arc<FigureJoints>,
        mut matrices: Vec<Affine>,
    ) -> Self {
        let (surface, palette) = (view.surface, view.palette);
        matrices.clear();
        matrices.extend_from_slice(palette.matrices());
        let world_from_model = *surface.world_from_model();
        let due = |every| options.is_due(every, view.tick);
        Self {
            tick: view.tick,
            input: *view.input,
            knockback: view.knockback,
            state: *view.state,
            report: view.report.into(),
            scene_fingerprint: view.scene_fingerprint,
            world_from_model,
            matrices,
            creature: due(options.transforms_every)
                .then(|| TakenFigure::new(Arc::clone(creature), palette, world_from_model)),
            skin: due(options.skin_every).then(|| TakenSkin {
                mesh: Arc::clone(surface.mesh()),
                touched: surface.diagnostics(),
                triangles: due(options.touched_every)
                    .then(|| surface.touched_triangles().collect()),
                every: options.skin_every,
            }),
            figures: Vec::new(),
            brain: None,
        }
    }
}

/// Encodes ticks of a climber.
pub(super) struct ClimberEncoder {
    tick: Channel,
    figure: Channel,
    brain: Channel,
    skin: Channel,
    touched: Channel,
    scene: Scene,
    /// Gives the memory of palettes back to the game's thread.
    written: SyncSender<Vec<Affine>>,
}

impl ClimberEncoder {
    pub(super) fn begin<W: Write>(
        out: W,
        info: &RecordingInfo,
        skin_points: usize,
        written: SyncSender<Vec<Affine>>,
    ) -> Result<(Self, Output<W>), RecordError> {
        let (own, settings) = (info.to_metadata()?, info.settings.clone());
        let metadata = (&OfClimber::TOPICS, own, settings);
        let mut output = Output::new(out, info.tick_seconds, metadata, skin_points)?;
        let encoder = Self {
            tick: output.channel::<Tick>(topics::TICK, None)?,
            figure: output.channel::<FrameTransforms>(topics::FIGURE, None)?,
            brain: output.channel::<Brain>(topics::BRAIN, None)?,
            skin: output.channel::<PointCloud>(topics::SKIN, None)?,
            touched: output.channel::<Touched>(topics::TOUCHED, None)?,
            scene: Scene::new(&info.climber, info.tick_seconds),
            written,
        };
        Ok((encoder, output))
    }

    /// Writes the views of the skin.
    fn look<W: Write>(
        &mut self,
        (data, view): (&ClimberTick, &TakenSkin),
        output: &mut Output<W>,
    ) -> Result<(), RecordError> {
        let frame = (CREATURE, data.world_from_model.scale);
        let points = output.skin(frame, (&view.mesh, &data.matrices))?;
        let positions = &output.positions;
        let scene = self.scene.message(output.now, data, view, positions);
        output.send(self.touched, &Touched::from(view.touched))?;
        output.send(self.skin, &points)?;
        output.send(output.scene, &scene)
    }

    /// Sends the messages of a tick.
    pub(super) fn tick<W: Write>(
        &mut self,
        mut data: ClimberTick,
        output: &mut Output<W>,
    ) -> Result<(), RecordError> {
        let now = output.now;
        let message = Tick {
            tick: data.tick,
            input: Mirror::of(&data.input),
            knockback: Mirror::of(&data.knockback),
            state: Mirror::of(&data.state),
            report: data.report.clone(),
            state_fingerprint: data.state.fingerprint(),
            palette_fingerprint: matrices_fingerprint(&data.matrices),
            scene_fingerprint: data.scene_fingerprint,
        };
        output.send_exact(self.tick, &message)?;
        if let Some(creature) = &data.creature {
            let mut transforms = creature.frames(now);
            let climber = frame_of_climber(now, CLIMBER, &data.state);
            transforms.extend([z_up(now), climber]);
            output.transforms(transforms)?;
        }
        for figure in &data.figures {
            let transforms = figure.frames(now);
            output.send(self.figure, &FrameTransforms { transforms })?;
        }
        if let Some(brain) = &data.brain {
            output.send(self.brain, brain)?;
        }
        // The mesh is released as soon as possible: until then, an edit has to copy it.
        if let Some(view) = data.skin.take() {
            self.look((&data, &view), output)?;
        }
        // Memory that nobody waits for is freed here.
        let _ = self.written.try_send(data.matrices);
        Ok(())
    }
}
