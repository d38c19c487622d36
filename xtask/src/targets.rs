//! Selects targets of packages as cargo does.

use cargo_metadata::Target;

use crate::parts::{Kind, Part};

/// A selection of targets.
#[derive(Clone, Debug)]
pub(crate) enum Targets {
    /// The selection of `cargo test` without options: libraries, programs, tests and documentation.
    Usual,
    /// `--lib`.
    Library,
    /// `--doc`.
    Documentation,
    /// `--tests`: all targets with a harness.
    Tests,
    /// `--all-targets`: tests as with `Tests`; examples are built but not run.
    All,
    Test(String),
    Bench(String),
    /// `--benches`.
    Benches,
    Example(String),
    /// `--examples`.
    Examples,
    /// The package's program, for `cargo run`.
    Program,
}

impl Targets {
    /// The options with which cargo selects these targets.
    pub(crate) fn options(&self) -> Vec<&str> {
        match self {
            Self::Usual | Self::Program => vec![],
            Self::Library => vec!["--lib"],
            Self::Documentation => vec!["--doc"],
            Self::Tests => vec!["--tests"],
            Self::All => vec!["--all-targets"],
            Self::Test(name) => vec!["--test", name],
            Self::Bench(name) => vec!["--bench", name],
            Self::Benches => vec!["--benches"],
            Self::Example(name) => vec!["--example", name],
            Self::Examples => vec!["--examples"],
        }
    }

    /// True if the selection contains this part of a target.
    pub(crate) fn have(&self, part: &Part, target: &Target) -> bool {
        let is_named = |name: &str| part.name == name;
        match (self, part.kind) {
            (Self::Usual | Self::Tests | Self::All, Kind::Library | Kind::Program | Kind::Test) => {
                target.test
            }
            (Self::Usual | Self::Documentation, Kind::Documentation)
            | (Self::Library, Kind::Library)
            | (Self::Benches, Kind::Bench)
            | (Self::Examples, Kind::Example)
            | (Self::Program, Kind::Start) => true,
            (Self::Test(name), Kind::Test)
            | (Self::Bench(name), Kind::Bench)
            | (Self::Example(name), Kind::Example) => is_named(name),
            _ => false,
        }
    }
}
