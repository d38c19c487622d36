//! When hands and feet move on while the body holds on: a clock that turns with the way, and rules that keep enough of
//! them on their holds.
//!
//! One hand or foot at a time at low speed, so that three hold; a hand and the opposite foot when it is faster. LEMUR
//! IIb climbs with stances of three and four holds (Bretl 2006); each step is at most 0.65 m and takes 0.12 to 0.3 s.

use glam::DVec3;

use super::context::Context;
use super::detour;
use super::event::Plant;
use super::goals::Goal;
use super::hold::Hold;
use super::limb::{Doing, LimbMemory};
use super::root::Root;
use crate::Extremity;

/// Speed from which a hand and a foot move together, metres a second.
const FAST: f64 = 0.8;

/// Length of a step: at rest, more of it per speed, and its bounds, metres.
const STEP: f64 = 0.35;
const STEP_PER_SPEED: f64 = 0.2;
const STEPS: [f64; 2] = [0.3, 0.65];

/// Arms for which that is, metres.
const ARM: f64 = 0.537;

/// Share of the time of a step in which the limb is on its way, one at a time and two together; bounds of that time,
/// seconds.
const SHARE: [f64; 2] = [0.24, 0.4];
const TIMES: [f64; 2] = [0.12, 0.30];

/// Times of a step of somebody who is still, of a hand that catches, and of a foot that follows, seconds.
const STILL: f64 = 0.22;
const CATCH: f64 = 0.14;
const FOLLOW: f64 = 0.16;

/// Largest acceleration of a hand that catches, metres a second squared, and the peak of a step of 1 m in 1 s.
const FORCE: f64 = 50.0;
const PEAK: f64 = 5.77;

/// Times of a step of a limb that is out of reach: a short one, and the most for a long one, seconds.
const HURRIES: f64 = 0.14;
const LATE: f64 = 0.2;

/// Slower than this is still, metres a second; after this time, seconds, limbs that are farther than this from where
/// they belong, metres, are put there.
const SLOW: f64 = 0.05;
const RESTS: f64 = 0.2;
const TIDY: f64 = 0.14;

/// The most of a limb's length with which it takes a hold.
const TAKES: f64 = 0.93;

/// A limb that is stretched more than this may move although another one does.
const URGENT: f64 = 1.4;

/// A limb that is stretched more than this has to move on.
const FAR: f64 = 1.12;

/// A limb on its way to something that is farther than this looks for another place.
const LOST: f64 = 1.4;

/// The body leans towards a place that is farther by up to this share of the limb's length.
const LEANS: f64 = 0.35;

/// How often a place is looked for, and how often of these nearer to the shoulder; and how far beside what carries the
/// climber the last ones are, metres.
const TRIES: usize = 8;
const SHIFTS: usize = 3;
const BESIDE: f64 = 0.1;

/// How far from a lost hold another one is taken without a step, metres.
const SLIPS: f64 = 0.06;

/// For how long after it took hold everything may move at once, seconds.
const ENTERS: f64 = 0.35;

/// When limbs step, as shares of the clock: one at a time, and in pairs. Left hand, right hand, left foot, right foot.
const ALONE: [f64; 4] = [0.5, 0.0, 0.25, 0.75];
const PAIRS: [f64; 4] = [0.5, 0.0, 0.0, 0.5];

/// Memory of climbing.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Climb {
    clock: f64,
    still: f64,
}

/// What is asked of the schedule in one frame.
pub(crate) struct Schedule<'a, 'c> {
    pub(crate) context: &'a Context<'c>,
    pub(crate) goals: [Option<Goal>; 4],
    /// Where shoulders and hips are.
    pub(crate) shoulders: [DVec3; 4],
    /// Where the clip has hands and feet.
    pub(crate) root: &'a Root,
    /// How fast it climbs, relative to what it holds.
    pub(crate) motion: DVec3,
    /// The material point that carries the climber.
    pub(crate) held: DVec3,
    /// Seconds since it took hold.
    pub(crate) since: f64,
    /// It hangs by its hands: the body follows them, as far as they reach.
    pub(crate) hangs: bool,
}

