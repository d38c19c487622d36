use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use clamber_climber::ClimberConfig;
use clamber_navigation::{ClimbGraph, GraphConfig, NavigationError};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{SurfaceKind, SurfaceTag, TriangleId, VertexId};

use clamber_colossus::{Brain, ColossusError, CreatureKind};
use clamber_gltf::{GltfError, LoadOptions};
use clamber_surface::mesh::{ColliderMesh, MeshError, PaletteError, Rig};
use clamber_surface::rig::{Clip, Palette, Pose, RigError, Skeleton, WeakPoint};
use clamber_surface::skin::skin;
use clamber_surface::surface::{SurfaceError, creature_fingerprint};
use glam::Vec3;
use thiserror::Error;

/// A creature as scenes use it, built in code or loaded from a file.
#[derive(Clone, Debug)]
pub struct Creature {
    /// The name that reports print.
    pub name: String,
    /// The skeleton.
    pub skeleton: Skeleton,
    /// The animation clips.
    pub clips: Vec<Clip>,
    /// The collision mesh.
    pub collider: Arc<ColliderMesh>,
    /// Of each material with a name, the triangles of the collider that have it.
    pub materials: BTreeMap<String, Vec<TriangleId>>,
    /// Where it can be wounded.
    pub weak_points: Vec<WeakPoint>,
    /// Speed of the walk clip, model units a second; `None` if unknown.
    pub walk_speed: Option<f64>,
    /// The graphs that were made of it.
    pub(crate) graphs: Graphs,
}

/// Graphs, by the fingerprint of the creature, its weak points, climber, height and the rate of clips.
pub(crate) type Graphs = Arc<Mutex<Vec<(GraphKey, Arc<ClimbGraph>)>>>;
type GraphKey = (
    u64,
    Vec<WeakPoint>,
    ClimberConfig,
    (f64, f64),
    Vec<Vec<TriangleId>>,
);

