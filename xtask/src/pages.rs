//! Finds the commands of the documentation: lines of blocks that are marked `sh`, `bash` or `console`, and indented
//! lines and words in backticks that begin with a known program. Pages are all Markdown files but the changelog, which
//! describes earlier versions.

use std::collections::BTreeMap;

use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};

use crate::workspace::{files, read};

/// The list of commands that no step runs, from the root of the repository.
pub(crate) const LIST: &str = "docs/commands.md";

/// Programs with which a command may begin. A program that is missing here is not checked.
const PROGRAMS: &str =
    "apt-get blender cargo clamber ffmpeg node npm npx pip python python3 rerun rustup";

/// Beginning of the paths of scripts, which are commands as well.
const SCRIPTS: &str = ".ci/";

/// Commands, each with the first page that has it.
pub(crate) type Commands = BTreeMap<String, Utf8PathBuf>;

/// The commands of all pages, and the pages that have commands but no link to the list.
pub(crate) fn read_all(root: &Utf8Path) -> Result<(Commands, Vec<Utf8PathBuf>), String> {
    let (mut all, mut without_link) = (Commands::new(), Vec::new());
    for page in files(root)? {
        if page.extension() != Some("md") || page == LIST || page == "CHANGELOG.md" {
            continue;
        }
        let text = read(&root.join(&page))?;
        let found = commands(&text);
        if !found.is_empty() && !text.contains("commands.md") {
            without_link.push(page.clone());
        }
        for command in found {
            all.entry(command).or_insert_with(|| page.clone());
        }
    }
    Ok((all, without_link))
}

/// The reason of each command in the list, which is a table with two columns.
pub(crate) fn reasons(root: &Utf8Path) -> Result<BTreeMap<String, String>, String> {
    let list = read(&root.join(LIST))?;
    let rows = list.lines().filter_map(|line| {
        let cells = line.strip_prefix("| `")?.strip_suffix(" |")?;
        let (command, reason) = cells.split_once("` | ")?;
        Some((command.replace("\\|", "|"), reason.trim().to_owned()))
    });
    Ok(rows.collect())
}

/// The commands of a page.
pub(crate) fn commands(page: &str) -> Vec<String> {
    let mut commands = Vec::new();
    for (index, text) in page.split("```").enumerate() {
        if index % 2 == 1 {
            let (language, lines) = text.split_once('\n').unwrap_or_default();
            if matches!(language.trim(), "sh" | "bash" | "console") {
                commands.extend(lines_of(lines));
            }
            continue;
        }
        let indented = text
            .lines()
            .filter(|line| line.starts_with("    "))
            .map(one_line);
        commands.extend(indented.filter(|line| is_command(line)));
        for paragraph in text.split("\n\n") {
            let code = paragraph.split('`').skip(1).step_by(2);
            let code = code.map(|text| one_line(&text.replace("\\|", "|")));
            commands.extend(code.filter(|text| is_command(text)));
        }
    }
    commands
}

/// The lines of a block, without comments. A line that is only a `cd` is put in front of each following line.
fn lines_of(block: &str) -> Vec<String> {
    let (mut folder, mut commands) = (String::new(), Vec::new());
    for line in block.replace("\\\n", " ").lines() {
        let line = line.split(" #").next().unwrap_or_default();
        let command = one_line(line.trim().trim_start_matches("$ "));
        if command.starts_with("cd ") && !command.contains("&&") {
            folder = format!("{command} && ");
        } else if !command.is_empty() && !command.starts_with('#') {
            commands.push(format!("{folder}{command}"));
        }
    }
    commands
}

/// The words of a text, separated by one blank.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// True if the text, after variables that are set, begins with a known program and has further words.
fn is_command(text: &str) -> bool {
    let is_set = |word: &&str| word.contains('=') && word.starts_with(char::is_uppercase);
    let mut words = text.split_whitespace().skip_while(is_set);
    let program = words.next().unwrap_or_default();
    let is_known = PROGRAMS.split_whitespace().any(|known| known == program);
    program.starts_with(SCRIPTS) || is_known && words.next().is_some()
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
        let due = [
            "cargo test",
            "cargo bench --bench tick",
            "A=1 cargo run | grep x",
            "cargo run --example battle -- --seconds 1",
            "cd examples/bevy && cargo run",
            "cargo xtask soak",
        ];
        assert_eq!(commands(&page.replace('\'', "`")), due);
    }
}
