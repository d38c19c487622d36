//! The report of a soak, as Markdown.

use std::collections::BTreeMap;
use std::fmt;
use std::io;
use std::path::Path;

use clamber_scenes::measure::Table;
use clamber_verify::stress::{Class, DOUBTFUL, LIMIT, Summary, Times};

use crate::findings::Finding;
use crate::task::Task;

/// The smallest number of queries of a class that is judged. With fewer queries the slowest thousandth is not defined.
const LEAST: usize = 1_000;

/// Number of the worst classes in the report. If more classes miss the limit, all of those are listed.
const LISTED: usize = 20;

/// Number of characters to which a finding's message is cut. Some messages hold whole answers.
const LETTERS: usize = 1_000;

/// The results of a soak.
#[derive(Default)]
pub(crate) struct Report {
    /// Numbers of cases, checks and findings by kind of task.
    kinds: BTreeMap<&'static str, [usize; 3]>,
    findings: Vec<Finding>,
    pub(crate) times: Times,
    pub(crate) minutes: f64,
    seed: u64,
}

impl Report {
    /// An empty report.
    pub(crate) fn new(seed: u64) -> Self {
        Self {
            seed,
            ..Self::default()
        }
    }

    /// Adds the result of a task: its number of checks, or the message of its finding.
    pub(crate) fn note(&mut self, task: Task, came: Result<usize, String>) {
        let [cases, checks, findings] = self.kinds.entry(task.kind()).or_default();
        *cases += 1;
        match came {
            Ok(done) => *checks += done,
            Err(message) => {
                *findings += 1;
                let message = message.chars().take(LETTERS).collect();
                self.findings.push(Finding { task, message });
            }
        }
    }

    /// Number of findings.
    pub(crate) fn findings(&self) -> usize {
        self.findings.len()
    }

    /// The judged classes, by descending ratio of the slowest thousandth to the median.
    fn judged(&self) -> Vec<(Class, Summary)> {
        let all = self.times.summaries();
        let mut judged: Vec<_> = all.filter(|(_, s)| s.count >= LEAST).collect();
        judged.sort_by(|(_, a), (_, b)| b.ratio().total_cmp(&a.ratio()));
        judged
    }

    /// True if there is no finding, and every judged class keeps the limit.
    pub(crate) fn holds(&self) -> bool {
        let slow = self
            .judged()
            .first()
            .is_some_and(|(_, s)| s.ratio() > LIMIT);
        self.findings.is_empty() && !slow
    }

    /// Writes `report.md`, and all classes to `times.csv`.
    pub(crate) fn write(&self, folder: &Path) -> io::Result<()> {
        std::fs::create_dir_all(folder)?;
        std::fs::write(folder.join("report.md"), self.to_string())?;
        let mut all = classes();
        for (class, summary) in self.times.summaries() {
            all.push(row(&class, &summary));
        }
        all.write_csv(&folder.join("times.csv"))
    }
}

fn classes() -> Table {
    Table::new(&[
        "mesh",
        "triangles",
        "query",
        "work, at most",
        "queries",
        "p50, us",
        "p99.9, us",
        "ratio",
        "at most 20",
        "longest in",
    ])
}

fn verdict(summary: &Summary) -> &'static str {
    match summary.count {
        ..LEAST => "too few",
        _ if summary.ratio() > LIMIT => "MISSED",
        _ => "ok",
    }
}

