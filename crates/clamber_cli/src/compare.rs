//! Compares two recordings of one scene.

use std::path::{Path, PathBuf};

use clamber_record::{
    AnyRecording, ArenaDifference, ArenaRecording, Difference, Ending, RecordError, Recording,
    Replayed,
};
use clap::Args;
use thiserror::Error;

/// Compares two recordings of one scene tick by tick, bit for bit.
///
/// For example, the recordings of one fight on two platforms. Prints the first tick and the first field that differ; of
/// arenas the creatures and fighters that differ, or whose input does.
/// Exits with 1 if the recordings differ, with 2 if one cannot be read.
#[derive(Args, Clone, Debug)]
pub struct CompareOptions {
    /// A recording.
    #[arg(value_name = "FILE.mcap")]
    pub first: PathBuf,

    /// Another recording, which should be the same.
    #[arg(value_name = "OTHER.mcap")]
    pub second: PathBuf,
}

/// Why recordings cannot be compared.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CompareError {
    /// A recording cannot be read.
    #[error("{}: {error}", path.display())]
    Record {
        /// The file.
        path: PathBuf,
        /// The reason.
        error: RecordError,
    },
    /// The recordings are not of one scene.
    #[error("the recordings cannot be compared: their {0} differ")]
    Scene(&'static str),
}

/// How two recordings compare.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Comparison {
    /// So many ticks are equal in every bit, and there are no others.
    Equal(u64),
    /// The first tick that differs.
    Differ(Box<Difference>),
    /// The first tick in which arenas differ.
    ArenasDiffer(Box<ArenaDifference>),
    /// The step to this tick has other inputs for a fighter, in arenas that are equal so far.
    InputsDiffer {
        /// The tick.
        tick: u64,
        /// The fighter's name.
        fighter: String,
    },
    /// The step to this tick has other orders, in arenas that are equal so far.
    OrdersDiffer {
        /// The tick.
        tick: u64,
    },
    /// One ends after so many ticks that are equal, the other goes on.
    Shorter(u64),
}

/// Compares two recordings. The first counts as the recorded one, the second as the replayed one.
///
/// # Errors
/// [`CompareError`] if one cannot be read, or they are of different creatures or of different ticks.
pub fn compare(options: &CompareOptions) -> Result<Comparison, CompareError> {
    match [open(&options.first)?, open(&options.second)?] {
        [AnyRecording::Climber(one), AnyRecording::Climber(other)] => {
            climbers([&one, &other], options)
        }
        [AnyRecording::Arena(one), AnyRecording::Arena(other)] => arenas([&one, &other], options),
        _ => Err(CompareError::Scene("kinds of scene")),
    }
}

fn open(path: &Path) -> Result<AnyRecording, CompareError> {
    AnyRecording::open(path).map_err(|error| failed(path, error))
}

fn failed(path: &Path, error: RecordError) -> CompareError {
    let path = path.to_owned();
    CompareError::Record { path, error }
}

fn climbers(
    [first, second]: [&Recording; 2],
    options: &CompareOptions,
) -> Result<Comparison, CompareError> {
    let (one, other) = (first.info(), second.info());
    if one.creature_fingerprint != other.creature_fingerprint {
        return Err(CompareError::Scene("creatures"));
    }
    if one.tick_seconds != other.tick_seconds {
        return Err(CompareError::Scene("tick lengths"));
    }
    if first.first() != second.first() {
        return Err(CompareError::Scene("first ticks"));
    }
    let mut equal = 0;
    let (mut one, mut other) = (first.ticks(), second.ticks());
    while let Some((ours, theirs)) = both([&mut one, &mut other], options, |tick| tick.tick)? {
        let replayed = Replayed {
            state: theirs.state,
            palette_fingerprint: theirs.palette_fingerprint,
            scene_fingerprint: Some(theirs.scene_fingerprint),
        };
        if let Some(difference) = Difference::between(&ours, &replayed) {
            return Ok(Comparison::Differ(Box::new(difference)));
        }
        equal += 1;
    }
    Ok(ended(equal, first.len() == second.len()))
}

