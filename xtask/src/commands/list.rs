//! Writes and reads the list of commands. Its first table has the commands that a step runs, and is generated from the
//! pages and the steps. Its second table has the commands that no step runs, with reasons that are written by hand.

use std::collections::BTreeMap;

use cargo_metadata::camino::Utf8PathBuf;

/// The beginning of the page.
const HEAD: &str = "\
# Commands

Which commands of the documentation are run by `cargo xtask ci` or `cargo xtask nightly`, and which are not, and why.
`cargo xtask ci` fails if a page has a command that is missing here, or one that names a package, a target, a feature or
a step that does not exist. `cargo xtask commands` writes this page; only the reasons are written by hand.

";

/// The beginning of the first table.
const RUN: &str = "\
## Run

The step runs the same target, with all features that the command names; a program with the same options. Their values
are others, so that it takes less time, and builds are those of tests.

| command | page | task: step |
|---|---|---|
";

/// The beginning of the second table, which [`reasons`] reads.
const NOT_RUN: &str = "\
## Not run

| command | page | why |
|---|---|---|
";

/// A command, the pages that have it, and the step that runs it or the reason why no step does.
pub(super) struct Row<'a> {
    pub(super) command: &'a str,
    pub(super) pages: &'a [Utf8PathBuf],
    pub(super) says: String,
}

/// The text of the whole page.
pub(super) fn write(run: &[Row], not_run: &[Row]) -> String {
    let table = |rows: &[Row]| rows.iter().map(line).collect::<String>();
    format!("{HEAD}{RUN}{}\n{NOT_RUN}{}", table(run), table(not_run))
}

/// The reasons in the page, by command.
pub(super) fn reasons(page: &str) -> BTreeMap<String, String> {
    let table = page.split(NOT_RUN).nth(1).unwrap_or_default();
    let rows = table.lines().filter_map(|line| {
        let cells = line.strip_prefix("| `")?.strip_suffix(" |")?;
        let (command, rest) = cells.split_once("` | ")?;
        let (_, reason) = rest.split_once(" | ")?;
        Some((command.replace("\\|", "|"), reason.trim().to_owned()))
    });
    rows.collect()
}

fn line(row: &Row) -> String {
    let links = row.pages.iter().map(|page| {
        let link = match page.strip_prefix("docs") {
            Ok(beside) => beside.to_string(),
            Err(_) => format!("../{page}"),
        };
        format!("[{page}]({link})")
    });
    let links = links.collect::<Vec<_>>().join(", ");
    let command = row.command.replace('|', "\\|");
    format!("| `{command}` | {links} | {} |\n", row.says)
}

#[cfg(test)]
mod tests {
    use super::{Row, reasons, write};

    #[test]
    fn reasons_are_read_as_they_were_written() {
        let pages = ["README.md".into(), "docs/measured.md".into()];
        let row = |command, says: &str| Row {
            command,
            pages: &pages,
            says: says.into(),
        };
        let run = [row("cargo test", "`ci`: tests")];
        let not_run = [row("cargo run | grep a", "a pipe"), row("cargo new", "")];
        let page = write(&run, &not_run);
        assert!(page.contains("[docs/measured.md](measured.md)"), "{page}");
        let read: Vec<_> = reasons(&page).into_iter().collect();
        let expected = [("cargo new", ""), ("cargo run | grep a", "a pipe")];
        assert_eq!(
            read,
            expected.map(|(command, why)| (command.into(), why.into()))
        );
    }
}