fn row(class: &Class, summary: &Summary) -> Vec<String> {
    vec![
        class.mesh.to_string(),
        class.triangles.to_string(),
        class.query.to_owned(),
        class.work.to_string(),
        summary.count.to_string(),
        format!("{:.2}", summary.median / 1e3),
        format!("{:.2}", summary.p999 / 1e3),
        format!("{:.1}", summary.ratio()),
        verdict(summary).to_owned(),
        summary.longest.clone(),
    ]
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "# Soak: {:.1} minutes, seed {}\n",
            self.minutes, self.seed
        )?;
        let mut done = Table::new(&["task", "cases", "checks", "findings"]);
        for (kind, numbers) in &self.kinds {
            let numbers = numbers.map(|number| number.to_string());
            done.push([vec![(*kind).to_owned()], numbers.to_vec()].concat());
        }
        writeln!(f, "{done}")?;
        writeln!(f, "## Findings: {}\n", self.findings.len())?;
        for Finding { task, message } in &self.findings {
            writeln!(f, "- `cargo xtask soak --case {task}`\n")?;
            for line in message.lines() {
                writeln!(f, "      {line}")?;
            }
            writeln!(f)?;
        }
        self.write_times(f)
    }
}

/// The classes of one query.
#[derive(Default)]
struct OfQuery {
    /// The judged classes, the worst first.
    judged: Vec<(Class, Summary)>,
    /// Mixed classes merge the classes that differ only in work. Their number, and the number of those that miss the
    /// limit.
    mixed: [usize; 2],
}

impl Report {
    fn by_query(&self) -> BTreeMap<&'static str, OfQuery> {
        let mut all: BTreeMap<&str, OfQuery> = BTreeMap::new();
        for (class, summary) in self.judged() {
            let of = all.entry(class.query).or_default();
            of.judged.push((class, summary));
        }
        for (class, summary) in self.times.whatever_work() {
            let [count, slow] = &mut all.entry(class.query).or_default().mixed;
            *count += 1;
            *slow += usize::from(summary.ratio() > LIMIT);
        }
        all
    }

    fn write_times(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let judged = self.judged();
        let few = self.times.summaries().count() - judged.len();
        let slow = judged.iter().filter(|(_, s)| s.ratio() > LIMIT).count();
        writeln!(
            f,
            "## Times\n\nA class is a query with one kind of aim, at one family of meshes of one size, in any pose,\n\
             with the same amount of work to a factor of four: nodes, clusters and triangles. The slowest\n\
             thousandth of a class may take {LIMIT} times its median, or {LIMIT} us if the median is below 1 us.\n\
             {slow} of {} classes miss this limit. {few} classes have fewer than {LEAST} queries and are not\n\
             judged. Each query ran once before it was timed, so the time does not include skinning. The first\n\
             queries of each class, and those that took more than {DOUBTFUL} times the median, were timed three\n\
             times more at once, and the shortest time counts, since other processes sometimes take the core.\n\n\
             A mixed class merges the classes that differ only in work. Their work differs by the amount of\n\
             skin at the query: no triangle, or thousands of a limb that has collapsed to a point. Mixed classes\n\
             are not judged.\n",
            judged.len()
        )?;
        let mut queries = Table::new(&[
            "query",
            "classes",
            "queries",
            "p50, us",
            "worst ratio",
            "at most 20",
            "worst class",
            "mixed classes, over 20",
        ]);
        for (query, OfQuery { judged, mixed }) in self.by_query() {
            let Some((class, worst)) = judged.first() else {
                continue;
            };
            let count: usize = judged.iter().map(|(_, s)| s.count).sum();
            let mut medians: Vec<f64> = judged.iter().map(|(_, s)| s.median / 1e3).collect();
            medians.sort_by(f64::total_cmp);
            let [mixed, over] = mixed;
            queries.push(vec![
                query.to_owned(),
                judged.len().to_string(),
                count.to_string(),
                format!("{:.2} to {:.2}", medians[0], medians[medians.len() - 1]),
                format!("{:.1}", worst.ratio()),
                verdict(worst).to_owned(),
                format!("{}, {}, work {}", class.mesh, class.triangles, class.work),
                format!("{mixed}, {over}"),
            ]);
        }
        writeln!(
            f,
            "{queries}\nThe worst classes. `times.csv` has all of them.\n"
        )?;
        let mut worst = classes();
        for (class, summary) in judged.iter().take(LISTED.max(slow)) {
            worst.push(row(class, summary));
        }
        writeln!(f, "{worst}")
    }
}
