//! What an attack does to people.

use serde::{Deserialize, Serialize};

use super::BrainProblem;
use super::compile::{check_seconds, out_of_range};

/// What is let out is over after this time, seconds.
const LONGEST: f64 = 60.0;

/// Shots are no faster than this when they leave, metres a second.
const FASTEST: f64 = 1_000.0;

/// Nothing pulls shots harder than this, metres a second squared.
const STRONGEST: f64 = 1_000.0;

/// A clip in which a limb strikes: with its skin, by a wave that goes out from where it comes down, by something that
/// it throws, by a beam, or by several of these.
///
/// Waves, shots and beams spare who rides the creature, and who is behind terrain. Its own body stops none of them. All
/// lengths and speeds are in metres and seconds of the world, whatever the creature's size is. What has neither damage
/// nor throw strikes nobody.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attack {
    /// The clip.
    pub clip: String,
    /// Joints whose skin hurts, such as `["foot.R", "toe.R"]`, or `["thumb.*.R", "hand.R"]`. The last one is its end.
    pub limb: Vec<String>,
    /// Hit points that a blow of the limb costs, 0 to 1. If this and `throw` are 0, the limb hurts nobody.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub damage: f64,
    /// Speed that a blow of the limb gives along its motion, metres a second.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub throw: f64,
    /// The limb's end goes to its prey if that is within this distance of where the clip strikes, metres: a leg as far as
    /// it reaches, a mouth or a hand as far as the neck or the arm above it does. 0 strikes where the clip does.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub aim: f64,
    /// A wave that goes out from the ground at the limb's end, or from the limb's end if there is no ground near it, at the
    /// clip's first marker `impact`, or at its marker `recovery` if it has none. The limb, its wave and its beam together
    /// strike a person once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wave: Option<Wave>,
    /// What leaves the limb's end at the clip's marker `active`. It ends where its middle meets terrain or another
    /// creature, or where it touches somebody.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shot: Option<Shot>,
    /// What goes out from the limb's end from the clip's marker `active` to its marker `recovery`, as far as terrain or
    /// another creature.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beam: Option<Beam>,
    /// A shot or a beam goes to where the middle of the prey was when the attack began. If no prey was seen then, it goes
    /// to a place ahead of the creature, level with its feet, as far away as the creature is high. While the creature
    /// sees prey, this place follows the prey with so many metres a second: for a shot until it leaves, for a beam until
    /// its end. Whoever runs faster gets away.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub follows: f64,
}

/// A ball that grows, and strikes whom it reaches, once: a shock wave, a tremor, a blast.
///
/// It begins somewhat above the ground, or off what a shot has met: by 0.5 m, or by a thirtieth of its radius if that is
/// more. Lower rocks do not stop it. Distances count from there to a person's skin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// How far it goes, metres.
    pub radius: f64,
    /// How fast it grows, metres a second: fast enough to be at its end within 60 s. Without it all are struck at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// It strikes only whose body would touch terrain if it were so many metres lower: who jumps is spared, and so is who
    /// stands on another creature. Without it all are struck.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// Hit points that it costs where it begins, 0 to 1. At a distance d it is this times 1 - d / radius.
    pub damage: f64,
    /// Speed that it gives where it begins, metres a second, in a direction half way between up and away from there. It
    /// falls off as the damage does.
    pub throw: f64,
}

/// Something that is thrown, spat or shot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shot {
    /// Metres a second, more than 0 and at most 1,000.
    pub speed: f64,
    /// Radius of the ball that strikes people, metres.
    pub radius: f64,
    /// What pulls it down, metres a second squared, at most 1,000; 9.81 if it is not given. It goes by the flat one of two
    /// arcs, and as far in that direction as its speed lets it if none gets there. With 0 it goes straight.
    #[serde(default = "earth", skip_serializing_if = "is_earth")]
    pub gravity: f64,
    /// Seconds after which it is gone if it meets nothing, at most 60; 20 if it is not given.
    #[serde(default = "lasts", skip_serializing_if = "is_default_lasts")]
    pub lasts: f64,
    /// Hit points that it costs, 0 to 1.
    pub damage: f64,
    /// Speed that it gives along its way, metres a second.
    pub throw: f64,
    /// A wave that goes out from where the shot meets something. The shot and its wave together strike a person once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wave: Option<Wave>,
}

