//! Parses a call of cargo on a page as cargo does.

use cargo_metadata::Metadata;
use cargo_metadata::camino::Utf8Path;

use crate::files::{files, read};
use crate::parts::Part;
use crate::test_run::{Ignored, Packages, Targets, TestRun};
use crate::workspaces::{Workspace, folder};

/// The targets, packages and features that a call of `cargo test`, `bench` or `run` selects.
pub(super) struct Asked<'a> {
    pub(super) workspace: &'a Workspace,
    /// The same call as a [`TestRun`].
    pub(super) run: TestRun,
    /// The words after `--`.
    pub(super) after: Vec<&'a str>,
    /// True if the call names no target.
    is_unnamed: bool,
}

impl<'a> Asked<'a> {
    /// Parses the words after `cargo`. `folder` is the working folder of the call.
    pub(super) fn read(
        workspaces: &'a [Workspace],
        folder: &Utf8Path,
        words: &[&'a str],
    ) -> Result<Self, String> {
        let mut before = words.split(|word| *word == "--");
        let options = before.next().unwrap_or_default();
        let mut after = words.get(options.len() + 1..).unwrap_or_default().to_vec();
        let (mut packages, mut features, mut targets) = (Vec::new(), Vec::new(), Vec::new());
        let mut manifest = folder.join("Cargo.toml");
        let mut options = options.iter().copied();
        let command = options.next().unwrap_or_default();
        while let Some(option) = options.next() {
            let mut value = || {
                let value = options.next().ok_or(format!("no value after {option}"));
                value.map(str::to_owned)
            };
            match option {
                "-p" | "--package" => packages.push(value()?),
                "--features" => features.extend(value()?.split(',').map(str::to_owned)),
                "--manifest-path" => manifest = folder.join(value()?),
                "--test" => targets.push(Targets::Test(value()?)),
                "--bench" => targets.push(Targets::Bench(value()?)),
                "--example" => targets.push(Targets::Example(value()?)),
                "--lib" => targets.push(Targets::Library),
                "--doc" => targets.push(Targets::Documentation),
                // Each step chooses its own profile.
                "--open" | "--release" | "--ignore-rust-version" | "--quiet" | "--locked" => {}
                // The name of a test, or a file for a program.
                word if !word.starts_with('-') => after.insert(0, word),
                _ => {
                    let file = "xtask/src/commands/asked.rs";
                    return Err(format!("{file} does not know cargo's option {option}"));
                }
            }
        }
        let mut known = workspaces.iter();
        let workspace = known
            .find(|known| known.manifest == manifest)
            .ok_or(format!("there is no workspace at {manifest}"))?;
        let is_unnamed = targets.is_empty();
        if is_unnamed {
            targets.push(match command {
                "bench" => Targets::Benches,
                "run" => Targets::Program,
                _ => Targets::Usual,
            });
        }
        let is_ignored = |word: &&str| matches!(*word, "--ignored" | "--include-ignored");
        let mut run = TestRun {
            packages: match packages.is_empty() {
                true => Packages::Default,
                false => Packages::Named(packages),
            },
            targets,
            ignored: match after.iter().any(is_ignored) {
                true => Ignored::Included,
                false => Ignored::LeftOut,
            },
            ..TestRun::default()
        };
        run.features = full_names(&workspace.metadata, &run, &features)?;
        Ok(Self {
            workspace,
            run,
            after,
            is_unnamed,
        })
    }

    /// The parts that the call runs. An error if it names a package or target that does not exist, or a target without
    /// the features that it requires.
    pub(super) fn parts(&self) -> Result<Vec<Part>, String> {
        let metadata = &self.workspace.metadata;
        if let Packages::Named(names) = &self.run.packages {
            let packages = self.run.packages(metadata);
            let is_missing = |name: &&String| !packages.iter().any(|known| known.name == **name);
            if let Some(name) = names.iter().find(is_missing) {
                return Err(format!("there is no package `{name}`"));
            }
        }
        let mut parts = Vec::new();
        for targets in &self.run.targets {
            let one = self.run.clone().of(vec![targets.clone()]);
            let found = one.covers(metadata);
            if found.is_empty() && !self.is_unnamed {
                return Err(match one.covers_with_all_features(metadata).first() {
                    Some(part) => format!("{part} needs features that are not named"),
                    None => format!("no package has `{}`", targets.options().join(" ")),
                });
            }
            parts.extend(found);
        }
        Ok(parts)
    }

    /// An error if names of tests, before or after `--`, are not in the sources of the packages.
    pub(super) fn check_names(&self) -> Result<(), String> {
        let has_tests =
            |it: &Targets| matches!(it, Targets::Usual | Targets::Library | Targets::Test(_));
        let names = self.after.iter().filter(|word| !word.starts_with('-'));
        let names: Vec<&str> = names.copied().collect();
        if names.is_empty() || !self.run.targets.iter().all(has_tests) {
            return Ok(());
        }
        let packages = self.run.packages(&self.workspace.metadata).into_iter();
        let texts = packages.map(|package| sources(&folder(package)));
        let texts = texts.collect::<Result<Vec<_>, _>>()?;
        let stands = |name: &&str| texts.iter().any(|text| text.contains(name));
        match names.iter().find(|name| !stands(name)) {
            Some(name) => Err(format!("there is no test `{name}`")),
            None => Ok(()),
        }
    }
}

/// The text of all sources of a package.
fn sources(folder: &Utf8Path) -> Result<String, String> {
    let mut all = String::new();
    for file in files(folder)? {
        if file.extension() == Some("rs") {
            all += &read(folder, &file)?;
        }
    }
    Ok(all)
}

/// The features as `package/feature`, with all packages of the run that have them.
fn full_names(
    workspace: &Metadata,
    run: &TestRun,
    features: &[String],
) -> Result<Vec<String>, String> {
    let mut full = Vec::new();
    for feature in features {
        let packages = run.packages(workspace).into_iter();
        let (package, name) = match feature.split_once('/') {
            Some((package, name)) => (Some(package), name),
            None => (None, feature.as_str()),
        };
        let having = packages.filter(|known| {
            package.is_none_or(|package| known.name == package) && known.features.contains_key(name)
        });
        let before = full.len();
        full.extend(having.map(|known| format!("{}/{name}", known.name)));
        if full.len() == before {
            return Err(format!("there is no feature `{feature}`"));
        }
    }
    Ok(full)
}
