use std::sync::Arc;

use clamber_surface::geometry::Similarity;
use clamber_surface::rig::{JointId, Palette, Skeleton};
use foxglove::messages::FrameTransform;
use glam::{DAffine3, DQuat, DVec3};

use super::{WORLD, frame, upright};

/// Names and parents of a figure's joints.
#[derive(Debug)]
pub(crate) struct FigureJoints {
    pub(crate) figure: String,
    /// For each joint, the name of its frame and the index of its parent.
    pub(crate) joints: Vec<(String, Option<usize>)>,
}

impl FigureJoints {
    pub(crate) fn new(figure: &str, skeleton: &Skeleton) -> Self {
        let mut taken = std::collections::HashSet::new();
        let named = |(index, joint): (usize, &clamber_surface::rig::Joint)| {
            let mut name = format!("{figure}/{}", joint.name);
            if joint.name.is_empty() || !taken.insert(name.clone()) {
                name = format!("{name}#{index}");
                taken.insert(name.clone());
            }
            (name, joint.parent.map(JointId::index))
        };
        Self {
            figure: figure.to_owned(),
            joints: skeleton.joints().iter().enumerate().map(named).collect(),
        }
    }
}

/// A figure in a tick.
#[derive(Debug)]
pub(crate) struct TakenFigure {
    pub(crate) joints: Arc<FigureJoints>,
    pub(crate) world_from_model: Similarity,
    pub(crate) model_from_joint: Vec<DAffine3>,
}

impl TakenFigure {
    pub(crate) fn new(
        joints: Arc<FigureJoints>,
        palette: &Palette,
        world_from_model: Similarity,
    ) -> Self {
        let placed = (0..).map_while(|joint| palette.model_from_joint(JointId(joint)));
        let mut model_from_joint = Vec::with_capacity(palette.matrices().len());
        model_from_joint.extend(placed.copied());
        Self {
            joints,
            world_from_model,
            model_from_joint,
        }
    }

    /// The transforms of the figure and of its joints, each relative to its parent, so that viewers draw lines between
    /// joints. In metres and without scale.
    pub(crate) fn frames(&self, nanoseconds: u64) -> Vec<FrameTransform> {
        let root = &self.world_from_model;
        let figure = &self.joints.figure;
        let at = (root.translation, root.rotation);
        let mut transforms = vec![frame(nanoseconds, (WORLD, figure), at)];
        let placed = self.model_from_joint.iter();
        let places: Vec<(DVec3, DQuat)> = placed
            .map(|joint| (joint.translation * root.scale, upright(&joint.matrix3)))
            .collect();
        for ((name, parent), (at, turn)) in self.joints.joints.iter().zip(&places) {
            let above = parent.and_then(|parent| {
                let (above, place) = (self.joints.joints.get(parent)?, places.get(parent)?);
                Some((above.0.as_str(), *place))
            });
            let (above, (from, back)) = above.unwrap_or((figure, (DVec3::ZERO, DQuat::IDENTITY)));
            let back = back.inverse();
            let at = (back * (*at - from), back * *turn);
            transforms.push(frame(nanoseconds, (above, name), at));
        }
        transforms
    }
}
