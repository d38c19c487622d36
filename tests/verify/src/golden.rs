//! Golden runs: a hash of every bit of a run, and a file with a checksum of every field in every tick. The hash shows
//! that a run has changed. The file shows the first tick and field that differ.
//!
//! ```
//! use clamber_verify::golden::GoldenRun;
//!
//! #[derive(Debug)]
//! struct Body {
//!     height: f64,
//!     speed: f64,
//! }
//!
//! let play = |gravity: f64| {
//!     move |run: &mut GoldenRun| {
//!         let mut body = Body { height: 10.0, speed: 0.0 };
//!         for tick in 0..5 {
//!             if tick == 3 {
//!                 body.speed += gravity;
//!             }
//!             body.height += body.speed;
//!             run.field("body", body.height.to_bits() ^ body.speed.to_bits().rotate_left(1));
//!             run.fields("its ", &body);
//!             run.end_tick();
//!         }
//!     }
//! };
//! let stored = GoldenRun::detailed(play(-9.81));
//! let changed = GoldenRun::detailed(play(-9.80));
//! assert!(changed.hash() != stored.hash());
//! let difference = changed.difference(&stored.to_bytes()).unwrap();
//! assert_eq!(difference, "the first difference is at tick 3, in body, its height, its speed");
//! ```

use core::fmt::Debug;
use std::path::Path;

use clamber_surface::Fingerprint;

/// A run that is hashed as it goes.
#[derive(Clone, Debug, Default)]
pub struct GoldenRun {
    hash: Fingerprint,
    /// True if checksums are kept as well.
    is_detailed: bool,
    /// Names of the fields, which are the same in every tick.
    names: Vec<String>,
    /// Checksums of all fields, tick after tick.
    checksums: Vec<u16>,
    ticks: usize,
}

/// Plays a run and compares its hash with the stored one. If they differ, plays the run again in detail, to find its
/// first difference from the stored file. With the environment variable `CLAMBER_BLESS`, first stores the file.
///
/// # Errors
/// A message if the hashes differ, with the first difference, or, if the file was just stored, with the new hash and
/// all fields that have changed; if the file belongs to another hash; or if it cannot be read or written.
pub fn hold(
    file: impl AsRef<Path>,
    hash: u64,
    play: impl Fn(&mut GoldenRun),
) -> Result<(), String> {
    let file = file.as_ref();
    let named = |error: std::io::Error| format!("{}: {error}", file.display());
    if std::env::var_os("CLAMBER_BLESS").is_some() {
        let run = GoldenRun::detailed(&play);
        let changes = run.changes(&std::fs::read(file).unwrap_or_default());
        std::fs::write(file, run.to_bytes()).map_err(named)?;
        if run.hash() != hash {
            return Err(format!(
                "{} is stored; {changes}. If this is intended, copy the hash {:#018x} into the test",
                file.display(),
                run.hash(),
            ));
        }
    }
    let stored = std::fs::read(file).map_err(named)?;
    let mut run = GoldenRun::default();
    play(&mut run);
    let how = "If this is intended, store the hash in the test, and the file by CLAMBER_BLESS=1";
    if run.hash() != hash {
        let difference = GoldenRun::detailed(&play).difference(&stored);
        return Err(format!(
            "the hash is {:#018x}, and {hash:#018x} was expected: {}. {how}",
            run.hash(),
            difference.unwrap_or("the stored file is equal".into()),
        ));
    }
    if !stored.starts_with(head(hash).as_bytes()) {
        return Err(format!("{} belongs to another hash. {how}", file.display()));
    }
    Ok(())
}

/// The first line of a file.
fn head(hash: u64) -> String {
    format!("{hash:#018x}\n")
}

impl GoldenRun {
    /// A run with a checksum of every field.
    pub fn detailed(play: impl FnOnce(&mut Self)) -> Self {
        let mut run = Self {
            is_detailed: true,
            ..Self::default()
        };
        play(&mut run);
        run
    }

