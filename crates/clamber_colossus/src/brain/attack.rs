//! Attacks: the clip, the limb, and the wave, shot or beam that an attack sends out.

use serde::{Deserialize, Serialize};

use super::BrainProblem;
use super::compile::{check, check_above, check_seconds};

/// The longest flight of a shot, and the longest time in which a wave reaches its radius, seconds.
const LONGEST_FLIGHT: f64 = 60.0;

/// The largest speed of a shot when it leaves the limb, metres a second. With a larger one, a saved shot could exceed
/// the 62,000 m/s up to which saved states are accepted.
const FASTEST_SHOT: f64 = 1_000.0;

/// The largest gravity of a shot, metres a second squared. It adds 60,000 m/s in [`LONGEST_FLIGHT`] seconds; with more,
/// a saved shot could exceed the 62,000 m/s up to which saved states are accepted.
const STRONGEST_GRAVITY: f64 = 1_000.0;

/// A clip in which a limb strikes: with its skin, by a wave from where it comes down, by a shot, by a beam, or by
/// several of these.
///
/// Waves, shots and beams spare riders of the creature, and people behind terrain; shots and beams also spare people
/// behind another creature. The creature's own body does not stop them. Lengths and speeds are in metres and metres a
/// second of world space, and do not scale with the creature's size. A limb, wave, shot or beam with neither damage nor
/// throw strikes nobody.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attack {
    /// The clip that is played once.
    pub clip: String,
    /// Joints whose skin deals the limb's blows to people it touches, from the clip's marker `active` to its marker
    /// `recovery`. For example `["foot.R", "toe.R"]`, or `["thumb.*.R", "hand.R"]`, where `*` stands for any text, once
    /// in a name. The last one is the limb's end: `aim` moves it to the prey, shots and beams start there, and waves
    /// above the ground next to it. If the last name has a `*`, it is the last joint of the skeleton that fits.
    pub limb: Vec<String>,
    /// Share of a person's full hit points that a blow of the limb costs, from 0 to 1. With 0 a blow only changes the
    /// person's velocity, by `throw`. If both are 0, the limb itself strikes nobody; a wave, a shot or a beam of the
    /// attack still does.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub damage: f64,
    /// Speed that a blow of the limb gives the person along the limb's motion, metres a second, not negative. With 0 a
    /// blow only costs hit points.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub throw: f64,
    /// How far the limb's end may deviate from where the clip strikes, towards the prey, metres. A leg goes only as far
    /// as it reaches, a mouth or a hand only as far as the neck or the arm above it does. 0 strikes where the clip
    /// does.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub aim: f64,
    /// A wave from above the ground near the limb's end, or from above the limb's end if there is no ground near it. It
    /// starts at the clip's first marker `impact`, or at its marker `recovery` if it has none. The limb, its wave and
    /// its beam together strike a person once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wave: Option<Wave>,
    /// A shot that leaves the limb's end at the clip's marker `active`. It ends where its middle meets terrain or
    /// another creature, or where it touches a person.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shot: Option<Shot>,
    /// A beam from the limb's end, from the clip's marker `active` to its marker `recovery`. It ends at terrain or at
    /// another creature.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beam: Option<Beam>,
    /// Speed at which the target of a shot or a beam follows the prey, metres a second, from 0, the default, to
    /// 1,000,000. The target starts at the middle of the prey when the attack begins; if no prey is seen then, one
    /// creature's height ([`Creature::height`](crate::Creature::height)) ahead of the creature, level with its feet. It
    /// follows the prey until the shot leaves or the beam ends, but stays where it is while the creature sees no prey.
    /// A faster person escapes. An attack without a shot and a beam is refused if this is not 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub follows: f64,
}

/// A growing ball that strikes each person once when it reaches them: a shock wave, a tremor, a blast.
///
/// The centre is above the ground, or off the surface that a shot has met, by 0.5 m or a thirtieth of `radius`,
/// whichever is more; if terrain there is nearer than that, half way to it. Lower rocks do not stop it. Distances are
/// from the centre to a person's skin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// The largest radius that it reaches, metres.
    pub radius: f64,
    /// How fast it grows, metres a second: it has to reach `radius` within 60 s. `None` strikes all people within
    /// `radius` at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// Height above terrain from which people are spared, metres, more than 0 and at most 1,000,000: the wave strikes a
    /// person only if the body would touch terrain when moved down by this. So people are spared who are high enough
    /// above terrain, in a jump or on another creature. `None` strikes at any height.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// Share of a person's full hit points that the wave costs at its centre, 0 to 1. At a distance d it costs this
    /// times 1 - d / radius.
    pub damage: f64,
    /// Speed that it gives at its centre, metres a second, in a direction half way between up and away from the centre.
    /// It falls off as the damage does.
    pub throw: f64,
}

/// A projectile that a creature throws, spits or shoots.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shot {
    /// Speed when it leaves the limb, metres a second, more than 0 and at most 1,000.
    pub speed: f64,
    /// Radius of the ball that touches people, metres.
    pub radius: f64,
    /// Gravity of the shot, metres a second squared, from 0 to 1,000; 9.81 by default. The shot takes the lower of two
    /// arcs to its target. If the target is out of range, it flies as far in that direction as its speed allows. With 0
    /// it flies straight.
    #[serde(default = "earth", skip_serializing_if = "is_earth")]
    pub gravity: f64,
    /// Seconds after which it disappears if it meets nothing, more than 0 and at most 60; 20 by default.
    #[serde(default = "lasts", skip_serializing_if = "is_default_lasts")]
    pub lasts: f64,
    /// Share of a person's full hit points that the shot costs the person that it touches, 0 to 1.
    pub damage: f64,
    /// Speed that a hit gives the person along the shot's path, metres a second.
    pub throw: f64,
    /// A wave from where the shot meets something. The shot and its wave together strike a person once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wave: Option<Wave>,
}

