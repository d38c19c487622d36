use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Attack, unique};
use crate::kind::BodyFile;

/// A brain as its file has it: states, moods, and what leads from one state to another.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BrainFile {
    /// The body that the brain moves: legs, head, gait.
    #[serde(default)]
    pub body: BodyFile,
    /// The state in which the creature begins.
    pub start: String,
    /// Moods by name: numbers from 0 to 1 that are raised by what is sensed, and fade.
    #[serde(default, with = "unique", skip_serializing_if = "BTreeMap::is_empty")]
    pub moods: BTreeMap<String, MoodFile>,
    /// Regions of the body by name, each with joints, whose senses are told apart. `"spine.*"` names all joints that
    /// begin with `spine.`, and `"thumb.*.L"` all that also end with `.L`.
    #[serde(default, with = "unique", skip_serializing_if = "BTreeMap::is_empty")]
    pub regions: BTreeMap<String, Vec<String>>,
    /// The game's own senses: numbers that it sets.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub senses: Vec<String>,
    /// The states by name. A name stands only once in the file.
    #[serde(with = "unique")]
    pub states: BTreeMap<String, StateFile>,
}

/// A mood.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MoodFile {
    /// Seconds in which it fades from 1 to 0, at a steady rate.
    pub fades: f64,
    /// What raises it.
    pub raised: Vec<RaiseFile>,
}

/// What raises a mood.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RaiseFile {
    /// Conditions that must all hold.
    pub when: Vec<String>,
    /// The mood is at least this while they hold, 0 to 1.
    pub to: f64,
}

/// A state. It has either an act, or states inside it, of which one is current.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateFile {
    /// What the creature does. Without one it goes on standing as it stands.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub act: Option<Act>,
    /// Where it looks. A state inside another one looks where the outer one does, unless it says otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gaze: Option<Gaze>,
    /// Seconds in which the act fades in; 0.6 if it does not say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fade: Option<f64>,
    /// Weak points, by name, that can be hurt in this state although they are hidden otherwise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub exposes: Vec<String>,
    /// Seconds after it was left in which it can't be entered again.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cooldown: Option<f64>,
    /// True if it is never left.
    #[serde(rename = "final", default, skip_serializing_if = "is_false")]
    pub is_final: bool,
    /// Of the states inside it, the one that is entered with it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<String>,
    /// What leads out of it, and of all states inside it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transitions: Vec<TransitionFile>,
    /// The states inside it.
    #[serde(default, with = "unique", skip_serializing_if = "BTreeMap::is_empty")]
    pub states: BTreeMap<String, StateFile>,
}

/// What leads from a state to another one. All that it names must hold; if it names nothing, it is taken at once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TransitionFile {
    /// The state that is entered.
    pub to: String,
    /// Conditions that must all hold, such as `"riders >= 1"` or `"!prey_seen"`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub when: Vec<String>,
    /// Conditions of which at least one must hold.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub any: Vec<String>,
    /// A marker of the clip that must have been passed in this tick.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
    /// Seconds that the state must have lasted. A time that is drawn by lot is the same for all transitions of a state
    /// with the same range, so that their weights decide.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after: Option<After>,
    /// Of the transitions that can be taken, those of the highest priority are; 0 if it does not say.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub priority: i32,
    /// Of several with the same priority one is drawn by lot, by their weights; 1 if it does not say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weight: Option<f64>,
    /// True if it may leave an act that has to be played to its end.
    #[serde(default, skip_serializing_if = "is_false")]
    pub interrupts: bool,
}

/// A time, seconds: fixed, or drawn by lot between two when the state is entered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum After {
    /// Fixed.
    Fixed(f64),
    /// Drawn from here to there.
    Between([f64; 2]),
}

/// What a creature does in a state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Act {
    /// Plays a clip again and again, on the spot.
    Play(String),
    /// Plays a clip once, to its end, and holds that. The state is left only then, or by a transition that interrupts.
    Once(String),
    /// Plays a clip once, in which a limb strikes people.
    Attack(Box<Attack>),
    /// Walks to a place.
    Walk(Walk),
    /// Turns on the spot to a place.
    Turn(Turn),
    /// Sleeps: holds the pose that its clips have reached, sees nothing, but feels and hears. It costs almost nothing.
    Sleep,
}

/// A walk to a place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Walk {
    /// Where to.
    pub to: Place,
    /// It has arrived when it is as near as this, metres. For an attack, as near to where that strikes.
    pub within: f64,
    /// Walks to where this attack's clip strikes the place, and faces it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strike: Option<String>,
}

/// A turn on the spot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Turn {
    /// To what.
    pub to: Place,
    /// It is done when the place is as near as this to straight ahead, degrees.
    pub within_deg: f64,
}

/// A place to go to, or to turn to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// The nearest person that is seen and does not ride; the place where one was seen last if none is.
    Prey,
    /// Where the creature was placed first.
    Home,
    /// A place of the arena, drawn by lot when the state is entered.
    Patrol,
    /// Where the last noise came from.
    Noise,
    /// The nearest wall, at the side that is nearest to it.
    Wall,
}

/// Where a creature looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Gaze {
    /// As its clips do.
    #[default]
    Clip,
    /// Here and there.
    Around,
    /// At its prey.
    Prey,
    /// At who rides it.
    Rider,
}

fn is_false(value: &bool) -> bool {
    !value
}

fn is_zero(value: &i32) -> bool {
    *value == 0
}
