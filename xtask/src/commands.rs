//! Checks that a step of `cargo xtask ci` or `cargo xtask nightly` runs each command in the documentation, or that
//! `docs/commands.md` gives the reason why not; and that the packages, targets, features, steps and files that a
//! command names exist.
//!
//! A step runs a command if it runs the same targets, with all features that are on there, and includes ignored tests
//! if the command does. Programs must get the same options. The comparison ignores:
//!
//! - the profile: each step chooses its own, mostly the profile of tests;
//! - the values of a program's options, such as of `--seconds`, and the program's files: a step has to be brief;
//! - the names of single tests or benches in a target, and `--nocapture`; a test's name must stand in the sources;
//! - `CLAMBER_TEST_DATA`, which is the folder of test files. Any other variable makes a different command.
//!
//! A step runs a program such as `clamber` if a test that starts it has the same words and options in its text. No step
//! runs a command with a pipe, or a command of any other program.

use std::collections::BTreeSet;

use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};
use cargo_metadata::{Metadata, Package};
use clap::Parser;

use crate::call::{Call, Part, ask, parts};
use crate::pages::{LIST, read_all, reasons};
use crate::plan::Plan;
use crate::workspace::{files, folder, no_faults, read};
use crate::{Arguments, Only, Task, examples};

/// Folders at the root of the repository. A word that begins with one of them is a path that must exist.
const FOLDERS: &str = ".ci/ assets/ benches/ crates/ examples/ peers/ tests/";

/// Options of cargo with a value. Other words of a test's command are names of tests.
const VALUED: &str = "-p --features --manifest-path --test --bench --example";

/// Path of the clone from a project in a folder beside it.
const CLONE: &str = "../clamber";

/// Checks all commands, and that each page with commands has a link to the list.
pub(crate) fn check(main: &Metadata) -> Result<(), String> {
    visit(main, |_, _| {})
}

/// Prints each command, with the step that runs it, or the reason why none does.
pub(crate) fn print(main: &Metadata) -> Result<(), String> {
    visit(main, |command, says| println!("{command}\n    {says}"))
}

fn visit(main: &Metadata, tell: impl Fn(&str, &str)) -> Result<(), String> {
    let plan = Plan::read(main)?;
    let root = &plan.root;
    let (commands, without_link) = read_all(root)?;
    let mut reasons = reasons(root)?;
    let link = |page| format!("{page} has commands, and no link to {LIST}");
    let mut wrong: Vec<String> = without_link.iter().map(link).collect();
    for (command, page) in &commands {
        let runs = match reasons.remove(command).filter(|reason| !reason.is_empty()) {
            Some(reason) => match plan.step_for(command, page) {
                Ok(Some(step)) => Err(format!("{step} runs it, but {LIST} gives a reason")),
                Ok(None) => Ok(Some(reason)),
                Err(why) => Err(why),
            },
            None => plan.step_for(command, page),
        };
        match runs {
            Ok(Some(says)) => tell(command, &says),
            Ok(None) => wrong.push(format!(
                "{page}: no step runs `{command}`, nor says {LIST} why"
            )),
            Err(why) => wrong.push(format!("{page}: `{command}`: {why}")),
        }
    }
    for command in reasons.keys() {
        wrong.push(format!("{LIST}: no page has `{command}`"));
    }
    no_faults(&wrong, "")
}

impl Plan {
    /// The steps that run a command of a page; `None` if no step runs it. An error if the command cannot work.
    fn step_for(&self, command: &str, page: &Utf8Path) -> Result<Option<String>, String> {
        self.check_names(command)?;
        let entered = command.strip_prefix("cd ");
        let entered = entered.and_then(|rest| rest.split_once(" && "));
        let (folder, line) = entered.unwrap_or(("", command));
        let words: Vec<&str> = line.split_whitespace().collect();
        let words = &words[usize::from(words[0].starts_with("CLAMBER_TEST_DATA="))..];
        match *words {
            // No step runs several programs of one command together.
            _ if words.contains(&"|") || words.contains(&"&&") => Ok(None),
            ["cargo", "xtask", ..] => self.task(&words[1..]),
            ["cargo", "doc", ..] => Ok(self.named("documentation")),
            ["cargo", "test" | "bench" | "run", ..] => {
                let line = words[1..].join(" ");
                let mut call = ask(&self.root.join(folder), &line);
                if !call.as_ref().is_ok_and(|call| !call.parts.is_empty()) {
                    // The page of another workspace may mean that workspace, whose manifest is beside the page.
                    let beside = self.root.join(page.parent().unwrap_or(page));
                    call = ask(&beside, &line).or(call);
                }
                Ok(self.steps_of(&call?))
            }
            [name, ref after @ ..] => {
                let mut call = Call::default();
                call.after.extend(after.iter().map(|&word| word.to_owned()));
                for package in &self.packages {
                    let mut programs = package.targets.iter().filter(|target| target.is_bin());
                    let is_there = programs.any(|target| target.name == name);
                    let part = Part::new(&package.name, "program", name);
                    call.parts.extend(is_there.then_some(part));
                }
                Ok(self.steps_of(&call))
            }
            [] => Ok(None),
        }
    }

