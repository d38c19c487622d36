//! The report on a creature, computed from its graph.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::ControlFlow;

use clamber_surface::mesh::Rig;
use clamber_surface::rig::WeakPoint;
use glam::DVec3;

use crate::clips::{HARDEST, SLICE_SECONDS};
use crate::graph::{NO_PATCH, Reachable};
use crate::plan::{slips, throws};
use crate::progress::Tell;
use crate::survey::Survey;
use crate::{ClimbGraph, Forecast, GraphConfig, NavigationError, Plan, Progress, Start};

/// The parts of a creature that a climber can reach, and how the creature's clips treat climbers.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct ClimbReport {
    /// Area of the skin, square metres.
    pub area: f64,
    /// Area of skin that can be gripped, square metres.
    pub grip_area: f64,
    /// Area on which a climber can stand, square metres.
    pub stand_area: f64,
    /// Area of the skin that a climber reaches from the ground, square metres, with the creature at rest, and for a
    /// climber that does not tire. It gets on from the ground by hand or by a jump. Jumps from one part of the creature
    /// to another, such as from a leg to the tail, count as well.
    pub reachable_area: f64,
    /// The part of `reachable_area` on which the climber can rest, square metres: it can stand there, and the angle of
    /// the slope is at most six tenths of the steepest angle on which it can stand.
    pub rest_area: f64,
    /// The ways from the ground onto the creature: its entries, grouped so that all entries of a group reach the same
    /// skin without jumps between parts of the creature. Sorted by the area of that skin, largest first.
    pub ways_on: Vec<EntryRoute>,
    /// The weak points, in the order of [`Rig::weak_points`].
    pub weak_points: Vec<PointReport>,
    /// The clips, in the order of [`Rig::clips`].
    pub clips: Vec<ClipReport>,
}

/// A group of entries from which the same skin is reached without jumps between parts of the creature.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct EntryRoute {
    /// Number of entries in this group, from all of which the same skin is reached: patches onto which a climber gets
    /// from the ground ([`Entry`](crate::Entry)).
    pub entries: usize,
    /// Where the centre of the climber's ball is on the lowest of these entries ([`Patch::seat`](crate::Patch::seat)),
    /// in world space, metres, with the creature in its rest pose, placed by [`GraphConfig::world_from_model`].
    pub place: DVec3,
    /// Area of the skin that is reached from these entries without jumps between parts of the creature, square metres.
    pub area: f64,
}

/// Whether and how a climber reaches a weak point from the ground, or what it lacks.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct PointReport {
    /// Name of the weak point.
    pub name: String,
    /// Position of the weak point's centre in world space, metres, on the creature in its rest pose, placed by
    /// [`GraphConfig::world_from_model`].
    pub place: DVec3,
    /// True if a climber with full stamina gets there from the ground on the creature at rest. Plates that cover the
    /// point are taken to be gone by then.
    pub reachable: bool,
    /// Seconds from when the climber has got onto the creature until it is at the weak point, rests included, if it
    /// starts on the ground with full stamina and takes the fastest way, with the creature at rest; `None` if
    /// `reachable` is false.
    pub seconds: Option<f64>,
    /// Stamina, 0 to 1, with which a climber arrives at the weak point if it starts on the ground with full stamina and
    /// takes the fastest way, with the creature at rest; `None` if `reachable` is false.
    pub stamina: Option<f64>,
    /// The reason if the point is not reachable; `None` if it is.
    pub missing: Option<Missing>,
}

/// Why a climber does not reach a weak point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Missing {
    /// The climber's hands would have to reach this much farther, metres. The best way leads past skin without a grip.
    Reach(f64),
    /// The climber would have to hold on this much longer without a rest, seconds.
    Strength(f64),
    /// Longer arms do not help: the climber has no room, or no grip at all is near.
    Way,
}

