//! Schedules the steps of hands and feet while the body holds on: a clock that runs with the climbed distance, and
//! rules that keep enough limbs on their holds.
//!
//! Below [`FAST_CLIMB_SPEED`], one hand or foot moves at a time, so that three hold. Above it, a hand and the opposite
//! foot move together. LEMUR IIb climbs with stances of three and four holds (Bretl 2006). A step is at most 0.65 m
//! long and takes 0.12 to 0.3 s.

use glam::DVec3;

use super::context::Context;
use super::detour;
use super::event::Plant;
use super::goals::Goal;
use super::hold::Hold;
use super::limb::{Doing, LimbMemory};
use super::root::Root;
use crate::Extremity;

/// Speed from which a hand and the opposite foot move together, metres a second.
const FAST_CLIMB_SPEED: f64 = 0.8;

/// Length of a limb's step from hold to hold at low speed, metres. The body climbs this far in one cycle of the clock.
const STEP_LENGTH: f64 = 0.35;

/// Growth of a step's length with the speed, metres per metre a second.
const STEP_LENGTH_PER_SPEED: f64 = 0.2;

/// Bounds of a step's length, metres.
const STEP_LENGTH_BOUNDS: [f64; 2] = [0.3, 0.65];

/// Length of the arms for which [`STEP_LENGTH`] and [`STEP_LENGTH_BOUNDS`] are given, metres. Shorter arms make
/// proportionally shorter steps.
const REFERENCE_ARM_LENGTH: f64 = 0.537;

/// Duration of a step as a share of the limb's cycle: below [`FAST_CLIMB_SPEED`], and from there on.
const STEP_SHARE_OF_CYCLE: [f64; 2] = [0.24, 0.4];

/// Bounds of a step's duration, seconds.
const STEP_TIME_BOUNDS: [f64; 2] = [0.12, 0.30];

/// Duration of a step while the climber is still, seconds.
const STILL_STEP_TIME: f64 = 0.22;

/// Duration of a hand's step to its first hold, or from a hold that is out of reach, seconds.
const HAND_CATCH_TIME: f64 = 0.14;

/// Duration of a foot's step to its first hold, seconds.
const FOOT_CATCH_TIME: f64 = 0.16;

/// Largest acceleration of a hand or foot in a step that the clock does not time, metres a second squared. Long steps
/// take longer for it.
const MAX_LIMB_ACCELERATION: f64 = 50.0;

/// Peak acceleration of a step of 1 m in 1 s, metres a second squared: the path of
/// [`Swing::place`](super::limb::Swing::place), from rest.
const UNIT_STEP_ACCELERATION: f64 = 5.77;

/// Longest duration of an urgent step, seconds; see [`URGENT_STRETCH`].
const URGENT_STEP_TIME: f64 = 0.14;

/// Duration to which a long urgent step may grow for [`MAX_LIMB_ACCELERATION`], seconds.
const LONG_URGENT_STEP_TIME: f64 = 0.2;

/// Speed below which the climber counts as still, metres a second.
const STILL_SPEED: f64 = 0.05;

/// Time for which the climber is still before limbs that are out of place move, seconds.
const STILL_BEFORE_TIDYING: f64 = 0.2;

/// Distance from its goal at which the limb of a still climber is out of place, metres.
const OUT_OF_PLACE_DISTANCE: f64 = 0.14;

/// Stretch up to which a limb takes a hold without a displacement of the body; see [`Schedule::stretch`].
const COMFORTABLE_STRETCH: f64 = 0.93;

/// Stretch above which a limb may move although another one is off its hold, unless both are hands.
const URGENT_STRETCH: f64 = 1.4;

/// Stretch above which a limb has to move on.
const STEP_STRETCH: f64 = 1.12;

/// Stretch above which a limb gives up the hold that it is on its way to.
const GIVE_UP_STRETCH: f64 = 1.4;

/// Stretch beyond [`COMFORTABLE_STRETCH`] up to which a limb takes a hold all the same; the body then moves towards the
/// hold.
const LEANING_STRETCH: f64 = 0.35;

/// Number of tries to find a hold for a step.
const HOLD_TRIES: usize = 8;

