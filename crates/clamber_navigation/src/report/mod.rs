//! What a graph tells about a creature.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

use clamber_surface::rig::WeakPoint;
use glam::DVec3;

use crate::graph::Reached;
use crate::{ClimbGraph, GraphSource, NavigationError};

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

/// A weak point is reached from seats on patches within its radius and so many radii of the climber.
const NEAR: f64 = 1.0;

impl ClimbGraph {
    /// What can be reached at rest from the ground.
    ///
    /// # Errors
    /// [`NavigationError`] if the skeleton cannot be posed.
    pub fn report(&self, source: &GraphSource<'_>) -> Result<ClimbReport, NavigationError> {
        let reach = self.config.reach();
        let from = self.entries.iter().map(|entry| entry.patch);
        let reached = self.flood(from, reach);
        let sum = |counts: &dyn Fn(usize) -> bool| {
            let all = self.patches.iter().enumerate();
            all.filter(|(index, _)| counts(*index))
                .map(|(_, patch)| patch.area)
                .sum()
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
            weak_points.push(self.look_at(point, place, source, &reached));
        }
        Ok(ClimbReport {
            area: sum(&|_| true),
            grip_area: sum(&|index| (self.config.can_grip)(&self.patches[index].tag)),
            stand_area: sum(&|index| self.patches[index].seat.is_some() && self.can_stand(index)),
            reachable_area: sum(&|index| reached.has(index)),
            entries: self.entries.len(),
            weak_points,
        })
    }

    fn look_at(
        &self,
        point: &WeakPoint,
        place: DVec3,
        source: &GraphSource<'_>,
        reached: &impl Reached,
    ) -> PointReport {
        let radius = f64::from(point.radius) * source.world_from_model.scale;
        let within = radius + NEAR * self.config.radius();
        let goals: Vec<usize> = (0..self.patches.len())
            .filter(|index| {
                let patch = &self.patches[*index];
                patch.seat.is_some() && patch.point.distance(place) <= within
            })
            .collect();
        let reachable = goals.iter().any(|patch| reached.has(*patch));
        PointReport {
            name: point.name.clone(),
            place,
            reachable,
            missing: (!reachable).then(|| self.missing(&goals, reached)),
        }
    }

    /// How much farther hands would have to reach, to come from what is reached to one of some patches.
    fn missing(&self, goals: &[usize], reached: &impl Reached) -> Missing {
        // The arms of ways that were measured. The others count as if no place between their ends asked more than the ends.
        let mut measured = BTreeMap::new();
        loop {
            let Some((way, worst)) = self.easiest(goals, reached, &measured) else {
                return Missing::Way;
            };
            let mut is_exact = true;
            for ends in way.windows(2) {
                let ends = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                if let Entry::Vacant(new) = measured.entry(ends) {
                    let arm = *new.insert(self.arm_between(ends, worst));
                    is_exact &= arm <= worst;
                }
            }
            if is_exact {
                return Missing::Reach((worst - self.config.reach()).max(0.0));
            }
        }
    }

    /// The way from what is reached to one of some patches whose worst place asks for the shortest arms, and those arms: as the
    /// shortest way (Dijkstra 1959), with the largest in place of the sum.
    fn easiest(
        &self,
        goals: &[usize],
        reached: &impl Reached,
        measured: &BTreeMap<[usize; 2], f64>,
    ) -> Option<(Vec<usize>, f64)> {
        let reach = self.config.reach();
        let mut least = vec![f64::INFINITY; self.patches.len()];
        let mut before = vec![usize::MAX; self.patches.len()];
        let mut open = BTreeSet::new();
        for patch in (0..self.patches.len()).filter(|patch| reached.has(*patch)) {
            least[patch] = reach;
            open.insert((reach.to_bits(), patch));
        }
        while let Some((worst, patch)) = open.pop_first() {
            let worst = f64::from_bits(worst);
            if goals.binary_search(&patch).is_ok() {
                let way = std::iter::successors(Some(patch), |patch| {
                    Some(before[*patch]).filter(|before| *before != usize::MAX)
                });
                return Some((way.collect(), worst));
            }
            for (beside, _) in self.links.of(patch) {
                let ends = [patch.min(beside), patch.max(beside)];
                let arm = measured.get(&ends).copied();
                let arm = arm.unwrap_or(self.arms[beside].max(self.arms[patch]));
                let asked = worst.max(arm);
                if asked < least[beside] && self.can_hold(beside, asked) {
                    open.remove(&(least[beside].to_bits(), beside));
                    (least[beside], before[beside]) = (asked, patch);
                    open.insert((asked.to_bits(), beside));
                }
            }
        }
        None
    }
}
