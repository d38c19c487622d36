use std::ops::Deref;
use std::sync::Arc;

use bevy_ecs::prelude::*;
use clamber_surface::geometry::Affine;
use clamber_surface::mesh::TriangleId;
use clamber_surface::rig::{Palette, RigError};
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use glam::DAffine3;
use thiserror::Error;

use super::PoseTiming;
use super::rig::{Hierarchy, Locals, Rig, set_between};
use crate::collider::BuiltCollider;
use crate::{ColliderError, SkinnedCollider};

/// Why a surface kept its last pose.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PoseError {
    /// A joint is gone, or hangs where none can be followed.
    #[error(transparent)]
    Hierarchy(#[from] ColliderError),
    /// A transform is not finite, or has a rotation of no length.
    #[error(transparent)]
    Transform(#[from] RigError),
    /// The creature is scaled to nothing.
    #[error("the creature is scaled to nothing, or placed nowhere finite")]
    Placement,
    /// The surface refuses the palette.
    #[error(transparent)]
    Palette(#[from] SurfaceError),
}

/// The surface of a skinned mesh, as posed in this tick: appears beside a
/// [`SkinnedCollider`](crate::SkinnedCollider) once its collider is built.
///
/// Read through [`SurfaceQuery`](crate::SurfaceQuery) in world space, or directly, in model space, as the
/// [`SkinnedSurface`] that it dereferences to.
#[derive(Component, Debug)]
pub struct PosedSurface {
    surface: SkinnedSurface,
    collider: Arc<BuiltCollider>,
    rig: Rig,
    timing: SkinnedCollider,
    /// As the last two frames drew it.
    drawn: Locals,
    drawn_before: Locals,
    /// As the last tick posed it.
    posed: Locals,
    /// Nothing moved in the last tick.
    still: bool,
    /// The next pose is no motion.
    restart: bool,
    /// As drawn now, for those who ask.
    as_drawn: Option<SkinnedSurface>,
    /// `as_drawn` has the last frame's pose.
    as_drawn_is_fresh: bool,
    error: Option<PoseError>,
    scratch: Scratch,
}

/// Kept for its memory.
#[derive(Debug, Default)]
struct Scratch {
    next: Locals,
    model_from_node: Vec<DAffine3>,
    matrices: Vec<Affine>,
    palette: Palette,
}

impl PosedSurface {
    pub(crate) fn new(
        collider: Arc<BuiltCollider>,
        rig: Rig,
        timing: SkinnedCollider,
        hierarchy: &Hierarchy<'_, '_>,
    ) -> Self {
        let mut posed = Self {
            surface: SkinnedSurface::new(Arc::clone(&collider.mesh)),
            collider,
            rig,
            timing,
            drawn: Locals::default(),
            drawn_before: Locals::default(),
            posed: Locals::default(),
            still: false,
            restart: true,
            as_drawn: None,
            as_drawn_is_fresh: false,
            error: None,
            scratch: Scratch::default(),
        };
        posed.sample(hierarchy);
        posed.drawn_before = posed.drawn.clone();
        posed.pose(1.0, hierarchy);
        posed
    }

    /// Why the surface kept its last pose in the last tick, if it did.
    pub fn error(&self) -> Option<&PoseError> {
        self.error.as_ref()
    }

    /// The next tick's pose is a place and no motion: after a teleport, which would else be a very fast way.
    pub fn forget_motion(&mut self) {
        self.restart = true;
    }

    /// For edits: disabled parts and triangles, holes. The next tick's pose overwrites any other.
    pub fn surface_mut(&mut self) -> &mut SkinnedSurface {
        &mut self.surface
    }

    /// Which triangle of the mesh asset a triangle of the collider is; `None` for one that an edit added.
    pub fn source_triangle(&self, triangle: TriangleId) -> Option<u32> {
        self.collider
            .source_triangles
            .get(triangle.index())
            .copied()
    }

    pub(crate) fn set_timing(&mut self, timing: SkinnedCollider) {
        self.timing = timing;
    }

    /// Notes the pose that a frame draws.
    pub(crate) fn sample(&mut self, hierarchy: &Hierarchy<'_, '_>) {
        self.as_drawn_is_fresh = false;
        std::mem::swap(&mut self.drawn, &mut self.drawn_before);
        if self.rig.read(hierarchy, &mut self.drawn).is_ok() {
            return;
        }
        if let Err(error) = self.follow(hierarchy) {
            // As it was.
            self.drawn.clone_from(&self.drawn_before);
            self.tell(Err(error.into()));
        }
    }

    /// Takes the pose of a tick, `fraction` of the way from the last frame to this one.
    pub(crate) fn pose(&mut self, fraction: f64, hierarchy: &Hierarchy<'_, '_>) {
        let posed = self.try_pose(fraction, hierarchy);
        self.tell(posed);
    }

    /// Of both poses, the current and the one before, becomes what it is now.
    fn follow(&mut self, hierarchy: &Hierarchy<'_, '_>) -> Result<(), ColliderError> {
        self.rig.follow(hierarchy)?;
        let read = self.rig.read(hierarchy, &mut self.drawn);
        read.map_err(|_| ColliderError::Joint { joint: 0 })?;
        self.drawn_before.clone_from(&self.drawn);
        Ok(())
    }

    fn try_pose(&mut self, fraction: f64, hierarchy: &Hierarchy<'_, '_>) -> Result<(), PoseError> {
        let mut next = std::mem::take(&mut self.scratch.next);
        if self.read_tick(fraction, hierarchy, &mut next)?.is_err() {
            self.follow(hierarchy)?;
            next.clone_from(&self.drawn);
        }
        std::mem::swap(&mut self.posed, &mut next);
        let same = self.posed == next;
        self.scratch.next = next;
        if same && self.still && !self.restart {
            return Ok(());
        }
        let scratch = &mut self.scratch;
        let placed = self.rig.compose(
            &self.posed,
            &mut scratch.model_from_node,
            &mut scratch.matrices,
        );
        let world_from_model = placed.ok_or(PoseError::Placement)?;
        scratch.palette.set_matrices(&scratch.matrices);
        if self.restart {
            self.surface.place(&scratch.palette, world_from_model)?;
        } else {
            self.surface.advance(&scratch.palette, world_from_model)?;
        }
        self.still = same || self.restart;
        self.restart = false;
        Ok(())
    }

    /// The transforms of a tick; `Ok(Err(_))` if the hierarchy has changed.
    fn read_tick(
        &self,
        fraction: f64,
        hierarchy: &Hierarchy<'_, '_>,
        into: &mut Locals,
    ) -> Result<Result<(), super::rig::Changed>, PoseError> {
        let (before, drawn) = (&self.drawn_before, &self.drawn);
        let joints = match self.timing.joints {
            PoseTiming::EachTick => self.rig.read_joints(hierarchy, &mut into.nodes),
            PoseTiming::EachFrame => {
                set_between(&mut into.nodes, &before.nodes, &drawn.nodes, fraction)?;
                Ok(())
            }
        };
        let root = match self.timing.root {
            PoseTiming::EachTick => self.rig.read_root(hierarchy, &mut into.above),
            PoseTiming::EachFrame => {
                set_between(&mut into.above, &before.above, &drawn.above, fraction)?;
                Ok(())
            }
        };
        Ok(joints.and(root))
    }

    /// Poses the surface as the last frame drew it.
    pub(crate) fn pose_as_drawn(&mut self) -> Option<&SkinnedSurface> {
        if !self.as_drawn_is_fresh {
            let scratch = &mut self.scratch;
            let placed = self.rig.compose(
                &self.drawn,
                &mut scratch.model_from_node,
                &mut scratch.matrices,
            )?;
            scratch.palette.set_matrices(&scratch.matrices);
            let mesh = self.surface.mesh();
            let surface = match &mut self.as_drawn {
                Some(surface) if Arc::ptr_eq(surface.mesh(), mesh) => surface,
                other => other.insert(SkinnedSurface::new(Arc::clone(mesh))),
            };
            surface.place(&scratch.palette, placed).ok()?;
            self.as_drawn_is_fresh = true;
        }
        self.as_drawn.as_ref()
    }

    /// As the last frame drew it, if anyone asked for that since.
    pub(crate) fn as_drawn(&self) -> Option<&SkinnedSurface> {
        self.as_drawn.as_ref().filter(|_| self.as_drawn_is_fresh)
    }

    /// Keeps what went wrong; a line in the log when it begins.
    fn tell(&mut self, result: Result<(), PoseError>) {
        let error = result.err();
        if let Some(error) = &error
            && self.error.is_none()
        {
            tracing::warn!("a surface keeps its last pose: {error}");
        }
        self.error = error;
    }
}

impl Deref for PosedSurface {
    type Target = SkinnedSurface;

    fn deref(&self) -> &SkinnedSurface {
        &self.surface
    }
}
