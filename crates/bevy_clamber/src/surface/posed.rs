use std::ops::Deref;
use std::sync::Arc;

use bevy_ecs::prelude::*;
use clamber_surface::mesh::TriangleId;
use clamber_surface::rig::{Palette, RigError};
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use glam::DAffine3;
use thiserror::Error;

use super::PoseTiming;
use super::rig::{Hierarchy, Locals, Rig};
use crate::collider::BuiltCollider;
use crate::{ColliderError, SkinnedCollider};

/// Why a surface kept its last pose.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PoseError {
    /// A joint is gone, or its hierarchy cannot be followed.
    #[error(transparent)]
    Hierarchy(#[from] ColliderError),
    /// The transform of a joint, or of an entity between or above the joints, is not finite, or has a rotation of
    /// length zero. Only for transforms that are sampled each frame ([`PoseTiming::EachFrame`]). With
    /// [`PoseTiming::EachTick`], a transform that is not finite gives [`PoseError::Palette`] or
    /// [`PoseError::Placement`].
    #[error(transparent)]
    Transform(#[from] RigError),
    /// The transforms above the joints have a scale of zero, or are not finite.
    #[error("the creature's transform has a scale of zero or is not finite")]
    Placement,
    /// The surface refuses the palette.
    #[error(transparent)]
    Palette(#[from] SurfaceError),
}

/// The surface of a skinned mesh in this tick's pose. Inserted beside a [`SkinnedCollider`](crate::SkinnedCollider)
/// once its collider is built.
///
/// Query all surfaces in world space through [`SurfaceQuery`](crate::SurfaceQuery). A single one dereferences to a
/// [`SkinnedSurface`], which has queries in model space as well.
#[derive(Component, Debug)]
pub struct PosedSurface {
    /// The entity of this component.
    entity: Entity,
    surface: SkinnedSurface,
    collider: Arc<BuiltCollider>,
    rig: Rig,
    timing: SkinnedCollider,
    /// Transforms as the last two frames drew them.
    drawn: Locals,
    drawn_before: Locals,
    /// `drawn` and `drawn_before` are equal.
    drawn_is_still: bool,
    /// Why the last frame's pose is not known.
    drawn_error: Option<ColliderError>,
    /// Transforms and palette of the last tick's pose.
    posed: Locals,
    palette: Palette,
    /// The surface has had a valid pose.
    is_placed: bool,
    /// Nothing moved in the last tick.
    still: bool,
    /// The last tick posed the surface anew; false if it had no need to.
    posed_anew: bool,
    /// The next pose is placed, without motion.
    restart: bool,
    /// The pose of the next frame has no motion.
    restart_drawn: bool,
    /// Somebody may have changed the surface since the last tick.
    edited: bool,
    /// The surface in a drawn pose; made on demand.
    as_drawn: Option<SkinnedSurface>,
    /// `as_drawn` has the last frame's pose.
    as_drawn_is_fresh: bool,
    error: Option<PoseError>,
    scratch: Scratch,
}

/// Buffers, kept to reuse their memory.
#[derive(Debug, Default)]
struct Scratch {
    next: Locals,
    model_from_node: Vec<DAffine3>,
    palette: Palette,
}

impl PosedSurface {
    pub(crate) fn new(
        entity: Entity,
        collider: Arc<BuiltCollider>,
        rig: Rig,
        timing: SkinnedCollider,
        hierarchy: &Hierarchy<'_, '_>,
    ) -> Self {
        let mut posed = Self {
            entity,
            surface: SkinnedSurface::new(Arc::clone(&collider.mesh)),
            collider,
            rig,
            timing,
            drawn: Locals::default(),
            drawn_before: Locals::default(),
            drawn_is_still: false,
            drawn_error: None,
            posed: Locals::default(),
            palette: Palette::default(),
            is_placed: false,
            still: false,
            posed_anew: false,
            restart: true,
            restart_drawn: false,
            edited: false,
            as_drawn: None,
            as_drawn_is_fresh: false,
            error: None,
            scratch: Scratch::default(),
        };
        posed.sample(hierarchy);
        posed.drawn_before.clone_from(&posed.drawn);
        posed.pose(1.0, hierarchy);
        posed
    }

    /// Why the surface kept its previous pose in the last tick; `None` if it did not have to.
    pub fn error(&self) -> Option<&PoseError> {
        self.error.as_ref()
    }

    /// Marks the motion until the next tick and the next drawn frame as a teleport, which gives the skin no velocity.
    ///
    /// Otherwise a teleport would be a very fast motion. Call this in the schedule that moves the creature.
    pub fn forget_motion(&mut self) {
        self.restart = true;
        self.restart_drawn = true;
    }

    /// Access for edits: disabling parts and triangles, cutting holes. The next tick overwrites a pose that is set
    /// here.
    ///
    /// Edits are lost when the collider is rebuilt, after a change of its mesh, skin or
    /// [`ColliderTag`](crate::ColliderTag). A new component is inserted then, so an observer of
    /// `On<Insert<PosedSurface>>` can repeat them.
    ///
    /// Anchors, picking and gizmos keep the drawn pose in a second surface. After each call it is copied anew when one
    /// of them needs it.
    pub fn surface_mut(&mut self) -> &mut SkinnedSurface {
        self.edited = true;
        self.as_drawn = None;
        &mut self.surface
    }

    /// The index in the mesh asset of a triangle of the collider; `None` for a triangle that an edit added.
    pub fn source_triangle(&self, triangle: TriangleId) -> Option<u32> {
        self.collider
            .source_triangles
            .get(triangle.index())
            .copied()
    }

    /// True if the last tick posed the surface anew, which resets the counts of queries.
    #[cfg_attr(
        not(feature = "diagnostics"),
        expect(dead_code, reason = "only diagnostics ask")
    )]
    pub(crate) fn is_posed_anew(&self) -> bool {
        self.posed_anew
    }

    pub(crate) fn set_timing(&mut self, timing: SkinnedCollider) {
        self.timing = timing;
    }

    /// True once the surface has had a valid pose.
    pub(crate) fn is_placed(&self) -> bool {
        self.is_placed
    }

    /// Records the pose that a frame draws.
    pub(crate) fn sample(&mut self, hierarchy: &Hierarchy<'_, '_>) {
        std::mem::swap(&mut self.drawn, &mut self.drawn_before);
        self.drawn_error = None;
        if self.rig.read(hierarchy, &mut self.drawn).is_err()
            && let Err(error) = self.follow(hierarchy)
        {
            // The previous pose stays.
            self.drawn.clone_from(&self.drawn_before);
            self.drawn_error = Some(error);
        }
        self.drawn_is_still = self.drawn == self.drawn_before;
        self.as_drawn_is_fresh &= self.drawn_is_still;
        if std::mem::take(&mut self.restart_drawn) {
            self.drawn_before.clone_from(&self.drawn);
            self.drawn_is_still = true;
        }
    }

    /// Takes the pose of a tick at a fraction of the time from the last frame to this one. Returns true if anything
    /// changed.
    pub(crate) fn pose(&mut self, fraction: f64, hierarchy: &Hierarchy<'_, '_>) -> bool {
        let mut next = std::mem::take(&mut self.scratch.next);
        let posed = self.try_pose(fraction, hierarchy, &mut next);
        self.scratch.next = next;
        let moved = match &posed {
            Ok(moved) => *moved,
            Err(_) => {
                let moved = self.rest();
                // When a valid pose comes again, the surface has not moved there in one tick.
                self.forget_motion();
                moved
            }
        };
        self.posed_anew = moved;
        self.tell(posed.err()) || moved
    }

    /// Reads a hierarchy that has changed. Both drawn poses become the current one.
    fn follow(&mut self, hierarchy: &Hierarchy<'_, '_>) -> Result<(), ColliderError> {
        self.rig.follow(hierarchy)?;
        let read = self.rig.read(hierarchy, &mut self.drawn);
        read.map_err(|_| ColliderError::Joint { joint: 0 })?;
        self.drawn_before.clone_from(&self.drawn);
        self.as_drawn_is_fresh = false;
        // The same transforms in another order are another pose.
        self.still = false;
        Ok(())
    }

    fn follows_frames(&self) -> bool {
        let SkinnedCollider { joints, root } = self.timing;
        [joints, root].contains(&PoseTiming::EachFrame)
    }

    fn follows_ticks(&self) -> bool {
        let SkinnedCollider { joints, root } = self.timing;
        [joints, root].contains(&PoseTiming::EachTick)
    }

    fn try_pose(
        &mut self,
        fraction: f64,
        hierarchy: &Hierarchy<'_, '_>,
        next: &mut Locals,
    ) -> Result<bool, PoseError> {
        if let Some(error) = &self.drawn_error
            && self.follows_frames()
        {
            return Err(error.clone().into());
        }
        let at_rest = self.still && !self.restart && !self.edited;
        if at_rest && self.drawn_is_still && !self.follows_ticks() && self.posed == self.drawn {
            return Ok(false);
        }
        if self.read_tick(fraction, hierarchy, next)?.is_err() {
            self.follow(hierarchy)?;
            next.clone_from(&self.drawn);
        }
        let same = self.posed == *next;
        if same && at_rest {
            return Ok(false);
        }
        let scratch = &mut self.scratch;
        let placed = self
            .rig
            .compose(next, &mut scratch.model_from_node, &mut scratch.palette);
        let world_from_model = placed.ok_or(PoseError::Placement)?;
        if self.restart {
            self.surface.place(&scratch.palette, world_from_model)?;
        } else {
            self.surface.advance(&scratch.palette, world_from_model)?;
        }
        std::mem::swap(&mut self.palette, &mut scratch.palette);
        std::mem::swap(&mut self.posed, next);
        self.is_placed = true;
        self.edited = false;
        self.still = same || self.restart;
        // The teleport may not be drawn yet.
        self.restart = self.restart_drawn && self.follows_frames();
        Ok(true)
    }

    /// Repeats the last pose, so that the surface stands still. True if it moved until now.
    fn rest(&mut self) -> bool {
        if self.still || !self.is_placed {
            return false;
        }
        let world_from_model = *self.surface.world_from_model();
        // The surface has accepted both before.
        self.still = self
            .surface
            .advance(&self.palette, world_from_model)
            .is_ok();
        self.still
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
                into.nodes.clone_from(&before.nodes);
                into.nodes.blend_in(&drawn.nodes, fraction)?;
                Ok(())
            }
        };
        let root = match self.timing.root {
            PoseTiming::EachTick => self.rig.read_root(hierarchy, &mut into.above),
            PoseTiming::EachFrame => {
                into.above.clone_from(&before.above);
                into.above.blend_in(&drawn.above, fraction)?;
                Ok(())
            }
        };
        Ok(joints.and(root))
    }

    /// Poses the surface as the last frame drew it.
    pub(crate) fn pose_as_drawn(&mut self) -> Option<&SkinnedSurface> {
        if self.as_drawn.is_none() || !self.as_drawn_is_fresh {
            self.as_drawn_is_fresh = false;
            let scratch = &mut self.scratch;
            let placed = self.rig.compose(
                &self.drawn,
                &mut scratch.model_from_node,
                &mut scratch.palette,
            )?;
            let surface = self.as_drawn.get_or_insert_with(|| self.surface.clone());
            surface.place(&self.scratch.palette, placed).ok()?;
            self.as_drawn_is_fresh = true;
        }
        self.as_drawn.as_ref()
    }

    /// The surface in the last frame's pose, if `pose_as_drawn` was called since.
    pub(crate) fn as_drawn(&self) -> Option<&SkinnedSurface> {
        self.as_drawn.as_ref().filter(|_| self.as_drawn_is_fresh)
    }

    /// Stores an error, and logs it if there was none before. True if the error has changed.
    fn tell(&mut self, error: Option<PoseError>) -> bool {
        if self.error == error {
            return false;
        }
        if let Some(error) = &error
            && self.error.is_none()
        {
            let entity = self.entity;
            tracing::warn!("the surface of {entity} keeps its last pose: {error}");
        }
        self.error = error;
        true
    }
}

impl Deref for PosedSurface {
    type Target = SkinnedSurface;

    fn deref(&self) -> &SkinnedSurface {
        &self.surface
    }
}
