use clamber_animation::ik::LookMemory;
use clamber_animation::rig::{Playback, Pose};
use clamber_animation::{Animator, Layer, LayerKind, PoseBuffers, Spring};
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use clamber_world::MaterialPoint;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::CreatureConfig;
use super::hips::Hips;
use super::ordered::Errand;
use super::ranged::Ranged;
use super::report::CreatureEvent;
use crate::brain::{BrainState, StateId};
use crate::error::ColossusError;
use crate::feet::Foot;
use crate::kind::CreatureKind;
use crate::senses::Senses;

/// Everything of a creature that has to be saved: a plain value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CreatureState {
    /// The kind of creature for which this state is known to be valid. A state that was deserialised is checked
    /// instead.
    #[serde(skip)]
    pub(super) sound: Sound,
    pub(super) brain: BrainState,
    pub(super) senses: Senses,
    pub(super) animator: Animator,
    pub(super) playing: Playing,
    /// State whose act has begun. It differs from the brain's state while the creature still comes to a stop.
    pub(super) acting: Option<StateId>,
    /// Where the game has sent the creature. Acts wait for the end of the errand.
    pub(super) errand: Option<Errand>,
    /// True while the creature stops abruptly.
    pub(super) halts: bool,
    /// Position of the model's origin, in world space. Its height follows the ground.
    pub(super) position: DVec3,
    /// Vertical velocity of the origin from following the ground, metres a second.
    pub(super) climb: f64,
    /// Heights of the ground: along the heading, from behind to ahead, then to the left and to the right. Each tick
    /// measures one of them.
    pub(super) ground: [f64; GROUND],
    /// The remembered point of the ground, whose motion carries the creature.
    pub(super) stands_on: Option<GroundPoint>,
    /// How the ground carried the creature in the last tick.
    pub(super) carried: Drift,
    /// Knowledge about the current way.
    pub(super) walked: Walked,
    /// Steepness of the ground ahead, as a tangent.
    pub(super) steepness: f64,
    pub(super) yaw: f64,
    /// Speed along the heading, metres a second.
    pub(super) speed: f64,
    /// Radians a second, positive to the left.
    pub(super) yaw_rate: f64,
    pub(super) feet: Vec<Foot>,
    pub(super) hips: Hips,
    pub(super) look: LookMemory,
    pub(super) gaze: Spring<DVec3>,
    pub(super) gaze_weight: Spring<f64>,
    pub(super) home: DVec3,
    /// Place to which the creature walks on patrol.
    pub(super) patrol: DVec3,
    /// Id of the last visible prey, and where it was seen last.
    pub(super) prey: Option<(u64, DVec3)>,
    pub(super) unseen: u32,
    pub(super) noise: DVec3,
    pub(super) rides: Vec<Ride>,
    /// Distances to walls around the creature, metres. The directions are measured in turn.
    pub(super) walls: [f32; WALLS],
    /// Hit points left of each weak point.
    pub(super) hit_points: Vec<f64>,
    /// State of each plate.
    pub(super) plates: Vec<PlateState>,
    /// Plates that staggered since the last step.
    pub(super) staggered: u32,
    /// Events since the last step, for the next report.
    pub(super) told: Vec<CreatureEvent>,
    /// Wounds since the last step.
    pub(super) wounds: Vec<Felt>,
    /// Ids of the people that the current attack has already struck: by its limb, its beam, or the wave of its limb.
    pub(super) struck: Vec<u64>,
    /// Vector from the place where the clip strikes to the place where this attack does, in world space.
    pub(super) aim: DVec3,
    pub(super) lean: Lean,
    pub(super) ranged: Ranged,
    /// The pose of the last step, with feet and head.
    pub(super) pose: Pose,
    /// Markers that the clips passed in the last step: index of the clip, and of the marker in the clip.
    pub(super) passed: Vec<[u32; 2]>,
    /// Ticks for which the creature has been asleep without moving.
    pub(super) sleeps: u32,
    pub(super) ticks: u64,
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
pub(super) const FARTHEST: f64 = 2e12;

