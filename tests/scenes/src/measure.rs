//! Tools that benches and examples share: tables, bounds, quantiles, times and exit codes.

use std::error::Error;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// True if a bench should run briefly, by criterion's rule: always, unless `--bench` is passed, as `cargo bench`
/// does, and `--test` is not.
pub fn is_brief() -> bool {
    let passed = |flag: &str| std::env::args().any(|argument| argument == flag);
    !passed("--bench") || passed("--test")
}

/// The larger of two numbers; NaN if one of them is NaN, which `f64::max` ignores.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// The exit code of a bench or an example. Prints the error of one that failed.
pub fn exit_code(result: Result<(), Box<dyn Error>>) -> ExitCode {
    let Err(error) = result else {
        return ExitCode::SUCCESS;
    };
    eprintln!("{error}");
    ExitCode::FAILURE
}

/// The exit code of a program that checks its results: 0 if all checks hold, 1 if one failed, 2 after an error. Prints
/// an error or that a check failed.
pub fn checked(name: &str, result: Result<bool, Box<dyn Error>>) -> ExitCode {
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => {
            eprintln!("{name}: a check failed");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{name}: {error}");
            ExitCode::from(2)
        }
    }
}

/// The smallest of `values` that at least the share `part` (0 to 1) of them does not exceed; NaN without
/// values. Sorts `values`.
pub fn quantile(values: &mut [f64], part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let index = (values.len() as f64 * part).ceil() as usize;
    let last = values.len().checked_sub(1);
    last.map_or(f64::NAN, |last| values[index.saturating_sub(1).min(last)])
}

/// The median time of `run`, microseconds, over as many runs as fit into `budget`, at least three. One run
/// before them is not counted.
pub fn median_us(budget: Duration, mut run: impl FnMut()) -> f64 {
    run();
    let begin = Instant::now();
    let mut times = Vec::new();
    while times.len() < 3 || begin.elapsed() < budget {
        let start = Instant::now();
        run();
        times.push(start.elapsed().as_secs_f64() * 1e6);
    }
    quantile(&mut times, 0.5)
}

/// The mean time of `count` runs, microseconds. `run` gets the number of runs before it.
///
/// # Errors
/// The first error of a run.
pub fn mean_us(
    count: u32,
    mut run: impl FnMut(u32) -> Result<(), Box<dyn Error>>,
) -> Result<f64, Box<dyn Error>> {
    let start = Instant::now();
    for index in 0..count {
        run(index)?;
    }
    Ok(start.elapsed().as_secs_f64() * 1e6 / f64::from(count))
}

/// A bench fails if a number misses its bound by more than this factor, unless it runs briefly. Noise does not reach
/// it, but what costs ten times as much as it did does.
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
    /// The bound as text, whether a number keeps it, and true if the number misses it by more than [`FAR`].
    fn judge(self, value: f64) -> (String, &'static str, bool) {
        let (sign, bound, holds, is_far_missed) = match self {
            Self::Least(bound) => (">=", bound, value >= bound, value * FAR < bound),
            Self::Most(bound) => ("<=", bound, value <= bound, value > bound * FAR),
            Self::None => return (String::new(), "", false),
        };
        let verdict = if holds { "yes" } else { "NO" };
        (format!("{sign} {bound}"), verdict, is_far_missed)
    }
}

/// The results of a bench, one row per number: its name, its value, its bound, and whether the bound holds.
#[derive(Clone, Debug, Default)]
pub struct Cells {
    rows: Vec<Vec<String>>,
    /// Names of the rows whose bound is missed by far.
    far_missed: Vec<String>,
}

impl Cells {
    /// Appends a row and prints it.
    pub fn push(&mut self, name: &str, value: f64, bound: Bound) {
        let digits = if value.abs() < 10.0 { 3 } else { 1 };
        let number = format!("{value:.digits$}");
        let (bound, holds, is_far_missed) = bound.judge(value);
        println!("{name}: {number} {bound} {holds}");
        if is_far_missed {
            self.far_missed.push(name.to_owned());
        }
        let row = vec![name.to_owned(), number, bound, holds.to_owned()];
        self.rows.push(row);
    }

    /// Appends a row without a bound and prints it.
    pub fn value(&mut self, name: &str, value: f64) {
        self.push(name, value, Bound::None);
    }

    /// Rows about one thing: each is named `thing: what`.
    pub fn of(&mut self, thing: impl Into<String>) -> Rows<'_> {
        Rows {
            cells: self,
            thing: thing.into(),
        }
    }

    /// Prints all rows, and writes them as [`Table::write`] does. A bound that is missed by less than four times, or in
    /// a brief run, is no error.
    ///
    /// # Errors
    /// If a number misses its bound by more than that, or the file cannot be written.
    pub fn finish(self, bench: &str, brief: bool) -> Result<(), Box<dyn Error>> {
        let table = Table {
            columns: vec!["name", "value", "bound", "holds"],
            rows: self.rows,
        };
        println!("\n{table}");
        table.write(bench, brief)?;
        if brief || self.far_missed.is_empty() {
            return Ok(());
        }
        let names = self.far_missed.join("; ");
        Err(format!("bounds are missed by more than {FAR} times: {names}").into())
    }
}

