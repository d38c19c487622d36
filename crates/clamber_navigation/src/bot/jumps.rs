//! The jumps of a plan: when the bot takes off, and its input in flight.

use clamber_climber::ClimberInput;
use glam::DVec3;

use super::View;
use crate::ClimbGraph;
use crate::graph::{Aim, Leap};

/// State of a bot's jumps.
#[derive(Clone, Debug, Default)]
pub(super) struct Jumps {
    /// The jump that the bot is in.
    flight: Option<Flight>,
    /// The jump that the bot is about to make.
    ready: Option<Ready>,
}

#[derive(Clone, Copy, Debug)]
struct Flight {
    ends: [usize; 2],
    aim: Aim,
    /// When the jump began, seconds.
    since: f64,
    /// Until when the jump may land, seconds.
    until: f64,
}

/// A jump at whose beginning the bot stands.
#[derive(Clone, Copy, Debug)]
struct Ready {
    ends: [usize; 2],
    /// When both ends began to keep together, seconds.
    since: f64,
    /// The vector from one end to the other at that time.
    way: DVec3,
    /// The vector from one end to the other at the last look.
    last: DVec3,
}

/// The decision at the beginning of a jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TakeOff {
    /// The bot jumps now.
    Now(Aim),
    /// The bot rests: its stamina is not enough.
    Tired,
    /// The creature moves so that the jump would miss now, but it would land later.
    Later,
    /// Unknown whether the jump would land.
    Unsure,
}

impl Jumps {
    /// The decision if the bot stands where its next jump begins; `None` if it does not stand there.
    pub(super) fn take_off(
        &mut self,
        graph: &ClimbGraph,
        view: &View<'_>,
        ends: [usize; 2],
    ) -> Option<TakeOff> {
        let before = self.ready.take().filter(|ready| ready.ends == ends);
        let (number, leap) = graph.leaps.between(ends[0], ends[1])?;
        let [from, to] =
            [ends[0], leap.aimed as usize].map(|patch| view.spot(&graph.patches()[patch]).seat);
        let (state, climber) = (view.climber.state(), view.climber.config());
        let (up, radius) = (climber.up(), climber.body.radius);
        let off = from - state.position;
        let height = off.dot(up);
        let is_there = (off - up * height).length() <= TAKE_OFF_DISTANCE * radius
            && height.abs() <= TAKE_OFF_HEIGHT * radius;
        if !is_there {
            return None;
        }
        let way = to - from;
        let ready = before
            .filter(|ready| (ready.way - way).length() <= MOST_CHANGE_IN_JUMP * radius)
            .unwrap_or(Ready {
                ends,
                since: view.seconds,
                way,
                last: DVec3::NAN,
            });
        self.ready = Some(Ready { last: way, ..ready });
        // A bot that cannot rest jumps with any stamina.
        let rests = climber.stamina.is_some_and(|stamina| stamina.refill > 0.0);
        if rests && state.stamina <= leap.costs() {
            return Some(TakeOff::Tired);
        }
        let Some(aim) = Aim::at(climber, from, to) else {
            return Some(TakeOff::Unsure);
        };
        let is_sure = if view.forecast.is_still() {
            // Without a forecast, the present motion of both ends decides.
            let keeps_still = (ready.last - way).length() <= MOST_CHANGE_BETWEEN_LOOKS * radius;
            keeps_still || view.seconds - ready.since >= leap.seconds()
        } else {
            view.forecast.lands(graph, number, 0.0)
        };
        Some(if is_sure {
            TakeOff::Now(aim)
        } else if !view.forecast.is_still() && view.forecast.ever_lands(graph, number) {
            TakeOff::Later
        } else {
            TakeOff::Unsure
        })
    }

    /// Begins a jump, and returns the input of its first tick.
    pub(super) fn begin(
        &mut self,
        graph: &ClimbGraph,
        view: &View<'_>,
        ends: [usize; 2],
        aim: Aim,
    ) -> ClimberInput {
        let leap = graph.leaps.between(ends[0], ends[1]);
        let lasts = leap.map_or(0.0, |(_, leap)| leap.seconds());
        self.flight = Some(Flight {
            ends,
            aim,
            since: view.seconds,
            until: view.seconds + LATE_LANDING_FACTOR * lasts.max(aim.seconds),
        });
        aim.input(view.climber.config(), 0.0)
    }

