//! The skin near one body, as a kinematic rapier body.

use clamber_surface::geometry::Similarity;
use clamber_surface::surface::{Patch, PatchChange, SkinnedSurface, SurfaceHit};
use glam::DVec3;
use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::{ColliderBuilder, ColliderHandle, ColliderSet, SharedShape};
use rapier3d::math::Vector;
use rapier3d::parry::query::PointQueryWithLocation;
use rapier3d::parry::shape::Triangle;
use rapier3d::pipeline::ActiveHooks;

use super::DebrisConfig;
use super::fit::RigidMotion;
use super::hull::Reach;
use super::passage::{Looked, Passage};
use super::patch_shape::PatchShape;
use crate::ObstacleId;

/// A new patch is filled this far beyond the box that the body may reach, as a fraction of half the box's longest side.
/// A larger margin rebuilds patches less often, but gives rapier more triangles in every tick.
const MARGIN: f32 = 0.02;

/// A piece of skin that collides with one body.
///
/// The patch's kinematic body is placed at the middle of the debris body, without rotation. Its vertices are placed
/// where they were a tick ago. It moves as the vertices do as a whole over the tick that rapier now steps. So rapier
/// finds contacts when they begin, and the patch ends where the skin is now.
#[derive(Clone, Debug, Default)]
pub(super) struct SkinPatch {
    patch: Patch,
    handles: Option<(RigidBodyHandle, ColliderHandle)>,
    /// Vertices a tick ago and now, relative to the body, in rapier's space.
    before: Vec<DVec3>,
    now: Vec<DVec3>,
    motion: RigidMotion,
    /// Distance of the skin from the middle of the body's hull a tick ago; `None` if it was not measured in this tick.
    gap: Option<f64>,
    /// Whether skin and body collide. If they do not, rapier gets no patch.
    pub(super) passage: Passage,
    /// True if skin that appeared around the body would have been found. False for a new patch.
    pub(super) is_looked_at: bool,
    /// The surface's `world_from_model`, if the patch's skin is at rest in model space.
    still_at: Option<Similarity>,
}

/// Where a patch is needed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// World position of rapier's origin.
    pub(super) origin: DVec3,
    /// The region that the body may reach in this tick.
    pub(super) reach: Reach,
    /// Distance at which rapier predicts contacts along the skin's motion, metres.
    pub(super) look_ahead: f32,
    pub(super) dt: f64,
}

impl SkinPatch {
    /// Updates the patch to the skin near a place in this tick. `None` if the place is out of reach.
    pub(super) fn update(
        &mut self,
        (obstacle, surface): (ObstacleId, &SkinnedSurface),
        place: &Place,
        config: &DebrisConfig,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) -> Option<()> {
        let world_from_model = surface.world_from_model();
        let reach = place.reach.on(world_from_model, place.origin);
        if !(reach.low.is_finite() && reach.high.is_finite()) {
            return None;
        }
        let margin = reach.half_side() * MARGIN;
        let change = self.patch.update_near(
            surface,
            reach.low,
            reach.high,
            margin,
            #[inline(always)]
            |moving| reach.apart(moving),
        );
        if self.patch.is_empty() {
            self.rest(colliders);
            return Some(());
        }
        self.gap = None;
        let still = self.patch.positions() == self.patch.previous_positions();
        if still
            && change == PatchChange::Same
            && self.still_at == Some(*world_from_model)
            && self.shown(bodies, colliders).is_some()
        {
            // The patch is unchanged. If it is left alone, rapier lets rocks fall asleep on it.
            return Some(());
        }
        self.still_at = still.then_some(*world_from_model);
        self.place_vertices(surface, place);
        self.fit(place);
        self.show(change, place, config, bodies, colliders);
        // The patch may have belonged to another creature.
        let id = u128::from(obstacle.0);
        if let Some((body, collider)) = self.handles
            && colliders
                .get(collider)
                .is_some_and(|known| known.user_data != id)
        {
            if let Some(collider) = colliders.get_mut(collider) {
                collider.user_data = id;
            }
            if let Some(body) = bodies.get_mut(body) {
                body.user_data = id;
            }
        }
        Some(())
    }

