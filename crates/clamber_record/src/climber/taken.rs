use std::sync::Arc;

use clamber_climber::{ClimberInput, ClimberState};
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::surface::Diagnostics;

use super::TickView;
use crate::RecordOptions;
use crate::messages::{Brain, Report};
use crate::views::{FigureJoints, TakenFigure};

/// The copy of a climber's tick that is made on the game's thread.
#[derive(Debug)]
pub struct ClimberTick {
    pub(crate) input: ClimberInput,
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
            input: *view.input,
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
