use std::fmt;

use glam::DAffine3;

use super::{Palette, Pose, RigError, Transform};
use crate::geometry::Affine;

/// Index of a joint in its skeleton, and of its matrix in a palette.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct JointId(pub u32);

impl JointId {
    /// The id as an index into a slice.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl fmt::Display for JointId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

/// One joint of a skeleton, at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name for display and for [`Skeleton::find`]; need not be unique. `clamber_gltf` names a node without a name
    /// by its index: `"node 3"`.
    pub name: String,
    /// The parent joint; `None` for a root.
    pub parent: Option<JointId>,
    /// The transform at rest, relative to the parent.
    pub rest: Transform,
    /// Inverse bind matrix, `joint_from_mesh`: maps mesh space to the joint's space at rest. The identity for
    /// joints that skin nothing.
    pub inverse_bind: Affine,
}

/// A forest of joints. In joint order, parents may come after their children.
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    joints: Vec<Joint>,
    /// Indices of the joints, every parent before its children.
    order: Vec<u32>,
}

impl Skeleton {
    /// Builds a skeleton from joints in any order.
    ///
    /// # Errors
    /// [`RigError::ParentOutOfRange`] if a parent does not exist, [`RigError::Cycle`] if a joint is its own
    /// ancestor, [`RigError::NotFinite`] if a rest transform or an inverse bind matrix is not finite, or a rotation
    /// has length zero.
    pub fn new(joints: Vec<Joint>) -> Result<Self, RigError> {
        for (index, joint) in joints.iter().enumerate() {
            let id = JointId(index as u32);
            if let Some(parent) = joint.parent
                && parent.0 as usize >= joints.len()
            {
                return Err(RigError::ParentOutOfRange {
                    joint: id,
                    parent,
                    joints: joints.len(),
                });
            }
            if !joint.rest.is_valid() || !joint.inverse_bind.is_finite() {
                return Err(RigError::NotFinite {
                    what: format!("joint {id} ({})", joint.name),
                });
            }
        }
        let order = parents_first(&joints)?;
        Ok(Self { joints, order })
    }

    /// The joints, in joint order.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// The first joint with this name; `None` if no joint has it.
    pub fn find(&self, name: &str) -> Option<JointId> {
        let index = self.joints.iter().position(|joint| joint.name == name)?;
        Some(JointId(index as u32))
    }

    /// True if `joint` is `ancestor` or one of its descendants. False for a joint that does not exist. O(depth).
    ///
    /// For example, the joints of an arm are those for which this is true with the shoulder as `ancestor`.
    pub fn is_descendant_or_self(&self, joint: JointId, ancestor: JointId) -> bool {
        let parent = |joint: &JointId| {
            self.joints
                .get(joint.index())
                .and_then(|joint| joint.parent)
        };
        let exists = joint.index() < self.joints.len();
        // Ends at a root: a skeleton has no cycles.
        exists && core::iter::successors(Some(joint), parent).any(|joint| joint == ancestor)
    }

    /// The pose in which every joint is at rest.
    pub fn rest_pose(&self) -> Pose {
        Pose {
            transforms: self.joints.iter().map(|joint| joint.rest).collect(),
        }
    }

    /// The palette of a pose.
    ///
    /// # Errors
    /// As [`Skeleton::palette_into`].
    pub fn palette(&self, pose: &Pose) -> Result<Palette, RigError> {
        let mut palette = Palette::default();
        self.palette_into(pose, &mut palette)?;
        Ok(palette)
    }

    /// [`Skeleton::palette`] into an existing palette, which keeps its memory.
    ///
    /// Composes in f64 from root to leaf, and rounds each element of the product with the inverse bind matrix once,
    /// so its error is half a unit in the last place of f32. An element that overflows f32 is infinite, and
    /// surfaces refuse such a palette.
    ///
    /// # Errors
    /// [`RigError::JointCount`] if the pose and the skeleton differ in their number of joints,
    /// [`RigError::NotFinite`] if a transform is not finite or a rotation has length zero. The palette is unchanged
    /// then.
    pub fn palette_into(&self, pose: &Pose, palette: &mut Palette) -> Result<(), RigError> {
        pose.check_joint_count(self.joints.len())?;
        pose.validate()?;
        let globals = &mut palette.model_from_joint;
        globals.resize(self.joints.len(), DAffine3::IDENTITY);
        for &index in &self.order {
            let index = index as usize;
            let local = pose.transforms[index].to_affine();
            globals[index] = match self.joints[index].parent {
                Some(parent) => globals[parent.0 as usize] * local,
                None => local,
            };
        }
        palette.matrices.clear();
        let matrices = globals
            .iter()
            .zip(&self.joints)
            .map(|(global, joint)| Affine::from_f64(&(*global * joint.inverse_bind.to_f64())));
        palette.matrices.extend(matrices);
        Ok(())
    }
}

