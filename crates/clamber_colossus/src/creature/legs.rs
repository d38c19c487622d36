//! Puts the feet of the pose on the ground.

use clamber_animation::ik::orient;
use clamber_animation::joints_in_model;
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle, slerp};
use clamber_world::Obstacle;
use glam::{DQuat, DVec3};

use super::Creature;
use super::clips::Playing;
use super::report::CreatureEvent;
use crate::feet::{
    Foot, FootGoal, Ground, MOST_ASIDE_ACCELERATION, MOST_UP_ACCELERATION, SWING_SHARES, Sole,
};
use crate::kind::{Contacts, Leg, rotation_of};

/// A leg in flight stretches softly beyond this share of its length.
const SOFT_STRETCH: f64 = 0.93;

/// Interval between a foot's checks of the ground, in ticks.
const GROUND_CHECK_INTERVAL: u64 = 8;

/// A leg lets go of the ground beyond this share of its length, before it is straight.
const RELEASE_STRETCH: f64 = 0.994;

/// Ground higher than this above a foot is a wall, as a share of the leg's length. Feet do not step on walls.
const WALL_HEIGHT: f64 = 0.25;

/// Largest acceleration of a foot towards the target that it strikes, and of a vertical correction while the clip of an
/// act plays, metres a second squared.
const STRIKE_ACCELERATION: f64 = 40.0;

/// Additional weight of a foot in the choice of a clip's start time, if the foot stands for the whole clip. It is
/// proportional to the time for which the foot still stands.
const STANDING_FOOT_WEIGHT: f64 = 8.0;

/// Start times whose costs differ by at most this fit equally well.
const EQUAL_COST_MARGIN: f64 = 1e-4;

/// Number of start times that are compared when a clip begins.
const START_TIMES: u32 = 48;

/// A leg as its clip poses it.
struct ClipLeg {
    /// Total length of the bones, in the model's units.
    reach: f64,
    /// The hip joint, in model space.
    hip: DVec3,
    /// The ball of the foot, in world space.
    ball: DVec3,
    /// Rotation of the ankle, in model space.
    rotation: DQuat,
    /// Yaw of the foot as a rotation, in model space.
    turn: DQuat,
    /// Yaw of the foot, radians.
    heading: f64,
}

/// A leg whose foot is put on the ground in this tick, in model space.
#[derive(Clone, Copy, Debug)]
pub(super) struct PutLeg {
    /// The hip joint in the clip.
    pub(super) hip: DVec3,
    /// Target of the ankle.
    pub(super) ankle: DVec3,
    /// Target of the ball of the foot.
    pub(super) ball: DVec3,
    /// Total length of the bones.
    pub(super) reach: f64,
    /// Rotation of the ankle.
    rotation: DQuat,
    /// How flat the foot is on the ground, from 0 to 1.
    pub(super) flat: f64,
    /// Normal of the ground, in world space.
    pub(super) normal: DVec3,
    /// How firmly the foot stands, from 0 to 1.
    firm: f64,
    pub(super) wants_step: bool,
    pub(super) is_planted: bool,
}

/// Heights of a swinging foot in its clip at [`SWING_SHARES`] of the time until it lands, in world space. `time` is the
/// clip's, and the foot lands in `wait` seconds of it.
fn heights_ahead(
    world: &Similarity,
    contacts: &Contacts,
    [time, wait]: [f64; 2],
) -> [f64; SWING_SHARES.len()] {
    SWING_SHARES.map(|share| {
        let time = (time + wait * share).rem_euclid(contacts.duration());
        world.transform_point(contacts.ball(time)).y
    })
}

