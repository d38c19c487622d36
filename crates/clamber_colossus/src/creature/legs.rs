//! Feet and head of the pose.

use clamber_animation::ik::{TwoBoneGoal, aim};
use clamber_animation::joint_in_model;
use clamber_surface::geometry::rotation_from_axis_angle;
use glam::{DAffine3, DQuat, DVec3};

use super::report::CreatureEvent;
use super::state::Playing;
use super::{Creature, Surroundings};
use crate::brain::Gaze;
use crate::feet::{Foot, FootGoal, Ground};
use crate::kind::{Contacts, Leg};

/// The most that a foot leans on the ground, as a tangent: 30 degrees.
const MOST_LEAN: f64 = 0.577;

/// Half time of a gaze that goes to something else, and of its beginning and end, seconds, for a creature of human size.
const LOOKS: f64 = 0.25;

/// How long a glance lasts, seconds.
const GLANCE: f64 = 3.5;

impl Creature {
    /// Puts the feet of the pose on the ground.
    pub(super) fn put_feet(&mut self, ground: &Ground<'_>, dt: f64) {
        let kind = std::sync::Arc::clone(&self.kind);
        let aims = self.aimed_leg();
        for (index, leg) in kind.legs().iter().enumerate() {
            let frames = [leg.ankle, leg.ball]
                .map(|joint| joint_in_model(kind.skeleton(), &self.state.pose, joint));
            let [Some(ankle), Some(ball)] = frames else {
                continue;
            };
            let others_stand = (self.state.feet.iter().enumerate())
                .all(|(other, foot)| other == index || foot.is_planted());
            let goal = self.foot_goal(index, leg, ball.translation, others_stand, aims);
            let corners = leg.sole.map(|corner| {
                self.state
                    .world_from_model(self.config.scale)
                    .transform_vector(corner)
            });
            let foot = &mut self.state.feet[index];
            let under = |place: DVec3| ground.under_foot(place, &corners, MOST_LEAN);
            if foot.step(&goal, under, dt) {
                let place = goal.clip + foot.offset();
                self.report
                    .events
                    .push(CreatureEvent::Plant { leg: index, place });
            }
            let foot = *foot;
            self.bend_leg(leg, &foot, [ankle, ball]);
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
        let wait = contacts
            .and_then(|contacts| contacts.until(time))
            .filter(|_| speed > 0.0);
        let lands_in = wait.map_or(1.0, |wait| wait / speed.max(1e-3)).min(4.0);
        // Where the creature will be then; the clip's own motion until then is left out, since only its height counts.
        let ahead = self.state.heading() * (self.state.speed * lands_in);
        let is_gait = matches!(self.state.playing, Playing::Walk | Playing::Turn(_));
        FootGoal {
            clip,
            stands,
            lands_in,
            lands_at: clip
                + ahead * f64::from(u8::from(!stands))
                + DVec3::Y * (self.state.position.y + leg.ball_height * scale - clip.y),
            turned: self.state.yaw_rate * self.kind.brain().tick(),
            ball_height: leg.ball_height * scale,
            leg: leg.length * scale,
            may_step: others_stand && !is_gait,
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

    /// Bends a leg so that its ball is where the foot is.
    fn bend_leg(&mut self, leg: &Leg, foot: &Foot, [ankle, ball]: [DAffine3; 2]) {
        let world = self.state.world_from_model(self.config.scale);
        let lean = DQuat::from_rotation_arc(DVec3::Y, world.rotation.conjugate() * foot.normal());
        let turn = lean * rotation_from_axis_angle(DVec3::Y, foot.yaw());
        let ball_at = ball.translation + world.inverse_transform_vector(foot.offset());
        let target = ball_at + turn * (ankle.translation - ball.translation);
        let skeleton = self.kind.skeleton();
        if leg
            .ik
            .solve(
                skeleton,
                &mut self.state.pose,
                &TwoBoneGoal::reach(target),
                None,
            )
            .is_err()
        {
            return;
        }
        // The foot keeps its own rotation, whatever the shin does.
        let axes = [DVec3::Y, DVec3::Z];
        let directions = axes.map(|axis| turn * (ankle.matrix3 * axis));
        let _ = aim(skeleton, &mut self.state.pose, leg.ankle, axes, directions);
    }

    /// Turns the head to what the creature looks at.
    pub(super) fn turn_head(&mut self, around: &Surroundings<'_>, dt: f64) {
        let kind = std::sync::Arc::clone(&self.kind);
        let Some((look, _)) = kind.look() else { return };
        let size = (kind.height() * self.config.scale / 1.75).max(0.1).sqrt();
        let target = self.target(around);
        let weight = f64::from(u8::from(target.is_some()));
        self.state.gaze_weight.step(weight, LOOKS * size, dt);
        if let Some(target) = target {
            if self.state.gaze_weight.value < 0.02 {
                self.state.gaze = clamber_animation::Spring::at(target);
            }
            self.state.gaze.step(target, LOOKS * size, dt);
        }
        let world = self.state.world_from_model(self.config.scale);
        let target = world.inverse_transform_point(self.state.gaze.value);
        let weight = self.state.gaze_weight.value.clamp(0.0, 1.0);
        if weight > 1e-3 {
            // A target in its head moves nothing.
            let _ = look.solve(
                kind.skeleton(),
                &mut self.state.pose,
                target,
                weight,
                &mut self.state.look,
                dt,
            );
        }
    }

    fn target(&self, around: &Surroundings<'_>) -> Option<DVec3> {
        match self.kind.brain().gaze(self.state.current()) {
            Gaze::Clip => None,
            Gaze::Prey => self.state.prey.map(|(_, place)| place),
            Gaze::Rider => {
                let ride = self.state.rides.iter().max_by_key(|ride| ride.ticks)?;
                let rider = around
                    .people
                    .iter()
                    .find(|person| person.id == ride.person)?;
                Some(rider.middle())
            }
            Gaze::Around => {
                let height = self.kind.height() * self.config.scale;
                let glance = (self.state.ticks as f64 * self.kind.brain().tick()
                    / (GLANCE * self.config.scale.sqrt())) as u64;
                let mut lot = fastrand::Rng::with_seed(
                    self.config.seed ^ glance.wrapping_mul(0x9e37_79b9_7f4a_7c15),
                );
                let angle = self.state.yaw + (lot.f64() - 0.5) * 2.0;
                let down = lot.f64() * 0.5;
                let way = DVec3::new(libm::sin(angle), -down, libm::cos(angle));
                Some(self.eye() + way * (2.0 * height))
            }
        }
    }
}