/// Largest speed in a restored state, metres a second. A faster creature could not be stepped. It also bounds the
/// heading, rates of turning and steepness.
const FASTEST: f64 = 1e6;

/// Most corners of a way in a restored state.
const MOST_CORNERS: usize = 512;

/// Distance that stands for no wall in reach, because JSON has no infinity.
pub(super) const NO_WALL: f32 = f32::MAX;

/// Height that stands for no ground below, because JSON has no infinity.
pub(super) const NO_GROUND: f64 = f64::MAX;

/// Number of places where the ground height is measured.
pub(super) const GROUND: usize = 9;

/// Number of directions in which walls are measured.
pub(super) const WALLS: usize = 8;

/// The clip that the creature plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Playing {
    /// The clip of standing.
    Idle,
    /// The clip of walking.
    Walk,
    /// The clip of turning to the left (0) or to the right (1).
    Turn(u8),
    /// The clip of a state's act.
    Act(StateId),
}

/// A point of the ground.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct GroundPoint {
    /// Index of the obstacle in the terrain of the last step.
    pub(super) obstacle: u32,
    /// Number of obstacles in that terrain.
    pub(super) among: u32,
    pub(super) material: MaterialPoint,
    /// Position of the point at the end of the last step, in world space.
    pub(super) at: DVec3,
}

/// Velocity with which moving ground carries a creature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Drift {
    /// Metres a second, in world space.
    pub(super) velocity: DVec3,
    /// Radians a second, positive to the left.
    pub(super) yaw_rate: f64,
}

/// Knowledge of a creature about its current way.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Walked {
    /// Corners on the way to the goal, the next one first; empty if the way is straight.
    pub(super) corners: Vec<DVec3>,
    /// Ticks until the next search for corners.
    pub(super) ticks_left: u32,
    /// Number of searches in a row that found no way.
    pub(super) failed: u32,
    /// True if `ahead`, `turn` and `faces` were measured.
    pub(super) is_known: bool,
    /// Free distance ahead, metres. If the way is free as far as the creature looks, it is a much larger number.
    pub(super) ahead: f64,
    /// Free angle to turn, radians; its sign is the side, positive to the left.
    pub(super) turn: f64,
    /// True if the goal was ahead at the last check.
    pub(super) faces: bool,
    /// Side to which the creature turns the long way round because the short way is blocked: -1 right, 1 left, 0
    /// neither.
    pub(super) round: i8,
    /// True if the creature has chosen the long way round since it began to turn.
    pub(super) has_gone_round: bool,
    /// True if the creature has checked the room for the whole turn since it began to turn.
    pub(super) has_looked_round: bool,
    /// True if the creature has begun a retreat since it began to turn.
    pub(super) has_gone_back: bool,
    /// How far the creature still walks backwards, metres.
    pub(super) back: f64,
    /// Length of the retreat so far, metres.
    pub(super) gone_back: f64,
    /// Whether the creature looks for ways on which it can turn everywhere.
    pub(super) wide: Wide,
    /// Place where the creature got stuck.
    pub(super) stuck_at: DVec3,
    /// Number of stops before an obstacle near that place.
    pub(super) stops: u8,
    /// Number of retreats from near that place.
    pub(super) retreats: u8,
    /// True if the creature cannot get on.
    pub(super) is_blocked: bool,
    /// Ticks since the act or the errand began.
    pub(super) tried: u32,
}

/// Whether a creature looks for ways on which it can turn everywhere. It does so once it got stuck on a way that is
/// only wide enough to walk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Wide {
    #[default]
    No,
    Looks,
    /// No such way was found.
    Failed,
}

impl Walked {
    /// True if all numbers are within the range that a creature reaches.
    fn is_within(&self, most: f64) -> bool {
        let places = self.corners.iter().flat_map(|corner| corner.to_array());
        let numbers = [self.ahead, self.turn, self.back, self.gone_back];
        let mut numbers = places.chain(numbers).chain(self.stuck_at.to_array());
        let is_way = self.corners.len() <= MOST_CORNERS && (-1..=1).contains(&self.round);
        is_way && numbers.all(|number| number.abs() <= most)
    }
}

