use std::f64::consts::TAU;

use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::VertexId;
use clamber_surface::rig::{Clip, Palette, Playback};
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use crate::{Creature, CreatureError};

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
    scale: f64,
    tempo: f64,
    motion: Motion,
}

impl<'a> Stage<'a> {
    /// A creature whose rest pose is `height` metres high, and whose clips are played at `tempo` times their speed.
    /// Giants move slower than the creatures that clips are made for, by the square root of their size.
    ///
    /// # Errors
    /// [`CreatureError`] if the rest pose does not fit the collider.
    pub fn new(
        creature: &'a Creature,
        (height, tempo): (f64, f64),
        motion: Motion,
    ) -> Result<Self, CreatureError> {
        let pose = creature.skeleton.rest_pose();
        let palette = creature.skeleton.palette(&pose)?;
        let rest = clamber_surface::skin::skin(&creature.collider, palette.matrices())?;
        let low = rest.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
        let high = rest.iter().map(|p| p.y).fold(f32::NEG_INFINITY, f32::max);
        let mut triangle_at = vec![None; rest.len()];
        for corners in creature.collider.triangles() {
            for vertex in corners {
                triangle_at[vertex.index()] = Some(*corners);
            }
        }
        Ok(Self {
            creature,
            surface: SkinnedSurface::new(creature.collider.clone()),
            triangle_at,
            scale: height / f64::from(high - low),
            tempo,
            motion,
        })
    }

    /// Puts the creature into its pose at a time, seconds, without motion.
    ///
    /// # Errors
    /// [`CreatureError`] if a clip does not fit.
    pub fn place(&mut self, time: f64) -> Result<(), CreatureError> {
        let (palette, root) = self.pose(time)?;
        Ok(self.surface.place(&palette, root)?)
    }

    /// Moves the creature on to its pose at a time, seconds: the next tick.
    ///
    /// # Errors
    /// As [`Stage::place`].
    pub fn advance(&mut self, time: f64) -> Result<(), CreatureError> {
        let (palette, root) = self.pose(time)?;
        Ok(self.surface.advance(&palette, root)?)
    }

    fn pose(&self, time: f64) -> Result<(Palette, Similarity), CreatureError> {
        let words: &[&str] = match self.motion {
            Motion::Walk => &["walk", "run", "idle"],
            Motion::Idle | Motion::Shake => &["idle", "breathe", "survey"],
        };
        let clip: Option<&Clip> = self
            .creature
            .clip_like(words)
            .or_else(|| self.creature.clips.first());
        let rest = self.creature.skeleton.rest_pose();
        let pose = match clip {
            Some(clip) => clip.sample(&rest, time * self.tempo, Playback::Loop)?,
            None => rest,
        };
        let sway = if self.motion == Motion::Shake {
            DVec3::new(0.05, 0.02, 0.03) * libm::sin(1.2 * TAU * time)
        } else {
            DVec3::ZERO
        };
        let root = Similarity {
            scale: self.scale,
            translation: sway,
            ..Similarity::IDENTITY
        };
        Ok((self.creature.skeleton.palette(&pose)?, root))
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
