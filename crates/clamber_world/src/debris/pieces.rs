use clamber_surface::mesh::TriangleId;
use clamber_surface::surface::{SkinnedSurface, SurfaceHit};
use glam::DVec3;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::{ColliderHandle, ColliderSet, SolverFlags};
use rapier3d::pipeline::{PairFilterContext, PhysicsHooks};

use super::hull::Hull;
use super::inner_capsule::InnerCapsule;
use super::let_through::owner_in;
use super::passage::{Looked, Passage};
use super::piece::Piece;
use super::seen::{self, Seen};
use super::skin_patch::SkinPatch;
use super::{DebrisConfig, DebrisError};
use crate::ObstacleId;

/// Dynamic bodies of a rapier world that collide with the skin of moving creatures: rocks, tree trunks, the stones of a
/// wall.
///
/// Near each body, the skin becomes a kinematic rapier body: a skin patch, made of the few triangles that the body may
/// reach in this tick. The patch collides with that body only. It starts where the skin was a tick ago, and moves to
/// where the skin is now, so rapier's own solver finds contacts and friction against moving skin. Forces go one way: no
/// body pushes a creature. If skin is too fast for rapier, such as a limb that moves by a metre in a tick, a sweep of
/// the inside of the body against the moving skin finds it.
///
/// A creature cannot be pushed, so it would drive a body that it steps on through the ground. Such a body is left where
/// it is, and skin passes through it until it is outside the creature again. The same happens to a body on which a fold
/// of the skin closes, such as between head and shoulder.
///
/// Skin may also appear around a body: a stone breaks off below the skin, or a creature is new, is
/// [teleported](SkinnedSurface::teleport), is [edited](SkinnedSurface::edit) or shows a part again where bodies are. A
/// body that is no deeper below the skin than the radius of the largest ball in it is moved out of the creature within
/// a split second, by the shortest way ([`Debris::is_put_out`]). Skin passes through a deeper body, and through a body
/// whose way out is blocked ([`Debris::is_let_through`]): such a body falls through the creature, or lies on the ground
/// until the creature moves on. [`DebrisReport::enclosed`](crate::DebrisReport::enclosed) counts such bodies when they
/// are found. A game that wants another result moves the body itself, before the next tick, or removes it. Open skin
/// does not enclose a body: behind a sheet, or in a flat bowl, a body collides with the skin as usual. Only a body in a
/// closed hollow, between added skin and the skin below it, counts as inside.
///
/// The state of a body against a creature is stored under the creature's [`ObstacleId`], which must stay the same from
/// tick to tick. The order of the list does not change any result. The state of a creature that leaves the list is
/// dropped.
///
/// Skin patches are colliders of the rapier world. The `user_data` of a patch's collider and of its body is the
/// creature's [`ObstacleId`]. If a climber gets both the creature and a [`RapierTerrain`](crate::RapierTerrain) without
/// a filter, it touches that skin twice. Leave the patches out with
/// [`RapierTerrain::with_filter`](crate::RapierTerrain::with_filter): by [`DebrisConfig::groups`], or by
/// [`Debris::triangle_at`], which gives `Some` for subshape 0 of a patch.
///
/// Patches have a shape type of their own, which rapier's debug renderer does not draw and serde does not save. Remove
/// the bodies of patches from a world before serde saves it; they come back in the next tick. Rapier's continuous
/// collision detection (`ccd_enabled`) is weaker against such a shape, and not needed: a sweep of `Debris`'s own finds
/// fast skin.
///
/// Make these calls each tick, in this order. `Debris` is the step's [`PhysicsHooks`], which keep a patch from
/// colliding with anything but its body:
///
/// ```
/// # use std::sync::Arc;
/// # use clamber_surface::geometry::Similarity;
/// # use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource};
/// # use clamber_surface::surface::{SkinnedSurface, SurfaceError};
/// # use glam::Vec3;
/// use clamber_world::rapier3d::prelude::*;
/// use clamber_world::{Debris, DebrisConfig, ObstacleId};
/// # let positions = [Vec3::ZERO, Vec3::X, Vec3::Z].map(|p| p * 9.0 - Vec3::new(3.0, 0.0, 3.0));
/// # let source = MeshSource::rigid(&positions, &[[0, 2, 1]]);
/// # let mesh = ColliderMesh::build(&source, &ColliderBuildOptions::default())?.0;
/// # let mut surface = SkinnedSurface::new(Arc::new(mesh));
/// # let palette = clamber_surface::rig::Palette::from_matrices([clamber_surface::geometry::Affine::IDENTITY]);
///
/// let mut world = PhysicsWorld::default();
/// let (rock, _) = world.insert(
///     RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 1.0, 0.0)),
///     ColliderBuilder::ball(0.5),
/// );
/// let mut debris = Debris::new(DebrisConfig::default());
/// debris.add(rock, &mut world.bodies, &world.colliders)?;
///
/// let dt = f64::from(world.integration_parameters.dt);
/// for _ in 0..60 {
///     surface.advance(&palette, Similarity::IDENTITY)?;
///     let surfaces = [(ObstacleId(0), &surface)];
///     debris.before_step(&surfaces, &mut world.bodies, &mut world.colliders, dt)?;
///     world.step_with_events(&debris, &());
///     debris.after_step(
///         &surfaces,
///         &mut world.bodies,
///         &world.colliders,
///         &world.broad_phase,
///         &world.narrow_phase,
///         dt,
///     )?;
/// }
/// assert!((world.bodies[rock].translation().y - 0.5).abs() < 0.02);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Debris {
    config: DebrisConfig,
    pub(super) origin: DVec3,
    /// By ascending handle of the body.
    pub(super) pieces: Vec<Piece>,
    /// The body that each patch is for, by ascending handle of the patch's collider.
    pub(super) owners: Vec<(ColliderHandle, RigidBodyHandle)>,
    /// Patches of bodies and surfaces that are gone, for reuse.
    spare: Vec<SkinPatch>,
    /// Ids of a call's surfaces, ascending, with their indices in its list. Reused memory.
    pub(super) order: Vec<(ObstacleId, usize)>,
    /// The surfaces of the last tick, by ascending id.
    pub(super) seen: Vec<(ObstacleId, Seen)>,
    /// Number of times in this tick that skin was found to have appeared around a body.
    pub(super) enclosed: u32,
    /// Memory for hits of rays.
    pub(super) hits: Vec<SurfaceHit>,
}