    /// Clears the patch and disables its collider, for reuse with another surface or body.
    pub(super) fn retire(&mut self, colliders: &mut ColliderSet) {
        self.rest(colliders);
        self.passage = Passage::Closed;
        self.is_looked_at = false;
    }

    /// Clears the patch and disables its collider until an update finds skin again.
    pub(super) fn rest(&mut self, colliders: &mut ColliderSet) {
        self.patch.clear();
        self.gap = None;
        self.still_at = None;
        if let Some((_, collider)) = self.handles
            && colliders.get(collider).is_some_and(|c| c.is_enabled())
            && let Some(collider) = colliders.get_mut(collider)
        {
            collider.set_enabled(false);
        }
    }

    /// Tests whether skin has appeared around the body, and sets the passage. True if it has appeared. A body that is
    /// let through already stays so until it is outside.
    pub(super) fn look(
        &mut self,
        body: &Looked<'_>,
        surface: &SkinnedSurface,
        hits: &mut Vec<SurfaceHit>,
    ) -> bool {
        self.is_looked_at = true;
        let before = match self.passage {
            Passage::LetThrough => return false,
            Passage::Closed => None,
            Passage::PutOut(before) => Some(before),
        };
        self.passage = Passage::around(body, surface, hits);
        if let (Passage::PutOut(now), Some(before)) = (&mut self.passage, &before) {
            *now = now.instead_of(before);
        }
        before.is_none() && self.passes()
    }

    /// True if skin passes through the body.
    pub(super) fn passes(&self) -> bool {
        !matches!(self.passage, Passage::Closed)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.patch.is_empty()
    }

    pub(super) fn patch(&self) -> &Patch {
        &self.patch
    }

    pub(super) fn handles(&self) -> Option<(RigidBodyHandle, ColliderHandle)> {
        self.handles
    }

    /// Distance of the skin from the middle of the body's hull before the tick, metres; `None` if it is not known.
    pub(super) fn gap(&self) -> Option<f64> {
        self.gap
    }

    /// The largest motion of the skin relative to either end of the body, metres. `ends` holds the displacements of the
    /// two ends.
    pub(super) fn most_motion(&self, ends: [DVec3; 2]) -> f64 {
        let pairs = self.before.iter().zip(&self.now);
        let squares =
            pairs.flat_map(|(before, now)| ends.map(|end| (*now - *before - end).length_squared()));
        squares.fold(0.0, f64::max).sqrt()
    }

    fn place_vertices(&mut self, surface: &SkinnedSurface, place: &Place) {
        let world_from_model = surface.world_from_model();
        let from = place.origin + place.reach.middle();
        let local = |p: &glam::Vec3| world_from_model.transform_point_f32(*p) - from;
        self.before.clear();
        self.before
            .extend(self.patch.previous_positions().iter().map(local));
        self.now.clear();
        self.now.extend(self.patch.positions().iter().map(local));
    }

    /// Fits the patch's rigid motion. Nearer vertices have more weight. At the point nearest to the body, the patch has
    /// exactly the skin's velocity, so the first skin to touch the body moves as the skin does.
    fn fit(&mut self, place: &Place) {
        let reach = place.reach.radius() * place.reach.radius();
        let pairs = self.before.iter().zip(&self.now);
        let pairs = pairs.map(|(before, now)| {
            let apart = (*before + *now) * 0.5;
            (1.0 / (reach + apart.length_squared()), *before, *now)
        });
        self.motion = RigidMotion::fit(pairs, place.dt);
        if let Some((before, now)) = self.nearest() {
            self.gap = Some(before.length());
            let wanted = now - before;
            let off = wanted - self.motion.displacement(before, place.dt);
            self.motion.linear += off / place.dt;
        }
    }