/// A straight beam that strikes each person it touches once.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// Length of the beam if nothing stops it, metres.
    pub length: f64,
    /// Radius of the beam, metres.
    pub radius: f64,
    /// Share of a person's full hit points that the beam costs a person that it touches, 0 to 1: once per attack,
    /// however long the beam stays on the person.
    pub damage: f64,
    /// Speed that the beam gives a person that it touches, along the beam, metres a second: once per attack.
    pub throw: f64,
}

impl Attack {
    pub(super) fn check(&self) -> Result<(), BrainProblem> {
        let text = |text: &str| Err(BrainProblem::Text(text.into()));
        if self.limb.is_empty() {
            return text("`limb` of an `attack` names no joint");
        }
        let has_target = self.shot.is_some() || self.beam.is_some();
        if !self.limb_strikes() && self.wave.is_none() && !has_target {
            return text(
                "an `attack` needs `damage` or `throw`, or a `wave`, a `shot` or a `beam`",
            );
        }
        if self.follows != 0.0 && !has_target {
            return text("`follows` of an `attack` needs a `shot` or a `beam`");
        }
        check_blow(["damage", "throw"], self.damage, self.throw)?;
        check_seconds("aim", self.aim)?;
        check_seconds("follows", self.follows)?;
        if let Some(wave) = &self.wave {
            wave.check(&WAVE_FIELDS)?;
        }
        if let Some(shot) = &self.shot {
            shot.check()?;
        }
        if let Some(beam) = &self.beam {
            check_blow(["beam.damage", "beam.throw"], beam.damage, beam.throw)?;
            check_seconds("beam.radius", beam.radius)?;
            check_above("beam.length", beam.length, 1e6, UP_TO_MILLION)?;
        }
        Ok(())
    }

    /// True if the skin of the limb hurts.
    pub(crate) fn limb_strikes(&self) -> bool {
        strikes(self.damage, self.throw)
    }

    /// The wave of the limb or of the shot; `None` if the attack has no such wave.
    pub(crate) fn wave_of(&self, of: WaveOf) -> Option<&Wave> {
        match of {
            WaveOf::Limb => self.wave.as_ref(),
            WaveOf::Shot => self.shot.as_ref()?.wave.as_ref(),
        }
    }
}

/// The source of a wave: where the limb comes down, or where the shot ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum WaveOf {
    Limb,
    Shot,
}

/// Names of a wave's fields in the file, for error messages.
type WaveNames = [&'static str; 5];

/// Names of the fields of [`Attack::wave`].
const WAVE_FIELDS: WaveNames = [
    "wave.radius",
    "wave.speed",
    "wave.height",
    "wave.damage",
    "wave.throw",
];
/// Names of the fields of [`Shot::wave`].
const SHOT_WAVE: WaveNames = [
    "shot.wave.radius",
    "shot.wave.speed",
    "shot.wave.height",
    "shot.wave.damage",
    "shot.wave.throw",
];

/// The range of lengths and speeds up to 1e6, for error messages.
const UP_TO_MILLION: &str = "more than 0 and at most 1,000,000";

impl Wave {
    pub(crate) fn strikes(&self) -> bool {
        strikes(self.damage, self.throw)
    }

    fn check(&self, names: &WaveNames) -> Result<(), BrainProblem> {
        let [radius, speed, height, damage, throw] = *names;
        check_blow([damage, throw], self.damage, self.throw)?;
        check_above(radius, self.radius, 1e6, UP_TO_MILLION)?;
        if let Some(found) = self.speed {
            check_above(speed, found, 1e6, UP_TO_MILLION)?;
            let is_enough = found * LONGEST_FLIGHT >= self.radius;
            check(is_enough, speed, "at least its radius / 60", found)?;
        }
        match self.height {
            Some(found) => check_above(height, found, 1e6, UP_TO_MILLION),
            None => Ok(()),
        }
    }
}

impl Beam {
    pub(crate) fn strikes(&self) -> bool {
        strikes(self.damage, self.throw)
    }
}

impl Shot {
    pub(crate) fn strikes(&self) -> bool {
        strikes(self.damage, self.throw)
    }

    fn check(&self) -> Result<(), BrainProblem> {
        check_blow(["shot.damage", "shot.throw"], self.damage, self.throw)?;
        check_seconds("shot.radius", self.radius)?;
        let speeds = "more than 0 and at most 1,000";
        check_above("shot.speed", self.speed, FASTEST_SHOT, speeds)?;
        check_above(
            "shot.lasts",
            self.lasts,
            LONGEST_FLIGHT,
            "more than 0 and at most 60",
        )?;
        let is_within = (0.0..=STRONGEST_GRAVITY).contains(&self.gravity);
        check(is_within, "shot.gravity", "from 0 to 1,000", self.gravity)?;
        self.wave
            .as_ref()
            .map_or(Ok(()), |wave| wave.check(&SHOT_WAVE))
    }
}

/// True if a blow does damage or changes velocity.
fn strikes(damage: f64, throw: f64) -> bool {
    damage != 0.0 || throw != 0.0
}

fn check_blow(names: [&'static str; 2], damage: f64, throw: f64) -> Result<(), BrainProblem> {
    let is_share = (0.0..=1.0).contains(&damage);
    check(is_share, names[0], "from 0 to 1", damage)?;
    check_seconds(names[1], throw)
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn earth() -> f64 {
    9.81
}

fn is_earth(value: &f64) -> bool {
    *value == earth()
}

fn lasts() -> f64 {
    20.0
}

fn is_default_lasts(value: &f64) -> bool {
    *value == lasts()
}
