//! Finds the tests that run the program `clamber`: no step starts it itself.

use cargo_metadata::Metadata;

use crate::files::read;
use crate::parts::{Kind, Part, parts};

/// The package of the program.
pub(super) const PACKAGE: &str = "clamber_cli";

/// The tests that start the program, with their texts.
pub(super) fn tests(main: &Metadata) -> Result<Vec<(Part, String)>, String> {
    let packages = main.workspace_packages().into_iter();
    let parts = packages
        .filter(|package| package.name == PACKAGE)
        .flat_map(parts);
    let mut tests = Vec::new();
    for (part, target) in parts.filter(|(part, _)| part.kind == Kind::Test) {
        let text = read(&main.workspace_root, &target.src_path)?;
        if text.contains("CARGO_BIN_EXE_") {
            tests.push((part, text));
        }
    }
    Ok(tests)
}

/// The test whose text has the first of these words, and all options among them, as strings.
pub(super) fn test<'a>(tests: &'a [(Part, String)], words: &[&str]) -> Option<&'a Part> {
    let is_option = |word: &str| word.starts_with("--");
    let has_all = |text: &str| {
        let mut words = words.iter().enumerate();
        words.all(|(at, word)| at > 0 && !is_option(word) || text.contains(&format!("\"{word}\"")))
    };
    let mut tests = tests.iter();
    tests.find(|(_, text)| has_all(text)).map(|(test, _)| test)
}
