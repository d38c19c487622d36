//! The state of a creature: one group of fields for each phase of its step. A group's fields are private to the file of
//! its phase.

use clamber_animation::rig::Pose;
use clamber_animation::{Animator, PoseBuffers};
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::CreatureConfig;
use super::act::Acting;
use super::carry::MovingGround;
use super::clips::{Clips, PassedMarkers};
use super::feel::Perceived;
use super::ground::OnGround;
use super::head::HeadTurn;
use super::hips::Hips;
use super::hurt::Damage;
use super::move_on::Motion;
use super::ranged::Ranged;
use super::step::Clock;
use super::strike::Striking;
use super::walked::Walked;
use super::way::Territory;
use crate::brain::{BrainState, StateId};
use crate::error::ColossusError;
use crate::feet::Foot;
use crate::kind::CreatureKind;
use crate::senses::Senses;

/// Everything of a creature that changes and has to be saved, as it is after a step: a plain value.
/// [`Creature::state`](crate::Creature::state) gives the one of a living creature.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CreatureState {
    /// The kind of creature for which this state is known to be valid. A state that was deserialised is checked
    /// instead.
    #[serde(skip)]
    pub(super) sound: Sound,
    pub(super) brain: BrainState,
    pub(super) senses: Senses,
    pub(super) clips: Clips,
    pub(super) acting: Acting,
    pub(super) on_ground: OnGround,
    pub(super) moving_ground: MovingGround,
    /// Knowledge about the current way.
    pub(super) walked: Walked,
    pub(super) motion: Motion,
    pub(super) feet: Vec<Foot>,
    pub(super) hips: Hips,
    pub(super) head: HeadTurn,
    pub(super) territory: Territory,
    pub(super) perceived: Perceived,
    pub(super) damage: Damage,
    pub(super) striking: Striking,
    pub(super) ranged: Ranged,
    /// The pose of the last step, with feet and head.
    pub(super) pose: Pose,
    pub(super) passed: PassedMarkers,
    pub(super) clock: Clock,
}

/// Number of a kind, or 0 if the state is unchecked. It is not part of the state: comparing and saving a state ignore
/// it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sound(pub(super) u64);

impl PartialEq for Sound {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Largest coordinate in a restored state, metres. A creature farther away could not be stepped. It is twice the
/// largest coordinate of a place where a creature can be put, so that the creature can walk on from there.
pub(super) const FARTHEST_COORDINATE: f64 = 2e12;

/// Largest speed in a restored state, metres a second. A faster creature could not be stepped. It also bounds the
/// heading, rates of turning and steepness.
const FASTEST_SPEED: f64 = 1e6;

/// True if a place is farther away than a creature gets, or is no place.
pub(super) fn is_far(place: DVec3) -> bool {
    place.to_array().into_iter().any(is_large)
}

/// True if a coordinate or a distance is larger than a creature's, or is no number.
pub(super) fn is_large(number: f64) -> bool {
    number.is_nan() || number.abs() > FARTHEST_COORDINATE
}

/// True if a speed, an angle or a rate is larger than a creature's, or is no number.
pub(super) fn is_fast(number: f64) -> bool {
    number.is_nan() || number.abs() > FASTEST_SPEED
}

impl CreatureState {
    pub(super) fn new(kind: &CreatureKind, config: &CreatureConfig, rate: f64) -> Self {
        Self {
            sound: Sound(kind.number()),
            brain: BrainState::new(kind.brain(), config.seed),
            senses: kind.brain().no_senses(),
            clips: Clips::new(kind, rate),
            acting: Acting::default(),
            on_ground: OnGround::at(config.position),
            moving_ground: MovingGround::default(),
            walked: Walked::default(),
            motion: Motion::at_rest(config.yaw),
            feet: vec![Foot::new(); kind.legs().len()],
            hips: Hips::default(),
            head: HeadTurn::towards(config.position),
            territory: Territory::around(config.position),
            perceived: Perceived::nothing(config.position),
            damage: Damage::none(kind),
            striking: Striking::default(),
            ranged: Ranged::default(),
            pose: kind.clips().rest().clone(),
            passed: PassedMarkers::default(),
            clock: Clock::default(),
        }
    }

    /// Converts this state of a creature of the kind `from` for a creature of the kind `to`, which has the same
    /// skeleton and another brain. The creature goes on with everything that it does. States, moods, weak points and
    /// plates are matched by name, and new weak points and plates are unhurt. If the number of legs differs, all feet
    /// start again. `None` if this state is not of `from`.
    pub fn carry_over(&self, from: &CreatureKind, to: &CreatureKind) -> Option<Self> {
        let brain = to.brain().carry_over(from.brain(), &self.brain)?;
        let same = |state: StateId| {
            let path = from.brain().path(state);
            to.brain()
                .states()
                .find(|known| to.brain().path(*known) == path)
        };
        let (regions, own) = (to.brain().regions().len(), to.brain().own_senses().len());
        let has_senses =
            from.brain().own_senses() == to.brain().own_senses() && self.senses.fits(regions, own);
        let has_legs = from.legs().len() == to.legs().len();
        Some(Self {
            sound: Sound::default(),
            brain,
            senses: if has_senses {
                self.senses.clone()
            } else {
                to.brain().no_senses()
            },
            clips: self.clips.carry_over(same),
            acting: self.acting.carry_over(same, to.gait().is_some()),
            feet: if has_legs {
                self.feet.clone()
            } else {
                vec![Foot::new(); to.legs().len()]
            },
            damage: self.damage.carry_over(from, to),
            striking: self.striking.carry_over(same),
            ranged: self.ranged.carry_over(to, same),
            ..self.clone()
        })
    }

