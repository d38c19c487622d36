//! The tasks of a soak, with names by which a task can be repeated.

use std::fmt;
use std::str::FromStr;

use clamber_scenes::Creature;
use clamber_verify::stress::{Case, Times, run};
use clamber_verify::targets::{builder, import, palettes, queries, square};

use crate::arena::arena;
use crate::fight::fight;
use crate::life::life;

/// A task of a soak. It runs the same way every time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Task {
    /// A stress case.
    Stress(Case),
    /// A fuzz target, with the seed of its random bytes.
    Fuzz(Target, u64),
    /// A whole battle, with its seed.
    Battle(u64),
    /// An arena with its seed: creatures and fighters of any size at any place.
    Arena(u64),
    /// The giant's life, with its seed.
    Life(u64),
}

/// A fuzz target of `clamber_verify`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    Queries,
    Palettes,
    Builder,
    Import,
}

impl Target {
    /// All targets.
    pub(crate) const ALL: [Self; 4] = [Self::Queries, Self::Palettes, Self::Builder, Self::Import];

    fn name(self) -> &'static str {
        match self {
            Self::Queries => "queries",
            Self::Palettes => "palettes",
            Self::Builder => "builder",
            Self::Import => "import",
        }
    }
}

impl Task {
    /// Name of the task's kind in a report.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Stress(_) => "stress",
            Self::Fuzz(target, _) => target.name(),
            Self::Battle(_) => "battle",
            Self::Arena(_) => "arena",
            Self::Life(_) => "life",
        }
    }

    /// Runs the task; returns the number of checks. Panics if a check fails. Only a life takes its length from
    /// `minutes`.
    pub(crate) fn run(&self, giant: &Creature, minutes: f64, times: &mut Times) -> usize {
        match self {
            Self::Stress(case) => run(case, Some(times)).checks(),
            Self::Battle(seed) => fight(giant, *seed),
            Self::Arena(seed) => arena(giant, *seed),
            Self::Life(seed) => life(giant, *seed, minutes),
            Self::Fuzz(target, seed) => {
                let bytes = random_bytes(*target, *seed);
                match target {
                    Target::Queries => {
                        let seen = queries(&bytes);
                        seen.answered + seen.refused + seen.edits
                    }
                    Target::Palettes => {
                        let seen = palettes(&bytes);
                        seen.accepted + seen.refused + seen.motions
                    }
                    Target::Builder => {
                        builder(&bytes);
                        1
                    }
                    Target::Import => {
                        import(&bytes);
                        1
                    }
                }
            }
        }
    }
}

/// Random bytes for a target. For an import they are a valid file with some bytes changed.
fn random_bytes(target: Target, seed: u64) -> Vec<u8> {
    let mut rng = fastrand::Rng::with_seed(seed);
    if target != Target::Import {
        return (0..rng.usize(4..200)).map(|_| rng.u8(..)).collect();
    }
    let (json, binary) = square();
    let mut file = [&json[..], &[0], &binary].concat();
    for _ in 0..rng.usize(1..4) {
        let at = rng.usize(0..file.len());
        // In the JSON text, a file loads more often with characters that JSON uses than with any bytes.
        file[at] = if at < json.len() {
            b"0123456789-.eE[]{}\","[rng.usize(0..20)]
        } else {
            [0, 1, 127, 128, 255, rng.u8(..)][rng.usize(0..6)]
        };
    }
    file
}

impl fmt::Display for Task {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stress(case) => write!(f, "stress/{case}"),
            Self::Fuzz(_, seed) | Self::Battle(seed) | Self::Arena(seed) | Self::Life(seed) => {
                write!(f, "{}/{seed}", self.kind())
            }
        }
    }
}

impl FromStr for Task {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let kinds = || {
            let targets = Target::ALL.map(Target::name).join("/SEED, ");
            format!(
                "{text:?} is none of stress/CASE, battle/SEED, arena/SEED, life/SEED, {targets}/SEED"
            )
        };
        let (kind, rest) = text.split_once('/').unwrap_or((text, "1"));
        if kind == "stress" {
            return Ok(Self::Stress(rest.parse()?));
        }
        let seed = rest
            .parse()
            .map_err(|_| format!("{rest:?} is not a seed"))?;
        Ok(match kind {
            "battle" => Self::Battle(seed),
            "arena" => Self::Arena(seed),
            "life" => Self::Life(seed),
            _ => {
                let target = Target::ALL.into_iter().find(|target| target.name() == kind);
                Self::Fuzz(target.ok_or_else(kinds)?, seed)
            }
        })
    }
}
