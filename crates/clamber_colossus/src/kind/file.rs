use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::brain::unique;

/// What a brain file says about the body: which joints are legs and head, and which clips walk. All names are those of
/// the creature's file. A body without legs keeps its feet where its clips have them, one without a gait does not walk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyFile {
    /// Where the model looks in its file; `+z` by default. Everything else is about the model as it is then turned, so
    /// that it looks along +Z.
    #[serde(default, skip_serializing_if = "Facing::is_forward")]
    pub facing: Facing,
    /// What the file does not say about its clips, by their names.
    #[serde(default, with = "unique", skip_serializing_if = "BTreeMap::is_empty")]
    pub clips: BTreeMap<String, ClipFile>,
    /// Weak points, after those of the creature's own file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub weak_points: Vec<WeakPointFile>,
    /// The legs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub legs: Vec<LegFile>,
    /// The clips that move it from place to place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gait: Option<GaitFile>,
    /// Its head and neck.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub head: Option<HeadFile>,
    /// A clip that is added to all others, over and over.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub breathe: Option<String>,
    /// Pieces of armour that break off.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub plates: Vec<PlateFile>,
    /// Which of its skin is fur, which a climber holds on to, beside what its own file says.
    #[serde(default, skip_serializing_if = "FurFile::is_empty")]
    pub fur: FurFile,
    /// How tall it is, metres, at [`CreatureConfig::scale`](crate::CreatureConfig) 1; `None` for as tall as its file
    /// makes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// The height for which its clips were made, metres: they look right at that height. A taller creature of the same
    /// shape moves slower, by the square root of how much taller it is (Froude's law), as gravity is the same at any
    /// size; so do its turns. `None` plays them as they are at any size.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made_for: Option<f64>,
    /// How much the body trembles when a clip passes its marker `impact`: the largest acceleration at the hips, metres
    /// a second squared. A step gives 15 % of it.
    #[serde(default = "tremor")]
    pub tremor: f64,
}

impl Default for BodyFile {
    fn default() -> Self {
        Self {
            facing: Facing::PlusZ,
            clips: BTreeMap::new(),
            weak_points: Vec::new(),
            legs: Vec::new(),
            gait: None,
            head: None,
            breathe: None,
            plates: Vec::new(),
            fur: FurFile::default(),
            height: None,
            made_for: None,
            tremor: tremor(),
        }
    }
}

fn tremor() -> f64 {
    2.5
}

/// Where a model looks in its file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Facing {
    /// Along +Z, as glTF wants it.
    #[default]
    #[serde(rename = "+z")]
    PlusZ,
    /// Along -Z.
    #[serde(rename = "-z")]
    MinusZ,
    /// Along +X.
    #[serde(rename = "+x")]
    PlusX,
    /// Along -X.
    #[serde(rename = "-x")]
    MinusX,
}

impl Facing {
    fn is_forward(&self) -> bool {
        *self == Self::PlusZ
    }
}

/// What a creature's own file does not say about one of its clips.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClipFile {
    /// Markers by name, with their times, seconds after the clip's first key frame: `active` and `recovery` of an
    /// attack, `impact`, and those that transitions wait for. They replace those of the same name in the file.
    #[serde(default, with = "unique", skip_serializing_if = "BTreeMap::is_empty")]
    pub markers: BTreeMap<String, Times>,
    /// Seconds in which it goes back from its end to its beginning, which are added to it: more than 0, at most 10. For
    /// a clip that is played again and again, but ends in another pose than it begins with; give the time of a frame
    /// where only the last key frame is missing. Without it such a clip jumps, and throws off who rides. Markers are
    /// within the clip as it is in its file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub close: Option<f64>,
}

/// One time, or several.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Times {
    /// One.
    One(f64),
    /// Several.
    Several(Vec<f64>),
}

impl Times {
    /// All of them.
    pub fn all(&self) -> &[f64] {
        match self {
            Self::One(time) => core::slice::from_ref(time),
            Self::Several(times) => times,
        }
    }
}

