//! One body, and the skin near it.

use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use glam::DVec3;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};
use rapier3d::math::Pose;

use super::core::Core;
use super::hull::{Hull, Reach};
use super::keep_out::{Kept, MET, SWEPT, keep_out, stays_clear};
use super::skin_patch::{Place, SkinPatch};

/// Metres beyond what a body's own motion reaches that skin is looked for: more than what gravity adds
/// within a tick, and rapier's own prediction of 2 cm. More gives rapier more triangles.
const REACH: f64 = 0.025;

/// One body, and the skin near it.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) body: RigidBodyHandle,
    pub(super) core: Core,
    hull: Hull,
    /// Where it was before the step, and where it would be after it if nothing stopped it.
    course: [Pose; 2],
    /// One for each surface.
    pub(super) patches: Vec<SkinPatch>,
}

impl Piece {
    pub(super) fn new(body: RigidBodyHandle, core: Core, hull: Hull, at: Pose) -> Self {
        Self {
            body,
            core,
            hull,
            course: [at; 2],
            patches: Vec::new(),
        }
    }

    /// Its colliders have changed.
    pub(super) fn reshape(&mut self, core: Core, hull: Hull) {
        (self.core, self.hull) = (core, hull);
    }

    /// What it is about to do in a step of `dt` seconds, and where skin is wanted for that.
    pub(super) fn set_course(&mut self, body: &RigidBody, origin: DVec3, dt: f64) -> Place {
        let end = body.predict_position_using_velocity(dt as f32);
        self.course = [*body.position(), end];
        Place {
            origin,
            reach: Reach::new(self.hull, [body.position(), &end], REACH),
            look_ahead: self.core.look_ahead(),
            dt,
        }
    }

    /// Where it was before the step.
    pub(super) fn start(&self) -> &Pose {
        &self.course[0]
    }

    /// What keeps it out of one surface, now that the step took it to a pose.
    pub(super) fn keep_out(
        &self,
        index: usize,
        surface: &SkinnedSurface,
        end: &Pose,
        origin: DVec3,
        dt: f64,
    ) -> Result<Kept, SurfaceError> {
        let ends = [&self.course[0], end].map(|pose| self.core.ends_at(pose));
        let in_world = ends.map(|ends| ends.map(|end| end + origin));
        if let Some(patch) = self.patches.get(index)
            && self.kept_course(&ends[1])
            && (patch.is_empty() || self.stays_clear(patch, surface, ends, in_world[1])?)
        {
            #[cfg(test)]
            assert_eq!(keep_out(surface, &self.core, in_world, dt)?.pushed, None);
            return Ok(Kept::FREE);
        }
        keep_out(surface, &self.core, in_world, dt)
    }

    /// True if it is seen without a sweep that it met none of the skin that its hull could meet.
    fn stays_clear(
        &self,
        patch: &SkinPatch,
        surface: &SkinnedSurface,
        [start, end]: [[DVec3; 2]; 2],
        end_in_world: [DVec3; 2],
    ) -> Result<bool, SurfaceError> {
        let motion = patch.most_motion([0, 1].map(|side| end[side] - start[side]));
        let middle = self.hull.middle_at(&self.course[0]);
        let farther = (start[0] - middle)
            .length()
            .max((start[1] - middle).length());
        let far = patch
            .gap()
            .is_some_and(|gap| gap - farther - motion > self.core.radius * MET);
        Ok(far || stays_clear(surface, &self.core, end_in_world, motion)?)
    }

    /// True if its core ended where it was expected to, so far that what of it is swept can have met no
    /// skin but that which its hull was to meet.
    fn kept_course(&self, ends: &[DVec3; 2]) -> bool {
        let expected = self.core.ends_at(&self.course[1]);
        let astray = REACH + self.core.radius * (1.0 - SWEPT);
        (0..2).all(|side| (ends[side] - expected[side]).length() <= astray)
    }
}
