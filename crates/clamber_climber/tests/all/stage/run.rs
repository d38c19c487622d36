//! A climber on a stage, and the trace of its run.

use clamber_climber::{
    Climber, ClimberConfig, ClimberError, ClimberEvent, ClimberInput, ClimberMode, ClimberObstacle,
    ClimberState, ContactQuery, ContactRule, Knockback, StepReport, StepRules,
};
use clamber_world::{Obstacle, ObstacleId, WorldCapsule};
use glam::DVec3;

use super::place::Elsewhere;
use super::setting::{kinds, remember};
use super::{Played, Reach, Shape, Stage, listed, within};
use crate::events::is_crushed;
use crate::input::IDLE;

/// A recorded run, tick by tick, in the scenario's units and frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trace {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) velocities: Vec<DVec3>,
    pub(crate) modes: Vec<ClimberMode>,
    pub(crate) events: Vec<ClimberEvent>,
    /// The tick of each event.
    pub(crate) event_ticks: Vec<usize>,
    /// Deepest penetration of the core.
    pub(crate) penetration: f64,
    /// Ticks whose movement was not clear.
    pub(crate) unclear: u32,
    pub(crate) most_rounds: u32,
    /// Kind of the obstacles.
    pub(crate) played: Played,
    pub(crate) dt: f64,
    pub(crate) reach: Reach,
}

/// A climber on a stage.
pub(crate) struct Run {
    pub(crate) stage: Stage,
    /// The climber, in the world's units and frame.
    pub(crate) climber: Climber,
    pub(crate) trace: Trace,
    config: ClimberConfig,
    /// The rule for contacts; `None` for the usual rule.
    rule: Option<Rule>,
    /// The climber's own id.
    pub(crate) id: Option<ObstacleId>,
    /// Another climber without input, in the world's units and frame.
    friend: Option<Climber>,
    /// The climber's state in the scenario's units and frame.
    state: ClimberState,
    /// The blow in the next step, in the scenario's units.
    pub(crate) knockback: Option<Knockback>,
}