/// How far a neck or an arm leans towards the target that it strikes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Lean {
    /// Offset from the end of the limb in the clip, in world space.
    pub(super) spring: Spring<DVec3>,
    /// State whose attack leans; `None` if no limb leans.
    pub(super) with: Option<StateId>,
}

/// The time that a person has been on the creature.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Ride {
    pub(super) person: u64,
    pub(super) ticks: u32,
    pub(super) joint: u32,
    /// Ticks since the person was last on the creature. A short leap does not end a ride.
    pub(super) off: u32,
}

/// State of a plate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PlateState {
    /// Damage since the last stagger.
    pub(super) strain: f64,
    /// Number of staggers until the plate breaks; 0 if it is broken.
    pub(super) left: u32,
}

/// A hit on the creature: the joint of the skin, and the damage done.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Felt {
    pub(super) joint: u32,
    pub(super) damage: f64,
}

impl CreatureState {
    pub(super) fn new(kind: &CreatureKind, config: &CreatureConfig, rate: f64) -> Self {
        let mut layers = Vec::new();
        if let Some(gait) = kind.gait() {
            layers.push(Layer::new(gait.idle));
        } else if !kind.clips().clips().is_empty() {
            layers.push(Layer::new(clamber_animation::ClipId(0)));
        }
        if let Some(breathe) = kind.breathe() {
            layers.push(Layer {
                kind: LayerKind::Additive,
                playback: Playback::Loop,
                ..Layer::new(breathe)
            });
        }
        let mut animator = Animator::new(layers);
        // Cannot fail, since the rate is finite.
        let _ = animator.set_rate(rate);
        Self {
            sound: Sound(kind.number()),
            brain: BrainState::new(kind.brain(), config.seed),
            senses: kind.brain().no_senses(),
            animator,
            playing: Playing::Idle,
            acting: None,
            errand: None,
            halts: false,
            position: config.position,
            climb: 0.0,
            ground: [NO_GROUND; GROUND],
            stands_on: None,
            carried: Drift::default(),
            walked: Walked::default(),
            steepness: 0.0,
            yaw: config.yaw,
            speed: 0.0,
            yaw_rate: 0.0,
            feet: vec![Foot::new(); kind.legs().len()],
            hips: Hips::default(),
            look: LookMemory::default(),
            gaze: Spring::at(config.position),
            gaze_weight: Spring::at(0.0),
            home: config.position,
            patrol: config.position,
            prey: None,
            unseen: u32::MAX,
            noise: config.position,
            rides: Vec::new(),
            walls: [NO_WALL; WALLS],
            hit_points: kind
                .weak_points()
                .iter()
                .map(|point| point.hit_points)
                .collect(),
            plates: kind
                .plates()
                .iter()
                .map(|plate| PlateState {
                    strain: 0.0,
                    left: plate.count,
                })
                .collect(),
            staggered: 0,
            told: Vec::new(),
            wounds: Vec::new(),
            sleeps: 0,
            struck: Vec::new(),
            aim: DVec3::ZERO,
            lean: Lean::default(),
            ranged: Ranged::default(),
            pose: kind.clips().rest().clone(),
            passed: Vec::new(),
            ticks: 0,
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
        let fresh = Self::new(to, &CreatureConfig::default(), 1.0);
        Some(Self {
            sound: Sound::default(),
            brain,
            errand: self.errand.filter(|_| to.gait().is_some()),
            feet: if from.legs().len() == to.legs().len() {
                self.feet.clone()
            } else {
                fresh.feet
            },
            hit_points: kept(
                (from.weak_points(), to.weak_points()),
                |point| point.name.as_str(),
                &self.hit_points,
                fresh.hit_points,
                |left, most| left.min(most),
            ),
            plates: kept(
                (from.plates(), to.plates()),
                |plate| plate.name.as_str(),
                &self.plates,
                fresh.plates,
                |had, fresh| PlateState {
                    left: had.left.min(fresh.left),
                    ..had
                },
            ),
            acting: self.acting.and_then(same),
            playing: match self.playing {
                Playing::Act(state) => same(state).map_or(Playing::Idle, Playing::Act),
                other => other,
            },
            lean: match self.lean.with {
                Some(state) if same(state).is_some() => Lean {
                    with: same(state),
                    ..self.lean
                },
                _ => Lean::default(),
            },
            ranged: self.ranged.carry_over(to, same),
            senses: if has_senses {
                self.senses.clone()
            } else {
                to.brain().no_senses()
            },
            told: {
                // The ids of states differ between brains.
                let mut told = self.told.clone();
                told.retain(|event| !matches!(event, CreatureEvent::Entered { .. }));
                told
            },
            ..self.clone()
        })
    }

    /// State of the brain.
    pub fn brain(&self) -> &BrainState {
        &self.brain
    }

    /// Senses of the last step.
    pub fn senses(&self) -> &Senses {
        &self.senses
    }

    /// The clips as they play, before the corrections of feet and gaze.
    pub fn animator(&self) -> &Animator {
        &self.animator
    }

    /// The current state of the brain: the innermost one.
    pub fn current(&self) -> StateId {
        self.brain.current()
    }

    /// Position of the model's origin, in world space.
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// Heading, radians about Y.
    pub fn yaw(&self) -> f64 {
        self.yaw
    }

    /// Speed along the heading, metres a second; negative during a retreat.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// True if a foot stands, by the index of the leg in the file.
    pub fn is_planted(&self, leg: usize) -> bool {
        self.feet.get(leg).is_some_and(Foot::is_planted)
    }

    /// Hit points left of each weak point.
    pub fn hit_points(&self) -> &[f64] {
        &self.hit_points
    }

    /// Number of staggers until a plate breaks; 0 if it is broken or does not exist.
    pub fn plate(&self, index: usize) -> u32 {
        self.plates.get(index).map_or(0, |plate| plate.left)
    }

    /// Ticks since the creature was created or last put somewhere.
    pub fn ticks(&self) -> u64 {
        self.ticks
    }

    pub(super) fn world_from_model(&self, scale: f64) -> Similarity {
        Similarity {
            rotation: rotation_from_axis_angle(DVec3::Y, self.yaw),
            scale,
            translation: self.position,
        }
    }

    /// The heading as a unit vector.
    pub(super) fn heading(&self) -> DVec3 {
        let (sin, cos) = libm::sincos(self.yaw);
        DVec3::new(sin, 0.0, cos)
    }

    /// Refuses a state that a creature of this kind cannot be in. A state that comes from a creature of this kind is
    /// not checked: the check costs more than the rest of a restore.
    pub(super) fn check(&self, kind: &CreatureKind) -> Result<(), ColossusError> {
        if self.sound.0 == kind.number() {
            return Ok(());
        }
        let brain = kind.brain();
        if !self.brain.fits(brain)
            || !self
                .senses
                .fits(brain.regions().len(), brain.own_senses().len())
        {
            return Err(ColossusError::OtherKind("its brain has other states"));
        }
        if self.feet.len() != kind.legs().len() {
            return Err(ColossusError::OtherKind("it has another number of legs"));
        }
        if self.pose.transforms.len() != kind.skeleton().joints().len() {
            return Err(ColossusError::OtherKind("it has another number of joints"));
        }
        if self.hit_points.len() != kind.weak_points().len() {
            return Err(ColossusError::OtherKind(
                "it has another number of weak points",
            ));
        }
        let is_left = |left: &f64| (0.0..=f64::MAX).contains(left);
        let is_wall = |wall: &f32| (0.0..=f32::MAX).contains(wall);
        let is_hurt = |felt: &Felt| (0.0..=f64::MAX).contains(&felt.damage);
        if !self.hit_points.iter().all(is_left)
            || !self.walls.iter().all(is_wall)
            || !self.wounds.iter().all(is_hurt)
        {
            return Err(ColossusError::OtherKind(
                "its hit points, wounds or distances to walls are negative or no numbers",
            ));
        }
        let fits = |state: &PlateState, plate: &crate::kind::Plate| {
            state.left <= plate.count && (0.0..=f64::MAX).contains(&state.strain)
        };
        if self.plates.len() != kind.plates().len()
            || !self
                .plates
                .iter()
                .zip(kind.plates())
                .all(|(state, plate)| fits(state, plate))
        {
            return Err(ColossusError::OtherKind("it has other plates"));
        }
        if self.errand.is_some() && kind.gait().is_none() {
            return Err(ColossusError::OtherKind("it was sent, and cannot walk"));
        }
        if !self.ranged.fits(kind) {
            return Err(ColossusError::OtherKind(
                "what its attacks have let out is not its brain's",
            ));
        }
        let states = brain.len();
        let acting = self.acting.is_none_or(|state| state.index() < states);
        let playing = !matches!(self.playing, Playing::Act(state) if state.index() >= states);
        let leaning = self.lean.with.is_none_or(|state| state.index() < states);
        if !acting || !playing || !leaning {
            return Err(ColossusError::OtherKind(
                "its act is not one of the brain's",
            ));
        }
        let numbers = [
            self.yaw,
            self.speed,
            self.yaw_rate,
            self.climb,
            self.steepness,
            self.carried.yaw_rate,
            self.carried.velocity.length(),
        ];
        let far = |number: f64| number.is_nan() || number.abs() > FARTHEST;
        let fast = |number: &f64| number.is_nan() || number.abs() > FASTEST;
        let known = self.prey.map_or(self.home, |(_, place)| place);
        let gaze = [
            self.gaze.value,
            self.gaze.velocity,
            self.lean.spring.value,
            self.lean.spring.velocity,
        ];
        let stands = self.stands_on.map_or(self.home, |point| point.at);
        let sent = self.errand.map_or(self.home, |errand| errand.to);
        let places = [
            self.position,
            self.home,
            self.patrol,
            self.noise,
            known,
            stands,
            sent,
        ];
        let places = places.into_iter().chain(gaze);
        let mut coordinates = places.flat_map(|place| place.to_array());
        let level = |level: &f64| *level == NO_GROUND || !far(*level);
        if coordinates.any(far)
            || far(self.yaw)
            || far(self.aim.length())
            || numbers.iter().any(fast)
            || !self.hips.is_within(FASTEST)
            || !self.walked.is_within(FARTHEST)
            || !self.ground.iter().all(level)
            || [self.gaze_weight.value, self.gaze_weight.velocity]
                .iter()
                .any(fast)
            || !self.feet.iter().all(|foot| foot.is_within(FARTHEST))
        {
            return Err(ColossusError::OtherKind(
                "its place or its motion is no number that a creature reaches",
            ));
        }
        if self.animator.fade_bound() > FARTHEST {
            return Err(ColossusError::OtherKind(
                "what is left of its last clip is no number that a pose has",
            ));
        }
        // The clips must be able to pose the creature, and to go on.
        let mut pose = Pose::default();
        let mut buffers = PoseBuffers::default();
        self.animator
            .pose_into(kind.clips(), &mut pose, &mut buffers)?;
        let mut animator = self.animator.clone();
        animator.advance(kind.clips(), kind.brain().tick(), &mut Vec::new())?;
        kind.skeleton().palette(&self.pose)?;
        Ok(())
    }
}

/// Carries values over to the parts with the same names, limited by `limit`. Parts without a namesake get their fresh
/// value. Names need not be unique: the second part of a name matches the second part of that name.
fn kept<T, S: Copy>(
    (from, to): (&[T], &[T]),
    name: impl Fn(&T) -> &str,
    had: &[S],
    fresh: Vec<S>,
    limit: impl Fn(S, S) -> S,
) -> Vec<S> {
    let find = |index: usize| {
        let ours = name(&to[index]);
        let before = to[..index].iter().filter(|part| name(part) == ours);
        let mut same = (0..from.len()).filter(|old| name(&from[*old]) == ours);
        had.get(same.nth(before.count())?).copied()
    };
    let parts = fresh.into_iter().enumerate();
    parts
        .map(|(index, fresh)| find(index).map_or(fresh, |had| limit(had, fresh)))
        .collect()
}
