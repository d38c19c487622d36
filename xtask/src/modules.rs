//! Checks the imports between the top-level modules of each library: no module imports a module to its right in
//! `xtask/modules.txt`. An import through a name that the crate's root exports again counts as one of its module.

use std::collections::{BTreeMap, BTreeSet};

use cargo_metadata::Metadata;
use cargo_metadata::camino::Utf8Path;

use crate::workspace::{files, no_faults, read};

/// The modules of each library in the direction of the data flow, and the imports that break this order.
const ORDER: &str = include_str!("../modules.txt");

/// Checks all libraries of the workspace. Each module that imports another one must have a place in the order.
pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    let mut wrong = Vec::new();
    for package in metadata.workspace_packages() {
        let prefix = format!("{}: ", package.name);
        let mut lines = ORDER.lines().filter_map(|line| line.strip_prefix(&prefix));
        let words = lines.next().unwrap_or_default().split(' ');
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        for library in package.targets.iter().filter(|target| target.is_lib()) {
            let (modules, arrows) = arrows(&library.src_path)?;
            let is_known = |word: &str| match word.split_once('>') {
                Some((from, to)) => arrows.contains(&(from.to_owned(), to.to_owned())),
                None => word == "|" || modules.contains(word),
            };
            let unknown = words.iter().filter(|word| !is_known(word));
            wrong.extend(unknown.map(|word| format!("{prefix}{word}, which the library lacks")));
            for (from, to) in arrows {
                let place = |module: &str| words.iter().position(|known| *known == module);
                let is_allowed = place(&format!("{from}>{to}")).is_some();
                match (place(&from), place(&to)) {
                    _ if is_allowed => {}
                    (Some(from), Some(to)) if to < from => {}
                    _ => wrong.push(format!("{prefix}{from}>{to}")),
                }
            }
        }
    }
    no_faults(&wrong, ": imports against the order in xtask/modules.txt")
}

/// Imports: from a module to another.
type Arrows = BTreeSet<(String, String)>;

/// The top-level modules of a library, and the imports between different ones.
fn arrows(root: &Utf8Path) -> Result<(BTreeSet<String>, Arrows), String> {
    let (folder, exports) = (root.parent().unwrap_or(root), read(root)?);
    let mut sources = files(folder)?;
    sources.retain(|file| {
        let is_declared = exports.contains(&format!("mod {};", module(file)));
        let mut parts = file.iter().map(|part| part.trim_end_matches(".rs"));
        let is_test = parts.any(|part| matches!(part, "tests" | "testing"));
        let is_test = is_test || file == "surface/agreement.rs";
        is_declared && !is_test && file.extension() == Some("rs")
    });
    let modules: BTreeSet<&str> = sources.iter().map(|file| module(file)).collect();
    // The module of each name that the root exports, and of each module.
    let mut owners = BTreeMap::new();
    for used in exports.split("use ").skip(1) {
        let mut names = names(used.split(';').next().unwrap_or_default());
        let module = names.next().filter(|name| modules.contains(name));
        owners.extend(names.filter_map(|name| Some((name, module?))));
    }
    owners.extend(modules.iter().map(|module| (*module, *module)));
    let mut arrows = Arrows::new();
    for file in &sources {
        let depth = file.iter().count() - usize::from(file.file_stem() == Some("mod"));
        for name in imported(&read(&folder.join(file))?, depth) {
            let to = owners.get(name.as_str()).copied().unwrap_or(module(file));
            arrows.insert((module(file).to_owned(), to.to_owned()));
        }
    }
    arrows.retain(|(from, to)| from != to);
    let modules = modules.into_iter().map(str::to_owned).collect();
    Ok((modules, arrows))
}

/// The top-level module of a file.
fn module(file: &Utf8Path) -> &str {
    file.iter()
        .next()
        .unwrap_or_default()
        .trim_end_matches(".rs")
}

/// The names in a path or in a group of paths.
fn names(path: &str) -> impl Iterator<Item = &str> {
    let names = path.split(|c: char| !c.is_alphanumeric() && c != '_');
    names.filter(|name| !name.is_empty())
}

/// The first name after each `crate::`, or after enough `super::`, in code without comments and tests. All names of the
/// groups in braces that follow.
fn imported(text: &str, depth: usize) -> Vec<String> {
    let mut code = String::new();
    for line in text.lines().take_while(|line| *line != "mod tests {") {
        if !line.trim_start().starts_with("//") {
            code += &format!("{line}\n");
        }
    }
    let mut imported = Vec::new();
    for root in ["crate::", &"super::".repeat(depth)] {
        for path in code.split(root).skip(1) {
            let count = if path.starts_with('{') { usize::MAX } else { 1 };
            let names = names(path.split(';').next().unwrap_or_default());
            imported.extend(names.take(count).map(str::to_owned));
        }
    }
    imported
}

#[cfg(test)]
mod tests {
    use super::imported;

    #[test]
    fn finds_what_a_file_imports_however_it_is_written() {
        let text = "
//! crate::surface in a comment
use crate::{mesh::Mesh, pose};
use super::super::skin::cluster;
use super::hit::SurfaceHit;
fn f() -> crate::bounds::Spheres {}
#[cfg(test)]
mod tests {
    use crate::surface::SkinnedSurface;
}";
        let due = ["mesh", "Mesh", "pose", "bounds", "skin"];
        assert_eq!(imported(text, 2), due);
    }
}
