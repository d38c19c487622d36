#![doc = include_str!("form.md")]

mod attack;
mod compile;
mod condition;
mod error;
mod file;
mod locate;
mod report;
mod state;
pub(crate) mod unique;

pub(crate) use attack::WaveOf;
pub use attack::{Attack, Beam, Shot, Wave};
pub(crate) use compile::{check, list};
pub(crate) use error::whole;

use condition::Condition;
pub use error::{BrainError, BrainProblem};
pub use file::{
    After, BrainFile, Gaze, MoodFile, Place, RaiseFile, StateAction, StateFile, TransitionFile,
    Turn, Walk,
};
pub use report::{BrainReport, Never};
pub use state::{BrainState, Entered};

/// Index of a state in its [`Brain`].
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
pub struct StateId(pub u16);

impl StateId {
    /// The state's index in the order of [`Brain::states`], from 0: for a slice with one element for each state of its
    /// brain.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// The most transitions in one tick. A state that has just been entered is left in the same tick only by a transition
/// without conditions. Files with longer chains of such transitions are refused.
pub const MOST_TRANSITIONS: usize = 8;

/// Deepest nesting of states. It is the length of two arrays in [`BrainState`], which has to stay below 1 KB.
const MOST_DEPTH: usize = 4;
/// Most states of a brain, so that its [`BrainState`] stays below 1 KB.
const MOST_STATES: usize = 160;
/// Most moods of a brain, so that its [`BrainState`] stays below 1 KB.
const MOST_MOODS: usize = 16;
/// Most regions of a brain: a joint's regions are the bits of a `u64`.
const MOST_REGIONS: usize = 64;

/// Largest weight of a transition, so that sums of weights stay finite.
const MOST_WEIGHT: f64 = 1e9;

/// Default time in which an act fades in, seconds.
const DEFAULT_FADE: f64 = 0.6;

/// A brain: states, moods, and the transitions between states. It never changes; [`BrainState`] holds all that changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Brain {
    file: BrainFile,
    tick: f64,
    states: Vec<State>,
    transitions: Vec<Transition>,
    moods: Vec<Mood>,
    /// The innermost state in which it begins.
    start: StateId,
    /// A hash of the names of states and moods, in their order, and of the moods' fading times. A [`BrainState`] fits
    /// brains with the same hash.
    mark: u64,
}

#[derive(Clone, Debug, PartialEq)]
struct State {
    name: String,
    /// The names of its outer states and its own, such as `calm/idle`.
    path: String,
    parent: Option<StateId>,
    /// Number of outer states.
    depth: usize,
    /// The inner state that is entered with it.
    start: Option<StateId>,
    act: Option<StateAction>,
    gaze: Gaze,
    fade: f64,
    exposes: Vec<String>,
    cooldown: u32,
    is_final: bool,
    /// Range in `Brain::transitions`.
    transitions: core::ops::Range<usize>,
    /// Line in the file; 0 if unknown.
    line: usize,
}

#[derive(Clone, Debug, PartialEq)]
struct Transition {
    /// Index in `Brain::transitions`.
    number: u64,
    from: StateId,
    to: StateId,
    when: Vec<Condition>,
    any: Vec<Condition>,
    on: Option<String>,
    /// Range of the ticks that the state must have lasted.
    after: [u32; 2],
    priority: i32,
    weight: f64,
    interrupts: bool,
    line: usize,
}

impl Transition {
    /// True if it has no conditions, so that it can be taken in the tick in which its state is entered.
    fn is_instant(&self) -> bool {
        self.when.is_empty() && self.any.is_empty() && self.on.is_none() && self.after == [0, 0]
    }
}

#[derive(Clone, Debug, PartialEq)]
struct Mood {
    /// Ticks in which it fades from 1 to 0.
    fades: u32,
    raised: Vec<(Vec<Condition>, u32)>,
}

impl StateAction {
    /// True if the act has to be played to its end.
    fn is_whole(&self) -> bool {
        matches!(self, Self::Once(_) | Self::Attack(_))
    }

    /// The clip that the act plays; `None` for a sleep, and for walks and turns, which play clips of the gait.
    pub fn clip(&self) -> Option<&str> {
        match self {
            Self::Play(clip) | Self::Once(clip) => Some(clip),
            Self::Attack(attack) => Some(&attack.clip),
            Self::Walk(_) | Self::Turn(_) | Self::Sleep => None,
        }
    }
}

impl Brain {
    /// The file that it was made from.
    pub fn file(&self) -> &BrainFile {
        &self.file
    }