impl Debris {
    /// Creates debris without any bodies.
    pub const fn new(config: DebrisConfig) -> Self {
        Self {
            config,
            origin: DVec3::ZERO,
            pieces: Vec::new(),
            owners: Vec::new(),
            spare: Vec::new(),
            order: Vec::new(),
            seen: Vec::new(),
            enclosed: 0,
            hits: Vec::new(),
        }
    }

    /// Sets the world position of rapier's origin, for scenes far larger than f32 can resolve. Zero by default.
    #[must_use]
    pub fn with_origin(mut self, origin: DVec3) -> Self {
        self.origin = origin;
        self
    }

    /// Makes a dynamic body collide with skin from now on. Its colliders are read now: if they change, add the body
    /// again. Turns on rapier's soft continuous collision detection for the body.
    ///
    /// # Errors
    /// [`DebrisError::NotDynamic`], [`DebrisError::NotSolid`].
    pub fn add(
        &mut self,
        body: RigidBodyHandle,
        bodies: &mut RigidBodySet,
        colliders: &ColliderSet,
    ) -> Result<(), DebrisError> {
        let known = bodies.get_mut(body).filter(|known| known.is_dynamic());
        let found = known.ok_or(DebrisError::NotDynamic(body))?;
        let core = InnerCapsule::of(found, colliders).ok_or(DebrisError::NotSolid(body))?;
        let hull = Hull::of(found, colliders).ok_or(DebrisError::NotSolid(body))?;
        found.set_soft_ccd_prediction(core.look_ahead());
        match self.place_of(body) {
            Ok(index) => self.pieces[index].reshape(core, hull),
            Err(index) => {
                let piece = Piece::new(body, core, hull, *found.position());
                self.pieces.insert(index, piece);
            }
        }
        Ok(())
    }

