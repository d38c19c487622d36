use std::collections::BTreeMap;
use std::sync::Arc;

use clamber_surface::mesh::{BuildReport, ColliderMesh, MeshError, TriangleId};
use clamber_surface::rig::{Clip, Skeleton, WeakPoint};

use crate::visual::{self, Material, VisualMesh};
use crate::warning::ImportWarning;

/// A creature that was loaded from a file.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Rig {
    /// The joints of the skins, in the skins' order, then the nodes of rigid meshes, then all other nodes above these.
    /// A node is several joints if skins give it different inverse bind matrices. Node 3 without a name is called
    /// `"node 3"`.
    pub skeleton: Skeleton,
    /// The clips that move the skeleton, in the order of the file. Animation 3 without a name is called `"clip 3"`.
    pub clips: Vec<Clip>,
    /// The mesh that a climber touches: all collision meshes, merged.
    pub collider: Arc<ColliderMesh>,
    /// The meshes to draw, not merged.
    pub visual: Vec<VisualMesh>,
    /// All materials of the file, in its order.
    pub materials: Vec<Material>,
    /// The collider's triangles by the name of their material, ascending. Materials of the same name are merged;
    /// triangles without a named material are left out.
    pub collider_materials: BTreeMap<String, Vec<TriangleId>>,
    /// The weak points, in the order of the file's nodes.
    pub weak_points: Vec<WeakPoint>,
    /// The import's report: the collider's build, the scale, and all that was skipped or repaired.
    pub report: ImportReport,
}

impl Rig {
    /// A creature made in code, from a skeleton and a collider. The other fields are empty.
    pub fn new(skeleton: Skeleton, collider: Arc<ColliderMesh>) -> Self {
        Self {
            skeleton,
            clips: Vec::new(),
            collider,
            visual: Vec::new(),
            materials: Vec::new(),
            collider_materials: BTreeMap::new(),
            weak_points: Vec::new(),
            report: ImportReport::default(),
        }
    }

    /// The first clip with this name, if there is one. The name is `"clip 3"` for animation 3 without a name.
    pub fn clip(&self, name: &str) -> Option<&Clip> {
        self.clips.iter().find(|clip| clip.name == name)
    }

    /// Merges the visual meshes into one mesh that can be queried like the collider.
    ///
    /// # Errors
    /// [`MeshError`] as [`ColliderMesh::build`] gives it: [`MeshError::InfluenceCount`] if there are no visual meshes,
    /// [`MeshError::NoTriangles`] if none has a triangle with area, [`MeshError::Position`] for a vertex farther than
    /// 2^99 from the origin, [`MeshError::TooLarge`] for too many vertices or joints.
    pub fn visual_collider(&self) -> Result<ColliderMesh, MeshError> {
        let joints = self.skeleton.joints().len();
        visual::merged(&self.visual, joints)
    }
}

/// The report of an import: the collider's build, the scale, and all that was skipped or repaired.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct ImportReport {
    /// The report of building the collider mesh.
    pub build: BuildReport,
    /// The factor by which [`LoadOptions::with_height`](crate::LoadOptions::with_height) scaled the creature; `None` if
    /// no height was set. Multiply your own lengths and speeds in file units by it.
    pub scale: Option<f64>,
    /// Objects that were skipped or repaired, in the order in which they were found.
    pub warnings: Vec<ImportWarning>,
}
