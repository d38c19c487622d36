//! The feet of the pose.

use clamber_animation::ik::{TwoBoneGoal, aim};
use clamber_animation::joint_in_model;
use clamber_surface::geometry::{rotation_from_axis_angle, slerp};
use clamber_world::Obstacle;
use glam::{DAffine3, DQuat, DVec3};

use super::Creature;
use super::report::CreatureEvent;
use super::state::Playing;
use crate::feet::{Foot, FootGoal, Ground, MOST_ASIDE, SHARES, Sole};
use crate::kind::{Contacts, Leg, rotation_of};

/// From which share of its length on a leg in flight is stretched softly.
const SOFT: f64 = 0.93;

/// A foot looks at what it stands on in one of so many ticks.
const LOOKS: u64 = 4;

/// From which share of its length on a leg lets go of the ground: before it is straight.
const STRETCHED: f64 = 0.994;

/// The most acceleration with which a foot goes to whom it strikes, metres a second squared.
const BLOW: f64 = 40.0;

/// How much more a foot counts that stands for a whole clip, when a clip's time is chosen.
const STANDING: f64 = 8.0;

/// Times of a clip that are compared with the feet when it begins.
const PHASES: u32 = 48;

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
    /// How flat its foot is, from 0 to 1.
    flat: f64,
    pub(super) wants_step: bool,
    pub(super) is_planted: bool,
}

impl Creature {
    /// Puts the feet of the pose on the ground, and the hips so that they reach it.
    pub(super) fn put_feet(&mut self, ground: &Ground<'_>, dt: f64) {
        let kind = std::sync::Arc::clone(&self.kind);
        let aims = self.aimed_leg();
        let mut legs = Vec::with_capacity(kind.legs().len());
        for (index, leg) in kind.legs().iter().enumerate() {
            let [hip, ankle, ball] = [leg.hip, leg.ankle, leg.ball].map(|joint| {
                joint_in_model(kind.skeleton(), &self.state.pose, joint).unwrap_or_default()
            });
            let others_stand = (self.state.feet.iter().enumerate())
                .all(|(other, foot)| other == index || foot.is_planted());
            let heading = yaw_of(rotation_of(&ankle) * leg.level.conjugate());
            let goal = self.foot_goal(index, leg, (ball.translation, heading), others_stand, aims);
            let foot = &self.state.feet[index];
            let sole = Sole {
                ground,
                shape: &leg.sole,
                turn: rotation_from_axis_angle(DVec3::Y, goal.heading + foot.yaw()),
                scale: self.config.scale,
            };
            let foot = &mut self.state.feet[index];
            if self.state.ticks <= 1 && goal.stands {
                foot.place(&goal, &sole);
            }
            if foot.step(&goal, &sole, dt) {
                let place = goal.clip + foot.offset();
                self.report
                    .events
                    .push(CreatureEvent::Plant { leg: index, place });
            }
            legs.push(self.put(leg, &self.state.feet[index], goal.clip, [hip, ankle]));
        }
        self.shift_hips(&legs, dt);
        for (index, (leg, put)) in kind.legs().iter().zip(&legs).enumerate() {
            let distance = self.bend_leg(leg, put);
            self.state.feet[index].set_stretched(distance > STRETCHED * put.reach);
        }
    }

    /// Where a leg's ankle goes.
    fn put(&self, leg: &Leg, foot: &Foot, clip: DVec3, [hip, ankle]: [DAffine3; 2]) -> PutLeg {
        let world = self.state.world_from_model(self.config.scale);
        let lean = DQuat::from_rotation_arc(DVec3::Y, world.rotation.conjugate() * foot.normal());
        let clip_rotation = rotation_of(&ankle);
        let heading =
            rotation_from_axis_angle(DVec3::Y, yaw_of(clip_rotation * leg.level.conjugate()));
        let turn = lean * rotation_from_axis_angle(DVec3::Y, foot.yaw());
        // The foot keeps its own rotation, whatever the shin does: that of its clip, or flat on the ground.
        let rotation = turn * slerp(clip_rotation, heading * leg.level, foot.flat());
        let ball_at = world.inverse_transform_point(clip + foot.offset());
        PutLeg {
            hip: hip.translation,
            ankle: ball_at + rotation * leg.from_ball,
            reach: leg.length,
            directions: FOOT_AXES.map(|axis| rotation * axis),
            ball: ball_at,
            flat: foot.flat(),
            wants_step: foot.wants_step(),
            is_planted: foot.is_planted(),
        }
    }

