//! Nothing rots unseen: each test, bench, example and program in the documentation is run by a step of `cargo xtask ci`
//! or of `cargo xtask nightly`, with the features that it requires, and so is each test that is marked as ignored.
//!
//! What the steps run, their [`TestRun`](crate::test_run::TestRun)s say, from which cargo's arguments follow too. What
//! there is to run, cargo's metadata says, and for ignored tests the sources. This holds for the main workspace and for
//! those beside it.
//!
//! A program in the documentation that is marked `no_run` is compiled with the others. One that is marked `ignore`, or
//! `rs` and not `rust`, is not even compiled, so a test must have the same program.

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

/// What there is to run, and what runs it.
#[derive(Clone)]
struct Tree {
    root: Utf8PathBuf,
    /// The main workspace first.
    workspaces: Vec<Workspace>,
    places: Vec<Place>,
    plan: Vec<Planned>,
}

/// There are no gaps.
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

    /// What no step runs, in sentences.
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
