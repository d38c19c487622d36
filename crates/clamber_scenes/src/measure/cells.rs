use std::error::Error;
use std::path::{Path, PathBuf};

use super::Table;

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
pub struct Cells(Table);

impl Default for Cells {
    /// No rows.
    fn default() -> Self {
        Self(Table::new(&["name", "value", "bound", "holds"]))
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
        self.0.push(row.to_vec());
    }

    /// Appends a row without a bound and prints it.
    pub fn value(&mut self, name: &str, value: f64) {
        self.push(name, value, Bound::None);
    }

    /// Prints all rows, and writes them to `BENCH.csv` in [`measure_folder`]; a brief run writes
    /// `BENCH_brief.csv`. A bound that does not hold is no error.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn finish(self, bench: &str, brief: bool) -> Result<(), Box<dyn Error>> {
        println!("\n{}", self.0);
        let brief = if brief { "_brief" } else { "" };
        let path = measure_folder().join(format!("{bench}{brief}.csv"));
        self.0.write_csv(&path)?;
        println!("written to {}", path.display());
        Ok(())
    }
}

/// The folder for the results of benches: `measure` in cargo's target folder.
pub fn measure_folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2);
    let target = target.or_else(|| Some(workspace?.join("target")));
    target.unwrap_or_default().join("measure")
}
