//! Checks which crates may depend on which, and keeps each engine to a single crate.

use cargo_metadata::{DependencyKind, Metadata};

/// The workspace crates that each crate may depend on. A crate that is missing here fails the check.
const ALLOWED: [(&str, &[&str]); 19] = [
    ("clamber_surface", &[]),
    ("clamber_world", &["clamber_surface"]),
    ("clamber_mover", &["clamber_surface", "clamber_world"]),
    (
        "clamber_climber",
        &["clamber_surface", "clamber_world", "clamber_mover"],
    ),
    ("clamber_animation", &["clamber_surface"]),
    (
        "clamber_body",
        &[
            "clamber_surface",
            "clamber_world",
            "clamber_climber",
            "clamber_animation",
        ],
    ),
    (
        "clamber_colossus",
        &["clamber_surface", "clamber_world", "clamber_animation"],
    ),
    (
        "clamber_fight",
        &[
            "clamber_surface",
            "clamber_world",
            "clamber_climber",
            "clamber_colossus",
        ],
    ),
    (
        "clamber_navigation",
        &["clamber_surface", "clamber_world", "clamber_climber"],
    ),
    ("clamber_gltf", &["clamber_surface"]),
    ("clamber_render", &["clamber_surface", "clamber_gltf"]),
    (
        "clamber_record",
        &[
            "clamber_surface",
            "clamber_world",
            "clamber_climber",
            "clamber_colossus",
            "clamber_fight",
        ],
    ),
    (
        "clamber",
        &[
            "clamber_surface",
            "clamber_animation",
            "clamber_body",
            "clamber_colossus",
            "clamber_fight",
            "clamber_world",
            "clamber_mover",
            "clamber_climber",
            "clamber_navigation",
            "clamber_gltf",
            "clamber_render",
            "clamber_record",
        ],
    ),
    (
        "clamber_scenes",
        &[
            "clamber_surface",
            "clamber_animation",
            "clamber_world",
            "clamber_climber",
            "clamber_body",
            "clamber_colossus",
            "clamber_fight",
            "clamber_gltf",
            "clamber_navigation",
            "clamber_record",
            "clamber_render",
        ],
    ),
    (
        "bevy_clamber",
        &[
            "clamber_surface",
            "clamber_animation",
            "clamber_body",
            "clamber_colossus",
            "clamber_fight",
            "clamber_world",
            "clamber_climber",
            "clamber_gltf",
        ],
    ),
    (
        "clamber_verify",
        &["clamber_surface", "clamber_world", "clamber_gltf"],
    ),
    (
        "clamber_cli",
        &[
            "clamber_surface",
            "clamber_animation",
            "clamber_body",
            "clamber_climber",
            "clamber_colossus",
            "clamber_gltf",
            "clamber_navigation",
            "clamber_record",
        ],
    ),
    ("clamber_benches", &[]),
    ("xtask", &[]),
];

/// The workspace crates that tests and examples of a crate may use as well, besides `clamber_verify`.
const ALLOWED_FOR_TESTS: [(&str, &str); 23] = [
    ("bevy_clamber", "clamber_scenes"),
    ("clamber", "clamber_scenes"),
    ("clamber_animation", "clamber_gltf"),
    ("clamber_body", "clamber_gltf"),
    ("clamber_body", "clamber_scenes"),
    ("clamber_colossus", "clamber_climber"),
    ("clamber_colossus", "clamber_gltf"),
    ("clamber_benches", "clamber"),
    ("clamber_cli", "clamber_scenes"),
    ("clamber_benches", "clamber_body"),
    ("clamber_benches", "clamber_colossus"),
    ("clamber_benches", "clamber_fight"),
    ("clamber_benches", "clamber_navigation"),
    ("clamber_benches", "clamber_scenes"),
    ("clamber_fight", "clamber_gltf"),
    ("clamber_navigation", "clamber_gltf"),
    ("clamber_scenes", "clamber"),
    ("clamber_verify", "clamber_climber"),
    ("clamber_verify", "clamber_colossus"),
    ("clamber_verify", "clamber_fight"),
    ("clamber_verify", "clamber_scenes"),
    ("clamber_record", "clamber_scenes"),
    ("clamber_render", "clamber_scenes"),
];

/// The only crate of Bevy that crates other than `bevy_clamber` may depend on, for a feature of the same name:
/// components contain their types, and without it no inspector or scene could show or store these.
const REFLECTION: &str = "bevy_reflect";

/// Crates outside the workspace, each with the only crate of the workspace that may depend on it.
const KEPT_TO: [(&str, &str); 10] = [
    ("avian3d", "bevy_clamber"),
    ("rapier3d", "clamber_world"),
    ("parry3d", "clamber_world"),
    ("ggrs", "clamber_fight"),
    ("gltf", "clamber_gltf"),
    ("wgpu", "clamber_render"),
    ("embedded-graphics", "clamber_render"),
    ("mcap", "clamber_record"),
    ("foxglove", "clamber_record"),
    ("prost", "clamber_record"),
];

/// The core and all crates outside the workspace that it may depend on.
const CORE: (&str, &[&str]) = (
    "clamber_surface",
    &[
        "arrayvec",
        REFLECTION,
        "fearless_simd",
        "glam",
        "libm",
        "rayon",
        "serde",
        "thiserror",
    ],
);

pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    let packages = metadata.workspace_packages();
    let mut wrong = Vec::new();
    for package in &packages {
        let name = package.name.as_str();
        let Some((_, allowed)) = ALLOWED.iter().find(|(known, _)| *known == name) else {
            wrong.push(format!("{name} is not in xtask/src/arrows.rs"));
            continue;
        };
        for dependency in &package.dependencies {
            let to = dependency.name.as_str();
            let inside = packages.iter().any(|other| other.name == to);
            let for_tests = dependency.kind == DependencyKind::Development;
            let fine = if inside {
                let tests = to == "clamber_verify" || ALLOWED_FOR_TESTS.contains(&(name, to));
                allowed.contains(&to) || for_tests && tests
            } else {
                if to.starts_with("bevy") && to != REFLECTION && name != "bevy_clamber" {
                    wrong.push(format!("{name} must not know Bevy"));
                }
                let kept = KEPT_TO.iter().find(|(engine, _)| *engine == to);
                let core = name == CORE.0 && !for_tests;
                kept.is_none_or(|(_, owner)| *owner == name) && (!core || CORE.1.contains(&to))
            };
            if !fine {
                wrong.push(format!("{name} must not depend on {to}"));
            }
        }
    }
    if wrong.is_empty() {
        Ok(())
    } else {
        Err(wrong.join("; "))
    }
}
