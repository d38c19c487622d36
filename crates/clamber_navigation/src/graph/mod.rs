//! Patches, and the ways between them.

mod arms;
mod flood;
mod links;

use std::ops::ControlFlow;

use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use crate::patches::{Patch, divide, seat};
use crate::{GraphConfig, GraphSource, NavigationError};

pub(crate) use flood::Reached;
use links::Links;

/// What a build does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage {
    /// Looks for room for the climber's ball.
    Seats,
    /// Looks how far hands have to reach.
    Arms,
}

/// How far a build has got.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// What it does.
    pub stage: Stage,
    /// How many patches it has done.
    pub done: usize,
    /// How many there are.
    pub of: usize,
}

/// A place where a climber gets on from the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Entry {
    /// The patch.
    pub patch: usize,
    /// How high the middle of the climber's ball has to come, metres above the ground.
    pub height: f64,
}

/// Where a climber can be on a creature, and how it gets from one place to another.
#[derive(Clone, Debug)]
pub struct ClimbGraph {
    pub(crate) config: GraphConfig,
    pub(crate) patches: Vec<Patch>,
    pub(crate) links: Links,
    /// Of each patch, how far a hand has to reach from the ball's seat for something to grip, metres; infinite if there is
    /// nothing within twice the climber's reach.
    pub(crate) arms: Vec<f64>,
    pub(crate) entries: Vec<Entry>,
    /// The skin at rest.
    surface: SkinnedSurface,
}

/// The ball's middle is at least so high above the ground, as a share of its radius.
const LOWEST: f64 = 0.98;

/// After so many patches a build tells how far it has got.
const TELLS: usize = 256;

impl ClimbGraph {
    /// Builds the graph of a creature at rest.
    ///
    /// `progress` is called again and again, and cancels the build by [`ControlFlow::Break`].
    ///
    /// # Errors
    /// [`NavigationError`] if a number of the configuration is out of its range, if the creature has no skin or cannot be
    /// posed, if it has too many patches, and if the caller cancels.
    pub fn build(
        source: &GraphSource<'_>,
        config: &GraphConfig,
        mut progress: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Self, NavigationError> {
        config.check()?;
        let palette = source.skeleton.palette(&source.skeleton.rest_pose())?;
        let mut surface = SkinnedSurface::new(source.mesh.clone());
        surface.place(&palette, source.world_from_model)?;
        let mut patches = divide(&surface, config)?;
        let of = patches.len();
        let lowest = source.ground + LOWEST * config.radius();
        let mut tell = |stage, done: usize| {
            if done.is_multiple_of(TELLS) && progress(Progress { stage, done, of }).is_break() {
                return Err(NavigationError::Cancelled);
            }
            Ok(())
        };
        for (done, patch) in patches.iter_mut().enumerate() {
            tell(Stage::Seats, done)?;
            let above = |seat: &DVec3| seat.dot(config.climber.up()) >= lowest;
            patch.seat = seat(&surface, patch, config.radius()).filter(above);
        }
        let mut arms = Vec::with_capacity(of);
        for (done, patch) in patches.iter().enumerate() {
            tell(Stage::Arms, done)?;
            let arm = patch.seat.map(|seat| arms::arm(&surface, seat, config));
            arms.push(arm.unwrap_or(f64::INFINITY));
        }
        let links = Links::new(&patches, config.link());
        let entries = entries(&surface, &patches, source.ground, config);
        Ok(Self {
            config: *config,
            patches,
            links,
            arms,
            entries,
            surface,
        })
    }

    /// The patches, sorted by place.
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// Where it can be got onto from the ground.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The settings that it was built with.
    pub fn config(&self) -> &GraphConfig {
        &self.config
    }

    /// How far a hand has to reach at most on the way between two patches; more than `enough` only if that is so.
    pub(crate) fn arm_between(&self, ends: [usize; 2], enough: f64) -> f64 {
        let [Some(from), Some(to)] = ends.map(|patch| self.patches[patch].seat) else {
            return f64::INFINITY;
        };
        let arms = ends.map(|patch| self.arms[patch]);
        let arm_at = |seat| arms::arm(&self.surface, seat, &self.config);
        arms::arm_between([from, to], arms, enough, &arm_at)
    }

    /// True if a climber can stand on a patch at rest.
    pub(crate) fn can_stand(&self, patch: usize) -> bool {
        let (climber, patch) = (&self.config.climber, &self.patches[patch]);
        let cosine = patch.normal.dot(climber.up()).clamp(-1.0, 1.0);
        libm::acos(cosine) <= climber.ground.max_slope
    }

    /// True if a climber can hold on at a patch at rest and climb there, with arms of this reach.
    pub(crate) fn can_hold(&self, patch: usize, reach: f64) -> bool {
        let climber = &self.config.climber;
        let Some(grip) = &climber.grip else {
            return false;
        };
        let cosine = self.patches[patch].normal.dot(climber.up()).clamp(-1.0, 1.0);
        self.arms[patch] <= reach && libm::acos(cosine) <= grip.max_overhang
    }
}

/// Patches that a climber on the ground reaches with a jump: their seats have free space down to the ground.
fn entries(surface: &SkinnedSurface, patches: &[Patch], ground: f64, config: &GraphConfig) -> Vec<Entry> {
    let climber = &config.climber;
    let (radius, gravity) = (config.radius(), climber.gravity.length());
    let jump = if gravity > 0.0 {
        0.5 * climber.ground.jump_speed.powi(2) / gravity
    } else {
        f64::INFINITY
    };
    let up = climber.up();
    let highest = radius + jump + config.reach().max(0.0);
    let mut found = Vec::new();
    for (index, patch) in patches.iter().enumerate() {
        let Some(seat) = patch.seat else {
            continue;
        };
        let height = seat.dot(up) - ground;
        let is_near = height <= highest;
        if is_near && has_room_below(surface, seat, up, height - radius, radius) {
            found.push(Entry {
                patch: index,
                height,
            });
        }
    }
    found
}

/// Steps of a ball on its way to the ground, as a share of its radius.
const STEP: f64 = 0.5;

/// A ball on the way to the ground may be so deep in skin, as a share of its radius: seats have as much.
const TOUCH: f64 = 0.03;

fn has_room_below(surface: &SkinnedSurface, seat: DVec3, up: DVec3, way: f64, radius: f64) -> bool {
    let steps = (way / (STEP * radius)).ceil().max(1.0);
    (1..=steps as u32).all(|step| {
        let place = seat - up * (way * f64::from(step) / steps);
        surface
            .in_world()
            .closest_point(place, radius * (1.0 - TOUCH))
            .is_none()
    })
}