    /// True from the take-off until the bot has landed or missed.
    pub(super) fn flies(&self) -> bool {
        self.flight.is_some()
    }

    /// The input in flight; `None` once it is too late to land.
    pub(super) fn input(&self, view: &View<'_>) -> Option<ClimberInput> {
        let flight = self.flight?;
        let input = || {
            flight
                .aim
                .input(view.climber.config(), view.seconds - flight.since)
        };
        (view.seconds <= flight.until).then(input)
    }

    /// The place to which the bot jumps.
    pub(super) fn goes_to(&self, graph: &ClimbGraph, view: &View<'_>) -> Option<DVec3> {
        let patch = graph.patches().get(self.flight?.ends[1])?;
        Some(view.spot(patch).seat)
    }

    /// Ends the jump, because the bot is on the creature again, or on the ground. Returns the jump's patches if the bot
    /// has missed its end.
    pub(super) fn ends(&mut self, graph: &ClimbGraph, view: &View<'_>) -> Option<[usize; 2]> {
        let to = self.goes_to(graph, view)?;
        let climber = view.climber;
        let apart = to.distance(climber.state().position);
        let ends = self.flight.take()?.ends;
        (!view.is_on_creature() || apart > MISS_DISTANCE * climber.config().body.radius)
            .then_some(ends)
    }

    /// For each jump, whether a plan may use it. With a forecast of clips, the jump has to land in one of them. Without
    /// one, the jump's ends have to keep together at the velocities that they had in the last `dt` seconds.
    pub(super) fn may_land(graph: &ClimbGraph, view: &View<'_>, dt: f64) -> Vec<bool> {
        let radius = view.climber.config().body.radius;
        let velocity = |patch: u32| view.velocity(&graph.patches()[patch as usize], dt);
        let may_land = |(number, leap): (usize, &Leap)| {
            if !view.forecast.is_still() {
                return view.forecast.ever_lands(graph, number);
            }
            // After a pause no velocities are known, and the take-off decides.
            if !(dt > 0.0 && dt < LONGEST_LOOK_GAP) {
                return true;
            }
            let [Some(from), Some(to)] = [leap.from, leap.aimed].map(velocity) else {
                return false;
            };
            (to - from).length() * leap.seconds() <= MOST_PARTING_IN_PLAN * radius
        };
        graph.leaps.iter().enumerate().map(may_land).collect()
    }
}

/// The bot jumps within this many radii of the place where a jump begins, seen from above.
const TAKE_OFF_DISTANCE: f64 = 0.25;
/// The bot jumps within this many radii of the height at which a jump begins.
const TAKE_OFF_HEIGHT: f64 = 0.5;

/// The ends of a jump keep together if their distance vector changes by no more than this many radii in the time of the
/// jump. If they keep their acceleration, also through a turning point, they come apart by at most nine times as much
/// in the jump. Proof: a motion of constant acceleration `a` that stays within `d` for a time `T` has `a T² <= 8 d`,
/// and in the next `T` it moves by `a T²` at most.
const MOST_CHANGE_IN_JUMP: f64 = 0.1;

/// The ends of a jump keep still if their distance vector changes by no more than this many radii between two looks.
const MOST_CHANGE_BETWEEN_LOOKS: f64 = 1e-6;

/// A plan uses a jump if its ends come apart by no more than this many radii during it, at their present velocities.
const MOST_PARTING_IN_PLAN: f64 = 0.5;

/// The latest time at which a jump may land, as a multiple of its expected time.
const LATE_LANDING_FACTOR: f64 = 1.3;

/// A bot that comes down farther than this many radii from the place to which it jumped has missed.
const MISS_DISTANCE: f64 = 4.0;

/// The longest time between two looks from which velocities are taken, seconds.
const LONGEST_LOOK_GAP: f64 = 0.1;