    /// Stops a body from colliding with skin; true if it did collide. `Debris` itself drops bodies that were removed
    /// from rapier's set.
    ///
    /// The kinematic bodies of its skin patches stay in rapier's sets for later bodies, with disabled colliders. They
    /// also stay when the `Debris` is dropped, and colliders that are enabled then stay enabled. So remove all bodies
    /// first.
    pub fn remove(&mut self, body: RigidBodyHandle, colliders: &mut ColliderSet) -> bool {
        let Ok(index) = self.place_of(body) else {
            return false;
        };
        let piece = self.pieces.remove(index);
        self.retire(piece, colliders);
        true
    }

    /// Bodies that collide with skin, by ascending handle.
    pub fn bodies(&self) -> impl ExactSizeIterator<Item = RigidBodyHandle> {
        self.pieces.iter().map(|piece| piece.body)
    }

    /// True if a body collides with skin.
    pub fn contains(&self, body: RigidBodyHandle) -> bool {
        self.place_of(body).is_ok()
    }

    /// True while skin passes through a body because it was caught between skin and something immovable, or other skin,
    /// or because skin appeared around it and it lay too deep to be [put out](Debris::is_put_out).
    pub fn is_let_through(&self, body: RigidBodyHandle) -> bool {
        self.passes(body, Passage::is_let_through)
    }

    /// True while a body around which skin appeared is moved out of the creature.
    pub fn is_put_out(&self, body: RigidBodyHandle) -> bool {
        self.passes(body, Passage::is_put_out)
    }

    /// True if the body's passage through the skin of some creature is of a certain kind.
    fn passes(&self, body: RigidBodyHandle, way: impl Fn(&Passage) -> bool) -> bool {
        let piece = self.place_of(body).map(|index| &self.pieces[index]);
        piece.is_ok_and(|piece| piece.patches.iter().any(|(_, patch)| way(&patch.passage)))
    }

    /// The surface and the triangle of a contact. `collider` and `subshape` name the contact's side that is not a
    /// debris body. `None` if that side is not skin.
    pub fn triangle_at(
        &self,
        collider: ColliderHandle,
        subshape: u32,
    ) -> Option<(ObstacleId, TriangleId)> {
        let owner = self.owner_of(collider)?;
        let piece = &self.pieces[self.place_of(owner).ok()?];
        let is_it = |patch: &SkinPatch| patch.handles().is_some_and(|(_, own)| own == collider);
        let mut patches = piece.patches.iter();
        let (obstacle, patch) = patches.find(|(_, patch)| is_it(patch))?;
        let triangle = patch.patch().triangles().get(subshape as usize)?;
        Some((*obstacle, *triangle))
    }

    /// Puts the skin near each body into rapier's world. Call it after the surfaces were advanced, and before the step
    /// of `dt` seconds.
    ///
    /// # Errors
    /// [`DebrisError::Tick`] or [`DebrisError::TwiceListed`]; nothing is changed then. [`DebrisError::OutOfReach`] for
    /// a body whose pose is not finite or too far from a surface; the bodies before it have their skin then.
    pub fn before_step(
        &mut self,
        surfaces: &[(ObstacleId, &SkinnedSurface)],
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
        dt: f64,
    ) -> Result<(), DebrisError> {
        check_tick(dt)?;
        self.set_order(surfaces)?;
        self.drop_lost(bodies, colliders);
        self.look_at_surfaces(surfaces);
        let mut changed = false;
        let shown = self.show_skin(surfaces, bodies, colliders, dt, &mut changed);
        // Also after an error, since some bodies may have their skin.
        if changed {
            self.list_owners();
        }
        shown
    }

    /// Finds the surfaces whose skin may have appeared around bodies, even if the rest of this tick fails.
    fn look_at_surfaces(&mut self, surfaces: &[(ObstacleId, &SkinnedSurface)]) {
        self.enclosed = 0;
        if self.pieces.is_empty() {
            // New bodies are tested for skin around them in any case.
            return;
        }
        seen::look(&mut self.seen, &self.order, surfaces);
        for (obstacle, _) in self.seen.iter().filter(|(_, seen)| seen.jumped) {
            for piece in &mut self.pieces {
                if let Ok(index) = piece.index_of(*obstacle) {
                    piece.patches[index].1.is_looked_at = false;
                }
            }
        }
    }

