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
/// The recordings may come from two platforms, for example. Prints the first tick and the first field that differ. For
/// arenas, prints the creatures and fighters that differ. If an input, a knockback or an order differs, prints that
/// instead, and whose input it is. Exits with 1 if the recordings differ, with 2 if one cannot be read or their scenes
/// differ.
#[derive(Args, Clone, Debug)]
pub struct CompareOptions {
    /// A recording.
    #[arg(value_name = "FILE.mcap")]
    pub first: PathBuf,

    /// The other recording, expected to be equal.
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
    /// A recording has no tick that can be read.
    #[error("{}: there is no tick in it", .0.display())]
    Empty(PathBuf),
    /// The recordings are of different scenes. The text names the property that differs, in the plural: `creatures`.
    #[error("the recordings cannot be compared: their {0} differ")]
    Scene(&'static str),
}

/// How two recordings compare.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Comparison {
    /// The recordings have the same ticks, this many, and all are equal in every bit.
    Equal(u64),
    /// The first tick that differs.
    Differ(Box<Difference>),
    /// The first tick in which arenas differ.
    ArenasDiffer(Box<ArenaDifference>),
    /// The inputs of the step to this tick differ. All ticks before are equal in every bit.
    InputsDiffer {
        /// The tick.
        tick: u64,
        /// The fighter's name, or `the climber`.
        fighter: String,
    },
    /// The knockback of the climber differs in the step to this tick. All ticks before are equal in every bit.
    KnockbacksDiffer {
        /// The tick.
        tick: u64,
    },
    /// The orders of the step to this tick differ. All ticks before are equal in every bit.
    OrdersDiffer {
        /// The tick.
        tick: u64,
    },
    /// This many ticks are equal; then one recording ends and the other goes on.
    Shorter(u64),
    /// The common ticks are equal in every bit, but at least one recording has gaps, where its recorder left ticks out.
    Partly {
        /// Number of ticks that both recordings have.
        equal: u64,
        /// Number of ticks that only the first recording has, and number that only the second has.
        alone: [u64; 2],
    },
}

