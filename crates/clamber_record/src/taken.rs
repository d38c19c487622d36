//! The copy of a tick that is made on the game's thread. The recorder's thread makes the recording from it later.

use std::fmt;
use std::sync::Arc;

use clamber_climber::{ClimberEvent, ClimberInput, ClimberState};
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::JointId;
use clamber_surface::surface::Diagnostics;
use clamber_world::ObstacleId;
use glam::DAffine3;

use crate::messages::Report;
use crate::names::{ObstacleNames, Part, name_of};
use crate::views::{TakenBrain, TakenFigure, TakenScenery};
use crate::{RecordOptions, TickView};

/// A copy of a tick. The memory of its vectors is reused from tick to tick.
#[derive(Debug)]
pub struct Taken {
    pub(crate) tick: u64,
    pub(crate) input: ClimberInput,
    pub(crate) state: ClimberState,
    pub(crate) report: Report,
    pub(crate) world_from_model: Similarity,
    pub(crate) scene_fingerprint: u64,
    pub(crate) events: Vec<ClimberEvent>,
    /// Names of obstacles, for the texts of the events.
    pub(crate) names: ObstacleNames,
    pub(crate) part: Option<Part>,
    pub(crate) matrices: Vec<Affine>,
    /// `model_from_joint` of every joint if transforms are due, else empty.
    pub(crate) joints: Vec<DAffine3>,
    pub(crate) transforms_due: bool,
    /// Data for the views of the skin; `None` if they are not due.
    pub(crate) skin: Option<TakenSkin>,
    /// Figures drawn at the end of this tick.
    pub(crate) figures: Vec<TakenFigure>,
    /// Meshes that are new, or whose places are due.
    pub(crate) scenery: Vec<TakenScenery>,
    /// The creature's brain, if it was recorded.
    pub(crate) brain: Option<TakenBrain>,
    /// Snapshots of the scene after this tick.
    pub(crate) snapshots: Vec<TakenSnapshot>,
    /// Number of ticks left out before this one.
    pub(crate) gap: u64,
}

impl crate::chunks::TakenTick for Taken {
    fn is_saved(&self) -> bool {
        !self.snapshots.is_empty()
    }

    fn follows_gap(&mut self, ticks: u64) {
        self.gap = ticks;
    }

    fn is_due(&self) -> bool {
        self.transforms_due
    }

    fn scenery(&mut self) -> &mut Vec<TakenScenery> {
        &mut self.scenery
    }
}

/// Function that makes the text of a snapshot, or says why it cannot.
pub(crate) struct TakenSnapshot(pub(crate) Box<dyn FnOnce() -> Result<String, String> + Send>);

impl fmt::Debug for TakenSnapshot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("TakenSnapshot")
    }
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

impl Taken {
    pub(crate) fn new(view: &TickView<'_>, options: &RecordOptions, names: &ObstacleNames) -> Self {
        let mut taken = Self {
            tick: view.tick,
            input: *view.input,
            state: *view.state,
            report: view.report.into(),
            world_from_model: *view.surface.world_from_model(),
            scene_fingerprint: view.scene_fingerprint,
            events: Vec::new(),
            names: Arc::clone(names),
            part: None,
            matrices: Vec::new(),
            joints: Vec::new(),
            transforms_due: false,
            skin: None,
            figures: Vec::new(),
            scenery: Vec::new(),
            brain: None,
            snapshots: Vec::new(),
            gap: 0,
        };
        taken.take(view, options, names);
        taken
    }

    /// Copies another tick over this one.
    pub(crate) fn take(
        &mut self,
        view: &TickView<'_>,
        options: &RecordOptions,
        names: &ObstacleNames,
    ) {
        let due = |every: u32| every > 0 && view.tick.is_multiple_of(u64::from(every));
        self.tick = view.tick;
        self.input = *view.input;
        self.state = *view.state;
        self.report = view.report.into();
        self.world_from_model = *view.surface.world_from_model();
        self.scene_fingerprint = view.scene_fingerprint;
        self.events.clone_from(&view.report.events);
        self.part = None;
        if !self.events.is_empty() {
            self.part = Part::of(view.state, view.surface.mesh());
        }
        self.names = Arc::clone(names);
        self.matrices.clear();
        self.matrices.extend_from_slice(view.palette.matrices());
        self.transforms_due = due(options.transforms_every);
        self.joints.clear();
        if self.transforms_due {
            let joints = (0..).map_while(|joint| view.palette.model_from_joint(JointId(joint)));
            self.joints.extend(joints);
        }
        self.skin = due(options.skin_every).then(|| TakenSkin {
            mesh: Arc::clone(view.surface.mesh()),
            touched: view.surface.diagnostics(),
            triangles: due(options.touched_every)
                .then(|| view.surface.touched_triangles().collect()),
            every: options.skin_every,
        });
        self.figures.clear();
        self.scenery.clear();
        self.brain = None;
        self.snapshots.clear();
        self.gap = 0;
    }
    /// The name of an obstacle. If it is the creature and the climber is on it, the name includes the part of the
    /// creature.
    pub(crate) fn name_of(
        &self,
        obstacle: ObstacleId,
        creature: &str,
        joints: &[String],
    ) -> String {
        let name = name_of(&self.names, obstacle);
        match self.part {
            Some(part) if part.is_on(obstacle) && name == creature => part
                .name(creature, |joint| {
                    joints.get(joint.index()).map(String::as_str)
                }),
            _ => name,
        }
    }
}
