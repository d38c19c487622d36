//! Rocks on a shaking giant: they fall on it, ride, roll off, and lie in the valley.

use std::error::Error;
use std::sync::Arc;

use clamber_surface::geometry::Similarity;
use clamber_surface::rig::{Clip, Palette, Playback, Pose};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::rapier3d::prelude::*;
use clamber_world::{Debris, DebrisConfig, DebrisReport, ObstacleId};
use glam::DVec3;

use crate::{Creature, valley};

/// Length of a tick, seconds.
pub const TICK: f64 = 1.0 / 60.0;

/// The giant's id among the debris's surfaces.
const CREATURE: ObstacleId = ObstacleId(0);

/// Seconds over which one clip fades into the next.
const FADE: f64 = 0.6;

/// The running scene: a giant in the valley, and rocks that fall on it.
pub struct Rocks<'a> {
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
    pub surface: SkinnedSurface,
    /// The physics world: the valley and the rocks.
    pub world: PhysicsWorld,
    debris: Debris,
    rocks: Vec<RigidBodyHandle>,
    root: Similarity,
    time: f64,
}

impl<'a> Rocks<'a> {
    /// The creature in the middle of the valley, and `count` rocks, stones and logs above it. `seed`
    /// determines their sizes and places.
    ///
    /// # Errors
    /// If the creature cannot be posed, or a rock cannot collide with its skin.
    pub fn new(creature: &'a Creature, count: usize, seed: u64) -> Result<Self, Box<dyn Error>> {
        let rest = creature.rig.skeleton.rest_pose();
        let (low, high) = creature.bounds(&rest)?;
        let ground = valley::height(0.0, 0.0) - f64::from(low.y);
        let root = Similarity::from_translation(DVec3::new(0.0, ground, 0.0));
        let mut world = valley::world();
        let top = root.transform_point_f32(high).y + 1.0;
        let rocks = scatter(&mut world, count, seed, DVec3::Y * top, 1.0);
        let mut debris = Debris::new(DebrisConfig::default());
        for rock in &rocks {
            debris.add(*rock, &mut world.bodies, &world.colliders)?;
        }
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
            debris,
            rocks,
            root,
            time: 0.0,
        };
        scene.advance_pose()?;
        scene.surface.place(&scene.palette, root)?;
        Ok(scene)
    }

    /// Fades the creature into the first clip whose name contains `word` (lower case), or into its rest pose
    /// if there is none.
    pub fn play(&mut self, word: Option<&str>) {
        let clip = word.and_then(|word| self.creature.clip_like(&[word]));
        let name = |clip: Option<&'a Clip>| clip.map(|clip| clip.name.as_str());
        if name(clip) != name(self.clips[0]) {
            self.clips = [clip, self.clips[0]];
            self.began = self.time;
        }
    }

    /// Poses the creature for the next tick. Call it once before each [`Rocks::step`].
    ///
    /// # Errors
    /// If the creature cannot be posed.
    pub fn pose(&mut self) -> Result<(), Box<dyn Error>> {
        self.time += TICK;
        self.advance_pose()?;
        Ok(self.surface.advance(&self.palette, self.root)?)
    }

    /// Adds the skin near the rocks to the physics world, steps the world, and keeps the rocks out of the skin.
    ///
    /// # Errors
    /// If the skin cannot be added to the physics world.
    pub fn step(&mut self) -> Result<DebrisReport, Box<dyn Error>> {
        self.bring_skin()?;
        self.step_world();
        self.keep_out()
    }

    /// The first part of [`Rocks::step`]: adds the skin near the rocks to the physics world.
    ///
    /// # Errors
    /// If the skin cannot be added to the physics world.
    pub fn bring_skin(&mut self) -> Result<(), Box<dyn Error>> {
        let (bodies, colliders) = (&mut self.world.bodies, &mut self.world.colliders);
        let surfaces = [(CREATURE, &self.surface)];
        Ok(self
            .debris
            .before_step(&surfaces, bodies, colliders, TICK)?)
    }

    /// The last part of [`Rocks::step`]: puts rocks that got into the skin back in front of it.
    ///
    /// # Errors
    /// If the skin cannot be added to the physics world.
    pub fn keep_out(&mut self) -> Result<DebrisReport, Box<dyn Error>> {
        let world = &mut self.world;
        let (broad_phase, narrow_phase) = (&world.broad_phase, &world.narrow_phase);
        let surfaces = [(CREATURE, &self.surface)];
        Ok(self.debris.after_step(
            &surfaces,
            &mut world.bodies,
            &world.colliders,
            broad_phase,
            narrow_phase,
            TICK,
        )?)
    }

    /// The middle part of [`Rocks::step`]: rapier's own step.
    pub fn step_world(&mut self) {
        self.world.step_with_events(&self.debris, &());
    }

    /// The rocks.
    pub fn rocks(&self) -> &[RigidBodyHandle] {
        &self.rocks
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

/// Adds `count` rocks, stones and logs to a physics world, in layers from `above` upwards; every sixth is a
/// log. At a scale of 1 a rock's size is 25 to 70 cm: the radius of a ball, or the largest half extent of a
/// box. A log has half of its size as radius, and twice its size as half length without the round ends.
pub fn scatter(
    world: &mut PhysicsWorld,
    count: usize,
    seed: u64,
    above: DVec3,
    scale: f64,
) -> Vec<RigidBodyHandle> {
    let mut rng = fastrand::Rng::with_seed(seed);
    let scale = scale as f32;
    let mut between = |low: f32, high: f32| (low + (high - low) * rng.f32()) * scale;
    let mut rocks = Vec::with_capacity(count);
    for index in 0..count {
        let size = between(0.25, 0.7);
        let shape = match index % 6 {
            0 => ColliderBuilder::capsule_x(size * 2.0, size * 0.5),
            1 | 3 => ColliderBuilder::cuboid(size, size * 0.7, size * 0.8),
            _ => ColliderBuilder::ball(size),
        };
        // In layers, so that no rock begins inside another.
        let (layer, row, column) = (index / 25, (index % 25) / 5, index % 5);
        let aside = Vector::new(
            (row as f32 - 2.0) * 2.6 * scale + between(-0.3, 0.3),
            layer as f32 * 3.0 * scale,
            (column as f32 - 2.0) * 2.6 * scale + between(-0.3, 0.3),
        );
        let place = (above + aside.as_dvec3()).as_vec3();
        let body = RigidBodyBuilder::dynamic().translation(place);
        let collider = shape.density(2500.0).friction(0.6);
        rocks.push(world.insert(body, collider).0);
    }
    rocks
}
