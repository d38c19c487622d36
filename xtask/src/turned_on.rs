//! Finds the features that are on in one call of cargo. Cargo builds each package once per call, with all features that
//! any of the built packages asks for.

use std::collections::BTreeSet;

use cargo_metadata::{DependencyKind, Metadata, Package};

/// The features of the workspace's packages, as `package/feature`, that are on when the tests or examples of the
/// selected packages are built. They are the named features, the default ones, those that other packages of the
/// workspace ask for, and all features that these imply.
pub(crate) fn turned_on(
    workspace: &Metadata,
    selected: &[&Package],
    named: &[String],
) -> BTreeSet<String> {
    let packages = workspace.workspace_packages();
    let names = selected.iter().map(|package| package.name.to_string());
    let mut search = Search {
        selected: names.clone().collect(),
        built: BTreeSet::new(),
        on: named.iter().cloned().collect(),
    };
    for name in names {
        search.build(&name, true);
    }
    // Repeats until no feature or package is added.
    loop {
        let before = (search.built.len(), search.on.len());
        for package in &packages {
            search.visit(package);
        }
        if before == (search.built.len(), search.on.len()) {
            return search.on;
        }
    }
}

struct Search {
    /// The packages whose tests are built, together with the dependencies of these tests.
    selected: BTreeSet<String>,
    built: BTreeSet<String>,
    /// Features, and optional dependencies as `package/dep:dependency`.
    on: BTreeSet<String>,
}

impl Search {
    fn build(&mut self, package: &str, with_default: bool) {
        self.built.insert(package.to_owned());
        if with_default {
            self.on.insert(format!("{package}/default"));
        }
    }

    /// Adds the features and dependencies that a package turns on, if it is built.
    fn visit(&mut self, package: &Package) {
        let name = package.name.as_str();
        if !self.built.contains(name) {
            return;
        }
        for (feature, implied) in &package.features {
            if self.on.contains(&format!("{name}/{feature}")) {
                for implied in implied {
                    self.imply(name, implied);
                }
            }
        }
        for dependency in &package.dependencies {
            let to = dependency.name.as_str();
            let is_for_tests = dependency.kind == DependencyKind::Development;
            let is_used = !dependency.optional || self.on.contains(&format!("{name}/dep:{to}"));
            if is_used && (!is_for_tests || self.selected.contains(name)) {
                self.build(to, dependency.uses_default_features);
                let asked = dependency.features.iter();
                self.on
                    .extend(asked.map(|feature| format!("{to}/{feature}")));
            }
        }
    }

    /// Adds what a feature implies: a feature of the same package, an optional dependency, or a feature of a
    /// dependency.
    fn imply(&mut self, package: &str, implied: &str) {
        match implied.split_once('/') {
            None => {
                self.on.insert(format!("{package}/{implied}"));
            }
            Some((to, feature)) => match to.strip_suffix('?') {
                // Applies only if the dependency is on for another reason.
                Some(to) if !self.on.contains(&format!("{package}/dep:{to}")) => {}
                weak => {
                    let to = weak.unwrap_or(to);
                    self.on.insert(format!("{package}/dep:{to}"));
                    self.on.insert(format!("{to}/{feature}"));
                }
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::turned_on;
    use crate::workspaces;

    /// The features that are on in this workspace's tests of some packages, with these features named.
    fn on(packages: &[&str], named: &[&str]) -> impl Fn(&str) -> bool {
        let workspace = workspaces::main().unwrap();
        let members = workspace.workspace_packages();
        let is_selected = |name: &str| packages.contains(&name);
        let selected: Vec<_> = members
            .into_iter()
            .filter(|package| is_selected(&package.name))
            .collect();
        let named: Vec<String> = named.iter().map(|&name| name.to_owned()).collect();
        let on = turned_on(&workspace, &selected, &named);
        move |feature| on.contains(feature)
    }

    #[test]
    fn a_feature_turns_on_what_it_implies() {
        let on = on(&["clamber"], &["clamber/ggrs"]);
        assert!(on("clamber/gltf"), "by default");
        assert!(on("clamber/fight") && on("clamber/colossus"));
        assert!(on("clamber_fight/ggrs"), "of a dependency");
        assert!(!on("clamber/deterministic") && !on("clamber/render"));
    }

    #[test]
    fn a_dependency_turns_on_what_it_asks_for() {
        // The manifest of `clamber` asks for `clamber_climber/serde` in its tests. No dependency of the mover's tests
        // asks for it.
        assert!(on(&["clamber"], &[])("clamber_climber/serde"));
        assert!(!on(&["clamber_mover"], &[])("clamber_climber/serde"));
    }

    #[test]
    fn a_weak_feature_waits_for_its_dependency() {
        let weak = "clamber_render/gltf";
        assert!(!on(&["clamber"], &["clamber/gltf"])(weak));
        assert!(on(&["clamber"], &["clamber/gltf", "clamber/render"])(weak));
    }
}
