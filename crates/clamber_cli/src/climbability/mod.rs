//! Reports where a climber can get to on a creature.

mod creature;
mod picture;
mod require;
mod table;

use std::ops::ControlFlow;
use std::path::PathBuf;

use clamber_climber::ClimberConfig;
use clamber_colossus::{BrainError, ColossusError};
use clamber_gltf::GltfError;
use clamber_navigation::{ClimbReport, GraphConfig, NavigationError, Progress as Built, Stage};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::SurfaceKind;
use clap::Args;
use thiserror::Error;

use creature::Creature;
pub use require::Requirement;

use crate::progress::Progress;

/// Reports where a climber can get to on a creature, and why it does not reach a weak point.
///
/// Divides the creature's skin into patches, finds the patches between which a climber walks and climbs, and plays all
/// clips. With --require it is a check for a game's CI: it exits with 1 if a requirement does not hold, and with 2 if
/// no report can be made.
#[derive(Args, Clone, Debug)]
pub struct ClimbabilityOptions {
    /// A .glb or .gltf file.
    pub file: PathBuf,

    /// The creature's brain file. The report includes its weak points and the skin below its plates. Its `height` and
    /// `made_for` hold where the options give none.
    #[arg(long, value_name = "FILE.json")]
    pub brain: Option<PathBuf>,

    /// Height for which the clips were made, metres. A creature of another height plays them slower or faster by
    /// Froude's law, as it does in a game [default: as the brain says; without one, clips keep their speed].
    #[arg(long, value_name = "METRES", value_parser = positive, allow_negative_numbers = true)]
    pub made_for: Option<f64>,

    /// Height of the creature, metres [default: as the brain says, else as in the file].
    #[arg(long, value_name = "METRES", value_parser = positive, allow_negative_numbers = true)]
    pub height: Option<f64>,

    /// Materials that can be gripped, separated by commas.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "fur")]
    pub grip: Vec<Material>,

    /// How far hands reach from the climber's ball, metres.
    #[arg(long, value_name = "METRES", default_value_t = 0.35, value_parser = positive, allow_negative_numbers = true)]
    pub reach: f64,

    /// Longest side of a patch of skin, metres.
    #[arg(long, value_name = "METRES", default_value_t = 0.4, value_parser = positive, allow_negative_numbers = true)]
    pub spacing: f64,

    /// A requirement, such as "weak_points>=3": the name of a number in the report, one of >=, <=, >, < and =, and a
    /// value. The numbers are weak_points (how many are reachable), reachable (share of the skin, 0 to 1),
    /// reachable_area and rest_area (square metres), and entries. May be given more than once.
    #[arg(long, value_name = "WHAT")]
    pub require: Vec<Requirement>,

    /// Print the report as JSON.
    #[arg(long)]
    pub json: bool,

    /// File for a picture from four sides. The colour runs from dark blue to yellow with the climbing time between a
    /// place and the ground. Skin that no climber reaches is grey, and red discs mark weak points.
    #[arg(long, value_name = "FILE.png")]
    pub picture: Option<PathBuf>,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number <= 1e6 => Ok(number),
        Ok(_) => Err("must be above 0 and at most 1000000".into()),
        Err(error) => Err(error.to_string()),
    }
}

/// A material of the skin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Material {
    /// Bare skin.
    Skin,
    /// Fur or plants.
    Fur,
    /// Armour or rock.
    Stone,
}

impl Material {
    fn kind(self) -> SurfaceKind {
        match self {
            Self::Skin => SurfaceKind::Skin,
            Self::Fur => SurfaceKind::Fur,
            Self::Stone => SurfaceKind::Stone,
        }
    }
}

