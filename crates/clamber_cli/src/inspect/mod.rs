//! A report on a creature's file: the results of its import, and measurements of the creature in every clip. It serves
//! authors of creatures, and measurements on many models.

mod bounds;
mod brain;
mod deviation;
mod humanoid;
mod joints;
mod options;
mod propose;
mod report;

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use clamber_colossus::{BrainError, ColossusError};
use clamber_gltf::{GltfError, LoadOptions, Model, load_with};
use clamber_oracle::agreement::{Agreement, Aims, Comparison, extent};
use clamber_surface::geometry::{Similarity, Sphere};
use clamber_surface::measure::{BruteForce, posed_triangles};
use clamber_surface::mesh::{MeshError, PaletteError};
use clamber_surface::rig::{Clip, Palette, Playback, Pose, RigError};
use clamber_surface::skin::skin_into;
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use glam::Vec3;
use thiserror::Error;

pub use deviation::skinning_error_share;
pub use options::InspectOptions;
pub use report::{ClipLine, Distances, Inspection, WeakPointLine};

use crate::progress::Progress;
use bounds::{refit, violations};
use deviation::VisualDistance;

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
    /// The drawing cannot be written.
    #[error("cannot draw {}: {error}", file.display())]
    Draw {
        /// The file.
        file: PathBuf,
        /// The reason.
        error: String,
    },
    /// A brain's file cannot be read.
    #[error("cannot read {}: {error}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// The reason.
        error: std::io::Error,
    },
    /// A brain's file is not valid.
    #[error("{}: {error}", file.display())]
    Brain {
        /// The file.
        file: PathBuf,
        /// The mistake.
        error: BrainError,
    },
    /// The brain and the creature do not fit each other.
    #[error("{}: {error}", file.display())]
    Colossus {
        /// The brain's file.
        file: PathBuf,
        /// The mismatch.
        error: ColossusError,
    },
    /// No brain can be proposed for the creature.
    #[error("{}: {error}", file.display())]
    Propose {
        /// The creature's file.
        file: PathBuf,
        /// The reason.
        error: String,
    },
    /// The file has no clip of that name.
    #[error("there is no clip {name:?}; the clips are: {clips}")]
    Clip {
        /// The name that was asked for.
        name: String,
        /// The names of the file's clips.
        clips: String,
    },
}

/// Loads a file and prints the results of its import, then measures the creature and prints the measurements. Returns
/// true if all checks hold. These options print something else instead:
///
/// - [`InspectOptions::brain`]: a brain; returns true if all its states and transitions can happen.
/// - [`InspectOptions::propose_brain`]: a brain's file for the creature.
/// - [`InspectOptions::joints`]: the joints as a tree.
/// - [`InspectOptions::humanoid`]: the human body in the file; returns true if there is one.
///
/// # Errors
/// [`InspectError`] if a file cannot be read, has no clip of a chosen name, or a clip or a brain does not fit the
/// creature.
pub fn print(options: &InspectOptions) -> Result<bool, InspectError> {
    if options.brain {
        return brain::print(options);
    }
    let mut load = LoadOptions::default();
    (load.scene, load.skin) = (options.scene, options.skin);
    let model = load_with(&options.file, &load)?;
    if options.propose_brain {
        print!("{}", propose::text(&model.rig, options)?);
        return Ok(true);
    }
    if options.joints {
        println!("{}", options.file.display());
        print!("{}", joints::tree(&model));
        return Ok(true);
    }
    if options.humanoid {
        return humanoid::print(&model, options);
    }
    let chosen = chosen(&model, options)?;
    let found = Inspection::of_import(&model);
    if !options.json {
        println!("{}", options.file.display());
        print!("{}", found.import());
        let each = options.poses_of_each(chosen.len());
        let default = InspectOptions::of(options.file.clone());
        let thorough = InspectOptions {
            thorough: true,
            ..default
        };
        if options.poses.is_none() && each < thorough.poses_of_each(chosen.len()) {
            println!("  {each} poses of each clip; --thorough measures more, --clip NAME one clip");
        }
        // Also a pipe shows the import before the measurements begin.
        let _ = std::io::stdout().flush();
    }
    let inspection = inspect(&model, options)?;
    if options.json {
        println!("{}", inspection.to_json());
    } else {
        print!("{}", inspection.measured());
    }
    if !inspection.holds() {
        eprintln!("clamber: a check failed");
    }
    Ok(inspection.holds())
}