/// Number of first tries that stay at the goal or move from it back along the skin, towards the shoulder. Later tries
/// move towards the climber's support.
const TRIES_AT_GOAL: usize = 3;

/// Distance beside the climber's support to which the later tries move, metres.
const BESIDE_SUPPORT: f64 = 0.1;

/// Distance within which a lost hold is replaced by another one without a step, metres.
const SLIP_DISTANCE: f64 = 0.06;

/// Time after the climber took hold in which all limbs may move at once, seconds.
const TAKE_HOLD_TIME: f64 = 0.35;

/// Phases of the clock at which limbs step one at a time, 0 to 1, in the order of [`Extremity::ALL`].
const SINGLE_STEP_PHASES: [f64; 4] = [0.5, 0.0, 0.25, 0.75];

/// Phases of the clock at which limbs step in pairs, 0 to 1, in the order of [`Extremity::ALL`].
const PAIRED_STEP_PHASES: [f64; 4] = [0.5, 0.0, 0.0, 0.5];

/// Memory of climbing: the clock in cycles, and the seconds for which the climber has been still.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Climb {
    clock: f64,
    still: f64,
}

/// The cycle of the limbs' steps at the speed of a frame.
struct Cycle {
    /// Speed of a body of reference size, metres a second.
    speed: f64,
    /// True if a hand and the opposite foot move together.
    is_fast: bool,
    /// True if the climber is still.
    is_still: bool,
    /// Distance that a body of reference size climbs in a cycle, metres.
    length: f64,
    /// The clock before this frame.
    was: f64,
    /// Duration of a step, seconds.
    time: f64,
    /// Direction of the climb.
    way: DVec3,
    /// Vector from a limb's goal to the place where it takes hold.
    ahead: DVec3,
}

/// Input of the schedule in one frame.
pub(crate) struct Schedule<'a, 'c> {
    pub(crate) context: &'a Context<'c>,
    pub(crate) goals: [Option<Goal>; 4],
    /// Positions of shoulders and hips in world space.
    pub(crate) shoulders: [DVec3; 4],
    /// Root of the model, for places of the clips' pose.
    pub(crate) root: &'a Root,
    /// Climbing velocity relative to the support, metres a second.
    pub(crate) motion: DVec3,
    /// The material point that carries the climber, in world space.
    pub(crate) held: DVec3,
    /// Seconds since the climber took hold.
    pub(crate) since: f64,
    /// True if the body hangs by its hands. Stretched limbs do not move on then: the body follows the hands.
    pub(crate) hangs: bool,
}

impl Climb {
    /// Advances all limbs by a frame: holds move with their material, the clock goes on, limbs ask for their step when
    /// it is their turn, and those that may move start it.
    pub(crate) fn step(
        &mut self,
        schedule: &Schedule<'_, '_>,
        limbs: &mut [LimbMemory; 4],
        plants: &mut Vec<Plant>,
    ) {
        for extremity in Extremity::ALL {
            schedule.follow(extremity, &mut limbs[extremity.index()], plants);
        }
        let cycle = self.advance(schedule);
        self.ask(schedule, &cycle, limbs);
        schedule.start_waiting(&cycle, limbs);
    }

    /// Advances the clock by a frame.
    fn advance(&mut self, schedule: &Schedule<'_, '_>) -> Cycle {
        let context = schedule.context;
        let size = context.size();
        // Speed of a body of reference size: speeds grow with the square root of the size.
        let speed = schedule.motion.length() / size.sqrt();
        let is_fast = speed >= FAST_CLIMB_SPEED;
        // Short arms make short steps.
        let arms = (context.figure.arm_length() / (REFERENCE_ARM_LENGTH * size)).min(1.0);
        let length = arms
            * (STEP_LENGTH + STEP_LENGTH_PER_SPEED * speed)
                .clamp(STEP_LENGTH_BOUNDS[0], STEP_LENGTH_BOUNDS[1]);
        let is_still = speed < STILL_SPEED;
        self.still = if is_still {
            self.still + context.dt
        } else {
            0.0
        };
        if is_still {
            // The limbs with phase 0 step as soon as the climber sets off.
            self.clock = -f64::MIN_POSITIVE;
        }
        let was = self.clock;
        if !is_still {
            self.clock += speed * context.dt / (length * size.sqrt());
        }
        let cycle = length / speed.max(STILL_SPEED);
        let time = if is_still {
            STILL_STEP_TIME
        } else {
            let share = STEP_SHARE_OF_CYCLE[usize::from(is_fast)];
            let longest = if is_fast {
                STEP_TIME_BOUNDS[1]
            } else {
                STEP_TIME_BOUNDS[1].min(share * cycle)
            };
            (share * cycle).clamp(STEP_TIME_BOUNDS[0], longest.max(STEP_TIME_BOUNDS[0]))
        } * size.sqrt();
        let way = schedule.motion.normalize_or_zero();
        // When a hand or foot lands, its hold is half of the stance's travel ahead of the goal, so that the stance is
        // centred on the goal.
        let swung = schedule.motion.length() * time;
        Cycle {
            speed,
            is_fast,
            is_still,
            length,
            was,
            time,
            way,
            ahead: way * (swung + 0.5 * (length * size - swung).max(0.0)),
        }
    }

