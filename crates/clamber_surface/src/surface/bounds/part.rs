use super::{JointMaps, NodeBounds};
use crate::geometry::{BoundingVolume, Capsule, Sphere};
use crate::mesh::{ColliderMesh, PartId};

/// Bounds of the parts of a mesh under any palette, without skinning: O(joints of the part) each.
///
/// Made once a mesh, and shared by its surfaces; an edited mesh needs a new one. Every bound holds
/// every vertex of its part as [`crate::skin::skin`] computes it.
///
/// ```
/// use clamber_surface::geometry::Affine;
/// use clamber_surface::mesh::{BuildOptions, ColliderMesh, Influence, MeshSource, PartId};
/// use clamber_surface::rig::{JointId, Palette};
/// use clamber_surface::surface::{JointMaps, PartBounds};
/// use glam::Vec3;
///
/// let (mesh, _) = ColliderMesh::build(
///     &MeshSource {
///         positions: &[Vec3::ZERO, Vec3::X, Vec3::Y],
///         triangles: &[[0, 1, 2]],
///         influences: &[Influence { joint: JointId(0), weight: 1.0 }; 3],
///         joint_count: 1,
///         ..MeshSource::default()
///     },
///     &BuildOptions::default(),
/// )?;
/// let bounds = PartBounds::new(&mesh);
///
/// let mut lifted = Affine::IDENTITY;
/// lifted.rows[2][3] = 5.0;
/// let maps = JointMaps::new(&mesh, &Palette::from_matrices([lifted]))?;
/// let sphere = bounds.sphere(PartId(0), &maps).unwrap();
/// assert!(sphere.contains(Vec3::new(1.0, 0.0, 5.0)));
/// assert!(sphere.radius < 0.75);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PartBounds {
    parts: Vec<Option<NodeBounds>>,
}

impl PartBounds {
    /// Reads the rest data of every part.
    pub fn new(mesh: &ColliderMesh) -> Self {
        let parts = mesh.parts().iter();
        Self {
            parts: parts
                .map(|part| NodeBounds::new(mesh, &part.vertices))
                .collect(),
        }
    }

    /// How many parts there are, those without triangles included.
    pub fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// The rest data of a part; `None` if it does not exist or has no triangles left.
    pub fn node(&self, part: PartId) -> Option<&NodeBounds> {
        self.parts.get(part.index())?.as_ref()
    }

    /// The part's bounding sphere, in model space: [`NodeBounds::sphere`]. `None` as for
    /// [`PartBounds::node`].
    ///
    /// # Panics
    /// If `maps` belong to a mesh with fewer joints; so do the two below.
    pub fn sphere(&self, part: PartId, maps: &JointMaps) -> Option<Sphere> {
        self.node(part).map(|node| node.sphere(maps))
    }

    /// The part's bounding capsule, in model space: [`NodeBounds::capsule`]. `None` as for
    /// [`PartBounds::node`].
    pub fn capsule(&self, part: PartId, maps: &JointMaps) -> Option<Capsule> {
        self.node(part).map(|node| node.capsule(maps))
    }

    /// The sphere, or the capsule where its volume is smaller. `None` as for [`PartBounds::node`].
    pub fn volume(&self, part: PartId, maps: &JointMaps) -> Option<BoundingVolume> {
        self.node(part).map(|node| node.volume(maps))
    }
}
