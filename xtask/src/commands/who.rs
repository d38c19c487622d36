//! Finds the steps that run a command.

use cargo_metadata::Metadata;
use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};
use clap::Parser;

use super::asked::Asked;
use super::{cli, path};
use crate::parts::{Kind, Part};
use crate::plan::{Planned, plan};
use crate::test_run::Ignored;
use crate::workspaces::{self, Workspace};
use crate::{Arguments, Task, ci, nightly};

/// Name of the step that builds the documentation.
const DOCUMENTATION: &str = "documentation";

/// Folders at the root of the repository. A word that begins with one of them is a path that must exist.
const FOLDERS: [&str; 7] = [
    ".ci/",
    "assets/",
    "benches/",
    "crates/",
    "examples/",
    "peers/",
    "tests/",
];

/// The variable that may precede a command without changing it.
const DATA: &str = "CLAMBER_TEST_DATA=";

/// All workspaces, the runs of all steps, and the tests that start `clamber`.
pub(super) struct Who {
    root: Utf8PathBuf,
    workspaces: Vec<Workspace>,
    plan: Vec<Planned>,
    /// The tests that start the program `clamber`, with their texts.
    cli_tests: Vec<(Part, String)>,
}

impl Who {
    pub(super) fn new(main: &Metadata) -> Result<Self, String> {
        Ok(Self {
            root: main.workspace_root.clone(),
            workspaces: workspaces::all(main)?,
            plan: plan(main),
            cli_tests: cli::tests(main)?,
        })
    }

    /// The steps that run a command of some pages, in words; `None` if no step runs it. An error if the command cannot
    /// work.
    pub(super) fn runs(
        &self,
        command: &str,
        pages: &[Utf8PathBuf],
    ) -> Result<Option<String>, String> {
        let mut folder = Utf8PathBuf::new();
        let mut programs: Vec<&str> = command
            .split(" | ")
            .flat_map(|it| it.split(" && "))
            .collect();
        if let Some(to) = programs[0].strip_prefix("cd ") {
            folder = to.into();
            programs.remove(0);
        }
        let runs = programs
            .iter()
            .map(|program| self.one(program, &folder, pages));
        let mut runs = runs.collect::<Result<Vec<_>, _>>()?;
        // No step runs several programs of one command together.
        Ok(runs.pop().filter(|_| runs.is_empty()).flatten())
    }

    /// The steps that run a single program, as in [`Who::runs`].
    fn one(
        &self,
        command: &str,
        folder: &Utf8Path,
        pages: &[Utf8PathBuf],
    ) -> Result<Option<String>, String> {
        let is_set = |word: &&str| word.contains('=') && !word.starts_with('-');
        let words = command.split_whitespace();
        let variables: Vec<&str> = words.clone().take_while(is_set).collect();
        let words: Vec<&str> = words.skip(variables.len()).collect();
        for word in &words {
            let is_ours = FOLDERS.iter().any(|folder| word.starts_with(folder));
            if is_ours && !self.root.join(word).exists() {
                return Err(format!("there is no {word}"));
            }
        }
        let runs = match words[..] {
            ["cargo", "xtask", ref after @ ..] => self.task(after)?,
            ["cargo", "add" | "install", ref after @ ..] => {
                path::check(after, &self.workspaces[0].metadata)?;
                None
            }
            ["cargo", "test" | "bench" | "run" | "doc", ..] => {
                self.cargo(&words[1..], folder, pages)?
            }
            ["clamber", ref after @ ..] => self.cli(after),
            _ => None,
        };
        Ok(runs.filter(|_| variables.iter().all(|variable| variable.starts_with(DATA))))
    }

