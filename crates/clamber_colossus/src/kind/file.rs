use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::brain::unique;

/// The body in a brain file: legs, head, gait and additions to the creature's own file. Joints, clips and materials
/// have their names in the creature's file. Without legs, feet stay where clips have them. Without a gait the creature
/// does not walk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyFile {
    /// The direction in which the model looks in its file; `+z` by default. The model is turned to look along +Z, and
    /// all other values are about the turned model.
    #[serde(default, skip_serializing_if = "Facing::is_forward")]
    pub facing: Facing,
    /// Additions to clips of the creature's own file, by the clips' names: markers, and time at a clip's end to close a
    /// loop. A name that no clip has is an error.
    #[serde(default, with = "unique", skip_serializing_if = "BTreeMap::is_empty")]
    pub clips: BTreeMap<String, ClipFile>,
    /// Weak points in addition to those in the creature's model file. Their indices come after the indices of those, in
    /// the order of this list.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub weak_points: Vec<WeakPointFile>,
    /// The legs, whose feet are put on the ground. Without any, feet stay where clips have them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub legs: Vec<LegFile>,
    /// The clips that the creature stands, walks and turns with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gait: Option<GaitFile>,
    /// The head and the neck, which turn to look at things.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub head: Option<HeadFile>,
    /// A clip of breathing. It is played in a loop and added to clips that are played in a loop.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub breathe: Option<String>,
    /// Pieces of armour, which take hits in place of the weak points below them, and break off.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub plates: Vec<PlateFile>,
    /// Skin that is fur, in addition to the fur of the creature's own file. A climber holds on to fur.
    #[serde(default, skip_serializing_if = "FurFile::is_empty")]
    pub fur: FurFile,
    /// Height of the creature, metres, at [`CreatureConfig::scale`](crate::CreatureConfig) 1. `None` keeps the size of
    /// its file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// The height for which the clips were made, metres: they look right at that height. A taller creature plays its
    /// clips and turns slower, by the square root of the ratio of heights (Froude's law), since gravity is the same at
    /// any size. `None` plays clips at their own speed at any size.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made_for: Option<f64>,
    /// Strength of the jolt, up and down at the creature's hips, when a clip passes its marker `impact`: nominally the
    /// largest acceleration of the swing that follows, metres a second squared, at any size. From 0 to 20, 2.5 by
    /// default. A footfall gives 15 % of it; jolts at the same time add up.
    ///
    /// The jolt itself grows with the creature. It changes the velocity of the hips at once, by
    /// `tremor * length.sqrt() / 50.0` metres a second, where `length` is the length of the longest leg in metres. The
    /// period of the swing grows with the square root of the leg's length as well, and its width with the length.
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

/// The direction in which a model looks in its file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Facing {
    /// Along +Z, as in glTF.
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

/// Additions to a clip of the creature's own file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClipFile {
    /// Markers by name, with their times in seconds after the clip's first key frame: `active` and `recovery` of an
    /// attack, `impact`, and markers that transitions wait for. They replace the clip's own markers of the same name.
    #[serde(default, with = "unique", skip_serializing_if = "BTreeMap::is_empty")]
    pub markers: BTreeMap<String, Times>,
    /// Seconds that are added to the clip's end, in which it returns to its first pose: more than 0, at most 10. It is
    /// for a clip that is played in a loop but ends in another pose than it begins with: without it the skin jumps at
    /// the seam, and throws off riders. If only the last key frame is missing, give the time of a frame. The added time
    /// has no markers: a time in `markers` beyond the clip's length in its file is an error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub close: Option<f64>,
}

/// The times at which a clip has a marker of one name ([`ClipFile::markers`]), seconds after its first key frame. In
/// the file it is a number or a list of numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Times {
    /// The marker occurs once, at this time, seconds.
    One(f64),
    /// The marker occurs at each of these times, seconds.
    Several(Vec<f64>),
}

impl Times {
    /// All times of the marker, seconds, as they stand in the file.
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
    /// Joints whose skin is fur. Each triangle belongs to the joint that moves it most. `"spine.*"` names all joints
    /// that begin with `spine.`, `"*"` all joints. Triangles of stone stay stone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<String>,
    /// Names of materials of the creature's file that are fur, also if the file gives them another surface.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<String>,
}

impl FurFile {
    fn is_empty(&self) -> bool {
        self.joints.is_empty() && self.materials.is_empty()
    }
}

/// A weak point in addition to the ones in a creature's own file. Lengths are in heights of the creature.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeakPointFile {
    /// Name of the weak point, for the game and for [`StateFile::exposes`](crate::brain::StateFile::exposes).
    /// [`CreatureState::carry_over`](crate::CreatureState::carry_over) finds the weak point by it when the brain's file
    /// is reloaded.
    pub name: String,
    /// The joint that moves it.
    pub joint: String,
    /// Centre of the weak point at rest, relative to the joint, along the model's axes: +X to the creature's left, +Y
    /// up, +Z ahead, in heights of the creature. By default it is at the joint.
    #[serde(default)]
    pub at: [f64; 3],
    /// Radius of the weak point, in heights of the creature, from 0 to 10. Hits on skin within it count.
    pub radius: f64,
    /// Damage that uses it up, more than 0. The unit is the game's own: damage of weapons is in the same unit
    /// ([`Creature::hurt`](crate::Creature::hurt)).
    pub hit_points: f64,
    /// True if the creature's health is 0 once this weak point is used up, whatever the others have left. Without a
    /// major one, health is 0 once all weak points are used up.
    #[serde(default, skip_serializing_if = "is_false")]
    pub major: bool,
    /// The weak point is hidden, and cannot be hurt, until all weak points of lower order are used up, except in states
    /// that expose it ([`StateFile::exposes`](crate::brain::StateFile::exposes)). `None` means 0, and 1 for a major
    /// one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<u32>,
}