/// A straight beam, that strikes whom it touches, once.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// How far it goes, metres.
    pub length: f64,
    /// How thick it is, metres.
    pub radius: f64,
    /// Hit points that it costs, 0 to 1.
    pub damage: f64,
    /// Speed that it gives along its way, metres a second.
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
            wave.check(&WAVE)?;
        }
        if let Some(shot) = &self.shot {
            shot.check()?;
        }
        if let Some(beam) = &self.beam {
            check_blow(["beam.damage", "beam.throw"], beam.damage, beam.throw)?;
            check_seconds("beam.radius", beam.radius)?;
            check_above("beam.length", beam.length, 1e6, MILLION)?;
        }
        Ok(())
    }

    /// True if its limb's skin hurts.
    pub(crate) fn limb_strikes(&self) -> bool {
        strikes(self.damage, self.throw)
    }

    /// The wave that goes out where its limb comes down, or where its shot ends.
    pub(crate) fn wave_of(&self, of: WaveOf) -> Option<&Wave> {
        match of {
            WaveOf::Limb => self.wave.as_ref(),
            WaveOf::Shot => self.shot.as_ref()?.wave.as_ref(),
        }
    }
}

/// What a wave goes out from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum WaveOf {
    Limb,
    Shot,
}

/// Names of a wave's numbers, for messages.
type WaveNames = [&'static str; 5];

const WAVE: WaveNames = [
    "wave.radius",
    "wave.speed",
    "wave.height",
    "wave.damage",
    "wave.throw",
];
const SHOT_WAVE: WaveNames = [
    "shot.wave.radius",
    "shot.wave.speed",
    "shot.wave.height",
    "shot.wave.damage",
    "shot.wave.throw",
];

const MILLION: &str = "more than 0 and at most 1,000,000";

impl Wave {
    pub(crate) fn strikes(&self) -> bool {
        strikes(self.damage, self.throw)
    }

    fn check(&self, names: &WaveNames) -> Result<(), BrainProblem> {
        let [radius, speed, height, damage, throw] = *names;
        check_blow([damage, throw], self.damage, self.throw)?;
        check_above(radius, self.radius, 1e6, MILLION)?;
        if let Some(found) = self.speed {
            check_above(speed, found, 1e6, MILLION)?;
            if found * LONGEST < self.radius {
                return Err(out_of_range(speed, "at least its radius / 60", found));
            }
        }
        match self.height {
            Some(found) => check_above(height, found, 1e6, MILLION),
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
        check_above("shot.speed", self.speed, FASTEST, speeds)?;
        check_above(
            "shot.lasts",
            self.lasts,
            LONGEST,
            "more than 0 and at most 60",
        )?;
        if !(0.0..=STRONGEST).contains(&self.gravity) {
            return Err(out_of_range(
                "shot.gravity",
                "from 0 to 1,000",
                self.gravity,
            ));
        }
        self.wave
            .as_ref()
            .map_or(Ok(()), |wave| wave.check(&SHOT_WAVE))
    }
}

/// True if a blow does anything.
fn strikes(damage: f64, throw: f64) -> bool {
    damage != 0.0 || throw != 0.0
}

fn check_blow(names: [&'static str; 2], damage: f64, throw: f64) -> Result<(), BrainProblem> {
    if !(0.0..=1.0).contains(&damage) {
        return Err(out_of_range(names[0], "from 0 to 1", damage));
    }
    check_seconds(names[1], throw)
}

fn check_above(
    what: &'static str,
    found: f64,
    most: f64,
    range: &'static str,
) -> Result<(), BrainProblem> {
    if found > 0.0 && found <= most {
        Ok(())
    } else {
        Err(out_of_range(what, range, found))
    }
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
