use std::path::Path;
use std::sync::Arc;

use clamber_gltf::{GltfError, LoadOptions};
use clamber_surface::mesh::{ColliderMesh, MeshError, PaletteError};
use clamber_surface::rig::{Clip, Palette, Pose, RigError, Skeleton};
use clamber_surface::skin::skin;
use clamber_surface::surface::SurfaceError;
use glam::Vec3;
use thiserror::Error;

/// What a scene needs of a creature, from code or from a file.
#[derive(Clone, Debug)]
pub struct Creature {
    /// For reports.
    pub name: String,
    /// Its joints.
    pub skeleton: Skeleton,
    /// Its motions.
    pub clips: Vec<Clip>,
    /// Its skin.
    pub collider: Arc<ColliderMesh>,
    /// Model units that its walk covers in a second, where that is known.
    pub walk_speed: Option<f64>,
}

/// Why a creature cannot play in a scene.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CreatureError {
    /// Its file cannot be loaded.
    #[error(transparent)]
    Load(#[from] GltfError),
    /// Its skeleton cannot be posed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// Its mesh cannot be built.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Its skin cannot be posed.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// Its palette does not fit its mesh.
    #[error(transparent)]
    Palette(#[from] PaletteError),
}

impl Creature {
    /// From its pieces.
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
            walk_speed: None,
        }
    }

    /// From a `.glb` or `.gltf` file.
    ///
    /// # Errors
    /// [`CreatureError::Load`].
    pub fn load(path: &Path) -> Result<Self, CreatureError> {
        let rig = clamber_gltf::load_with(path, &LoadOptions::default())?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        Ok(Self::new(name, rig.skeleton, rig.clips, rig.collider))
    }

    /// The clip whose name contains one of `words`, in any case; the earlier word wins.
    pub fn clip_like(&self, words: &[&str]) -> Option<&Clip> {
        words.iter().find_map(|word| {
            let matches = |clip: &&Clip| clip.name.to_lowercase().contains(word);
            self.clips.iter().find(matches)
        })
    }

    /// Lowest and highest corner of a box around the skin in a pose, in model space.
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
