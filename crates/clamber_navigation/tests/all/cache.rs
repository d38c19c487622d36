//! Graphs from files equal built ones, and damaged files are built again.

#![allow(clippy::unwrap_used, reason = "a test")]

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use crate::support::{Body, ball, climber};
use clamber_navigation::{
    CachedGraph, ClimbGraph, Footing, Forecast, GraphConfig, GraphOrigin, NavigationError, Start,
};
use clamber_surface::mesh::SurfaceKind::Fur;
use clamber_surface::mesh::TriangleId;
use clamber_surface::surface::SurfaceError;
use fastrand::Rng;
use glam::Vec3;

/// An empty folder for a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    folder
}

fn body() -> Body {
    ball(Vec3::Y * 2.5, 2.0, |_, _| Fur)
}

fn cached(folder: &Path, body: &Body, config: &GraphConfig) -> CachedGraph {
    let go_on = |_| ControlFlow::Continue(());
    ClimbGraph::cached(folder, &body.rig(), config, go_on).unwrap()
}

/// The content of a graph as text: its patches and entries, and plans on it.
fn told(graph: &ClimbGraph) -> String {
    let mut rng = Rng::with_seed(28);
    let all = graph.patches().len();
    let goal = graph.goal(&[rng.usize(0..all)]);
    let plans = (0..20).map(|_| {
        let start = Start {
            patch: rng.usize(0..all),
            footing: Footing::Holds,
            seconds: 0.0,
            stamina: 1.0,
        };
        graph.plan(&[start], &goal, &Forecast::still())
    });
    let plans: Vec<_> = plans.collect();
    format!("{:?} {:?} {plans:?}", graph.patches(), graph.entries())
}

#[test]
fn a_graph_is_built_once_and_read_then() {
    let folder = folder("built_once");
    let first = cached(&folder, &body(), &climber());
    let second = cached(&folder, &body(), &climber());
    assert!(matches!(first.origin, GraphOrigin::Built));
    assert!(matches!(second.origin, GraphOrigin::Read));
    assert_eq!(first.file, second.file);
    assert_eq!(told(&first.graph), told(&second.graph));
}

#[test]
fn what_has_changed_gets_a_file_of_its_own() {
    let folder = folder("changed");
    let mut larger = climber();
    larger.spacing = 0.5;
    let mut longer = climber();
    longer.climber.grip.as_mut().unwrap().reach += 1e-12;
    let files = [
        cached(&folder, &body(), &climber()),
        cached(&folder, &body(), &larger),
        cached(&folder, &body(), &longer),
        cached(
            &folder,
            &ball(Vec3::Y * 2.500_001, 2.0, |_, _| Fur),
            &climber(),
        ),
    ];
    for (index, cached) in files.iter().enumerate() {
        assert!(matches!(cached.origin, GraphOrigin::Built), "{index}");
    }
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), files.len());
}

#[test]
fn damaged_files_are_built_anew() {
    let folder = folder("damaged");
    let whole = cached(&folder, &body(), &climber());
    let bytes = std::fs::read(&whole.file).unwrap();
    let mut rng = Rng::with_seed(28);
    for round in 0..40 {
        let mut damaged = bytes.clone();
        let at = if round < 30 {
            rng.usize(0..bytes.len())
        } else {
            round
        };
        match round % 3 {
            0 => damaged.truncate(at),
            1 => damaged[at] ^= 1 << rng.u32(0..8),
            _ => damaged.push(0),
        }
        std::fs::write(&whole.file, &damaged).unwrap();
        let again = cached(&folder, &body(), &climber());
        assert!(matches!(again.origin, GraphOrigin::Built), "round {round}");
        assert_eq!(std::fs::read(&whole.file).unwrap(), bytes, "round {round}");
    }
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
}

#[test]
fn forged_files_do_no_harm() {
    let folder = folder("forged");
    let whole = cached(&folder, &body(), &climber());
    let bytes = std::fs::read(&whole.file).unwrap();
    let (head, rest) = bytes.split_at(48);
    let mut rng = Rng::with_seed(29);
    let mut read = 0;
    for _ in 0..100 {
        let mut forged = rest.to_vec();
        for _ in 0..rng.usize(1..4) {
            let at = rng.usize(0..forged.len());
            forged[at] = rng.u8(..);
        }
        let mut file = head[..32].to_vec();
        file.extend(xxhash_rust::xxh3::xxh3_128(&forged).to_le_bytes());
        file.extend(forged);
        std::fs::write(&whole.file, &file).unwrap();
        let again = cached(&folder, &body(), &climber());
        read += u32::from(matches!(again.origin, GraphOrigin::Read));
        told(&again.graph);
    }
    assert!(read > 10, "only {read} forged files are read");
}