    /// Lets limbs wait for a step if it is their turn, or if they are out of place.
    fn ask(&self, schedule: &Schedule<'_, '_>, cycle: &Cycle, limbs: &mut [LimbMemory; 4]) {
        let size = schedule.context.size();
        let Cycle { length, was, .. } = *cycle;
        let offsets = if cycle.is_fast {
            PAIRED_STEP_PHASES
        } else {
            SINGLE_STEP_PHASES
        };
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
            let behind = away.dot(cycle.way);
            let turn = (self.clock - offsets[index]).floor() > (was - offsets[index]).floor();
            let is_due = turn && behind > 0.85 * length * size;
            let lags = !cycle.is_still && behind > 0.85 * length * size;
            let is_untidy =
                self.still > STILL_BEFORE_TIDYING && away.length() > OUT_OF_PLACE_DISTANCE * size;
            let is_far = !schedule.hangs && schedule.stretch(index, hold) > STEP_STRETCH;
            if is_due && !limb.waits {
                // The limb's turn came within this frame.
                let past = (self.clock - offsets[index]).rem_euclid(1.0);
                limb.late = past * length * size.sqrt() / cycle.speed;
            }
            limb.waits |= is_due || lags || is_untidy || is_far;
        }
    }
}

impl Schedule<'_, '_> {
    /// Starts the steps of waiting limbs that may move, the most stretched limb first.
    fn start_waiting(&self, cycle: &Cycle, limbs: &mut [LimbMemory; 4]) {
        let Cycle { is_fast, time, .. } = *cycle;
        let mut order = [0, 1, 2, 3];
        let stretch = |index: usize| {
            limbs[index]
                .hold()
                .map_or(f64::INFINITY, |hold| self.stretch(index, hold))
        };
        let stretches = [stretch(0), stretch(1), stretch(2), stretch(3)];
        order.sort_by(|a, b| stretches[*b].total_cmp(&stretches[*a]));
        for index in order {
            let enters = self.since < TAKE_HOLD_TIME || self.context.is_fresh;
            let is_urgent = stretches[index] > URGENT_STRETCH && stretches[index].is_finite();
            if limbs[index].waits && (enters || self.may_move(index, is_fast, is_urgent, limbs)) {
                let goal = if enters { DVec3::ZERO } else { cycle.ahead };
                let time = if is_urgent {
                    time.min(URGENT_STEP_TIME)
                } else {
                    time
                };
                let swings = match (enters, Extremity::ALL[index].is_hand()) {
                    (false, _) => time,
                    (true, true) => HAND_CATCH_TIME,
                    (true, false) => FOOT_CATCH_TIME,
                };
                self.start(index, goal, swings, limbs);
            }
        }
    }

