//! Finds the marks in the repository's files, and their gaps.

use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};

use super::Tree;
use super::marks::{Mark, marks};
use super::owners::owners;
use crate::files::{files, read};
use crate::parts::Part;
use crate::test_run::Ignored;
use crate::workspaces::owner;

/// Pages with programs that are not compiled, each with the package and the test that compiles the same programs.
const COMPILED: [(&str, &str, &str); 3] = [
    ("README.md", "bevy_clamber", "readme"),
    ("crates/bevy_clamber/README.md", "bevy_clamber", "readme"),
    ("docs/recipes/falling_crates.md", "bevy_clamber", "readme"),
];

/// A mark with its file and line.
#[derive(Clone)]
pub(super) struct Place {
    pub(super) file: Utf8PathBuf,
    pub(super) line: usize,
    pub(super) mark: Mark,
}

/// The marks of all sources and pages.
pub(super) fn places(root: &Utf8Path) -> Result<Vec<Place>, String> {
    let mut places = Vec::new();
    for file in files(root)? {
        if matches!(file.extension(), Some("rs" | "md")) {
            let marks = marks(&read(root, &file)?).into_iter();
            places.extend(marks.map(|(line, mark)| Place {
                file: file.clone(),
                line,
                mark,
            }));
        }
    }
    Ok(places)
}

/// The sentence about a mark that no step covers; `None` if one does.
pub(super) fn gap(tree: &Tree, place: &Place) -> Option<String> {
    let Place { file, line, mark } = place;
    match mark {
        Mark::NotCompiled if is_compiled_elsewhere(tree, file) => None,
        Mark::NotCompiled => Some(format!(
            "{file}:{line}: a program that is not even compiled: mark it `no_run`, or have a test compare it with one \
             that is, and name the test in `COMPILED` in xtask/src/coverage/places.rs"
        )),
        Mark::Test if has_harness(tree, file) => None,
        Mark::Test => Some(format!(
            "{file}: tests in a target without a harness, so cargo runs none of them: move them to one that has"
        )),
        Mark::Ignored => not_run(tree, file).map(|part| {
            format!(
                "{file}:{line}: an ignored test in {part}, whose ignored tests no step runs: add {} to `LONG` in \
                 xtask/src/nightly.rs",
                part.package
            )
        }),
    }
}

fn is_compiled_elsewhere(tree: &Tree, page: &Utf8Path) -> bool {
    let packages = tree.workspaces[0].metadata.workspace_packages();
    let is_there = |package: &str, test: &str| {
        let mut targets = packages.iter().filter(|known| known.name == package);
        targets.any(|known| {
            known
                .targets
                .iter()
                .any(|it| it.is_test() && it.name == test)
        })
    };
    let mut compiled = COMPILED.into_iter();
    compiled.any(|(known, package, test)| known == page && is_there(package, test))
}

fn has_harness(tree: &Tree, file: &Utf8Path) -> bool {
    let owner = owner(&tree.workspaces, &tree.root, file);
    owner.is_some_and(|(_, package)| !owners(package, &tree.root.join(file)).is_empty())
}

/// A part that the file may belong to and whose ignored tests no step runs.
fn not_run(tree: &Tree, file: &Utf8Path) -> Option<Part> {
    let (workspace, package) = owner(&tree.workspaces, &tree.root, file)?;
    let here = tree.plan.iter().filter(|planned| planned.is_in(workspace));
    let with_ignored = here.filter(|planned| planned.run.ignored == Ignored::Included);
    let covered: Vec<_> = with_ignored
        .map(|planned| planned.run.covers(&workspace.metadata))
        .collect();
    let mut owners = owners(package, &tree.root.join(file)).into_iter();
    owners.find(|part| !covered.iter().any(|covered| covered.contains(part)))
}
