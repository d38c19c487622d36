//! All that `cargo xtask ci` and `cargo xtask nightly` run.

use cargo_metadata::Metadata;

use crate::test_run::TestRun;
use crate::workspaces::Workspace;
use crate::{ci, nightly};

/// A run, and where it belongs.
#[derive(Clone)]
pub(crate) struct Planned {
    pub(crate) task: &'static str,
    pub(crate) step: &'static str,
    pub(crate) run: TestRun,
}

impl Planned {
    /// True if it runs in a workspace.
    pub(crate) fn is_in(&self, workspace: &Workspace) -> bool {
        self.run.workspace == workspace.manifest
    }
}

/// The runs of all steps, CI's first.
pub(crate) fn plan(main: &Metadata) -> Vec<Planned> {
    let tasks = [("ci", &ci::STEPS[..]), ("nightly", &nightly::STEPS)];
    let mut plan = Vec::new();
    for (task, steps) in tasks {
        for step in steps {
            let runs = (step.runs)(main).into_iter();
            plan.extend(runs.map(|run| Planned {
                task,
                step: step.name,
                run,
            }));
        }
    }
    plan
}