fn arenas(
    [first, second]: [&ArenaRecording; 2],
    options: &CompareOptions,
) -> Result<Comparison, CompareError> {
    if first.info().config != second.info().config {
        return Err(CompareError::Scene("configurations"));
    }
    if first.first() != second.first() {
        return Err(CompareError::Scene("first ticks"));
    }
    let mut equal = 0;
    // Whose inputs a step has.
    let mut fighters: Vec<usize> = Vec::new();
    let (mut one, mut other) = (first.ticks_from(0), second.ticks_from(0));
    while let Some((ours, theirs)) = both([&mut one, &mut other], options, |tick| tick.tick)? {
        let mut inputs = ours.inputs.iter().zip(&theirs.inputs);
        if let Some(fighter) = inputs.position(|(one, other)| one != other) {
            return Ok(Comparison::InputsDiffer {
                tick: ours.tick,
                fighter: match fighters.get(fighter) {
                    Some(number) => first.info().fighter(*number),
                    None => format!("input {fighter}"),
                },
            });
        }
        if ours.orders != theirs.orders {
            return Ok(Comparison::OrdersDiffer { tick: ours.tick });
        }
        let (all, parts) = (theirs.fingerprint, &theirs.parts);
        if let Some(difference) = ArenaDifference::between(first.info(), &ours, all, parts) {
            return Ok(Comparison::ArenasDiffer(Box::new(difference)));
        }
        fighters.clear();
        fighters.extend(ours.fighters());
        equal += 1;
    }
    Ok(ended(equal, first.len() == second.len()))
}

/// The next tick that both recordings have: either may have gaps.
fn both<T>(
    [first, second]: [&mut dyn Iterator<Item = Result<T, RecordError>>; 2],
    options: &CompareOptions,
    number: impl Fn(&T) -> u64,
) -> Result<Option<(T, T)>, CompareError> {
    let mut one = || {
        let tick = first.next().transpose();
        tick.map_err(|error| failed(&options.first, error))
    };
    let mut other = || {
        let tick = second.next().transpose();
        tick.map_err(|error| failed(&options.second, error))
    };
    let (mut ours, mut theirs) = (one()?, other()?);
    loop {
        match (ours, theirs) {
            (Some(a), Some(b)) if number(&a) == number(&b) => return Ok(Some((a, b))),
            (Some(a), Some(b)) if number(&a) < number(&b) => (ours, theirs) = (one()?, Some(b)),
            (Some(a), Some(_)) => (ours, theirs) = (Some(a), other()?),
            _ => return Ok(None),
        }
    }
}

/// After so many ticks that are equal, both end, or one of them.
fn ended(equal: u64, both: bool) -> Comparison {
    if both {
        Comparison::Equal(equal)
    } else {
        Comparison::Shorter(equal)
    }
}

/// Compares two recordings and prints the result; returns true if they are equal.
///
/// # Errors
/// As [`compare`].
pub fn print(options: &CompareOptions) -> Result<bool, CompareError> {
    for path in [&options.first, &options.second] {
        if let Ok(recording) = AnyRecording::open(path)
            && *recording.ending() != Ending::Whole
        {
            println!("{}: {}", path.display(), recording.ending());
        }
    }
    Ok(match compare(options)? {
        Comparison::Equal(ticks) => {
            println!("all {ticks} ticks are equal in every bit");
            true
        }
        Comparison::Shorter(ticks) => {
            println!("{ticks} ticks are equal in every bit; then one recording ends");
            false
        }
        Comparison::Differ(difference) => {
            print!("{difference}");
            false
        }
        Comparison::ArenasDiffer(difference) => {
            println!("{difference}");
            false
        }
        Comparison::OrdersDiffer { tick } => {
            println!("the orders of the step to tick {tick} differ; all is equal before");
            false
        }
        Comparison::InputsDiffer { tick, fighter } => {
            println!(
                "the input of {fighter} for the step to tick {tick} differs; all is equal before"
            );
            false
        }
    })
}
