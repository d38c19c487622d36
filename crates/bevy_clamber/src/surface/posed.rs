use std::ops::Deref;
use std::sync::Arc;

use bevy_ecs::prelude::*;
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::TriangleId;
use clamber_surface::rig::{Palette, RigError};
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use glam::{DAffine3, DVec3};
use thiserror::Error;

use super::PoseTiming;
use super::clock::PoseClock;
use super::drawn::DrawnSurface;
use super::history::Between;
use super::rig::{Changed, Locals, Scene};
use crate::collider::BuiltCollider;
use crate::{ColliderError, SkinnedCollider};

/// Why a surface kept its last pose.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PoseError {
    /// A joint is gone, or its hierarchy cannot be followed. The next frame removes the surface.
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
    /// [`DrawnSurface::hierarchies`] in the last tick.
    hierarchies: u32,
    /// Counts teleports, for [`DrawnSurface`].
    teleports: u32,
    /// Counts times at which somebody may have changed the surface, for [`DrawnSurface`].
    edits: u32,
    /// The last tick placed a creature that had a pose before, and so did the one before: nobody knows how it moved.
    has_jumped: [bool; 2],
    /// Somebody may have changed the surface since the last tick.
    edited: bool,
    error: Option<PoseError>,
    scratch: Scratch,
}

/// Buffers, kept to reuse their memory.
#[derive(Debug, Default)]
struct Scratch {
    next: Locals,
    /// Where the nodes were in the last tick, in world space.
    places: Vec<DVec3>,
    model_from_node: Vec<DAffine3>,
    palette: Palette,
}

impl PosedSurface {
    /// The surface in the pose of `drawn`.
    pub(crate) fn new(
        entity: Entity,
        collider: Arc<BuiltCollider>,
        timing: &SkinnedCollider,
        drawn: &mut DrawnSurface,
        scene: &Scene<'_, '_, '_>,
        clock: &PoseClock,
    ) -> Self {
        let mut posed = Self {
            entity,
            surface: SkinnedSurface::new(Arc::clone(&collider.mesh)),
            collider,
            posed: Locals::default(),
            palette: Palette::default(),
            is_placed: false,
            still: false,
            posed_anew: false,
            restart: true,
            hierarchies: 0,
            teleports: 0,
            edits: 0,
            has_jumped: [false; 2],
            edited: false,
            error: None,
            scratch: Scratch::default(),
        };
        drawn.sample(&posed, timing, scene, clock.drawn());
        posed.pose(drawn, timing, scene, clock, 0.0);
        posed
    }

    /// Why the surface kept its previous pose in the last tick; `None` if it did not have to.
    pub fn error(&self) -> Option<&PoseError> {
        self.error.as_ref()
    }

    /// Why the surface has lost its joints, if it has.
    pub(crate) fn lost_joints(&self) -> Option<&ColliderError> {
        match &self.error {
            Some(PoseError::Hierarchy(error)) => Some(error),
            _ => None,
        }
    }

    /// Marks the motion until the next tick and the next drawn frame as a teleport, which gives the skin no velocity.
    ///
    /// Otherwise a teleport would be a very fast motion. Call this in the schedule that moves the creature.
    pub fn forget_motion(&mut self) {
        self.restart = true;
        self.teleports = self.teleports.wrapping_add(1);
    }

