//! Tells where a climber can get to on a creature.

use std::ops::ControlFlow;
use std::path::PathBuf;

use clamber_climber::ClimberConfig;
use clamber_gltf::GltfError;
use clamber_navigation::{ClimbReport, GraphConfig, GraphSource, Missing, NavigationError};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::SurfaceKind;
use clap::Args;
use thiserror::Error;

/// Tells where a climber can get to on a creature, and what keeps it from the weak points.
#[derive(Args, Clone, Debug)]
pub struct ClimbabilityOptions {
    /// A .glb or .gltf file.
    pub file: PathBuf,

    /// Height of the creature, metres [default: as in the file].
    #[arg(long, value_name = "METRES")]
    pub height: Option<f64>,

    /// Largest side of a patch of skin, metres.
    #[arg(long, value_name = "METRES", default_value_t = 0.4)]
    pub spacing: f64,

    /// Materials that can be gripped.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "fur")]
    pub grip: Vec<Material>,
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
    /// The file cannot be loaded.
    #[error(transparent)]
    Gltf(#[from] GltfError),
    /// The graph cannot be built.
    #[error(transparent)]
    Navigation(#[from] NavigationError),
}

/// Builds the graph of a creature and prints what it tells.
///
/// # Errors
/// [`ClimbabilityError`] if the file cannot be loaded, or no graph can be built.
pub fn print(options: &ClimbabilityOptions) -> Result<bool, ClimbabilityError> {
    let rig = clamber_gltf::load(&options.file)?;
    let palette = rig.skeleton.palette(&rig.skeleton.rest_pose()).map_err(NavigationError::from)?;
    let skin = clamber_surface::skin::skin(&rig.collider, palette.matrices()).unwrap_or_default();
    let low = skin.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
    let high = skin.iter().map(|p| p.y).fold(f32::NEG_INFINITY, f32::max);
    let scale = options.height.map_or(1.0, |height| height / f64::from(high - low));
    let source = GraphSource {
        skeleton: &rig.skeleton,
        mesh: &rig.collider,
        clips: &rig.clips,
        plates: &[],
        weak_points: &rig.weak_points,
        world_from_model: Similarity::from_scale(scale),
        ground: f64::from(low) * scale,
    };
    let config = GraphConfig {
        spacing: options.spacing,
        grips: options.grip.iter().map(|material| material.kind()).collect(),
        ..GraphConfig::new(ClimberConfig::colossus_climber())
    };
    let start = std::time::Instant::now();
    let (report, graph) = ClimbReport::new(&source, &config, |_| ControlFlow::Continue(()))?;
    println!("{} patches, {} ways, {:.2} s", graph.patches().len(), graph.ways(), start.elapsed().as_secs_f64());
    println!("skin             {:9.1} m2", report.area);
    println!("can be gripped   {:9.1} m2", report.grip_area);
    println!("can be stood on  {:9.1} m2", report.stand_area);
    println!("reachable        {:9.1} m2, {:.1} %", report.reachable_area, 100.0 * report.reachable_area / report.area);
    println!("entries          {}", report.entries);
    for point in &report.weak_points {
        let how = match (point.reachable, point.missing) {
            (true, _) => "reachable".to_owned(),
            (_, Some(Missing::Reach(by))) => format!("not reachable: {by:.2} m of reach are missing"),
            _ => "not reachable: no way leads there".to_owned(),
        };
        println!("{:16} {:.1} m up, {how}", point.name, point.place.y - source.ground);
    }
    use clamber_navigation::{Footing, Forecast, Start};
    for point in &report.weak_points {
        let near = graph.patches_near(point.place, 1.0);
        let time = std::time::Instant::now();
        let goal = graph.goal(&near);
        let made = time.elapsed();
        let starts: Vec<Start> = graph.entries().iter().flat_map(|entry| [Footing::Stands, Footing::Holds].map(|footing| Start {
            patch: entry.patch, footing, seconds: 0.0, stamina: 1.0 })).collect();
        let forecast = Forecast::still().then(&graph, "idle", 0.0, 4.5).then(&graph, "shake", 0.0, 4.5);
        for (name, forecast) in [("still", Forecast::still()), ("shaken", forecast)] {
            let time = std::time::Instant::now();
            let plan = graph.plan(&starts, &goal, &forecast);
            println!("  {name}: goal {} patches {made:?}, plan {:?}: {:?}", near.len(), time.elapsed(),
                plan.map(|p| (p.seconds(), p.stamina(), p.steps.len(), p.looked_at)));
        }
    }
    Ok(true)
}