    /// Height of a foot's sole above the ground: of its point that is lowest, negative if that is in the ground. `None` if there
    /// is no such leg, or no ground below it.
    pub fn foot_clearance(&self, leg: usize, terrain: &[&dyn Obstacle]) -> Option<f64> {
        let ground = Ground {
            terrain,
            reach: 0.5 * self.kind.height() * self.config.scale,
        };
        let points = &self.kind.legs().get(leg)?.sole.points;
        let places = self.on_sole(leg, points);
        let heights = places.filter_map(|place| Some(place.y - ground.below(place)?.0));
        heights.min_by(f64::total_cmp)
    }

    /// The corners of a rectangle around a foot's sole, in world space, one after the other around it. `None` if there is
    /// no such leg.
    pub fn sole(&self, leg: usize) -> Option<[DVec3; 4]> {
        let [right_heel, left_heel, right_toe, left_toe] = self.kind.legs().get(leg)?.sole.corners;
        let below = DVec3::Y * self.kind.legs().get(leg)?.sole.ball_height;
        let corners = [right_heel, left_heel, left_toe, right_toe].map(|corner| corner - below);
        let mut places = self.on_sole(leg, &corners);
        Some([
            places.next()?,
            places.next()?,
            places.next()?,
            places.next()?,
        ])
    }

    /// Places in world space of points on a foot's sole, which are given relative to its ball.
    fn on_sole<'a>(&'a self, leg: usize, points: &'a [DVec3]) -> impl Iterator<Item = DVec3> + 'a {
        let world = self.surface.world_from_model();
        let frame = self.kind.legs().get(leg).and_then(|leg| {
            let ankle = self.palette.model_from_joint(leg.ankle)?;
            let ball = self.palette.model_from_joint(leg.ball)?;
            Some((rotation_of(ankle) * leg.level.conjugate(), ball.translation))
        });
        points.iter().filter_map(move |point| {
            let (turn, ball) = frame?;
            Some(world.transform_point(ball + turn * *point))
        })
    }

    fn foot_goal(
        &self,
        index: usize,
        leg: &Leg,
        (ball, heading): (DVec3, f64),
        others_stand: bool,
        aims: Option<usize>,
    ) -> FootGoal {
        let scale = self.config.scale;
        let world = self.state.world_from_model(scale);
        let clip = world.transform_point(ball);
        let layer = self.state.animator.layers().first();
        let (time, speed) = layer.map_or((0.0, 0.0), |layer| {
            (layer.time, layer.speed * self.state.animator.rate())
        });
        let contacts = self.contacts(index);
        let is_idle = self.state.playing == Playing::Idle;
        let stands = is_idle || contacts.is_none_or(|contacts| contacts.stands(time));
        let settled = contacts.map_or(clip, |contacts| world.transform_point(contacts.ball(time)));
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
        let is_walk = self.state.playing == Playing::Walk;
        let aside = match landing {
            _ if aims == Some(index) => self.state.aim,
            Some((_, place)) if is_walk => {
                self.state.heading() * (place.z * scale * (self.stride() - 1.0))
            }
            _ => DVec3::ZERO,
        };
        // A blow is meant, and no correction.
        let most_aside = if aims == Some(index) {
            BLOW
        } else {
            MOST_ASIDE
        };
        let ahead = SHARES.map(|share| {
            let Some((contacts, (wait, _))) = contacts.zip(landing) else {
                return clip.y;
            };
            let ball = contacts.ball((time + wait * share).rem_euclid(contacts.duration()));
            world.transform_point(ball).y
        });
        FootGoal {
            clip,
            settled,
            ahead,
            aside,
            most_aside,
            stands,
            lands_in,
            lands_at: lands_at.with_y(self.state.position.y + leg.sole.ball_height * scale),
            heading: self.state.yaw + heading,
            ball_height: leg.sole.ball_height * scale,
            leg: leg.length * scale,
            may_step: others_stand && self.state.hips.has_shifted(),
            looks: (self.state.ticks + index as u64).is_multiple_of(LOOKS),
            is_gait: matches!(self.state.playing, Playing::Walk | Playing::Turn(_)),
            is_lifted: !is_idle && contacts.is_some_and(|contacts| contacts.lifts_after(time)),
        }
    }

