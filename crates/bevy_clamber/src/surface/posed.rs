use std::ops::Deref;
use std::sync::Arc;

use bevy_ecs::prelude::*;
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::TriangleId;
use clamber_surface::rig::{Between, Palette, PoseMotion, RigError};
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use glam::{DAffine3, DMat3, DVec3};
use thiserror::Error;

use super::PoseTiming;
use super::clock::FrameClock;
use super::drawn::DrawnSurface;
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
    model_from_node: Vec<DAffine3>,
    palette: Palette,
    /// The surface has had a valid pose.
    is_placed: bool,
    /// The surface did not move in the last tick.
    still: bool,
    /// The last tick posed the surface anew; false if it had no need to.
    posed_anew: bool,
    /// The next pose is placed, without motion.
    restart: bool,
    /// [`DrawnSurface::hierarchies`] in the last tick.
    hierarchies: u32,
    /// [`History::poses`](super::history::History::poses) when the surface was at rest last.
    poses: u64,
    /// Counts teleports, for [`DrawnSurface`].
    teleports: u32,
    /// Counts times at which somebody may have changed the surface, for [`DrawnSurface`].
    edits: u32,
    /// In the last tick, and in the one before, nobody knew how a creature moved that had a pose before: it was placed,
    /// or its pose had not been drawn yet.
    has_jumped: [bool; 2],
    /// The app may have changed the surface since the last tick.
    edited: bool,
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
    /// The surface in the pose of `drawn`.
    pub(crate) fn new(
        entity: Entity,
        collider: Arc<BuiltCollider>,
        timing: &SkinnedCollider,
        drawn: &mut DrawnSurface,
        scene: &Scene<'_, '_, '_>,
        clock: &FrameClock,
    ) -> Self {
        let mut posed = Self {
            entity,
            surface: SkinnedSurface::new(Arc::clone(&collider.mesh)),
            collider,
            posed: Locals::default(),
            model_from_node: Vec::new(),
            palette: Palette::default(),
            is_placed: false,
            still: false,
            posed_anew: false,
            restart: true,
            hierarchies: 0,
            poses: 0,
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

    /// True if the tick, or the one before, did not know how a surface moved that had a pose before: the skin's
    /// velocity says nothing then about what a rider feels.
    pub(crate) fn has_jumped(&self) -> bool {
        self.has_jumped.contains(&true)
    }

    /// Takes the pose of a tick of `dt` seconds. Returns true if anything changed.
    pub(crate) fn pose(
        &mut self,
        drawn: &mut DrawnSurface,
        timing: &SkinnedCollider,
        scene: &Scene<'_, '_, '_>,
        clock: &FrameClock,
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
        clock: &FrameClock,
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
        let poses = drawn.history.poses();
        // The pose of a jump is not known, even if it looks as if the skin stood still.
        self.has_jumped[0] = self.is_placed && timing.follows_frames() && clock.jumped();
        if at_rest && is_still && std::mem::replace(&mut self.poses, poses) == poses {
            return Ok(false);
        }
        let same = match read_tick(drawn, timing, scene, at, &self.posed, next)? {
            Ok(same) => same && self.hierarchies == drawn.hierarchies,
            Err(Changed) => {
                drawn.follow(scene, clock.drawn(), next)?;
                false
            }
        };
        if self.hierarchies != drawn.hierarchies {
            // Nodes are others now, or in another order.
            self.model_from_node.clear();
            self.hierarchies = drawn.hierarchies;
        }
        if same && at_rest {
            return Ok(false);
        }
        let scratch = &mut self.scratch;
        let placed = drawn
            .rig
            .compose(next, &mut scratch.model_from_node, &mut scratch.palette);
        let world_from_model = placed.ok_or(PoseError::Placement)?;
        let jumps =
            timing.follows_frames() && (clock.jumped() || at.motion == PoseMotion::Teleported);
        let limit = f64::from(timing.max_speed) * dt;
        let farthest = self.farthest(&world_from_model, limit);
        let is_teleport = farthest > limit && dt > 0.0;
        if is_teleport && !self.restart && !jumps {
            drawn.tell_teleport(self, farthest / dt);
        }
        let restart = self.restart || jumps || is_teleport;
        if restart {
            self.surface
                .teleport(&self.scratch.palette, world_from_model)?;
        } else {
            self.surface
                .advance(&self.scratch.palette, world_from_model)?;
        }
        self.has_jumped[0] = restart && self.is_placed;
        std::mem::swap(&mut self.palette, &mut self.scratch.palette);
        std::mem::swap(&mut self.model_from_node, &mut self.scratch.model_from_node);
        std::mem::swap(&mut self.posed, next);
        self.is_placed = true;
        self.edited = false;
        self.still = same || restart;
        self.restart = false;
        Ok(true)
    }

    /// How far a node has moved at most since the last tick, metres; or less than that and `limit`.
    fn farthest(&self, world_from_model: &Similarity, limit: f64) -> f64 {
        let (now, before) = (&self.scratch.model_from_node, &self.model_from_node);
        if now.len() != before.len() {
            return 0.0;
        }
        let old = self.surface.world_from_model();
        // In model space first, which is cheaper.
        let (mut step, mut reach) = (0.0, 0.0);
        for (now, before) in now.iter().zip(before) {
            step = f64::max(step, now.translation.distance_squared(before.translation));
            reach = f64::max(reach, before.translation.length_squared());
        }
        let bound =
            world_from_model.scale * step.sqrt() + swing(old, world_from_model, reach.sqrt());
        if bound <= limit {
            return bound;
        }
        let place = |placed: &Similarity, node: &DAffine3| placed.transform_point(node.translation);
        let moved = now
            .iter()
            .zip(before)
            .map(|(now, before)| place(world_from_model, now).distance_squared(place(old, before)));
        moved.fold(0.0, f64::max).sqrt()
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

/// A bound of how far apart two placements take a point, of at most this distance from the origin of model space.
fn swing(from: &Similarity, to: &Similarity, reach: f64) -> f64 {
    if from == to {
        return 0.0;
    }
    let axes = |placed: &Similarity| DMat3::from_quat(placed.rotation) * placed.scale;
    let (from_axes, to_axes) = (axes(from), axes(to));
    let apart = |a: DVec3, b: DVec3| a.distance_squared(b);
    let turned = apart(from_axes.x_axis, to_axes.x_axis)
        + apart(from_axes.y_axis, to_axes.y_axis)
        + apart(from_axes.z_axis, to_axes.z_axis);
    from.translation.distance(to.translation) + turned.sqrt() * reach
}

/// The transforms of a tick. True if they are equal to `last`; `Ok(Err(_))` if the hierarchy has changed.
fn read_tick(
    drawn: &DrawnSurface,
    timing: &SkinnedCollider,
    scene: &Scene<'_, '_, '_>,
    at: Between,
    last: &Locals,
    into: &mut Locals,
) -> Result<Result<bool, Changed>, PoseError> {
    if !timing.follows_frames() {
        return Ok(drawn.rig.read(scene, last, into));
    }
    let joints = match timing.joints {
        PoseTiming::EachTick => drawn.rig.read_joints(scene, last, into),
        PoseTiming::EachFrame => {
            drawn.history.joints(at, into)?;
            Ok(true)
        }
    };
    let root = match timing.root {
        PoseTiming::EachTick => drawn.rig.read_root(scene, last, into),
        PoseTiming::EachFrame => {
            drawn.history.root(at, into)?;
            Ok(true)
        }
    };
    Ok(joints.and(root).map(|_| into == last))
}

impl Deref for PosedSurface {
    type Target = SkinnedSurface;

    fn deref(&self) -> &SkinnedSurface {
        &self.surface
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;

    #[test]
    fn no_point_moves_farther_than_the_bound() {
        let mut random = fastrand::Rng::with_seed(5);
        let mut number = |size: f64| (random.f64() - 0.5) * size;
        let turn = |v: DVec3| DQuat::from_xyzw(v.x, v.y, v.z, 1.0).normalize();
        let mut tightest = 0.0f64;
        for _ in 0..20_000 {
            let mut vector = |size: f64| DVec3::new(number(size), number(size), number(size));
            let from = Similarity {
                rotation: turn(vector(6.0)),
                scale: 2.0,
                translation: vector(50.0),
            };
            let to = Similarity {
                rotation: turn(vector(0.1)) * from.rotation,
                scale: from.scale + vector(0.1).x,
                translation: from.translation + vector(1.0),
            };
            let point = vector(20.0);
            let moved = to
                .transform_point(point)
                .distance(from.transform_point(point));
            let bound = swing(&from, &to, point.length());
            assert!(
                moved <= bound + 1e-12,
                "{point} moves by {moved}, not {bound}"
            );
            tightest = tightest.max(moved / bound);
        }
        assert!(tightest > 0.5, "the bound is {tightest} of its use");
    }
}