/// An order of joint indices with every parent before its children.
fn parents_first(joints: &[Joint]) -> Result<Vec<u32>, RigError> {
    let mut order = Vec::with_capacity(joints.len());
    let mut placed = vec![false; joints.len()];
    let mut chain = Vec::new();
    for start in 0..joints.len() {
        let mut next = Some(start);
        while let Some(index) = next.filter(|&index| !placed[index]) {
            // A chain of unplaced ancestors that is longer than all joints contains one joint twice.
            if chain.len() == joints.len() {
                return Err(RigError::Cycle(JointId(start as u32)));
            }
            chain.push(index as u32);
            next = joints[index].parent.map(|parent| parent.0 as usize);
        }
        while let Some(index) = chain.pop() {
            placed[index as usize] = true;
            order.push(index);
        }
    }
    Ok(order)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rotation_from_axis_angle;
    use crate::rig::transform::rotation_f32;
    use glam::{DVec3, Vec3};

    fn joint(parent: Option<u32>, x: f32) -> Joint {
        Joint {
            name: format!("at {x}"),
            parent: parent.map(JointId),
            rest: Transform::from_translation(Vec3::new(x, 0.0, 0.0)),
            inverse_bind: Affine::IDENTITY,
        }
    }

    #[test]
    fn children_follow_parents_that_come_later() {
        // The parent of joint 0 is joint 2, and the parent of joint 2 is joint 1.
        let skeleton = Skeleton::new(vec![
            joint(Some(2), 1.0),
            joint(None, 10.0),
            joint(Some(1), 5.0),
        ])
        .unwrap();
        let mut pose = skeleton.rest_pose();
        let palette = skeleton.palette(&pose).unwrap();
        assert_eq!(palette.matrices()[0].rows[0][3], 16.0);
        // A quarter turn of the root about Z lays the chain along Y.
        let turn = rotation_from_axis_angle(DVec3::Z, core::f64::consts::FRAC_PI_2);
        pose.transforms[1].rotation = rotation_f32(turn);
        let palette = skeleton.palette(&pose).unwrap();
        let tip = palette.matrices()[0].transform_point(Vec3::ZERO);
        assert!((tip - Vec3::new(10.0, 6.0, 0.0)).length() < 1e-6, "{tip}");
    }

    #[test]
    fn impossible_trees_are_refused() {
        use RigError as E;
        let refused = |joints: &[Joint]| Skeleton::new(joints.to_vec()).unwrap_err();
        let both = refused(&[joint(Some(1), 0.0), joint(Some(0), 0.0)]);
        assert!(matches!(both, E::Cycle(_)));
        let own = refused(&[joint(Some(0), 0.0)]);
        assert!(matches!(own, E::Cycle(JointId(0))));
        let nobody = refused(&[joint(Some(7), 0.0)]);
        assert!(matches!(nobody, E::ParentOutOfRange { .. }));
        let nowhere = refused(&[joint(None, f32::NAN)]);
        assert!(matches!(nowhere, E::NotFinite { .. }));
    }

    #[test]
    fn descendants_are_found_at_any_depth_and_order() {
        // Two trees: 1 > 2 > 0, 2 > 4, and 3 alone.
        let parents = [Some(2), None, Some(1), None, Some(2)];
        let joints = parents.map(|parent| joint(parent, 0.0));
        let skeleton = Skeleton::new(joints.to_vec()).unwrap();
        let below = [(0, 2), (0, 1), (2, 1), (4, 2), (4, 1)];
        for (a, b) in (0..7).flat_map(|a| (0..7).map(move |b| (a, b))) {
            let expected = a < 5 && (a == b || below.contains(&(a, b)));
            let found = skeleton.is_descendant_or_self(JointId(a), JointId(b));
            assert_eq!(found, expected, "{a} below {b}");
        }
    }

    #[test]
    fn a_bad_pose_leaves_the_palette_alone() {
        let skeleton = Skeleton::new(vec![joint(None, 1.0)]).unwrap();
        let mut palette = skeleton.palette(&skeleton.rest_pose()).unwrap();
        let before = palette.clone();
        let mut pose = skeleton.rest_pose();
        pose.transforms[0].translation.y = f32::INFINITY;
        assert!(skeleton.palette_into(&pose, &mut palette).is_err());
        let empty = skeleton.palette_into(&Pose::default(), &mut palette);
        assert!(empty.is_err());
        assert_eq!(palette, before);
    }
}