    /// Adds the bits of a number, or a hash of bits, to this tick and to the hash of the run.
    pub fn field(&mut self, name: &str, bits: u64) {
        self.hash.word(bits);
        if self.is_detailed {
            let mut hash = Fingerprint::default();
            hash.word(bits);
            self.push(name, hash);
        }
    }

    /// Adds a checksum of each field of a struct to this tick, under the field's name with the prefix `of`. These
    /// checksums show where runs differ, and do not change the hash of the run. They are computed from the text of
    /// [`Debug`], which differs for any two numbers, but is the same for every NaN.
    pub fn fields(&mut self, of: &str, value: &impl Debug) {
        if !self.is_detailed {
            return;
        }
        let text = format!("{value:#?}");
        let mut current: Option<(&str, Fingerprint)> = None;
        for line in text.lines() {
            // The struct's own fields are indented once; their contents are indented deeper.
            let own = line.strip_prefix("    ");
            let own = own.filter(|rest| !rest.starts_with([' ', '}', ')', ']']));
            if let Some((name, _)) = own.and_then(|rest| rest.split_once(':')) {
                if let Some((name, hash)) = current.take() {
                    self.push(&format!("{of}{name}"), hash);
                }
                current = Some((name, Fingerprint::default()));
            }
            if let Some((_, hash)) = &mut current {
                hash.text(line);
            }
        }
        if let Some((name, hash)) = current {
            self.push(&format!("{of}{name}"), hash);
        }
    }

    fn push(&mut self, name: &str, hash: Fingerprint) {
        if self.ticks == 0 {
            self.names.push(name.to_owned());
        }
        let folded = hash.value() ^ hash.value() >> 32;
        self.checksums.push((folded ^ folded >> 16) as u16);
    }

    /// Ends a tick. Each tick must have the same fields in the same order.
    pub fn end_tick(&mut self) {
        self.ticks += 1;
    }

    /// The hash of all fields so far.
    pub fn hash(&self) -> u64 {
        self.hash.value()
    }

