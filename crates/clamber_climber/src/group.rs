//! The climbers of a scene, as obstacles to each other.

use clamber_world::{Obstacle, ObstacleId};

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
        let on = |climber: &Climber| climber.state().support.map(|on| on.attachment.obstacle);
        let bodies = &self.bodies;
        let is_on_another = climbers.clone().map(|(_, climber)| {
            let carrier = on(climber);
            bodies.iter().any(|(id, _)| Some(*id) == carrier)
        });
        self.carried
            .extend(is_on_another.map(|is_on_another| !is_on_another));
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
    }

    /// Index in `bodies` of the climber that carries another one.
    fn carrier_of(&self, climber: &Climber) -> Option<usize> {
        let on = climber.state().support.map(|on| on.attachment.obstacle);
        self.bodies.iter().position(|(id, _)| Some(*id) == on)
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

    /// The obstacles of all climbers, in the order of the last update.
    pub fn bodies(&self) -> &[(ObstacleId, ClimberObstacle)] {
        &self.bodies
    }
}