    /// Length of a tick, seconds: the `tick` that was given to [`Brain::from_json`] or [`Brain::new`]. It never
    /// changes. Each step of a creature with this brain advances the creature by this time, so an arena of
    /// `clamber_fight` has to have the same tick.
    pub fn tick(&self) -> f64 {
        self.tick
    }

    /// Number of states, outer ones included.
    pub fn len(&self) -> usize {
        self.states.len()
    }

    /// False: a brain has at least one state.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// The ids of all states, outer ones included.
    pub fn states(&self) -> impl ExactSizeIterator<Item = StateId> + use<> {
        (0..self.states.len() as u16).map(StateId)
    }

    /// The state with this name; `None` if no state has it.
    pub fn find(&self, name: &str) -> Option<StateId> {
        let found = self.states.iter().position(|state| state.name == name)?;
        Some(StateId(found as u16))
    }

    /// A state's name after the names of its outer states, such as `calm/idle`. A [`StateId`] is only an index: an id
    /// from another brain gives the state of this brain with the same index, and an empty text if there is none.
    pub fn path(&self, state: StateId) -> &str {
        self.state(state).map_or("", |state| &state.path)
    }

    /// The act of a state; `None` if the creature only stands in it.
    pub fn act(&self, state: StateId) -> Option<&StateAction> {
        self.state(state)?.act.as_ref()
    }

    /// Where the creature looks in a state.
    pub fn gaze(&self, state: StateId) -> Gaze {
        self.state(state).map_or(Gaze::Clip, |state| state.gaze)
    }

    /// Seconds in which the clip of a state's act fades in, or the idle clip in a state without an act and in place of
    /// an attack that is blocked ([`StateFile::fade`]).
    pub fn fade(&self, state: StateId) -> f64 {
        self.state(state).map_or(DEFAULT_FADE, |state| state.fade)
    }

    /// Weak points that a state exposes, by name.
    pub fn exposes(&self, state: StateId) -> &[String] {
        self.state(state).map_or(&[], |state| &state.exposes)
    }

    /// True if a state is final: no transition leads out of it.
    pub fn is_final(&self, state: StateId) -> bool {
        self.state(state).is_some_and(|state| state.is_final)
    }

    /// True if `inner` is `outer` or one of its inner states.
    pub fn is_within(&self, inner: StateId, outer: StateId) -> bool {
        self.around(inner).any(|state| state == outer)
    }

    /// The line of a state in its file; `None` if the brain was not read from a file.
    pub fn line(&self, state: StateId) -> Option<usize> {
        let line = self.state(state)?.line;
        (line > 0).then_some(line)
    }

    /// The names of the moods, sorted by name. A mood's position among them is its index for [`BrainState::mood`].
    pub fn moods(&self) -> impl ExactSizeIterator<Item = &str> {
        self.file.moods.keys().map(String::as_str)
    }

    /// The names of the regions, each with its joints, sorted by name. A region's position among them is its index for
    /// [`Senses::in_region`](crate::Senses::in_region).
    pub fn regions(&self) -> impl ExactSizeIterator<Item = (&str, &[String])> {
        let regions = self.file.regions.iter();
        regions.map(|(name, joints)| (name.as_str(), joints.as_slice()))
    }

    /// The names of the game's own senses, in the order of the file: the index for [`Senses::own`](crate::Senses::own).
    /// [`Creature::set_sense`](crate::Creature::set_sense) takes the name.
    pub fn own_senses(&self) -> &[String] {
        &self.file.senses
    }

    /// Senses of a creature that senses nothing, for tests of this brain, with its regions and its game's own senses.
    /// All numbers are 0, except that health is 1, and that the distances to prey and to a wall and the time since prey
    /// was seen are infinite.
    pub fn no_senses(&self) -> crate::Senses {
        crate::Senses::nothing(self.file.regions.len(), self.file.senses.len())
    }

    fn state(&self, state: StateId) -> Option<&State> {
        self.states.get(state.index())
    }

    /// A state and its outer states, from the inside out.
    fn around(&self, state: StateId) -> impl Iterator<Item = StateId> {
        let first = self.state(state).map(|_| state);
        core::iter::successors(first, |state| self.state(*state)?.parent)
    }

    /// The innermost state that is entered when this state is entered.
    fn innermost(&self, state: StateId) -> StateId {
        let inside = |state: &StateId| self.state(*state)?.start;
        core::iter::successors(Some(state), inside)
            .last()
            .unwrap_or(state)
    }

    /// A time in ticks, rounded.
    fn ticks(seconds: f64, tick: f64) -> u32 {
        (seconds / tick).round().min(f64::from(u32::MAX)) as u32
    }
}