    /// Access for edits: disabling parts and triangles, cutting holes. The next tick overwrites a pose that is set
    /// here.
    ///
    /// Edits are lost when the collider is rebuilt, after a change of its mesh, skin or
    /// [`ColliderTag`](crate::ColliderTag). A new component is inserted then, so an observer of
    /// `On<Insert<PosedSurface>>` can repeat them.
    ///
    /// Anchors, picking, gizmos and [`DrawnSurfaceQuery`](crate::DrawnSurfaceQuery) see the drawn pose in a second
    /// surface. After the frame of each call, it is copied anew when one of them needs it.
    pub fn surface_mut(&mut self) -> &mut SkinnedSurface {
        self.edited = true;
        self.edits = self.edits.wrapping_add(1);
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

    pub(super) fn entity(&self) -> Entity {
        self.entity
    }

    pub(super) fn teleports(&self) -> u32 {
        self.teleports
    }

    pub(super) fn edits(&self) -> u32 {
        self.edits
    }

    /// True once the surface has had a valid pose.
    pub(crate) fn is_placed(&self) -> bool {
        self.is_placed
    }

    /// True if the tick, or the one before, placed a surface that had a pose before: the skin's velocity says nothing
    /// then about what a rider feels.
    pub(crate) fn has_jumped(&self) -> bool {
        self.has_jumped.contains(&true)
    }

    /// Takes the pose of a tick of `dt` seconds. Returns true if anything changed.
    pub(crate) fn pose(
        &mut self,
        drawn: &mut DrawnSurface,
        timing: &SkinnedCollider,
        scene: &Scene<'_, '_, '_>,
        clock: &PoseClock,
        dt: f64,
    ) -> bool {
        self.has_jumped = [false, self.has_jumped[0]];
        let mut next = std::mem::take(&mut self.scratch.next);
        let posed = self.try_pose(drawn, timing, scene, clock, dt, &mut next);
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

    fn try_pose(
        &mut self,
        drawn: &mut DrawnSurface,
        timing: &SkinnedCollider,
        scene: &Scene<'_, '_, '_>,
        clock: &PoseClock,
        dt: f64,
        next: &mut Locals,
    ) -> Result<bool, PoseError> {
        if timing.follows_frames() {
            drawn.check()?;
        }
        let at = drawn.history.advance(clock.at());
        // The same transforms in another order are another pose.
        self.still &= self.hierarchies == drawn.hierarchies;
        let at_rest = self.still && !self.restart && !self.edited;
        let is_still = drawn.history.is_still() && !timing.follows_ticks();
        if at_rest && is_still && drawn.history.last() == Some(&self.posed) {
            return Ok(false);
        }
        if read_tick(drawn, timing, scene, at, next)?.is_err() {
            drawn.follow(scene, clock.drawn(), next)?;
        }
        let same = self.posed == *next && self.hierarchies == drawn.hierarchies;
        self.hierarchies = drawn.hierarchies;
        if same && at_rest {
            return Ok(false);
        }
        let scratch = &mut self.scratch;
        let placed = drawn
            .rig
            .compose(next, &mut scratch.model_from_node, &mut scratch.palette);
        let world_from_model = placed.ok_or(PoseError::Placement)?;
        let jumps = timing.follows_frames() && (clock.jumped() || at.is_cut);
        let fastest = self.farthest(&world_from_model) / dt;
        let is_teleport = fastest > f64::from(timing.max_speed) && dt > 0.0;
        if is_teleport && !self.restart && !jumps {
            drawn.tell_teleport(self, fastest);
        }
        let restart = self.restart || jumps || is_teleport;
        if restart {
            self.surface
                .place(&self.scratch.palette, world_from_model)?;
        } else {
            self.surface
                .advance(&self.scratch.palette, world_from_model)?;
        }
        self.has_jumped[0] = restart && self.is_placed;
        std::mem::swap(&mut self.palette, &mut self.scratch.palette);
        std::mem::swap(&mut self.posed, next);
        self.is_placed = true;
        self.edited = false;
        self.still = same || restart;
        self.restart = false;
        Ok(true)
    }

    /// How far a node has moved at most since the last tick, metres. Keeps their places for the next tick.
    fn farthest(&mut self, world_from_model: &Similarity) -> f64 {
        let scratch = &mut self.scratch;
        let is_known = scratch.places.len() == scratch.model_from_node.len();
        scratch
            .places
            .resize(scratch.model_from_node.len(), DVec3::ZERO);
        let mut farthest = 0.0;
        for (place, node) in scratch.places.iter_mut().zip(&scratch.model_from_node) {
            let now = world_from_model.transform_point(node.translation);
            farthest = f64::max(farthest, now.distance_squared(*place));
            *place = now;
        }
        if is_known { farthest.sqrt() } else { 0.0 }
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

    /// Stores an error, and logs it if there was none before. True if the error has changed.
    fn tell(&mut self, error: Option<PoseError>) -> bool {
        if self.error == error {
            return false;
        }
        // Where joints are lost, the surface will be removed, and that is logged.
        if let Some(error) = &error
            && self.error.is_none()
            && !matches!(error, PoseError::Hierarchy(_))
        {
            let entity = self.entity;
            tracing::warn!("the surface of {entity} keeps its last pose: {error}");
        }
        self.error = error;
        true
    }
}

/// The transforms of a tick; `Ok(Err(_))` if the hierarchy has changed.
fn read_tick(
    drawn: &DrawnSurface,
    timing: &SkinnedCollider,
    scene: &Scene<'_, '_, '_>,
    at: Between,
    into: &mut Locals,
) -> Result<Result<(), Changed>, PoseError> {
    let joints = match timing.joints {
        PoseTiming::EachTick => drawn.rig.read_joints(scene, into),
        PoseTiming::EachFrame => {
            drawn.history.joints(at, into)?;
            Ok(())
        }
    };
    let root = match timing.root {
        PoseTiming::EachTick => drawn.rig.read_root(scene, into),
        PoseTiming::EachFrame => {
            drawn.history.root(at, into)?;
            Ok(())
        }
    };
    Ok(joints.and(root))
}

impl Deref for PosedSurface {
    type Target = SkinnedSurface;

    fn deref(&self) -> &SkinnedSurface {
        &self.surface
    }
}
