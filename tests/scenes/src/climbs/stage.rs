//! A creature that moves while it is climbed.

use std::f64::consts::TAU;

use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::VertexId;
use clamber_surface::rig::{Clip, Palette, Playback};
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use crate::{Creature, SceneError};

/// How a creature moves while it is climbed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// It plays its idle clip, or else its first clip.
    Idle,
    /// It plays its walk, on the spot unless the clip itself moves the root.
    Walk,
    /// It plays its idle clip, or else its first clip, while the whole creature sways by centimetres.
    Shake,
}

/// A moving creature, scaled to a height, at the origin.
pub struct Stage<'a> {
    creature: &'a Creature,
    surface: SkinnedSurface,
    /// The corners of one triangle at each vertex.
    triangle_at: Vec<Option<[VertexId; 3]>>,
    place: Similarity,
    clip: Option<&'a Clip>,
    /// Seconds of the clip per second.
    tempo: f64,
    sways: bool,
}

impl<'a> Stage<'a> {
    /// A creature whose rest pose is `height` metres high, in its first pose. `tempo` is the rate of its clip. Giants
    /// move slower than the creatures that clips are made for, by the square root of their size.
    pub fn new(
        creature: &'a Creature,
        (height, tempo): (f64, f64),
        motion: Motion,
    ) -> Result<Self, SceneError> {
        let mut triangle_at = vec![None; creature.rig.collider.positions().len()];
        for corners in creature.rig.collider.triangles() {
            for vertex in corners {
                triangle_at[vertex.index()] = Some(*corners);
            }
        }
        let words = match motion {
            Motion::Walk => ["walk", "run", "idle"],
            Motion::Idle | Motion::Shake => ["idle", "breathe", "survey"],
        };
        let mut stage = Self {
            creature,
            surface: SkinnedSurface::new(creature.rig.collider.clone()),
            triangle_at,
            place: creature.standing(height)?.0,
            clip: creature.clip_like(&words).or(creature.rig.clips.first()),
            tempo,
            sways: motion == Motion::Shake,
        };
        stage.place(0.0)?;
        Ok(stage)
    }

    /// Puts the creature into its pose at a time, seconds, without motion.
    pub fn place(&mut self, time: f64) -> Result<(), SceneError> {
        let (palette, root) = self.pose(time)?;
        Ok(self.surface.teleport(&palette, root)?)
    }

    /// Moves the creature on to its pose at a time, seconds: the next tick.
    pub fn advance(&mut self, time: f64) -> Result<(), SceneError> {
        let (palette, root) = self.pose(time)?;
        Ok(self.surface.advance(&palette, root)?)
    }

    /// The palette at a time, seconds, and the place of the creature.
    fn pose(&self, time: f64) -> Result<(Palette, Similarity), SceneError> {
        let skeleton = &self.creature.rig.skeleton;
        let mut pose = skeleton.rest_pose();
        if let Some(clip) = self.clip {
            clip.sample_into(time * self.tempo, Playback::Loop, &mut pose)?;
        }
        let mut root = self.place;
        if self.sways {
            root.translation += DVec3::new(0.05, 0.02, 0.03) * libm::sin(1.2 * TAU * time);
        }
        Ok((skeleton.palette(&pose)?, root))
    }

    /// The creature's skin.
    pub fn surface(&self) -> &SkinnedSurface {
        &self.surface
    }

    /// The current position of a vertex in the world, and the unit normal of one of its triangles.
    pub fn vertex(&self, vertex: VertexId) -> (DVec3, DVec3) {
        let world_from_model = self.surface.world_from_model();
        let place = |vertex: VertexId| {
            let position = self.surface.in_model().position(vertex).unwrap_or_default();
            world_from_model.transform_point_f32(position)
        };
        let corners = self.triangle_at[vertex.index()];
        let [a, b, c] = corners.unwrap_or([vertex; 3]).map(place);
        (place(vertex), (b - a).cross(c - a).normalize_or(DVec3::Y))
    }
}
