use std::ops::ControlFlow;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use clamber_climber::ClimberConfig;
use clamber_navigation::{ClimbGraph, GraphConfig};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{Rig, SurfaceKind, SurfaceTag, TriangleId};
use clamber_surface::rig::{Clip, Palette, Playback, Pose, RigError, WeakPoint};
use clamber_surface::skin::skin;
use clamber_surface::surface::creature_fingerprint;
use glam::Vec3;

use crate::SceneError;

/// A creature as scenes use it, built in code or loaded from a file.
#[derive(Clone, Debug)]
pub struct Creature {
    /// The name that reports print.
    pub name: String,
    /// Skeleton, clips, skin, materials and weak points.
    pub rig: Rig,
    /// Speed of the walk clip, model units a second; `None` if unknown.
    pub walk_speed: Option<f64>,
    /// The graphs that were made of it.
    pub(crate) graphs: Graphs,
}

/// Graphs, by the fingerprint of the creature, its weak points, and the configuration.
pub(crate) type Graphs = Arc<Mutex<Vec<(GraphKey, Arc<ClimbGraph>)>>>;
type GraphKey = (u64, Vec<WeakPoint>, GraphConfig);

impl Creature {
    /// A creature with an unknown walk speed.
    pub fn new(name: impl Into<String>, rig: Rig) -> Self {
        Self {
            name: name.into(),
            rig,
            walk_speed: None,
            graphs: Graphs::default(),
        }
    }

    /// Loads a creature from a `.glb` or `.gltf` file, and names it after the file. The walk speed is unknown.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let rig = clamber_gltf::load(path)?.rig;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        Ok(Self::new(name, rig))
    }

    /// The graph of its skin for a climber, when it is so many metres tall, stands on the ground, plays its clips at
    /// this rate, and has plates. A climber grips fur and stone, or all of it if it has no fur. It is made once for
    /// each size: clones share it.
    pub fn graph(
        &self,
        climber: &ClimberConfig,
        height: f64,
        rate: f64,
        plates: &[Vec<TriangleId>],
    ) -> Result<Arc<ClimbGraph>, SceneError> {
        let rig = &self.rig;
        let (world_from_model, ground) = self.standing(height)?;
        let is_fur = |tag: &SurfaceTag| tag.kind == SurfaceKind::Fur;
        let mut grips = vec![SurfaceKind::Fur, SurfaceKind::Stone];
        if !rig.collider.tags().iter().any(is_fur) {
            grips.insert(0, SurfaceKind::Skin);
        }
        let config = GraphConfig {
            grips,
            world_from_model,
            ground,
            clip_rate: rate,
            plates: plates.to_vec(),
            ..GraphConfig::new(*climber)
        };
        let body = creature_fingerprint(&rig.skeleton, &rig.clips, &rig.collider);
        let key = (body, rig.weak_points.clone(), config);
        let mut known = self.graphs.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, graph)) = known.iter().find(|(other, _)| *other == key) {
            return Ok(Arc::clone(graph));
        }
        let graph = ClimbGraph::build(rig, &key.2, |_| ControlFlow::Continue(()))?;
        let graph = Arc::new(graph);
        known.push((key, Arc::clone(&graph)));
        Ok(graph)
    }

    /// Where it stands at rest when it is so many metres tall, and the height of the ground there, metres.
    pub fn standing(&self, height: f64) -> Result<(Similarity, f64), SceneError> {
        let (low, high) = self.bounds(&self.rig.skeleton.rest_pose())?;
        let scale = height / f64::from(high.y - low.y);
        Ok((Similarity::from_scale(scale), f64::from(low.y) * scale))
    }

    /// The palette at rest.
    pub fn rest_palette(&self) -> Result<Palette, RigError> {
        self.rig.skeleton.palette(&self.rig.skeleton.rest_pose())
    }

    /// The palette of a clip that is repeated, after some seconds.
    pub fn palette(&self, clip: &str, seconds: f64) -> Result<Palette, SceneError> {
        let found = self.rig.clip(clip);
        let clip = found.ok_or_else(|| format!("{} has no clip {clip}", self.name))?;
        let rest = self.rig.skeleton.rest_pose();
        let pose = clip.sample(&rest, seconds, Playback::Loop)?;
        Ok(self.rig.skeleton.palette(&pose)?)
    }

    /// The positions of all vertices at rest, in model space.
    pub fn at_rest(&self) -> Result<Vec<Vec3>, SceneError> {
        let palette = self.rest_palette()?;
        Ok(skin(&self.rig.collider, palette.matrices())?)
    }

    /// The first clip whose name contains one of `words`. Words must be in lower case, names match in any case,
    /// and an earlier word wins.
    pub fn clip_like(&self, words: &[&str]) -> Option<&Clip> {
        Some(&self.rig.clips[self.clip_index(words)?])
    }

    /// The index of [`Creature::clip_like`].
    pub fn clip_index(&self, words: &[&str]) -> Option<usize> {
        words.iter().find_map(|word| {
            let matches = |clip: &Clip| clip.name.to_lowercase().contains(word);
            self.rig.clips.iter().position(matches)
        })
    }

    /// Lowest and highest corner of the skin's bounding box in a pose, in model space.
    pub fn bounds(&self, pose: &Pose) -> Result<(Vec3, Vec3), SceneError> {
        let palette = self.rig.skeleton.palette(pose)?;
        let positions = skin(&self.rig.collider, palette.matrices())?;
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for position in positions {
            (low, high) = (low.min(position), high.max(position));
        }
        Ok((low, high))
    }
}
