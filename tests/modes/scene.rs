//! A climber among moving boxes and water, in a frame that moves as a whole.

use clamber::climber::Knockback;
use clamber::climber::{ClimberConfig, ClimberInput, ClimberMode, CustomMode, StepReport};
use clamber::prelude::{Climber, Obstacle, ObstacleId, StepRules, SurfaceKind};
use glam::{DQuat, DVec3};

use crate::modes::dash::Dash;
use crate::modes::swim::Swim;
use crate::modes::vault::Vault;
use crate::modes::wall_run::WallRun;
use crate::own::Own;

/// Length of a tick, seconds.
pub(crate) const DT: f64 = 1.0 / 60.0;

/// Mode of the dash.
pub(crate) const DASH: ClimberMode = ClimberMode::Custom(1);
/// Mode of the vault.
pub(crate) const VAULT: ClimberMode = ClimberMode::Custom(2);
/// Mode of the wall run.
pub(crate) const WALL_RUN: ClimberMode = ClimberMode::Custom(3);
/// Mode of swimming.
pub(crate) const SWIM: ClimberMode = ClimberMode::Custom(4);

/// Rotation and translation of a box at a time, seconds, relative to its first place.
pub(crate) type Motion = fn(f64) -> (DQuat, DVec3);

/// Triangles of a box. The bits of a corner's index select the low or the high side along X, Y and Z.
const TRIANGLES: [[u32; 3]; 12] = [
    [0, 2, 1],
    [1, 2, 3],
    [4, 5, 6],
    [5, 7, 6],
    [0, 1, 4],
    [1, 5, 4],
    [2, 6, 3],
    [3, 6, 7],
    [0, 4, 2],
    [2, 4, 6],
    [1, 3, 5],
    [3, 7, 5],
];

/// The scene. Positions and velocities are relative to the frame.
pub(crate) struct Scene {
    boxes: Vec<Own>,
    water: Option<[DVec3; 2]>,
    /// Velocity of the whole scene, metres a second.
    frame: DVec3,
    tick: u32,
    pub(crate) climber: Climber,
    /// The blow that strikes the climber in the next tick.
    pub(crate) knockback: Option<Knockback>,
    pub(crate) dash: Dash,
    pub(crate) extra: Option<Box<dyn CustomMode>>,
    pub(crate) trace: Vec<(DVec3, DVec3, ClimberMode)>,
}

impl Scene {
    /// A climber in the air, and a floor whose top is at 0.
    pub(crate) fn new(frame: DVec3, position: DVec3) -> Self {
        let mut config = ClimberConfig::walker();
        config.ground.air_acceleration = 5.0;
        let mut climber = Climber::new(config, position).unwrap();
        let mut state = *climber.state();
        (state.velocity, state.base_velocity) = (frame, frame);
        climber.restore(state).unwrap();
        Self {
            boxes: Vec::new(),
            water: None,
            frame,
            tick: 0,
            climber,
            knockback: None,
            dash: Dash::default(),
            extra: None,
            trace: Vec::new(),
        }
        .with_box([-50.0, -5.0, -50.0], [50.0, 0.0, 50.0])
    }

    pub(crate) fn without_floor(mut self) -> Self {
        self.boxes.clear();
        self
    }

    pub(crate) fn with_box(self, low: [f64; 3], high: [f64; 3]) -> Self {
        self.with_moving(low, high, |_| (DQuat::IDENTITY, DVec3::ZERO))
    }

    pub(crate) fn with_moving(mut self, low: [f64; 3], high: [f64; 3], motion: Motion) -> Self {
        let corners = move |time: f64| {
            let (turn, by) = motion(time);
            let pick = |corner: usize, axis: usize| {
                if corner >> axis & 1 == 1 {
                    high[axis]
                } else {
                    low[axis]
                }
            };
            let corner = |k: usize| DVec3::new(pick(k, 0), pick(k, 1), pick(k, 2));
            (0..8).map(|k| turn * corner(k) + by).collect()
        };
        let triangles = TRIANGLES.to_vec();
        let mut own = Own::new(Box::new(corners), triangles, SurfaceKind::default(), 1.0);
        own.advance(0.0, |point| point);
        self.boxes.push(own);
        self
    }