    /// An error if a path, package, target, feature or test that a command names does not exist.
    fn check_names(&self, command: &str) -> Result<(), String> {
        let is_in = |list: &str, word: &str| list.split(' ').any(|known| word.starts_with(known));
        let words = command.split_whitespace();
        let words: Vec<&str> = words.take_while(|word| *word != "|").collect();
        let mut paths = words.iter().filter(|word| is_in(FOLDERS, word));
        if let Some(path) = paths.find(|path| !self.root.join(path).exists()) {
            return Err(format!("there is no {path}"));
        }
        let has = |word| words.contains(&word);
        // What `cargo add` names without a path is not ours.
        if !has("cargo") || (has("add") || has("install")) && !has("--path") {
            return Ok(());
        }
        let pairs: Vec<(&str, &str)> = words.windows(2).map(|pair| (pair[0], pair[1])).collect();
        let mut packages: Vec<&Package> = self.packages.iter().collect();
        for (option, value) in &pairs {
            let at = value.trim_start_matches(CLONE).trim_start_matches('/');
            let at = self.root.join(at);
            packages.retain(|package| match *option {
                "-p" => package.name == *value,
                "--path" => folder(package) == at,
                "cd" => package.manifest_path.starts_with(&at),
                "--manifest-path" => package.manifest_path == at,
                _ => true,
            });
            if packages.is_empty() {
                return Err(format!("there is no package {value}"));
            }
        }
        let any = |is_it: &dyn Fn(&Package) -> bool| packages.iter().any(|package| is_it(package));
        let mut is_test = false;
        for (option, value) in &pairs {
            let has_feature = |name: &str| {
                let name = name.rsplit('/').next().unwrap_or_default();
                any(&|package| package.features.contains_key(name))
            };
            let is_target =
                |part: &Part| part.name == *value && *option == format!("--{}", part.kind);
            let is_there = match *option {
                "--features" => value.split(',').all(has_feature),
                "--test" | "--bench" | "--example" => {
                    any(&|package| parts(package).iter().any(|(part, _)| is_target(part)))
                }
                _ if is_test && !value.starts_with('-') && !is_in(VALUED, option) => {
                    any(&|package| has_word(package, value).unwrap_or_default())
                }
                _ => true,
            };
            is_test |= *value == "test";
            if !is_there {
                return Err(format!("there is no {value}"));
            }
        }
        Ok(())
    }

    /// The step for a call of `cargo xtask`: all steps of a task, the steps that `--only` names, or the step with the
    /// task's name.
    fn task(&self, words: &[&str]) -> Result<Option<String>, String> {
        let parsed = Arguments::try_parse_from(words).map_err(|error| error.to_string())?;
        let (task, Only { only }) = match parsed.task {
            Task::Ci(only) => ("ci", only),
            Task::Nightly(only) => ("nightly", only),
            _ => return Ok(self.named(words[1])),
        };
        let mut names = self.steps.iter().filter(|name| name.starts_with(task));
        match names.any(|name| name.contains(&only)) {
            true if only.is_empty() => Ok(Some(format!("{task}: all"))),
            true => Ok(Some(format!("{task}: {only}"))),
            false => Err(format!("no step of {task} is called {only}")),
        }
    }

    /// The step of that name, with its task.
    fn named(&self, name: &str) -> Option<String> {
        let mut steps = self.steps.iter();
        let step = steps.find(|step| step.ends_with(&format!(": {name}")));
        step.map(|&step| step.to_owned())
    }

    /// The steps that run all parts of a call.
    fn steps_of(&self, call: &Call) -> Option<String> {
        let mut steps = BTreeSet::new();
        for part in &call.parts {
            steps.insert(self.step_of(part, call)?);
        }
        let steps: Vec<&str> = steps.into_iter().collect();
        (!steps.is_empty()).then(|| steps.join(", "))
    }

    /// The first step that runs a part of a call with its features, ignored tests and options.
    fn step_of(&self, part: &Part, call: &Call) -> Option<&str> {
        let part = match part.kind {
            "program" => &self.starter(part, &call.after)?,
            _ => part,
        };
        let package = format!("{}/", part.package);
        let given = examples::given(&part.name);
        let mut steps = self.calls.iter().filter(|(_, planned)| {
            let mut features = call.features.iter();
            let mut options = call.after.iter().filter(|word| word.starts_with("--"));
            let is_given = |it: &String| given.contains(&it.as_str()) || planned.after.contains(it);
            planned.parts.contains(part)
                && features.all(|it| !it.starts_with(&package) || planned.features.contains(it))
                && (planned.runs_ignored() || !call.runs_ignored())
                && (part.kind != "example" || options.all(is_given))
        });
        steps.next().map(|(step, _)| *step)
    }

