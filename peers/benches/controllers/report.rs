//! Three tables: a printed one with a row for each scene, a file with a row for each scene and controller, and a file
//! of times.

use std::error::Error;

use clamber_scenes::controllers::{Outcome, Scene};
use clamber_scenes::measure::{Bound, Cells, Table, quantile};

use crate::controller::Entry;

/// Columns of the file with a row for each scene and controller.
const COLUMNS: [&str; 8] = [
    "scenario",
    "scene",
    "controller",
    "asked, m",
    "error, m",
    "ticks not standing",
    "passes",
    "us a tick",
];

/// The results of all controllers in all scenes.
pub(crate) struct Report {
    read: Table,
    computed: Table,
    /// For each controller, the name, the number of scenes passed, and the microseconds of a tick in each scene.
    sums: Vec<(&'static str, usize, Vec<f64>)>,
}

impl Report {
    pub(crate) fn new(entries: &[Entry]) -> Self {
        let names = entries.iter().map(|entry| entry.name);
        let columns = ["scenario", "scene", "asked"];
        let columns: Vec<&str> = columns.into_iter().chain(names.clone()).collect();
        Self {
            read: Table::new(&columns),
            computed: Table::new(&COLUMNS),
            sums: names.map(|name| (name, 0, Vec::new())).collect(),
        }
    }

    /// Adds a scene, with an outcome for each controller.
    pub(crate) fn add(&mut self, scene: &Scene, outcomes: &[Outcome]) {
        let mut row = vec![
            format!("{:02}", scene.number),
            scene.name.to_owned(),
            length(scene.asked),
        ];
        row.extend(outcomes.iter().map(|outcome| cell(scene, outcome)));
        self.read.push(row);
        for ((name, passed, times), outcome) in self.sums.iter_mut().zip(outcomes) {
            *passed += usize::from(outcome.passes);
            times.push(outcome.micros);
            let passes = if outcome.passes { "yes" } else { "NO" };
            self.computed.push(vec![
                format!("{:02}", scene.number),
                scene.name.to_owned(),
                (*name).to_owned(),
                scene.asked.to_string(),
                format!("{:e}", outcome.error),
                outcome.in_air.to_string(),
                passes.to_owned(),
                format!("{:.1}", outcome.micros),
            ]);
        }
    }

    /// Prints the first table, and writes the other two to files.
    pub(crate) fn finish(mut self, brief: bool) -> Result<(), Box<dyn Error>> {
        let scenes = self.sums.first().map_or(0, |(.., times)| times.len());
        let row = |name: &str, cells: Vec<String>| {
            let head = ["", name, ""].map(str::to_owned);
            head.into_iter().chain(cells).collect()
        };
        let passed = self.sums.iter();
        let passed = passed.map(|(_, passed, _)| format!("{passed} of {scenes}"));
        self.read.push(row("scenes passed", passed.collect()));
        let times = self.sums.iter_mut();
        let times: Vec<f64> = times.map(|(.., times)| quantile(times, 0.5)).collect();
        let shown = times.iter().map(|time| format!("{time:.1} us"));
        self.read
            .push(row("a tick, median of scenes", shown.collect()));
        println!("{}", self.read);
        let mut cells = Cells::default();
        for ((name, ..), time) in self.sums.iter().zip(&times) {
            cells.value(&format!("{name}: a tick, median of scenes, us"), *time);
        }
        let mut names = self.sums.iter().map(|(name, ..)| *name);
        if let Some(jolt) = names.position(|name| name.starts_with("Jolt")) {
            let name = format!("{} / {}", self.sums[0].0, self.sums[jolt].0);
            cells.push(&name, times[0] / times[jolt], Bound::Most(1.0));
        }
        cells.finish("controllers_times", brief)?;
        Ok(self.computed.write("controllers", brief)?)
    }
}

fn cell(scene: &Scene, outcome: &Outcome) -> String {
    let error = length(outcome.error);
    if outcome.passes {
        return error;
    }
    let in_air = outcome.in_air;
    if scene.always_stands && in_air > 0 {
        return format!("NO, {error}, {in_air} ticks in the air");
    }
    format!("NO, {error}")
}

/// A length in a suitable unit, with one decimal below 10.
fn length(metres: f64) -> String {
    let (scaled, unit) = match metres {
        m if m < 1e-6 => return "< 1 um".to_owned(),
        m if m < 1e-3 => (m * 1e6, "um"),
        m if m < 1.0 => (m * 1e3, "mm"),
        m => (m, "m"),
    };
    let digits = usize::from(scaled < 10.0);
    format!("{scaled:.digits$} {unit}")
}