    pub(crate) fn with_water(mut self, low: [f64; 3], high: [f64; 3]) -> Self {
        self.water = Some([low, high].map(DVec3::from_array));
        self
    }

    /// Makes one tick with all modes. Asserts that a second climber, restored to the state before the tick, gets the
    /// same state and report, bit for bit.
    pub(crate) fn step(&mut self, input: &ClimberInput) -> StepReport {
        self.step_without(input, None)
    }

    /// Like [`Scene::step`], without the handler of one mode.
    pub(crate) fn step_without(
        &mut self,
        input: &ClimberInput,
        missing: Option<ClimberMode>,
    ) -> StepReport {
        self.tick += 1;
        let time = f64::from(self.tick) * DT;
        let by = self.frame * time;
        for own in &mut self.boxes {
            own.advance(time, |point| point + by);
        }
        let ids = (0..).map(ObstacleId);
        let boxes = self.boxes.iter().map(|own| own as &dyn Obstacle);
        let obstacles: Vec<(ObstacleId, &dyn Obstacle)> = ids.zip(boxes).collect();
        let swim = self
            .water
            .map(|water| Swim::new(water.map(|corner| corner + by), self.frame));
        let (vault, wall_run) = (Vault::default(), WallRun { action: 4 });
        let mut modes: Vec<&dyn CustomMode> = vec![&self.dash, &vault, &wall_run];
        modes.extend(swim.iter().map(|swim| swim as &dyn CustomMode));
        modes.extend(self.extra.as_deref());
        modes.retain(|mode| Some(ClimberMode::Custom(mode.id())) != missing);
        let rules = StepRules {
            knockback: self.knockback.take(),
            ..StepRules::with_modes(&modes)
        };

        let state = *self.climber.state();
        let mut other = Climber::new(*self.climber.config(), DVec3::ZERO).unwrap();
        other.restore(state).unwrap();
        let report = self
            .climber
            .step_with(input, &obstacles, &rules, DT)
            .unwrap();
        let again = other.step_with(input, &obstacles, &rules, DT).unwrap();
        let told = self.climber.state();
        let bits = [told.fingerprint(), other.state().fingerprint()];
        assert_eq!(
            bits[0],
            bits[1],
            "{state:?} became {told:?} and {:?}",
            other.state()
        );
        assert_eq!(report, again, "{state:?}");
        assert!(
            report.penetration < 1e-4 && report.is_clear,
            "{told:?}: {report:?}"
        );
        self.trace
            .push((told.position - by, told.velocity - self.frame, told.mode));
        report
    }

    pub(crate) fn steps(&mut self, count: u32, input: &ClimberInput) {
        for _ in 0..count {
            self.step(input);
        }
    }

    /// Waits until the climber stands on the floor.
    pub(crate) fn settled(mut self) -> Self {
        self.steps(60, &ClimberInput::IDLE);
        assert_eq!(
            self.mode(),
            ClimberMode::Standing,
            "{:?}",
            self.climber.state()
        );
        self
    }

    pub(crate) fn time(&self) -> f64 {
        f64::from(self.tick) * DT
    }

    pub(crate) fn mode(&self) -> ClimberMode {
        self.climber.state().mode
    }

    pub(crate) fn position(&self) -> DVec3 {
        self.climber.state().position - self.frame * self.time()
    }

    pub(crate) fn velocity(&self) -> DVec3 {
        self.climber.state().velocity - self.frame
    }

    /// Number of ticks that ended in a mode.
    pub(crate) fn ticks_in(&self, mode: ClimberMode) -> usize {
        self.trace
            .iter()
            .filter(|(_, _, known)| *known == mode)
            .count()
    }
}

pub(crate) fn walk(direction: DVec3) -> ClimberInput {
    ClimberInput {
        walk: direction,
        ..ClimberInput::IDLE
    }
}

/// Walks with a button held.
pub(crate) fn act(direction: DVec3, action: u32) -> ClimberInput {
    ClimberInput {
        actions: action,
        ..walk(direction)
    }
}
