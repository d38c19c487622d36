//! Checks that a step of `cargo xtask ci` or of `cargo xtask nightly` runs each test, bench, example and program in the
//! documentation, with the features that it requires, and each test that is marked as ignored.
//!
//! Each step lists its [`TestRun`](crate::test_run::TestRun)s, from which cargo's arguments follow as well. Cargo's
//! metadata lists the targets, and the sources mark ignored tests. The check covers the main workspace and all others in
//! the repository.
//!
//! A program in the documentation that is marked `no_run` is compiled with the others. A program that is marked
//! `ignore`, or `rs` instead of `rust`, is not even compiled, so a test must have the same program.

mod marks;
mod owners;
mod places;
mod targets;

use std::collections::BTreeSet;

use cargo_metadata::Metadata;
use cargo_metadata::camino::Utf8PathBuf;
use places::{Place, places};

use crate::plan::{Planned, plan};
use crate::workspaces::{self, Workspace};

/// All targets and marks of the repository, and the runs of all steps.
#[derive(Clone)]
struct Tree {
    root: Utf8PathBuf,
    /// The main workspace comes first.
    workspaces: Vec<Workspace>,
    places: Vec<Place>,
    plan: Vec<Planned>,
}

/// Fails if there are gaps.
pub(crate) fn check(main: &Metadata) -> Result<(), String> {
    let found = Tree::read(main)?.gaps();
    if found.is_empty() {
        return Ok(());
    }
    for gap in &found {
        eprintln!("   {gap}");
    }
    Err(format!("gaps in what ci and nightly run: {}", found.len()))
}

impl Tree {
    fn read(main: &Metadata) -> Result<Self, String> {
        Ok(Self {
            root: main.workspace_root.clone(),
            workspaces: workspaces::all(main)?,
            places: places(&main.workspace_root)?,
            plan: plan(main),
        })
    }

    /// The targets and marks that no step runs, in sentences.
    fn gaps(&self) -> BTreeSet<String> {
        let workspaces = self.workspaces.iter();
        let targets = workspaces.flat_map(|workspace| targets::gaps(workspace, &self.plan));
        let places = self.places.iter();
        targets
            .chain(places.filter_map(|place| places::gap(self, place)))
            .collect()
    }
}

#[cfg(test)]
mod tests;
