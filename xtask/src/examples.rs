//! Runs each example once, briefly, as built for tests.

use std::collections::BTreeMap;

use cargo_metadata::{Message, Metadata};

use crate::battle;
use crate::plan::expand;
use crate::process::{cargo_path, refuses, run};
use crate::workspace::files;

/// Options and files that examples get.
const LINES: &str = include_str!("../examples.txt");

/// Options of the example that also runs on all models of the test data, if there are any.
const ON_MODELS: (&str, [&str; 2]) = ("climbs", ["", "--moving --forecast"]);

/// The environment variable with the folder of the test data.
const DATA: &str = "CLAMBER_TEST_DATA";

/// Query in which a vertex falls through a face, in the format of the query files. It is used without test data.
const QUERY: &str = "\
    1,4,1,1,1,4,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,0,1,1,1,1\n\
    1,4,-1,1,1,4,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,0,1,1,1,1\n";

/// Paths of the examples' binaries, by name.
pub(crate) type Examples = BTreeMap<String, String>;

/// The lines of an example, without its name.
fn lines(name: &str) -> Vec<&'static str> {
    let name = format!("{name} ");
    let lines = LINES.lines().filter_map(|line| line.strip_prefix(&name));
    lines.collect()
}

/// The options that an example gets in the step `examples`.
pub(crate) fn given(name: &str) -> Vec<&'static str> {
    let mut all = [lines(name), battle::given(name)].concat();
    all.retain(|line| !line.contains("=>"));
    all.into_iter().flat_map(str::split_whitespace).collect()
}

/// Builds examples with a selection of cargo.
pub(crate) fn build(metadata: &Metadata, selection: &str) -> Result<Examples, String> {
    let line = format!("build --quiet --message-format json-render-diagnostics {selection}");
    let messages = run(&cargo_path(), &expand(metadata, &line))?;
    let mut examples = Examples::new();
    for message in Message::parse_stream(messages.as_bytes()) {
        let message = message.map_err(|error| format!("cargo's messages: {error}"))?;
        if let Message::CompilerArtifact(artifact) = message
            && artifact.target.is_example()
            && let Some(binary) = artifact.executable
        {
            examples.insert(artifact.target.name, binary.into_string());
        }
    }
    Ok(examples)
}

/// Runs all examples, then the checks of the battle.
pub(crate) fn run_all(metadata: &Metadata) -> Result<(), String> {
    let examples = build(metadata, "{all} --examples")?;
    std::fs::create_dir_all("target").map_err(|error| format!("target: {error}"))?;
    let data = std::env::var(DATA).ok();
    let queries = query_files(data.as_deref())?;
    let given = LINES.lines().filter(|line| !line.starts_with('#'));
    let given = given.map(|line| line.split(' ').next().unwrap_or_default());
    if let Some(name) = given.clone().find(|name| !examples.contains_key(*name)) {
        return Err(format!("xtask/examples.txt: no example is called {name}"));
    }
    for (name, binary) in &examples {
        let mut all = lines(name);
        if data.is_some() && name == ON_MODELS.0 {
            all.extend(ON_MODELS.1);
        }
        if name == "ccd_queries" {
            all.push(&queries);
        } else if all.is_empty() {
            all.push("");
        }
        for line in all {
            match line.split_once("=> ") {
                Some((line, reason)) => refuses(binary, line, reason)?,
                None => run(binary, line).map(drop)?,
            }
        }
    }
    battle::check(&examples)
}

/// The query files of the test data. Without test data, a file with [`QUERY`].
fn query_files(data: Option<&str>) -> Result<String, String> {
    let Some(data) = data else {
        let file = "target/xtask-vertex-face.csv";
        std::fs::write(file, QUERY).map_err(|error| format!("{file}: {error}"))?;
        return Ok(file.into());
    };
    let mut files = files(format!("{data}/ccd").as_str().into())?;
    files.retain(|file| file.extension() == Some("csv"));
    let files = files.iter().map(|file| format!("{data}/ccd/{file} "));
    Ok(files.collect())
}
