//! A climber on a stage, and what is written down of it.

use clamber_climber::{
    Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, ClimberState, StepReport,
};
use glam::DVec3;

use super::{Played, Stage, within};

/// What a climber did, tick by tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trace {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) modes: Vec<ClimberMode>,
    pub(crate) events: Vec<ClimberEvent>,
    /// Deepest below the skin width that anything was.
    pub(crate) penetration: f64,
    /// Ticks in which something was left on the way.
    pub(crate) unclear: u32,
    pub(crate) most_rounds: u32,
}

/// A climber on a stage.
pub(crate) struct Run {
    pub(crate) stage: Stage,
    pub(crate) climber: Climber,
    pub(crate) trace: Trace,
}

/// No input.
pub(crate) const IDLE: ClimberInput = ClimberInput::IDLE;

pub(crate) fn walk(direction: DVec3) -> ClimberInput {
    ClimberInput {
        walk: direction,
        ..IDLE
    }
}

pub(crate) const JUMP: ClimberInput = ClimberInput { jump: true, ..IDLE };

impl Run {
    /// A climber whose feet are at a place of the stage.
    pub(crate) fn new(stage: Stage, config: ClimberConfig, feet: DVec3) -> Self {
        let position = stage.origin + feet + config.up() * config.body.radius;
        Self {
            climber: Climber::new(config, position).unwrap(),
            stage,
            trace: Trace::default(),
        }
    }

    pub(crate) fn step(&mut self, input: &ClimberInput) -> StepReport {
        self.stage.advance();
        self.step_only(input)
    }

    /// A tick in which nothing of the stage moves.
    pub(crate) fn step_held(&mut self, input: &ClimberInput) -> StepReport {
        self.stage.hold();
        self.step_only(input)
    }

    fn step_only(&mut self, input: &ClimberInput) -> StepReport {
        let (climber, dt) = (&mut self.climber, self.stage.dt);
        let report = self
            .stage
            .obstacles(|obstacles| climber.step(input, obstacles, dt).unwrap());
        let state = self.climber.state();
        let trace = &mut self.trace;
        trace.positions.push(state.position - self.stage.origin);
        trace.modes.push(state.mode);
        trace.events.extend(&report.events);
        trace.penetration = trace.penetration.max(report.penetration);
        trace.unclear += u32::from(!report.is_clear);
        trace.most_rounds = trace.most_rounds.max(report.rounds);
        report
    }

    pub(crate) fn steps(&mut self, count: u32, input: &ClimberInput) {
        for _ in 0..count {
            self.step(input);
        }
    }

    /// Lets it land before anything moves, and forgets how.
    pub(crate) fn settle(mut self) -> Self {
        for _ in 0..60 {
            self.step_held(&IDLE);
            if self.mode() == ClimberMode::Standing {
                self.step_held(&IDLE);
                break;
            }
        }
        assert_eq!(
            self.mode(),
            ClimberMode::Standing,
            "did not settle: {:?}",
            self.state()
        );
        self.trace = Trace::default();
        self
    }

    /// In the air at a velocity.
    pub(crate) fn thrown(mut self, velocity: DVec3) -> Self {
        let state = ClimberState {
            velocity,
            ..*self.climber.state()
        };
        self.climber.restore(state).unwrap();
        self
    }

    pub(crate) fn state(&self) -> &ClimberState {
        self.climber.state()
    }

    pub(crate) fn mode(&self) -> ClimberMode {
        self.state().mode
    }

    /// Of its centre, relative to the stage's origin.
    pub(crate) fn position(&self) -> DVec3 {
        self.state().position - self.stage.origin
    }

    /// Of its feet.
    pub(crate) fn feet(&self) -> DVec3 {
        let config = self.climber.config();
        self.position() - config.up() * config.body.radius
    }

    /// What was written down, after seeing that no tick went wrong.
    pub(crate) fn sound(self) -> Trace {
        self.trace.assert_sound();
        self.trace
    }
}

impl Trace {
    pub(crate) fn assert_sound(&self) {
        assert_eq!(self.unclear, 0, "ticks with something left on the way");
        assert!(
            self.penetration <= 1e-3,
            "{} m below the skin width",
            self.penetration
        );
        let strange = self.events.iter().find(|event| {
            matches!(
                event,
                ClimberEvent::NotFinite | ClimberEvent::Crushed { .. }
            )
        });
        assert_eq!(strange, None);
        assert!(self.positions.iter().all(|p| p.is_finite()));
    }

    pub(crate) fn always(&self, mode: ClimberMode) -> bool {
        self.modes.iter().all(|m| *m == mode)
    }

    /// The largest distance from another at one tick, and the tick.
    pub(crate) fn apart(&self, other: &Self) -> (f64, usize) {
        assert_eq!(self.positions.len(), other.positions.len());
        let pairs = self.positions.iter().zip(&other.positions);
        let apart = pairs.map(|(a, b)| a.distance(*b)).enumerate();
        apart.fold(
            (0.0, 0),
            |most, (tick, apart)| {
                if apart > most.0 { (apart, tick) } else { most }
            },
        )
    }

    /// Every mode is one that the other has at that tick or beside it.
    fn assert_same_modes(&self, other: &Self, name: &str) {
        for (tick, mode) in self.modes.iter().enumerate() {
            let near = tick.saturating_sub(1)..(tick + 2).min(other.modes.len());
            assert!(
                other.modes[near].contains(mode),
                "{name}: {mode:?} at tick {tick} is {:?} there",
                other.modes[tick]
            );
        }
    }
}

/// How far two ways to play the same motion may lead apart, metres.
pub(crate) const SAME: f64 = 1e-4;

/// Plays a scenario as the motion of a root, of a joint and of a body: each must pass, and all must give
/// the same. `chord` is by how much a body's turning way leaves the skin's straight one.
pub(crate) fn every(chord: f64, play: impl Fn(Played) -> Trace) {
    let root = play(Played::Root);
    for (played, tolerance) in [(Played::Joint, SAME), (Played::Body, SAME + chord)] {
        let other = play(played);
        let (apart, tick) = root.apart(&other);
        let name = format!("{played:?}");
        within!(
            apart,
            tolerance,
            "{name}: {apart} m from the root's at tick {tick}"
        );
        root.assert_same_modes(&other, &name);
        other.assert_same_modes(&root, &name);
    }
}
