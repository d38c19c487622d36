//! Climbers on a box that moves, in any order and size.

use clamber_climber::{
    Climber, ClimberConfig, ClimberGroup, ClimberInput, ClimberMode, ClimberState, ContactQuery,
    ContactRule, StepReport, StepRules,
};
use clamber_surface::geometry::Similarity;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::{DQuat, DVec3};

use crate::input::IDLE;
use crate::numbers::in_world_of_size;
use crate::scene::{STONE, cuboid, list, rest, throw};

/// The tick rates of all plays of this test, hertz.
pub(crate) const RATES: [f64; 4] = [30.0, 60.0, 120.0, 240.0];

/// Sizes of the bodies, relative to a radius of 0.4 m.
pub(crate) const SIZES: [f64; 4] = [1.0, 0.02, 0.3, 100.0];

/// A walker of another size, in a world of that size.
pub(crate) fn walker(size: f64) -> ClimberConfig {
    in_world_of_size(ClimberConfig::walker(), size)
}

/// Boxes, and climbers among them. The first box may move.
pub(crate) struct Crowd {
    pub(crate) boxes: Vec<SkinnedSurface>,
    pub(crate) climbers: Vec<Climber>,
    group: ClimberGroup,
    pub(crate) dt: f64,
    /// The rule for the climbers' contacts.
    pub(crate) rule: Option<fn(&ContactQuery<'_>) -> ContactRule>,
    /// False if the climbers do not know their own ids.
    pub(crate) know_ids: bool,
    /// The order in which the climbers are stepped and listed.
    pub(crate) order: Vec<usize>,
    /// The centre of the first box.
    deck: DVec3,
    /// Size of the bodies, relative to a radius of 0.4 m.
    size: f64,
}

fn id(index: usize) -> ObstacleId {
    ObstacleId(100 + index as u64)
}

impl Crowd {
    /// Climbers with the centres of their balls at places, on a deck whose top is at height 0.
    pub(crate) fn new(config: ClimberConfig, places: &[DVec3], rate: f64) -> Self {
        let size = config.body.radius / 0.4;
        let climbers = places.iter();
        let mut crowd = Self {
            boxes: Vec::new(),
            climbers: climbers
                .map(|place| Climber::new(config, *place).unwrap())
                .collect(),
            group: ClimberGroup::default(),
            dt: 1.0 / rate,
            rule: None,
            know_ids: true,
            order: (0..places.len()).collect(),
            deck: DVec3::ZERO,
            size,
        };
        crowd.add_box(DVec3::NEG_Y * size, DVec3::new(8.0, 1.0, 8.0) * size);
        crowd
    }

    fn at(&self, translation: DVec3) -> Similarity {
        Similarity {
            translation,
            rotation: DQuat::IDENTITY,
            scale: self.size,
        }
    }

    /// A box at a place; `half` are its half lengths.
    pub(crate) fn add_box(&mut self, center: DVec3, half: DVec3) {
        let mut surface = cuboid((half / self.size).as_vec3(), STONE);
        surface.teleport(&rest(), self.at(center)).unwrap();
        if self.boxes.is_empty() {
            self.deck = center;
        }
        self.boxes.push(surface);
    }

    /// Steps all climbers, after the deck has moved to `deck`, relative to its first place.
    pub(crate) fn step(
        &mut self,
        deck: DVec3,
        input: impl Fn(usize) -> ClimberInput,
    ) -> Vec<StepReport> {
        let place = self.at(self.deck + deck);
        if let Some(first) = self.boxes.first_mut() {
            first.advance(&rest(), place).unwrap();
        }
        let boxes: Vec<_> = self.boxes.iter().map(|one| one as &dyn Obstacle).collect();
        let fixed = list(&boxes);
        let climbers = &self.climbers;
        let order = self.order.iter();
        let listed = order.map(|index| (id(*index), &climbers[*index]));
        self.group.update(listed, &fixed, self.dt);
        let rule = self.rule;
        let mut reports = vec![StepReport::default(); self.climbers.len()];
        for &index in &self.order {
            let mut obstacles = fixed.clone();
            obstacles.extend(self.group.others(id(index)));
            if self.order[0] != 0 {
                obstacles.reverse();
            }
            let rules = StepRules {
                id: self.know_ids.then_some(id(index)),
                contact: rule
                    .as_ref()
                    .map(|rule| rule as &dyn Fn(&ContactQuery<'_>) -> ContactRule),
                ..StepRules::default()
            };
            let climber = &mut self.climbers[index];
            reports[index] = climber
                .step_with(&input(index), &obstacles, &rules, self.dt)
                .unwrap();
        }
        reports
    }

    /// Steps with the deck at rest, and input of the first climber only.
    pub(crate) fn step_first(&mut self, input: ClimberInput) -> Vec<StepReport> {
        self.step(DVec3::ZERO, |index| if index == 0 { input } else { IDLE })
    }

    /// Steps with the deck at rest and without input.
    pub(crate) fn rest(&mut self, seconds: f64) {
        for _ in 0..(seconds / self.dt).round() as u32 {
            self.step(DVec3::ZERO, |_| IDLE);
        }
    }

    /// Puts a climber at another place, in the air.
    pub(crate) fn put(&mut self, index: usize, position: DVec3) {
        let state = ClimberState {
            position,
            support: None,
            mode: ClimberMode::Falling,
            ..*self.state(index)
        };
        self.climbers[index].restore(state).unwrap();
    }

    pub(crate) fn position(&self, index: usize) -> DVec3 {
        self.climbers[index].state().position
    }

    pub(crate) fn state(&self, index: usize) -> &ClimberState {
        self.climbers[index].state()
    }

    /// Sets the velocities of a climber and of its frame.
    pub(crate) fn throw(&mut self, index: usize, velocity: DVec3, base_velocity: DVec3) {
        throw(&mut self.climbers[index], velocity, base_velocity);
    }
}
