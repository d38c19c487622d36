//! Giants that walk in a valley, each in its own phase, and places on them. The bench `climber` has them, too.

use std::error::Error;
use std::sync::Arc;

use clamber::climber::{Climber, ClimberMode, ClimberState};
use clamber::prelude::*;
use clamber::rig::{Clip, Pose};
use clamber_scenes::{Creature, valley};
use glam::DVec3;
use rayon::prelude::*;

/// Ticks per second.
pub(crate) const RATE: f64 = 60.0;

pub(crate) struct Herd {
    pub(crate) giants: Vec<Giant>,
    skeleton: Skeleton,
    walk: Clip,
}

pub(crate) struct Giant {
    pub(crate) surface: SkinnedSurface,
    place: Similarity,
    /// Seconds into the walk at the first tick.
    phase: f64,
    pose: Pose,
    palette: Palette,
}

/// A place on a giant.
pub(crate) struct Seat {
    giant: usize,
    anchor: Anchor,
}

impl Herd {
    /// `count` giants in rows of `row`, `apart` metres from each other.
    pub(crate) fn new(
        creature: &Creature,
        count: usize,
        row: usize,
        apart: f64,
    ) -> Result<Self, Box<dyn Error>> {
        let walk = creature
            .clip_like(&["walk"])
            .ok_or("the creature has no walk clip")?;
        let mut rng = fastrand::Rng::with_seed(8);
        let giant = |index: usize| {
            let along = |step: usize| (step as f64 - (row as f64 - 1.0) / 2.0) * apart;
            let (x, z) = (along(index % row), along(index / row));
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
        for giant in &mut self.giants[awake] {
            giant.advance(&self.skeleton, &self.walk, tick)?;
        }
        Ok(())
    }

    /// Poses all giants, on rayon's threads.
    pub(crate) fn pose_in_parallel(&mut self, tick: usize) -> Result<(), String> {
        let (skeleton, walk) = (&self.skeleton, &self.walk);
        self.giants.par_iter_mut().try_for_each(|giant| {
            let posed = giant.advance(skeleton, walk, tick);
            posed.map_err(|error| error.to_string())
        })
    }

    /// A random place on a giant, and the Y of its unit normal.
    pub(crate) fn seat(
        &self,
        giant: usize,
        rng: &mut fastrand::Rng,
    ) -> Result<(Seat, f32), Box<dyn Error>> {
        let surface = &self.giants[giant].surface;
        let triangle = TriangleId(rng.u32(0..surface.mesh().triangles().len() as u32));
        let anchor = surface.anchor(triangle, [0.5, 0.25, 0.25])?;
        let normal = surface.in_model().motion(&anchor, 1.0 / RATE)?.normal;
        Ok((Seat { giant, anchor }, normal.y))
    }

    /// Puts a climber that is more than `away` metres from its seat back, just above it.
    pub(crate) fn sit(
        &self,
        climber: &mut Climber,
        seat: &Seat,
        away: f64,
    ) -> Result<(), Box<dyn Error>> {
        let surface = &self.giants[seat.giant].surface;
        let motion = surface.in_model().motion(&seat.anchor, 1.0 / RATE)?;
        let place = surface.world_from_model();
        let normal = (place.rotation * motion.normal.as_dvec3()).normalize();
        let point = place.transform_point_f32(motion.position);
        let position = point + normal * (climber.config().body.radius * 1.01);
        if climber.state().position.distance(position) > away {
            climber.restore(ClimberState {
                position,
                velocity: place.transform_vector(motion.velocity.as_dvec3()),
                mode: ClimberMode::Falling,
                support: None,
                support_velocity: None,
                stamina: 1.0,
                ..*climber.state()
            })?;
        }
        Ok(())
    }
}

impl Giant {
    fn advance(
        &mut self,
        skeleton: &Skeleton,
        walk: &Clip,
        tick: usize,
    ) -> Result<(), Box<dyn Error>> {
        let time = self.phase + tick as f64 / RATE;
        walk.sample_into(time, Playback::Loop, &mut self.pose)?;
        skeleton.palette_into(&self.pose, &mut self.palette)?;
        Ok(self.surface.advance(&self.palette, self.place)?)
    }
}
