//! Finds the commands of the pages: lines of blocks that are marked `sh`, `bash` or `console`, indented lines, and
//! words in backticks. The last two must begin with a known program.

use std::collections::BTreeMap;

use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};

use crate::files::{files, read};

/// Programs with which a command may begin. A program that is missing here is not checked.
const PROGRAMS: [&str; 13] = [
    "apt-get", "blender", "cargo", "clamber", "ffmpeg", "node", "npm", "npx", "pip", "python",
    "python3", "rerun", "rustup",
];

/// Beginning of the paths of scripts, which are commands as well.
const SCRIPTS: &str = ".ci/";

/// Pages without checks: the list itself, and the changelog, which describes earlier versions.
const LEFT_OUT: [&str; 2] = [super::LIST, "CHANGELOG.md"];

/// Commands, each with the pages that have it.
pub(super) type Commands = BTreeMap<String, Vec<Utf8PathBuf>>;

/// The commands of all pages, and the pages that have commands but no link to the list.
pub(super) fn read_all(root: &Utf8Path) -> Result<(Commands, Vec<Utf8PathBuf>), String> {
    let (mut all, mut without_link) = (Commands::new(), Vec::new());
    for page in files(root)? {
        if page.extension() != Some("md") || LEFT_OUT.contains(&page.as_str()) {
            continue;
        }
        let text = read(root, &page)?;
        let found = commands(&text);
        if !found.is_empty() && !text.contains("commands.md") {
            without_link.push(page.clone());
        }
        for command in found {
            let pages = all.entry(command).or_default();
            if pages.last() != Some(&page) {
                pages.push(page.clone());
            }
        }
    }
    Ok((all, without_link))
}

/// The commands of a page, in order.
pub(super) fn commands(page: &str) -> Vec<String> {
    let mut commands = Vec::new();
    let (mut block, mut paragraph) = (None::<(&str, String)>, String::new());
    for line in page.lines() {
        let fence = line.trim_start().strip_prefix("```");
        match (&mut block, fence) {
            (None, Some(language)) => block = Some((language.trim(), String::new())),
            (Some((language, lines)), Some(_)) => {
                if matches!(*language, "sh" | "bash" | "console") {
                    commands.extend(lines_of(lines));
                }
                block = None;
            }
            (Some((_, lines)), None) => *lines += &format!("{line}\n"),
            (None, None) if line.starts_with("    ") && is_command(line.trim()) => {
                commands.extend(lines_of(line));
            }
            (None, None) if !line.trim().is_empty() => paragraph += &format!("{line}\n"),
            _ => {}
        }
        if fence.is_some() || line.trim().is_empty() {
            commands.extend(in_backticks(&std::mem::take(&mut paragraph)));
        }
    }
    commands.extend(in_backticks(&paragraph));
    commands
}

/// The lines of a block, without comments. A line that is only a `cd` is put in front of each following line.
fn lines_of(block: &str) -> Vec<String> {
    let joined = block.replace("\\\n", " ");
    let mut folder = String::new();
    let mut commands = Vec::new();
    for line in joined.lines() {
        let line = line.split(" #").next().unwrap_or_default();
        let command = words(line.trim().trim_start_matches("$ "));
        if command.starts_with("cd ") && !command.contains("&&") {
            folder = format!("{command} && ");
        } else if !command.is_empty() && !command.starts_with('#') {
            commands.push(format!("{folder}{command}"));
        }
    }
    commands
}

/// The commands among the words in backticks of a paragraph or table. The words may continue on the next line.
fn in_backticks(paragraph: &str) -> Vec<String> {
    let mut rest = paragraph;
    let mut commands = Vec::new();
    while let Some(at) = rest.find('`') {
        let after = rest[at..].trim_start_matches('`');
        let ticks = &rest[at..rest.len() - after.len()];
        let Some(end) = after.find(ticks) else {
            break;
        };
        let command = words(&after[..end].replace("\\|", "|"));
        if is_command(&command) {
            commands.push(command);
        }
        rest = after[end..].trim_start_matches('`');
    }
    commands
}

/// The words of a text, separated by one blank.
fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// True if the text, after variables that are set, begins with a known program and has further words.
fn is_command(text: &str) -> bool {
    let is_set = |word: &&str| {
        let name = word.split_once('=').map(|(name, _)| name);
        name.is_some_and(|name| name.chars().all(|c| c.is_ascii_uppercase() || c == '_'))
    };
    let mut words = text.split_whitespace().skip_while(is_set);
    let program = words.next().unwrap_or_default();
    program.starts_with(SCRIPTS) || PROGRAMS.contains(&program) && words.next().is_some()
}

#[cfg(test)]
mod tests {
    use super::commands;

    #[test]
    fn finds_commands_wherever_they_stand() {
        let page = "\
Run `cargo test`, or `cargo
bench --bench tick`, in `cargo`. A `clamber::body` and a `Body` are none.

| `A=1 cargo run \\| grep x` | .ci/none |

'''sh
# a comment
$ cargo run --example battle -- \\
    --seconds 1   # and this
cd examples/bevy
cargo run
'''

'''rust
let a = 1; // `cargo no`
'''

    cargo xtask soak
";
        let found = commands(&page.replace('\'', "`"));
        let expected = [
            "cargo test",
            "cargo bench --bench tick",
            "A=1 cargo run | grep x",
            "cargo run --example battle -- --seconds 1",
            "cd examples/bevy && cargo run",
            "cargo xtask soak",
        ];
        assert_eq!(found, expected);
    }
}
