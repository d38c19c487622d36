//! Finds marks of tests in source files, and of programs in the documentation that are not compiled.

/// A mark of a test or a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mark {
    /// A function is a test.
    Test,
    /// A test is ignored, in some builds at least.
    Ignored,
    /// A program in the documentation is not compiled.
    NotCompiled,
}

/// The marks of a text, with their line numbers from 1.
pub(super) fn marks(text: &str) -> Vec<(usize, Mark)> {
    let mut marks = Vec::new();
    let mut start = 0;
    for (index, line) in text.lines().enumerate() {
        let code = line.trim_start();
        let comment = code
            .strip_prefix("///")
            .or_else(|| code.strip_prefix("//!"));
        let documentation = comment.unwrap_or(code).trim_start();
        if let Some(language) = documentation.strip_prefix("```") {
            let mut words = language.split(',').map(str::trim);
            if words.any(|word| word == "ignore" || word == "rs") {
                marks.push((index + 1, Mark::NotCompiled));
            }
        } else if !code.starts_with("//") {
            // An attribute may continue on further lines.
            let opened = code.match_indices("#[").map(|(at, _)| at);
            for at in opened {
                let from = start + (line.len() - code.len()) + at + 2;
                let names = names(&text[from..]);
                if names.contains(&"test") {
                    marks.push((index + 1, Mark::Test));
                }
                if names.contains(&"ignore") {
                    marks.push((index + 1, Mark::Ignored));
                }
            }
        }
        start += line.len() + 1;
    }
    marks
}

/// The names of the attributes that an attribute sets: its own name, or the names after the condition of a `cfg_attr`.
fn names(attribute: &str) -> Vec<&str> {
    let inside = attribute.trim_start().strip_prefix("cfg_attr");
    match inside.and_then(|inside| inside.trim_start().strip_prefix('(')) {
        Some(inside) => parts(inside).into_iter().skip(1).map(name).collect(),
        None => vec![name(attribute)],
    }
}

/// A text up to its closing bracket, split at the commas of the same depth.
fn parts(text: &str) -> Vec<&str> {
    let (mut depth, mut quoted, mut start) = (0, false, 0);
    let mut parts = Vec::new();
    for (at, character) in text.char_indices() {
        match character {
            '"' => quoted = !quoted,
            _ if quoted => {}
            '(' | '[' => depth += 1,
            ')' | ']' if depth == 0 => {
                parts.push(&text[start..at]);
                break;
            }
            ')' | ']' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts
}

/// The name at the beginning of an attribute.
fn name(attribute: &str) -> &str {
    let attribute = attribute.trim_start();
    let end = attribute.find(|c: char| !c.is_alphanumeric() && c != '_' && c != ':');
    &attribute[..end.unwrap_or(attribute.len())]
}

#[cfg(test)]
mod tests {
    use super::Mark::{Ignored, NotCompiled, Test};
    use super::marks;

    #[test]
    fn finds_ignored_tests_however_they_are_marked() {
        // `@` replaces the beginning of an attribute. Otherwise the check would find the marks below in this file.
        let text = "\
@test]
@ignore]
fn plain() {}
    @ignore = \"minutes, a [lot]\"]
@cfg_attr(debug_assertions, ignore)]
@cfg_attr(
    any(debug_assertions, windows),
    ignore = \"slow\"
)]
// @ignore] in a comment
@cfg_attr(ignore, allow(dead_code))]
@ignored_by_others]
";
        let found = marks(&text.replace('@', "#["));
        let expected = [
            (1, Test),
            (2, Ignored),
            (4, Ignored),
            (5, Ignored),
            (6, Ignored),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn finds_programs_that_are_not_compiled() {
        let text = "/// '''ignore\n//! '''rust,ignore\n'''rust, ignore\n'''no_run\n'''rs\nlet a = \"'''ignore\";\n";
        let found = marks(&text.replace('\'', "`"));
        assert_eq!(found, [1, 2, 3, 5].map(|line| (line, NotCompiled)));
    }
}