/// How a clip treats climbers on the patches that they can reach.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct ClipReport {
    /// Name of the clip in the creature's file.
    pub name: String,
    /// The hardest shake in the clip on any patch that a climber can reach, metres per second squared: the acceleration
    /// of the skin, low-pass filtered as [`ClimberState::shake`](clamber_climber::ClimberState::shake).
    /// [`ClipReport::HARDEST`] stands for all harder ones.
    pub hardest_shake: f64,
    /// Area on which a standing climber slips because it gets too steep, square metres.
    pub slips_from: f64,
    /// Area on which a standing climber is thrown or knocked down, square metres.
    pub throws_from: f64,
    /// Earliest time at which a standing climber is thrown or knocked down, to half a second: seconds from the clip's
    /// beginning at its rate. `None` if the clip does neither on any reachable skin.
    pub throws_at: Option<f64>,
    /// Area on which a climber loses its hold if it begins with full stamina and holds on for the clip's whole length,
    /// square metres.
    pub exhausts_on: f64,
    /// Earliest time at which a climber loses its hold, to half a second: seconds from the clip's beginning at its
    /// rate. `None` if no climber loses its hold.
    pub exhausts_at: Option<f64>,
}

impl ClipReport {
    /// Shakes of at least this many metres per second squared are not told apart: 63.75.
    pub const HARDEST: f64 = HARDEST;
}

/// A weak point is reached from seats on pieces within its radius plus this many radii of the climber.
const REACHED_DISTANCE: f64 = 1.0;

/// The steepest slope for rests, as a share of the steepest one that can be stood on.
pub(crate) const REST_SLOPE_SHARE: f64 = 0.6;

impl ClimbReport {
    /// Builds the graph of a creature and reports on it. `progress` is called repeatedly, and cancels by
    /// [`ControlFlow::Break`].
    ///
    /// This takes as long as building the graph, which is returned as well. A report is for studios and their CI. A
    /// game needs only the graph, from `ClimbGraph::cached`.
    ///
    /// # Errors
    /// As [`ClimbGraph::build`].
    pub fn new(
        rig: &Rig,
        config: &GraphConfig,
        mut progress: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<(Self, ClimbGraph), NavigationError> {
        let mut tell = Tell(&mut progress);
        let survey = Survey::new(rig, config, &mut tell)?;
        let (graph, patch_of) = ClimbGraph::of_survey(&survey, rig, &mut tell)?;
        let reached = graph.flood(graph.entries().iter().map(|entry| entry.patch));
        let view = View {
            survey: &survey,
            graph: &graph,
            patch_of: &patch_of,
            reached: &reached,
        };
        let palette = rig.skeleton.palette(&rig.skeleton.rest_pose())?;
        let mut weak_points = Vec::new();
        for point in &rig.weak_points {
            let place = palette
                .model_from_joint(point.joint)
                .map_or(DVec3::NAN, |frame| {
                    let in_model = frame.transform_point3(point.position.as_dvec3());
                    config.world_from_model.transform_point(in_model)
                });
            weak_points.push(view.look_at(point, place, config));
        }
        let report = Self {
            area: view.sum(|_| true),
            grip_area: view.sum(|piece| config.can_grip(&survey.pieces[piece].tag)),
            stand_area: view.sum(|piece| survey.can_stand(piece)),
            reachable_area: view.sum(|piece| view.has(piece)),
            rest_area: view.sum(|piece| view.has(piece) && view.can_rest(piece)),
            ways_on: view.ways_on(),
            weak_points,
            clips: view.clips(),
        };
        Ok((report, graph))
    }
}

/// The pieces of skin, and the patches that are reached.
struct View<'a> {
    survey: &'a Survey,
    graph: &'a ClimbGraph,
    patch_of: &'a [u32],
    reached: &'a Reachable,
}