fn is_false(value: &bool) -> bool {
    !value
}

/// A leg whose foot is put on the ground: its joints, and how its knee bends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LegFile {
    /// Two to five joints from the hip down to the foot, each below the one before in the skeleton: hip, knee and ankle
    /// of a human, more in an animal's hind leg. Only the foot may be elsewhere in the skeleton, like a control that
    /// was baked into the file; it then moves to where the leg ends. The knee is the joint that divides the leg most
    /// evenly; other joints keep their pose.
    pub joints: Vec<String>,
    /// The joint at the ball of the foot; `None` if the foot is one piece.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub toe: Option<String>,
    /// The side to which the knee points. `None` takes the side to which it is bent at rest, or forward if it is
    /// straight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub knee: Option<Knee>,
}

/// The side to which a knee points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Knee {
    /// Forward, like a human's.
    Forward,
    /// Backward, like a bird's ankle that is used as a knee.
    Backward,
}

/// The clips of standing, walking and turning. The walk is a loop on the spot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GaitFile {
    /// Name of the clip that is played in a loop while the creature plays no other clip: in a state without an act, in
    /// place of an attack that is blocked, in a turn if the gait has no clips of turning, and in a walk or a turn while
    /// the creature stands or goes backwards, as at its end.
    pub idle: String,
    /// Name of the clip that is played in a loop while the creature walks. It is a walk on the spot; `speed` says how
    /// fast the creature moves meanwhile.
    pub walk: String,
    /// Speed over ground: how far it walks in a second of the clip, in heights of the creature, so that neither its
    /// size nor the unit of its file matters. `None` takes the clip's own speed (in a glTF file the key `speed` in the
    /// object `clamber` of the animation's extras), or without one the speed of the feet while they stand in the clip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// Clips of turning on the spot to the left and to the right. `None` turns with the idle clip, and the feet follow
    /// by steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turn: Option<[String; 2]>,
    /// Rate of turning on the spot, degrees a second, while the clips play at the speed of their file. A creature that
    /// plays its clips slower ([`BodyFile::made_for`]) turns slower in proportion.
    pub turn_deg: f64,
    /// Rate of turning while it walks, degrees a second, while the clips play at the speed of their file. A creature
    /// that plays its clips slower ([`BodyFile::made_for`]) turns slower in proportion.
    pub steer_deg: f64,
}

/// A piece of armour: triangles of the skin on which a hit hurts no weak point. It staggers each time that the damage
/// to it since its last stagger reaches `stagger`, and breaks off at the last of `count` staggers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlateFile {
    /// Name of the plate, for the game. [`CreatureState::carry_over`](crate::CreatureState::carry_over) finds the plate
    /// by it when the brain's file is reloaded.
    pub name: String,
    /// The plate's triangles are those with this number in `SurfaceTag::user`, more than 0. In a glTF file the number
    /// is the key `user` in the object `clamber` of a material's extras: `{"clamber": {"user": 7}}`.
    pub user: u32,
    /// Damage at which the plate staggers: finite, more than 0, in the same unit as hit points of weak points. The
    /// damage of all hits on the plate adds up. When the sum reaches this number, the plate staggers, and the sum
    /// begins at 0 again. What the last hit did beyond this number does not count towards the next stagger, so one hit
    /// causes one stagger at most. A stagger is an event
    /// ([`CreatureEvent::Staggered`](crate::CreatureEvent::Staggered)) and a sense of the brain
    /// ([`Sense::Staggered`](crate::Sense::Staggered)); what the creature does then is up to its brain.
    pub stagger: f64,
    /// Number of this plate's own staggers after which it breaks off, at least 1.
    pub count: u32,
}

/// The joints of head and neck, which turn to look at things.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeadFile {
    /// Names of the joints that turn, from the head down, each above the one before in the skeleton. With each stands
    /// its share, from 0 to 1, of the turn that the joints before it leave; the last joint takes all of the rest,
    /// whatever its share.
    pub joints: Vec<(String, f64)>,
    /// The eye at rest relative to the head's joint, along the model's axes: +X to the creature's left, +Y up, +Z
    /// ahead, in heights of the creature. By default it is at the joint.
    #[serde(default)]
    pub eye: [f64; 3],
    /// Largest angles of the gaze, degrees: first to either side, from 0 to 180, then up and down, from 0 to 90; 80 and
    /// 60 by default. They count from straight ahead of the part of the body that carries the last of `joints`, as it
    /// faces in the current pose, not from the head's direction in the clip.
    #[serde(default = "limits")]
    pub limits_deg: [f64; 2],
}

fn limits() -> [f64; 2] {
    [80.0, 60.0]
}