/// A rule for contacts that lives longer than a tick.
pub(crate) type Rule = Box<dyn Fn(&ContactQuery<'_>) -> ContactRule>;

/// Id of the other climber on the stage.
const FRIEND: ObstacleId = ObstacleId(99);

impl Run {
    /// A climber with its feet at a position on the stage.
    pub(crate) fn new(stage: Stage, config: ClimberConfig, feet: DVec3) -> Self {
        let place = stage.place();
        let position = feet + config.up() * config.body.radius;
        let climber = Climber::new(place.config(&config), place.point(position)).unwrap();
        let mut run = Self {
            state: *climber.state(),
            climber,
            stage,
            trace: Trace::default(),
            config,
            rule: None,
            id: None,
            friend: None,
            knockback: None,
        };
        run.put(ClimberState {
            position,
            velocity: DVec3::ZERO,
            ..run.state
        });
        run
    }

    /// A climber that has settled on a shape at rest.
    pub(crate) fn on(played: Played, shape: &Shape, config: ClimberConfig, feet: DVec3) -> Self {
        let stage = Stage::new(played).with_still(shape);
        Self::new(stage, config, feet).settle()
    }

    /// Sets the rule for contacts.
    pub(crate) fn set_rule(&mut self, rule: impl Fn(&ContactQuery<'_>) -> ContactRule + 'static) {
        self.rule = Some(Box::new(rule));
    }

    /// Puts another climber of the same configuration on the stage, with its feet at a position.
    pub(crate) fn meet_friend(&mut self, feet: DVec3) {
        let place = self.stage.place();
        let at = place.point(feet + self.config.up() * self.config.body.radius);
        let mut friend = Climber::new(place.config(&self.config), at).unwrap();
        let state = ClimberState {
            velocity: place.velocity,
            base_velocity: place.velocity,
            ..*friend.state()
        };
        friend.restore(state).unwrap();
        self.friend = Some(friend);
    }

    pub(crate) fn step(&mut self, input: &ClimberInput) -> StepReport {
        self.stage.advance();
        self.step_only(input)
    }

    /// Steps the climber by one tick in which no obstacle of the stage moves.
    pub(crate) fn step_held(&mut self, input: &ClimberInput) -> StepReport {
        self.stage.hold();
        self.step_only(input)
    }

    /// Steps the climber by one tick among obstacles that wrap the stage's obstacles. Both are queried in the
    /// scenario's units and frame.
    pub(crate) fn step_around(
        &mut self,
        input: &ClimberInput,
        around: impl for<'a> Fn(&'a dyn Obstacle) -> Box<dyn Obstacle + 'a>,
    ) -> StepReport {
        self.stage.advance();
        let (climber, dt) = (&mut self.climber, self.stage.dt);
        let there = self.stage.place().inverse();
        let report = self.stage.obstacles(|obstacles| {
            let around: Vec<(ObstacleId, Box<dyn Obstacle + '_>)> = obstacles
                .iter()
                .map(|(id, obstacle)| (*id, around(*obstacle)))
                .collect();
            let mut seen = Vec::new();
            for (id, inner) in &around {
                let inner = inner.as_ref();
                seen.push((*id, Elsewhere { inner, there }));
            }
            climber.step(input, &listed(&seen), dt).unwrap()
        });
        self.note(report)
    }

    fn step_only(&mut self, input: &ClimberInput) -> StepReport {
        let (climber, dt) = (&mut self.climber, self.stage.dt);
        let scale = self.stage.place().scale;
        let knockback = self.knockback.take().map(|knockback| Knockback {
            velocity: knockback.velocity * scale,
            ..knockback
        });
        // The air moves with the frame.
        let rules = StepRules {
            contact: self.rule.as_deref().map(|rule| rule as _),
            id: self.id,
            air_velocity: self.stage.place().velocity,
            knockback,
            ..StepRules::default()
        };
        let friend = &mut self.friend;
        let report = self.stage.in_world(|obstacles| {
            let mut obstacles = obstacles.to_vec();
            let body = friend
                .as_ref()
                .map(|friend| ClimberObstacle::new(friend, &obstacles, dt));
            if let Some(friend) = friend {
                friend.step(&IDLE, &obstacles, dt).unwrap();
            }
            obstacles.extend(body.as_ref().map(|body| (FRIEND, body as &dyn Obstacle)));
            let stepped = climber.step_with(input, &obstacles, &rules, dt);
            stepped.unwrap()
        });
        self.note(report)
    }

    /// Records the result of a step.
    fn note(&mut self, report: StepReport) -> StepReport {
        let back = self.stage.place().inverse();
        let report = back.report(report);
        self.state = back.state(self.climber.state());
        let trace = &mut self.trace;
        let tick = trace.positions.len();
        trace.positions.push(self.state.position);
        trace.velocities.push(self.state.velocity);
        trace.modes.push(self.state.mode);
        trace.events.extend(&report.events);
        trace.event_ticks.resize(trace.events.len(), tick);
        trace.penetration = trace.penetration.max(report.penetration);
        trace.unclear += u32::from(!report.is_clear);
        trace.most_rounds = trace.most_rounds.max(report.rounds);
        report
    }

    /// Sets the climber's state.
    pub(crate) fn put(&mut self, state: ClimberState) {
        let place = self.stage.place();
        self.climber.restore(place.state(&state)).unwrap();
        self.state = state;
    }

    pub(crate) fn steps(&mut self, count: u32, input: &ClimberInput) {
        for _ in 0..count {
            self.step(input);
        }
    }

    /// Lets the climber land before any obstacle moves, and clears the trace.
    pub(crate) fn settle(mut self) -> Self {
        for _ in 0..60 {
            self.step_held(&IDLE);
            if self.mode() == ClimberMode::Standing {
                self.step_held(&IDLE);
                break;
            }
        }
        let state = self.state();
        assert_eq!(
            state.mode,
            ClimberMode::Standing,
            "did not settle: {state:?}"
        );
        self.trace = Trace::default();
        self
    }

    /// Resizes the climber among the obstacles of the stage. The configuration is in the scenario's units.
    pub(crate) fn resize(&mut self, config: ClimberConfig) -> Result<(), ClimberError> {
        let (climber, place) = (&mut self.climber, self.stage.place());
        let scaled = place.config(&config);
        self.stage
            .in_world(|obstacles| climber.try_resize(scaled, obstacles))?;
        self.config = config;
        self.state = place.inverse().state(self.climber.state());
        Ok(())
    }

    /// Throws the climber into the air at a velocity.
    pub(crate) fn thrown(mut self, velocity: DVec3) -> Self {
        self.put(ClimberState {
            velocity,
            ..self.state
        });
        self
    }

    pub(crate) fn state(&self) -> &ClimberState {
        &self.state
    }

    pub(crate) fn config(&self) -> &ClimberConfig {
        &self.config
    }

    /// The climber's capsule.
    pub(crate) fn body(&self) -> WorldCapsule {
        self.stage.place().inverse().capsule(&self.climber.body())
    }

    pub(crate) fn mode(&self) -> ClimberMode {
        self.state().mode
    }

    /// Position of the climber's centre, relative to the stage's origin.
    pub(crate) fn position(&self) -> DVec3 {
        self.state.position
    }

    /// Position of the climber's feet.
    pub(crate) fn feet(&self) -> DVec3 {
        self.position() - self.config.up() * self.config.body.radius
    }

    /// The trace, after asserting that no tick went wrong.
    pub(crate) fn sound(self) -> Trace {
        self.trace.assert_sound();
        self.trace.clone()
    }
}

impl Drop for Run {
    /// Keeps the trace for the comparison of settings.
    fn drop(&mut self) {
        let mut trace = std::mem::take(&mut self.trace);
        trace.played = self.stage.played();
        trace.dt = self.stage.dt;
        trace.reach = self.stage.reach();
        remember(trace);
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
        let mut events = self.events.iter();
        let strange = events.find(|event| **event == ClimberEvent::NotFinite || is_crushed(event));
        assert_eq!(strange, None);
        assert!(self.positions.iter().all(|p| p.is_finite()));
    }

    pub(crate) fn heights(&self) -> impl Iterator<Item = f64> {
        self.positions.iter().map(|position| position.y)
    }

    pub(crate) fn always(&self, mode: ClimberMode) -> bool {
        self.modes.iter().all(|m| *m == mode)
    }

    /// The largest distance from another trace, and the tick of that distance.
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

    /// Asserts that the other trace has each mode in the same tick, or in the tick before or after.
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

/// Allowed distance between two kinds of obstacles with the same motion, metres.
pub(crate) const SAME: f64 = 1e-4;

/// Plays a scenario on each kind of obstacle of the setting: with the motion of a root, a joint and a body, or on a
/// single kind. Each must pass, and all must give the same result. `chord` is the distance between a body's circular
/// path and a skin's straight one, which is added to the allowed difference.
pub(crate) fn every(chord: f64, play: impl Fn(Played) -> Trace) {
    let first = kinds()[0];
    let trace = play(first);
    for &played in &kinds()[1..] {
        let tolerance = SAME + if played == Played::Body { chord } else { 0.0 };
        let other = play(played);
        let (apart, tick) = trace.apart(&other);
        let name = format!("{played:?}");
        let told = format!("{name}: {apart} m from {first:?} at tick {tick}");
        within!(apart, tolerance, "{told}");
        trace.assert_same_modes(&other, &name);
        other.assert_same_modes(&trace, &name);
    }
}
