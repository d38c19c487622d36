use std::io::Write;
use std::sync::mpsc::SyncSender;

use clamber_surface::geometry::Affine;
use clamber_surface::surface::matrices_fingerprint;
use foxglove::messages::{FrameTransforms, PointCloud};

use super::{ClimberTick, RecordingInfo, TakenSkin};
use crate::messages::{Brain, Mirror, Tick, Touched};
use crate::output::Channel;
use crate::views::{CLIMBER, CREATURE, Scene, frame_of_climber, z_up};
use crate::writing::{EncodeTick, Sheet, Writing};
use crate::{OfClimber, RecordError, RecordingKind, topics};

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
    ) -> Result<Writing<Self, W>, RecordError> {
        let metadata = (
            &OfClimber::TOPICS,
            info.to_metadata()?,
            info.settings.clone(),
        );
        let mut sheet = Sheet::new(out, info.tick_seconds, metadata, skin_points)?;
        let output = &mut sheet.output;
        let encoder = Self {
            tick: output.channel::<Tick>(topics::TICK)?,
            figure: output.channel::<FrameTransforms>(topics::FIGURE)?,
            brain: output.channel::<Brain>(topics::BRAIN)?,
            skin: output.channel::<PointCloud>(topics::SKIN)?,
            touched: output.channel::<Touched>(topics::TOUCHED)?,
            scene: Scene::new(&info.climber, info.tick_seconds),
            written,
        };
        Ok(Writing::new(encoder, sheet))
    }

    /// Writes the views of the skin.
    fn look<W: Write>(
        &mut self,
        now: u64,
        (data, view): (&ClimberTick, &TakenSkin),
        sheet: &mut Sheet<W>,
    ) -> Result<(), RecordError> {
        let frame = (CREATURE, data.world_from_model.scale);
        let points = sheet.skin(now, frame, (&view.mesh, &data.matrices))?;
        let scene = self.scene.message(now, data, view, &sheet.positions);
        let output = &mut sheet.output;
        output.send(self.touched, &Touched::from(view.touched))?;
        output.send(self.skin, &points)?;
        output.send(sheet.scene, &scene)
    }
}

impl EncodeTick for ClimberEncoder {
    type Data = ClimberTick;

    fn tick<W: Write>(
        &mut self,
        (tick, now): (u64, u64),
        mut data: ClimberTick,
        sheet: &mut Sheet<W>,
    ) -> Result<(), RecordError> {
        let message = Tick {
            tick,
            input: Mirror::of(&data.input),
            state: Mirror::of(&data.state),
            report: data.report.clone(),
            state_fingerprint: data.state.fingerprint(),
            palette_fingerprint: matrices_fingerprint(&data.matrices),
            scene_fingerprint: data.scene_fingerprint,
        };
        sheet.output.send_exact(self.tick, &message)?;
        if let Some(creature) = &data.creature {
            let mut transforms = creature.frames(now);
            let climber = frame_of_climber(now, CLIMBER, &data.state);
            transforms.extend([z_up(now), climber]);
            sheet.transforms(transforms)?;
        }
        for figure in &data.figures {
            let transforms = figure.frames(now);
            sheet
                .output
                .send(self.figure, &FrameTransforms { transforms })?;
        }
        if let Some(brain) = &data.brain {
            sheet.output.send(self.brain, brain)?;
        }
        // The mesh is released as soon as possible: until then, an edit has to copy it.
        if let Some(view) = data.skin.take() {
            self.look(now, (&data, &view), sheet)?;
        }
        // Memory that nobody waits for is freed here.
        let _ = self.written.try_send(data.matrices);
        Ok(())
    }
}