impl Climb {
    pub(crate) fn step(
        &mut self,
        schedule: &Schedule<'_, '_>,
        limbs: &mut [LimbMemory; 4],
        plants: &mut Vec<Plant>,
    ) {
        let context = schedule.context;
        for extremity in Extremity::ALL {
            schedule.follow(extremity, &mut limbs[extremity.index()], plants);
        }
        let size = context.size();
        // Along what is held; a body of another size moves faster by the root of its size.
        let speed = schedule.motion.length() / size.sqrt();
        let is_fast = speed >= FAST;
        // Short arms make short steps.
        let arms = (context.figure.arm_length() / (ARM * size)).min(1.0);
        let length = arms * (STEP + STEP_PER_SPEED * speed).clamp(STEPS[0], STEPS[1]);
        let is_still = speed < SLOW;
        self.still = if is_still {
            self.still + context.dt
        } else {
            0.0
        };
        if is_still {
            // The first limb steps when the body sets off.
            self.clock = -f64::MIN_POSITIVE;
        }
        let was = self.clock;
        if !is_still {
            self.clock += speed * context.dt / (length * size.sqrt());
        }
        let offsets = if is_fast { PAIRS } else { ALONE };
        let cycle = length / speed.max(SLOW);
        let time = if is_still {
            STILL
        } else {
            let share = SHARE[usize::from(is_fast)];
            let longest = if is_fast {
                TIMES[1]
            } else {
                TIMES[1].min(share * cycle)
            };
            (share * cycle).clamp(TIMES[0], longest.max(TIMES[0]))
        } * size.sqrt();
        let way = schedule.motion.normalize_or_zero();
        // At its landing, a hold is half of the way of its stance ahead of where it belongs then.
        let swung = schedule.motion.length() * time;
        let ahead = way * (swung + 0.5 * (length * size - swung).max(0.0));
        for (index, limb) in limbs.iter_mut().enumerate() {
            let Some(goal) = schedule.goals[index] else {
                limb.waits = false;
                continue;
            };
            let Some(hold) = limb.hold() else {
                limb.waits = !limb.is_swinging();
                continue;
            };
            let away = goal.point - hold.point();
            let behind = away.dot(way);
            let turn = (self.clock - offsets[index]).floor() > (was - offsets[index]).floor();
            let is_due = turn && behind > 0.85 * length * size;
            let lags = !is_still && behind > 0.85 * length * size;
            let is_untidy = self.still > RESTS && away.length() > TIDY * size;
            let is_far = !schedule.hangs && schedule.stretch(index, hold) > FAR;
            if is_due && !limb.waits {
                // Its turn came within this frame.
                let past = (self.clock - offsets[index]).rem_euclid(1.0);
                limb.late = past * length * size.sqrt() / speed;
            }
            limb.waits |= is_due || lags || is_untidy || is_far;
        }
        let mut order = [0, 1, 2, 3];
        let stretch = |index: usize| {
            limbs[index]
                .hold()
                .map_or(f64::INFINITY, |hold| schedule.stretch(index, hold))
        };
        let stretches = [stretch(0), stretch(1), stretch(2), stretch(3)];
        order.sort_by(|a, b| stretches[*b].total_cmp(&stretches[*a]));
        for index in order {
            let enters = schedule.since < ENTERS || context.is_fresh;
            let is_urgent = stretches[index] > URGENT && stretches[index].is_finite();
            if limbs[index].waits && (enters || schedule.may_move(index, is_fast, is_urgent, limbs))
            {
                let goal = if enters { DVec3::ZERO } else { ahead };
                let time = if is_urgent { time.min(HURRIES) } else { time };
                let swings = match (enters, Extremity::ALL[index].is_hand()) {
                    (false, _) => time,
                    (true, true) => CATCH,
                    (true, false) => FOLLOW,
                };
                schedule.start(index, goal, swings, limbs);
            }
        }
    }
}

impl Schedule<'_, '_> {
    /// Moves on with the skin; ends steps; lets go of what is gone, or of what is no goal.
    fn follow(&self, extremity: Extremity, limb: &mut LimbMemory, plants: &mut Vec<Plant>) {
        let context = self.context;
        let clip = context.clip_in_world(self.root, extremity);
        if self.goals[extremity.index()].is_none() {
            if !matches!(limb.doing, Doing::Free) {
                limb.let_go(&clip);
            }
            return;
        }
        match &mut limb.doing {
            Doing::Free => {}
            Doing::Planted(hold) => {
                if hold.follow(&context.around) {
                    return;
                }
                let lost = *hold;
                match self.beside(&lost) {
                    Some(next) => {
                        limb.keep(&next.place());
                        limb.doing = Doing::Planted(next);
                    }
                    None => limb.let_go(&clip),
                }
            }
            Doing::Swinging(swing) => {
                let is_there = swing.to.follow(&context.around);
                let to = swing.to;
                if !is_there || self.stretch(extremity.index(), &to) > LOST {
                    limb.let_go(&clip);
                } else if swing.time >= swing.duration {
                    let hold = swing.to;
                    limb.doing = Doing::Planted(hold);
                    limb.settle();
                    context.tell(plants, extremity, &hold, limb.pace);
                }
            }
        }
    }

    /// What is held instead where skin is gone, right beside it.
    fn beside(&self, lost: &Hold) -> Option<Hold> {
        let context = self.context;
        let found = context
            .around
            .nearest(lost.point(), SLIPS * context.size())?;
        let rotation = lost.rotation();
        Some(Hold::new(
            &found,
            rotation * DVec3::X,
            rotation * DVec3::Y,
            lost.touching,
        ))
    }