impl View<'_> {
    fn has(&self, piece: usize) -> bool {
        let patch = self.patch_of[piece];
        patch != NO_PATCH && self.reached.has(patch as usize)
    }

    /// Area of the pieces for which `counts` is true, square metres.
    fn sum(&self, counts: impl Fn(usize) -> bool) -> f64 {
        let pieces = self.survey.pieces.iter().enumerate();
        let counted = pieces.filter(|(index, _)| counts(*index));
        // An empty sum of floats is -0.
        0.0 + counted.map(|(_, piece)| piece.area).sum::<f64>()
    }

    fn look_at(&self, point: &WeakPoint, place: DVec3, config: &GraphConfig) -> PointReport {
        let radius = f64::from(point.radius) * config.world_from_model.scale;
        let within = radius + REACHED_DISTANCE * self.survey.config.radius();
        let pieces = &self.survey.pieces;
        let is_near = |index: &usize| {
            let piece = &pieces[*index];
            piece.seat.is_some() && piece.point.distance(place) <= within
        };
        let is_plate = |index: &usize| {
            let triangle = &pieces[*index].triangle;
            config.plates.iter().any(|plate| plate.contains(triangle))
        };
        let near: Vec<usize> = (0..pieces.len()).filter(is_near).collect();
        // A plate that covers the point is no goal. If there is only the plate, the point is on it.
        let bare = near.iter().copied().filter(|index| !is_plate(index));
        let bare: Vec<usize> = bare.collect();
        let goals = if bare.is_empty() { near } else { bare };
        let is_reached = goals.iter().any(|piece| self.has(*piece));
        let plan = is_reached.then(|| self.plan(&goals, 1.0)).flatten();
        let missing = match (&plan, is_reached) {
            (Some(_), _) => None,
            (None, true) => Some(self.missing_strength(&goals)),
            (None, false) => Some(self.missing(&goals)),
        };
        PointReport {
            name: point.name.clone(),
            place,
            reachable: plan.is_some(),
            seconds: plan.as_ref().map(Plan::seconds),
            stamina: plan.as_ref().map(Plan::stamina),
            missing,
        }
    }

    /// The fastest way from the ground to some pieces, for a climber that spends `strain` times as much stamina on
    /// holding on.
    fn plan(&self, goals: &[usize], strain: f64) -> Option<Plan> {
        let patches = goals.iter().map(|piece| self.patch_of[*piece]);
        let patches: Vec<usize> = patches
            .filter(|patch| *patch != NO_PATCH)
            .map(|patch| patch as usize)
            .collect();
        let goal = self.graph.goal_strained(&patches, strain);
        let starts: Vec<Start> = self.graph.starts_on_ground(1.0).collect();
        self.graph.plan(&starts, &goal, &Forecast::still())
    }

    /// How much longer the climber would have to hold on, to a tenth of a second.
    fn missing_strength(&self, goals: &[usize]) -> Missing {
        let stamina = self.survey.config.climber.stamina;
        let lasts = stamina.map_or(0.0, |stamina| 1.0 / stamina.hold_drain);
        let (mut enough, mut short) = (1e-3, 1.0);
        if !lasts.is_finite() || self.plan(goals, enough).is_none() {
            return Missing::Way;
        }
        // The bisection stops after 64 rounds: for a climber that lasts very long, floats cannot get as near as a tenth
        // of a second.
        for _ in 0..64 {
            if lasts / enough - lasts / short <= 0.1 {
                break;
            }
            let strain = 2.0 / (1.0 / enough + 1.0 / short);
            if self.plan(goals, strain).is_some() {
                enough = strain;
            } else {
                short = strain;
            }
        }
        Missing::Strength(lasts / enough - lasts)
    }

    fn can_rest(&self, piece: usize) -> bool {
        let climber = &self.survey.config.climber;
        let cosine = self.survey.pieces[piece].normal.dot(climber.up());
        self.survey.can_stand(piece)
            && cosine >= libm::cos(REST_SLOPE_SHARE * climber.ground.max_slope)
    }

    fn ways_on(&self) -> Vec<EntryRoute> {
        let mut left: Vec<usize> = self
            .graph
            .entries()
            .iter()
            .map(|entry| entry.patch)
            .collect();
        let mut ways = Vec::new();
        let up = self.survey.config.climber.up();
        let area: Vec<f64> = self
            .graph
            .patches()
            .iter()
            .map(|patch| patch.area)
            .collect();
        while let Some(&first) = left.first() {
            let reached = self.graph.region([first]);
            let (same, others): (Vec<usize>, Vec<usize>) =
                left.iter().partition(|patch| reached.has(**patch));
            let places = same.iter().map(|patch| self.graph.patches()[*patch].seat);
            let lowest = places.min_by(|a, b| a.dot(up).total_cmp(&b.dot(up)));
            let counted = area
                .iter()
                .enumerate()
                .filter(|(patch, _)| reached.has(*patch));
            ways.push(EntryRoute {
                entries: same.len(),
                place: lowest.unwrap_or_default(),
                area: counted.map(|(_, area)| area).sum(),
            });
            left = others;
        }
        ways.sort_by(|a, b| b.area.total_cmp(&a.area));
        ways
    }

    fn clips(&self) -> Vec<ClipReport> {
        let facts = &self.graph.clips;
        (0..facts.clips.len()).map(|clip| self.clip(clip)).collect()
    }

    fn clip(&self, clip: usize) -> ClipReport {
        let (facts, climber) = (&self.graph.clips, &self.survey.config.climber);
        let slices = facts.clips[clip].count;
        let mut report = ClipReport {
            name: facts.clips[clip].name.clone(),
            hardest_shake: 0.0,
            slips_from: 0.0,
            throws_from: 0.0,
            throws_at: None,
            exhausts_on: 0.0,
            exhausts_at: None,
        };
        let earlier = |known: &mut Option<f64>, slice: usize| {
            let at = slice as f64 * SLICE_SECONDS;
            *known = Some(known.map_or(at, |known| known.min(at)));
        };
        for (index, patch) in self.graph.patches().iter().enumerate() {
            if !self.reached.has(index) {
                continue;
            }
            let numbers = (0..slices).filter_map(|slice| facts.slice(clip, slice));
            let moments = numbers.map(|slice| facts.at(slice, index));
            let moments: Vec<_> = moments.collect();
            let hardest = moments
                .iter()
                .map(|moment| moment.shake)
                .fold(0.0, f64::max);
            report.hardest_shake = report.hardest_shake.max(hardest).min(HARDEST);
            if patch.can_stand {
                let thrown = moments.iter().position(|moment| throws(climber, moment));
                if let Some(slice) = thrown {
                    report.throws_from += patch.area;
                    earlier(&mut report.throws_at, slice);
                }
                if moments.iter().any(|moment| slips(climber, moment)) {
                    report.slips_from += patch.area;
                }
            }
            let Some(costs) = climber.stamina.filter(|_| patch.can_hold) else {
                continue;
            };
            let mut left = 1.0;
            let ends = moments.iter().position(|moment| {
                left -= SLICE_SECONDS * (costs.hold_drain + costs.shake_drain * moment.excess);
                left <= 0.0
            });
            if let Some(slice) = ends {
                report.exhausts_on += patch.area;
                earlier(&mut report.exhausts_at, slice);
            }
        }
        report
    }

    /// How much farther hands would have to reach to get from the reached pieces to one of the goals. Takes the way
    /// whose worst place needs the shortest arms.
    ///
    /// The search is Dijkstra's (1959), with the largest reach on a way in place of the sum. A link is measured only
    /// when it comes out of the heap. Before that it counts with the reach of its ends, which is a lower bound.
    fn missing(&self, goals: &[usize]) -> Missing {
        let survey = self.survey;
        let reach = survey.config.reach();
        let mut settled = vec![false; survey.pieces.len()];
        let mut open = BinaryHeap::new();
        // Hands may reach nothing where the climber stands.
        let first = |piece: usize| Turn {
            arm: reach.max(survey.arms[piece]),
            is_measured: true,
            from: piece,
            to: piece,
        };
        open.extend(
            (0..settled.len())
                .filter(|piece| self.has(*piece))
                .map(first),
        );
        while let Some(turn) = open.pop() {
            let Turn { arm, from, to, .. } = turn;
            // The remaining links lead past skin without any grip near.
            if !arm.is_finite() {
                break;
            }
            if settled[to] || !survey.can_hold(to, arm) {
                continue;
            }
            if !turn.is_measured {
                let ends = [from.min(to), from.max(to)];
                open.push(Turn {
                    arm: arm.max(survey.arm_between(ends, arm)),
                    is_measured: true,
                    ..turn
                });
                continue;
            }
            if goals.binary_search(&to).is_ok() {
                return Missing::Reach(arm - reach);
            }
            settled[to] = true;
            for beside in survey.links.of(to).filter(|beside| !settled[*beside]) {
                open.push(Turn {
                    arm: arm.max(survey.arms[beside]),
                    is_measured: false,
                    from: to,
                    to: beside,
                });
            }
        }
        Missing::Way
    }
}

/// A link in the heap of the search, ordered by the reach that it needs.
#[derive(Clone, Copy, Debug)]
struct Turn {
    /// The reach that a hand needs from the reached pieces to the link's end, metres.
    arm: f64,
    is_measured: bool,
    from: usize,
    to: usize,
}

impl Turn {
    fn key(&self) -> (u64, bool, usize, usize) {
        // Reaches are not negative, so their bits sort like the floats. Measured links come first.
        (self.arm.to_bits(), !self.is_measured, self.to, self.from)
    }
}

impl Ord for Turn {
    fn cmp(&self, other: &Self) -> Ordering {
        // Reversed, because the heap returns the greatest.
        other.key().cmp(&self.key())
    }
}

impl PartialOrd for Turn {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Turn {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Eq for Turn {}
