//! The climbers of a scene, as obstacles to each other.

mod tree;

use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

use tree::Tree;

use crate::{Climber, ClimberObstacle};

/// The climbers of a scene, as obstacles to each other for one tick.
///
/// A climber that stands on another one is carried by it, and that one by its own support, and so on. So a group makes
/// the obstacles from the ground up. Keep a group from tick to tick: it reuses its memory.
///
/// ```
/// use clamber_climber::{Climber, ClimberConfig, ClimberGroup, ClimberInput, StepRules};
/// use clamber_world::{HalfSpace, Obstacle, ObstacleId};
/// use glam::DVec3;
///
/// let dt = 1.0 / 60.0;
/// let ground = HalfSpace::below(0.0);
/// let fixed: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &ground)];
/// let at = |x| Climber::new(ClimberConfig::walker(), DVec3::new(x, 0.4, 0.0));
/// let mut climbers = [(ObstacleId(1), at(0.0)?), (ObstacleId(2), at(0.5)?)];
/// let mut group = ClimberGroup::default();
///
/// group.update(climbers.iter().map(|(id, climber)| (*id, climber)), &fixed, dt);
/// for (id, climber) in &mut climbers {
///     let obstacles: Vec<_> = fixed.into_iter().chain(group.others(*id)).collect();
///     let rules = StepRules { id: Some(*id), ..StepRules::default() };
///     climber.step_with(&ClimberInput::default(), &obstacles, &rules, dt)?;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct ClimberGroup {
    /// In the caller's order.
    bodies: Vec<(ObstacleId, ClimberObstacle)>,
    /// For each of `bodies`, true once it is where its support carries it.
    carried: Vec<bool>,
    /// By ascending id, with the index in `bodies`; among equal ids, the first comes first.
    by_id: Vec<(ObstacleId, u32)>,
    /// Bounds of `bodies`, for `tree`.
    bounds: Vec<(DVec3, f64)>,
    tree: Tree,
}

impl ClimberGroup {
    /// Makes the obstacles of all climbers for the next tick of `dt` seconds. Call it before any climber is stepped,
    /// when the other `obstacles` are in their state at the tick's end. The order of obstacles and climbers does not
    /// matter. If two climbers have the same id, the first counts.
    ///
    /// Step each climber with the id that it has here ([`StepRules::id`](crate::StepRules::id)). Two climbers at
    /// exactly one place part to opposite sides by their ids; without ids they stay there.
    ///
    /// If climbers hold each other in a circle, the one with the lowest id lets go.
    pub fn update<'a>(
        &mut self,
        climbers: impl Iterator<Item = (ObstacleId, &'a Climber)> + Clone,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        dt: f64,
    ) {
        self.bodies.clear();
        self.carried.clear();
        let made = climbers
            .clone()
            .map(|(id, climber)| (id, ClimberObstacle::new(climber, obstacles, dt)));
        self.bodies.extend(made);
        self.by_id.clear();
        let ids = self.bodies.iter().map(|(id, _)| *id);
        self.by_id.extend(ids.zip(0..));
        self.by_id.sort_unstable();
        for (_, climber) in climbers.clone() {
            self.carried.push(self.carrier_of(climber).is_none());
        }
        // From the ground up. Each round settles the climbers on at least one more level, or breaks one circle.
        while self.carried.contains(&false) {
            let mut any = false;
            for (index, (_, climber)) in climbers.clone().enumerate() {
                if self.carried[index] {
                    continue;
                }
                let carrier = self.carrier_of(climber);
                let Some(carrier) = carrier.filter(|carrier| self.carried[*carrier]) else {
                    continue;
                };
                let below = self.bodies[carrier].1;
                self.bodies[index].1 = ClimberObstacle::on(climber, Some(&below), dt);
                self.carried[index] = true;
                any = true;
            }
            if !any {
                self.break_circle(climbers.clone(), dt);
            }
        }
        self.bounds.clear();
        let bounds = self.bodies.iter().map(|(_, body)| body.ball());
        self.bounds.extend(bounds);
        self.tree.build(&self.bounds);
    }

    /// Index in `bodies` of the climber that carries another one.
    fn carrier_of(&self, climber: &Climber) -> Option<usize> {
        let on = climber.state().support?.attachment.obstacle;
        let first = self.by_id.partition_point(|(id, _)| *id < on);
        let (id, index) = *self.by_id.get(first)?;
        (id == on).then_some(index as usize)
    }

    /// Finds a circle of climbers in which each carries the next, and lets the one with the lowest id fall: it lets go
    /// in its step. Call it when the carrier of every remaining climber remains as well: then these climbers contain a
    /// circle.
    fn break_circle<'a>(
        &mut self,
        climbers: impl Iterator<Item = (ObstacleId, &'a Climber)> + Clone,
        dt: f64,
    ) {
        let next = |index: usize| {
            let (_, climber) = climbers.clone().nth(index)?;
            self.carrier_of(climber)
        };
        let Some(first) = self.carried.iter().position(|is_carried| !is_carried) else {
            return;
        };
        // After as many steps as there are climbers, the climber that is reached is in the circle.
        let steps = 0..self.bodies.len();
        let inside = steps.fold(first, |index, _| next(index).unwrap_or(index));
        let (mut lowest, mut index) = (inside, inside);
        while let Some(other) = next(index).filter(|other| *other != inside) {
            if self.bodies[other].0 < self.bodies[lowest].0 {
                lowest = other;
            }
            index = other;
        }
        if let Some((_, climber)) = climbers.clone().nth(lowest) {
            self.bodies[lowest].1 = ClimberObstacle::falling(climber, dt);
        }
        self.carried[lowest] = true;
    }

    /// The obstacles of all climbers but one, in the order of the last update.
    pub fn others(&self, id: ObstacleId) -> impl Iterator<Item = (ObstacleId, &dyn Obstacle)> {
        let others = self.bodies.iter().filter(move |(other, _)| *other != id);
        others.map(|(other, body)| (*other, body as &dyn Obstacle))
    }

    /// Adds the obstacles of the climbers that are at most `radius` metres from `center` in this tick, and possibly of
    /// others, by ascending id. The climber with this id is left out. A climber that is farther from others than it
    /// moves and reaches in a tick does not need them.
    pub fn near<'a>(
        &'a self,
        id: ObstacleId,
        (center, radius): (DVec3, f64),
        found: &mut Vec<(ObstacleId, &'a dyn Obstacle)>,
    ) {
        let start = found.len();
        self.tree.near(center, radius, |index| {
            let (other, body) = &self.bodies[index];
            if *other != id {
                found.push((*other, body));
            }
        });
        found[start..].sort_unstable_by_key(|(id, _)| *id);
    }

    /// The obstacles of all climbers, in the order of the last update.
    pub fn bodies(&self) -> &[(ObstacleId, ClimberObstacle)] {
        &self.bodies
    }
}
