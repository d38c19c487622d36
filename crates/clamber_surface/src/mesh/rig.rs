use std::collections::BTreeMap;
use std::sync::Arc;

use super::{ColliderMesh, TriangleId};
use crate::rig::{Clip, Skeleton, WeakPoint};

/// A creature as its file describes it: skeleton, clips, skin and weak points.
///
/// `clamber_gltf` loads one from a glTF file. A living creature, a climb graph and a recording are all made from it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Rig {
    /// The joints.
    pub skeleton: Skeleton,
    /// The clips that move the skeleton.
    pub clips: Vec<Clip>,
    /// The skin that a climber touches, with the tags of its triangles.
    pub collider: Arc<ColliderMesh>,
    /// Per name of a material, the collider's triangles that have it, ascending.
    pub collider_materials: BTreeMap<String, Vec<TriangleId>>,
    /// The places at which the creature can be wounded.
    pub weak_points: Vec<WeakPoint>,
}

impl Rig {
    /// A rig without clips, materials and weak points.
    pub fn new(skeleton: Skeleton, collider: Arc<ColliderMesh>) -> Self {
        Self {
            skeleton,
            clips: Vec::new(),
            collider,
            collider_materials: BTreeMap::new(),
            weak_points: Vec::new(),
        }
    }

    /// The first clip with this name, if there is one.
    pub fn clip(&self, name: &str) -> Option<&Clip> {
        self.clips.iter().find(|clip| clip.name == name)
    }
}
