//! The parts of a package that can be run separately.

use std::fmt;

use cargo_metadata::{Package, Target};

/// The way in which a target runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// Unit tests of a library.
    Library,
    /// Unit tests of a program.
    Program,
    /// Programs in the documentation of a library.
    Documentation,
    Test,
    /// A bench, in full or briefly.
    Bench,
    /// An example, run as a program.
    Example,
    /// A program, started by `cargo run`. No step is required to run it.
    Start,
}

/// A target of a package, run in one way.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Part {
    pub(crate) package: String,
    pub(crate) kind: Kind,
    pub(crate) name: String,
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { package, name, .. } = self;
        match self.kind {
            Kind::Library => write!(f, "the library's unit tests of {package}"),
            Kind::Program => write!(f, "the unit tests of the program `{name}` of {package}"),
            Kind::Documentation => write!(f, "the documentation's tests of {package}"),
            Kind::Test => write!(f, "the test `{name}` of {package}"),
            Kind::Bench => write!(f, "the bench `{name}` of {package}"),
            Kind::Example => write!(f, "the example `{name}` of {package}"),
            Kind::Start => write!(f, "the program `{name}` of {package}"),
        }
    }
}

/// The parts of a package, each with its target.
pub(crate) fn parts(package: &Package) -> Vec<(Part, &Target)> {
    let mut parts = Vec::new();
    for target in &package.targets {
        for kind in kinds(target) {
            let part = Part {
                package: package.name.to_string(),
                kind,
                name: target.name.clone(),
            };
            parts.push((part, target));
        }
    }
    parts
}

/// The ways in which a target can run. Build scripts have none: each build runs them.
fn kinds(target: &Target) -> Vec<Kind> {
    let possible = [
        (Kind::Documentation, target.doctest),
        (Kind::Program, target.is_bin() && target.test),
        (Kind::Start, target.is_bin()),
        (Kind::Test, target.is_test()),
        (Kind::Bench, target.is_bench()),
        (Kind::Example, target.is_example()),
        (Kind::Library, is_library(target) && target.test),
    ];
    let kinds = possible.into_iter().filter(|(_, is_one)| *is_one);
    kinds.map(|(kind, _)| kind).collect()
}

/// True for a library of any kind.
fn is_library(target: &Target) -> bool {
    let other = target.is_bin() || target.is_test() || target.is_bench() || target.is_example();
    !other && !target.is_custom_build()
}
