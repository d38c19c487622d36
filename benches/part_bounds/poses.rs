//! A creature with the poses in which it is measured.

use clamber::rig::{Clip, Palette, Playback, Pose, RigError};
use clamber_scenes::Creature;
use clamber_scenes::part_bounds::PartBounds;

use crate::precomputed::Precomputed;

/// A creature with the rest data of its bounds.
pub(crate) struct Subject {
    pub(crate) creature: Creature,
    pub(crate) bounds: PartBounds,
    pub(crate) precomputed: Precomputed,
    /// Number of poses of each clip that `precomputed` was made from.
    samples: u32,
}

/// Position of the poses of [`Subject::between`] between two samples, as a share of the interval: half-way is farthest
/// from both.
const BETWEEN: f64 = 0.5;

impl Subject {
    pub(crate) fn new(creature: Creature, samples: u32) -> Result<Self, RigError> {
        let mut subject = Self {
            bounds: PartBounds::new(&creature.collider),
            precomputed: Precomputed::default(),
            creature,
            samples,
        };
        let palettes = subject.sampled()?;
        subject.precomputed = Precomputed::new(&subject.creature.collider, &palettes);
        Ok(subject)
    }

    /// Name and number of vertices.
    pub(crate) fn label(&self) -> String {
        let vertices = self.creature.collider.positions().len();
        format!("{} {vertices}", self.creature.name)
    }

    /// The poses from which the bounds were precomputed.
    pub(crate) fn sampled(&self) -> Result<Vec<Palette>, RigError> {
        self.of_all_clips(0.0, 1)
    }

    /// Poses half-way between some of the sampled poses.
    pub(crate) fn between(&self) -> Result<Vec<Palette>, RigError> {
        self.of_all_clips(BETWEEN, 2)
    }

    /// Blends of every clip at equal weight, with the next clip at another time, and with the rest pose.
    pub(crate) fn blended(&self) -> Result<Vec<Palette>, RigError> {
        let rest = self.creature.skeleton.rest_pose();
        let clips = &self.creature.clips;
        let mut palettes = Vec::new();
        for (clip, next) in clips.iter().zip(clips.iter().cycle().skip(1)) {
            for (part, next_part) in [(0.1, 0.6), (0.4, 0.2), (0.7, 0.9)] {
                let pose = sample(clip, &rest, part)?;
                let other = sample(next, &rest, next_part)?;
                palettes.push(self.palette(&pose.blend(&other, 0.5)?)?);
                palettes.push(self.palette(&pose.blend(&rest, 0.5)?)?);
            }
        }
        Ok(palettes)
    }

    /// Every `step`-th sample of each clip, shifted by `offset` of a sampling interval.
    fn of_all_clips(&self, offset: f64, step: usize) -> Result<Vec<Palette>, RigError> {
        let rest = self.creature.skeleton.rest_pose();
        let mut palettes = Vec::new();
        for clip in &self.creature.clips {
            for k in (0..self.samples).step_by(step) {
                let part = (f64::from(k) + offset) / f64::from(self.samples);
                palettes.push(self.palette(&sample(clip, &rest, part)?)?);
            }
        }
        Ok(palettes)
    }

    fn palette(&self, pose: &Pose) -> Result<Palette, RigError> {
        self.creature.skeleton.palette(pose)
    }
}

/// The pose at a share of the clip's length.
fn sample(clip: &Clip, rest: &Pose, part: f64) -> Result<Pose, RigError> {
    clip.sample(rest, clip.duration() * part, Playback::Loop)
}
