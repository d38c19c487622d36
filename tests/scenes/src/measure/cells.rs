use std::error::Error;
use std::path::{Path, PathBuf};

use super::Table;

/// A bench fails if a number misses its bound by more than this factor, unless it runs briefly. Noise does not reach it,
/// but what costs ten times as much as it did does.
const FAR: f64 = 4.0;

/// The bound that a measured number should keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// The number should be at least this.
    Least(f64),
    /// The number should be at most this.
    Most(f64),
    /// No bound: the number is only reported.
    None,
}

impl Bound {
    fn holds(self, value: f64) -> &'static str {
        match self {
            Self::Least(bound) if value >= bound => "yes",
            Self::Most(bound) if value <= bound => "yes",
            Self::None => "",
            _ => "NO",
        }
    }

    /// True if a number misses the bound by more than [`FAR`].
    fn is_far_missed(self, value: f64) -> bool {
        match self {
            Self::Least(bound) => value * FAR < bound,
            Self::Most(bound) => value > bound * FAR,
            Self::None => false,
        }
    }

    fn text(self) -> String {
        match self {
            Self::Least(bound) => format!(">= {bound}"),
            Self::Most(bound) => format!("<= {bound}"),
            Self::None => String::new(),
        }
    }
}

/// The results of a bench, one row per number: its name, its value, its bound, and whether the bound holds.
#[derive(Clone, Debug)]
pub struct Cells {
    table: Table,
    /// Names of the rows whose bound is missed by far.
    far_missed: Vec<String>,
}

impl Default for Cells {
    /// No rows.
    fn default() -> Self {
        Self {
            table: Table::new(&["name", "value", "bound", "holds"]),
            far_missed: Vec::new(),
        }
    }
}

impl Cells {
    /// Appends a row and prints it.
    pub fn push(&mut self, name: &str, value: f64, bound: Bound) {
        let digits = if value.abs() < 10.0 { 3 } else { 1 };
        let row = [
            name.to_owned(),
            format!("{value:.digits$}"),
            bound.text(),
            bound.holds(value).to_owned(),
        ];
        println!("{}: {} {} {}", row[0], row[1], row[2], row[3]);
        if bound.is_far_missed(value) {
            self.far_missed.push(name.to_owned());
        }
        self.table.push(row.to_vec());
    }

    /// Appends a row without a bound and prints it.
    pub fn value(&mut self, name: &str, value: f64) {
        self.push(name, value, Bound::None);
    }

    /// Prints all rows, and writes them to `BENCH.csv` in [`measure_folder`]; a brief run writes
    /// `BENCH_brief.csv`. A bound that is missed by less than four times, or in a brief run,
    /// is no error.
    ///
    /// # Errors
    /// If a number misses its bound by more than that, or the file cannot be written.
    pub fn finish(self, bench: &str, brief: bool) -> Result<(), Box<dyn Error>> {
        println!("\n{}", self.table);
        let suffix = if brief { "_brief" } else { "" };
        let path = measure_folder().join(format!("{bench}{suffix}.csv"));
        self.table.write_csv(&path)?;
        println!("written to {}", path.display());
        if brief || self.far_missed.is_empty() {
            return Ok(());
        }
        let names = self.far_missed.join("; ");
        Err(format!("bounds are missed by more than {FAR} times: {names}").into())
    }
}

/// The folder for the results of benches: `measure` in cargo's target folder.
pub fn measure_folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2);
    let target = target.or_else(|| Some(workspace?.join("target")));
    target.unwrap_or_default().join("measure")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_missed_by_far_on_their_side() {
        let cases = [
            (Bound::Most(4.0), [3.0, 5.0, 15.9], [16.1, f64::INFINITY]),
            (Bound::Least(4.0), [5.0, 3.0, 1.1], [0.9, 0.0]),
        ];
        for (bound, near, far) in cases {
            assert!(near.iter().all(|value| !bound.is_far_missed(*value)));
            assert!(far.iter().all(|value| bound.is_far_missed(*value)));
        }
        assert!(!Bound::None.is_far_missed(f64::INFINITY));
    }
}
