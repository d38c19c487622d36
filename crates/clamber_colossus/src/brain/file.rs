use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Attack, unique};
use crate::kind::BodyFile;

/// A brain as in its JSON file, not yet checked: states, moods, and the transitions between states.
/// [`Brain::new`](crate::Brain::new) makes a brain of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BrainFile {
    /// The body that the brain moves: legs, head, gait.
    #[serde(default)]
    pub body: BodyFile,
    /// The state in which the creature begins.
    pub start: String,
    /// Moods by name: numbers from 0 to 1 that conditions raise, and that fade.
    #[serde(default, with = "unique", skip_serializing_if = "BTreeMap::is_empty")]
    pub moods: BTreeMap<String, MoodFile>,
    /// Regions of the body by name, each with its joints. Some senses are also counted per region. `"spine.*"` names
    /// all joints that begin with `spine.`, and `"thumb.*.L"` all joints that begin with `thumb.` and end with `.L`.
    #[serde(default, with = "unique", skip_serializing_if = "BTreeMap::is_empty")]
    pub regions: BTreeMap<String, Vec<String>>,
    /// Names of the game's own senses: numbers that conditions read and that the game sets by
    /// [`Creature::set_sense`](crate::Creature::set_sense). A number is 0 at first, and stays as it is until the game
    /// sets it anew. A name that a sense or a mood has already is refused.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub senses: Vec<String>,
    /// The states by name. Names are unique in the file, inner states included.
    #[serde(with = "unique")]
    pub states: BTreeMap<String, StateFile>,
}

/// A mood: a number from 0 to 1 that conditions raise, and that fades.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MoodFile {
    /// Seconds in which it fades from 1 to 0, at a constant rate: from 0 to 1,000,000; less than a tick counts as one
    /// tick.
    pub fades: f64,
    /// Rules that raise the mood. In each tick the mood is at least the largest [`RaiseFile::to`] of the rules whose
    /// conditions hold.
    pub raised: Vec<RaiseFile>,
}

/// A rule that raises a mood: while its conditions hold, the mood is at least `to`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RaiseFile {
    /// Conditions on senses and moods, such as `"struck"` or `"riders >= 1"`; [the brain's documentation](crate::brain)
    /// gives their form. The rule raises its mood while all of them hold; without any, always.
    pub when: Vec<String>,
    /// Value from 0 to 1 to which the rule raises its mood while the conditions hold. A higher mood stays as it is, and
    /// fades.
    pub to: f64,
}

/// A state with either an act or inner states, which are states nested in it. While a state with inner states is
/// current, exactly one of them is current, too.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateFile {
    /// The creature's act in this state. With `None` it stands: it plays the idle clip if it has a gait, else goes on
    /// with its last clip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub act: Option<StateAction>,
    /// Where the creature looks. `None` takes the gaze of the outer state.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gaze: Option<Gaze>,
    /// Seconds in which the clip of the act fades in, from the pose that the creature has when the act begins: from 0,
    /// for no fade, to 1,000,000; 0.6 by default. In a state without an act, and in place of an attack that is blocked,
    /// the idle clip fades in within this time. Walks and turns do not use it, nor does a sleep, which plays no clip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fade: Option<f64>,
    /// Names of weak points that can be hurt in this state and its inner states even if their order
    /// ([`WeakPointFile::order`](crate::WeakPointFile::order)) hides them otherwise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub exposes: Vec<String>,
    /// Seconds after the state was left in which no transition enters it again, from 0 to 1,000,000; 0 by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cooldown: Option<f64>,
    /// True for a final state, such as death: no transition leads out of it. Only the game can take the creature out of
    /// it ([`Creature::enter`](crate::Creature::enter)). False by default.
    #[serde(rename = "final", default, skip_serializing_if = "is_false")]
    pub is_final: bool,
    /// Name of the inner state that the creature enters together with this state: one of `states`. A state with inner
    /// states needs it; any other state must not have it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<String>,
    /// Transitions out of this state and of all its inner states.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transitions: Vec<TransitionFile>,
    /// The inner states: states that are nested in this one, by name. While this state is current, so is exactly one of
    /// them; `start` names the one that is entered with it. Names are unique in the whole file. Empty by default, for a
    /// state without inner states.
    #[serde(default, with = "unique", skip_serializing_if = "BTreeMap::is_empty")]
    pub states: BTreeMap<String, StateFile>,
}

