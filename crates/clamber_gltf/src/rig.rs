use std::sync::Arc;

use clamber_surface::mesh::{BuildReport, ColliderMesh, MeshError};
use clamber_surface::rig::{Clip, Skeleton, WeakPoint};

use crate::visual::{self, Material, VisualMesh};
use crate::warning::ImportWarning;

/// A creature as a file describes it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Rig {
    /// The joints of the skins first, in the skins' order, then the nodes of rigid meshes, then the
    /// other nodes that all these hang under. Node 3 without a name is called `"node 3"`.
    pub skeleton: Skeleton,
    /// The clips that move the skeleton, in the order of the file. Animation 3 without a name is called `"clip 3"`.
    pub clips: Vec<Clip>,
    /// What a climber touches: all meshes that are for collision, as one.
    pub collider: Arc<ColliderMesh>,
    /// The meshes to be drawn, each by itself.
    pub visual: Vec<VisualMesh>,
    /// All materials of the file, in its order.
    pub materials: Vec<Material>,
    /// Where the creature can be wounded, in the order of the file's nodes.
    pub weak_points: Vec<WeakPoint>,
    /// What the import found.
    pub report: ImportReport,
}

impl Rig {
    /// A creature made in code, with nothing else than a skeleton and a collider; the other fields are empty.
    pub fn new(skeleton: Skeleton, collider: Arc<ColliderMesh>) -> Self {
        Self {
            skeleton,
            clips: Vec::new(),
            collider,
            visual: Vec::new(),
            materials: Vec::new(),
            weak_points: Vec::new(),
            report: ImportReport::default(),
        }
    }

    /// The first clip of this name; `"clip 3"` for animation 3 without a name.
    pub fn clip(&self, name: &str) -> Option<&Clip> {
        self.clips.iter().find(|clip| clip.name == name)
    }

    /// The meshes to be drawn, as one mesh that can be queried like the collider.
    ///
    /// # Errors
    /// [`MeshError`] as [`ColliderMesh::build`] gives it: [`MeshError::InfluenceCount`] if there are no such meshes,
    /// [`MeshError::NoTriangles`] if none has a triangle with area, [`MeshError::Position`] for a vertex farther than
    /// 2^99 from the origin, [`MeshError::TooLarge`] for too many vertices.
    pub fn visual_collider(&self) -> Result<ColliderMesh, MeshError> {
        let joints = self.skeleton.joints().len();
        visual::merged(&self.visual, joints)
    }
}

/// What an import found, changed and passed over.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct ImportReport {
    /// About the collider mesh.
    pub build: BuildReport,
    /// The factor that [`LoadOptions::with_height`](crate::LoadOptions::with_height) led to; `None` if no height was
    /// asked for. Multiply your own lengths and speeds in file units by it.
    pub scale: Option<f64>,
    /// What was passed over or mended, in the order in which it was found.
    pub warnings: Vec<ImportWarning>,
}
