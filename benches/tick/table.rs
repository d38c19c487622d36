//! The table of ratios, and what they are held against.

use std::error::Error;
use std::path::{Path, PathBuf};

use clamber_scenes::measure::Table;

use crate::timing::Lap;

/// What a cell is held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Bound {
    Least(f64),
    Most(f64),
    None,
}

impl Bound {
    pub(crate) const NONE: Self = Self::None;

    pub(crate) fn at_least(value: f64) -> Self {
        Self::Least(value)
    }

    pub(crate) fn at_most(value: f64) -> Self {
        Self::Most(value)
    }

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

/// Everything measured, a row each.
pub(crate) struct Cells(Table);

impl Default for Cells {
    fn default() -> Self {
        Self(Table::new(&["name", "value", "bound", "holds"]))
    }
}

impl Cells {
    fn push(&mut self, name: &str, value: f64, bound: Bound) {
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

    /// Medians of a race.
    pub(crate) fn race(&mut self, name: &str, laps: &[Lap]) {
        for (lap, who) in laps.iter().zip(["lazy", "eager", "parry"]) {
            let [low, high] = lap.quartiles_us;
            println!(
                "{name}: {who}: quartiles {low:.1} to {high:.1} us, {} hits",
                lap.hits
            );
            self.push(&format!("{name}: {who}, us"), lap.median_us, Bound::None);
        }
    }

    pub(crate) fn ratio(&mut self, name: &str, value: f64, bound: Bound) {
        self.push(name, value, bound);
    }

    pub(crate) fn microseconds(&mut self, name: &str, value: f64, bound: Bound) {
        self.push(name, value, bound);
    }

    pub(crate) fn value(&mut self, name: &str, value: f64) {
        self.push(name, value, Bound::None);
    }

    /// Prints and writes all rows.
    pub(crate) fn finish(self, brief: bool) -> Result<(), Box<dyn Error>> {
        println!("\n{}", self.0);
        let name = if brief { "tick_brief.csv" } else { "tick.csv" };
        let path = measure_folder().join(name);
        self.0.write_csv(&path)?;
        println!("written to {}", path.display());
        Ok(())
    }
}

/// `measure` in cargo's target folder.
fn measure_folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("target"),
        PathBuf::from,
    );
    target.join("measure")
}