#[test]
fn a_folder_that_cannot_be_written_costs_nothing_but_time() {
    let folder = folder("a_file");
    std::fs::write(&folder, "no folder").unwrap();
    let built = cached(&folder, &body(), &climber());
    assert!(matches!(built.origin, GraphOrigin::NotSaved(_)));
    assert!(!built.graph.patches().is_empty());
    std::fs::remove_file(&folder).unwrap();
}

#[test]
fn a_cancelled_build_leaves_no_file() {
    let folder = folder("cancelled");
    let stop = |_| ControlFlow::Break(());
    let cancelled = ClimbGraph::cached(&folder, &body().rig(), &climber(), stop);
    assert!(matches!(cancelled, Err(NavigationError::Cancelled)));
    assert!(!folder.exists());
}

#[test]
fn many_may_use_a_folder_at_the_same_time() {
    let folder = folder("shared");
    let told: Vec<String> = std::thread::scope(|scope| {
        let all: Vec<_> = (0..4)
            .map(|_| scope.spawn(|| told(&cached(&folder, &body(), &climber()).graph)))
            .collect();
        all.into_iter().map(|one| one.join().unwrap()).collect()
    });
    assert!(told.iter().all(|other| *other == told[0]));
    // No temporary file is left.
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    let again = cached(&folder, &body(), &climber());
    assert!(matches!(again.origin, GraphOrigin::Read));
}

/// Temporary files of killed processes do not keep graphs from being saved, and only regular files are read.
#[test]
#[cfg(unix)]
fn leftovers_and_devices_do_no_harm() {
    let folder = folder("leftovers");
    let built = cached(&folder, &body(), &climber());
    assert!(matches!(built.origin, GraphOrigin::Built));
    std::fs::remove_file(&built.file).unwrap();
    // Temporary names of this process, for any counter that it may have reached.
    for count in 0..200 {
        let name = format!("{}-{count}-0.part", std::process::id());
        std::fs::write(built.file.with_extension(name), "half").unwrap();
    }
    let again = cached(&folder, &body(), &climber());
    assert!(matches!(again.origin, GraphOrigin::Built));
    let read = cached(&folder, &body(), &climber());
    assert!(matches!(read.origin, GraphOrigin::Read));
    // A link to an endless device.
    std::fs::remove_file(&built.file).unwrap();
    std::os::unix::fs::symlink("/dev/zero", &built.file).unwrap();
    let again = cached(&folder, &body(), &climber());
    assert!(matches!(again.origin, GraphOrigin::Built));
    assert!(std::fs::metadata("/dev/zero").is_ok());
}

#[test]
fn a_ground_that_is_nowhere_is_refused() {
    let go_on = |_| ControlFlow::Continue(());
    for ground in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let config = GraphConfig {
            ground,
            ..climber()
        };
        let refused = ClimbGraph::build(&body().rig(), &config, go_on).map(drop);
        let is_ground = matches!(
            refused,
            Err(NavigationError::OutOfRange { name: "ground", .. })
        );
        assert!(is_ground, "{ground}: {refused:?}");
    }
}

#[test]
fn plates_that_the_skin_does_not_have_and_too_many_plates_are_refused() {
    let build = |plates| {
        let mut calls = 0;
        let config = GraphConfig {
            plates,
            ..climber()
        };
        let go_on = |_| {
            calls += 1;
            ControlFlow::Continue(())
        };
        (
            ClimbGraph::build(&body().rig(), &config, go_on).map(drop),
            calls,
        )
    };
    let (refused, calls) = build(vec![vec![TriangleId(0)], vec![TriangleId(u32::MAX)]]);
    let missing = SurfaceError::Triangle(TriangleId(u32::MAX));
    assert_eq!(refused, Err(NavigationError::Surface(missing)));
    assert_eq!(calls, 0);
    let (refused, _) = build(vec![Vec::new(); (1 << 16) + 1]);
    let message = refused.unwrap_err().to_string();
    assert_eq!(message, "plates.len() must be at most 65,536, but is 65537");
}