impl Creature {
    /// Puts the feet of the pose on the ground, and moves the hips so that the legs reach them.
    pub(super) fn put_feet(&mut self, world: &Similarity, ground: &Ground<'_>, dt: f64) {
        let kind = std::sync::Arc::clone(&self.kind);
        let aims = self.aimed_leg();
        let mut legs = std::mem::take(&mut self.legs);
        legs.clear();
        for (index, leg) in kind.legs().iter().enumerate() {
            let joints = [leg.hip, leg.ankle, leg.ball];
            let frames = joints_in_model(kind.skeleton(), &self.state.pose, joints);
            let [hip, ankle, ball] = frames.unwrap_or_default();
            leg.limb.make_rigid(kind.skeleton(), &mut self.state.pose);
            let joints = [leg.limb.knee, leg.limb.end.0];
            let frames = joints_in_model(kind.skeleton(), &self.state.pose, joints);
            let [knee, end] = frames.unwrap_or_default();
            let end = end.transform_point3(leg.limb.end.1);
            let reach = leg.limb.length([hip.translation, knee.translation, end]);
            let rotation = rotation_of(&ankle);
            let turn = turn_about_up(rotation * leg.level.conjugate());
            let clip = ClipLeg {
                reach,
                hip: hip.translation,
                ball: world.transform_point(leg.ball_in(&ball)),
                rotation,
                turn,
                heading: 2.0 * libm::atan2(turn.y, turn.w),
            };
            let others = self.state.feet.iter().enumerate();
            let lifted = others.filter(|(other, foot)| *other != index && !foot.is_planted());
            let others_stand = lifted.count() < at_once(kind.legs().len());
            let goal = self.foot_goal(world, index, &clip, others_stand, aims);
            let foot = &self.state.feet[index];
            let sole = Sole {
                ground,
                shape: &leg.sole,
                turn: rotation_from_axis_angle(DVec3::Y, goal.heading + foot.yaw()),
                scale: world.scale,
                wall: WALL_HEIGHT * leg.length * world.scale,
            };
            let foot = &mut self.state.feet[index];
            if self.state.clock.is_first() && goal.stands {
                foot.place(&goal, &sole);
            }
            if foot.step(&goal, &sole, dt) {
                let place = goal.clip + foot.offset();
                self.report
                    .events
                    .push(CreatureEvent::Plant { leg: index, place });
            }
            legs.push(put(world, leg, &self.state.feet[index], &clip));
        }
        let moved = self.shift_hips(world, &legs, dt);
        for (index, (leg, put)) in kind.legs().iter().zip(&legs).enumerate() {
            self.bend_leg(leg, put);
            self.press_foot(world, leg, put);
            // All legs move with the hips.
            let distance = (put.hip + moved).distance(put.ankle);
            let is_stretched = distance > RELEASE_STRETCH * put.reach;
            self.state.feet[index].set_stretched(is_stretched);
        }
        self.legs = legs;
    }

    /// Smallest height of a foot's sole above the ground below it, metres; negative if the sole is in the ground.
    /// Ground more than a quarter of the leg's length above a point of the sole is a wall, and does not count. `None`
    /// if there is no such leg, or no ground below it.
    pub fn foot_clearance(&self, leg: usize, terrain: &[&dyn Obstacle]) -> Option<f64> {
        let ground = Ground {
            terrain,
            reach: 0.5 * self.size.height,
        };
        let shape = self.kind.legs().get(leg)?;
        let wall = WALL_HEIGHT * shape.length * self.size.scale;
        let above = |place: DVec3| {
            let height = place.y - ground.below(place)?.0;
            (height > -wall).then_some(height)
        };
        let blended = &shape.sole.blended;
        if blended.is_empty() {
            let places = self.on_sole(leg, &shape.sole.points);
            return places.filter_map(above).min_by(f64::total_cmp);
        }
        let mut places = Vec::new();
        blended.skin(self.kind.skeleton(), &self.state.pose, &mut places);
        let world = self.surface.world_from_model();
        let places = places.iter().map(|place| world.transform_point(*place));
        places.filter_map(above).min_by(f64::total_cmp)
    }

    /// The corners of a rectangle around a foot's sole, in world space, in order around it. `None` if there is no such
    /// leg.
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

    /// Converts points on a foot's sole, which are relative to its ball, to world space.
    fn on_sole<'a>(&'a self, leg: usize, points: &'a [DVec3]) -> impl Iterator<Item = DVec3> + 'a {
        let world = self.surface.world_from_model();
        let frame = self.kind.legs().get(leg).and_then(|leg| {
            let ankle = self.palette.model_from_joint(leg.ankle)?;
            let ball = self.palette.model_from_joint(leg.ball)?;
            Some((
                rotation_of(ankle) * leg.level.conjugate(),
                leg.ball_in(ball),
            ))
        });
        points.iter().filter_map(move |point| {
            let (turn, ball) = frame?;
            Some(world.transform_point(ball + turn * *point))
        })
    }

