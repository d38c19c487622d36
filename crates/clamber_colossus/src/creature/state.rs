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

/// All that changes in a creature: a plain value, to be saved and restored.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CreatureState {
    /// The kind of whose creature it is known to be a state: those that were read are checked.
    #[serde(skip)]
    pub(super) sound: Sound,
    pub(super) brain: BrainState,
    pub(super) senses: Senses,
    pub(super) animator: Animator,
    pub(super) playing: Playing,
    /// The state whose act has begun; another one than the brain's while the creature still comes to a stand.
    pub(super) acting: Option<StateId>,
    /// Where the game has sent it: acts wait meanwhile.
    pub(super) errand: Option<Errand>,
    /// True if it stops abruptly.
    pub(super) halts: bool,
    /// Where the model's origin is. Its height follows the ground.
    pub(super) position: DVec3,
    pub(super) climb: f64,
    /// Heights of the ground along its heading, from behind to ahead, and to the left and right; one is looked for in
    /// each tick.
    pub(super) ground: [f64; GROUND],
    /// The point of the ground that it goes with, if that moves.
    pub(super) stands_on: Option<GroundPoint>,
    /// How that has moved it in the last tick.
    pub(super) carried: Drift,
    /// What it knows of the way that it is on.
    pub(super) walked: Walked,
    /// How steep the ground ahead is, as a tangent.
    pub(super) steepness: f64,
    pub(super) yaw: f64,
    /// Along its heading, metres a second, and radians a second to the left.
    pub(super) speed: f64,
    pub(super) yaw_rate: f64,
    pub(super) feet: Vec<Foot>,
    pub(super) hips: Hips,
    pub(super) look: LookMemory,
    pub(super) gaze: Spring<DVec3>,
    pub(super) gaze_weight: Spring<f64>,
    pub(super) home: DVec3,
    /// Where it goes on patrol.
    pub(super) patrol: DVec3,
    /// Where prey was seen last, and who it was.
    pub(super) prey: Option<(u64, DVec3)>,
    pub(super) unseen: u32,
    pub(super) noise: DVec3,
    pub(super) rides: Vec<Ride>,
    /// Distances to walls around it, one looked for in each tick.
    pub(super) walls: [f32; WALLS],
    /// Hit points left of each weak point.
    pub(super) hit_points: Vec<f64>,
    /// Of each plate, what it has taken and how often it still staggers.
    pub(super) plates: Vec<PlateState>,
    /// Plates that staggered since the last step.
    pub(super) staggered: u32,
    /// What happened since the last step, for the next report.
    pub(super) told: Vec<CreatureEvent>,
    /// Wounds since the last step.
    pub(super) wounds: Vec<Felt>,
    /// Whom the attack has struck already: by its limb, its beam, or the wave of its limb.
    pub(super) struck: Vec<u64>,
    /// From where the clip strikes to where this attack does, in world space.
    pub(super) aim: DVec3,
    pub(super) lean: Lean,
    pub(super) ranged: Ranged,
    /// The pose of the last step, with feet and head.
    pub(super) pose: Pose,
    /// Markers that were passed in the last step: clips, and indices in them.
    pub(super) passed: Vec<[u32; 2]>,
    /// Ticks for which it has been asleep and still.
    pub(super) sleeps: u32,
    pub(super) ticks: u64,
}

/// The number of a kind, or 0. It is not part of the state: whoever compares or saves that does not see it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sound(pub(super) u64);

impl PartialEq for Sound {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A creature is no further from the origin than this, metres, and nothing of it moves faster than this, metres a second,
/// in a state that is restored: what was changed to more could not be stepped. It is twice as far as one can be put, so that
/// it can walk on from there.
pub(super) const FARTHEST: f64 = 2e12;
const FASTEST: f64 = 1e6;

/// A way has no more corners.
const MOST_CORNERS: usize = 512;

/// Stands for no wall in reach: JSON has no infinity.
pub(super) const NO_WALL: f32 = f32::MAX;

/// Stands for no ground below: JSON has no infinity.
pub(super) const NO_GROUND: f64 = f64::MAX;

/// Places at which the ground is looked for.
pub(super) const GROUND: usize = 9;

/// Directions in which walls are looked for.
pub(super) const WALLS: usize = 8;

/// What the creature plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Playing {
    /// Stands.
    Idle,
    /// Walks.
    Walk,
    /// Turns to the left (0) or right (1).
    Turn(u8),
    /// The clip of a state's act.
    Act(StateId),
}

/// A point of the ground.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct GroundPoint {
    /// The obstacle, by its place among the terrain of the last step.
    pub(super) obstacle: u32,
    /// How many obstacles there were.
    pub(super) among: u32,
    pub(super) material: MaterialPoint,
    /// Where it was at the end of the last step, in world space.
    pub(super) at: DVec3,
}

/// How moving ground takes a creature along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Drift {
    /// Metres a second, in world space.
    pub(super) velocity: DVec3,
    /// Radians a second to the left.
    pub(super) yaw_rate: f64,
}

