//! One call of cargo that runs tests, benches or examples, as a value. Both cargo's arguments and the list of parts
//! that it runs follow from this value, so they cannot disagree.

use std::collections::BTreeSet;

use cargo_metadata::{Metadata, Package};

use crate::parts::{Part, parts};
use crate::run::cargo_with;
pub(crate) use crate::targets::Targets;
use crate::turned_on::turned_on;

/// A selection of packages in a workspace.
#[derive(Clone, Debug)]
pub(crate) enum Packages {
    /// The default members, which cargo selects without options.
    Default,
    /// All members except these.
    AllBut(Vec<String>),
    Named(Vec<String>),
}

/// Whether tests that are marked `#[ignore]` are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ignored {
    LeftOut,
    Included,
}

/// The profile of a build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Profile {
    Dev,
    Release,
}

/// A call of cargo. The default is `cargo test`.
#[derive(Clone, Debug)]
pub(crate) struct TestRun {
    /// The manifest of the run's workspace, from the root of the repository.
    pub(crate) workspace: &'static str,
    pub(crate) profile: Profile,
    pub(crate) packages: Packages,
    /// Features as `package/feature`, besides those that are on by default.
    pub(crate) features: Vec<String>,
    pub(crate) targets: Vec<Targets>,
    pub(crate) ignored: Ignored,
    /// Options of cargo that select no targets.
    pub(crate) options: Vec<String>,
    /// Options of the tests' or benches' harness that select no tests.
    pub(crate) harness: &'static [&'static str],
    pub(crate) variables: &'static [(&'static str, &'static str)],
    /// The options that a program of this run gets, by its name.
    pub(crate) given: fn(&str) -> Vec<&'static str>,
    /// Performs the run.
    pub(crate) perform: fn(&Metadata, &TestRun) -> Result<(), String>,
}

/// The manifest of the main workspace.
pub(crate) const MAIN: &str = "Cargo.toml";

impl Default for TestRun {
    fn default() -> Self {
        Self {
            workspace: MAIN,
            profile: Profile::Dev,
            packages: Packages::Default,
            features: Vec::new(),
            targets: vec![Targets::Usual],
            ignored: Ignored::LeftOut,
            options: Vec::new(),
            harness: &[],
            variables: &[],
            given: |_| Vec::new(),
            perform: test,
        }
    }
}

/// Runs `cargo test`.
pub(crate) fn test(_: &Metadata, run: &TestRun) -> Result<(), String> {
    let ignored: &[&str] = match run.ignored {
        Ignored::LeftOut => &[],
        Ignored::Included => &["--include-ignored"],
    };
    let harness = [ignored, run.harness].concat();
    cargo_with(&run.arguments("test", &harness), run.variables)
}

impl TestRun {
    /// The same run with other targets.
    pub(crate) fn of(self, targets: Vec<Targets>) -> Self {
        Self { targets, ..self }
    }

    /// The arguments of cargo: a command, the selection, and the words after `--`.
    pub(crate) fn arguments(&self, command: &str, after: &[&str]) -> Vec<String> {
        let mut arguments = vec![command.to_owned()];
        let mut add = |words: &[&str]| arguments.extend(words.iter().map(|&word| word.to_owned()));
        if self.workspace != MAIN {
            add(&["--manifest-path", self.workspace]);
        }
        if self.profile == Profile::Release {
            add(&["--release"]);
        }
        match &self.packages {
            Packages::Default => {}
            Packages::AllBut(excluded) => {
                add(&["--workspace"]);
                excluded.iter().for_each(|name| add(&["--exclude", name]));
            }
            Packages::Named(names) => names.iter().for_each(|name| add(&["-p", name])),
        }
        if !self.features.is_empty() {
            add(&["--features", &self.features.join(",")]);
        }
        self.options.iter().for_each(|option| add(&[option]));
        self.targets
            .iter()
            .for_each(|targets| add(&targets.options()));
        if !after.is_empty() {
            add(&["--"]);
            add(after);
        }
        arguments
    }

    /// The packages of its workspace that the run selects.
    pub(crate) fn packages<'a>(&self, workspace: &'a Metadata) -> Vec<&'a Package> {
        let mut packages = match self.packages {
            Packages::Default => workspace.workspace_default_packages(),
            _ => workspace.workspace_packages(),
        };
        packages.retain(|package| match &self.packages {
            Packages::Default => true,
            Packages::AllBut(excluded) => !excluded.iter().any(|name| package.name == *name),
            Packages::Named(names) => names.iter().any(|name| package.name == *name),
        });
        packages
    }

    /// The features that are on during the run, as `package/feature`.
    pub(crate) fn turned_on(&self, workspace: &Metadata) -> BTreeSet<String> {
        turned_on(workspace, &self.packages(workspace), &self.features)
    }

    /// The parts of its workspace that the run covers. As cargo does, it leaves out targets whose required features are
    /// off.
    pub(crate) fn covers(&self, workspace: &Metadata) -> BTreeSet<Part> {
        let on = self.turned_on(workspace);
        self.parts_with(workspace, |package, feature| {
            on.contains(&format!("{}/{feature}", package.name))
        })
    }

    /// The parts that the run would cover with all required features on.
    pub(crate) fn covers_with_all_features(&self, workspace: &Metadata) -> BTreeSet<Part> {
        self.parts_with(workspace, |_, _| true)
    }

    fn parts_with(
        &self,
        workspace: &Metadata,
        is_on: impl Fn(&Package, &str) -> bool,
    ) -> BTreeSet<Part> {
        let mut covered = BTreeSet::new();
        for package in self.packages(workspace) {
            for (part, target) in parts(package) {
                let features = target.required_features.iter();
                let built = features.into_iter().all(|feature| is_on(package, feature));
                if built && self.targets.iter().any(|some| some.have(&part, target)) {
                    covered.insert(part);
                }
            }
        }
        covered
    }
}