    /// The goal of a foot in this tick. `others_stand` is true if enough other feet stand, `aims` is the leg that
    /// strikes.
    fn foot_goal(
        &self,
        world: &Similarity,
        index: usize,
        &ClipLeg {
            ball: clip,
            heading,
            ..
        }: &ClipLeg,
        others_stand: bool,
        aims: Option<usize>,
    ) -> FootGoal {
        let leg = &self.kind.legs()[index];
        let scale = world.scale;
        let (time, speed) = self.state.clips.time_and_speed();
        let contacts = self.contacts(index);
        let is_idle = self.state.clips.playing() == Playing::Idle;
        let stands = is_idle || contacts.is_none_or(|contacts| contacts.stands(time));
        let stands_for = match contacts {
            Some(contacts) if !is_idle => contacts.stands_for(time) / speed.max(1e-3),
            _ => f64::INFINITY,
        };
        let settled = contacts.map_or(clip, |contacts| world.transform_point(contacts.ball(time)));
        let landing = contacts
            .filter(|_| speed > 0.0 && !stands)
            .and_then(|contacts| contacts.next(time));
        let lands_in = landing
            .map_or(1.0, |(wait, _)| wait / speed.max(1e-3))
            .min(4.0);
        let forward = self.state.heading();
        let at = landing.map_or(clip, |(_, place)| world.transform_point(place));
        let lands_at = if stands {
            clip
        } else {
            // The creature moves on until the foot lands.
            at + forward * (self.state.speed() * lands_in)
        };
        let is_aimed = aims == Some(index);
        let aside = if is_aimed {
            self.state.striking.aim()
        } else {
            self.stride_offset(landing.map(|(_, place)| place), scale)
        };
        let past = (!stands).then(|| self.past_others(index, forward));
        let aside = past.map_or(aside, |past| aside + past);
        let swing = contacts.zip(landing.map(|(wait, _)| wait));
        let ahead = swing.map_or([clip.y; SWING_SHARES.len()], |(contacts, wait)| {
            heights_ahead(world, contacts, [time, wait])
        });
        FootGoal {
            clip,
            settled,
            ahead,
            aside,
            // A blow is intended: the limit for corrections does not apply.
            most_aside: if is_aimed {
                STRIKE_ACCELERATION
            } else {
                MOST_ASIDE_ACCELERATION
            },
            // The clip of a strike or a fall may lift a standing foot faster than `MOST_UP_ACCELERATION` allows.
            most_up: if matches!(self.state.clips.playing(), Playing::Act(_)) {
                STRIKE_ACCELERATION
            } else {
                MOST_UP_ACCELERATION
            },
            stands,
            stands_for,
            lands_in,
            lands_at: lands_at.with_y(self.state.position().y + leg.sole.ball_height * scale),
            heading: self.state.yaw() + heading,
            ball_height: leg.sole.ball_height * scale,
            leg: leg.length * scale,
            may_step: others_stand && self.state.hips.has_shifted(),
            looks: (self.state.ticks() + index as u64).is_multiple_of(GROUND_CHECK_INTERVAL),
            is_gait: matches!(self.state.clips.playing(), Playing::Walk | Playing::Turn(_)),
            is_lifted: !is_idle && contacts.is_some_and(|contacts| contacts.lifts_after(time)),
        }
    }

    /// Offset of a foot's landing place in the model from the one in the clip, in world space, because the steps of a
    /// walk are shorter on slopes.
    fn stride_offset(&self, landing: Option<DVec3>, scale: f64) -> DVec3 {
        match landing {
            Some(place) if self.state.clips.playing() == Playing::Walk => {
                self.state.heading() * (place.z * scale * (self.stride() - 1.0))
            }
            _ => DVec3::ZERO,
        }
    }

    /// Sideways offset with which a leg passes the standing feet beside it: the largest offset by which one of them has
    /// come nearer to the leg than in its clip.
    fn past_others(&self, index: usize, forward: DVec3) -> DVec3 {
        let leg = &self.kind.legs()[index];
        let left = DVec3::new(forward.z, 0.0, -forward.x);
        let others = self.kind.legs().iter().zip(&self.state.feet);
        let nearer = others.filter_map(|(other, foot)| {
            let way = leg.stands_at - other.stands_at;
            let is_beside = way.x.abs() > way.z.abs();
            let near = foot.offset().dot(left) * way.x.signum();
            (is_beside && foot.is_planted() && near > 0.0).then_some(near * way.x.signum())
        });
        let most = nearer.max_by(|a, b| a.abs().total_cmp(&b.abs()));
        left * most.unwrap_or(0.0)
    }