/// Appends rows that begin with the same name: see [`Cells::of`].
#[derive(Debug)]
pub struct Rows<'a> {
    cells: &'a mut Cells,
    thing: String,
}

impl Rows<'_> {
    /// Appends a row and prints it.
    pub fn push(&mut self, what: &str, value: f64, bound: Bound) {
        let name = format!("{}: {what}", self.thing);
        self.cells.push(&name, value, bound);
    }

    /// Appends a row without a bound and prints it.
    pub fn value(&mut self, what: &str, value: f64) {
        self.push(what, value, Bound::None);
    }
}

/// The file of a bench's results, in the folder `measure` of cargo's target folder. The name of one of a brief run ends
/// in `_brief`.
pub fn measure_file(name: &str, brief: bool, extension: &str) -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2);
    let target = target.or_else(|| Some(workspace?.join("target")));
    let suffix = if brief { "_brief" } else { "" };
    let name = format!("measure/{name}{suffix}.{extension}");
    target.unwrap_or_default().join(name)
}

/// Rows of text under named columns, to be printed as Markdown and written as CSV.
#[derive(Clone, Debug)]
pub struct Table {
    columns: Vec<&'static str>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows.
    pub fn new(columns: &[&'static str]) -> Self {
        Self {
            columns: columns.to_vec(),
            rows: Vec::new(),
        }
    }

    /// Appends a row.
    ///
    /// # Panics
    /// If the number of cells is not the number of columns.
    pub fn push(&mut self, row: Vec<String>) {
        assert_eq!(row.len(), self.columns.len(), "{row:?}");
        self.rows.push(row);
    }

    /// Writes the table as CSV to a [`measure_file`], and prints the file's path.
    pub fn write(&self, name: &str, brief: bool) -> io::Result<()> {
        let path = measure_file(name, brief, "csv");
        self.write_csv(&path)?;
        println!("written to {}", path.display());
        Ok(())
    }

    /// Writes the table as CSV, and creates the folder if needed.
    pub fn write_csv(&self, path: &Path) -> io::Result<()> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        // Cells are quoted if needed (RFC 4180).
        let field = |cell: &String| match cell.contains([',', '"', '\n', '\r']) {
            true => format!("\"{}\"", cell.replace('"', "\"\"")),
            false => cell.clone(),
        };
        let header: Vec<String> = self.columns.iter().map(|c| (*c).to_owned()).collect();
        let mut text = String::new();
        for row in std::iter::once(&header).chain(&self.rows) {
            let cells: Vec<String> = row.iter().map(field).collect();
            text += &(cells.join(",") + "\n");
        }
        std::fs::write(path, text)
    }
}

impl fmt::Display for Table {
    /// Writes the table as Markdown.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "| {} |", self.columns.join(" | "))?;
        writeln!(f, "|{}", "---|".repeat(self.columns.len()))?;
        let mut rows = self.rows.iter();
        rows.try_for_each(|row| writeln!(f, "| {} |", row.join(" | ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_larger_of_nan_and_a_number_is_nan() {
        assert_eq!([larger(1.0, 2.0), larger(2.0, 1.0)], [2.0; 2]);
        assert!(larger(f64::NAN, 1.0).is_nan() && larger(1.0, f64::NAN).is_nan());
    }

    #[test]
    fn quantiles_of_few_values() {
        let mut values = [4.0, 1.0, 3.0, 2.0];
        assert_eq!(quantile(&mut values, 0.5), 2.0);
        assert_eq!(quantile(&mut values, 0.95), 4.0);
        assert_eq!(quantile(&mut values, 0.0), 1.0);
        assert!(quantile(&mut [], 0.5).is_nan());
    }

    #[test]
    fn bounds_are_missed_by_far_on_their_side() {
        let cases = [
            (Bound::Most(4.0), [3.0, 5.0, 15.9], [16.1, f64::INFINITY]),
            (Bound::Least(4.0), [5.0, 3.0, 1.1], [0.9, 0.0]),
        ];
        for (bound, near, far) in cases {
            assert!(near.iter().all(|value| !bound.judge(*value).2));
            assert!(far.iter().all(|value| bound.judge(*value).2));
        }
        assert!(!Bound::None.judge(f64::INFINITY).2);
    }

    #[test]
    fn prints_markdown_and_writes_csv() {
        let mut table = Table::new(&["name", "us"]);
        table.push(vec!["a, \"b\"".into(), "1.5".into()]);
        assert_eq!(
            table.to_string(),
            "| name | us |\n|---|---|\n| a, \"b\" | 1.5 |\n"
        );
        let folder = std::env::temp_dir().join(format!("clamber-table-{}", std::process::id()));
        let path = folder.join("table.csv");
        table.write_csv(&path).unwrap();
        let written = std::fs::read_to_string(&path).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(written, "name,us\n\"a, \"\"b\"\"\",1.5\n");
    }
}