/// A transition from one state to another. It is possible while `when` and `any` (conditions), `on` (a marker) and
/// `after` (a time) all allow it; without any of these it is taken as soon as its state is entered. Two things hold up
/// even such a transition: an act that has to be played to its end, and the target's
/// [`cooldown`](StateFile::cooldown). A transition that `interrupts` the act waits only until the tick after the one in
/// which its state is entered. If several are possible, `priority` and `weight` decide.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TransitionFile {
    /// Name of the target state, without the names of its outer states. Any state of the file is allowed. If it has
    /// inner states, the creature enters its `start`.
    pub to: String,
    /// Conditions on senses and moods that must all hold, such as `"riders >= 1"` or `"!prey_seen"`; [the brain's
    /// documentation](crate::brain) gives their form. An empty list sets no condition.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub when: Vec<String>,
    /// Conditions, as in `when`, of which at least one must hold in addition to all of `when`. An empty list sets no
    /// condition.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub any: Vec<String>,
    /// Name of a marker that the creature's clip must have passed in the last tick. Markers are times with names in a
    /// clip ([`ClipFile::markers`](crate::ClipFile::markers)). `None` waits for no marker.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
    /// Seconds that the state must have lasted. A random time is the same for all transitions of a state with the same
    /// range, so that their weights decide.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after: Option<After>,
    /// Priority: only possible transitions of the highest priority are taken; 0 by default.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub priority: i32,
    /// Weight in the random choice among possible transitions of the same priority; 1 by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weight: Option<f64>,
    /// True if it may leave an act that otherwise has to be played to its end, [`StateAction::Once`] or
    /// [`StateAction::Attack`]; the clip is broken off then. A creature that is walking stops abruptly, unless the new
    /// act is a walk as well. If false, the default, the transition is possible only once such an act is over; any
    /// other act can be left at any time. A creature that is walking then comes to a stand first, before an act other
    /// than a walk begins.
    #[serde(default, skip_serializing_if = "is_false")]
    pub interrupts: bool,
}

/// How long a state must have lasted before a transition can leave it ([`TransitionFile::after`]), seconds: fixed, or
/// random within a range. The time counts from when the state was entered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum After {
    /// A fixed time, seconds.
    Fixed(f64),
    /// A random time from the first number to the second one, seconds, both included. It is drawn anew each time that
    /// the state is entered.
    Between([f64; 2]),
}

/// What a creature does while a state of its brain is current: it plays a clip, attacks, walks, turns or sleeps. The
/// field `act` of a state has it ([`StateFile::act`]); a creature in a state without one stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StateAction {
    /// Plays a clip in a loop, on the spot.
    Play(String),
    /// Plays a clip once, to its end, and holds its last pose. Before the end, only a transition that interrupts leaves
    /// the state.
    Once(String),
    /// Plays a clip once in which a limb strikes people.
    Attack(Box<Attack>),
    /// Walks to a place.
    Walk(Walk),
    /// Turns on the spot to a place.
    Turn(Turn),
    /// Sleeps: holds its current pose, sees nothing, but feels and hears. A sleeping creature costs almost nothing.
    Sleep,
}

/// An act: the creature walks to a place, round walls and drops if there is a way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Walk {
    /// The goal of the walk. For a goal outside the creature's arena
    /// ([`CreatureConfig::arena`](crate::CreatureConfig::arena)), the nearest place in the arena counts.
    pub to: Place,
    /// The walk is done once the goal is within this level distance of the creature's origin, metres; 0.015 times the
    /// creature's height if that is more. With `strike` it is done once the goal is within this distance of where that
    /// clip strikes, with no least distance.
    pub within: f64,
    /// Name of the clip of an attack of this brain. The creature stops where the limb of this attack would strike the
    /// goal, and turned so that it would: not straight towards the goal if the limb strikes to one side. `None`, the
    /// default, walks to the goal itself and ends with any heading.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strike: Option<String>,
}

/// An act: the creature turns on the spot until it faces a place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Turn {
    /// The place that the creature turns to face. It follows a place that moves, such as prey.
    pub to: Place,
    /// The turn is done when the place is within this angle of straight ahead, degrees.
    pub within_deg: f64,
}

/// A place to walk or to turn to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// The nearest person in view that does not ride the creature. If no such person is in view, the place where one
    /// was last seen, or home if none was ever seen.
    Prey,
    /// The place where the creature began or was last put. Ground that carries the creature carries this place along.
    Home,
    /// A random place in the arena, drawn when the act begins.
    Patrol,
    /// The place of the last noise.
    Noise,
    /// The place in front of the nearest wall, half the creature's width away from it.
    Wall,
}

/// Where a creature looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Gaze {
    /// Where its clips look: the head is not turned.
    #[default]
    Clip,
    /// At changing random places ahead.
    Around,
    /// At its prey.
    Prey,
    /// At the rider that has been on it longest.
    Rider,
}

fn is_false(value: &bool) -> bool {
    !value
}

fn is_zero(value: &i32) -> bool {
    *value == 0
}