/// Measures a creature at rest and in its clips. Shows its progress on standard error.
///
/// # Errors
/// [`InspectError`] if no clip has a chosen name, a clip does not fit the creature, or the visual meshes are broken.
pub fn inspect(model: &Model, options: &InspectOptions) -> Result<Inspection, InspectError> {
    let mut inspection = Inspection::of_import(model);
    let mut surface = SkinnedSurface::new(model.rig.collider.clone());
    let mut visual = VisualDistance::new(model)?;
    let mut rng = fastrand::Rng::with_seed(options.seed);
    let mut timings = Timings::default();
    let mut positions = Vec::new();
    let poses = poses(model, options)?;
    let mut agreement = Agreement::default();
    let mut progress = Progress::new(poses.len(), "poses");
    for pose in &poses {
        let palette = model.rig.skeleton.palette(pose)?;
        surface.advance(&palette, Similarity::IDENTITY)?;
        surface.skin_all(&mut positions);
        let share = skinning_error_share(&model.rig.collider, palette.matrices(), &positions);
        inspection.skinning_error_share = inspection.skinning_error_share.max(share);
        compare_queries(&surface, &mut rng, &mut agreement);
        inspection.bound_violations += violations(&surface, &positions);
        visual.measure(&palette, &surface, &mut rng)?;
        timings.measure(model, &palette)?;
        progress.step();
    }
    progress.finish();
    inspection.poses = poses.len();
    inspection.answers = agreement.questions;
    inspection.hits = agreement.found;
    inspection.wrong_answers = agreement.disagreements;
    inspection.first_wrong_answer = agreement.first.map(|first| first.to_string());
    inspection.collision_to_visual = visual.finish();
    (inspection.skin_us, inspection.refit_us) = timings.medians();
    Ok(inspection)
}

/// Compares answers with brute force, for one question of every kind and aim. Each question is asked twice: of the
/// surface, which skins only the vertices that the query touches, and of a copy that has all vertices skinned ahead.
pub fn compare_queries(
    surface: &SkinnedSurface,
    rng: &mut fastrand::Rng,
    agreement: &mut Agreement,
) {
    let mut ahead = surface.clone();
    ahead.skin_ahead();
    let triangles = posed_triangles(surface.in_model());
    let brute_force = BruteForce::new(surface.in_model());
    let (mut questions, mut comparison) = (Vec::new(), Comparison::default());
    Aims::new(&triangles, extent(&triangles), rng).all(&mut questions);
    for question in &questions {
        comparison.ask(&brute_force, question);
        for surface in [surface, &ahead] {
            agreement.count(comparison.hold(&surface.in_model()));
        }
    }
}

/// The clips to measure: the chosen ones, or all if none is chosen.
fn chosen<'a>(model: &'a Model, options: &InspectOptions) -> Result<Vec<&'a Clip>, InspectError> {
    for name in &options.clips {
        if !model.rig.clips.iter().any(|clip| clip.name == *name) {
            let names: Vec<&str> = model
                .rig
                .clips
                .iter()
                .map(|clip| clip.name.as_str())
                .collect();
            return Err(InspectError::Clip {
                name: name.clone(),
                clips: names.join(", "),
            });
        }
    }
    let all = model.rig.clips.iter();
    let asked = all.filter(|clip| options.clips.is_empty() || options.clips.contains(&clip.name));
    Ok(asked.collect())
}

/// The rest pose, and poses of the chosen clips.
fn poses(model: &Model, options: &InspectOptions) -> Result<Vec<Pose>, InspectError> {
    let rest = model.rig.skeleton.rest_pose();
    let mut poses = vec![rest.clone()];
    let chosen = chosen(model, options)?;
    let count = options.poses_of_each(chosen.len());
    for clip in chosen {
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
    fn measure(&mut self, model: &Model, palette: &Palette) -> Result<(), PaletteError> {
        let mesh = &model.rig.collider;
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
            median(&mut self.skin).unwrap_or_default(),
            median(&mut self.refit).unwrap_or_default(),
        )
    }
}

/// The median, or `None` without values. For an even count it is the smaller of the middle two. Sorts `values`.
fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len().saturating_sub(1) / 2).copied()
}