/// What a creature knows of the way that it is on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Walked {
    /// Places on the way to its goal, the next one first; none if it goes straight there.
    pub(super) corners: Vec<DVec3>,
    /// Ticks until it looks for them anew.
    pub(super) ticks_left: u32,
    /// How often it found no way, one after the other.
    pub(super) failed: u32,
    /// True if the following was looked for.
    pub(super) is_known: bool,
    /// How far ahead its way is free, metres; much further than it looks if it is free as far as that.
    pub(super) ahead: f64,
    /// How far it may turn, radians: to the side that its sign tells, positive to the left.
    pub(super) turn: f64,
    /// True if its goal was ahead when it looked last.
    pub(super) faces: bool,
    /// To which side it turns the long way round, since the short one is blocked: -1 to the right, 1 to the left, or 0.
    pub(super) round: i8,
    /// True if it has turned the long way round since it began to turn.
    pub(super) has_gone_round: bool,
    /// True if it has looked for room for the whole of its turn since it began to turn, and if it has gone back since.
    pub(super) has_looked_round: bool,
    pub(super) has_gone_back: bool,
    /// How far it still goes back, since it could neither turn nor go on, and how far it has gone so, metres.
    pub(super) back: f64,
    pub(super) gone_back: f64,
    /// Whether it looks for ways on which it can turn everywhere.
    pub(super) wide: Wide,
    /// Where it did not get on, how often it stood before something about there, and how often it went back.
    pub(super) stuck_at: DVec3,
    pub(super) stops: u8,
    pub(super) retreats: u8,
    /// True if it does not get on.
    pub(super) is_blocked: bool,
    /// Ticks since it began its act or its errand.
    pub(super) tried: u32,
}

/// Whether a creature looks for ways on which it can turn everywhere, as it does once it got stuck on one that is just wide
/// enough to walk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Wide {
    #[default]
    No,
    Looks,
    /// There was none.
    Failed,
}

impl Walked {
    /// True if all its numbers are some that a creature reaches.
    fn is_within(&self, most: f64) -> bool {
        let places = self.corners.iter().flat_map(|corner| corner.to_array());
        let numbers = [self.ahead, self.turn, self.back, self.gone_back];
        let mut numbers = places.chain(numbers).chain(self.stuck_at.to_array());
        let is_way = self.corners.len() <= MOST_CORNERS && (-1..=1).contains(&self.round);
        is_way && numbers.all(|number| number.abs() <= most)
    }
}

/// How far a neck or an arm leans out to whom it strikes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Lean {
    /// From where the clip has its end, in world space.
    pub(super) spring: Spring<DVec3>,
    /// The state whose attack leans; `None` if nothing does.
    pub(super) with: Option<StateId>,
}

/// Somebody's time on the creature.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Ride {
    pub(super) person: u64,
    pub(super) ticks: u32,
    pub(super) joint: u32,
    /// Ticks since it was on the creature last: a short leap does not end a ride.
    pub(super) off: u32,
}

/// A plate of a creature.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PlateState {
    /// Damage since it staggered last.
    pub(super) strain: f64,
    /// How often it still staggers; 0 if it is broken.
    pub(super) left: u32,
}

/// What struck it, and where.
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
        // Cannot fail for a finite rate.
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

    /// This state of a creature of the kind `from`, for one of the kind `to`, which has the same skeleton and another
    /// brain. All that it does goes on. States and moods are found by their names, and so are weak points and plates: new
    /// ones are unhurt. With another number of legs its feet begin anew. `None` if this state is not of `from`.
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
                // States had other numbers.
                let mut told = self.told.clone();
                told.retain(|event| !matches!(event, CreatureEvent::Entered { .. }));
                told
            },
            ..self.clone()
        })
    }

    /// The brain's state.
    pub fn brain(&self) -> &BrainState {
        &self.brain
    }

    /// What it sensed last.
    pub fn senses(&self) -> &Senses {
        &self.senses
    }

    /// Its clips, as they play: without feet on the ground and without a gaze.
    pub fn animator(&self) -> &Animator {
        &self.animator
    }

    /// The state that it is in: the innermost one.
    pub fn current(&self) -> StateId {
        self.brain.current()
    }

    /// Where its model's origin is, in world space.
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// Its heading, radians about Y.
    pub fn yaw(&self) -> f64 {
        self.yaw
    }

    /// Speed along its heading, metres a second; negative while it goes back.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// True if a foot stands, by its index in the file.
    pub fn is_planted(&self, leg: usize) -> bool {
        self.feet.get(leg).is_some_and(Foot::is_planted)
    }

    /// Hit points left of each weak point.
    pub fn hit_points(&self) -> &[f64] {
        &self.hit_points
    }

    /// How often a plate still staggers before it breaks; 0 if it is broken, or if there is none.
    pub fn plate(&self, index: usize) -> u32 {
        self.plates.get(index).map_or(0, |plate| plate.left)
    }

    /// Ticks since it began, or was put somewhere.
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

    /// Its heading as a unit vector.
    pub(super) fn heading(&self) -> DVec3 {
        let (sin, cos) = libm::sincos(self.yaw);
        DVec3::new(sin, 0.0, cos)
    }

    /// Refuses what a creature of this kind cannot be in. What one of it has been in needs no check, which costs more than
    /// all else of going back to it.
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
        // Clips that cannot pose it now never can.
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

/// What parts of the same names had with another brain, as far as they can have it now, or what they begin with. Names
/// need not be unique: the second of a name is the second of it there.
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
