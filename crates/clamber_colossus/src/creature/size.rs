//! How large a creature is, and how fast things of its size are.

use super::{Creature, CreatureConfig};
use crate::kind::CreatureKind;

/// Times and angular accelerations of this module are those of a creature of this height, metres: the giant on which they
/// were tuned.
pub(super) const GIANT: f64 = 41.0;

/// How large a creature is, and how fast.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    /// Metres per unit of the model.
    pub(super) scale: f64,
    /// Metres.
    pub(super) height: f64,
    /// Half its width on the ground, metres.
    pub(super) girth: f64,
    /// How fast its clips are played.
    pub(super) rate: f64,
    /// How long things take that need some time for a giant of [`GIANT`] metres, as a share of that: by Froude's law.
    pub(super) pace: f64,
}

impl Size {
    pub(super) fn new(kind: &CreatureKind, config: &CreatureConfig) -> Self {
        let body = &kind.brain().file().body;
        let unit = body.height.map_or(1.0, |height| height / kind.height());
        let scale = unit * config.scale;
        let height = kind.height() * scale;
        let made_for = config.made_for.or(body.made_for);
        // A skin without height has no size to go by.
        let known = made_for.filter(|_| height > 0.0);
        Self {
            scale,
            height,
            girth: kind.girth() * scale,
            rate: known.map_or(1.0, |made_for| (made_for / height).sqrt()),
            pace: (height / GIANT).sqrt(),
        }
    }
}

impl Creature {
    /// Metres per unit of its model.
    pub fn scale(&self) -> f64 {
        self.size.scale
    }

    /// Its height at rest, metres.
    pub fn height(&self) -> f64 {
        self.size.height
    }

    /// How fast its clips are played: 1 as they are in the file, less for a creature that is larger than they were made
    /// for ([`BodyFile::made_for`](crate::BodyFile::made_for)).
    pub fn rate(&self) -> f64 {
        self.size.rate
    }
}
