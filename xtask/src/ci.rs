//! The steps of `cargo xtask ci`.

use cargo_metadata::Metadata;

use crate::build::beyond_default;
use crate::run::{IGNORE_RUST_VERSION, cargo, cargo_with};
use crate::steps::Step;
use crate::test_run::TestRun;
use crate::{
    arrows, benches, commands, coverage, crates, examples, face, features, golden, modules,
    packages,
};

/// The steps in the order in which they run.
pub(crate) const STEPS: [Step; 14] = [
    Step::runs("tests", tests),
    Step {
        name: "golden",
        runs: |_| golden::runs(),
        rest: golden::rest,
    },
    Step::runs("examples", |_| examples::runs()),
    Step::runs("benches", benches::runs),
    Step::other("coverage", coverage::check),
    Step::other("commands", commands::check),
    Step::other("format", |_| cargo(&["fmt", "--all", "--check"])),
    Step::other("arrows", |metadata| {
        arrows::check(metadata)?;
        modules::check()
    }),
    Step::other("crates", crates::check),
    Step::other("packages", packages::check),
    Step::other("lints", lints),
    Step::other("documentation", documentation),
    Step::other("face", face::check),
    Step::other("features", features::check),
];

/// Runs `cargo test`, the command of the front page; then all tests that it leaves out.
pub(crate) fn tests(metadata: &Metadata) -> Vec<TestRun> {
    vec![TestRun::default(), beyond_default(metadata)]
}

fn lints(_: &Metadata) -> Result<(), String> {
    let lint = ["clippy", "--all-targets", "--quiet", "--workspace"];
    let all = ["--all-features", IGNORE_RUST_VERSION];
    cargo(&[&lint[..], &all, &["--", "-D", "warnings"]].concat())
}

fn documentation(_: &Metadata) -> Result<(), String> {
    let doc = [
        "doc",
        "--workspace",
        "--no-deps",
        "--all-features",
        IGNORE_RUST_VERSION,
        "--quiet",
    ];
    cargo_with(&doc, &[("RUSTDOCFLAGS", "-D warnings")])
}
