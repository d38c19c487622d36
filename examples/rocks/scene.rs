//! Rocks on a shaking giant: they fall on it, ride, roll off, and lie in the valley.

use std::error::Error;
use std::sync::Arc;

use clamber::geometry::Similarity;
use clamber::rig::{Clip, Palette, Playback, Pose};
use clamber::surface::SkinnedSurface;
use clamber::world::ObstacleId;
use clamber::world::rapier3d::prelude::PhysicsWorld;
use clamber_scenes::rocks::FallingRocks;
use clamber_scenes::{Creature, valley};
use glam::DVec3;

/// Length of a tick, seconds.
pub(crate) const TICK: f64 = 1.0 / 60.0;

/// The giant's id among the debris's surfaces.
pub(crate) const CREATURE: ObstacleId = ObstacleId(0);

/// Seconds over which one clip fades into the next.
const FADE: f64 = 0.6;

/// The running scene: a giant in the valley, and rocks that fall on it.
pub(crate) struct Rocks<'a> {
    creature: &'a Creature,
    /// The current clip, and the one that it fades in from.
    clips: [Option<&'a Clip>; 2],
    /// When the current clip began, in seconds of the scene.
    began: f64,
    rest: Pose,
    pose: Pose,
    fading: Pose,
    palette: Palette,
    /// The creature's skin.
    pub(crate) surface: SkinnedSurface,
    /// The physics world: the valley and the rocks.
    pub(crate) world: PhysicsWorld,
    /// The rocks.
    pub(crate) rocks: FallingRocks,
    root: Similarity,
    time: f64,
}

impl<'a> Rocks<'a> {
    /// The creature in the middle of the valley, and `count` rocks, stones and logs above it. `seed`
    /// determines their sizes and places.
    pub(crate) fn new(
        creature: &'a Creature,
        count: usize,
        seed: u64,
    ) -> Result<Self, Box<dyn Error>> {
        let rest = creature.rig.skeleton.rest_pose();
        let (low, high) = creature.bounds(&rest)?;
        let ground = valley::height(0.0, 0.0) - f64::from(low.y);
        let root = Similarity::from_translation(DVec3::new(0.0, ground, 0.0));
        let mut world = valley::world();
        let top = root.transform_point_f32(high).y + 1.0;
        let rocks = FallingRocks::new(&mut world, count, seed, DVec3::Y * top, 1.0)?;
        let mut scene = Self {
            creature,
            clips: [None; 2],
            began: -FADE,
            pose: rest.clone(),
            fading: rest.clone(),
            rest,
            palette: Palette::default(),
            surface: SkinnedSurface::new(Arc::clone(&creature.rig.collider)),
            world,
            rocks,
            root,
            time: 0.0,
        };
        scene.advance_pose()?;
        scene.surface.teleport(&scene.palette, root)?;
        Ok(scene)
    }

    /// Fades the creature into the first clip whose name contains `word` (lower case), or into its rest pose
    /// if there is none.
    pub(crate) fn play(&mut self, word: Option<&str>) {
        let clip = word.and_then(|word| self.creature.clip_like(&[word]));
        let name = |clip: Option<&'a Clip>| clip.map(|clip| clip.name.as_str());
        if name(clip) != name(self.clips[0]) {
            self.clips = [clip, self.clips[0]];
            self.began = self.time;
        }
    }

    /// Poses the creature for the next tick.
    pub(crate) fn pose(&mut self) -> Result<(), Box<dyn Error>> {
        self.time += TICK;
        self.advance_pose()?;
        Ok(self.surface.advance(&self.palette, self.root)?)
    }

    fn advance_pose(&mut self) -> Result<(), Box<dyn Error>> {
        for (clip, pose) in [
            (self.clips[1], &mut self.pose),
            (self.clips[0], &mut self.fading),
        ] {
            pose.clone_from(&self.rest);
            if let Some(clip) = clip {
                clip.sample_into(self.time, Playback::Loop, pose)?;
            }
        }
        // Smoothstep, so that the fade begins and ends without a jerk.
        let share = ((self.time - self.began) / FADE).clamp(0.0, 1.0);
        let share = share * share * (3.0 - 2.0 * share);
        self.pose.blend_in(&self.fading, share)?;
        let skeleton = &self.creature.rig.skeleton;
        Ok(skeleton.palette_into(&self.pose, &mut self.palette)?)
    }
}