    /// Previous and current position of the material point nearest to the body.
    fn nearest(&self) -> Option<(DVec3, DVec3)> {
        let mut nearest: Option<(f64, [DVec3; 2])> = None;
        for corners in self.patch.indices() {
            let before = corners.map(|corner| self.before[corner as usize]);
            if nearest.is_some_and(|(least, _)| least < least_square(before)) {
                continue;
            }
            let weights = closest_to_origin(before);
            let at = |corners: [DVec3; 3]| {
                corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]
            };
            let distance = at(before).length_squared();
            if nearest.is_none_or(|(least, _)| distance < least) {
                let now = corners.map(|corner| self.now[corner as usize]);
                nearest = Some((distance, [at(before), at(now)]));
            }
        }
        nearest.map(|(_, [before, now])| (before, now))
    }

    /// The patch's body and collider, if they are in rapier's sets.
    fn shown(
        &self,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
    ) -> Option<(RigidBodyHandle, ColliderHandle)> {
        self.handles
            .filter(|(body, collider)| bodies.contains(*body) && colliders.contains(*collider))
    }

    fn show(
        &mut self,
        change: PatchChange,
        place: &Place,
        config: &DebrisConfig,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) {
        let vertices = self.before.iter().map(|vertex| vertex.as_vec3());
        let known = self.shown(bodies, colliders);
        let (body, collider) = known.unwrap_or_else(|| {
            let shape = PatchShape::new(self.patch.indices(), vertices.clone());
            insert(shape, config, bodies, colliders)
        });
        if let Some(shown) = colliders.get_mut(collider).filter(|_| known.is_some()) {
            let moved = change != PatchChange::Rebuilt && shown.is_enabled();
            let shape = moved.then(|| shown.shape_mut().as_shape_mut::<PatchShape>());
            if let Some(shape) = shape.flatten() {
                shape.place(vertices);
            } else {
                let shape = PatchShape::new(self.patch.indices(), vertices);
                shown.set_shape(SharedShape::new(shape));
            }
            shown.set_enabled(true);
        }
        if let Some(body) = bodies.get_mut(body) {
            body.set_translation(place.reach.middle().as_vec3(), false);
            body.set_rotation(rapier3d::math::Rotation::IDENTITY, false);
            body.set_soft_ccd_prediction(place.look_ahead);
            body.set_linvel(self.motion.linear.as_vec3(), true);
            body.set_angvel(self.motion.angular.as_vec3(), true);
        }
        self.handles = Some((body, collider));
    }
}

fn insert(
    shape: PatchShape,
    config: &DebrisConfig,
    bodies: &mut RigidBodySet,
    colliders: &mut ColliderSet,
) -> (RigidBodyHandle, ColliderHandle) {
    let body = bodies.insert(RigidBodyBuilder::kinematic_velocity_based());
    let collider = ColliderBuilder::new(SharedShape::new(shape))
        // Kinematic bodies need no mass, and the mass of a mesh is slow to compute.
        .density(0.0)
        .friction(config.friction)
        .restitution(config.restitution)
        .collision_groups(config.groups)
        .active_hooks(ActiveHooks::FILTER_CONTACT_PAIRS);
    let collider = colliders.insert_with_parent(collider, body, bodies);
    (body, collider)
}

/// Squared distance from the origin to the box around a triangle: a lower bound of the squared distance to the
/// triangle.
fn least_square([a, b, c]: [DVec3; 3]) -> f64 {
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    low.max(-high).max(DVec3::ZERO).length_squared()
}

/// Barycentric weights of a triangle's point closest to the origin.
fn closest_to_origin(corners: [DVec3; 3]) -> [f64; 3] {
    let [a, b, c] = corners.map(|corner| corner.as_vec3());
    let triangle = Triangle::new(a, b, c);
    let (_, location) = triangle.project_local_point_and_get_location(Vector::ZERO, false);
    let weights = location.barycentric_coordinates();
    weights.unwrap_or([1.0, 0.0, 0.0]).map(f64::from)
}