    /// The time of the clip that is begun at which its feet are where the creature's are.
    pub(super) fn step_in(&self) -> f64 {
        let legs = self.kind.legs();
        let duration = self.contacts(0).map_or(0.0, Contacts::duration);
        let cost = |time: f64| -> f64 {
            let costs = legs.iter().enumerate().map(|(index, leg)| {
                let at = self.palette.model_from_joint(leg.ball);
                let (Some(contacts), Some(at)) = (self.contacts(index), at) else {
                    return 0.0;
                };
                let way = (contacts.ball(time) - at.translation) / leg.length;
                let is_other = contacts.stands(time) != self.state.feet[index].is_planted();
                // What stands for long has to fit best.
                let left = contacts
                    .left(time)
                    .map_or(0.0, |left| left / duration.max(1e-9));
                way.length_squared() * (1.0 + STANDING * left) + f64::from(u8::from(is_other))
            });
            costs.sum()
        };
        let times = (0..PHASES).map(|phase| f64::from(phase) / f64::from(PHASES) * duration);
        let costs = times.map(|time| (cost(time), time));
        costs
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map_or(0.0, |(_, time)| time)
    }

    fn contacts(&self, leg: usize) -> Option<&Contacts> {
        let gait = self.kind.gait();
        match self.state.playing {
            Playing::Walk => gait?.walk_contacts.get(leg),
            Playing::Turn(side) => gait?.turn_contacts[usize::from(side.min(1))].get(leg),
            Playing::Idle => gait?.idle_contacts.get(leg),
            Playing::Act(state) => self.kind.act(state).contacts.get(leg),
        }
    }

    /// The leg that aims, until it has struck.
    fn aimed_leg(&self) -> Option<usize> {
        let Playing::Act(state) = self.state.playing else {
            return None;
        };
        let strike = self.kind.act(state).strike.as_ref()?;
        let time = self.state.animator.layers().first()?.time;
        strike.leg.filter(|_| time < strike.active[1])
    }

    /// Bends a leg so that its ankle is where the foot wants it. Returns how far that is from the hip.
    fn bend_leg(&mut self, leg: &Leg, put: &PutLeg) -> f64 {
        let skeleton = self.kind.skeleton();
        // A leg in flight is not stretched to its end, so that its knee does not snap.
        let goal = TwoBoneGoal {
            soft: SOFT + (1.0 - SOFT) * put.flat,
            ..TwoBoneGoal::reach(put.ankle)
        };
        let pose = &mut self.state.pose;
        let hip = joint_in_model(skeleton, pose, leg.hip);
        // A leg that cannot be bent stays as its clip has it.
        if leg.ik.solve(skeleton, pose, &goal, None).is_ok() {
            let _ = aim(skeleton, pose, leg.ankle, FOOT_AXES, put.directions);
            if leg.ball != leg.ankle {
                let rest = self.kind.clips().rest().transforms[leg.ball.index()].rotation;
                let toe = &mut pose.transforms[leg.ball.index()].rotation;
                *toe = slerp(toe.as_dquat(), rest.as_dquat(), put.flat).as_quat();
            }
        }
        hip.map_or(0.0, |hip| hip.translation.distance(put.ankle))
    }
}

/// The turn about up of a rotation: its twist about Y.
fn yaw_of(rotation: DQuat) -> f64 {
    2.0 * libm::atan2(rotation.y, rotation.w)
}
