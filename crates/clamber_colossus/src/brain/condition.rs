use std::fmt;

use super::BrainFile;
use crate::senses::{RegionSense, Sense, Senses};

/// A comparison of one number with a constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Condition {
    pub(crate) source: Source,
    pub(crate) comparison: Comparison,
    pub(crate) value: f64,
}

/// The source of the number that a condition compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    Sense(Sense),
    Region(RegionSense, usize),
    Mood(usize),
    Own(usize),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Comparison {
    Less,
    AtMost,
    Equal,
    NotEqual,
    AtLeast,
    More,
}

impl Comparison {
    fn find(text: &str) -> Option<Self> {
        Some(match text {
            "<" => Self::Less,
            "<=" => Self::AtMost,
            "==" => Self::Equal,
            "!=" => Self::NotEqual,
            ">=" => Self::AtLeast,
            ">" => Self::More,
            _ => return None,
        })
    }

    fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Self::Less => a < b,
            Self::AtMost => a <= b,
            Self::Equal => a == b,
            Self::NotEqual => a != b,
            Self::AtLeast => a >= b,
            Self::More => a > b,
        }
    }
}

/// Why the text of a condition cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum ConditionFault {
    /// The text is neither `name`, nor `!name`, nor `name operator number`.
    Form,
    /// An unknown sense, mood or region, and the list of known names.
    Name(String, String),
}

impl fmt::Display for ConditionFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Form => f.write_str(
                "is neither a name, `!name`, nor a name, an operator (<, <=, ==, !=, >=, >) and a number, with spaces between them",
            ),
            Self::Name(name, known) => write!(f, "names `{name}`, which is no sense, mood or region of this file; there is {known}"),
        }
    }
}

impl Condition {
    /// Reads `"riders >= 1"`, `"prey_seen"` (not 0) or `"!prey_seen"` (0).
    pub(crate) fn parse(text: &str, file: &BrainFile) -> Result<Self, ConditionFault> {
        let words: Vec<&str> = text.split_whitespace().collect();
        match words[..] {
            [name] => {
                let (name, comparison) = match name.strip_prefix('!') {
                    Some(name) => (name, Comparison::Equal),
                    None => (name, Comparison::NotEqual),
                };
                let source = Source::find(name, file)?;
                Ok(Self {
                    source,
                    comparison,
                    value: 0.0,
                })
            }
            [name, operator, number] => {
                let source = Source::find(name, file)?;
                let comparison = Comparison::find(operator).ok_or(ConditionFault::Form)?;
                let value: f64 = number.parse().map_err(|_| ConditionFault::Form)?;
                if value.is_nan() {
                    return Err(ConditionFault::Form);
                }
                Ok(Self {
                    source,
                    comparison,
                    value,
                })
            }
            _ => Err(ConditionFault::Form),
        }
    }

    /// True if the condition holds. `mood` gives the value of a mood by its index.
    pub(crate) fn holds(&self, senses: &Senses, mood: impl Fn(usize) -> f64) -> bool {
        let number = match self.source {
            Source::Sense(sense) => senses.get(sense),
            Source::Region(sense, region) => senses.in_region(sense, region),
            Source::Mood(index) => mood(index),
            Source::Own(index) => senses.own(index),
        };
        self.holds_for(number)
    }

    /// True if the condition holds when its source has this value.
    pub(crate) fn holds_for(&self, number: f64) -> bool {
        self.comparison.holds(number, self.value)
    }

    /// The interval of numbers for which the condition holds; for `!=` the whole line, which is a superset.
    pub(crate) fn interval(&self) -> [f64; 2] {
        let (low, high) = (f64::NEG_INFINITY, f64::INFINITY);
        match self.comparison {
            Comparison::Less => [low, self.value.next_down()],
            Comparison::AtMost => [low, self.value],
            Comparison::Equal => [self.value; 2],
            Comparison::NotEqual => [low, high],
            Comparison::AtLeast => [self.value, high],
            Comparison::More => [self.value.next_up(), high],
        }
    }
}

impl Source {
    fn find(name: &str, file: &BrainFile) -> Result<Self, ConditionFault> {
        let unknown = || {
            let known: Vec<String> = if name.contains('@') {
                let of_region = |region: &String| {
                    RegionSense::ALL.map(|sense| format!("{}@{region}", sense.name()))
                };
                file.regions.keys().flat_map(of_region).collect()
            } else {
                let senses = Sense::all().map(|sense| sense.name().to_owned());
                let own = file.moods.keys().chain(&file.senses).cloned();
                senses.chain(own).collect()
            };
            ConditionFault::Name(name.to_owned(), super::list(known.iter()))
        };
        if let Some((sense, region)) = name.split_once('@') {
            let sense = RegionSense::find(sense).ok_or_else(unknown)?;
            let region = file.regions.keys().position(|known| known == region);
            return Ok(Self::Region(sense, region.ok_or_else(unknown)?));
        }
        if let Some(sense) = Sense::find(name) {
            return Ok(Self::Sense(sense));
        }
        if let Some(mood) = file.moods.keys().position(|known| known == name) {
            return Ok(Self::Mood(mood));
        }
        let own = file.senses.iter().position(|known| known == name);
        own.map(Self::Own).ok_or_else(unknown)
    }

    /// The interval of numbers that the source can have.
    pub(crate) fn range(self) -> [f64; 2] {
        match self {
            Self::Mood(_) | Self::Sense(Sense::Health | Sense::Done | Sense::PreySeen) => {
                [0.0, 1.0]
            }
            Self::Sense(Sense::PreyBearingDeg | Sense::NoiseBearingDeg) => [-180.0, 180.0],
            Self::Sense(Sense::RiderHeight) | Self::Own(_) => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Sense(_) | Self::Region(..) => [0.0, f64::INFINITY],
        }
    }
}
