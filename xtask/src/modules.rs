//! Checks the imports between the core's modules: no module imports a module to its right in [`ORDER`].

use std::path::{Path, PathBuf};

/// Sources of the core, from the root of the repository.
const SOURCES: &str = "crates/clamber_surface/src";

/// The modules in the direction of the data flow, from left to right.
const ORDER: [&str; 9] = [
    "geometry", "rig", "mesh", "skin", "bounds", "pose", "query", "surface", "measure",
];

pub(crate) fn check() -> Result<(), String> {
    let mut files = Vec::new();
    collect(Path::new(SOURCES), &mut files).map_err(|error| format!("{SOURCES}: {error}"))?;
    let mut wrong = Vec::new();
    for file in files {
        let text = std::fs::read_to_string(&file);
        let text = text.map_err(|error| format!("{}: {error}", file.display()))?;
        let path = file.strip_prefix(SOURCES).unwrap_or(&file);
        let known = importer(path).map(|from| (from, imported(&text, depth(path))));
        let Some((from, modules)) = known else {
            continue;
        };
        let to_the_right = modules.into_iter().filter(|to| place(to) > place(from));
        wrong.extend(to_the_right.map(|to| format!("{} must not import {to}", file.display())));
    }
    wrong.sort();
    wrong.dedup();
    if wrong.is_empty() {
        Ok(())
    } else {
        Err(wrong.join("; "))
    }
}

/// Collects the source files under a folder, except test files.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_stem().and_then(|name| name.to_str());
        if matches!(name, Some("tests" | "testing" | "agreement")) {
            continue;
        }
        if path.is_dir() {
            collect(&path, files)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    Ok(())
}

/// The module that a file belongs to; `None` for files outside of [`ORDER`], such as those at the crate's root.
fn importer(path: &Path) -> Option<&'static str> {
    let first = path.iter().next()?.to_str()?.trim_end_matches(".rs");
    ORDER.into_iter().find(|module| *module == first)
}

/// Number of modules from the crate's root down to the file's module.
fn depth(path: &Path) -> usize {
    let module_file = path.file_stem().is_some_and(|name| name == "mod");
    path.iter().count() - usize::from(module_file)
}

/// Position of a module in [`ORDER`]. Modules that are not in it have 0: all modules may import them.
fn place(module: &str) -> usize {
    let place = ORDER.iter().position(|known| *known == module);
    place.unwrap_or(0)
}

/// The first names after `crate::`, or after enough `super::`, in code without comments and tests.
fn imported(text: &str, depth: usize) -> Vec<String> {
    let code = text
        .split("#[cfg(test)]\nmod tests {")
        .next()
        .unwrap_or_default();
    let lines = code
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    let code: String = lines.map(|line| format!("{line}\n")).collect();
    let up = "super::".repeat(depth);
    let roots = ["crate::", up.as_str()];
    let after = roots.iter().flat_map(|root| {
        code.match_indices(root)
            .map(|(at, _)| &code[at + root.len()..])
    });
    after.flat_map(first_names).collect()
}

/// The name at the beginning of a path, or all names of a group in braces.
fn first_names(path: &str) -> Vec<String> {
    let name = |text: &str| -> String {
        let is_part = |c: &char| c.is_alphanumeric() || *c == '_';
        text.trim_start().chars().take_while(is_part).collect()
    };
    let Some(group) = path.strip_prefix('{') else {
        return vec![name(path)];
    };
    let mut open = 0;
    let mut names = vec![name(group)];
    for (at, character) in group.char_indices() {
        match character {
            '{' => open += 1,
            '}' if open == 0 => break,
            '}' => open -= 1,
            ',' if open == 0 => names.push(name(&group[at + 1..])),
            _ => {}
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::imported;

    #[test]
    fn finds_what_a_file_imports_however_it_is_written() {
        let text = "\
//! crate::surface in a comment
use crate::{mesh::{ColliderMesh, TriangleId}, pose};
use super::super::skin::cluster;
use super::hit::SurfaceHit;
fn f() -> crate::bounds::Spheres {}
#[cfg(test)]
mod tests {
    use crate::surface::SkinnedSurface;
}
";
        let mut found = imported(text, 2);
        found.sort();
        assert_eq!(found, ["bounds", "mesh", "pose", "skin"]);
    }
}
