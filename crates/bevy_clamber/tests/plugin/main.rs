//! The plugins in apps. One program for all of them: each one more would be built and linked with all of Bevy.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

#[cfg(all(
    feature = "diagnostics",
    feature = "fight",
    feature = "gizmos",
    feature = "input",
    feature = "picking"
))]
mod ambiguities;
mod anchors;
#[cfg(feature = "fight")]
mod arena;
mod assets;
mod camera;
mod climbers;
#[cfg(all(feature = "avian", feature = "rapier"))]
mod climbers_on_engines;
#[cfg(feature = "colossus")]
mod colossus;
mod common;
#[cfg(feature = "input")]
mod controls;
#[cfg(feature = "clamber_gltf")]
mod creatures;
#[cfg(feature = "rapier")]
mod debris;
#[cfg(feature = "diagnostics")]
mod diagnostics;
mod drawn;
#[cfg(feature = "clamber_gltf")]
mod figures;
#[cfg(feature = "clamber_gltf")]
mod front_page;
#[cfg(feature = "gizmos")]
mod gizmos;
#[cfg(feature = "gltf")]
mod gltf_tags;
mod hierarchy;
#[cfg(all(feature = "diagnostics", feature = "gizmos", feature = "picking"))]
mod missing_plugins;
#[cfg(all(feature = "avian", feature = "rapier"))]
mod obstacles;
#[cfg(feature = "picking")]
mod picking;
mod preludes;
#[cfg(all(feature = "avian", feature = "rapier"))]
mod proxies;
mod queries;
mod relations;
mod saved_worlds;
mod scenes;
mod seldom_poses;
mod sizes;
mod sticking;
mod surfaces;
mod tags;
mod timing;
mod uneven_frames;
mod wind;
