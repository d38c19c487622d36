//! Hands and feet of a frame: they move with the support, step, and are posed.

use clamber_animation::{Spring, joint_in_model};
use clamber_surface::rig::Pose;
use glam::{DQuat, DVec3};

use super::reached::Reached;
use super::{Placed, Update};
use crate::body::climb::{Climb, Schedule};
use crate::body::context::Context;
use crate::body::event::Plant;
use crate::body::feet;
use crate::body::goals::{self, Goal};
use crate::body::legs::Legs;
use crate::body::limb::{Doing, LimbMemory};
use crate::body::root::Root;
use crate::body::solve::{self, Wanted};
use crate::body::stance::Stance;
use crate::body::walk::Walk;
use crate::figure::Place;
use crate::{BodyError, Extremity};

/// Share of a limb's length over which a limb on its way slows down near its full stretch.
const SOFT_STRETCH: f64 = 0.03;

/// Distance from the clips' pose at which a free limb has all of [`SOFT_STRETCH`], metres.
const FULLY_SOFT_DISTANCE: f64 = 0.05;

/// Distance from the clips' pose within which a free limb follows the clips without inverse kinematics, metres.
const CLIP_DISTANCE: f64 = 1e-3;

impl Update<'_> {
    /// The limbs after this frame, before they step: they move with the support, and leave the holds of another stance.
    pub(super) fn limbs(&self, context: &Context<'_>, placed: &Placed) -> [LimbMemory; 4] {
        let Some(memory) = &self.memory else {
            return Extremity::ALL
                .map(|extremity| LimbMemory::at(context.clip_in_world(&placed.root, extremity)));
        };
        let mut limbs = memory.limbs;
        for limb in &mut limbs {
            limb.carry(&self.carry, memory.velocity);
            limb.advance(self.dt);
        }
        self.leave(context, placed, &mut limbs);
        limbs
    }

    /// Takes hands and feet off the holds of another stance.
    fn leave(&self, context: &Context<'_>, placed: &Placed, limbs: &mut [LimbMemory; 4]) {
        let Some(memory) = &self.memory else {
            return;
        };
        let has_changed = memory.stance != self.stance;
        for extremity in Extremity::ALL {
            let keeps = match extremity {
                Extremity::Hand(_) => self.stance.is_held(),
                Extremity::Foot(_) if has_changed => {
                    self.stance.is_held() && memory.stance.is_held()
                }
                Extremity::Foot(_) => self.stance.is_held() || self.stance == Stance::Upright,
            };
            let limb = &mut limbs[extremity.index()];
            let mut clip = context.clip_in_world(&placed.root, extremity);
            if has_changed && !extremity.is_hand() {
                if self.stance == Stance::Upright {
                    clip = context.clip_in_world(&placed.stand, extremity);
                    limb.ground = Spring::default();
                    limb.tilt = Spring::at(self.up);
                }
                limb.keep(&clip);
            }
            if !keeps && !matches!(limb.doing, Doing::Free) {
                limb.let_go(&clip);
            }
        }
    }

    /// Positions of shoulders and hips in the clips' pose, in world space.
    pub(super) fn shoulders(&self, pose: &Pose, root: &Root) -> [DVec3; 4] {
        Extremity::ALL.map(|extremity| {
            let joint = self.figure.limb(extremity).upper;
            let model = joint_in_model(self.figure.skeleton(), pose, joint).unwrap_or_default();
            root.point(model.translation * self.figure.scale())
        })
    }

    /// The goals of hands and feet. For an overlay clip, a hand leaves its hold only when the other hand holds.
    pub(super) fn goals(
        &self,
        context: &Context<'_>,
        target: &Root,
        busy: [bool; 2],
        limbs: &[LimbMemory; 4],
    ) -> [Option<Goal>; 4] {
        let mut goals = goals::goals(context, self.stance, target);
        for hand in 0..2 {
            let other_holds = busy[1 - hand] || limbs[1 - hand].is_planted();
            goals[hand] =
                goals[hand].filter(|_| !busy[hand] || !other_holds && limbs[hand].is_planted());
        }
        goals
    }

    /// Lets hands and feet step: from hold to hold, or with the gait. Returns the memory of climbing.
    pub(super) fn step_limbs(
        &self,
        schedule: &Schedule<'_, '_>,
        stand: &Root,
        walk: &Walk,
        limbs: &mut [LimbMemory; 4],
        plants: &mut Vec<Plant>,
    ) -> Climb {
        let context = schedule.context;
        let mut climb = self.memory.map_or(Climb::default(), |memory| memory.climb);
        if self.stance.is_held() {
            climb.step(schedule, limbs, plants);
            for limb in limbs {
                if let Doing::Swinging(swing) = &limb.doing {
                    let touching = swing.place().point(swing.to.touching);
                    limb.detour.step(context, touching);
                }
            }
        } else if self.stance == Stance::Upright {
            let hips = [schedule.shoulders[2], schedule.shoulders[3]];
            feet::step(context, stand, walk, hips, limbs, plants);
        }
        climb
    }

    /// The legs that swing below the hips.
    pub(super) fn legs(&self, context: &Context<'_>, pose: &Pose, root: &Root) -> Legs {
        let hips = joint_in_model(self.figure.skeleton(), pose, self.figure.humanoid().hips);
        let hips = root.point(hips.unwrap_or_default().translation * self.figure.scale());
        let down = root.rotation * DVec3::NEG_Y;
        let leg = self.figure.leg_length();
        match &self.memory {
            Some(memory) if matches!(memory.stance, Stance::Hang | Stance::Ledge) => {
                let mut legs = memory.legs;
                legs.step(hips, down, self.frame.config.gravity, leg, self.dt);
                legs
            }
            Some(memory) => Legs::at_rest(hips, down, memory.velocity + memory.climber.base, leg),
            None => Legs::at_rest(hips, down, context.state.velocity, leg),
        }
    }

    /// Bends the limbs towards their places. Free limbs follow the clips. Hanging legs are turned about their hips.
    pub(super) fn pose_limbs(
        &self,
        context: &Context<'_>,
        pose: &mut Pose,
        reached: &Reached,
        (legs, shoulders): (&Legs, &[DVec3; 4]),
        limbs: &mut [LimbMemory; 4],
    ) -> Result<(), BodyError> {
        let root = &reached.root;
        let swings = matches!(self.stance, Stance::Hang | Stance::Ledge);
        let swung = swings.then(|| legs.turn(root.rotation * DVec3::NEG_Y));
        for extremity in Extremity::ALL {
            let index = extremity.index();
            let turn = swung
                .filter(|_| !extremity.is_hand())
                .map(|turn| (turn, shoulders[index] + reached.moved));
            let end = reached.ends[index];
            let limb = &mut limbs[index];
            let shown = self.pose_limb(context, (pose, root), extremity, (end, turn), limb)?;
            if context.is_fresh {
                limb.shown = shown;
            } else {
                limb.show(shown, self.dt);
            }
        }
        Ok(())
    }

    /// Bends a limb towards its end, or to its place in the clips' pose, turned about its hip. Returns the reached
    /// place.
    fn pose_limb(
        &self,
        context: &Context<'_>,
        (pose, root): (&mut Pose, &Root),
        extremity: Extremity,
        (end, turn): (Option<Place>, Option<(DQuat, DVec3)>),
        limb: &mut LimbMemory,
    ) -> Result<Place, BodyError> {
        let clip = context.clip_in_world(root, extremity);
        let place = end.unwrap_or_else(|| {
            let swung = turn.map_or(clip, |(turn, hip)| Place {
                position: hip + turn * (clip.position - hip),
                rotation: (turn * clip.rotation).normalize(),
            });
            limb.kept(&swung)
        });
        let far = limb.kept_distance();
        if end.is_none() && turn.is_none() && far < CLIP_DISTANCE {
            limb.pole.forget();
            return Ok(clip);
        }
        let soft = match limb.doing {
            Doing::Planted(_) => 1.0,
            // The softness grows gradually, since a limb may be straight when its step begins.
            Doing::Swinging(swing) => {
                1.0 - SOFT_STRETCH * (2.0 * swing.time / swing.duration).min(1.0)
            }
            Doing::Free => {
                1.0 - SOFT_STRETCH * (far / (FULLY_SOFT_DISTANCE * context.size())).min(1.0)
            }
        };
        let wanted = Wanted { place, soft };
        let shape = self.figure.limb(extremity);
        let pole = (&mut limb.pole, self.dt);
        Ok(solve::limb(self.figure, pose, root, shape, &wanted, pole)?)
    }
}