    /// The test that starts a program with these words: the first one and all options stand in its text.
    fn starter(&self, program: &Part, words: &[String]) -> Option<Part> {
        let mut packages = self.packages.iter();
        let package = packages.find(|package| package.name == program.package)?;
        let mut tests = parts(package);
        tests.retain(|(part, _)| part.kind == "test");
        let is_it = |text: &str| {
            let mut words = words.iter().enumerate();
            text.contains("CARGO_BIN_EXE_")
                && words.all(|(at, word)| {
                    at > 0 && !word.starts_with("--") || text.contains(&format!("\"{word}\""))
                })
        };
        let mut tests = tests.into_iter();
        let test = tests.find(|(_, test)| {
            let mut files = sources(&test.src_path).into_iter();
            files.any(|file| read(&file).is_ok_and(|text| is_it(&text)))
        });
        test.map(|(part, _)| part)
    }
}

/// The files of a test: its own, or all files beside it if it is a `main.rs`.
fn sources(file: &Utf8Path) -> Vec<Utf8PathBuf> {
    match (file.file_name(), file.parent()) {
        (Some("main.rs"), Some(folder)) => {
            let files = files(folder).unwrap_or_default().into_iter();
            files.map(|file| folder.join(file)).collect()
        }
        _ => vec![file.to_owned()],
    }
}

/// True if a word stands in a package's sources.
fn has_word(package: &Package, word: &str) -> Result<bool, String> {
    let mut has_word = false;
    for file in files(folder(package))? {
        if file.extension() == Some("rs") {
            has_word |= read(&folder(package).join(&file))?.contains(word);
        }
    }
    Ok(has_word)
}

#[cfg(test)]
mod tests {
    use super::Plan;
    use crate::workspace::main;

    /// Commands with the step that runs them, with `none`, or with a part of what is wrong with them.
    const COMMANDS: &str = "\
ci: examples <= cargo run --release --example battle
ci: examples <= cargo run --features record --example replay -- FILE --from 9
ci: tests <= cargo test --test bots
ci: tests <= cargo test --features deterministic --test golden_battle
nightly: all cases <= cargo test -p clamber_verify --test stress -- --include-ignored
ci: benches <= cargo bench -p clamber_benches --bench tick
nightly: peers <= cargo bench --manifest-path peers/Cargo.toml --bench peers -- queries
ci: documentation <= cargo doc --open -p clamber_record
ci: golden <= cargo xtask ci --only golden
nightly: soak <= cargo xtask soak --minutes 10
ci: tests <= clamber inspect --humanoid FILE
ci: tests <= cargo run -p clamber_cli -- inspect FILE
nightly: app <= cd examples/bevy && cargo run --release -- --script a --screenshot a.png
none <= cargo run --release --example battle -- --pilot bot
none <= cargo run --release --example battle -- --out x | cat
none <= cargo test -p clamber_gltf --lib -- --ignored
none <= CLAMBER_BLESS=1 cargo test --test bots
none <= clamber inspect --hominid FILE
none <= cargo add --path ../clamber --features serde,record
no battel <= cargo run --release --example battel
requires the features: `record` <= cargo run --release --example replay
no recrod <= cargo run --features recrod --example battle
no package clamber_recrod <= cargo doc -p clamber_recrod
no time_of_eddies <= cargo test -p clamber_surface --lib -- time_of_eddies
no package pears/Cargo.toml <= cargo bench --manifest-path pears/Cargo.toml --bench peers
no step of ci is called gulden <= cargo xtask ci --only gulden
sok <= cargo xtask sok
--minute <= cargo xtask soak --minute 10
no recrod <= cargo add --path ../clamber --features recrod
no crates/clamber_clj <= cargo install --path crates/clamber_clj
no assets/collosus.py <= blender -b -P assets/collosus.py";

    #[test]
    fn commands_are_run_by_steps_or_need_a_reason_or_are_wrong() {
        let plan = Plan::read(&main().unwrap()).unwrap();
        for (due, command) in COMMANDS.lines().filter_map(|line| line.split_once(" <= ")) {
            match plan.step_for(command, "README.md".into()) {
                Ok(step) => assert_eq!(step.as_deref().unwrap_or("none"), due, "{command}"),
                Err(why) => assert!(why.contains(due), "{command}: {why}"),
            }
        }
    }
}