    /// Moves a hold with its material. Ends a step that is done. Lets go of lost holds, and of limbs without a goal.
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
                if !is_there || self.stretch(extremity.index(), &to) > GIVE_UP_STRETCH {
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

    /// A hold right beside a lost one, with the same rotation.
    fn beside(&self, lost: &Hold) -> Option<Hold> {
        let context = self.context;
        let found = context
            .around
            .nearest(lost.point(), SLIP_DISTANCE * context.size())?;
        let rotation = lost.rotation();
        Some(Hold::new(
            &found,
            rotation * DVec3::X,
            rotation * DVec3::Y,
            lost.touching,
        ))
    }

    /// Stretch: distance of a hold's wrist or ankle from the shoulder or hip, as a share of the limb's length.
    fn stretch(&self, index: usize, hold: &Hold) -> f64 {
        let length = self.context.shape(Extremity::ALL[index]).length;
        hold.place().position.distance(self.shoulders[index]) / length
    }

    /// True if a limb may leave its hold: all other limbs with a goal hold, or only one does not and both may be off
    /// together. Two hands are never off together, and a hand stays on its hold while the other one has no goal.
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
            // The other hand is busy with an overlay clip.
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

    /// Takes a limb from a hold that is out of reach and starts a step to another one.
    pub(crate) fn replace(&self, index: usize, limbs: &mut [LimbMemory; 4]) {
        let clip = self.context.clip_in_world(self.root, Extremity::ALL[index]);
        limbs[index].let_go(&clip);
        self.start(index, DVec3::ZERO, HAND_CATCH_TIME, limbs);
    }

    /// Starts a step of a limb towards its goal, or to a nearer hold if the goal is too far.
    fn start(&self, index: usize, ahead: DVec3, time: f64, limbs: &mut [LimbMemory; 4]) {
        let (context, extremity) = (self.context, Extremity::ALL[index]);
        let Some(goal) = self.goals[index] else {
            return;
        };
        let mut way = ahead;
        if let Some(hold) = limbs[index].hold() {
            let step = goal.point + way - hold.point();
            way += step.clamp_length_max(STEP_LENGTH_BOUNDS[1] * context.size()) - step;
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
            let soft = (UNIT_STEP_ACCELERATION * way / MAX_LIMB_ACCELERATION).sqrt();
            // The clock times the steps of a moving climber. Other steps take at least the time that
            // `MAX_LIMB_ACCELERATION` asks for.
            let time = if ahead == DVec3::ZERO {
                time.max(soft)
            } else if time <= URGENT_STEP_TIME {
                time.max(soft.min(LONG_URGENT_STEP_TIME * context.size().sqrt()))
            } else {
                time
            };
            let bow = detour::bow(context, &limb.shown, &hold);
            limb.swing_to(hold, time, bow);
        }
    }

    /// A hold near a goal, or near the shoulder or the climber's support where the goal is out of reach or without a
    /// surface.
    fn choose(&self, extremity: Extremity, goal: &Goal, time: f64) -> Option<Hold> {
        let length = self.context.shape(extremity).length;
        let shoulder = self.shoulders[extremity.index()] + self.motion * time;
        let mut goal = *goal;
        let mut best: Option<(f64, Hold)> = None;
        for attempt in 0..HOLD_TRIES {
            if let Some(hold) = goal.find(self.context, extremity) {
                let reach = hold.place().position - shoulder;
                let beyond = reach.length() / length - COMFORTABLE_STRETCH;
                if beyond <= 0.0 {
                    return Some(hold);
                }
                if best.is_none_or(|(other, _)| beyond < other) {
                    best = Some((beyond, hold));
                }
                if attempt + 1 < TRIES_AT_GOAL {
                    // Moves the goal back along the skin by the excess of the stretch.
                    let along = reach - goal.out * reach.dot(goal.out);
                    let back = beyond * length * reach.length() / along.length().max(0.3 * length);
                    goal.point -= along.normalize_or_zero() * back.min(length);
                    continue;
                }
            }
            let to = self.held + goal.aside * (BESIDE_SUPPORT * self.context.size());
            goal.point = goal.point.lerp(to, 0.4);
        }
        if let Some((beyond, hold)) = best
            && beyond < LEANING_STRETCH
        {
            return Some(hold);
        }
        // Takes any surface near the shoulder.
        goal.point = shoulder - goal.out * (0.4 * length);
        let hold = goal.near(self.context, extremity, 1.1 * length)?;
        let beyond = hold.place().position.distance(shoulder) / length - COMFORTABLE_STRETCH;
        (beyond < LEANING_STRETCH).then_some(hold)
    }
}