/// Why there is no report.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ClimbabilityError {
    /// The creature's file cannot be loaded.
    #[error(transparent)]
    Gltf(#[from] GltfError),
    /// The graph cannot be built.
    #[error(transparent)]
    Navigation(#[from] NavigationError),
    /// The creature is flat, and cannot be scaled to a height.
    #[error("the creature has no height, so it cannot be scaled to {0} m")]
    NoHeight(f64),
    /// The brain's file cannot be read.
    #[error("cannot read {file}: {error}")]
    Read {
        /// The file.
        file: PathBuf,
        /// The reason.
        error: std::io::Error,
    },
    /// The brain has a mistake.
    #[error("{file}: {error}")]
    Brain {
        /// The file.
        file: PathBuf,
        /// The mistake.
        error: BrainError,
    },
    /// The brain does not fit the creature.
    #[error("{file}: {error}")]
    Colossus {
        /// The brain's file.
        file: PathBuf,
        /// The mismatch.
        error: ColossusError,
    },
    /// The picture cannot be written.
    #[error("cannot write {path}: {error}")]
    Picture {
        /// The file.
        path: PathBuf,
        /// The reason.
        error: std::io::Error,
    },
    /// The report cannot be written as JSON.
    #[error("the report cannot be written: {0}")]
    Json(#[from] serde_json::Error),
}

/// Prints the report on a creature. Returns true if all requirements hold.
///
/// # Errors
/// [`ClimbabilityError`] if a file cannot be loaded, no graph can be built, or the report cannot be written.
pub fn print(options: &ClimbabilityOptions) -> Result<bool, ClimbabilityError> {
    let creature = Creature::load(options)?;
    let palette = creature
        .rig
        .skeleton
        .palette(&creature.rig.skeleton.rest_pose());
    let palette = palette.map_err(NavigationError::from)?;
    let skin =
        clamber_surface::skin::skin(&creature.rig.collider, palette.matrices()).unwrap_or_default();
    let low = skin.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
    let high = skin.iter().map(|p| p.y).fold(f32::NEG_INFINITY, f32::max);
    let own = f64::from(high - low);
    let scale = creature.height.map_or(1.0, |height| height / own);
    if !(scale.is_normal() && scale > 0.0) {
        return Err(ClimbabilityError::NoHeight(creature.height.unwrap_or(own)));
    }
    let made_for = creature.made_for;
    let mut climber = ClimberConfig::colossus_climber();
    if let Some(grip) = &mut climber.grip {
        grip.reach = options.reach;
    }
    let config = GraphConfig {
        spacing: options.spacing,
        grips: options
            .grip
            .iter()
            .map(|material| material.kind())
            .collect(),
        world_from_model: Similarity::from_scale(scale),
        ground: f64::from(low) * scale,
        clip_rate: made_for.map_or(1.0, |made_for| (made_for / (own * scale)).sqrt()),
        plates: creature.plates.clone(),
        ..GraphConfig::new(climber)
    };
    let mut bar: Option<(Stage, Progress)> = None;
    let built = ClimbReport::new(&creature.rig, &config, |built| {
        show(&mut bar, built);
        ControlFlow::Continue(())
    });
    if let Some((_, bar)) = &bar {
        bar.finish();
    }
    let (report, graph) = built?;
    if options.json {
        println!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        print!("{}", table::table(&report, own * scale, config.ground));
    }
    if let Some(path) = &options.picture {
        let place = |p: &glam::Vec3| config.world_from_model.transform_point(p.as_dvec3());
        let skin: Vec<glam::DVec3> = skin.iter().map(place).collect();
        let longest = picture::draw(path, &creature.rig.collider, &skin, &graph, &report);
        let longest = longest.map_err(|error| ClimbabilityError::Picture {
            path: path.clone(),
            error,
        })?;
        eprintln!(
            "{}: dark blue is the ground, yellow {longest:.1} s from it",
            path.display()
        );
    }
    let mut holds = true;
    for requirement in &options.require {
        let found = requirement.found(&report);
        if !requirement.holds(found) {
            holds = false;
            eprintln!("clamber: {requirement} does not hold: it is {found}");
        }
    }
    Ok(holds)
}

/// Shows the progress of a build, with one bar for each stage.
fn show(bar: &mut Option<(Stage, Progress)>, built: Built) {
    let is_same = bar.as_ref().is_some_and(|(stage, _)| *stage == built.stage);
    if !is_same {
        if let Some((_, bar)) = bar.take() {
            bar.finish();
        }
        let of = match built.stage {
            Stage::Seats => "places with room",
            Stage::Arms => "places with holds",
            Stage::Clips => "clips",
            _ => "jumps",
        };
        *bar = Some((built.stage, Progress::new(built.of, of)));
    }
    if let Some((_, bar)) = bar {
        bar.set(built.done);
    }
}
