//! Giants that walk in a valley, each in its own phase.

use std::error::Error;
use std::sync::Arc;

use clamber::prelude::*;
use clamber::rig::{Clip, Pose};
use clamber_scenes::{Creature, valley};
use glam::DVec3;
use rayon::prelude::*;

/// Ticks per second.
pub(crate) const RATE: f64 = 60.0;

/// Distance between giants, metres.
const APART: f64 = 31.0;

/// Which vertices a tick skins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Skinning {
    /// Only the vertices that queries touch.
    Lazy,
    /// All vertices.
    Everything,
}

pub(crate) struct Herd {
    pub(crate) giants: Vec<Giant>,
    skeleton: Skeleton,
    walk: Clip,
    skinning: Skinning,
}

pub(crate) struct Giant {
    pub(crate) surface: SkinnedSurface,
    place: Similarity,
    /// Seconds into the walk at the first tick.
    phase: f64,
    pose: Pose,
    palette: Palette,
}

impl Herd {
    pub(crate) fn new(
        creature: &Creature,
        count: usize,
        skinning: Skinning,
    ) -> Result<Self, Box<dyn Error>> {
        let walk = creature
            .clip_like(&["walk"])
            .ok_or("the creature has no walk clip")?;
        let mut rng = fastrand::Rng::with_seed(8);
        let side = (count as f64).sqrt().ceil() as usize;
        let giant = |index: usize| {
            let along = |step: usize| (step as f64 - (side as f64 - 1.0) / 2.0) * APART;
            let (x, z) = (along(index % side), along(index / side));
            Giant {
                surface: SkinnedSurface::new(Arc::clone(&creature.rig.collider)),
                place: Similarity::from_translation(DVec3::new(x, valley::height(x, z), z)),
                phase: rng.f64() * walk.duration(),
                pose: creature.rig.skeleton.rest_pose(),
                palette: Palette::default(),
            }
        };
        let mut herd = Self {
            giants: (0..count).map(giant).collect(),
            skeleton: creature.rig.skeleton.clone(),
            walk: walk.clone(),
            skinning,
        };
        herd.pose(0, 0..count)?;
        for giant in &mut herd.giants {
            giant.surface.sleep();
        }
        Ok(herd)
    }

    /// Poses the giants `awake` for a tick; the others are not touched.
    pub(crate) fn pose(
        &mut self,
        tick: usize,
        awake: std::ops::Range<usize>,
    ) -> Result<(), Box<dyn Error>> {
        let Self {
            giants,
            skeleton,
            walk,
            skinning,
        } = self;
        for giant in &mut giants[awake] {
            giant.advance(skeleton, walk, *skinning, tick)?;
        }
        Ok(())
    }

    /// Poses all giants, on rayon's threads.
    pub(crate) fn pose_in_parallel(&mut self, tick: usize) -> Result<(), Box<dyn Error>> {
        let Self {
            giants,
            skeleton,
            walk,
            skinning,
        } = self;
        let posed = giants.par_iter_mut().try_for_each(|giant| {
            giant
                .advance(skeleton, walk, *skinning, tick)
                .map_err(|error| error.to_string())
        });
        Ok(posed?)
    }
}

impl Giant {
    fn advance(
        &mut self,
        skeleton: &Skeleton,
        walk: &Clip,
        skinning: Skinning,
        tick: usize,
    ) -> Result<(), Box<dyn Error>> {
        let time = self.phase + tick as f64 / RATE;
        walk.sample_into(time, Playback::Loop, &mut self.pose)?;
        skeleton.palette_into(&self.pose, &mut self.palette)?;
        self.surface.advance(&self.palette, self.place)?;
        if skinning == Skinning::Everything {
            self.surface.skin_ahead();
        }
        Ok(())
    }
}
