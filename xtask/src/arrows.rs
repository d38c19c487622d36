//! Checks which crates may depend on which, keeps each engine to a single crate, and checks the chart of the crates.

use std::collections::BTreeMap;

use cargo_metadata::{DependencyKind, Metadata};

use crate::workspace::{differences, no_faults, read};

/// The workspace crates that each crate may depend on, and the crates that keep engines to themselves.
const ALLOWED: &str = include_str!("../crates.txt");

/// The crate that tests of any crate may use.
const VERIFY: &str = "verify";

/// The only crate of Bevy that crates other than `bevy_clamber` may depend on, for a feature of the same name:
/// components contain their types, and without it no inspector or scene could show or store these.
const REFLECTION: &str = "bevy_reflect";

/// All crates outside the workspace that the core may depend on.
const CORE: &str = "arrayvec bevy_reflect fearless_simd glam libm rayon serde thiserror";

/// The page with the chart, from the root of the repository.
const PAGE: &str = "docs/architecture.md";

/// Crates outside the workspace, each with the only crate of the workspace that may depend on it.
const KEPT_TO: &str = "avian3d:bevy_clamber rapier3d:world parry3d:world ggrs:fight gltf:gltf wgpu:render \
    embedded-graphics:render mcap:record foxglove:record prost:record";

/// The name of a crate of the workspace without `clamber_` in front.
fn short(name: &str) -> &str {
    name.strip_prefix("clamber_").unwrap_or(name)
}

/// Checks all dependencies of the workspace's crates.
pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    let packages = metadata.workspace_packages();
    let has = |list: &str, name: &str| list.split_whitespace().any(|known| known == name);
    let mut wrong = Vec::new();
    for package in &packages {
        let name = short(&package.name);
        let mut lines = ALLOWED.lines().filter_map(|line| line.split_once(':'));
        let Some((_, allowed)) = lines.find(|(known, _)| *known == name) else {
            wrong.push(format!("{name} is not in xtask/crates.txt"));
            continue;
        };
        let (allowed, for_tests) = allowed.split_once('|').unwrap_or((allowed, ""));
        for dependency in &package.dependencies {
            let to = dependency.name.as_str();
            let is_for_tests = dependency.kind == DependencyKind::Development;
            let is_fine = if packages.iter().any(|other| other.name == to) {
                let to = short(to);
                has(allowed, to) || is_for_tests && (to == VERIFY || has(for_tests, to))
            } else {
                let mut kept = KEPT_TO.split([' ', ':']).skip_while(|engine| *engine != to);
                let is_bevy = to.starts_with("bevy") && to != REFLECTION && name != "bevy_clamber";
                let is_core = name == "surface" && !is_for_tests;
                kept.nth(1).is_none_or(|owner| owner == name)
                    && !is_bevy
                    && (!is_core || has(CORE, to))
            };
            if !is_fine {
                wrong.push(format!("{name} must not depend on {to}"));
            }
        }
    }
    no_faults(&wrong, "")
}

/// The crates that each crate depends on. The value is true if only a feature turns the dependency on.
type Needs<'a> = BTreeMap<&'a str, BTreeMap<&'a str, bool>>;

/// Checks that the chart has an arrow for each dependency, dotted if only a feature turns it on. Dependencies of tests
/// are left out, as are arrows that follow from others: if A needs B and B needs C, no arrow leads from A to C.
pub(crate) fn check_chart(metadata: &Metadata) -> Result<(), String> {
    let packages = metadata.workspace_packages();
    let mut needs = Needs::new();
    for package in &packages {
        let needed = needs.entry(short(&package.name)).or_default();
        for it in &package.dependencies {
            let is_member = packages.iter().any(|other| other.name == it.name);
            if is_member && it.kind == DependencyKind::Normal {
                needed.insert(short(&it.name), it.optional);
            }
        }
    }
    let mut due = String::new();
    for (from, needed) in &needs {
        for (to, is_optional) in needed.iter().filter(|(to, _)| !follows(&needs, from, to)) {
            let arrow = if *is_optional { "-.->" } else { "-->" };
            due += &format!("    {from} {arrow} {to}\n");
        }
    }
    let page = read(&metadata.workspace_root.join(PAGE))?;
    let mut drawn: Vec<&str> = page.lines().collect();
    drawn.retain(|line| line.contains("->"));
    let hint = format!(": `+` is missing in {PAGE}, `-` is wrong or follows from other arrows");
    no_faults(&differences(&drawn.join("\n"), &due), &hint)
}

/// True if a crate depends on another one through further crates, independently of features.
fn follows(all: &Needs, from: &str, to: &str) -> bool {
    let mut needs = all[from].iter().filter(|(_, is_optional)| !**is_optional);
    needs.any(|(through, _)| all[through].get(to) == Some(&false) || follows(all, through, to))
}
