//! A report on a creature's file: the results of its import, and the distance between its collider and its visual
//! meshes in every clip.

mod brain;
mod humanoid;
mod joints;
mod options;
mod propose;
mod report;
mod visual;

use std::io::Write;
use std::path::PathBuf;

use clamber_colossus::{BrainError, ColossusError};
use clamber_gltf::{GltfError, LoadOptions, Model, load_with};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::MeshError;
use clamber_surface::rig::{Clip, Playback, Pose, RigError};
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use thiserror::Error;

pub use options::InspectOptions;
pub use report::{ClipLine, Distances, Inspection, WeakPointLine};

use crate::progress::Progress;
use visual::VisualDistance;

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
/// true. These options print something else instead:
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
    Ok(true)
}

/// Reports on a creature, and measures the distance between its collider and its visual meshes, at rest and in its
/// clips. Shows its progress on standard error.
///
/// # Errors
/// [`InspectError`] if no clip has a chosen name, a clip does not fit the creature, or the visual meshes are broken.
pub fn inspect(model: &Model, options: &InspectOptions) -> Result<Inspection, InspectError> {
    let mut inspection = Inspection::of_import(model);
    let mut surface = SkinnedSurface::new(model.rig.collider.clone());
    let mut visual = VisualDistance::new(model)?;
    let mut rng = fastrand::Rng::with_seed(options.seed);
    let poses = poses(model, options)?;
    let mut progress = Progress::new(poses.len(), "poses");
    for pose in &poses {
        let palette = model.rig.skeleton.palette(pose)?;
        surface.advance(&palette, Similarity::IDENTITY)?;
        visual.measure(&palette, &surface, &mut rng)?;
        progress.step();
    }
    progress.finish();
    inspection.poses = poses.len();
    inspection.collision_to_visual = visual.finish();
    Ok(inspection)
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