    /// Start time of a new clip, seconds: the time at which the clip's feet best fit the creature's feet.
    pub(super) fn step_in(&self) -> f64 {
        let legs = self.kind.legs();
        let duration = self.contacts(0).map_or(0.0, Contacts::duration);
        let cost = |time: f64| -> f64 {
            let costs = legs.iter().enumerate().map(|(index, leg)| {
                let at = self.palette.model_from_joint(leg.ball);
                let (Some(contacts), Some(at)) = (self.contacts(index), at) else {
                    return 0.0;
                };
                let way = (contacts.ball(time) - leg.ball_in(at)) / leg.length;
                let is_other = contacts.stands(time) != self.state.feet[index].is_planted();
                // A foot that stands for long has to fit best.
                let left = contacts
                    .left(time)
                    .map_or(0.0, |left| left / duration.max(1e-9));
                way.length_squared() * (1.0 + STANDING_FOOT_WEIGHT * left)
                    + f64::from(u8::from(is_other))
            });
            costs.sum()
        };
        let times =
            (0..START_TIMES).map(|phase| f64::from(phase) / f64::from(START_TIMES) * duration);
        let costs: Vec<(f64, f64)> = times.map(|time| (cost(time), time)).collect();
        let least = costs
            .iter()
            .map(|(cost, _)| *cost)
            .fold(f64::INFINITY, f64::min);
        // The first of the times that fit equally well: rounding, which depends on the unit of a file, must not decide.
        let mut best = costs
            .iter()
            .filter(|(cost, _)| *cost <= least + EQUAL_COST_MARGIN);
        best.next().map_or(0.0, |(_, time)| *time)
    }

    fn contacts(&self, leg: usize) -> Option<&Contacts> {
        let gait = self.kind.gait();
        match self.state.clips.playing() {
            Playing::Walk => gait?.walk_contacts.get(leg),
            Playing::Turn(side) => gait?.turn_contacts[usize::from(side.min(1))].get(leg),
            Playing::Idle => gait?.idle_contacts.get(leg),
            Playing::Act(state) => self.kind.act(state).contacts.get(leg),
        }
    }

    /// The leg that aims, until its strike is over.
    fn aimed_leg(&self) -> Option<usize> {
        let Playing::Act(state) = self.state.clips.playing() else {
            return None;
        };
        let strike = self.kind.act(state).strike.as_ref()?;
        let time = self.state.animator().layers().first()?.time;
        strike.leg.filter(|_| time < strike.active[1])
    }

    /// Bends a leg so that its ankle reaches its target, and turns its foot.
    pub(super) fn bend_leg(&mut self, leg: &Leg, put: &PutLeg) {
        let skeleton = self.kind.skeleton();
        // A leg in flight does not stretch fully, so that its knee does not snap.
        let soft = SOFT_STRETCH + (1.0 - SOFT_STRETCH) * put.firm;
        let pose = &mut self.state.pose;
        // A leg that cannot be bent keeps the pose of its clip.
        if leg.limb.bend(skeleton, pose, put.ankle, soft) {
            let _ = orient(skeleton, pose, leg.ankle, put.rotation);
            if leg.ball != leg.ankle && put.flat > 0.0 {
                let rest = self.kind.clips().rest().transforms[leg.ball.index()].rotation;
                let toe = &mut pose.transforms[leg.ball.index()].rotation;
                *toe = slerp(toe.as_dquat(), rest.as_dquat(), put.flat).as_quat();
            }
        }
    }
}

/// How many of `legs` legs may be in the air at once: half of them, but at least one.
pub(super) fn at_once(legs: usize) -> usize {
    (legs / 2).max(1)
}

/// Places the foot of a leg.
fn put(world: &Similarity, leg: &Leg, foot: &Foot, clip: &ClipLeg) -> PutLeg {
    let normal = world.rotation.conjugate() * foot.normal();
    // The foot's rotation does not depend on the shin: the foot is turned as in its clip, or flat on the ground.
    let flat = foot.flat();
    let flattened = if flat > 0.0 {
        slerp(clip.rotation, clip.turn * leg.level, flat)
    } else {
        clip.rotation
    };
    let lean = DQuat::from_rotation_arc(DVec3::Y, normal);
    let rotation = lean * rotation_from_axis_angle(DVec3::Y, foot.yaw()) * flattened;
    let ball = world.inverse_transform_point(clip.ball + foot.offset());
    PutLeg {
        hip: clip.hip,
        ankle: ball + rotation * leg.from_ball,
        reach: clip.reach,
        rotation,
        ball,
        flat,
        normal: foot.normal(),
        firm: foot.firm(),
        wants_step: foot.wants_step(),
        is_planted: foot.is_planted(),
    }
}

/// Yaw of a rotation as a rotation: its twist about Y. The identity for a half turn about a horizontal axis, which has
/// no yaw.
fn turn_about_up(rotation: DQuat) -> DQuat {
    let length = (rotation.y * rotation.y + rotation.w * rotation.w).sqrt();
    if length > 1e-9 {
        DQuat::from_xyzw(0.0, rotation.y / length, 0.0, rotation.w / length)
    } else {
        DQuat::IDENTITY
    }
}
