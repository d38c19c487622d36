//! Runs each example once, briefly, as built for tests.

use std::path::PathBuf;

use crate::run::program;
use crate::test_run::{Targets, TestRun};
use crate::{battle, build};

/// Options and files that examples get. Examples run in the order of their names. An example that is listed twice runs
/// twice. An example that is missing here runs once, without options.
const ARGUMENTS: [(&str, &[&str]); 9] = [
    (
        "battle",
        &[
            "--story",
            "ride",
            "--creature",
            "assets/colossus.glb",
            "--height",
            "10",
            "--seconds",
            "3",
            "--out",
            "target/xtask-brief",
        ],
    ),
    (
        "battle",
        &[
            "--fights",
            "1",
            "--seed",
            "1",
            "--seconds",
            "2",
            "--out",
            "target/xtask-brief",
        ],
    ),
    ("climbs", &["--height", "40", "assets/colossus.glb"]),
    ("duel", &["--joins", "10", "--record", DUEL]),
    // `duel` records this file.
    ("replay", &[DUEL, "--from", "60"]),
    ("rides", &["assets/colossus.glb", "--seconds", "10"]),
    ("seeds", &["target/fuzz-seeds"]),
    ("soak", &["--minutes", "0.2", "--out", "target/soak-brief"]),
    ("soak", &["--case", "life", "--minutes", "10"]),
];

/// Recording of `duel`, which `replay` reads.
const DUEL: &str = "target/xtask-duel.mcap";

/// The example that also runs on all models of the test data, if there are any.
const ON_MODELS: &str = "climbs";

/// The environment variable with the folder of the test data.
const DATA: &str = "CLAMBER_TEST_DATA";

/// Query in which a vertex falls through a face, in the format of the query files. It is used without test data.
const QUERY: &str = "\
    1,4,1,1,1,4,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,0,1,1,1,1\n\
    1,4,-1,1,1,4,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,0,1,1,1,1\n";

/// All examples of the workspace, as one run.
pub(crate) fn runs() -> Vec<TestRun> {
    vec![TestRun {
        given,
        perform: |_, run| all(run),
        ..build::selection().of(vec![Targets::Examples])
    }]
}

/// The options among an example's arguments, from here and from [`battle::given`].
fn given(name: &str) -> Vec<&'static str> {
    let listed = ARGUMENTS.iter().filter(|(needing, _)| *needing == name);
    let mut words: Vec<&str> = listed
        .flat_map(|(_, arguments)| *arguments)
        .copied()
        .collect();
    words.extend(battle::given(name));
    words.retain(|word| word.starts_with("--"));
    words
}

fn all(run: &TestRun) -> Result<(), String> {
    let folder = "target";
    std::fs::create_dir_all(folder).map_err(|error| format!("{folder}: {error}"))?;
    let queries = query_files()?;
    let examples = build::examples(run)?;
    for (name, binary) in &examples {
        let needed = ARGUMENTS.iter().filter(|(needing, _)| needing == name);
        let mut given: Vec<&[&str]> = needed.map(|(_, arguments)| *arguments).collect();
        if given.is_empty() {
            given.push(&[]);
        }
        if name == ON_MODELS && std::env::var_os(DATA).is_some() {
            given.extend([&[][..], &["--moving", "--forecast"]]);
        }
        let files = queries.iter().map(String::as_str);
        let files: Vec<&str> = files.filter(|_| name == "ccd_queries").collect();
        for arguments in given {
            program(binary, &[arguments, &files].concat())?;
        }
    }
    battle::check(&examples)
}

/// The query files of the test data. Without test data, a file with [`QUERY`].
fn query_files() -> Result<Vec<String>, String> {
    let Some(data) = std::env::var_os(DATA) else {
        let file = "target/xtask-vertex-face.csv";
        std::fs::write(file, QUERY).map_err(|error| format!("{file}: {error}"))?;
        return Ok(vec![file.into()]);
    };
    let (mut files, mut folders) = (Vec::new(), vec![PathBuf::from(data).join("ccd")]);
    while let Some(folder) = folders.pop() {
        let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
        for entry in std::fs::read_dir(&folder).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "csv") {
                files.push(path.to_string_lossy().into_owned());
            }
        }
    }
    files.sort();
    Ok(files)
}
