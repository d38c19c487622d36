//! Checks that a step of `cargo xtask ci` or `cargo xtask nightly` runs each command in the documentation, or that
//! `docs/commands.md` gives the reason why not.
//!
//! Pages are all Markdown files except the list itself and the changelog. A command is a line of a block that is marked
//! `sh`, `bash` or `console`, or words in backticks that begin with a known program. A step runs a command if it runs
//! the same targets, with all features that the command names, and includes ignored tests if the command does. Programs
//! must get the same options. The comparison ignores:
//!
//! - the profile: each step chooses its own, mostly the profile of tests;
//! - the values of a program's options, such as of `--seconds`, and the program's files: a step has to be brief;
//! - the names of single tests or benches in a target, and `--nocapture`; a test's name must stand in the sources;
//! - `CLAMBER_TEST_DATA`, which is the folder of test files. Any other variable makes a different command.
//!
//! A step runs `clamber` if a test that starts the program has the same words and options in its text. No step runs a
//! command with a pipe, or a command of any other program.
//!
//! For each command, the packages, targets, features and steps that it names must exist.

mod asked;
mod cli;
mod list;
mod pages;
mod path;
mod who;

use cargo_metadata::Metadata;
use list::Row;
use who::Who;

/// The list of commands, from the root of the repository.
const LIST: &str = "docs/commands.md";

/// Checks that the stored list is up to date and has a step or a reason for each command.
pub(crate) fn check(main: &Metadata) -> Result<(), String> {
    let stored = std::fs::read_to_string(main.workspace_root.join(LIST)).unwrap_or_default();
    let stored = stored.replace("\r\n", "\n");
    let (page, wrong) = write(main, &stored)?;
    for line in &wrong {
        eprintln!("   {line}");
    }
    if !wrong.is_empty() {
        Err(format!(
            "faults in the documentation's commands: {}",
            wrong.len()
        ))
    } else if page != stored {
        Err(format!(
            "{LIST} is out of date: `cargo xtask commands` writes it"
        ))
    } else {
        Ok(())
    }
}

/// Stores the list. It keeps the stored reasons and leaves missing reasons empty.
pub(crate) fn store(main: &Metadata) -> Result<(), String> {
    let path = main.workspace_root.join(LIST);
    let (page, _) = write(main, &std::fs::read_to_string(&path).unwrap_or_default())?;
    let (page, wrong) = write(main, &page)?;
    std::fs::write(&path, page).map_err(|error| format!("{LIST}: {error}"))?;
    println!("   {LIST}");
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(wrong.join("\n")),
    }
}

/// The list as it should be, with the stored reasons; and the faults.
fn write(main: &Metadata, stored: &str) -> Result<(String, Vec<String>), String> {
    let who = Who::new(main)?;
    let mut reasons = list::reasons(stored);
    let (commands, without_link) = pages::read_all(&main.workspace_root)?;
    let (mut run, mut not_run, mut wrong) = (Vec::new(), Vec::new(), Vec::new());
    for (command, pages) in &commands {
        let place = || {
            pages
                .iter()
                .map(|page| page.as_str())
                .collect::<Vec<_>>()
                .join(", ")
        };
        let reason = reasons.remove(command).unwrap_or_default();
        let row = |says| Row {
            command,
            pages,
            says,
        };
        match who.runs(command, pages) {
            Ok(Some(step)) => {
                run.push(row(step));
                continue;
            }
            Ok(None) => {}
            Err(why) => {
                wrong.push(format!("{}: `{command}`: {why}", place()));
                if reason.is_empty() {
                    continue;
                }
            }
        }
        if reason.is_empty() {
            wrong.push(format!(
                "{}: no step runs `{command}`: have one run it, or give the reason in {LIST}, into which \
                 `cargo xtask commands` writes it",
                place()
            ));
        }
        not_run.push(row(reason));
    }
    for command in reasons.keys() {
        wrong.push(format!(
            "{LIST}: no page has `{command}`: `cargo xtask commands` removes it"
        ));
    }
    for page in without_link {
        wrong.push(format!("{page} has commands, and no link to {LIST}"));
    }
    Ok((list::write(&run, &not_run), wrong))
}

#[cfg(test)]
mod tests;
