//! Lists the runs of all steps of `cargo xtask ci` and `cargo xtask nightly`.

use cargo_metadata::Metadata;

use crate::test_run::TestRun;
use crate::workspaces::Workspace;
use crate::{ci, nightly};

/// A run with its task and its step.
#[derive(Clone)]
pub(crate) struct Planned {
    pub(crate) task: &'static str,
    pub(crate) step: &'static str,
    pub(crate) run: TestRun,
}

impl Planned {
    /// True if the run is in this workspace.
    pub(crate) fn is_in(&self, workspace: &Workspace) -> bool {
        self.run.workspace == workspace.manifest
    }
}

/// The runs of all steps, first those in CI.
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
