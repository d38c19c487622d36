//! The skin near one body, as a kinematic body of rapier's.

use clamber_surface::geometry::Similarity;
use clamber_surface::surface::{MovingTriangle, Patch, PatchChange, SkinnedSurface};
use glam::DVec3;
use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::{ColliderBuilder, ColliderHandle, ColliderSet, SharedShape, TriMesh};
use rapier3d::math::Vector;
use rapier3d::parry::query::PointQueryWithLocation;
use rapier3d::parry::shape::{TriMeshFlags, Triangle};
use rapier3d::pipeline::ActiveHooks;

use super::DebrisConfig;
use super::fit::RigidMotion;
use super::hull::Reach;
use super::patch_mesh::{move_trimesh, trimesh};

/// How far beyond the box that a body may reach a patch is filled when it is made, as a share of the
/// box. More makes it less often, and gives rapier more triangles in every tick.
const MARGIN: f32 = 0.02;

/// Without these, bodies that slide catch on edges between triangles. From both sides, since mirrored
/// joints turn triangles inside out.
const FLAGS: TriMeshFlags = TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED;

/// A piece of skin that collides with one body.
///
/// Its body stands where the piece of debris does and has no rotation of its own. The vertices are put
/// where they were a tick ago, and the body moves as they do on the whole over the tick that rapier
/// now steps, so rapier finds contacts where they begin and ends them where the skin is.
#[derive(Clone, Debug, Default)]
pub(super) struct SkinPatch {
    patch: Patch,
    handles: Option<(RigidBodyHandle, ColliderHandle)>,
    /// Vertices a tick ago and now, relative to the body, in rapier's space.
    before: Vec<DVec3>,
    now: Vec<DVec3>,
    motion: RigidMotion,
    /// How far the skin was from the middle of the body's hull a tick ago, if it was measured in this one.
    gap: Option<f64>,
    /// Skin passes through the body, and none is shown.
    pub(super) let_through: bool,
    /// Where the surface stands, if the skin shown stood still in it.
    still_at: Option<Similarity>,
}

/// Where a patch is wanted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Rapier's origin in the world.
    pub(super) origin: DVec3,
    /// What the body may reach in this tick.
    pub(super) reach: Reach,
    /// How far rapier is to look ahead along the skin's motion.
    pub(super) look_ahead: f32,
    pub(super) dt: f64,
}

impl SkinPatch {
    /// The skin near a place, this tick.
    pub(super) fn update(
        &mut self,
        surface: &SkinnedSurface,
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
        let apart = |moving: &MovingTriangle| reach.apart(moving);
        let change = self
            .patch
            .update_near(surface, reach.low, reach.high, margin, apart);
        if self.patch.is_empty() {
            self.rest(colliders);
            return Some(());
        }
        self.gap = None;
        let still = self.patch.positions() == self.patch.previous_positions();
        if still && change == PatchChange::Same && self.still_at == Some(*world_from_model) {
            // Nothing is new. Left alone, rapier lets rocks fall asleep on it.
            return Some(());
        }
        self.still_at = still.then_some(*world_from_model);
        self.place_vertices(surface, place);
        self.fit(place);
        self.show(change, place, config, bodies, colliders);
        Some(())
    }

    /// Forgets its surface and takes part in nothing, for another surface or body to use.
    pub(super) fn retire(&mut self, colliders: &mut ColliderSet) {
        self.rest(colliders);
        self.let_through = false;
    }

    /// Takes part in nothing until the next update that finds skin.
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

    pub(super) fn is_empty(&self) -> bool {
        self.patch.is_empty()
    }

    pub(super) fn patch(&self) -> &Patch {
        &self.patch
    }

    pub(super) fn handles(&self) -> Option<(RigidBodyHandle, ColliderHandle)> {
        self.handles
    }

    /// How far the skin was from the middle of the body's hull before the tick, metres; `None` if that is
    /// not known.
    pub(super) fn gap(&self) -> Option<f64> {
        self.gap
    }

    /// How far the skin and either end of the body, of which it is said how they moved, moved past each
    /// other at most, metres.
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

    /// The nearer a vertex the more it counts, and the point nearest to the body counts alone for the
    /// velocity there: what touches the body first moves as the skin does.
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

    /// Where the material point nearest to the body was and is.
    fn nearest(&self) -> Option<(DVec3, DVec3)> {
        let mut nearest: Option<(f64, [DVec3; 2])> = None;
        for corners in self.patch.indices() {
            let before = corners.map(|corner| self.before[corner as usize]);
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

    fn show(
        &mut self,
        change: PatchChange,
        place: &Place,
        config: &DebrisConfig,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) {
        let vertex = |index: usize| self.before[index].as_vec3();
        let known = self
            .handles
            .filter(|(body, collider)| bodies.contains(*body) && colliders.contains(*collider));
        let (body, collider) = match known {
            Some(known) => known,
            None => {
                let Some(mesh) = trimesh(&self.patch, FLAGS, vertex) else {
                    return;
                };
                insert(mesh, config, bodies, colliders)
            }
        };
        if let Some(shown) = colliders.get_mut(collider).filter(|_| known.is_some()) {
            let moved = change != PatchChange::Rebuilt && shown.is_enabled();
            let mesh = moved.then(|| shown.shape_mut().as_trimesh_mut()).flatten();
            if let Some(mesh) = mesh {
                move_trimesh(mesh, vertex);
            } else if let Some(mesh) = trimesh(&self.patch, FLAGS, vertex) {
                shown.set_shape(SharedShape::new(mesh));
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
    mesh: TriMesh,
    config: &DebrisConfig,
    bodies: &mut RigidBodySet,
    colliders: &mut ColliderSet,
) -> (RigidBodyHandle, ColliderHandle) {
    let body = bodies.insert(RigidBodyBuilder::kinematic_velocity_based());
    let collider = ColliderBuilder::new(SharedShape::new(mesh))
        // Kinematic bodies need no mass, and a mesh's takes long to find.
        .density(0.0)
        .friction(config.friction)
        .restitution(config.restitution)
        .collision_groups(config.groups)
        .active_hooks(ActiveHooks::FILTER_CONTACT_PAIRS);
    let collider = colliders.insert_with_parent(collider, body, bodies);
    (body, collider)
}

/// Weights of the corners of a triangle's point closest to the origin.
fn closest_to_origin(corners: [DVec3; 3]) -> [f64; 3] {
    let [a, b, c] = corners.map(|corner| corner.as_vec3());
    let triangle = Triangle::new(a, b, c);
    let (_, location) = triangle.project_local_point_and_get_location(Vector::ZERO, false);
    let weights = location.barycentric_coordinates();
    weights.unwrap_or([1.0, 0.0, 0.0]).map(f64::from)
}