/// Compares two recordings, the first as the recorded run, the second as its replay.
///
/// # Errors
/// [`CompareError`] if a recording cannot be read or has no ticks, or if the two differ in their kind of scene,
/// creature, tick length, configuration or first tick.
pub fn compare(options: &CompareOptions) -> Result<Comparison, CompareError> {
    let both = [open(&options.first)?, open(&options.second)?];
    for (recording, path) in both.iter().zip([&options.first, &options.second]) {
        if recording.is_empty() {
            return Err(CompareError::Empty(path.clone()));
        }
    }
    match both {
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
    let mut met = Met::default();
    let (mut one, mut other) = (first.ticks(), second.ticks());
    while let Some((ours, theirs)) =
        both([&mut one, &mut other], options, |tick| tick.tick, &mut met)?
    {
        if ours.input != theirs.input {
            return Ok(Comparison::InputsDiffer {
                tick: ours.tick,
                fighter: "the climber".to_owned(),
            });
        }
        if ours.knockback != theirs.knockback {
            return Ok(Comparison::KnockbacksDiffer { tick: ours.tick });
        }
        let replayed = Replayed {
            state: theirs.state,
            palette_fingerprint: theirs.palette_fingerprint,
            scene_fingerprint: Some(theirs.scene_fingerprint),
        };
        if let Some(difference) = Difference::between(&ours, &replayed) {
            return Ok(Comparison::Differ(Box::new(difference)));
        }
    }
    Ok(met.ended())
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
    let mut met = Met::default();
    // The numbers of the fighters to which the inputs of the next step belong, and the number of the tick before.
    let (mut fighters, mut before): (Vec<usize>, _) = (Vec::new(), None);
    let (mut one, mut other) = (first.ticks_from(0), second.ticks_from(0));
    while let Some((ours, theirs)) =
        both([&mut one, &mut other], options, |tick| tick.tick, &mut met)?
    {
        if before
            .replace(ours.tick)
            .and_then(|tick| tick.checked_add(1))
            != Some(ours.tick)
        {
            fighters.clear();
        }
        if ours.inputs.len() != theirs.inputs.len() {
            let fighter = "somebody who is in one of them".to_owned();
            return Ok(Comparison::InputsDiffer {
                tick: ours.tick,
                fighter,
            });
        }
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
        if let Some(difference) = ArenaDifference::between(first.info(), &ours, &theirs.parts) {
            return Ok(Comparison::ArenasDiffer(Box::new(difference)));
        }
        fighters.clear();
        fighters.extend(ours.fighters());
    }
    Ok(met.ended())
}

/// Returns the next tick that both recordings have, `None` after the last one. Either may have gaps: the ticks that
/// only one of them has are counted in `met`.
fn both<T>(
    ticks: [&mut dyn Iterator<Item = Result<T, RecordError>>; 2],
    options: &CompareOptions,
    number: impl Fn(&T) -> u64,
    met: &mut Met,
) -> Result<Option<(T, T)>, CompareError> {
    let paths = [&options.first, &options.second];
    let mut next = |index: usize| {
        let tick = ticks[index].next().transpose();
        tick.map_err(|error| failed(paths[index], error))
    };
    let (mut ours, mut theirs) = (next(0)?, next(1)?);
    loop {
        match (ours, theirs) {
            (Some(a), Some(b)) if number(&a) == number(&b) => {
                met.equal += 1;
                return Ok(Some((a, b)));
            }
            (Some(a), Some(b)) if number(&a) < number(&b) => {
                met.alone[0] += 1;
                met.has_gaps = true;
                (ours, theirs) = (next(0)?, Some(b));
            }
            (Some(a), Some(_)) => {
                met.alone[1] += 1;
                met.has_gaps = true;
                (ours, theirs) = (Some(a), next(1)?);
            }
            (Some(_), None) => {
                met.alone[0] += 1;
                (ours, theirs) = (next(0)?, None);
            }
            (None, Some(_)) => {
                met.alone[1] += 1;
                (ours, theirs) = (None, next(1)?);
            }
            (None, None) => return Ok(None),
        }
    }
}

/// Counts of the ticks of two recordings.
#[derive(Default)]
struct Met {
    /// Ticks that both have.
    equal: u64,
    /// Ticks that only the first has, and only the second.
    alone: [u64; 2],
    /// True if a recording lacks ticks before its end.
    has_gaps: bool,
}

impl Met {
    /// The result for recordings whose common ticks are all equal.
    fn ended(&self) -> Comparison {
        let Self { equal, alone, .. } = *self;
        match (self.has_gaps, alone) {
            (_, [0, 0]) => Comparison::Equal(equal),
            (false, _) => Comparison::Shorter(equal),
            (true, _) => Comparison::Partly { equal, alone },
        }
    }
}

/// Compares two recordings and prints the result. Returns true if they are equal.
///
/// # Errors
/// See [`compare`].
pub fn print(options: &CompareOptions) -> Result<bool, CompareError> {
    for path in [&options.first, &options.second] {
        let Ok(recording) = AnyRecording::open(path) else {
            continue;
        };
        if *recording.ending() != Ending::Whole {
            println!("{}: {}", path.display(), recording.ending());
        }
        let lost = recording.lost_at_end();
        if lost > 0 {
            println!("{}: {lost} ticks are left out at its end", path.display());
        }
    }
    let compared = compare(options)?;
    match &compared {
        Comparison::Equal(ticks) => println!("all {ticks} ticks are equal in every bit"),
        Comparison::Shorter(ticks) => {
            println!("{ticks} ticks are equal in every bit; then one recording ends");
        }
        Comparison::Partly {
            equal,
            alone: [first, second],
        } => println!(
            "{equal} ticks are in both, and equal in every bit; {first} are only in the first recording and {second} \
             only in the second: a recorder whose disk is too slow leaves ticks out"
        ),
        Comparison::Differ(difference) => print!("{difference}"),
        Comparison::ArenasDiffer(difference) => println!("{difference}"),
        Comparison::KnockbacksDiffer { tick } => println!(
            "the knockback of the climber for the step to tick {tick} differs; what both have before is equal"
        ),
        Comparison::OrdersDiffer { tick } => {
            println!(
                "the orders of the step to tick {tick} differ; what both have before is equal"
            );
        }
        Comparison::InputsDiffer { tick, fighter } => println!(
            "the input of {fighter} for the step to tick {tick} differs; what both have before is equal"
        ),
    }
    Ok(matches!(compared, Comparison::Equal(_)))
}
