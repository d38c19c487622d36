//! A creature's body at rest: the places of its joints, and the skin that each joint moves.

use std::collections::{BTreeMap, BTreeSet};

use clamber_animation::joint_in_model;
use clamber_animation::rig::{JointId, Pose, Skeleton};
use clamber_surface::mesh::{ColliderMesh, VertexId};
use glam::DVec3;

use crate::error::ColossusError;
use crate::kind::{CreatureKind, RestSkin};

/// A creature at rest, looking along +Z.
pub(super) struct Look<'a> {
    pub(super) skeleton: &'a Skeleton,
    mesh: &'a ColliderMesh,
    /// Per vertex, the joint that moves it most.
    movers: Vec<Option<JointId>>,
    /// Per joint, its place.
    pub(super) places: Vec<DVec3>,
    /// Per joint, the places of the vertices that it moves more than any other joint does.
    pub(super) skin: Vec<Vec<DVec3>>,
    /// Height of the lowest skin, and height of the whole skin. All lengths here are in the model's units.
    pub(super) low: f64,
    pub(super) height: f64,
}

impl<'a> Look<'a> {
    pub(super) fn at(kind: &'a CreatureKind) -> Result<Self, ColossusError> {
        let (skeleton, mesh) = (kind.skeleton(), kind.mesh());
        let rest = RestSkin::new(skeleton, mesh)?;
        let mut skin = vec![Vec::new(); skeleton.joints().len()];
        let mut movers = Vec::new();
        for (index, place) in rest.positions.iter().enumerate() {
            let influences = mesh.influences(VertexId(index as u32));
            let most = influences.max_by(|a, b| a.1.total_cmp(&b.1));
            let mover = most.map(|(joint, _)| joint);
            if let Some(joint) = mover {
                skin[joint.index()].push(place.as_dvec3());
            }
            movers.push(mover);
        }
        let places = joints(skeleton).map(|joint| place(skeleton, &skeleton.rest_pose(), joint));
        Ok(Self {
            places: places.collect(),
            skin,
            low: rest.low.y,
            height: rest.height(),
            skeleton,
            mesh,
            movers,
        })
    }

    pub(super) fn joints(&self) -> impl Iterator<Item = JointId> + use<> {
        joints(self.skeleton)
    }

    pub(super) fn name(&self, joint: JointId) -> &'a str {
        &self.skeleton.joints()[joint.index()].name
    }

    /// True if the joint's name, as a pattern in a brain file, names only this joint: names may repeat, and `*` stands
    /// for any text.
    pub(super) fn is_named(&self, joint: JointId) -> bool {
        let name = self.name(joint);
        self.skeleton.find(name) == Some(joint) && !name.contains('*')
    }

    pub(super) fn parent(&self, joint: JointId) -> Option<JointId> {
        self.skeleton.joints()[joint.index()].parent
    }

    /// A joint and all joints above it.
    pub(super) fn upward(&self, joint: JointId) -> impl Iterator<Item = JointId> {
        core::iter::successors(Some(joint), |joint| self.parent(*joint))
    }

    pub(super) fn place(&self, joint: JointId) -> DVec3 {
        self.places[joint.index()]
    }

    pub(super) fn skin(&self, joint: JointId) -> &[DVec3] {
        &self.skin[joint.index()]
    }

    /// Centre of a joint's skin relative to the joint, along the model's axes; `None` if it moves no skin.
    pub(super) fn middle(&self, joint: JointId) -> Option<DVec3> {
        let skin = self.skin(joint);
        let sum: DVec3 = skin.iter().sum();
        (!skin.is_empty()).then(|| sum / skin.len() as f64 - self.place(joint))
    }

    /// The joints that share triangles of the skin with a joint, each with the number of those triangles.
    pub(super) fn neighbours(&self, joint: JointId) -> BTreeMap<JointId, usize> {
        let mut found = BTreeMap::new();
        for corners in self.mesh.triangles() {
            let movers = corners.map(|vertex| self.movers[vertex.index()]);
            if movers.contains(&Some(joint)) {
                let others: BTreeSet<JointId> = movers.into_iter().flatten().collect();
                for other in others.into_iter().filter(|other| *other != joint) {
                    *found.entry(other).or_default() += 1;
                }
            }
        }
        found
    }

    /// The joint of the head: the joint with the shortest name among those that move skin and have `head` in their
    /// names.
    pub(super) fn head(&self) -> Option<JointId> {
        let named = self.joints().filter(|joint| {
            let name = self.name(*joint).to_lowercase();
            name.contains("head") && !self.skin(*joint).is_empty() && self.is_named(*joint)
        });
        named.min_by_key(|joint| self.name(*joint).len())
    }

    /// A length in heights of the creature, as in brain files, rounded to a thousandth.
    pub(super) fn in_heights(&self, length: f64) -> f64 {
        rounded(length / self.height, 1e3)
    }
}

fn joints(skeleton: &Skeleton) -> impl Iterator<Item = JointId> + use<> {
    (0..skeleton.joints().len() as u32).map(JointId)
}

/// Place of a joint in a pose, in model space.
pub(super) fn place(skeleton: &Skeleton, pose: &Pose, joint: JointId) -> DVec3 {
    joint_in_model(skeleton, pose, joint).map_or(DVec3::ZERO, |frame| frame.translation)
}

/// A number rounded to a multiple of 1 / `steps`; never -0, which looks odd in a file.
pub(super) fn rounded(number: f64, steps: f64) -> f64 {
    (number * steps).round() / steps + 0.0
}