    fn show_skin(
        &mut self,
        surfaces: &[(ObstacleId, &SkinnedSurface)],
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
        dt: f64,
        changed: &mut bool,
    ) -> Result<(), DebrisError> {
        for piece in &mut self.pieces {
            let Some(body) = bodies.get(piece.body) else {
                continue;
            };
            let place = piece.set_course(body, self.origin, dt);
            let enabled = body.is_enabled();
            // A reused patch belongs to this body now.
            *changed |= piece.follow(&self.order, &mut self.spare, colliders);
            let looked = Looked {
                core: &piece.core,
                course: &piece.course,
                origin: self.origin,
            };
            for ((_, patch), (obstacle, index)) in piece.patches.iter_mut().zip(&self.order) {
                let surface = surfaces[*index].1;
                if !enabled {
                    patch.rest(colliders);
                    patch.is_looked_at = false;
                    continue;
                }
                if !patch.is_looked_at && patch.look(&looked, surface, &mut self.hits) {
                    self.enclosed += 1;
                }
                if patch.passes() {
                    patch.rest(colliders);
                    continue;
                }
                let had = patch.handles();
                patch
                    .update(
                        (*obstacle, surface),
                        &place,
                        &self.config,
                        bodies,
                        colliders,
                    )
                    .ok_or(DebrisError::OutOfReach {
                        body: piece.body,
                        obstacle: *obstacle,
                    })?;
                *changed |= had != patch.handles();
            }
        }
        Ok(())
    }

    fn place_of(&self, body: RigidBodyHandle) -> Result<usize, usize> {
        let key = |piece: &Piece| piece.body.into_raw_parts();
        self.pieces
            .binary_search_by_key(&body.into_raw_parts(), key)
    }

    /// The body that a skin patch's collider is for; `None` for any other collider.
    pub(super) fn owner_of(&self, collider: ColliderHandle) -> Option<RigidBodyHandle> {
        owner_in(&self.owners, collider)
    }

    /// Lists the ids of the surfaces in ascending order, so that the order of the argument does not change any result.
    pub(super) fn set_order(
        &mut self,
        surfaces: &[(ObstacleId, &SkinnedSurface)],
    ) -> Result<(), DebrisError> {
        self.order.clear();
        let ids = surfaces.iter().map(|(id, _)| *id);
        self.order.extend(ids.zip(0..));
        self.order.sort_unstable();
        let mut pairs = self.order.windows(2);
        match pairs.find(|pair| pair[0].0 == pair[1].0) {
            Some(pair) => Err(DebrisError::TwiceListed(pair[0].0)),
            None => Ok(()),
        }
    }

    fn drop_lost(&mut self, bodies: &RigidBodySet, colliders: &mut ColliderSet) {
        let mut index = 0;
        while index < self.pieces.len() {
            let body = bodies.get(self.pieces[index].body);
            if body.is_some_and(RigidBody::is_dynamic) {
                index += 1;
            } else {
                let piece = self.pieces.remove(index);
                self.retire(piece, colliders);
            }
        }
    }

    fn retire(&mut self, piece: Piece, colliders: &mut ColliderSet) {
        for (_, mut patch) in piece.patches {
            patch.retire(colliders);
            self.spare.push(patch);
        }
        self.list_owners();
    }

    fn list_owners(&mut self) {
        self.owners.clear();
        for piece in &self.pieces {
            let patches = piece.patches.iter();
            let handles = patches.filter_map(|(_, patch)| patch.handles());
            self.owners
                .extend(handles.map(|(_, collider)| (collider, piece.body)));
        }
        self.owners
            .sort_unstable_by_key(|(collider, _)| collider.into_raw_parts());
    }
}

impl PhysicsHooks for Debris {
    /// A skin patch collides with the body that it is for, and with nothing else.
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        let meets = |skin, body| self.owner_of(skin).is_none_or(|owner| Some(owner) == body);
        let both = meets(context.collider1, context.rigid_body2)
            && meets(context.collider2, context.rigid_body1);
        both.then_some(SolverFlags::COMPUTE_RIGID_IMPULSES)
    }
}

pub(super) fn check_tick(dt: f64) -> Result<(), DebrisError> {
    if dt > 0.0 && dt.is_finite() {
        Ok(())
    } else {
        Err(DebrisError::Tick(dt))
    }
}
