//! A creature: a value that its owner steps once a tick.

mod act;
mod back;
mod carry;
mod check_way;
mod clips;
mod config;
mod corners;
mod course;
mod feel;
mod foresee;
mod ground;
mod head;
mod hips;
mod hurt;
mod legs;
mod move_on;
mod ordered;
mod press;
mod ranged;
mod report;
mod room;
mod size;
mod state;
mod step;
mod strike;
mod think;
mod walked;
mod way;
mod world;

use std::sync::Arc;

use clamber_animation::PoseBuffers;
use clamber_animation::rig::{Palette, Pose};
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

pub use config::CreatureConfig;
pub use foresee::Foresight;
pub use ranged::{ActiveShot, ActiveWave};
pub use report::{ActiveBeam, AttackPhase, CreatureEvent, CreatureReport, StrikeHit};
pub use state::CreatureState;
use state::Sound;
pub use world::{Noise, Person, Riding, Surroundings};

use self::legs::PutLeg;
use self::size::Size;
use crate::error::ColossusError;
use crate::kind::CreatureKind;

/// A living creature: it senses, decides, moves, and hurts people with its limbs.
///
/// The [`CreatureState`] is all that has to be saved. Climbers and weapons touch the [`SkinnedSurface`], which each
/// step poses.
#[derive(Clone, Debug)]
pub struct Creature {
    kind: Arc<CreatureKind>,
    config: CreatureConfig,
    size: Size,
    state: CreatureState,
    surface: SkinnedSurface,
    palette: Palette,
    buffers: PoseBuffers,
    report: CreatureReport,
    events: Vec<clamber_animation::AnimationEvent>,
    /// Buffer for the legs, reused so that a step does not allocate.
    legs: Vec<PutLeg>,
    /// Buffer for the skin of a sole, reused so that a step does not allocate.
    sole: Vec<DVec3>,
    /// True while the skin is known to be without motion.
    is_still: bool,
    /// For each plate: whether the skin shows it. It follows the state of the plate.
    shows_plate: Vec<bool>,
}

impl Creature {
    /// Creates a creature at its initial place, in its first pose.
    ///
    /// # Errors
    /// [`ColossusError::OutOfRange`] if the configuration is not valid, [`ColossusError::Animation`] or
    /// [`ColossusError::Surface`] if the clips cannot pose the skin.
    pub fn new(kind: Arc<CreatureKind>, config: CreatureConfig) -> Result<Self, ColossusError> {
        config.check()?;
        let size = Size::new(&kind, &config);
        let state = CreatureState::new(&kind, &config, size.rate);
        let mut creature = Self {
            surface: SkinnedSurface::new(Arc::clone(kind.mesh())),
            palette: Palette::default(),
            buffers: PoseBuffers::default(),
            report: CreatureReport::default(),
            events: Vec::new(),
            legs: Vec::new(),
            sole: Vec::new(),
            is_still: false,
            shows_plate: vec![true; kind.plates().len()],
            kind,
            config,
            size,
            state,
        };
        let clips = Arc::clone(&creature.kind);
        let state = &mut creature.state;
        let animator = state.clips.animator();
        animator.pose_into(clips.clips(), &mut state.pose, &mut creature.buffers)?;
        creature.place()?;
        Ok(creature)
    }

    /// The kind of the creature: the skeleton, clips, skin, weak points, plates and brain that all creatures of this
    /// kind share.
    pub fn kind(&self) -> &Arc<CreatureKind> {
        &self.kind
    }

    /// The configuration with which the creature was created.
    pub fn config(&self) -> &CreatureConfig {
        &self.config
    }

    /// The state of the creature: everything that has to be saved.
    pub fn state(&self) -> &CreatureState {
        &self.state
    }

    /// The skin as the last step posed it: the obstacle for climbers and weapons.
    pub fn surface(&self) -> &SkinnedSurface {
        &self.surface
    }

    /// The skin, for disabling parts of it, so that weapons and climbers no longer touch them, or for editing it. A
    /// step poses it anew, unless the creature sleeps and is still. [`CreatureState`] does not save such changes.
    pub fn surface_mut(&mut self) -> &mut SkinnedSurface {
        &mut self.surface
    }

    /// The transforms of the joints, each relative to its parent, after the last step, with feet on the ground and the
    /// head turned.
    pub fn pose(&self) -> &Pose {
        &self.state.pose
    }

    /// The skinning matrices after the last step, for drawing: one per joint, from mesh space at rest to model space.
    /// [`Creature::surface`] has the model's place in the world. Before the first step they are those of the first
    /// pose.
    pub fn palette(&self) -> &Palette {
        &self.palette
    }

    /// Events, blows and the beam of the last step.
    pub fn report(&self) -> &CreatureReport {
        &self.report
    }

    /// Restores a saved state. The skin is teleported, so that it has no motion, and later steps give the same bits as
    /// after the state was saved.
    ///
    /// # Errors
    /// [`ColossusError::OtherKind`] if the state belongs to another kind of creature; also the errors of posing the
    /// skin. The creature is unchanged then.
    pub fn restore(&mut self, mut state: CreatureState) -> Result<(), ColossusError> {
        self.swap_state(&mut state)
    }

    /// Restores a saved state as [`Creature::restore`] does, and leaves the previous state in `state`.
    ///
    /// # Errors
    /// As [`Creature::restore`]. Both states are unchanged then.
    pub fn swap_state(&mut self, state: &mut CreatureState) -> Result<(), ColossusError> {
        state.check(&self.kind)?;
        std::mem::swap(&mut self.state, state);
        if let Err(error) = self.place() {
            std::mem::swap(&mut self.state, state);
            self.place()?;
            return Err(error);
        }
        self.state.sound = Sound(self.kind.number());
        self.hide_broken_plates();
        self.is_still = false;
        Ok(())
    }
}
