use clamber_animation::joint_in_model;
use clamber_animation::rig::{JointId, Playback};
use glam::DVec3;

use super::{Leg, Names};
use crate::brain::{Attack, BrainProblem};

/// An attack of a kind of creature.
#[derive(Clone, Debug)]
pub(crate) struct Strike {
    /// Joints whose skin hurts.
    pub(crate) limb: Vec<JointId>,
    /// Seconds of the clip: from here on it hurts, and until here.
    pub(crate) active: [f64; 2],
    /// Hit points, and metres a second.
    pub(crate) damage: f64,
    pub(crate) throw: f64,
    /// Metres.
    pub(crate) aim: f64,
    /// Where the limb's last joint is when it stops to hurt, in model space.
    pub(crate) spot: DVec3,
    /// The leg that strikes, if one does: its index.
    pub(crate) leg: Option<usize>,
}

impl Strike {
    pub(crate) fn new(
        names: &Names<'_>,
        attack: &Attack,
        limb: Vec<JointId>,
        legs: &[Leg],
    ) -> Result<Self, BrainProblem> {
        let id = names.clip(&attack.clip)?;
        let phases = || BrainProblem::Phases {
            clip: attack.clip.clone(),
        };
        let clip = names.clips.clip(id).map_err(|_| phases())?;
        let marker = |name: &str| {
            clip.markers()
                .iter()
                .find(|marker| marker.name == name)
                .map(|marker| marker.time)
        };
        let (Some(from), Some(to)) = (marker("active"), marker("recovery")) else {
            return Err(phases());
        };
        if from >= to || limb.is_empty() {
            return Err(phases());
        }
        let end = limb[limb.len() - 1];
        let pose = clip
            .sample(names.clips.rest(), to, Playback::Clamp)
            .map_err(|_| phases())?;
        let spot = joint_in_model(names.skeleton, &pose, end)
            .map_or(DVec3::ZERO, |frame| frame.translation);
        let leg = legs.iter().position(|leg| limb.contains(&leg.ankle));
        Ok(Self {
            limb,
            active: [from, to],
            damage: attack.damage,
            throw: attack.throw,
            aim: attack.aim,
            spot,
            leg,
        })
    }

    /// True for skin of a joint that hurts.
    pub(crate) fn hurts(&self, joint: JointId) -> bool {
        self.limb.contains(&joint)
    }
}
