//! One body, and the skin near it.

use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};
use rapier3d::geometry::ColliderSet;
use rapier3d::math::Pose;

use super::hull::{Hull, Reach};
use super::inner_capsule::InnerCapsule;
use super::keep_out::{Kept, MET, SWEPT, keep_out, stays_clear};
use super::skin_patch::{Place, SkinPatch};
use crate::ObstacleId;

/// Skin is searched this far beyond the reach of a body's own motion, metres: more than gravity adds in a tick at 60 Hz
/// and rapier's prediction of 2 cm together. A larger value gives rapier more triangles.
const REACH: f64 = 0.025;

/// One body, and the skin near it.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) body: RigidBodyHandle,
    pub(super) core: InnerCapsule,
    pub(super) hull: Hull,
    /// The body's pose before the step, and its pose after it if nothing stopped it.
    pub(super) course: [Pose; 2],
    /// The body's pose after the last step; `None` if there was none.
    pub(super) left_at: Option<Pose>,
    /// One patch for each surface of the last tick, by ascending id.
    pub(super) patches: Vec<(ObstacleId, SkinPatch)>,
}

impl Piece {
    pub(super) fn new(body: RigidBodyHandle, core: InnerCapsule, hull: Hull, at: Pose) -> Self {
        Self {
            body,
            core,
            hull,
            course: [at; 2],
            left_at: None,
            patches: Vec::new(),
        }
    }

    /// Replaces the shapes, after the body's colliders have changed.
    pub(super) fn reshape(&mut self, core: InnerCapsule, hull: Hull) {
        (self.core, self.hull) = (core, hull);
        self.left_at = None;
    }

    /// Stores the body's expected motion in a step of `dt` seconds. Returns the place where the body needs skin.
    pub(super) fn set_course(&mut self, body: &RigidBody, origin: DVec3, dt: f64) -> Place {
        let end = body.predict_position_using_velocity(dt as f32);
        self.course = [*body.position(), end];
        if self.left_at != Some(self.course[0]) {
            // The body is new, or was moved from outside.
            for (_, patch) in &mut self.patches {
                patch.is_looked_at = false;
            }
        }
        Place {
            origin,
            reach: Reach::new(self.hull, [body.position(), &end], REACH),
            look_ahead: self.core.look_ahead(),
            dt,
        }
    }

    /// The body's pose before the step.
    pub(super) fn start(&self) -> &Pose {
        &self.course[0]
    }

    /// The body's patch of a surface; `None` if that was not among the surfaces before the step.
    pub(super) fn patch(&self, obstacle: ObstacleId) -> Option<&SkinPatch> {
        let index = self.index_of(obstacle).ok()?;
        Some(&self.patches[index].1)
    }

    /// Index of the body's patch of a surface, or of where to insert that patch.
    pub(super) fn index_of(&self, obstacle: ObstacleId) -> Result<usize, usize> {
        self.patches
            .binary_search_by_key(&obstacle, |(known, _)| *known)
    }

    /// Gives the body a patch for each of these surfaces, which are by ascending id, and for no other. Patches of other
    /// surfaces are retired to `spare`, and new ones are taken from there. True if a patch was added or removed.
    pub(super) fn follow(
        &mut self,
        surfaces: &[(ObstacleId, usize)],
        spare: &mut Vec<SkinPatch>,
        colliders: &mut ColliderSet,
    ) -> bool {
        let (mut index, mut changed) = (0, false);
        while index < self.patches.len() {
            let known = self.patches[index].0;
            if surfaces.binary_search_by_key(&known, |(id, _)| *id).is_ok() {
                index += 1;
            } else {
                let (_, mut gone) = self.patches.remove(index);
                gone.retire(colliders);
                spare.push(gone);
                changed = true;
            }
        }
        for (obstacle, _) in surfaces {
            if let Err(index) = self.index_of(*obstacle) {
                let patch = spare.pop().unwrap_or_default();
                self.patches.insert(index, (*obstacle, patch));
                changed = true;
            }
        }
        changed
    }

    /// Finds how to move the body out of one surface, after the step has moved it to the pose `end`. `None` if the body
    /// is out of reach of the surface.
    pub(super) fn keep_out(
        &self,
        obstacle: ObstacleId,
        surface: &SkinnedSurface,
        end: &Pose,
        origin: DVec3,
        dt: f64,
    ) -> Option<Kept> {
        let ends = [&self.course[0], end].map(|pose| self.core.ends_at(pose));
        let in_world = ends.map(|ends| ends.map(|end| end + origin));
        if let Some(patch) = self.patch(obstacle)
            && self.kept_course(&ends[1])
            && (patch.is_empty() || self.stays_clear(patch, surface, ends, in_world[1])?)
        {
            #[cfg(test)]
            assert_eq!(keep_out(surface, &self.core, in_world, dt)?.pushed, None);
            return Some(Kept::FREE);
        }
        keep_out(surface, &self.core, in_world, dt)
    }

    /// True if it is certain without a sweep that the body has touched none of the skin within its hull's reach.
    fn stays_clear(
        &self,
        patch: &SkinPatch,
        surface: &SkinnedSurface,
        [start, end]: [[DVec3; 2]; 2],
        end_in_world: [DVec3; 2],
    ) -> Option<bool> {
        let motion = patch.most_motion([0, 1].map(|side| end[side] - start[side]));
        let middle = self.hull.middle_at(&self.course[0]);
        let farther = (start[0] - middle)
            .length()
            .max((start[1] - middle).length());
        let far = patch
            .gap()
            .is_some_and(|gap| gap - farther - motion > self.core.radius * MET);
        Some(far || stays_clear(surface, &self.core, end_in_world, motion)?)
    }

    /// True if the core ended so near to its expected pose that the swept part of it can have touched only skin within
    /// the hull's reach.
    fn kept_course(&self, ends: &[DVec3; 2]) -> bool {
        let expected = self.core.ends_at(&self.course[1]);
        let astray = REACH + self.core.radius * (1.0 - SWEPT);
        (0..2).all(|side| (ends[side] - expected[side]).length() <= astray)
    }
}
