//! Finds the targets that no step runs.

use std::collections::BTreeSet;

use crate::parts::{Kind, Part, parts};
use crate::plan::Planned;
use crate::test_run::{Targets, TestRun};
use crate::workspaces::Workspace;

/// Packages and examples that open a window: steps build these examples and do not run them.
const WINDOWS: [(&str, &str); 2] = [("clamber_bevy_app", "first"), ("clamber_bevy_app", "fox")];

/// The targets of a workspace that no step runs, in sentences.
pub(super) fn gaps(workspace: &Workspace, plan: &[Planned]) -> Vec<String> {
    let here = plan.iter().filter(|planned| planned.is_in(workspace));
    let runs: Vec<&TestRun> = here.map(|planned| &planned.run).collect();
    let metadata = &workspace.metadata;
    let covered: BTreeSet<Part> = runs.iter().flat_map(|run| run.covers(metadata)).collect();
    let with_all_features = runs
        .iter()
        .flat_map(|run| run.covers_with_all_features(metadata));
    let with_all_features: BTreeSet<Part> = with_all_features.collect();
    let builds_all = |run: &&TestRun| matches!(run.targets[..], [Targets::All]);
    let is_built = |part: &Part| {
        let is_window = WINDOWS.contains(&(&part.package, &part.name));
        is_window && part.kind == Kind::Example && runs.iter().any(builds_all)
    };
    let packages = metadata.workspace_packages();
    let missing = packages
        .into_iter()
        .flat_map(parts)
        .filter(|(part, _)| part.kind != Kind::Start && !covered.contains(part) && !is_built(part));
    let told = missing.map(|(part, target)| match with_all_features.contains(&part) {
        true => format!(
            "{part} requires the features {}, which no step turns on together: add them to `FEATURES` in \
             xtask/src/build.rs, or run it with them in xtask/src/nightly.rs",
            target.required_features.join(", ")
        ),
        false => format!(
            "no step runs {part} ({}): add it to one in xtask/src/ci.rs if it takes seconds, else in \
             xtask/src/nightly.rs",
            workspace.manifest
        ),
    });
    told.collect()
}