/// Skin that is fur: it can be gripped and hung from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FurFile {
    /// Joints whose skin is fur: each triangle belongs to the joint that moves it most. `"spine.*"` names all joints that
    /// begin with `spine.`, `"*"` all. Stone stays stone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<String>,
    /// Materials of the creature's file that are fur, by their names, whatever the file says of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<String>,
}

impl FurFile {
    fn is_empty(&self) -> bool {
        self.joints.is_empty() && self.materials.is_empty()
    }
}

/// A weak point that a creature's own file does not have. Lengths are in heights of the creature.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeakPointFile {
    /// Its name.
    pub name: String,
    /// The joint that moves it.
    pub joint: String,
    /// Its place at rest, as seen from the joint: along the model's axes (+X is its left, +Y up, +Z ahead).
    #[serde(default)]
    pub at: [f64; 3],
    /// Its radius.
    pub radius: f64,
    /// Damage that it takes, more than 0.
    pub hit_points: f64,
    /// True if the creature dies when it is used up.
    #[serde(default, skip_serializing_if = "is_false")]
    pub major: bool,
    /// It is hidden until all of lower order are used up: 0 without one, and 1 for a major one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<u32>,
}

fn is_false(value: &bool) -> bool {
    !value
}

/// A leg.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LegFile {
    /// Two to five joints from the hip down. The last is the foot. A person's are hip, knee and ankle; an animal's hind
    /// leg has more. Each is below the one before it, but for the foot: it may hang elsewhere, as a control that was
    /// baked into the file does, and is carried along then. The joint that divides the leg most evenly is its knee; others
    /// keep their pose.
    pub joints: Vec<String>,
    /// The joint at the ball of the foot; `None` if the foot is one piece.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub toe: Option<String>,
    /// To which side the knee points; `None` for the side to which it is bent at rest, or forward if it is straight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub knee: Option<Knee>,
}

/// To which side a knee points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Knee {
    /// Forward, as a human's.
    Forward,
    /// Backward, as a bird's ankle that is used as a knee.
    Backward,
}

/// The clips of walking and turning. The walk is a loop on the spot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GaitFile {
    /// The clip of standing.
    pub idle: String,
    /// The clip of walking.
    pub walk: String,
    /// Its speed over ground: how far it goes in a second of the clip, in heights of the creature, so that neither its
    /// size nor the unit of its file matters. `None` for the speed in the clip's extras, or without one for that of the
    /// feet while they stand in the clip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// Clips of turning on the spot to the left and to the right; `None` to turn with the idle clip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turn: Option<[String; 2]>,
    /// How fast it turns on the spot, degrees a second of the clip.
    pub turn_deg: f64,
    /// How fast it turns while it walks, degrees a second of the clip.
    pub steer_deg: f64,
}

/// A piece of armour that staggers the creature when it has taken a blow too many, and breaks off after some of those.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlateFile {
    /// Its name, for the game.
    pub name: String,
    /// Its triangles: those with this number in `SurfaceTag::user`, `"user"` in a material's extras. More than 0.
    pub user: u32,
    /// Damage after which it staggers, more than 0.
    pub stagger: f64,
    /// How often it staggers before it breaks, at least 1.
    pub count: u32,
}

/// The joints that look at something.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeadFile {
    /// From the head down, with the share of the turn that each one takes of what the joints above it leave, 0 to 1.
    /// The last one takes the rest.
    pub joints: Vec<(String, f64)>,
    /// The eye at rest, as seen from the head's joint: along the model's axes (+X is its left, +Y up, +Z ahead), in
    /// heights of the creature.
    #[serde(default)]
    pub eye: [f64; 3],
    /// How far it turns to either side, and up and down, degrees.
    #[serde(default = "limits")]
    pub limits_deg: [f64; 2],
}

fn limits() -> [f64; 2] {
    [80.0, 60.0]
}