/// Why a creature cannot be loaded, built or posed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CreatureError {
    /// The file cannot be loaded.
    #[error(transparent)]
    Load(#[from] GltfError),
    /// The skeleton cannot be built or posed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The mesh cannot be built.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The surface cannot be posed.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The palette does not fit the mesh.
    #[error(transparent)]
    Palette(#[from] PaletteError),
}

impl Creature {
    /// A creature from its parts, without weak points and with an unknown walk speed.
    pub fn new(
        name: impl Into<String>,
        skeleton: Skeleton,
        clips: Vec<Clip>,
        collider: Arc<ColliderMesh>,
    ) -> Self {
        Self {
            name: name.into(),
            skeleton,
            clips,
            collider,
            materials: BTreeMap::new(),
            weak_points: Vec::new(),
            walk_speed: None,
            graphs: Graphs::default(),
        }
    }

    /// Loads a creature from a `.glb` or `.gltf` file, and names it after the file. The walk speed is unknown.
    ///
    /// # Errors
    /// [`CreatureError::Load`].
    pub fn load(path: &Path) -> Result<Self, CreatureError> {
        let rig = clamber_gltf::load_with(path, &LoadOptions::default())?.rig;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        Ok(Self {
            materials: rig.collider_materials,
            weak_points: rig.weak_points,
            ..Self::new(name, rig.skeleton, rig.clips, rig.collider)
        })
    }

    /// The graph of its skin for a climber, when it is so many metres tall, stands on the ground, plays its clips at
    /// this rate, and has plates. A climber grips fur and stone, or all of it if it has no fur. It is made once for
    /// each size: clones share it.
    ///
    /// # Errors
    /// As [`ClimbGraph::build`].
    pub fn graph(
        &self,
        climber: &ClimberConfig,
        height: f64,
        rate: f64,
        plates: &[Vec<TriangleId>],
    ) -> Result<Arc<ClimbGraph>, NavigationError> {
        let mut known = self.graphs.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (
            creature_fingerprint(&self.skeleton, &self.clips, &self.collider),
            self.weak_points.clone(),
            *climber,
            (height, rate),
            plates.to_vec(),
        );
        if let Some((_, graph)) = known.iter().find(|(other, _)| *other == key) {
            return Ok(Arc::clone(graph));
        }
        let (world_from_model, ground) = self.standing(height)?;
        let is_fur = |tag: &SurfaceTag| tag.kind == SurfaceKind::Fur;
        let grips = if self.collider.tags().iter().any(is_fur) {
            vec![SurfaceKind::Fur, SurfaceKind::Stone]
        } else {
            vec![SurfaceKind::Skin, SurfaceKind::Fur, SurfaceKind::Stone]
        };
        let config = GraphConfig {
            grips,
            world_from_model,
            ground,
            clip_rate: rate,
            plates: plates.to_vec(),
            ..GraphConfig::new(*climber)
        };
        let graph = ClimbGraph::build(&self.rig(), &config, |_| ControlFlow::Continue(()))?;
        let graph = Arc::new(graph);
        known.push((key, Arc::clone(&graph)));
        Ok(graph)
    }

    /// Where it stands at rest when it is so many metres tall, and the height of the ground there, metres.
    ///
    /// # Errors
    /// [`RigError`] if it cannot be posed.
    pub fn standing(&self, height: f64) -> Result<(Similarity, f64), RigError> {
        let palette = self.skeleton.palette(&self.skeleton.rest_pose())?;
        let rest = skin(&self.collider, palette.matrices()).unwrap_or_default();
        let low = rest.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
        let high = rest.iter().map(|p| p.y).fold(f32::NEG_INFINITY, f32::max);
        let scale = height / f64::from(high - low);
        Ok((Similarity::from_scale(scale), f64::from(low) * scale))
    }

    /// Area of its skin at rest when it is so many metres tall, square metres.
    pub fn area(&self, height: f64) -> f64 {
        let Ok((place, _)) = self.standing(height) else {
            return 0.0;
        };
        let palette = self.skeleton.palette(&self.skeleton.rest_pose());
        let palette = palette.unwrap_or_default();
        let rest = skin(&self.collider, palette.matrices()).unwrap_or_default();
        let area = |corners: &[VertexId; 3]| {
            let [a, b, c] = corners.map(|vertex| rest[vertex.index()].as_dvec3() * place.scale);
            0.5 * (b - a).cross(c - a).length()
        };
        self.collider.triangles().iter().map(area).sum()
    }

    /// Skeleton, clips, collider, materials and weak points.
    pub fn rig(&self) -> Rig {
        let mut rig = Rig::new(self.skeleton.clone(), Arc::clone(&self.collider));
        rig.clips.clone_from(&self.clips);
        rig.collider_materials.clone_from(&self.materials);
        rig.weak_points.clone_from(&self.weak_points);
        rig
    }

    /// The creature with a brain, to live by it.
    ///
    /// # Errors
    /// As [`CreatureKind::new`].
    pub fn with_brain(&self, brain: Brain) -> Result<CreatureKind, ColossusError> {
        CreatureKind::new(&self.rig(), brain)
    }

    /// The creature as it is when it lives by a brain, whose file may turn it, and say more of its clips, fur and weak
    /// points.
    pub(crate) fn as_it_lives(&self, kind: &CreatureKind) -> Self {
        // What the kind adds to them is no clip of the file: breath, which it plays on top of others.
        let clips = kind.clips().clips().iter().take(self.clips.len());
        Self {
            skeleton: kind.skeleton().clone(),
            clips: clips.cloned().collect(),
            collider: Arc::clone(kind.mesh()),
            weak_points: kind.weak_points().to_vec(),
            ..self.clone()
        }
    }

    /// The first clip whose name contains one of `words`. Words must be in lower case, names match in any case,
    /// and an earlier word wins.
    pub fn clip_like(&self, words: &[&str]) -> Option<&Clip> {
        words.iter().find_map(|word| {
            let matches = |clip: &&Clip| clip.name.to_lowercase().contains(word);
            self.clips.iter().find(matches)
        })
    }

    /// Lowest and highest corner of the skin's bounding box in a pose, in model space.
    ///
    /// # Errors
    /// [`CreatureError`] if the pose does not fit the skeleton.
    pub fn bounds(&self, pose: &Pose) -> Result<(Vec3, Vec3), CreatureError> {
        let palette: Palette = self.skeleton.palette(pose)?;
        let positions = skin(&self.collider, palette.matrices())?;
        let around = |(low, high): (Vec3, Vec3), p: &Vec3| (low.min(*p), high.max(*p));
        Ok(positions
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), around))
    }
}
