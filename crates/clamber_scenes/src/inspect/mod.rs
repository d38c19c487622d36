//! A report on a creature's file: what its import found, and measurements of the creature in every clip. For
//! people who make creatures, and for measurements on many models.

mod agreement;
mod bounds;
mod deviation;
mod options;
mod report;

use std::time::Instant;

use clamber_gltf::{GltfError, LoadOptions, Rig, load_with};
use clamber_surface::geometry::{Similarity, Sphere};
use clamber_surface::mesh::{MeshError, PaletteError};
use clamber_surface::rig::{Palette, Playback, Pose, RigError};
use clamber_surface::skin::skin_into;
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use glam::Vec3;
use indicatif::{ProgressBar, ProgressStyle};
use thiserror::Error;

pub use agreement::{Agreement, compare_queries};
pub use deviation::skinning_error_share;
pub use options::InspectOptions;
pub use report::Inspection;

use crate::measure::quantile;
use bounds::{refit, violations};
use deviation::VisualDistance;

/// Number of places in each pose at which queries are compared with brute force.
const PLACES: usize = 6;

/// Why a file cannot be inspected.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum InspectError {
    /// The file cannot be loaded.
    #[error(transparent)]
    Load(#[from] GltfError),
    /// The skeleton cannot be posed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The surface cannot be posed.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The palette does not fit the collider.
    #[error(transparent)]
    Palette(#[from] PaletteError),
    /// No mesh can be built of the visual meshes.
    #[error(transparent)]
    Visual(#[from] MeshError),
}

/// Loads a file and measures the creature over all its clips.
///
/// # Errors
/// [`InspectError`] if the file cannot be loaded, or a clip does not fit the creature.
pub fn run(options: &InspectOptions) -> Result<Inspection, InspectError> {
    let mut load = LoadOptions::default();
    load.skin = options.skin;
    let rig = load_with(&options.file, &load)?;
    inspect(&rig, options)
}

/// Measures a creature at rest and over all its clips. Shows a progress bar on standard error.
///
/// # Errors
/// [`InspectError`] if a clip does not fit the creature, or the visual meshes are broken.
pub fn inspect(rig: &Rig, options: &InspectOptions) -> Result<Inspection, InspectError> {
    let mut inspection = Inspection::of_import(rig);
    let mut surface = SkinnedSurface::new(rig.collider.clone());
    let mut visual = VisualDistance::new(rig)?;
    let mut rng = fastrand::Rng::with_seed(options.seed);
    let mut timings = Timings::default();
    let mut positions = Vec::new();
    let poses = poses(rig, options.poses)?;
    let bar = ProgressBar::new(poses.len() as u64);
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} % of the poses  [{eta} left]");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    for pose in &poses {
        let palette = rig.skeleton.palette(pose)?;
        surface.advance(&palette, Similarity::IDENTITY)?;
        surface.skin_all(&mut positions);
        let share = skinning_error_share(&rig.collider, palette.matrices(), &positions);
        inspection.skinning_error_share = inspection.skinning_error_share.max(share);
        let agreement = compare_queries(&surface, &mut rng, PLACES);
        inspection.query_hits += agreement.hits;
        inspection.query_mismatches += agreement.mismatches;
        inspection.bound_violations += violations(&surface, &positions);
        visual.measure(&palette, &surface, &mut rng)?;
        timings.measure(rig, &palette)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    inspection.poses = poses.len();
    inspection.collision_to_visual = visual.finish();
    (inspection.skin_us, inspection.refit_us) = timings.medians();
    Ok(inspection)
}

/// The rest pose, and `count` poses of every clip.
fn poses(rig: &Rig, count: u32) -> Result<Vec<Pose>, RigError> {
    let rest = rig.skeleton.rest_pose();
    let mut poses = vec![rest.clone()];
    for clip in &rig.clips {
        for k in 0..count {
            let time = clip.duration() * f64::from(k) / f64::from(count);
            poses.push(clip.sample(&rest, time, Playback::Clamp)?);
        }
    }
    Ok(poses)
}

/// Times of skinning and of refitting in each pose, microseconds.
#[derive(Default)]
struct Timings {
    positions: Vec<Vec3>,
    spheres: Vec<Option<Sphere>>,
    skin: Vec<f64>,
    refit: Vec<f64>,
}

impl Timings {
    fn measure(&mut self, rig: &Rig, palette: &Palette) -> Result<(), PaletteError> {
        let mesh = &rig.collider;
        self.positions.resize(mesh.positions().len(), Vec3::ZERO);
        let start = Instant::now();
        skin_into(mesh, palette.matrices(), &mut self.positions)?;
        let skinned = Instant::now();
        refit(mesh, &self.positions, &mut self.spheres);
        let refitted = Instant::now();
        self.skin.push((skinned - start).as_secs_f64() * 1e6);
        self.refit.push((refitted - skinned).as_secs_f64() * 1e6);
        Ok(())
    }

    fn medians(&mut self) -> (f64, f64) {
        (
            quantile(&mut self.skin, 0.5),
            quantile(&mut self.refit, 0.5),
        )
    }
}
