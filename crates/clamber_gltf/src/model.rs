use clamber_surface::mesh::{BuildReport, ColliderMesh, MeshError, Rig};

use crate::visual::{self, Material, VisualMesh};
use crate::warning::ImportWarning;

/// A creature that was loaded from a file: the rig, and the meshes that are drawn.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Model {
    /// Skeleton, clips, collider and weak points.
    ///
    /// - The joints are the joints of the skins, in the skins' order, then the nodes of rigid meshes, then all other
    ///   nodes above these. A node is several joints if skins give it different inverse bind matrices. Node 3 without a
    ///   name is called `"node 3"`.
    /// - The clips have the order of the file. Animation 3 without a name is called `"clip 3"`.
    /// - The collider consists of all collision meshes, merged.
    /// - In `collider_materials`, materials of the same name are merged; triangles without a named material are left
    ///   out.
    /// - The weak points have the order of the file's nodes.
    pub rig: Rig,
    /// The meshes to draw, not merged.
    pub visual: Vec<VisualMesh>,
    /// All materials of the file, in its order.
    pub materials: Vec<Material>,
    /// The import's report: the collider's build, the scale, and all that was skipped or repaired.
    pub report: ImportReport,
}

impl Model {
    /// A creature made in code, with nothing to draw but its collider.
    pub fn new(rig: Rig) -> Self {
        Self {
            rig,
            visual: Vec::new(),
            materials: Vec::new(),
            report: ImportReport::default(),
        }
    }

    /// Merges the visual meshes into one mesh that can be queried like the collider.
    ///
    /// # Errors
    /// [`MeshError`] as [`ColliderMesh::build`] gives it: [`MeshError::InfluenceCount`] if there are no visual meshes,
    /// [`MeshError::NoTriangles`] if none has a triangle with area, [`MeshError::Position`] for a vertex farther than
    /// 2^99 from the origin, [`MeshError::TooLarge`] for too many vertices or joints.
    pub fn visual_collider(&self) -> Result<ColliderMesh, MeshError> {
        let joints = self.rig.skeleton.joints().len();
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
