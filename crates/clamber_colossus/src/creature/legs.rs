//! The feet of the pose.

use clamber_animation::ik::{TwoBoneGoal, aim};
use clamber_animation::joint_in_model;
use clamber_surface::geometry::rotation_from_axis_angle;
use glam::{DAffine3, DQuat, DVec3};

use super::Creature;
use super::report::CreatureEvent;
use super::state::Playing;
use crate::feet::{Foot, FootGoal, Ground, Sole};
use crate::kind::{Contacts, Leg};

/// The axes of an ankle that keep their directions.
const FOOT_AXES: [DVec3; 2] = [DVec3::Y, DVec3::Z];

/// Where a leg is put in a tick, in model space.
#[derive(Clone, Copy, Debug)]
pub(super) struct PutLeg {
    /// As its clip has it.
    pub(super) hip: DVec3,
    /// Where it goes, together with the ball of the foot.
    pub(super) ankle: DVec3,
    pub(super) ball: DVec3,
    /// Length of thigh and shin together.
    pub(super) reach: f64,
    directions: [DVec3; 2],
    pub(super) wants_step: bool,
    pub(super) is_planted: bool,
}

impl Creature {
    /// Puts the feet of the pose on the ground, and the hips so that they reach it.
    pub(super) fn put_feet(&mut self, ground: &Ground<'_>, dt: f64) {
        let kind = std::sync::Arc::clone(&self.kind);
        let aims = self.aimed_leg();
        let mut legs = std::mem::take(&mut self.legs);
        legs.clear();
        for (index, leg) in kind.legs().iter().enumerate() {
            let [hip, ankle, ball] = [leg.hip, leg.ankle, leg.ball].map(|joint| {
                joint_in_model(kind.skeleton(), &self.state.pose, joint).unwrap_or_default()
            });
            let others_stand = (self.state.feet.iter().enumerate())
                .all(|(other, foot)| other == index || foot.is_planted());
            let goal = self.foot_goal(index, leg, ball.translation, others_stand, aims);
            let corners = leg.sole.map(|corner| {
                self.state
                    .world_from_model(self.config.scale)
                    .transform_vector(corner)
            });
            let foot = &mut self.state.feet[index];
            if foot.step(&goal, &Sole { ground, corners }, dt) {
                let place = goal.clip + foot.offset();
                self.report
                    .events
                    .push(CreatureEvent::Plant { leg: index, place });
            }
            legs.push(self.put(leg, &self.state.feet[index], goal.clip, [hip, ankle, ball]));
        }
        self.shift_hips(&legs, dt);
        for (leg, put) in kind.legs().iter().zip(&legs) {
            self.bend_leg(leg, put);
        }
        self.legs = legs;
    }

    /// Where a leg's ankle goes.
    fn put(
        &self,
        leg: &Leg,
        foot: &Foot,
        clip: DVec3,
        [hip, ankle, ball]: [DAffine3; 3],
    ) -> PutLeg {
        let world = self.state.world_from_model(self.config.scale);
        let lean = DQuat::from_rotation_arc(DVec3::Y, world.rotation.conjugate() * foot.normal());
        let turn = lean * rotation_from_axis_angle(DVec3::Y, foot.yaw());
        let ball_at = world.inverse_transform_point(clip + foot.offset());
        // The foot keeps its own rotation, whatever the shin does.
        let directions = FOOT_AXES.map(|axis| turn * (ankle.matrix3 * axis));
        PutLeg {
            hip: hip.translation,
            ankle: ball_at + turn * (ankle.translation - ball.translation),
            reach: leg.length,
            directions,
            ball: ball_at,
            wants_step: foot.wants_step(),
            is_planted: foot.is_planted(),
        }
    }

    fn foot_goal(
        &self,
        index: usize,
        leg: &Leg,
        ball: DVec3,
        others_stand: bool,
        aims: Option<(usize, f64)>,
    ) -> FootGoal {
        let scale = self.config.scale;
        let world = self.state.world_from_model(scale);
        let mut clip = world.transform_point(ball);
        if let Some((aimed, share)) = aims
            && aimed == index
        {
            clip += self.state.aim * share;
        }
        let layer = self.state.animator.layers().first();
        let (time, speed) = layer.map_or((0.0, 0.0), |layer| {
            (layer.time, layer.speed * self.state.animator.rate())
        });
        let contacts = self.contacts(index);
        let stands = contacts.is_none_or(|contacts| contacts.stands(time));
        let landing = contacts
            .and_then(|contacts| contacts.next(time))
            .filter(|_| speed > 0.0);
        let lands_in = landing
            .map_or(1.0, |(wait, _)| wait / speed.max(1e-3))
            .min(4.0);
        // Where the creature will be then.
        let ahead = self.state.heading() * (self.state.speed * lands_in);
        let at = landing.map_or(clip, |(_, place)| world.transform_point(place));
        let lands_at = if stands { clip } else { at + ahead };
        FootGoal {
            clip,
            stands,
            lands_in,
            lands_at: lands_at.with_y(self.state.position.y + leg.ball_height * scale),
            turned: self.state.yaw_rate * self.kind.brain().tick(),
            ball_height: leg.ball_height * scale,
            leg: leg.length * scale,
            may_step: others_stand && self.state.hips.has_shifted(),
            is_gait: matches!(self.state.playing, Playing::Walk | Playing::Turn(_)),
        }
    }

    fn contacts(&self, leg: usize) -> Option<&Contacts> {
        let gait = self.kind.gait();
        match self.state.playing {
            Playing::Walk => gait?.walk_contacts.get(leg),
            Playing::Turn(side) => gait?.turn_contacts[usize::from(side.min(1))].get(leg),
            Playing::Idle => None,
            Playing::Act(state) => self.kind.act(state).contacts.get(leg),
        }
    }

    /// The leg that aims, and by how much of its aim it already does.
    fn aimed_leg(&self) -> Option<(usize, f64)> {
        let Playing::Act(state) = self.state.playing else {
            return None;
        };
        let strike = self.kind.act(state).strike.as_ref()?;
        let leg = strike.leg?;
        let time = self.state.animator.layers().first()?.time;
        let clip = self.kind.clips().clip(self.kind.act(state).clip?).ok()?;
        let smooth = |s: f64| {
            let s = s.clamp(0.0, 1.0);
            s * s * (3.0 - 2.0 * s)
        };
        // There when it begins to fall, and back at the clip's end.
        let rise = smooth(time / strike.active[0].max(1e-3));
        let left = (clip.duration() - strike.active[1]).max(1e-3);
        let fall = smooth((time - strike.active[1]) / left);
        Some((leg, rise * (1.0 - fall)))
    }

    /// Bends a leg so that its ankle is where the foot wants it.
    fn bend_leg(&mut self, leg: &Leg, put: &PutLeg) {
        let skeleton = self.kind.skeleton();
        let goal = TwoBoneGoal::reach(put.ankle);
        let pose = &mut self.state.pose;
        // A leg that cannot be bent stays as its clip has it.
        if leg.ik.solve(skeleton, pose, &goal, None).is_ok() {
            let _ = aim(skeleton, pose, leg.ankle, FOOT_AXES, put.directions);
        }
    }
}