    /// State of the brain: the current state, for how long it has been current, moods, and random numbers.
    pub fn brain(&self) -> &BrainState {
        &self.brain
    }

    /// The creature's senses after the last step.
    pub fn senses(&self) -> &Senses {
        &self.senses
    }

    /// The clips as they play, before the corrections of feet and gaze.
    pub fn animator(&self) -> &Animator {
        self.clips.animator()
    }

    /// The current state of the brain: the innermost one.
    pub fn current(&self) -> StateId {
        self.brain.current()
    }

    /// Position of the model's origin, in world space, metres.
    pub fn position(&self) -> DVec3 {
        self.on_ground.position()
    }

    /// Heading, radians about Y: 0 is +Z, and positive turns to the creature's left.
    pub fn yaw(&self) -> f64 {
        self.motion.yaw()
    }

    /// Speed along the heading, metres a second; negative during a retreat.
    pub fn speed(&self) -> f64 {
        self.motion.speed()
    }

    /// True if a foot stands on the ground, false while it takes a step. `leg` is the index in
    /// [`BodyFile::legs`](crate::BodyFile::legs); false if there is no such leg.
    pub fn is_planted(&self, leg: usize) -> bool {
        self.feet.get(leg).is_some_and(Foot::is_planted)
    }

    /// Hit points left of each weak point, in the order of [`CreatureKind::weak_points`].
    pub fn hit_points(&self) -> &[f64] {
        self.damage.hit_points()
    }

    /// Number of staggers until a plate breaks, by its index in [`CreatureKind::plates`]; 0 if it is broken or does not
    /// exist.
    pub fn plate(&self, index: usize) -> u32 {
        self.damage.plate(index)
    }

    /// Ticks since the creature was created or last put somewhere.
    pub fn ticks(&self) -> u64 {
        self.clock.ticks()
    }

    pub(super) fn world_from_model(&self, scale: f64) -> Similarity {
        Similarity {
            rotation: rotation_from_axis_angle(DVec3::Y, self.yaw()),
            scale,
            translation: self.position(),
        }
    }

    /// The heading as a unit vector.
    pub(super) fn heading(&self) -> DVec3 {
        let (sin, cos) = libm::sincos(self.yaw());
        DVec3::new(sin, 0.0, cos)
    }

    /// Refuses a state that a creature of this kind cannot be in. A state that comes from a creature of this kind is
    /// not checked: the check costs more than the rest of a restore.
    pub(super) fn check(&self, kind: &CreatureKind) -> Result<(), ColossusError> {
        if self.sound.0 == kind.number() {
            return Ok(());
        }
        let brain = kind.brain();
        let (regions, own) = (brain.regions().len(), brain.own_senses().len());
        let states = brain.len();
        let fault = if !self.brain.fits(brain) || !self.senses.fits(regions, own) {
            "its brain has other states"
        } else if self.feet.len() != kind.legs().len() {
            "it has another number of legs"
        } else if self.pose.transforms.len() != kind.skeleton().joints().len() {
            "it has another number of joints"
        } else if self.hit_points().len() != kind.weak_points().len() {
            "it has another number of weak points"
        } else if !self.damage.is_valid() || !self.perceived.has_valid_walls() {
            "its hit points, wounds or distances to walls are negative or no numbers"
        } else if !self.damage.fits_plates(kind) {
            "it has other plates"
        } else if self.acting.errand().is_some() && kind.gait().is_none() {
            "it was sent, and cannot walk"
        } else if !self.ranged.fits(kind) {
            "what its attacks have let out is not its brain's"
        } else if !self.acting.fits(states)
            || !self.clips.fits(states)
            || !self.striking.fits(states)
        {
            "its act is not one of the brain's"
        } else if !self.is_within_range() {
            "its place or its motion is no number that a creature reaches"
        } else if self.animator().fade_bound() > FARTHEST_COORDINATE {
            "what is left of its last clip is no number that a pose has"
        } else {
            return self.check_pose(kind);
        };
        Err(ColossusError::OtherKind(fault))
    }

    /// True if all places and motions are numbers that a creature reaches.
    fn is_within_range(&self) -> bool {
        let errand = self.acting.errand();
        self.on_ground.is_within_range()
            && self.moving_ground.is_within_range()
            && self.motion.is_within_range()
            && self.territory.is_within_range()
            && self.perceived.is_within_range()
            && self.head.is_within_range()
            && self.striking.is_within_range()
            && !errand.is_some_and(|errand| is_far(errand.to()))
            && self.hips.is_within(FASTEST_SPEED)
            && self.walked.is_within(FARTHEST_COORDINATE)
            && self
                .feet
                .iter()
                .all(|foot| foot.is_within(FARTHEST_COORDINATE))
    }

    /// Refuses a state whose clips cannot pose the creature, or cannot go on.
    fn check_pose(&self, kind: &CreatureKind) -> Result<(), ColossusError> {
        let mut pose = Pose::default();
        let mut buffers = PoseBuffers::default();
        self.animator()
            .pose_into(kind.clips(), &mut pose, &mut buffers)?;
        let mut animator = self.animator().clone();
        animator.advance(kind.clips(), kind.brain().tick(), &mut Vec::new())?;
        kind.skeleton().palette(&self.pose)?;
        Ok(())
    }
}
