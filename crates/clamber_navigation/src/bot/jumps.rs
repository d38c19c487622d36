//! The jumps of a plan: when they begin, and how they go.

use clamber_climber::ClimberInput;
use glam::DVec3;

use super::View;
use crate::ClimbGraph;
use crate::graph::{Aim, Leap};

/// Memory of a bot that jumps.
#[derive(Clone, Debug, Default)]
pub(super) struct Jumps {
    /// The jump that it is in.
    flight: Option<Flight>,
    /// The one that it is about to make.
    ready: Option<Ready>,
}

#[derive(Clone, Copy, Debug)]
struct Flight {
    ends: [usize; 2],
    aim: Aim,
    /// When it began, and until when it may land, seconds.
    since: f64,
    until: f64,
}

/// It stands where a jump begins.
#[derive(Clone, Copy, Debug)]
struct Ready {
    ends: [usize; 2],
    /// Since when both ends have kept together, seconds, and the way from one to the other then, and when it looked last.
    since: f64,
    way: DVec3,
    last: DVec3,
}

/// What to do where a jump begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TakeOff {
    /// It jumps now.
    Now(Aim),
    /// It rests: its strength is not enough.
    Tired,
    /// The creature moves so that it would not land, but will not do so for ever.
    Later,
    /// It cannot be told whether it would land.
    Unsure,
}

impl Jumps {
    /// What to do now if it stands where its next jump begins; `None` if it does not.
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
        let is_there =
            (off - up * height).length() <= ASIDE * radius && height.abs() <= HIGHER * radius;
        if !is_there {
            return None;
        }
        let way = to - from;
        let ready = before
            .filter(|ready| (ready.way - way).length() <= TOGETHER * radius)
            .unwrap_or(Ready {
                ends,
                since: view.seconds,
                way,
                last: DVec3::NAN,
            });
        self.ready = Some(Ready { last: way, ..ready });
        // Who cannot rest goes as far as its strength does.
        let rests = climber.stamina.is_some_and(|stamina| stamina.refill > 0.0);
        if rests && state.stamina <= leap.costs() {
            return Some(TakeOff::Tired);
        }
        let Some(aim) = Aim::at(climber, from, to) else {
            return Some(TakeOff::Unsure);
        };
        let is_sure = if view.forecast.is_still() {
            // Nothing is known of what the creature is about to do.
            let keeps_still = (ready.last - way).length() <= STILL * radius;
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

    /// It jumps: the input of this tick.
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
            until: view.seconds + LATE * lasts.max(aim.seconds),
        });
        aim.input(view.climber.config(), 0.0)
    }

    /// True from a jump until it has landed or missed.
    pub(super) fn flies(&self) -> bool {
        self.flight.is_some()
    }

    /// The input on its way through the air, as long as it may still land.
    pub(super) fn input(&self, view: &View<'_>) -> Option<ClimberInput> {
        let flight = self.flight?;
        let input = || {
            flight
                .aim
                .input(view.climber.config(), view.seconds - flight.since)
        };
        (view.seconds <= flight.until).then(input)
    }

    /// Where it jumps to.
    pub(super) fn goes_to(&self, graph: &ClimbGraph, view: &View<'_>) -> Option<DVec3> {
        let patch = graph.patches().get(self.flight?.ends[1])?;
        Some(view.spot(patch).seat)
    }

    /// It is on the creature again, or on the ground: the way on which it missed its end, if it did.
    pub(super) fn ends(&mut self, graph: &ClimbGraph, view: &View<'_>) -> Option<[usize; 2]> {
        let to = self.goes_to(graph, view)?;
        let climber = view.climber;
        let apart = to.distance(climber.state().position);
        let ends = self.flight.take()?.ends;
        (!view.is_on_creature() || apart > MISSES * climber.config().body.radius).then_some(ends)
    }

    /// Of each jump, whether a plan may lead over it. If clips are expected, it has to land in one of them. Otherwise its
    /// ends have to keep together, at the velocities that they had in the last `dt` seconds.
    pub(super) fn may_land(graph: &ClimbGraph, view: &View<'_>, dt: f64) -> Vec<bool> {
        let radius = view.climber.config().body.radius;
        let velocity = |patch: u32| view.velocity(&graph.patches()[patch as usize], dt);
        let may_land = |(number, leap): (usize, &Leap)| {
            if !view.forecast.is_still() {
                return view.forecast.ever_lands(graph, number);
            }
            // After a pause no velocities are known. Then the take-off decides.
            if !(dt > 0.0 && dt < LOOKS) {
                return true;
            }
            let [Some(from), Some(to)] = [leap.from, leap.aimed].map(velocity) else {
                return false;
            };
            (to - from).length() * leap.seconds() <= PARTS * radius
        };
        graph.leaps.iter().enumerate().map(may_land).collect()
    }
}

/// It jumps within so many radii of where a jump begins, seen from above, and within so many in height.
const ASIDE: f64 = 0.25;
const HIGHER: f64 = 0.5;

/// The ends of a jump keep together if they come apart by no more than so many radii in as much time as it takes. If
/// they go on as they do, at a turning point as well, they come apart by at most nine times as much in the jump: of an
/// acceleration `a` that is within `d` for a time `T`, `a T² <= 8 d`, and in the next `T` it moves by `a T²` at most.
const TOGETHER: f64 = 0.1;

/// Whose ends move by no more than so many radii from look to look keep still.
const STILL: f64 = 1e-6;

/// A plan leads over a jump if its ends come apart by no more than so many radii in it, at the velocities that they have.
const PARTS: f64 = 0.5;

/// It may land so many times as late as it is expected to.
const LATE: f64 = 1.3;

/// Who comes down farther than so many radii from where it jumped to has missed it.
const MISSES: f64 = 4.0;

/// Velocities are known from looks that are no farther apart, seconds.
const LOOKS: f64 = 0.1;