    /// The content of the file of a detailed run: a line with the hash, a line with each field's name, an empty line,
    /// and the checksums, 16 bits each, little endian.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = head(self.hash()).into_bytes();
        bytes.extend(self.table());
        bytes
    }

    /// Names and checksums.
    fn table(&self) -> Vec<u8> {
        let mut bytes = self.names.join("\n").into_bytes();
        bytes.extend(b"\n\n");
        let checksums = self.checksums.iter().map(|sum| sum.to_le_bytes());
        bytes.extend(checksums.flatten());
        bytes
    }

    /// A message about the first difference between this detailed run and a stored one; `None` if all checksums are
    /// equal. A changed field has the same checksum in one of 65,536 ticks on average; its change is then found a tick
    /// late.
    pub fn difference(&self, stored: &[u8]) -> Option<String> {
        let ours = self.table();
        let stored = stored.get(head(0).len()..).unwrap_or_default();
        if ours == stored {
            return None;
        }
        let Some(theirs) = self.checksums_in(stored) else {
            return Some("the stored run has other fields".into());
        };
        let wanted = |index: usize| theirs.get(index).map(|sum| u16::from_le_bytes(*sum));
        let fields = self.names.len().max(1);
        for (tick, row) in self.checksums.chunks(fields).enumerate() {
            let differ = |field: &usize| Some(row[*field]) != wanted(tick * fields + field);
            let differing = (0..row.len()).filter(differ);
            let names: Vec<&str> = differing.map(|field| self.names[field].as_str()).collect();
            if !names.is_empty() {
                let names = names.join(", ");
                return Some(format!(
                    "the first difference is at tick {tick}, in {names}"
                ));
            }
        }
        Some(format!("the stored run goes on after tick {}", self.ticks))
    }

    /// The checksums of a stored file without its first line; `None` if it has other fields than this run.
    fn checksums_in<'a>(&self, stored: &'a [u8]) -> Option<&'a [[u8; 2]]> {
        let ours = self.table();
        let (names, _) = ours.split_at(ours.len() - 2 * self.checksums.len());
        Some(stored.strip_prefix(names)?.as_chunks::<2>().0)
    }

    /// A message about all fields in which this detailed run differs from a stored one, each with its number of ticks.
    pub fn changes(&self, stored: &[u8]) -> String {
        let stored = stored.get(head(0).len()..).unwrap_or_default();
        let Some(theirs) = self.checksums_in(stored) else {
            return "its fields are others now".into();
        };
        let fields = self.names.len().max(1);
        if theirs.len() != self.checksums.len() {
            let before = theirs.len() / fields;
            return format!("it had {before} ticks, and has {} now", self.ticks);
        }
        let mut ticks = vec![0; fields];
        for (index, (ours, theirs)) in self.checksums.iter().zip(theirs).enumerate() {
            ticks[index % fields] += usize::from(ours.to_le_bytes() != *theirs);
        }
        let changed = self.names.iter().zip(ticks).filter(|(_, ticks)| *ticks > 0);
        let changed: Vec<String> = changed
            .map(|(name, ticks)| format!("{name} ({ticks})"))
            .collect();
        format!(
            "{} of {fields} fields changed in {} ticks: {}",
            changed.len(),
            self.ticks,
            changed.join(", ")
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug)]
    #[expect(dead_code, reason = "only printed")]
    struct Nested {
        place: [f64; 2],
        inner: Option<Inner>,
        count: u32,
    }

    #[derive(Debug)]
    #[expect(dead_code, reason = "only printed")]
    struct Inner {
        weight: f32,
    }

    fn run(value: &Nested) -> GoldenRun {
        GoldenRun::detailed(|run| {
            run.fields("body ", value);
            run.field("rest", value.count.into());
            run.end_tick();
        })
    }

    #[test]
    fn a_change_deep_in_a_field_is_named_by_the_field() {
        let value = |weight, place| Nested {
            place,
            inner: Some(Inner { weight }),
            count: 3,
        };
        let first = run(&value(1.5, [0.0, 1.0]));
        assert_eq!(
            first.names,
            ["body place", "body inner", "body count", "rest"]
        );
        let stored = first.to_bytes();
        assert_eq!(run(&value(1.5, [0.0, 1.0])).difference(&stored), None);
        let other = run(&value(1.5000001, [0.0, 1.0]));
        let told = other.difference(&stored).unwrap();
        assert_eq!(told, "the first difference is at tick 0, in body inner");
        // Only numbers that `field` adds change the hash.
        assert_eq!(other.hash(), first.hash());
        let other = run(&value(1.5, [-0.0, 1.0]));
        let told = other.difference(&stored).unwrap();
        assert_eq!(told, "the first difference is at tick 0, in body place");
        let told = other.changes(&stored);
        assert_eq!(told, "1 of 4 fields changed in 1 ticks: body place (1)");
    }

    #[test]
    fn other_lengths_and_fields_are_told() {
        let count_to = |last: u64| {
            GoldenRun::detailed(|run| {
                for tick in 0..last {
                    run.field("a", tick);
                    run.end_tick();
                }
            })
        };
        let [first, longer] = [count_to(2), count_to(3)];
        assert!(first.hash() != longer.hash());
        let told = first.difference(&longer.to_bytes()).unwrap();
        assert_eq!(told, "the stored run goes on after tick 2");
        let told = longer.difference(&first.to_bytes()).unwrap();
        assert_eq!(told, "the first difference is at tick 2, in a");
        let told = run(&Nested {
            place: [0.0; 2],
            inner: None,
            count: 0,
        });
        assert_eq!(
            told.difference(&first.to_bytes()).unwrap(),
            "the stored run has other fields"
        );
        assert!(first.difference(b"").is_some());
    }
}
