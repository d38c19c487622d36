//! What a graph tells about a creature.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::ControlFlow;

use clamber_surface::rig::WeakPoint;
use glam::DVec3;

use crate::graph::{NONE, Reachable};
use crate::progress::Tell;
use crate::survey::Survey;
use crate::{ClimbGraph, GraphConfig, GraphSource, NavigationError, Progress};

/// What a climber can reach on a creature at rest.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClimbReport {
    /// Area of the skin, square metres.
    pub area: f64,
    /// Area of skin that can be gripped, square metres.
    pub grip_area: f64,
    /// Area on which a climber can stand, square metres.
    pub stand_area: f64,
    /// Area that a climber from the ground can reach, square metres.
    pub reachable_area: f64,
    /// Number of places where it gets on.
    pub entries: usize,
    /// The weak points, in their order in the file.
    pub weak_points: Vec<PointReport>,
}

/// What the report says about a weak point.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PointReport {
    /// Its name.
    pub name: String,
    /// Where it is at rest, in the world.
    pub place: DVec3,
    /// True if a climber can get there.
    pub reachable: bool,
    /// What is missing if it cannot.
    pub missing: Option<Missing>,
}

/// What keeps a climber from a weak point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Missing {
    /// Hands would have to reach so much farther, metres: beside the best way there is nothing to grip.
    Reach(f64),
    /// No longer arms help: there is no room, or nothing to hold on to at all.
    Way,
}

/// A weak point is reached from seats on pieces within its radius and so many radii of the climber.
const NEAR: f64 = 1.0;

impl ClimbReport {
    /// Looks at a creature. `progress` is called again and again, and cancels by [`ControlFlow::Break`].
    ///
    /// # Errors
    /// As [`ClimbGraph::build`].
    pub fn new(
        source: &GraphSource<'_>,
        config: &GraphConfig,
        mut progress: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<(Self, ClimbGraph), NavigationError> {
        let mut tell = Tell(&mut progress);
        let survey = Survey::new(source, config, &mut tell)?;
        let (graph, patch_of) = ClimbGraph::of_survey(&survey, source, &mut tell)?;
        let reached = graph.flood(graph.entries().iter().map(|entry| entry.patch));
        let view = View {
            survey: &survey,
            patch_of: &patch_of,
            reached: &reached,
        };
        let palette = source.skeleton.palette(&source.skeleton.rest_pose())?;
        let mut weak_points = Vec::new();
        for point in source.weak_points {
            let place = palette
                .model_from_joint(point.joint)
                .map_or(DVec3::NAN, |frame| {
                    let in_model = frame.transform_point3(point.position.as_dvec3());
                    source.world_from_model.transform_point(in_model)
                });
            weak_points.push(view.look_at(point, place, source));
        }
        let report = Self {
            area: view.sum(|_| true),
            grip_area: view.sum(|piece| config.can_grip(&survey.pieces[piece].tag)),
            stand_area: view.sum(|piece| survey.can_stand(piece)),
            reachable_area: view.sum(|piece| view.has(piece)),
            entries: graph.entries().len(),
            weak_points,
        };
        Ok((report, graph))
    }
}

/// The pieces of skin, and which of them are reached.
struct View<'a> {
    survey: &'a Survey,
    patch_of: &'a [u32],
    reached: &'a Reachable,
}

impl View<'_> {
    fn has(&self, piece: usize) -> bool {
        let patch = self.patch_of[piece];
        patch != NONE && self.reached.has(patch as usize)
    }

    /// Area of some pieces, square metres.
    fn sum(&self, counts: impl Fn(usize) -> bool) -> f64 {
        let pieces = self.survey.pieces.iter().enumerate();
        let counted = pieces.filter(|(index, _)| counts(*index));
        counted.map(|(_, piece)| piece.area).sum()
    }

    fn look_at(&self, point: &WeakPoint, place: DVec3, source: &GraphSource<'_>) -> PointReport {
        let radius = f64::from(point.radius) * source.world_from_model.scale;
        let within = radius + NEAR * self.survey.config.radius();
        let pieces = &self.survey.pieces;
        let goals: Vec<usize> = (0..pieces.len())
            .filter(|index| {
                let piece = &pieces[*index];
                piece.seat.is_some() && piece.point.distance(place) <= within
            })
            .collect();
        let reachable = goals.iter().any(|piece| self.has(*piece));
        PointReport {
            name: point.name.clone(),
            place,
            reachable,
            missing: (!reachable).then(|| self.missing(&goals)),
        }
    }

    /// How much farther hands would have to reach, to come from what is reached to one of some pieces: the way whose worst
    /// place asks for the shortest arms. It is found as the shortest way is (Dijkstra 1959), with the largest in place of the
    /// sum. A link is measured only when it is its turn: until then it counts as if no place on it asked more than its ends.
    fn missing(&self, goals: &[usize]) -> Missing {
        let survey = self.survey;
        let reach = survey.config.reach();
        let mut settled = vec![false; survey.pieces.len()];
        let mut open = BinaryHeap::new();
        let first = |piece| Turn {
            arm: reach,
            is_measured: true,
            from: piece,
            to: piece,
        };
        open.extend((0..settled.len()).filter(|piece| self.has(*piece)).map(first));
        while let Some(turn) = open.pop() {
            let Turn { arm, from, to, .. } = turn;
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

/// A link whose turn comes when all that ask for shorter arms are done.
#[derive(Clone, Copy, Debug)]
struct Turn {
    /// How far a hand has to reach from what is reached to the link's end, metres.
    arm: f64,
    is_measured: bool,
    from: usize,
    to: usize,
}

impl Turn {
    fn key(&self) -> (u64, bool, usize, usize) {
        // Reaches are not negative: their bits have their order. What is measured comes first.
        (self.arm.to_bits(), !self.is_measured, self.to, self.from)
    }
}

impl Ord for Turn {
    fn cmp(&self, other: &Self) -> Ordering {
        // The heap gives the greatest.
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
