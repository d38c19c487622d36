//! Models in files, at rest and in poses of their clips: skinning stays within its error bound, every query has the
//! bits of brute force, and every bound holds its vertices.
//!
//! The files are the giant, the models in the folder of `CLAMBER_TEST_DATA`, and all `.glb` and `.gltf` files in the
//! folder of `CLAMBER_FILES`, if that variable is set. With `--nocapture` the tests print a table for each file.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use std::fmt;

use clamber_gltf::load;
use clamber_scenes::{giant, test_data};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::Rig;
use clamber_surface::rig::{Playback, Pose};
use clamber_surface::surface::SkinnedSurface;
use clamber_verify::agreement::Agreement;
use clamber_verify::posed::{bound_violations, compare_queries, skinning_error_share};

/// The environment variable that names a folder of further models.
const FILES: &str = "CLAMBER_FILES";

/// Number of models of the test data that can be loaded. Two more are rejected, as some of their weights are NaN.
const MODELS: usize = 27;

/// The largest number of poses of one clip in a thorough check.
const POSES: usize = 30;

/// Number of poses of all clips together in a thorough check. If there are more clips than that, each has one pose.
const BUDGET: usize = 300;

/// The poses in which a file is checked, beside the rest pose.
#[derive(Clone, Copy)]
enum Poses {
    /// This many poses of each clip.
    OfEachClip(usize),
    /// At most [`POSES`] of each clip, and about [`BUDGET`] in all.
    Thorough,
}

/// The results of all checks of a file, or of several files.
#[derive(Clone, Debug, Default)]
struct Report {
    poses: usize,
    /// Largest error of a skinned coordinate, as a share of its bound.
    skinning_error_share: f64,
    agreement: Agreement,
    bound_violations: usize,
}

impl Report {
    fn holds(&self) -> bool {
        let wrong = self.agreement.disagreements + self.bound_violations;
        self.skinning_error_share <= 1.0 && wrong == 0
    }

    fn add(&mut self, other: &Self) {
        self.poses += other.poses;
        self.skinning_error_share = self.skinning_error_share.max(other.skinning_error_share);
        self.agreement.questions += other.agreement.questions;
        self.agreement.found += other.agreement.found;
        self.agreement.disagreements += other.agreement.disagreements;
        self.agreement.first = self.agreement.first.or(other.agreement.first);
        self.bound_violations += other.bound_violations;
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Agreement {
            questions,
            found,
            disagreements,
            first,
        } = &self.agreement;
        let mut row = |name: &str, value: String| writeln!(f, "  {name:<24}{value}");
        row("measured in", format!("{} poses", self.poses))?;
        let share = self.skinning_error_share;
        row("skinning error", format!("{share:.3} of the bound"))?;
        let wrong = format!("{disagreements} of {questions}, with {found} hits");
        row("wrong answers", wrong)?;
        if let Some(first) = first {
            row("first wrong answer", first.to_string())?;
        }
        row("bound violations", self.bound_violations.to_string())
    }
}

/// The rest pose, and poses of all clips.
fn poses(rig: &Rig, of: Poses) -> Vec<Pose> {
    let count = match of {
        Poses::OfEachClip(count) => count,
        Poses::Thorough => (BUDGET / rig.clips.len().max(1)).clamp(1, POSES),
    };
    let rest = rig.skeleton.rest_pose();
    let mut poses = vec![rest.clone()];
    for clip in &rig.clips {
        for k in 0..count {
            let time = clip.duration() * k as f64 / count as f64;
            poses.push(clip.sample(&rest, time, Playback::Clamp).unwrap());
        }
    }
    poses
}

/// Checks a creature in poses of all its clips, and prints the results.
fn check(name: &str, rig: &Rig, of: Poses) -> Report {
    let mut rng = fastrand::Rng::with_seed(1);
    let mut surface = SkinnedSurface::new(rig.collider.clone());
    let mut report = Report::default();
    let mut positions = Vec::new();
    for pose in poses(rig, of) {
        let palette = rig.skeleton.palette(&pose).unwrap();
        surface.advance(&palette, Similarity::IDENTITY).unwrap();
        surface.skin_all(&mut positions);
        let share = skinning_error_share(&rig.collider, palette.matrices(), &positions);
        report.skinning_error_share = report.skinning_error_share.max(share);
        compare_queries(&surface, &mut rng, &mut report.agreement);
        report.bound_violations += bound_violations(&surface, &positions);
        report.poses += 1;
    }
    println!("{name}\n{report}");
    assert!(report.holds(), "{name}\n{report}");
    assert!(report.agreement.found > 0, "{name}\n{report}");
    report
}

fn check_giant(of: Poses) {
    let report = check("giant", &load(giant::path()).unwrap().rig, of);
    assert!(report.agreement.found > 1_000, "{report}");
}

/// Checks the models of the test data.
fn check_models(of: Poses) {
    let files = test_data::gltf_files("checks of all models").unwrap();
    let (mut checked, mut all) = (0, Report::default());
    for (name, path) in files.iter().filter(|(name, _)| name.starts_with("models/")) {
        let Ok(model) = load(path) else {
            println!("{name} is rejected");
            continue;
        };
        all.add(&check(name, &model.rig, of));
        checked += 1;
    }
    println!("{checked} models\n{all}");
    assert!(files.is_empty() || checked == MODELS, "{checked}");
}

#[test]
fn the_giant_in_a_few_poses() {
    check_giant(Poses::OfEachClip(4));
}

#[test]
fn models_in_a_few_poses() {
    check_models(Poses::OfEachClip(1));
}

#[test]
fn files_of_a_folder() {
    let Some(folder) = std::env::var_os(FILES) else {
        return;
    };
    let files = test_data::models_in(folder.as_ref()).unwrap();
    assert!(!files.is_empty(), "{FILES} has no .glb or .gltf file");
    for file in files {
        let name = file.display().to_string();
        let rig = load(&file)
            .unwrap_or_else(|error| panic!("{name}: {error}"))
            .rig;
        check(&name, &rig, Poses::Thorough);
    }
}

#[test]
#[ignore = "half a minute: run it in release"]
fn the_giant_in_many_poses() {
    check_giant(Poses::Thorough);
}

#[test]
#[ignore = "minutes: run it in release"]
fn models_in_many_poses() {
    check_models(Poses::Thorough);
}
