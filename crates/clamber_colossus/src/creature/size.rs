//! The size of a creature, and the durations and rates that follow from it.

use super::{Creature, CreatureConfig};
use crate::kind::CreatureKind;

/// Reference height for the durations and angular accelerations in this module, metres. They were tuned on a giant of
/// this height.
pub(super) const GIANT_HEIGHT: f64 = 41.0;

/// Size of a creature, and how its size scales rates and durations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    /// Metres per unit of the model.
    pub(super) scale: f64,
    /// Height at rest, metres.
    pub(super) height: f64,
    /// Half the width of the body on the ground, metres.
    pub(super) girth: f64,
    /// Playback rate of the clips.
    pub(super) rate: f64,
    /// Factor on durations that are given for a creature of [`GIANT_HEIGHT`]: the square root of the height ratio, by
    /// Froude's law.
    pub(super) pace: f64,
}

impl Size {
    pub(super) fn new(kind: &CreatureKind, config: &CreatureConfig) -> Self {
        let body = &kind.brain().file().body;
        let unit = body.height.map_or(1.0, |height| height / kind.height());
        let scale = unit * config.scale;
        let height = kind.height() * scale;
        let made_for = config.made_for.or(body.made_for);
        // A skin without height cannot be compared with `made_for`.
        let known = made_for.filter(|_| height > 0.0);
        Self {
            scale,
            height,
            girth: kind.girth() * scale,
            rate: known.map_or(1.0, |made_for| (made_for / height).sqrt()),
            pace: (height / GIANT_HEIGHT).sqrt(),
        }
    }
}

impl Creature {
    /// Metres per unit of the creature's model.
    pub fn scale(&self) -> f64 {
        self.size.scale
    }

    /// Height of the creature at rest, metres.
    pub fn height(&self) -> f64 {
        self.size.height
    }

    /// Playback rate of the creature's clips: 1 as in the file, less if the creature is larger than the clips were made
    /// for ([`BodyFile::made_for`](crate::BodyFile::made_for)).
    pub fn rate(&self) -> f64 {
        self.size.rate
    }
}
