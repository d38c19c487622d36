use std::sync::{Mutex, OnceLock, PoisonError};

use bevy_ecs::prelude::*;
use clamber_surface::rig::{Palette, PoseMotion};
use clamber_surface::surface::SkinnedSurface;
use glam::DAffine3;

use super::PosedSurface;
use super::history::History;
use super::rig::{Changed, Locals, Rig, Scene};
use crate::{ColliderError, SkinnedCollider};

/// The poses in which the last frames drew a surface. Inserted beside [`PosedSurface`].
///
/// [`DrawnSurfaceQuery`](crate::DrawnSurfaceQuery) queries surfaces in the pose of the last frame.
#[derive(Component, Debug)]
pub struct DrawnSurface {
    pub(super) rig: Rig,
    pub(super) history: History,
    /// Counts changes of the hierarchy.
    pub(super) hierarchies: u32,
    /// Why the last frame's pose is not known.
    error: Option<ColliderError>,
    /// Frames that have drawn it, up to [`FIRST_FRAMES`].
    frames: u8,
    /// An implausible speed was logged.
    has_told: bool,
    /// The counts of [`PosedSurface`] at the last frame.
    teleports: u32,
    edits: u32,
    /// The surface in the last frame's pose, made on demand; `None` if it cannot take that pose.
    surface: OnceLock<Option<SkinnedSurface>>,
    spare: Mutex<Spare>,
}

/// Kept to reuse its memory.
#[derive(Debug, Default)]
struct Spare {
    surface: Option<SkinnedSurface>,
    model_from_node: Vec<DAffine3>,
    palette: Palette,
}

/// Number of the drawn frame, counted from 1, from which on a jump of the creature is warned of. In earlier frames its
/// animation may start, which looks like a jump.
const FIRST_FRAMES: u8 = 8;

impl DrawnSurface {
    pub(crate) fn new(rig: Rig) -> Self {
        Self {
            rig,
            history: History::default(),
            hierarchies: 0,
            error: None,
            frames: 0,
            has_told: false,
            teleports: 0,
            edits: 0,
            surface: OnceLock::new(),
            spare: Mutex::default(),
        }
    }

    /// The surface as the last frame drew it.
    pub(crate) fn pose(&self, surface: &PosedSurface) -> Option<&SkinnedSurface> {
        let posed = self.surface.get_or_init(|| {
            let mut spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner);
            let Spare {
                surface: known,
                model_from_node,
                palette,
            } = &mut *spare;
            let placed = self
                .rig
                .compose(self.history.last(), model_from_node, palette)?;
            let mut posed = known
                .take()
                .unwrap_or_else(|| SkinnedSurface::clone(surface));
            posed.teleport(palette, placed).ok()?;
            Some(posed)
        });
        posed.as_ref()
    }

    /// Records the pose that a frame draws, at the frame's time.
    pub(crate) fn sample(
        &mut self,
        surface: &PosedSurface,
        timing: &SkinnedCollider,
        scene: &Scene<'_, '_, '_>,
        time: f64,
    ) {
        self.error = None;
        self.frames = FIRST_FRAMES.min(self.frames + 1);
        let mut drawn = self.history.buffer();
        let is_same = match self.rig.read(scene, self.history.last(), &mut drawn) {
            Ok(is_same) => is_same,
            Err(Changed) => {
                if let Err(error) = self.follow(scene, time, &mut drawn) {
                    // The previous pose stays.
                    drawn.clone_from(self.history.last());
                    self.error = Some(error);
                }
                true
            }
        };
        if self.edits != surface.edits() {
            self.edits = surface.edits();
            self.surface.take();
            self.spare = Mutex::default();
        }
        let mut is_cut = self.teleports != surface.teleports();
        self.teleports = surface.teleports();
        if !is_same {
            self.forget_pose();
            is_cut = is_cut || self.is_teleport(surface, timing, &drawn, time);
        }
        if is_same && !is_cut {
            self.history.stay(time, drawn);
        } else {
            let motion = if is_cut {
                PoseMotion::Teleported
            } else {
                PoseMotion::Moved
            };
            self.history.record(time, drawn, motion);
        }
    }

    /// The error of the last frame.
    pub(super) fn check(&self) -> Result<(), ColliderError> {
        self.error.clone().map_or(Ok(()), Err)
    }

    /// Reads a hierarchy that has changed. Only its current pose is known then.
    pub(super) fn follow(
        &mut self,
        scene: &Scene<'_, '_, '_>,
        time: f64,
        drawn: &mut Locals,
    ) -> Result<(), ColliderError> {
        self.rig.follow(scene.hierarchy)?;
        let read = self.rig.read(scene, &Locals::default(), drawn);
        read.map_err(|Changed| ColliderError::Joint { joint: 0 })?;
        self.history.restart(time, drawn.clone());
        self.hierarchies = self.hierarchies.wrapping_add(1);
        self.forget_pose();
        Ok(())
    }

    /// Logs an implausible speed, metres a second, once. An animation that begins is no fault: it takes the creature
    /// from its rest to the clip's first pose.
    pub(super) fn tell_teleport(&mut self, surface: &PosedSurface, speed: f64) {
        if self.frames >= FIRST_FRAMES && !std::mem::replace(&mut self.has_told, true) {
            let entity = surface.entity();
            tracing::warn!(
                "the surface of {entity} moved at {speed:.0} m/s, which is taken for a teleport: its skin has no \
                 velocity in that tick. If it was one, call PosedSurface::forget_motion beside it; if not, raise \
                 SkinnedCollider::max_speed"
            );
        }
    }

    /// True if the topmost entity is too far from its place in the last frame to have moved there.
    fn is_teleport(
        &mut self,
        surface: &PosedSurface,
        timing: &SkinnedCollider,
        drawn: &Locals,
        time: f64,
    ) -> bool {
        let Some((last, before)) = self.history.last_timed() else {
            return false;
        };
        let (Some(from), Some(to)) = (last.place(), drawn.place()) else {
            return false;
        };
        let time = time - before;
        let speed = from.distance(to) / time;
        let is_teleport = time > 0.0 && speed > f64::from(timing.max_speed);
        if is_teleport {
            self.tell_teleport(surface, speed);
        }
        is_teleport
    }

    /// The next query poses the surface anew.
    fn forget_pose(&mut self) {
        if let Some(posed) = self.surface.take() {
            let spare = self.spare.get_mut().unwrap_or_else(PoisonError::into_inner);
            spare.surface = posed;
        }
    }
}