    /// Distance of a hold's wrist or ankle from the shoulder or hip, as a share of the limb.
    fn stretch(&self, index: usize, hold: &Hold) -> f64 {
        let length = self.context.shape(Extremity::ALL[index]).length;
        hold.place().position.distance(self.shoulders[index]) / length
    }

    /// True if enough of the others hold: never both hands off, and never fewer than two.
    fn may_move(
        &self,
        index: usize,
        is_fast: bool,
        is_urgent: bool,
        limbs: &[LimbMemory; 4],
    ) -> bool {
        if !limbs[index].is_planted() {
            return true;
        }
        let is_hand = Extremity::ALL[index].is_hand();
        if is_hand && self.goals[1 - index].is_none() {
            // The other hand does something else.
            return false;
        }
        let mut off = (0..4).filter(|&other| {
            other != index && self.goals[other].is_some() && !limbs[other].is_planted()
        });
        // A hand goes with the opposite foot.
        let partner = [3, 2, 1, 0][index];
        match (off.next(), off.next()) {
            (None, _) => true,
            (Some(other), None) if is_urgent => !(is_hand && Extremity::ALL[other].is_hand()),
            (Some(other), None) => is_fast && other == partner,
            _ => false,
        }
    }

    /// Takes a limb from a hold that is out of reach, to another one.
    pub(crate) fn replace(&self, index: usize, limbs: &mut [LimbMemory; 4]) {
        let clip = self.context.clip_in_world(self.root, Extremity::ALL[index]);
        limbs[index].let_go(&clip);
        self.start(index, DVec3::ZERO, CATCH, limbs);
    }

    /// Begins a step of a limb towards its goal, or nearer if that is too far.
    fn start(&self, index: usize, ahead: DVec3, time: f64, limbs: &mut [LimbMemory; 4]) {
        let (context, extremity) = (self.context, Extremity::ALL[index]);
        let Some(goal) = self.goals[index] else {
            return;
        };
        let mut way = ahead;
        if let Some(hold) = limbs[index].hold() {
            let step = goal.point + way - hold.point();
            way += step.clamp_length_max(STEPS[1] * context.size()) - step;
        }
        let found = self.choose(extremity, &goal.moved(way), time);
        let limb = &mut limbs[index];
        let Some(hold) = found else {
            return;
        };
        if context.is_fresh {
            limb.doing = Doing::Planted(hold);
            limb.settle();
            limb.waits = false;
        } else {
            let way = hold.place().position.distance(limb.shown.position);
            let soft = (PEAK * way / FORCE).sqrt();
            // A step of somebody who climbs is timed; all others take the time that they need.
            let time = if ahead == DVec3::ZERO {
                time.max(soft)
            } else if time <= HURRIES {
                time.max(soft.min(LATE * context.size().sqrt()))
            } else {
                time
            };
            let bow = detour::bow(context, &limb.shown, &hold);
            limb.swing_to(hold, time, bow);
        }
    }

    /// A place to hold near a goal: nearer to the shoulder if that is too far, and nearer to what carries the climber
    /// if there is nothing to hold.
    fn choose(&self, extremity: Extremity, goal: &Goal, time: f64) -> Option<Hold> {
        let length = self.context.shape(extremity).length;
        let shoulder = self.shoulders[extremity.index()] + self.motion * time;
        let mut goal = *goal;
        let mut best: Option<(f64, Hold)> = None;
        for attempt in 0..TRIES {
            if let Some(hold) = goal.find(self.context, extremity) {
                let reach = hold.place().position - shoulder;
                let beyond = reach.length() / length - TAKES;
                if beyond <= 0.0 {
                    return Some(hold);
                }
                if best.is_none_or(|(other, _)| beyond < other) {
                    best = Some((beyond, hold));
                }
                if attempt + 1 < SHIFTS {
                    // Back along the skin, by what is too far.
                    let along = reach - goal.out * reach.dot(goal.out);
                    let back = beyond * length * reach.length() / along.length().max(0.3 * length);
                    goal.point -= along.normalize_or_zero() * back.min(length);
                    continue;
                }
            }
            let to = self.held + goal.aside * (BESIDE * self.context.size());
            goal.point = goal.point.lerp(to, 0.4);
        }
        if let Some((beyond, hold)) = best
            && beyond < LEANS
        {
            return Some(hold);
        }
        // Whatever is near.
        goal.point = shoulder - goal.out * (0.4 * length);
        let hold = goal.near(self.context, extremity, 1.1 * length)?;
        let beyond = hold.place().position.distance(shoulder) / length - TAKES;
        (beyond < LEANS).then_some(hold)
    }
}