    /// The step for a call of `cargo xtask`: all steps of a task, the steps that `--only` names, or the step with the
    /// task's name.
    fn task(&self, after: &[&str]) -> Result<Option<String>, String> {
        let words = ["xtask"].iter().chain(after);
        let parsed = Arguments::try_parse_from(words).map_err(|error| error.to_string())?;
        let (task, steps, only) = match parsed.task {
            Task::Ci { only } => ("ci", &ci::STEPS[..], only),
            Task::Nightly { only } => ("nightly", &nightly::STEPS[..], only),
            _ => return Ok(self.named(after[0])),
        };
        match only {
            None => Ok(Some(told(task, "all"))),
            Some(only) if steps.iter().any(|step| step.name.contains(&only)) => {
                Ok(Some(told(task, &only)))
            }
            Some(only) => Err(format!("no step of {task} is called {only}")),
        }
    }

    /// The step of that name, with its task.
    fn named(&self, step: &str) -> Option<String> {
        let tasks = [("ci", &ci::STEPS[..]), ("nightly", &nightly::STEPS)];
        let mut having = tasks
            .iter()
            .filter(|(_, steps)| steps.iter().any(|it| it.name == step));
        having.next().map(|(task, _)| told(task, step))
    }

    /// The steps for a call of `cargo test`, `bench`, `run` or `doc`.
    fn cargo(
        &self,
        words: &[&str],
        folder: &Utf8Path,
        pages: &[Utf8PathBuf],
    ) -> Result<Option<String>, String> {
        let mut asked = Asked::read(&self.workspaces, folder, words)?;
        let mut parts = asked.parts()?;
        if parts.is_empty() {
            // The page of another workspace may mean that workspace, whose manifest is beside the page.
            let beside = pages
                .first()
                .and_then(|page| page.parent())
                .unwrap_or(folder);
            asked = Asked::read(&self.workspaces, beside, words).unwrap_or(asked);
            parts = asked.parts()?;
        }
        asked.check_names()?;
        if words[0] == "doc" {
            return Ok(self.named(DOCUMENTATION));
        }
        let is_cli = |part: &Part| part.kind == Kind::Start && part.package == cli::PACKAGE;
        if parts.iter().all(is_cli) && !parts.is_empty() {
            return Ok(self.cli(&asked.after));
        }
        let steps: Option<Vec<String>> = parts.iter().map(|part| self.step(part, &asked)).collect();
        let mut steps = steps.unwrap_or_default();
        steps.sort();
        steps.dedup();
        Ok(Some(steps.join(", ")).filter(|steps| !steps.is_empty()))
    }

    /// The first step that runs a part with the features, ignored tests and options that the call has.
    fn step(&self, part: &Part, asked: &Asked) -> Option<String> {
        let metadata = &asked.workspace.metadata;
        let is_program = matches!(part.kind, Kind::Start | Kind::Example);
        let options = asked
            .after
            .iter()
            .filter(|word| is_program && word.starts_with("--"));
        let mut here = self
            .plan
            .iter()
            .filter(|planned| planned.is_in(asked.workspace));
        let found = here.find(|Planned { run, .. }| {
            let on = run.turned_on(metadata);
            let given = (run.given)(&part.name);
            run.covers(metadata).contains(part)
                && asked
                    .run
                    .features
                    .iter()
                    .all(|feature| on.contains(feature))
                && (asked.run.ignored == Ignored::LeftOut || run.ignored == Ignored::Included)
                && options.clone().all(|option| given.contains(option))
        });
        found.map(|planned| told(planned.task, planned.step))
    }

    /// The step for a call of the program `clamber`: it runs a test that has the same words.
    fn cli(&self, after: &[&str]) -> Option<String> {
        let test = cli::test(&self.cli_tests, after)?;
        let metadata = &self.workspaces[0].metadata;
        let mut plan = self.plan.iter();
        let found = plan.find(|planned| {
            planned.is_in(&self.workspaces[0]) && planned.run.covers(metadata).contains(test)
        });
        found.map(|planned| told(planned.task, planned.step))
    }
}

fn told(task: &str, step: &str) -> String {
    format!("{task}: {step}")
}
